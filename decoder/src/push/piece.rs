//! What a reader of pushed bytes hands out.

use crate::bssrdf::BssrdfHeader;
use crate::bssrdf::basis::BasisSize;
use crate::btf::factored::layout::TuckerShape;
use crate::btf::nested::layout::CodebookSizes;
use crate::btf::{BtfHeader, Material};
use crate::kernel::KernelHeader;
use crate::section::Section;
#[cfg(feature = "transfer")]
use crate::transfer::TransferHeader;

/// Piece of a file, in file order. All values in it were checked.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum Piece<'p> {
    /// Header of a BSSRDF.
    Bssrdf(&'p BssrdfHeader),
    /// Header of BTFs of either model.
    Btf(&'p BtfHeader),
    /// Header of a kernel.
    Kernel(&'p KernelHeader),
    /// Header of a transfer.
    #[cfg(feature = "transfer")]
    Transfer(&'p TransferHeader),
    /// Size of the separable basis whose rows follow.
    Basis(BasisSize),
    /// Next material of a BTF.
    Material(Material),
    /// Sizes of the nested codebooks whose rows follow.
    Codebooks(&'p CodebookSizes),
    /// Sizes of the Tucker decomposition whose rows follow.
    Tucker(&'p TuckerShape),
    /// Row of a table.
    Row(Row<'p>),
    /// Section that has passed: its CRC-32 is that of the bytes that came, unless the reader was told not to look.
    End(Section),
}

/// Row of a table, as its bytes stand in the file; see the table of rows at [`push`](crate::push).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Row<'p> {
    /// Section that it belongs to.
    pub section: Section,
    /// Number in its section, from 0.
    pub number: u32,
    /// Its bytes. [`F32Le`](crate::container::bytes::F32Le) and its like read numbers of any alignment.
    pub bytes: &'p [u8],
}
