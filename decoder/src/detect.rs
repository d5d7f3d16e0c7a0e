//! Which family a file belongs to.

use crate::btf::layout::BtfHeader;
use crate::container::sections::{SectionBytes, Sections};
use crate::error::ReadError;
use crate::family::Family;
use crate::section::Section;

/// Family of a file by its header section.
pub(crate) fn family(sections: &Sections<'_>) -> Result<Family, ReadError> {
    #[cfg(feature = "transfer")]
    if sections.has(Section::TransferHeader) {
        return Ok(Family::Transfer);
    }
    if sections.has(Section::BtfHeader) {
        Ok(BtfHeader::parse(sections.any(Section::BtfHeader)?)?.model.family())
    } else if sections.has(Section::BssrdfHeader) {
        Ok(Family::Bssrdf)
    } else if sections.has(Section::KernelHeader) {
        Ok(Family::Kernel)
    } else {
        Err(ReadError::UnknownContent)
    }
}

/// Header section of the family that is expected. A file that has the header of another family is refused as such.
pub(crate) fn header<'a>(
    sections: &Sections<'a>,
    section: Section,
    expected: Family,
) -> Result<SectionBytes<'a>, ReadError> {
    if !sections.has(section)
        && let Ok(found) = family(sections)
    {
        return Err(ReadError::OtherFamily { found, expected });
    }
    sections.any(section)
}
