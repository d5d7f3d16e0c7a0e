//! Nested BTFs: what their blocks lead shaders to, and pictures of the ball.

use subsurf_decoder::NestedBtf;
use subsurf_scene::Placement;
use subsurf_shaders::cpu::{BtfSurface, BtfTriangles, shade_btf};
use subsurf_shaders::uniform::{BtfCodebooks, BtfFiltering, BtfTable, BtfTexture, MAX_LEVELS};

use crate::stage::{BACKGROUND, SIZE, stage};

/// Samples of the environment for a pixel.
const SAMPLES: u32 = 2;

/// All that is made of a nested BTF.
///
/// # Panics
/// If blocks lead outside the file.
pub fn nested_btf(btf: &NestedBtf<'_>) {
    let books = BtfCodebooks::of(btf).expect("a file of a few kB");
    let bits = 8 * btf.file().len() as u64;
    assert!(u64::from(books.last_word) * 32 < bits && (u64::from(books.last_word) + 1) * 32 >= bits, "the last word");
    for stage in 0..books.stages as usize {
        for table in &books.chains[4 * stage..][..4] {
            lies_within(table, bits);
        }
        for start in [books.p2_bytes[stage], books.p1[stage]] {
            assert!(start > 0 && u64::from(start) < bits, "{start} of {bits} bits");
        }
    }
    for table in [&books.merged, &books.i2, &books.i1] {
        lies_within(table, bits);
    }
    assert!(books.octaves.is_finite() && books.white.is_finite(), "{books:?}");
    for number in 0..btf.materials().count() {
        let texture = BtfTexture::of(btf, number).expect("a material");
        assert!((1..=MAX_LEVELS).contains(&(texture.count as usize)), "{} levels", texture.count);
        let [first, width, height, _] = texture.levels[texture.count as usize - 1];
        assert!(first + width * height <= texels_within(&books.chains[0], bits), "the coarsest level");
        for filtering in [BtfFiltering::Nearest, BtfFiltering::Trilinear] {
            ball(&BtfSurface { btf, material: number, filtering, samples: SAMPLES });
        }
    }
    assert!(BtfTexture::of(btf, btf.materials().count()).is_none(), "no more materials");
}

/// Rows of a table that fit behind its start.
fn texels_within(table: &BtfTable, bits: u64) -> u32 {
    let rows = (bits - u64::from(table.start)) / u64::from(table.row_bits.max(1));
    u32::try_from(rows).unwrap_or(u32::MAX)
}

/// A row at least lies in the file, and masks are what the bits of an item hold.
fn lies_within(table: &BtfTable, bits: u64) {
    assert!(u64::from(table.start) + u64::from(table.row_bits) <= bits, "{table:?} in {bits} bits");
    assert!(table.width <= 32 && table.sign_at + table.index_bits + table.sign_mask <= 32, "{table:?}");
}

/// Picture of the ball.
fn ball(surface: &BtfSurface<'_>) {
    let stage = stage();
    let blocks = stage.blocks(&Placement::of_btf(&stage.mesh, [2.0, 1.0]));
    let triangles = BtfTriangles {
        positions: &stage.mesh.positions,
        normals: &stage.mesh.normals,
        uvs: stage.mesh.uvs.as_ref().expect("a ball has texture coordinates"),
        tangents: &stage.tangents,
        visibilities: &stage.visibilities,
        triangles: &stage.mesh.triangles,
    };
    let picture = shade_btf(&triangles, surface, &blocks.scene, &stage.reflections(), SIZE, BACKGROUND);
    assert!(picture.iter().any(|pixel| *pixel != BACKGROUND), "the ball is in the picture");
}
