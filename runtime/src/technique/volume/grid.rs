//! Size of a light volume: which Gaussians spread in it, and how fine its cells are.

use glam::{IVec3, Vec3};

/// Edge of a cell in standard deviations of the narrowest Gaussian that spreads in the volume: as fine as is of use, and as coarse as
/// may be.
const FINEST: f32 = 0.9;
const COARSEST: f32 = 1.1;
/// Variance of the splines by which light comes into the cells and is read from them, together, in cells squared.
const OF_SPLINES: f32 = 0.5;
/// Sizes of cells that are tried between the two.
const TRIES: usize = 5;
/// Width of what the cells have around the box, in standard deviations of the widest Gaussian but one: what it spreads out there is
/// what the widest brings back.
const MARGIN: f32 = 1.25;

/// Cells of a volume.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Grid {
    /// Number of the first Gaussian that spreads in it, at least 1.
    pub(super) first: usize,
    /// Middle of the first cell in mm.
    pub(super) origin_mm: Vec3,
    /// Edge of a cell in mm.
    pub(super) cell_mm: f32,
    /// Number of cells along each axis, at least 4: one at least more than the box has on both sides.
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
        let last = sigmas_mm.len().saturating_sub(1);
        sigmas_mm.iter().enumerate().skip(1).find_map(|(first, sigma_mm)| {
            (0..TRIES).find_map(|k| {
                #[allow(clippy::cast_precision_loss, reason = "a handful")]
                let cell_mm = sigma_mm * (FINEST + (COARSEST - FINEST) * k as f32 / (TRIES - 1) as f32);
                let spread_mm = if first < last { sigmas_mm[last - 1] } else { 0.0 };
                let margin = (MARGIN * spread_mm / cell_mm).round().max(1.0);
                let (cells, columns) = fitting(extent / cell_mm, margin, texels)?;
                // In the middle of what the cells cover.
                let origin_mm = 0.5 * (low + high) - 0.5 * cell_mm * (cells - 1).as_vec3();
                Some(Self { first, origin_mm, cell_mm, cells, columns })
            })
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

/// Number of cells along each axis for a box of so many with a margin on both sides, and slices in a row of the texture; `None` if they
/// do not fit.
fn fitting(extent: Vec3, margin: f32, texels: [u32; 2]) -> Option<(IVec3, i32)> {
    let [width, height] = texels.map(|side| i32::try_from(side).unwrap_or(i32::MAX));
    let cells = (extent.max(Vec3::ONE).ceil() + 2.0 * margin + 1.0).as_ivec3();
    let [columns, rows] = [width / cells.x, height / cells.y];
    (columns.saturating_mul(rows) >= cells.z).then_some((cells, columns))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::technique::volume::TEXELS;

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
            assert!((FINEST - 1e-4..=COARSEST + 1e-4).contains(&(cell_mm / sigma_mm)), "{extent}: {cell_mm}");
            let slices_before = cells.z - 1;
            let last = (cells.x * (slices_before % columns + 1), cells.y * (slices_before / columns + 1));
            assert!(last.0 <= 256 && last.1 <= 256, "{extent}: {last:?}");
        }
    }

    #[test]
    fn margins_hold_what_the_widest_gaussian_brings_back() {
        let sigmas_mm = [0.3, 0.75, 1.9, 4.8];
        let extent = Vec3::new(20.0, 20.0, 0.0);
        let Grid { origin_mm, cell_mm, cells, .. } = grid(extent, &sigmas_mm).unwrap();
        let end = origin_mm + cell_mm * (cells - 1).as_vec3();
        assert!((end - 0.5 * extent).min_element() > 1.9 && (0.5 * -extent - origin_mm).min_element() > 1.9, "{cells}");
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
