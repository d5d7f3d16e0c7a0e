//! Codebooks while they grow, and what their entries decode to.

use std::collections::BTreeMap;

use subsurf_decoder::btf::Grid;

use super::measure::{Decoded, Piece};
use super::rows::{Rows, Slices};

/// An entry of the codebook below, and a gain.
pub(super) type Scaled = (u32, f32);

/// All codebooks. Entries of P2, P3 and P4 have a mean luma near 1, the largest value of an entry of P1 is 1.
#[derive(Clone, Debug)]
pub(super) struct Codebooks {
    pub(super) grid: Grid,
    /// P4: entries of P3, `[entry][φ_v]`.
    pub(super) p4: Vec<Scaled>,
    /// P3: entries of M, `[entry][θ_v]`.
    pub(super) p3: Vec<Scaled>,
    /// M: pairs of entries of P2 and I2.
    pub(super) merged: Vec<[u32; 2]>,
    pub(super) number_of_merged: BTreeMap<[u32; 2], u32>,
    /// P2: entries of P1, `[entry][α]`.
    pub(super) p2: Vec<Scaled>,
    /// P1: values, `[entry][β]`.
    pub(super) p1: Rows,
    /// I2: entries of I1, `[entry][α]`.
    pub(super) i2: Vec<u32>,
    /// I1: entries of C, `[entry][β]`.
    pub(super) i1: Vec<u32>,
    /// C: colours, two channels of chroma each.
    pub(super) colours: Vec<[f32; 2]>,
    /// Entries of I1, decoded, by channel.
    pub(super) of_i1: [Rows; 2],
    /// Entries of P2 and I2, decoded.
    pub(super) decoded: Decoded,
    /// Mean luma of the entries of P2.
    pub(super) of_p2: Vec<f32>,
    /// P3, decoded to `[entry][θ_v]`, and the mean luma of its entries.
    pub(super) of_p3: (Vec<Piece>, Vec<f32>),
    /// P4, decoded to `[entry][φ_v][θ_v]`, and the mean luma of its entries.
    pub(super) of_p4: (Vec<Piece>, Vec<f32>),
}

fn number(length: usize, row: usize) -> u32 {
    u32::try_from(length / row).expect("fewer than 2³² entries")
}

impl Codebooks {
    pub(super) fn new(grid: Grid) -> Self {
        let rows = || Rows::new(grid.n_beta.into());
        let slices = || Slices::new([grid.n_alpha, grid.n_beta].map(usize::from));
        Self {
            grid,
            p4: Vec::new(),
            p3: Vec::new(),
            merged: Vec::new(),
            number_of_merged: BTreeMap::new(),
            p2: Vec::new(),
            p1: rows(),
            i2: Vec::new(),
            i1: Vec::new(),
            colours: Vec::new(),
            of_i1: [rows(), rows()],
            decoded: Decoded { luma: slices(), chroma: [slices(), slices()] },
            of_p2: Vec::new(),
            of_p3: (Vec::new(), Vec::new()),
            of_p4: (Vec::new(), Vec::new()),
        }
    }

    pub(super) fn n_phi(&self) -> usize {
        self.grid.n_phi.into()
    }

    pub(super) fn n_theta(&self) -> usize {
        self.grid.n_theta.into()
    }

    pub(super) fn n_alpha(&self) -> usize {
        self.grid.n_alpha.into()
    }

    pub(super) fn n_beta(&self) -> usize {
        self.grid.n_beta.into()
    }

    pub(super) fn push_colour(&mut self, colour: [f32; 2]) -> u32 {
        self.colours.push(colour);
        number(self.colours.len() - 1, 1)
    }

    pub(super) fn push_i1(&mut self, colours: &[u32]) -> u32 {
        for (c, rows) in self.of_i1.iter_mut().enumerate() {
            let row: Vec<f32> = colours.iter().map(|colour| self.colours[*colour as usize][c]).collect();
            rows.push(&row);
        }
        self.i1.extend_from_slice(colours);
        number(self.i1.len() - 1, self.n_beta())
    }

    pub(super) fn push_i2(&mut self, slices: &[u32]) -> u32 {
        for (decoded, rows) in self.decoded.chroma.iter_mut().zip(&self.of_i1) {
            let values: Vec<f32> = slices.iter().flat_map(|slice| rows.row(*slice as usize).values).copied().collect();
            decoded.push(&values);
        }
        self.i2.extend_from_slice(slices);
        number(self.i2.len() - 1, self.n_alpha())
    }

    pub(super) fn push_p1(&mut self, row: &[f32]) -> u32 {
        self.p1.push(row);
        number(self.p1.len() - 1, 1)
    }

    pub(super) fn push_p2(&mut self, items: &[Scaled]) -> u32 {
        let mut values = Vec::with_capacity(items.len() * self.n_beta());
        for (slice, gain) in items {
            values.extend(self.p1.row(*slice as usize).values.iter().map(|value| gain * value));
        }
        self.decoded.luma.push(&values);
        let entry = self.decoded.luma.len() - 1;
        self.of_p2.push(self.decoded.luma.mean(entry..entry + 1));
        self.p2.extend_from_slice(items);
        number(self.p2.len() - 1, self.n_alpha())
    }

    /// The pair, which may be there already.
    pub(super) fn merge(&mut self, pair: [u32; 2]) -> u32 {
        let next = number(self.merged.len(), 1);
        let entry = *self.number_of_merged.entry(pair).or_insert(next);
        if entry == next {
            self.merged.push(pair);
        }
        entry
    }

    pub(super) fn push_p3(&mut self, items: &[Scaled]) -> u32 {
        let mut sum = 0.0;
        for (merged, gain) in items {
            let [p2, i2] = self.merged[*merged as usize];
            sum += gain * self.of_p2[p2 as usize];
            self.of_p3.0.push(Piece { p2, i2, gain: *gain });
        }
        self.of_p3.1.push(sum / items.len() as f32);
        self.p3.extend_from_slice(items);
        number(self.p3.len() - 1, self.n_theta())
    }

    pub(super) fn push_p4(&mut self, items: &[Scaled]) -> u32 {
        let (n_theta, mut sum) = (self.n_theta(), 0.0);
        for (entry, gain) in items {
            let entry = *entry as usize;
            sum += gain * self.of_p3.1[entry];
            let pieces = &self.of_p3.0[entry * n_theta..(entry + 1) * n_theta];
            self.of_p4.0.extend(pieces.iter().map(|piece| Piece { gain: gain * piece.gain, ..*piece }));
        }
        self.of_p4.1.push(sum / items.len() as f32);
        self.p4.extend_from_slice(items);
        number(self.p4.len() - 1, self.n_phi())
    }
}
