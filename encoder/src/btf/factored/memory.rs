//! Files of factors, expanded in memory of the host.

use subsurf_decoder::btf::factored::Buffers;
use subsurf_decoder::btf::{Expanded, Factored};

/// Memory that a file of factors is expanded into.
#[derive(Debug, Default)]
pub struct Memory {
    table: Vec<i8>,
    words: Vec<i16>,
}

/// Expands a file into `memory`.
///
/// # Panics
/// Never: the buffers are as long as the file says.
pub fn expanded<'m>(file: &Factored<'m>, memory: &'m mut Memory) -> Expanded<'m> {
    memory.table.resize(file.table_len(), 0);
    memory.words.resize(file.words_len(), 0);
    let mut scratch = vec![0.0; file.scratch_len()];
    let buffers = Buffers { table: &mut memory.table, words: &mut memory.words, scratch: &mut scratch };
    file.expand(buffers).expect("buffers are as long as the file says")
}
