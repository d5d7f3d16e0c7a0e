//! Size of a light volume: which Gaussians spread in it, and how fine its cells are.

use glam::{IVec3, Vec3};

/// Edge of a cell in standard deviations of the narrowest Gaussian that spreads in the volume: as fine as is of use, and as coarse as
/// may be.
const FINEST: f32 = 0.9;
const COARSEST: f32 = 1.1;
/// Variance of the splines by which light comes into the cells and is read from them, together, in cells squared.
const OF_SPLINES: f32 = 0.5;
/// How much coarser cells get until they fit.
const STEP: f32 = 1.05;

/// Cells of a volume.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Grid {
    /// Number of the first Gaussian that spreads in it, at least 1.
    pub(super) first: usize,
    /// Middle of the first cell in mm.
    pub(super) origin_mm: Vec3,
    /// Edge of a cell in mm.
    pub(super) cell_mm: f32,
    /// Number of cells along each axis, at least 4: one more than the box has on both sides.
    pub(super) cells: IVec3,
    /// Slices of equal z in a row of the texture.
    pub(super) columns: i32,
}

impl Grid {
    /// Cells over a box in mm, lowest and highest corner, for Gaussians of standard deviations in mm, narrowest first, in a texture of
    /// so many texels. The narrowest never spreads here; `None` where cells as fine as the widest needs do not fit.
    pub(super) fn new([low, high]: [Vec3; 2], sigmas_mm: &[f32], texels: [u32; 2]) -> Option<Self> {
        let extent = high - low;
        if !extent.is_finite() {
            return None;
        }
        sigmas_mm.iter().enumerate().skip(1).find_map(|(first, sigma_mm)| {
            let mut cell_mm = FINEST * sigma_mm;
            while cell_mm <= COARSEST * sigma_mm {
                if let Some((cells, columns)) = fitting(extent / cell_mm, texels) {
                    // In the middle of what the cells cover.
                    let origin_mm = 0.5 * (low + high) - 0.5 * cell_mm * (cells - 1).as_vec3();
                    return Some(Self { first, origin_mm, cell_mm, cells, columns });
                }
                cell_mm *= STEP;
            }
            None
        })
    }

    /// Width and height of what the cells take of the texture.
    pub(super) fn texels(&self) -> [u32; 2] {
        let rows = (self.cells.z + self.columns - 1) / self.columns;
        [self.columns * self.cells.x, rows * self.cells.y].map(|side| u32::try_from(side).unwrap_or(0))
    }

    /// Standard deviation in cells of what remains to be blurred of a Gaussian, of `sigma_mm`, that is the first.
    pub(super) fn first_sigma(&self, sigma_mm: f32) -> f32 {
        let cells = sigma_mm / self.cell_mm;
        (cells * cells - OF_SPLINES).sqrt()
    }
}

/// Number of cells along each axis for a box of so many, and slices in a row of the texture; `None` if they do not fit.
fn fitting(extent: Vec3, texels: [u32; 2]) -> Option<(IVec3, i32)> {
    let [width, height] = texels.map(|side| i32::try_from(side).unwrap_or(i32::MAX));
    let cells = extent.ceil().as_ivec3().max(IVec3::ONE).saturating_add(IVec3::splat(3));
    let [columns, rows] = [width / cells.x, height / cells.y];
    (columns.saturating_mul(rows) >= cells.z).then_some((cells, columns))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXELS: [u32; 2] = [256, 192];

    fn grid(extent: Vec3, sigmas_mm: &[f32]) -> Option<Grid> {
        Grid::new([-0.5 * extent, 0.5 * extent], sigmas_mm, TEXELS)
    }

    #[test]
    fn cells_hold_the_box_and_lie_in_the_texture() {
        for extent in [Vec3::splat(20.0), Vec3::new(40.0, 28.0, 25.0), Vec3::new(3.0, 90.0, 0.0), Vec3::splat(40.0)] {
            let Grid { first, origin_mm, cell_mm, cells, columns } = grid(extent, &[0.35, 0.98, 2.57]).unwrap();
            let end = origin_mm + cell_mm * (cells - 1).as_vec3();
            assert!(origin_mm.cmple(-0.5 * extent + 1e-4).all() && end.cmpge(0.5 * extent - 1e-4).all(), "{extent}");
            let sigma_mm = [0.35, 0.98, 2.57][first];
            assert!((FINEST * sigma_mm..=COARSEST * sigma_mm).contains(&cell_mm), "{extent}: {cell_mm}");
            let slices_before = cells.z - 1;
            let last = (cells.x * (slices_before % columns + 1), cells.y * (slices_before / columns + 1));
            assert!(last.0 <= 256 && last.1 <= 192, "{extent}: {last:?}");
        }
    }

    #[test]
    fn what_does_not_fit_stays_on_the_screen() {
        let first = |extent| grid(Vec3::splat(extent), &[0.35, 0.98, 2.57]).map(|grid| grid.first);
        assert_eq!([30.0, 60.0, 800.0].map(first), [Some(1), Some(2), None]);
        assert_eq!(grid(Vec3::splat(30.0), &[2.57]), None, "one Gaussian is the narrowest");
        assert_eq!(grid(Vec3::splat(f32::NAN), &[0.35, 0.98]), None);
        assert_eq!(grid(Vec3::splat(f32::INFINITY), &[0.35, 0.98]), None);
    }
}
