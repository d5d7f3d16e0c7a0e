//! Whole apparent BRDFs in coordinates whose distances are those of what was measured.

use nalgebra::DMatrix;

use crate::btf::Survey;

/// All three channels of all texels.
pub(super) struct Whole<'a> {
    survey: &'a Survey,
    /// `[coordinate × texel]`; squared distances are sums of w² err² over pairs and channels.
    pub(super) texels: DMatrix<f32>,
    /// The survey's numbers (u, ρ_a u, ρ_b u, v) from coordinates.
    survey_from_texels: DMatrix<f32>,
}

impl<'a> Whole<'a> {
    pub(super) fn new(survey: &'a Survey) -> Self {
        let (luma, chroma) = (survey.luma.texels.nrows(), survey.chroma.texels.nrows());
        let (texels, all) = (survey.texels(), 3 * luma + chroma);
        let numbers = DMatrix::from_fn(all, texels, |row, texel| match row / luma {
            0 => survey.luma.texels[(row, texel)],
            channel @ 1..=2 => survey.ratios[texel][channel - 1] * survey.luma.texels[(row % luma, texel)],
            _ => survey.chroma.texels[(row - 3 * luma, texel)],
        });
        // Products of all functions: B of luma in each channel, and Q of chroma in both of its own.
        let mut products = DMatrix::identity(all, all);
        for channel in 0..2 {
            let cross = survey.luma.basis.tr_mul(&survey.chroma_basis(channel));
            products.view_mut(((1 + channel) * luma, 3 * luma), (luma, chroma)).copy_from(&cross);
            products.view_mut((3 * luma, (1 + channel) * luma), (chroma, luma)).copy_from(&cross.transpose());
        }
        // Chroma may lie in what luma spans: no more than rounding leaves is added.
        products += DMatrix::identity(all, all) * 1e-4;
        let lower = products.cholesky().expect("it is positive: a ridge was added").l();
        let inverse = lower.solve_lower_triangular(&DMatrix::identity(all, all)).expect("its diagonal is positive");
        Self { survey, texels: lower.tr_mul(&numbers), survey_from_texels: inverse.transpose() }
    }

    /// Values `[3 · pair + channel × function]` of functions given by coordinates.
    pub(super) fn functions(&self, coordinates: &DMatrix<f32>) -> DMatrix<f32> {
        let numbers = &self.survey_from_texels * coordinates;
        let (luma, chroma) = (self.survey.luma.texels.nrows(), self.survey.chroma.texels.nrows());
        let of_luma = [0, 1, 2].map(|channel| &self.survey.luma.basis * numbers.rows(channel * luma, luma));
        let of_chroma = &self.survey.chroma.basis * numbers.rows(3 * luma, chroma);
        DMatrix::from_fn(3 * self.survey.weights.len(), coordinates.ncols(), |row, function| {
            let (pair, channel) = (row / 3, row % 3);
            let rest = if channel == 0 { 0.0 } else { of_chroma[(2 * pair + channel - 1, function)] };
            (of_luma[channel][(pair, function)] + rest) / self.survey.weights[pair]
        })
    }
}
