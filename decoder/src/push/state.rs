//! Where in a file a reader of pushed bytes is.

use super::piece::Piece;
use super::plan::Plan;
use super::rows::Arrived;
use crate::container::crc::Crc32;
use crate::container::table::{Start, Table, truncated};
use crate::container::{Crc, Entry, FILE_HEADER_BYTES};
use crate::detect::header_section;
use crate::error::ReadError;
use crate::section::Section;
use heapless::VecView;

/// Everything about a reader but its buffer, which has the file's first bytes up to the end of the section table, and what has come of a
/// row after them.
#[derive(Clone, Debug)]
pub(super) struct State {
    crc: Crc,
    /// Bytes of the file that have passed.
    passed: u64,
    /// File header and first byte after the section table, once they are known.
    start: Option<(Start, usize)>,
    /// What comes now or next: its number in the section table.
    section: usize,
    /// CRC-32 of what has passed of the section.
    sum: Crc32,
    /// First byte of the row that comes, in its section.
    at: u64,
    /// Its number.
    row: u32,
    /// Whether no row follows the one that is in the buffer. It waits for the CRC.
    is_last: bool,
    /// Rows by what is known; `None` before the section table is.
    plan: Option<Plan>,
    /// What is wrong with a value of the section. It is not told before the CRC: a damaged file is damaged in the first place.
    fault: Option<ReadError>,
}

impl State {
    pub(super) const fn new(crc: Crc) -> Self {
        let sum = Crc32::NEW;
        let (start, plan, fault) = (None, None, None);
        Self { crc, passed: 0, start, section: 0, sum, at: 0, row: 0, is_last: false, plan, fault }
    }

    /// Whether all bytes of the file have passed.
    pub(super) fn is_complete(&self) -> bool {
        self.start.is_some_and(|(start, _)| self.plan.is_some() && self.passed >= start.file_bytes)
    }

    /// Error of a file that ends here.
    pub(super) fn end(&self, buffer: &[u8]) -> Result<(), ReadError> {
        match self.start {
            None => Start::parse(buffer).map(drop),
            Some(_) if self.is_complete() => Ok(()),
            Some((start, _)) => Err(truncated(start.file_bytes, self.passed)),
        }
    }

    /// Takes in the next bytes.
    pub(super) fn push(
        &mut self,
        buffer: &mut VecView<u8>,
        mut bytes: &[u8],
        on_piece: &mut dyn FnMut(Piece<'_>),
    ) -> Result<(), ReadError> {
        let Some((start, header_end)) = self.header(buffer, &mut bytes)? else { return Ok(()) };
        loop {
            let table = Table::checked_before(buffer.get(..header_end).unwrap_or(&[]));
            let next = table.entries().nth(self.section);
            // What lies before a section, and after the last.
            self.skip(&mut bytes, next.map_or(start.file_bytes, |entry| entry.offset));
            let Some(entry) = next.filter(|entry| self.passed >= entry.offset) else { return Ok(()) };
            if !self.section(&entry, header_end, buffer, &mut bytes, on_piece)? {
                return Ok(());
            }
        }
    }

    /// Gathers file header and section table, and checks both.
    fn header(&mut self, buffer: &mut VecView<u8>, bytes: &mut &[u8]) -> Result<Option<(Start, usize)>, ReadError> {
        if self.start.is_none() {
            self.gather(buffer, bytes, FILE_HEADER_BYTES, Section::FileHeader)?;
            let start = match Start::parse(buffer) {
                Err(ReadError::Truncated { .. }) => return Ok(None),
                start => start?,
            };
            self.start = Some((start, start.header_end()?));
        }
        let Some((start, header_end)) = self.start else { return Ok(None) };
        if self.plan.is_none() {
            self.gather(buffer, bytes, header_end, Section::FileHeader)?;
            if buffer.len() < header_end {
                return Ok(None);
            }
            self.plan = Some(Plan::Header(header_section(Table::parse(buffer, &start)?)?));
            self.sum = Crc32::NEW;
        }
        Ok(Some((start, header_end)))
    }

    /// Takes in what there is of a section; whether it has ended.
    fn section(
        &mut self,
        entry: &Entry,
        header_end: usize,
        buffer: &mut VecView<u8>,
        bytes: &mut &[u8],
        on_piece: &mut dyn FnMut(Piece<'_>),
    ) -> Result<bool, ReadError> {
        if !self.plan.as_mut().is_some_and(|plan| plan.reads(entry)) {
            self.skip(bytes, entry.end());
            let has_ended = self.passed >= entry.end();
            if has_ended {
                self.next_section();
            }
            return Ok(has_ended);
        }
        while !self.is_last && self.fault.is_none() {
            let row_bytes = self.row_bytes(entry, self.at)?;
            let end = header_end.saturating_add(usize::try_from(row_bytes).unwrap_or(usize::MAX));
            self.gather(buffer, bytes, end, entry.section)?;
            if buffer.len() < end {
                return Ok(false);
            }
            let next = self.at.saturating_add(row_bytes);
            self.is_last = next >= entry.length || self.row_bytes(entry, next) == Ok(0);
            if !self.is_last {
                if let Err(error) = self.take(entry, header_end, buffer, on_piece) {
                    self.fault = Some(error);
                }
                buffer.truncate(header_end);
                self.at = next;
            }
        }
        // Fill, or what follows a wrong value.
        let before = *bytes;
        self.skip(bytes, entry.end());
        self.add(before.get(..before.len().saturating_sub(bytes.len())).unwrap_or(&[]));
        if self.passed < entry.end() {
            return Ok(false);
        }
        let (stored, computed) = (entry.crc, self.sum.value());
        if self.crc == Crc::Check && stored != computed {
            return Err(ReadError::Checksum { section: entry.section, stored, computed });
        }
        if let Some(fault) = self.fault {
            return Err(fault);
        }
        if buffer.len() > header_end {
            self.take(entry, header_end, buffer, on_piece)?;
            buffer.truncate(header_end);
        }
        on_piece(Piece::End(entry.section));
        self.next_section();
        Ok(true)
    }

    /// Bytes of the row that begins at byte `at` of a section; 0 where only fill follows.
    fn row_bytes(&mut self, entry: &Entry, at: u64) -> Result<u64, ReadError> {
        self.plan.as_mut().map_or(Ok(0), |plan| plan.row_bytes(entry, at))
    }

    /// Checks the row in the buffer and hands it out.
    fn take(
        &mut self,
        entry: &Entry,
        header_end: usize,
        buffer: &[u8],
        on_piece: &mut dyn FnMut(Piece<'_>),
    ) -> Result<(), ReadError> {
        let (Some(plan), Some((header, bytes))) = (&mut self.plan, buffer.split_at_checked(header_end)) else {
            return Ok(());
        };
        let arrived = Arrived { table: Table::checked_before(header), entry: *entry, at: self.at, bytes };
        if plan.take(&arrived, self.row, on_piece)? {
            self.row = self.row.saturating_add(1);
        }
        Ok(())
    }

    /// Goes on to the next section.
    fn next_section(&mut self) {
        self.section = self.section.saturating_add(1);
        (self.sum, self.at, self.row, self.is_last) = (Crc32::NEW, 0, 0, false);
    }

    /// Fills the buffer to a length, as far as there are bytes.
    fn gather(
        &mut self,
        buffer: &mut VecView<u8>,
        bytes: &mut &[u8],
        len: usize,
        section: Section,
    ) -> Result<(), ReadError> {
        if len > buffer.capacity() {
            let [need_bytes, have_bytes] = [len, buffer.capacity()].map(|bytes| bytes as u64);
            return Err(ReadError::BufferTooSmall { section, need_bytes, have_bytes });
        }
        let count = len.saturating_sub(buffer.len()).min(bytes.len());
        let (now, later) = bytes.split_at_checked(count).unwrap_or((&[], bytes));
        if buffer.extend_from_slice(now).is_ok() {
            self.add(now);
            self.passed = self.passed.saturating_add(now.len() as u64);
            *bytes = later;
        }
        Ok(())
    }

    /// Takes bytes into the section's CRC-32, where it is wanted.
    fn add(&mut self, bytes: &[u8]) {
        if self.crc == Crc::Check {
            self.sum.update(bytes);
        }
    }

    /// Passes over bytes up to a place in the file, as far as there are.
    fn skip(&mut self, bytes: &mut &[u8], to: u64) {
        let count = usize::try_from(to.saturating_sub(self.passed)).unwrap_or(usize::MAX).min(bytes.len());
        self.passed = self.passed.saturating_add(count as u64);
        *bytes = bytes.get(count..).unwrap_or(&[]);
    }
}
