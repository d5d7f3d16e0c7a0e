//! The front door: any `.subsurf` file, checked once.

use crate::bssrdf::Bssrdf;
use crate::btf::{Catalog, FactoredBtf, NestedBtf};
use crate::container::sections::Sections;
use crate::container::{Container, Crc};
use crate::detect::family;
use crate::error::ReadError;
use crate::family::Family;
use crate::kernel::Kernel;
#[cfg(feature = "transfer")]
use crate::transfer::Transfer;

/// Checked file of any family.
#[derive(Clone, Copy, Debug)]
pub struct File<'a> {
    container: Container<'a>,
    content: Content<'a>,
}

/// What a file holds.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
#[allow(clippy::large_enum_variant, reason = "there is no allocator to box the larger ones with")]
pub enum Content<'a> {
    /// Diffuse BSSRDF of a patch.
    Bssrdf(Bssrdf<'a>),
    /// Bidirectional texture functions in nested codebooks.
    NestedBtf(NestedBtf<'a>),
    /// Bidirectional texture functions as a Tucker decomposition.
    FactoredBtf(FactoredBtf<'a>),
    /// Diffusion profile and separable kernel of a homogeneous material.
    Kernel(Kernel<'a>),
    /// Scattering precomputed for the vertices of a mesh.
    #[cfg(feature = "transfer")]
    Transfer(Transfer<'a>),
}

impl<'a> File<'a> {
    /// Reads and checks a file: structure, sizes, every value and index, and all CRCs.
    ///
    /// # Errors
    /// The first thing that is wrong, with section, offset and numbers.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, ReadError> {
        Self::parse_with(bytes, Crc::Check)
    }

    /// [`Self::parse`] with a choice about the sections' CRC-32.
    ///
    /// # Errors
    /// As [`Self::parse`].
    pub fn parse_with(bytes: &'a [u8], crc: Crc) -> Result<Self, ReadError> {
        let sections = Sections::parse(bytes, crc)?;
        let content = match family(&sections)? {
            Family::Bssrdf => Content::Bssrdf(Bssrdf::read(&sections)?),
            Family::NestedBtf => Content::NestedBtf(NestedBtf::read(&sections)?),
            Family::FactoredBtf => Content::FactoredBtf(FactoredBtf::read(&sections)?),
            Family::Kernel => Content::Kernel(Kernel::read(&sections)?),
            #[cfg(feature = "transfer")]
            Family::Transfer => Content::Transfer(Transfer::read(&sections)?),
        };
        Ok(Self { container: sections.container, content })
    }

    /// What the file holds, ready for use.
    #[must_use]
    pub fn content(&self) -> Content<'a> {
        self.content
    }

    /// Header and section table.
    #[must_use]
    pub fn container(&self) -> &Container<'a> {
        &self.container
    }
}

impl<'a> Content<'a> {
    /// Header and materials of a BTF of either model; `None` of other families.
    #[must_use]
    pub fn catalog(&self) -> Option<&Catalog<'a>> {
        match self {
            Self::NestedBtf(btf) => Some(btf.catalog()),
            Self::FactoredBtf(btf) => Some(btf.catalog()),
            _ => None,
        }
    }

    /// Family of the content.
    #[must_use]
    pub fn family(&self) -> Family {
        match self {
            Self::Bssrdf(_) => Family::Bssrdf,
            Self::NestedBtf(_) => Family::NestedBtf,
            Self::FactoredBtf(_) => Family::FactoredBtf,
            Self::Kernel(_) => Family::Kernel,
            #[cfg(feature = "transfer")]
            Self::Transfer(_) => Family::Transfer,
        }
    }
}
