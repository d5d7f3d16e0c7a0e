//! Every pass against what phones take: GLSL ES 3.00, WebGL2 limits, and compilers stricter than naga.

use naga::back::{glsl, spv};
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{Block, Expression, Function, MathFunction, Module, ScalarKind, ShaderStage, Statement, TypeInner};
use subsurf_shaders::source;

/// What a WebGL2-class device offers: nothing beyond the core of WGSL.
const WEBGL2: Capabilities = Capabilities::empty();
/// `Limits::downlevel_webgl2_defaults()`.
const MAX_UNIFORM_BYTES: u32 = 16 << 10;
const MAX_TEXTURES: usize = 16;

fn parse(name: &str, text: &str) -> Module {
    naga::front::wgsl::parse_str(text).unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(text)))
}

fn validate(name: &str, module: &Module) -> ModuleInfo {
    let mut validator = Validator::new(ValidationFlags::all(), WEBGL2);
    validator.validate(module).unwrap_or_else(|error| panic!("{name}: {error:?}"))
}

fn functions(module: &Module) -> impl Iterator<Item = &Function> {
    let entries = module.entry_points.iter().map(|entry| &entry.function);
    module.functions.iter().map(|(_, function)| function).chain(entries)
}

#[test]
fn all_passes_are_valid_and_lower_to_gles_3_0_and_spir_v() {
    for (name, text) in &source::all() {
        let module = parse(name, text);
        let info = validate(name, &module);
        for entry in &module.entry_points {
            let options = glsl::Options { version: glsl::Version::new_gles(300), ..Default::default() };
            let pipeline =
                glsl::PipelineOptions { shader_stage: entry.stage, entry_point: entry.name.clone(), multiview: None };
            let mut text = String::new();
            glsl::Writer::new(&mut text, &module, &info, &options, &pipeline, Default::default())
                .and_then(|mut writer| writer.write())
                .unwrap_or_else(|error| panic!("{name}, {}: {error}", entry.name));
            assert!(text.starts_with("#version 300 es"), "{name}, {}: {text}", entry.name);
            assert_ne!(entry.stage, ShaderStage::Compute, "{name}: GLES 3.0 has no compute");
        }
        spv::write_vec(&module, &info, &spv::Options::default(), None)
            .unwrap_or_else(|error| panic!("{name}: {error}"));
    }
}

/// Built-ins that naga lowers to GLSL ES 3.00 and real compilers refuse there.
fn is_refused(function: MathFunction) -> bool {
    matches!(
        function,
        MathFunction::ExtractBits
            | MathFunction::InsertBits
            | MathFunction::CountOneBits
            | MathFunction::CountTrailingZeros
            | MathFunction::CountLeadingZeros
            | MathFunction::ReverseBits
            | MathFunction::FirstLeadingBit
            | MathFunction::FirstTrailingBit
            | MathFunction::Ldexp
            | MathFunction::Frexp
            | MathFunction::Modf
            | MathFunction::Fma
            | MathFunction::Dot4I8Packed
            | MathFunction::Dot4U8Packed
            | MathFunction::Pack2x16float
            | MathFunction::Unpack2x16float
    )
}

#[test]
fn no_pass_uses_what_gles_3_0_compilers_refuse() {
    for (name, text) in &source::all() {
        let module = parse(name, text);
        for function in functions(&module) {
            for (_, expression) in function.expressions.iter() {
                match expression {
                    Expression::Math { fun, .. } => assert!(!is_refused(*fun), "{name}: {fun:?}"),
                    Expression::ImageSample { gather, level, .. } => {
                        assert!(gather.is_none(), "{name}: textureGather");
                        // Implicit levels need derivatives, which non-uniform control flow does not have.
                        assert!(!matches!(level, naga::SampleLevel::Auto), "{name}: textureSample");
                    }
                    _ => {}
                }
            }
        }
    }
}

/// naga lowers `select` with a vector condition to `mix(.., bvec)`, which GLSL ES 3.00 has for floats only.
#[test]
fn selects_by_vector_are_of_floats() {
    for (name, text) in &source::all() {
        let module = parse(name, text);
        let info = validate(name, &module);
        let by_index = module.functions.iter().map(|(handle, function)| (function, &info[handle]));
        let entries = module.entry_points.iter().enumerate();
        let by_entry = entries.map(|(index, entry)| (&entry.function, info.get_entry_point(index)));
        for (function, info) in by_index.chain(by_entry) {
            for (_, expression) in function.expressions.iter() {
                if let Expression::Select { condition, accept, .. } = expression {
                    let scalar = matches!(info[*condition].ty.inner_with(&module.types), TypeInner::Scalar(_));
                    let kind = info[*accept].ty.inner_with(&module.types).scalar_kind();
                    assert!(scalar || kind == Some(ScalarKind::Float), "{name}, {:?}", function.name);
                }
            }
        }
    }
}

/// GLES has no bounds checks, so every `textureLoad` takes a texel that is clamped, or derived from the target's own
/// position. This holds the number of loads, so that a new one is looked at.
#[test]
fn texture_loads_are_accounted_for() {
    let loads = |text: &str| text.matches("textureLoad(").count();
    // How values are kept loads nothing.
    let all: Vec<_> = source::all().into_iter().filter(|(name, _)| !name.ends_with(", packed")).collect();
    let counts: Vec<(&str, usize)> = all.iter().map(|(name, text)| (&name[..], loads(text))).collect();
    assert_eq!(
        counts,
        [
            // Index or code, ratio or pair, node; irradiance at an addressed texel.
            ("gather, Single", 3),
            ("gather, Bmpp", 4),
            ("gather, Palette", 4),
            ("gather, Three", 4),
            ("gather, Five", 4),
            ("gather, PerPixel", 4),
            ("gather, Capture", 2),
            // Cell starts clamped to the number of points, pixels to the patch; the points' tables have equal sizes. Splats:
            // samples within their level, texels of the target times its stride clamped, places wrapped into the patch.
            ("surface gather, Single", 8),
            ("splat, Single", 9),
            ("surface gather, Bmpp", 9),
            ("splat, Bmpp", 10),
            ("surface gather, Palette", 9),
            ("splat, Palette", 10),
            ("surface gather, Three", 9),
            ("splat, Three", 10),
            ("surface gather, Five", 9),
            ("splat, Five", 10),
            ("surface gather, PerPixel", 9),
            ("splat, PerPixel", 10),
            // At the target's own texel; taps clamped to the size of the maps, or wrapped by a sampler; what lights see clamped to its size.
            ("blur first rows, Patch, L = 1", 0),
            ("blur last columns, Patch, L = 1", 2),
            ("weigh mesh, L = 1", 4),
            ("shade sums, L = 1", 3),
            ("shade sums there, L = 1", 3),
            ("blur rows, Patch, L = 1", 0),
            ("blur columns, Patch, L = 1", 1),
            ("blur rows, Screen, L = 1", 1),
            ("blur columns, Screen, L = 1", 2),
            ("blur first rows, Patch, L = 2", 0),
            ("blur last columns, Patch, L = 2", 2),
            ("weigh mesh, L = 2", 4),
            ("shade sums, L = 2", 3),
            ("shade sums there, L = 2", 3),
            ("blur rows, Patch, L = 2", 0),
            ("blur columns, Patch, L = 2", 1),
            ("blur rows, Screen, L = 2", 1),
            ("blur columns, Screen, L = 2", 2),
            ("irradiance", 3),
            ("light view", 0),
            ("shade points", 2),
            ("shade points there", 2),
            ("surface view", 0),
            ("reduce", 3),
            ("collapse", 8),
            ("shade splats", 2),
            ("shade splats there", 2),
            ("present", 1),
            ("homogeneous", 0),
            // Words of a file, clamped to the last; lists at the target's own texel.
            ("BTF query, Nested", 4),
            ("shade BTF, Nested", 2),
            ("shade BTF there, Nested", 2),
            ("shade BTF in the dark, Nested", 2),
            ("shade BTF in the dark there, Nested", 2),
            // Pixels of images clamped to their size, tiles and layers to the texture's.
            ("BTF query, Images", 4),
            ("shade BTF, Images", 2),
            ("shade BTF there, Images", 2),
            ("shade BTF in the dark, Images", 2),
            ("shade BTF in the dark there, Images", 2),
        ]
    );
}

#[test]
fn limits_of_webgl2_are_kept() {
    for (name, text) in &source::all() {
        let module = parse(name, text);
        let mut textures = 0;
        let shared = module.global_variables.iter().filter(|(_, global)| global.space != naga::AddressSpace::Private);
        for (_, global) in shared {
            match &module.types[global.ty].inner {
                TypeInner::Image { .. } => textures += 1,
                TypeInner::Sampler { .. } => {}
                TypeInner::Struct { span, .. } => {
                    assert!(*span <= MAX_UNIFORM_BYTES, "{name}: {span} bytes")
                }
                other => panic!("{name}: {other:?} is neither texture nor uniform"),
            }
            let is_storage = matches!(global.space, naga::AddressSpace::Storage { .. });
            assert!(!is_storage, "{name}: storage buffers are beyond GLES 3.0");
        }
        assert!(textures <= MAX_TEXTURES, "{name}: {textures} textures");
    }
}

/// Old Adreno compilers give up on functions with many literals, and deep nests of loops time out: keep passes small.
#[test]
fn loops_nest_at_most_three_deep() {
    fn depth(block: &Block) -> usize {
        let deepest = block.iter().map(|statement| match statement {
            Statement::Loop { body, continuing, .. } => 1 + depth(body).max(depth(continuing)),
            Statement::If { accept, reject, .. } => depth(accept).max(depth(reject)),
            Statement::Block(block) => depth(block),
            Statement::Switch { cases, .. } => cases.iter().map(|case| depth(&case.body)).max().unwrap_or(0),
            _ => 0,
        });
        deepest.max().unwrap_or(0)
    }
    for (name, text) in &source::all() {
        for function in functions(&parse(name, text)) {
            assert!(depth(&function.body) <= 3, "{name}: {:?}", function.name);
        }
    }
}
