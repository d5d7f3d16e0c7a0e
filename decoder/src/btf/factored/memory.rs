//! Expansion of a factored BTF into memory from the heap.

use super::evaluate::ExpandedBtf;
use super::expand::ExpansionBuffers;
use super::reader::FactoredBtf;
use alloc::vec::Vec;

/// Memory from the heap that a factored BTF is expanded into; empty at first.
#[derive(Debug, Default)]
pub struct ExpansionMemory {
    table: Vec<i8>,
    words: Vec<i16>,
}

impl<'a> FactoredBtf<'a> {
    /// [`Self::expand`] with buffers from the heap; `None` where it has no such memory.
    #[must_use]
    pub fn expand_in<'m>(&self, memory: &'m mut ExpansionMemory) -> Option<ExpandedBtf<'m>>
    where
        'a: 'm,
    {
        let mut scratch = Vec::new();
        resize(&mut memory.table, self.table_len())?;
        resize(&mut memory.words, self.words_len())?;
        resize(&mut scratch, self.scratch_len())?;
        let ExpansionMemory { table, words } = memory;
        self.expand(ExpansionBuffers { table, words, scratch: &mut scratch })
    }
}

/// Makes a buffer `len` values long; `None` where there is no such memory.
fn resize<T: Copy + Default>(buffer: &mut Vec<T>, len: usize) -> Option<()> {
    buffer.try_reserve_exact(len.saturating_sub(buffer.len())).ok()?;
    buffer.resize(len, T::default());
    Some(())
}
