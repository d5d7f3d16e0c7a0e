//! Every pass against what phones take: GLSL ES 3.00, WebGL2 limits, and compilers stricter than naga.

use std::borrow::Cow;

use naga::back::pipeline_constants::process_overrides;
use naga::back::{glsl, spv};
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{Block, Expression, Function, MathFunction, Module, ScalarKind, ShaderStage, Statement, TypeInner};
use subsurf_shaders::TargetFormat;
use subsurf_shaders::passes::ALL;

/// What a WebGL2-class device offers: nothing beyond the core of WGSL.
const WEBGL2: Capabilities = Capabilities::empty();
/// `Limits::downlevel_webgl2_defaults()`.
const MAX_UNIFORM_BYTES: u32 = 16 << 10;
const MAX_TEXTURES: usize = 16;

/// Every variant of every pass for every target format: name and WGSL. Names for packed targets end in ", packed".
fn all() -> Vec<(String, String)> {
    let variants = ALL.into_iter().flat_map(|pass| pass.variants());
    let both = variants.flat_map(|variant| {
        let [half, packed] = TargetFormat::ALL.map(|target| variant.wgsl(target));
        [(variant.name(), half), (format!("{}, packed", variant.name()), packed)]
    });
    both.collect()
}

/// The module with its overrides set to `value`, for one entry point.
fn with_overrides<'a>(
    module: &'a Module,
    info: &'a ModuleInfo,
    entry: (ShaderStage, &str),
    value: f64,
) -> (Cow<'a, Module>, Cow<'a, ModuleInfo>) {
    let names = module.overrides.iter().filter_map(|(_, constant)| constant.name.clone());
    let constants = names.map(|name| (name, value)).collect();
    process_overrides(module, info, Some(entry), &constants).unwrap()
}

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
    for (name, text) in &all() {
        let module = parse(name, text);
        let info = validate(name, &module);
        // Overrides become constants for each pipeline, as wgpu makes them.
        let values = if module.overrides.is_empty() { vec![0.0] } else { vec![0.0, 1.0] };
        for (entry, value) in
            module.entry_points.iter().flat_map(|entry| values.iter().map(move |value| (entry, *value)))
        {
            let (module, info) = with_overrides(&module, &info, (entry.stage, &entry.name), value);
            let options = glsl::Options { version: glsl::Version::new_gles(300), ..Default::default() };
            let pipeline =
                glsl::PipelineOptions { shader_stage: entry.stage, entry_point: entry.name.clone(), multiview: None };
            let mut text = String::new();
            glsl::Writer::new(&mut text, &module, &info, &options, &pipeline, Default::default())
                .and_then(|mut writer| writer.write())
                .unwrap_or_else(|error| panic!("{name}, {}: {error}", entry.name));
            assert!(text.starts_with("#version 300 es"), "{name}, {}: {text}", entry.name);
            assert_ne!(entry.stage, ShaderStage::Compute, "{name}: GLES 3.0 has no compute");
            spv::write_vec(&module, &info, &spv::Options::default(), None)
                .unwrap_or_else(|error| panic!("{name}, {}: {error}", entry.name));
        }
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
    for (name, text) in &all() {
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
    for (name, text) in &all() {
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
    // Target formats load nothing.
    let all: Vec<_> = all().into_iter().filter(|(name, _)| !name.ends_with(", packed")).collect();
    let counts: Vec<(&str, usize)> = all.iter().map(|(name, text)| (&name[..], loads(text))).collect();
    assert_eq!(
        counts,
        [
            // Index or code, ratio or pair, node; irradiance at an addressed texel.
            ("gather, Material(Bmpp1)", 3),
            ("gather, Material(Bmpp2)", 4),
            ("gather, Material(Bmpp2Palette)", 4),
            ("gather, Material(Bmpp3)", 4),
            ("gather, Material(Bmpp5)", 4),
            ("gather, Material(PerPixel)", 4),
            ("gather, Material(Capture)", 2),
            ("present", 1),
            ("homogeneous", 0),
            // At the texel of the target; taps addressed into the patch, irradiance clamped to its one texel or many.
            ("blur_patch_first, Terms(1)", 3),
            ("blur_patch_first, Terms(2)", 3),
            ("blur_patch, Terms(1)", 1),
            ("blur_patch, Terms(2)", 1),
            ("sum_patch, Terms(1)", 1),
            ("sum_patch, Terms(2)", 1),
            ("blur_patch_last, Terms(1)", 2),
            ("blur_patch_last, Terms(2)", 2),
            // Entries clamped to the table, spans to the finer level.
            ("profile_sums, Material(Bmpp1)", 3),
            ("profile_sums, Material(Bmpp2)", 4),
            ("profile_sums, Material(Bmpp2Palette)", 4),
            ("profile_sums, Material(Bmpp3)", 4),
            ("profile_sums, Material(Bmpp5)", 4),
            ("profile_sums, Material(PerPixel)", 4),
            ("patch_reduce", 1),
            // Cell starts clamped to the number of points, pixels to the patch; the tables of the points have equal sizes.
            ("irradiance", 3),
            ("surface_gather, Material(Bmpp1)", 8),
            ("surface_gather, Material(Bmpp2)", 9),
            ("surface_gather, Material(Bmpp2Palette)", 9),
            ("surface_gather, Material(Bmpp3)", 9),
            ("surface_gather, Material(Bmpp5)", 9),
            ("surface_gather, Material(PerPixel)", 9),
            ("shade_vertex", 2),
            ("tsm_render", 0),
            ("tsm_reduce", 3),
            // Samples within their level, texels of the target times its stride clamped, places wrapped into the patch.
            ("surface_gbuffer", 0),
            ("splat, Material(Bmpp1)", 10),
            ("splat, Material(Bmpp2)", 11),
            ("splat, Material(Bmpp2Palette)", 11),
            ("splat, Material(Bmpp3)", 11),
            ("splat, Material(Bmpp5)", 11),
            ("splat, Material(PerPixel)", 11),
            ("splat_resolve", 8),
            ("shade_splat", 2),
            // Taps clamped to the size of the maps; translucent shadow maps clamped to theirs.
            ("separable_gbuffer, Terms(1)", 5),
            ("separable_gbuffer, Terms(2)", 5),
            ("blur_screen, Terms(1)", 1),
            ("blur_screen, Terms(2)", 1),
            ("sum_screen, Terms(1)", 1),
            ("sum_screen, Terms(2)", 1),
            ("blur_screen_last, Terms(1)", 1),
            ("blur_screen_last, Terms(2)", 1),
            ("shade_separable, Terms(1)", 2),
            ("shade_separable, Terms(2)", 2),
            // Texels of a light's own tile, of samples within it.
            ("fill_volume, Terms(1)", 4),
            ("fill_volume, Terms(2)", 4),
            // Cells within the volume.
            ("blur_volume, Terms(1)", 1),
            ("blur_volume, Terms(2)", 1),
            ("sum_volume, Terms(1)", 1),
            ("sum_volume, Terms(2)", 1),
            // Nodes of the tail up to the last; maps and translucent shadow maps as above.
            ("kernel_gbuffer", 5),
            ("blur_kernel", 1),
            ("sum_kernel", 2),
            ("shade_kernel", 2),
            ("copy", 1),
            // Codes and tables clamped to their textures; translucent shadow maps as above.
            ("shade_transfer", 3),
            ("shade_coat", 1),
            // Taps clamped to what the maps hold; levels of the pyramid to what is left of it.
            ("linsss_gbuffer", 4),
            ("linsss_blur", 3),
            ("linsss_reduce", 1),
            ("linsss_lookup", 4),
            ("shade_linsss", 4),
            // Words of a file, clamped to the last; lists at the texel of the target. Pixels of images clamped to their size,
            // tiles and layers to those of the texture.
            ("btf_query, Btf(Nested)", 4),
            ("btf_query, Btf(Images)", 4),
            ("shade_btf, LitBtf(Nested, true)", 2),
            ("shade_btf, LitBtf(Nested, false)", 2),
            ("shade_btf, LitBtf(Images, true)", 2),
            ("shade_btf, LitBtf(Images, false)", 2),
        ]
    );
}

#[test]
fn limits_of_webgl2_are_kept() {
    for (name, text) in &all() {
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
    for (name, text) in &all() {
        for function in functions(&parse(name, text)) {
            assert!(depth(&function.body) <= 3, "{name}: {:?}", function.name);
        }
    }
}
