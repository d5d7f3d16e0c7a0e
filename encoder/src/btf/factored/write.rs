//! The file of factors, through the decoder's own layout.

use subsurf_decoder::Section;
use subsurf_decoder::btf::factored::layout::{CodewordStage, MAX_STAGES, TuckerShape};
use subsurf_decoder::btf::{BtfHeader, Material};

use super::angles::Tucker;
use super::streams::{codewords, core};
use super::texels::Quantised;
use crate::file::container;

/// Contents of a file.
pub(super) struct Contents<'a> {
    pub(super) header: BtfHeader,
    pub(super) materials: &'a [Material],
    /// Components of luma and of chroma.
    pub(super) components: [usize; 2],
    pub(super) tucker: &'a Tucker,
    pub(super) texels: &'a Quantised,
    /// ρ of a step of its coefficients.
    pub(super) ratio_steps: [f32; 2],
    /// Value of a step of a coefficient times a step of a table, by columns.
    pub(super) factors: &'a [f32],
}

fn byte(number: usize) -> u8 {
    u8::try_from(number).expect("options were checked")
}

impl Contents<'_> {
    pub(super) fn to_bytes(&self) -> Vec<u8> {
        let mut stages = [CodewordStage::default(); MAX_STAGES];
        for (stage, words) in stages.iter_mut().zip(&self.texels.words) {
            *stage = CodewordStage {
                words: u16::try_from(words.ncols()).expect("at most 256"),
                first: 0,
                count: byte(words.nrows()),
            };
        }
        let [view_scales, light_scales] = &self.tucker.scales;
        let shape = TuckerShape {
            luma: byte(self.components[0]),
            chroma: byte(self.components[1]),
            view_axes: byte(view_scales.len()),
            light_axes: byte(light_scales.len()),
            stages,
            count: byte(self.texels.words.len()),
        };
        // Steps of the core in steps of the table.
        let core_steps: Vec<f32> =
            self.tucker.core_steps.iter().zip(&self.tucker.steps).map(|(core, table)| core / table).collect();
        let floats = [&self.ratio_steps[..], self.factors, &core_steps, view_scales, light_scales];
        let factors: Vec<u8> =
            shape.to_bytes().chain(floats.into_iter().flatten().flat_map(|value| value.to_le_bytes())).collect();
        let axes: Vec<u8> = self.tucker.axes.iter().flatten().map(|value| value.to_le_bytes()[0]).collect();
        let materials: Vec<u8> = self.materials.iter().flat_map(Material::to_bytes).collect();
        let (core, words) = (core(&self.tucker.core, light_scales.len()), codewords(&self.texels.words));
        container::write([
            (Section::BtfHeader, &self.header.to_bytes()[..]),
            (Section::Materials, &materials),
            (Section::TuckerHeader, &factors),
            (Section::Axes, &axes),
            (Section::Core, &core),
            (Section::Codewords, &words),
            (Section::TexelIndices, &self.texels.indices),
        ])
    }
}
