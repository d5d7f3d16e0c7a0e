//! Rows of a transfer's sections as they pass, checked with what checks whole sections.

use super::layout::TransferHeader;
use super::reader::{check_clusters, checked_ranges, unit_vectors};
use crate::container::Entry;
use crate::container::table::Table;
use crate::error::ReadError;
use crate::kernel::layout::TAIL_NODE_BYTES;
use crate::kernel::reader::{TAIL_START, tail_after};
use crate::push::rows::{Arrived, Rows, Taken};
use crate::section::Section;

/// Header of a transfer, and the last node of the tail that has passed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TransferRows {
    header: TransferHeader,
    tail: [f32; 3],
}

impl TransferRows {
    /// Refuses files without the sections that the header asks for, or with other sizes of them.
    pub(crate) fn new(header: TransferHeader, table: Table<'_>) -> Result<Self, ReadError> {
        use Section::{ClusterBases, ClusterMeans, ClusterRanges, KernelTail, LightAxes, Lights, VertexCodes};
        for section in [Lights, ClusterRanges, VertexCodes, LightAxes, ClusterMeans, ClusterBases, KernelTail] {
            table.entry(section)?.sized(header.section_bytes(section))?;
        }
        Ok(Self { header, tail: TAIL_START })
    }
}

impl Rows for TransferRows {
    fn reads(&self, entry: &Entry) -> bool {
        self.header.section_bytes(entry.section) > 0
    }

    fn row_bytes(&self, entry: &Entry, _: u64) -> Result<u64, ReadError> {
        const DIRECTION_BYTES: u64 = 12;
        const RANGE_BYTES: u64 = 8;
        let axes = u64::from(self.header.axes);
        Ok(match entry.section {
            Section::Lights => DIRECTION_BYTES,
            Section::ClusterRanges => (self.header.components() as u64).saturating_add(1).saturating_mul(RANGE_BYTES),
            Section::ClusterMeans => axes.saturating_mul(2),
            Section::VertexCodes => self.header.record_bytes() as u64,
            Section::KernelTail => TAIL_NODE_BYTES,
            _ => axes,
        })
    }

    fn take<'r>(&'r mut self, arrived: &Arrived<'r>) -> Result<Taken<'r>, ReadError> {
        let row = arrived.row();
        match arrived.entry.section {
            Section::Lights => drop(unit_vectors(row)?),
            Section::ClusterRanges => drop(checked_ranges(row)?),
            Section::VertexCodes => check_clusters(row, &self.header)?,
            Section::KernelTail => self.tail = tail_after(row, self.tail, arrived.is_last())?.rgb_at(0),
            _ => {}
        }
        Ok(Taken::Row)
    }
}
