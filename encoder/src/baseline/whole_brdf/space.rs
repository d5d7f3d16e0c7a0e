//! Whole apparent BRDFs in coordinates whose distances are those of what was measured.

use nalgebra::DMatrix;

use crate::btf::TruncatedSvd;

/// All three channels of all texels.
pub(super) struct Whole<'a> {
    svd: &'a TruncatedSvd,
    /// `[coordinate × texel]`; squared distances are sums of w² err² over pairs and channels.
    pub(super) texels: DMatrix<f32>,
    /// Matrix from coordinates to the decomposition's numbers (u, ρ_a u, ρ_b u, v).
    svd_from_texels: DMatrix<f32>,
}

impl<'a> Whole<'a> {
    pub(super) fn new(svd: &'a TruncatedSvd) -> Self {
        let (luma, chroma) = (svd.luma.texels.nrows(), svd.chroma.texels.nrows());
        let (texels, all) = (svd.texels(), 3 * luma + chroma);
        let numbers = DMatrix::from_fn(all, texels, |row, texel| match row / luma {
            0 => svd.luma.texels[(row, texel)],
            channel @ 1..=2 => svd.ratios[texel][channel - 1] * svd.luma.texels[(row % luma, texel)],
            _ => svd.chroma.texels[(row - 3 * luma, texel)],
        });
        // Products of all functions: B of luma in each channel, and Q of chroma in both of its own.
        let mut products = DMatrix::identity(all, all);
        for channel in 0..2 {
            let cross = svd.luma.basis.tr_mul(&svd.chroma_basis(channel));
            products.view_mut(((1 + channel) * luma, 3 * luma), (luma, chroma)).copy_from(&cross);
            products.view_mut((3 * luma, (1 + channel) * luma), (chroma, luma)).copy_from(&cross.transpose());
        }
        // Chroma may lie in what luma spans: no more than rounding leaves is added.
        products += DMatrix::identity(all, all) * 1e-4;
        let lower = products.cholesky().expect("it is positive: a ridge was added").l();
        let inverse = lower.solve_lower_triangular(&DMatrix::identity(all, all)).expect("its diagonal is positive");
        Self { svd, texels: lower.tr_mul(&numbers), svd_from_texels: inverse.transpose() }
    }

    /// Values `[3 · pair + channel × function]` of functions given by coordinates.
    pub(super) fn functions(&self, coordinates: &DMatrix<f32>) -> DMatrix<f32> {
        let numbers = &self.svd_from_texels * coordinates;
        let (luma, chroma) = (self.svd.luma.texels.nrows(), self.svd.chroma.texels.nrows());
        let of_luma = [0, 1, 2].map(|channel| &self.svd.luma.basis * numbers.rows(channel * luma, luma));
        let of_chroma = &self.svd.chroma.basis * numbers.rows(3 * luma, chroma);
        DMatrix::from_fn(3 * self.svd.weights.len(), coordinates.ncols(), |row, function| {
            let (pair, channel) = (row / 3, row % 3);
            let rest = if channel == 0 { 0.0 } else { of_chroma[(2 * pair + channel - 1, function)] };
            (of_luma[channel][(pair, function)] + rest) / self.svd.weights[pair]
        })
    }
}
