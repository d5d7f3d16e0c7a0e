//! Rows of a kernel's sections as they pass, checked with what checks whole sections.

use super::evaluate::add_term;
use super::layout::{KernelHeader, TAIL_NODE_BYTES};
use super::reader::{RGB, TAIL_START, TwoGaussians, check_energy, checked_weights, offsets, tail_after};
use crate::container::Entry;
use crate::container::index::row_major;
use crate::container::origin::Origin;
use crate::container::table::Table;
use crate::error::ReadError;
use crate::push::rows::{Arrived, Rows, Taken};
use crate::section::Section;

/// Bytes of a tap's weights.
const TAP_BYTES: u64 = 12;

/// Header of a kernel, and sums over what has passed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct KernelRows {
    header: KernelHeader,
    /// The last node of the tail.
    tail: [f32; 3],
    /// Σ_t s_t (Σ_i w_ti)² of the terms that have passed.
    energy: [f32; 3],
    terms: usize,
    /// T(0).
    reflectance: [f32; 3],
    /// Whether the tail has passed.
    has_tail: bool,
    /// Where the weights are.
    weights: Origin,
}

impl KernelRows {
    /// Refuses files without the sections that the header asks for, or with other sizes of them.
    pub(crate) fn new(header: KernelHeader, table: Table<'_>) -> Result<Self, ReadError> {
        use Section::{KernelOffsets, KernelTail, KernelWeights, TwoGaussians};
        let sized = |entry: Entry| entry.sized(header.section_bytes(entry.section));
        let weights = table.entry(KernelWeights)?;
        sized(weights)?;
        sized(table.entry(KernelOffsets)?)?;
        sized(table.entry(KernelTail)?)?;
        table.entry(TwoGaussians).map_or(Ok(()), sized)?;
        let weights = Origin { section: KernelWeights, offset: weights.offset };
        let (energy, reflectance) = ([0.0; 3], [0.0; 3]);
        Ok(Self { header, tail: TAIL_START, energy, terms: 0, reflectance, has_tail: false, weights })
    }

    /// Compares energy and reflectance once both are known.
    fn check_energy(&self) -> Result<(), ReadError> {
        if self.has_tail && self.terms == self.header.terms.into() {
            check_energy(self.weights, self.energy, self.reflectance)?;
        }
        Ok(())
    }
}

impl Rows for KernelRows {
    fn reads(&self, entry: &Entry) -> bool {
        self.header.section_bytes(entry.section) > 0
    }

    fn row_bytes(&self, entry: &Entry, _: u64) -> Result<u64, ReadError> {
        Ok(match entry.section {
            Section::KernelWeights => (self.header.side() as u64).saturating_mul(TAP_BYTES),
            Section::KernelTail => TAIL_NODE_BYTES,
            // Few numbers, one row.
            _ => entry.length,
        })
    }

    fn take<'r>(&'r mut self, arrived: &Arrived<'r>) -> Result<Taken<'r>, ReadError> {
        let row = arrived.row();
        match arrived.entry.section {
            Section::KernelOffsets => drop(offsets(row, self.header.radius_mm)?),
            Section::TwoGaussians => drop(TwoGaussians::parse(row)?),
            Section::KernelWeights => {
                let weights = checked_weights(row)?;
                let taps = (0..self.header.side()).map(|tap| weights.rgb_at(row_major(tap, RGB, 0)));
                add_term(&mut self.energy, self.header.sign(self.terms), taps);
                self.terms = self.terms.saturating_add(1);
                self.check_energy()?;
            }
            Section::KernelTail => {
                self.tail = tail_after(row, self.tail, arrived.is_last())?.rgb_at(0);
                if arrived.at == 0 {
                    self.reflectance = self.tail;
                }
                self.has_tail = arrived.is_last();
                self.check_energy()?;
            }
            _ => {}
        }
        Ok(Taken::Row)
    }
}
