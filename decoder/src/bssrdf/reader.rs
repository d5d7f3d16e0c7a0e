//! Reads and checks a BSSRDF file once; afterwards its planes are borrowed and nothing can fail.

use super::basis::SeparableBasis;
use super::layout::{BssrdfHeader, Coding, MODEL_2BMPP, MODEL_PER_PIXEL, pairs_in};
use super::planes::{BaseMaterials, BssrdfModel, Mixtures, PerPixelProfiles, Profiles};
use super::values;
use crate::container::Crc;
use crate::container::sections::{SectionBytes, Sections};
use crate::detect;
use crate::error::ReadError;
use crate::family::Family;
use crate::section::Section;

/// Checked BSSRDF file.
#[derive(Clone, Copy, Debug)]
pub struct Bssrdf<'a> {
    header: BssrdfHeader,
    model: BssrdfModel<'a>,
    basis: Option<SeparableBasis<'a>>,
}

impl<'a> Bssrdf<'a> {
    /// Reads and checks a file: structure, sizes, every value and index, and all CRCs.
    ///
    /// # Errors
    /// The first thing that is wrong, with section, offset and numbers.
    pub fn parse(file: &'a [u8]) -> Result<Self, ReadError> {
        Self::parse_with(file, Crc::Check)
    }

    /// [`Bssrdf::parse`] with a choice about the sections' CRC-32.
    ///
    /// # Errors
    /// As [`Bssrdf::parse`].
    pub fn parse_with(file: &'a [u8], crc: Crc) -> Result<Self, ReadError> {
        Self::read(&Sections::parse(file, crc)?)
    }

    /// Reads and checks all sections.
    #[inline(never)]
    pub(crate) fn read(sections: &Sections<'a>) -> Result<Self, ReadError> {
        let header = BssrdfHeader::parse(detect::header(sections, Section::BssrdfHeader, Family::Bssrdf)?)?;
        let planes = Planes { sections, header: &header };
        let model = if header.model == MODEL_PER_PIXEL {
            BssrdfModel::PerPixel(PerPixelProfiles { profiles: values::logs(planes.sized(Section::LocalProfiles)?)? })
        } else {
            BssrdfModel::BaseMaterials(BaseMaterials { profiles: planes.profiles()?, mixtures: planes.mixtures()? })
        };
        let basis = if sections.has(Section::SeparableBasis) {
            Some(SeparableBasis::parse(sections.any(Section::SeparableBasis)?, header.samples)?)
        } else {
            None
        };
        Ok(Self { header, model, basis })
    }

    /// Sizes, units and model.
    #[must_use]
    pub fn header(&self) -> &BssrdfHeader {
        &self.header
    }

    /// The planes, for upload.
    #[must_use]
    pub fn model(&self) -> &BssrdfModel<'a> {
        &self.model
    }

    /// The separable basis, where the file has one.
    #[must_use]
    pub fn basis(&self) -> Option<&SeparableBasis<'a>> {
        self.basis.as_ref()
    }
}

/// The planes of a file whose header is known.
struct Planes<'a, 'b> {
    sections: &'b Sections<'a>,
    header: &'b BssrdfHeader,
}

impl<'a> Planes<'a, '_> {
    /// A section whose size follows from the header.
    fn sized(&self, section: Section) -> Result<SectionBytes<'a>, ReadError> {
        self.sections.sized(section, self.header.section_bytes(section))
    }

    /// Half floats if they are there, single ones otherwise.
    fn profiles(&self) -> Result<Profiles<'a>, ReadError> {
        if self.sections.has(Section::HalfProfiles) {
            return values::half_logs(self.sized(Section::HalfProfiles)?).map(Profiles::F16);
        }
        values::logs(self.sized(Section::BaseProfiles)?).map(Profiles::F32)
    }

    fn mixtures(&self) -> Result<Mixtures<'a>, ReadError> {
        let materials = self.header.base_materials;
        let bytes_of = |section| values::indices(self.sized(section)?, materials);
        Ok(match (self.header.coding, self.header.model) {
            (Coding::Palette, _) => {
                let pairs = self.pairs()?;
                let codes = values::codes(self.sized(Section::Codes)?, pairs.len())?;
                Mixtures::Palette { pairs, codes }
            }
            (Coding::SmallRatios, _) => Mixtures::TwoSmall {
                ratios: self.sized(Section::SmallRatios)?.bytes,
                indices: bytes_of(Section::BaseIndices)?.as_chunks().0,
            },
            (Coding::Exact, MODEL_2BMPP) => Mixtures::Two {
                ratios: values::ratios(self.sized(Section::MixtureRatios)?)?,
                indices: bytes_of(Section::BaseIndices)?.as_chunks().0,
            },
            (Coding::Exact, 1) if self.header.index_bytes() == 1 => Mixtures::One(bytes_of(Section::BaseIndices)?),
            (Coding::Exact, 1) => {
                Mixtures::OneOfMany(values::wide_indices(self.sized(Section::BaseIndices)?, materials)?)
            }
            (Coding::Exact, count) => {
                let count = usize::from(count);
                let section = self.sized(Section::MixtureRatios)?;
                let ratios = values::ratios(section)?;
                values::check_sums(section.origin, ratios, count)?;
                Mixtures::Several { ratios, indices: bytes_of(Section::BaseIndices)?, count }
            }
        })
    }

    /// The palette, whose length its section's size tells.
    fn pairs(&self) -> Result<&'a [[u8; 2]], ReadError> {
        let section = self.sections.any(Section::Pairs)?;
        pairs_in(section.bytes.len() as u64)?;
        Ok(values::indices(section, self.header.base_materials)?.as_chunks().0)
    }
}
