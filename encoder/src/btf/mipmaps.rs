//! Mipmaps: coarser levels of coefficients of texels.

use nalgebra::DMatrix;

/// For every texel of every level of every material, in the order of a file, the texels of full size that it covers.
pub(crate) struct Mipmaps(Vec<Vec<u32>>);

impl Mipmaps {
    /// Of materials of these sizes, whose texels follow each other; full size alone without `has_levels`.
    pub(crate) fn new(sizes: &[[u32; 2]], has_levels: bool) -> Self {
        let mut covered = Vec::new();
        let mut start = 0;
        for &[width, height] in sizes {
            let levels = if has_levels { 1 + width.max(height).ilog2() } else { 1 };
            for level in 0..levels {
                let [columns, rows] = [width, height].map(|side| (side >> level).max(1));
                // Sides that are not powers of two: the last texel of a level covers what is left.
                let range = |at: u32, count: u32, side: u32| at * side / count..(at + 1) * side / count;
                for (y, x) in (0..rows).flat_map(|y| (0..columns).map(move |x| (y, x))) {
                    let of_row = |y: u32| range(x, columns, width).map(move |x| start + y * width + x);
                    covered.push(range(y, rows, height).flat_map(of_row).collect());
                }
            }
            start += width * height;
        }
        Self(covered)
    }

    /// For every texel of every level, the texels of full size that it covers.
    pub(crate) fn covered(&self) -> &[Vec<u32>] {
        &self.0
    }

    /// Means of columns over the texels that each texel of a level covers.
    pub(crate) fn of(&self, texels: &DMatrix<f32>) -> DMatrix<f32> {
        let mut all = DMatrix::zeros(texels.nrows(), self.0.len());
        for (mut mean, covered) in all.column_iter_mut().zip(&self.0) {
            for texel in covered {
                mean += texels.column(*texel as usize);
            }
            mean /= covered.len() as f32;
        }
        all
    }

    /// Means of ratios by the energy of luma: what is bright has its colour seen.
    pub(crate) fn of_ratios(&self, ratios: &[[f32; 2]], luma: &DMatrix<f32>) -> Vec<[f32; 2]> {
        let energy = |texel: u32| luma.column(texel as usize).norm_squared();
        let mean = |covered: &Vec<u32>| {
            let weights: Vec<f32> = covered.iter().map(|texel| energy(*texel).max(f32::MIN_POSITIVE)).collect();
            let total: f32 = weights.iter().sum();
            [0, 1].map(|c: usize| {
                let weighed = covered.iter().zip(&weights).map(|(texel, weight)| weight * ratios[*texel as usize][c]);
                weighed.sum::<f32>() / total
            })
        };
        self.0.iter().map(mean).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_cover_all_texels() {
        let mipmaps = Mipmaps::new(&[[5, 3], [2, 2]], true);
        let ends = [15, 15 + 2, 15 + 2 + 1, 18 + 4, 18 + 4 + 1];
        assert_eq!(mipmaps.0.len(), ends[4]);
        for range in [15..17, 17..18, 22..23] {
            let mut all: Vec<u32> = mipmaps.0[range].concat();
            all.sort_unstable();
            assert!(all.is_sorted_by(|a, b| a + 1 == *b), "each once: {all:?}");
        }
        let texels = DMatrix::from_fn(1, 19, |_, k| k as f32);
        assert!((mipmaps.of(&texels)[17] - 7.0).abs() < 1e-5, "the mean of 0 to 14");
    }
}
