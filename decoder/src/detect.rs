//! Which family a file belongs to.

use crate::btf::layout::BtfHeader;
use crate::container::sections::{SectionBytes, Sections};
use crate::container::table::Table;
use crate::error::ReadError;
use crate::family::Family;
use crate::section::Section;

/// Header sections of all families; a file has one of them.
const HEADERS: &[Section] = &[
    Section::BssrdfHeader,
    Section::BtfHeader,
    Section::KernelHeader,
    #[cfg(feature = "transfer")]
    Section::TransferHeader,
];

/// Header section of a file: what says which family it is of.
pub(crate) fn header_section(table: Table<'_>) -> Result<Section, ReadError> {
    let mut found = HEADERS.iter().copied().filter(|section| table.has(*section));
    let header = found.next().ok_or(ReadError::UnknownContent)?;
    match found.next() {
        Some(second) => Err(ReadError::TwoFamilies { headers: [header, second] }),
        None => Ok(header),
    }
}

/// Family of a file by its header section.
#[inline(never)]
pub(crate) fn family(sections: &Sections<'_>) -> Result<Family, ReadError> {
    Ok(match header_section(sections.container.table)? {
        Section::BtfHeader => BtfHeader::parse(sections.any(Section::BtfHeader)?)?.model.family(),
        Section::KernelHeader => Family::Kernel,
        #[cfg(feature = "transfer")]
        Section::TransferHeader => Family::Transfer,
        _ => Family::Bssrdf,
    })
}

/// Header section of the family that is expected. A file that has the header of another family is refused as such.
#[inline(never)]
pub(crate) fn header<'a>(
    sections: &Sections<'a>,
    section: Section,
    expected: Family,
) -> Result<SectionBytes<'a>, ReadError> {
    match family(sections) {
        Ok(found) if found != expected => Err(ReadError::OtherFamily { found, expected }),
        Ok(_) | Err(ReadError::UnknownContent) => sections.any(section),
        Err(error) => Err(error),
    }
}
