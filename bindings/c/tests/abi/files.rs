//! Files that the C programs open: conformance vectors, and synthetic ones of the families that have none.

use std::path::{Path, PathBuf};

use subsurf_decoder::bssrdf::Addressing;
use subsurf_encoder::synthetic::{NestedShape, Shape, factored};

/// Vectors of BSSRDFs that have to be read, one for each layout of planes.
const VECTORS: [&str; 8] = [
    "bmpp_mirror",
    "small_ratios",
    "palette",
    "half_profiles",
    "one_base",
    "one_of_300_bases",
    "five_bases",
    "per_pixel_clamp",
];

/// Folder of the conformance vectors.
fn vectors() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/vectors")
}

/// The example of FORMAT.md, of 216 bytes.
pub(crate) fn bssrdf() -> PathBuf {
    vectors().join("format_example.subsurf")
}

/// Nested and factored BTF, written into a folder.
pub(crate) fn btfs(folder: &Path) -> [PathBuf; 2] {
    let nested = NestedShape { materials: vec![(3, 2, 2), (2, 2, 1)], ..NestedShape::small() }.database(3).to_bytes();
    [("nested.subsurf", nested), ("factored.subsurf", factored(1))].map(|(name, bytes)| {
        let path = folder.join(name);
        std::fs::write(&path, bytes).expect("a temporary folder can be written to");
        path
    })
}

/// One file of every kind.
pub(crate) fn all(folder: &Path) -> Vec<PathBuf> {
    let vectors = VECTORS.map(|name| vectors().join(name).with_extension("subsurf"));
    vectors.into_iter().chain(btfs(folder)).collect()
}

/// Bytes before a file in an archive: no whole pages, as `check.c` has it.
pub(crate) const ASSET_OFFSET: usize = 5001;

/// Archive with a file in it as it is, and other bytes around.
pub(crate) fn asset(folder: &Path, bytes: &[u8]) -> PathBuf {
    let path = folder.join("asset");
    let archive = [&[b'-'; ASSET_OFFSET], bytes, &[b'-'; 300]].concat();
    std::fs::write(&path, archive).expect("a temporary folder can be written to");
    path
}

/// Archive with per-pixel profiles of 40 MB, and their length.
#[cfg(target_os = "linux")]
pub(crate) fn large_asset(folder: &Path) -> (PathBuf, usize) {
    let shape = Shape { size: [512; 2], radius: 3, samples: 13, base_materials: 1, addressing: Addressing::Clamp };
    let bytes = shape.per_pixel();
    (asset(folder, &bytes), bytes.len())
}
