//! The table of passes against the WGSL files, and the list of twins against the files on the CPU.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use naga::{AddressSpace, ImageClass, ImageDimension, Module, ScalarKind, ShaderStage, TypeInner};
use subsurf_shaders::TargetFormat;
use subsurf_shaders::passes::{ALL, Binding, Variant};

/// A file or folder of the crate.
fn at(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// A WGSL file, with its comments.
fn source(path: &str) -> String {
    std::fs::read_to_string(at("wgsl").join(path).with_extension("wgsl")).unwrap()
}

/// Paths of all files under a folder with an extension, relative to it and without the extension.
fn files_under(folder: &str, extension: &str) -> BTreeSet<String> {
    let mut files = BTreeSet::new();
    let mut folders = vec![at(folder)];
    while let Some(next) = folders.pop() {
        for entry in std::fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|found| found == extension) {
                let relative = path.strip_prefix(at(folder)).unwrap().with_extension("");
                files.insert(relative.to_str().unwrap().replace('\\', "/"));
            }
        }
    }
    files
}

/// Every variant of every pass, with its target formats.
fn variants() -> impl Iterator<Item = (Variant, TargetFormat)> {
    let variants = ALL.into_iter().flat_map(|pass| pass.variants());
    variants.flat_map(|variant| TargetFormat::ALL.map(|target| (variant, target)))
}

fn parse(variant: Variant, target: TargetFormat) -> Module {
    let text = variant.wgsl(target);
    naga::front::wgsl::parse_str(&text)
        .unwrap_or_else(|error| panic!("{}: {}", variant.name(), error.emit_to_string(&text)))
}

#[test]
fn every_file_belongs_to_a_pass_and_says_what_it_is() {
    let files: Vec<_> = variants().flat_map(|(variant, target)| variant.files(target)).collect();
    let used: BTreeSet<String> = files.iter().map(|file| file.path.to_owned()).collect();
    assert_eq!(used, files_under("wgsl", "wgsl"), "files that passes use, and files that there are");
    let mut paths = BTreeMap::new();
    for file in files {
        let before = paths.insert(file.stem(), file.path);
        assert!(before.is_none_or(|before| before == file.path), "two files called {}", file.stem());
        let source = source(file.path);
        assert!(source.starts_with("// "), "{}: the first line says what it is", file.path);
        assert!(source.ends_with('\n'), "{}: the last line ends", file.path);
        // `build.rs` takes comments out line by line, from `//` on; it knows no others, and no strings.
        assert!(!file.text.contains("/*"), "{}: a comment that `//` does not begin", file.path);
        assert!(!file.text.contains('"'), "{}: a string, in which `//` would begin no comment", file.path);
    }
}

#[test]
fn first_lines_of_passes_name_their_parts() {
    let folder: BTreeSet<String> = files_under("wgsl/pass", "wgsl");
    let rows: BTreeSet<String> =
        ALL.iter().map(|pass| pass.file.path.strip_prefix("pass/").unwrap().to_owned()).collect();
    assert_eq!(rows, folder, "one row for each file of a pass");
    assert_eq!(rows.len(), ALL.len(), "one file for each row");
    for pass in ALL {
        let parts: Vec<&str> = pass.parts.iter().map(|part| part.name()).collect();
        let source = source(pass.file.path);
        assert_eq!(source.lines().next().unwrap(), format!("// Needs: {}.", parts.join(", ")), "{}", pass.name());
    }
}

#[test]
fn entry_points_and_overrides_are_those_of_the_table() {
    for (variant, target) in variants() {
        let (name, pass, module) = (variant.name(), variant.pass, parse(variant, target));
        let found: BTreeSet<(&str, bool)> =
            module.entry_points.iter().map(|entry| (&entry.name[..], entry.stage == ShaderStage::Vertex)).collect();
        assert_eq!(found, BTreeSet::from([(pass.vertex, true), (pass.name(), false)]), "{name}");
        let stages: Vec<ShaderStage> = module.entry_points.iter().map(|entry| entry.stage).collect();
        assert!(!stages.contains(&ShaderStage::Compute) && stages.len() == 2, "{name}: {stages:?}");
        let overrides: Vec<&str> = module.overrides.iter().map(|(_, found)| found.name.as_deref().unwrap()).collect();
        assert_eq!(overrides, pass.overrides, "{name}");
        for (_, found) in module.overrides.iter() {
            let kind = module.types[found.ty].inner.scalar_kind();
            assert_eq!(kind, Some(ScalarKind::Bool), "{name}: {:?}", found.name);
        }
    }
}

/// Whether a global variable is a resource of a kind.
fn is(space: AddressSpace, inner: &TypeInner, binding: Binding, target: TargetFormat) -> bool {
    let texture = |wanted: ScalarKind, layers: bool| match inner {
        TypeInner::Image { dim: ImageDimension::D2, arrayed, class: ImageClass::Sampled { kind, multi: false } } => {
            *kind == wanted && *arrayed == layers
        }
        _ => false,
    };
    let of_target = match target {
        TargetFormat::Half => ScalarKind::Float,
        TargetFormat::Packed => ScalarKind::Uint,
    };
    match binding {
        Binding::Uniform | Binding::Object => {
            space == AddressSpace::Uniform && matches!(inner, TypeInner::Struct { .. })
        }
        Binding::Float | Binding::Filtered => texture(ScalarKind::Float, false),
        Binding::FloatLayers | Binding::FilteredLayers => texture(ScalarKind::Float, true),
        Binding::Target => texture(of_target, false),
        Binding::TargetLayers => texture(of_target, true),
        Binding::Uint => texture(ScalarKind::Uint, false),
        Binding::UintLayers => texture(ScalarKind::Uint, true),
        Binding::Sampler | Binding::Nearest => matches!(inner, TypeInner::Sampler { comparison: false }),
    }
}

#[test]
fn bindings_are_those_of_the_table() {
    for (variant, target) in variants() {
        let (name, module, groups) = (variant.name(), parse(variant, target), variant.groups());
        let mut left: BTreeSet<(usize, usize)> =
            groups.iter().enumerate().flat_map(|(group, all)| (0..all.len()).map(move |k| (group, k))).collect();
        for (_, global) in module.global_variables.iter() {
            let Some(place) = &global.binding else {
                assert_eq!(global.space, AddressSpace::Private, "{name}: {:?}", global.name);
                continue;
            };
            let place = (place.group as usize, place.binding as usize);
            assert!(left.remove(&place), "{name}: {:?} at {place:?}", global.name);
            let binding = groups[place.0][place.1];
            let inner = &module.types[global.ty].inner;
            assert!(is(global.space, inner, binding, target), "{name}: {:?} is no {binding:?}", global.name);
        }
        // All pictures of meshes share a bind group; exitance of vertices has the visibility of lights with it.
        let unused = if variant.pass.name() == "shade_vertex" { BTreeSet::from([(0, 1)]) } else { BTreeSet::new() };
        assert_eq!(left, unused, "{name}: bindings of the table that no variable has");
    }
}

#[test]
fn passes_have_a_twin_or_the_crate_says_why_not() {
    let lib = std::fs::read_to_string(at("src/lib.rs")).unwrap();
    let listed = lib.lines().filter(|line| line.starts_with("//! * `"));
    let excused: Vec<&str> = listed.flat_map(|line| line.split('`').skip(1).step_by(2)).collect();
    let twins = files_under("src/cpu", "rs");
    let (with, without): (Vec<&str>, Vec<&str>) =
        ALL.iter().map(|pass| pass.name()).partition(|name| twins.contains(*name));
    let sorted = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<BTreeSet<String>>();
    assert_eq!(sorted(&excused), sorted(&without), "passes without a twin: the crate's text, and the files");
    assert_eq!(excused.len(), without.len(), "listed once");
    assert!(!with.is_empty(), "some have one");
}
