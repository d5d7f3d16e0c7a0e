//! Nested codebooks of BTFs at random.

use subsurf_decoder::btf::NAME_BYTES;
use subsurf_decoder::btf::nested::layout::Scales;
use subsurf_decoder::btf::{BtfHeader, BtfModel, ColourEncoding, Grid, Material};

use super::unit;
use crate::btf::nested::{Chain, Chroma, Database, Item, slice_mean};

/// Sizes of a random BTF.
#[derive(Clone, Debug)]
pub struct NestedShape {
    /// Nodes of directions.
    pub grid: Grid,
    /// Encoding of the three channels.
    pub tone: ColourEncoding,
    /// Width, height and mipmap levels of the materials.
    pub materials: Vec<(u16, u16, u8)>,
    /// Additive stages of luma, 1 to 4.
    pub stages: usize,
    /// Entries of P4, P3, P2 and P1, in every stage.
    pub luma: [u32; 4],
    /// Entries of M, I2, I1 and C.
    pub chroma: [u32; 4],
    /// Entries of tints, 0 for none.
    pub tints: u32,
    /// Whether chroma is divided by luma.
    pub is_relative: bool,
    /// Bits of the code of a scale.
    pub scale_bits: u8,
}

impl NestedShape {
    /// About 200 kB: one material of 128 × 128 texels and the paper's grid.
    #[must_use]
    pub fn typical() -> Self {
        Self {
            grid: Grid::PAPER,
            tone: ColourEncoding::Display { white: 1.0 },
            materials: vec![(128, 128, 1)],
            stages: 1,
            luma: [1024, 2048, 4096, 1024],
            chroma: [4096, 64, 64, 64],
            tints: 0,
            is_relative: false,
            scale_bits: 7,
        }
    }

    /// Few entries of everything, for tests that go through all of them.
    #[must_use]
    pub fn small() -> Self {
        let grid = Grid { n_alpha: 5, n_beta: 4, n_theta: 3, n_phi: 4, ..Grid::PAPER };
        Self {
            grid,
            materials: vec![(3, 2, 1)],
            luma: [3, 5, 6, 7],
            chroma: [7, 3, 2, 4],
            scale_bits: 4,
            ..Self::typical()
        }
    }

    /// Random codebooks that depend on `seed` alone: indices are spread evenly, slices have one lobe.
    ///
    /// # Panics
    /// If sizes are not those of a file.
    #[must_use]
    pub fn database(&self, seed: u32) -> Database {
        let mut numbers = Numbers(seed.wrapping_mul(0x9E37_79B9));
        let materials: Vec<Material> = self.materials.iter().zip(0_u8..).map(|(size, k)| material(*size, k)).collect();
        let texels = materials.iter().map(|material| material.texels(u8::MAX)).sum();
        let stages: Vec<Chain> = (0..self.stages).map(|stage| self.chain(stage, texels, &mut numbers)).collect();
        let [merged, i2, i1, colours] = self.chroma;
        let [.., p2, _] = self.luma;
        let pairs = (0..merged).map(|_| [numbers.below(p2), numbers.below(i2)]).collect();
        let rows = |entries: u32, nodes: u8, len: u32, numbers: &mut Numbers| {
            (0..entries * u32::from(nodes)).map(|_| numbers.below(len)).collect()
        };
        let codes =
            |entries: u32, numbers: &mut Numbers| (0..entries).map(|_| [numbers.byte(), numbers.byte()]).collect();
        let (first, step) = match self.tone {
            ColourEncoding::Display { .. } => ([-0.05; 2], [0.000_4; 2]),
            ColourEncoding::LogLuv { .. } => ([0.15, 0.42], [0.000_5; 2]),
        };
        let chroma = Chroma {
            merged: pairs,
            i2: rows(i2, self.grid.n_alpha, i1, &mut numbers),
            i1: rows(i1, self.grid.n_beta, colours, &mut numbers),
            colours: codes(colours, &mut numbers),
            tints: codes(self.tints, &mut numbers),
            texel_tints: if self.tints > 0 { rows(texels, 1, self.tints, &mut numbers) } else { Vec::new() },
            first,
            step,
            is_relative: self.is_relative,
        };
        let materials_count = u8::try_from(materials.len()).expect("at most 255 materials");
        let header = BtfHeader {
            model: BtfModel::Nested,
            encoding: self.tone,
            materials: materials_count,
            grid: self.grid,
            texel_mm: None,
        };
        Database { header, materials, stages, chroma }
    }

    fn chain(&self, stage: usize, texels: u32, numbers: &mut Numbers) -> Chain {
        let grid = &self.grid;
        let is_signed = stage > 0;
        let [p4, p3, p2, p1] = self.luma;
        let [merged, ..] = self.chroma;
        // Scales are spread around 1; those of texels around 1/2, or 1/4 of logarithms, or 1/16 in later stages.
        let bits = self.scale_bits.saturating_sub(is_signed.into());
        let step = u8::from(bits <= 8);
        let last = ((1_i16 << bits) - 1) << step;
        let middle = match self.tone {
            _ if is_signed => -256,
            ColourEncoding::Display { .. } => -64,
            ColourEncoding::LogLuv { .. } => -128,
        };
        let scales = [middle, 0, 0, 0];
        let scales = scales.map(|middle| Scales { bits: self.scale_bits, step, offset: middle - last / 2 });
        let mut items = |entries: u32, nodes: u8, len: u32| {
            // The middle half of the codes, at most an octave up and down.
            let (all, sign) = (1_u32 << bits, u32::from(is_signed) << bits);
            let reach = (all / 4).min(64 >> step);
            let code = |numbers: &mut Numbers| (all / 2 - reach + numbers.below(2 * reach + 1)).min(all - 1);
            let item = |_| Item {
                index: numbers.below(len),
                code: code(numbers) | if numbers.below(2) == 1 { sign } else { 0 },
            };
            (0..entries * u32::from(nodes)).map(item).collect()
        };
        let below_p3 = if stage == 0 { merged } else { p2 };
        Chain {
            texels: items(texels, 1, p4),
            p4: items(p4, grid.n_phi, p3),
            p3: items(p3, grid.n_theta, below_p3),
            p2: items(p2, grid.n_alpha, p1),
            p1: (0..p1).flat_map(|_| slice(grid.n_beta, is_signed, numbers)).collect(),
            scales,
            is_signed,
        }
    }
}

/// Values of a slice, of which the largest is 255, and their mean; signed ones have alternating lobes.
fn slice(n_beta: u8, is_signed: bool, numbers: &mut Numbers) -> Vec<u8> {
    let (centre, width) = (2.0 * numbers.unit() - 1.0, 0.2 + numbers.unit());
    let value = |k: u8| {
        let s = 2.0 * f32::from(k) / f32::from(n_beta - 1) - 1.0;
        let lobe = 1.0 / (1.0 + ((s - centre) / width).powi(2));
        if is_signed { lobe * (6.0 * s).cos() } else { lobe }
    };
    let largest = (0..n_beta).map(|k| value(k).abs()).fold(0.0, f32::max);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 255, or 127 with a sign")]
    let code = |value: f32| {
        if is_signed { (127.0 * value / largest).round() as i8 as u8 } else { (255.0 * value / largest).round() as u8 }
    };
    let mut values: Vec<u8> = (0..n_beta).map(|k| code(value(k))).collect();
    values.push(if is_signed { 0 } else { slice_mean(&values) });
    values
}

fn material((width, height, levels): (u16, u16, u8), number: u8) -> Material {
    let mut name = [0; NAME_BYTES];
    name[..7].copy_from_slice(b"random ");
    name[7] = b'a' + number % 26;
    Material { name, width, height, levels }
}

/// Sequence of numbers that look random and depend on its start alone.
struct Numbers(u32);

impl Numbers {
    /// The next number, 0 to 1.
    fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(1);
        unit(self.0)
    }

    /// The next number, 0 to below `len`.
    fn below(&mut self, len: u32) -> u32 {
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            clippy::cast_precision_loss,
            reason = "at most 2²⁴"
        )]
        let number = (self.unit() * len as f32) as u32;
        number.min(len - 1)
    }

    fn byte(&mut self) -> u8 {
        self.below(256).to_le_bytes()[0]
    }
}
