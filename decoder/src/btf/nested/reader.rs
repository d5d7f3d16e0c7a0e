//! Reads and checks a nested BTF file once; after that nothing can fail.

use super::codebooks::NestedCodebooks;
use super::sampler::{Sample, Sampler};
use crate::btf::catalog::{Catalog, Texel};
use crate::btf::coord::GridCoord;
use crate::btf::grid::{Grid, View};
use crate::btf::layout::BtfHeader;
use crate::btf::material::Material;
use crate::container::Crc;
use crate::container::sections::Sections;
use crate::error::ReadError;
use crate::family::Family;

/// Checked BTF file of nested codebooks.
#[derive(Clone, Copy, Debug)]
pub struct NestedBtf<'a> {
    file: &'a [u8],
    catalog: Catalog<'a>,
    codebooks: NestedCodebooks<'a>,
    /// Binary logarithms of luminance that l spans, of the colour encoding.
    octaves: f32,
}

impl<'a> NestedBtf<'a> {
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
    /// The first thing that is wrong, with section, offset and numbers.
    pub fn parse_with(bytes: &'a [u8], crc: Crc) -> Result<Self, ReadError> {
        Self::read(&Sections::parse(bytes, crc)?)
    }

    /// Reads and checks all sections.
    #[inline(never)]
    pub(crate) fn read(sections: &Sections<'a>) -> Result<Self, ReadError> {
        let catalog = Catalog::read(sections, Family::NestedBtf)?;
        let codebooks = NestedCodebooks::parse(sections, catalog.grid(), catalog.texels())?;
        let octaves = catalog.header().encoding.octaves();
        Ok(Self { file: sections.container.file(), catalog, codebooks, octaves })
    }

    /// Header and materials.
    #[must_use]
    pub fn catalog(&self) -> &Catalog<'a> {
        &self.catalog
    }

    /// Bytes of the file, without what followed it in memory.
    #[must_use]
    pub fn file(&self) -> &'a [u8] {
        self.file
    }

    /// Model, colour encoding and grid.
    #[must_use]
    pub fn header(&self) -> &BtfHeader {
        self.catalog.header()
    }

    /// Nodes of directions.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        self.catalog.grid()
    }

    /// Materials in file order.
    pub fn materials(&self) -> impl Iterator<Item = Material> + 'a {
        self.catalog.materials()
    }

    /// Codebooks, checked.
    #[must_use]
    pub fn codebooks(&self) -> &NestedCodebooks<'a> {
        &self.codebooks
    }

    /// Texel by material, mipmap level and coordinates, which repeat; `None` if there is no such material or level.
    #[must_use]
    pub fn texel(&self, material: usize, level: u8, [x, y]: [i32; 2]) -> Option<Texel> {
        self.catalog.texel(material, level, [x, y])
    }

    /// Value of a texel at coordinates of the grid, as images have it ([`ColourEncoding`](crate::btf::ColourEncoding)): π times the radiance under
    /// light of unit irradiance on a plane that faces it, so that white paper has cos θ_i.
    #[must_use]
    pub fn eval_at(&self, texel: Texel, coord: &GridCoord) -> [f32; 3] {
        let Texel(texel) = texel;
        let channels = self.codebooks.channels(texel, coord);
        self.catalog.header().encoding.decode_in(self.octaves, channels).map(|value| value * coord.fade)
    }

    /// [`Self::eval_at`] for a light and a prepared view.
    #[must_use]
    pub fn eval_for(&self, texel: Texel, light: [f32; 3], view: &View) -> [f32; 3] {
        self.eval_at(texel, &self.catalog.grid().coord_for(light, view))
    }

    /// [`Self::eval_at`] for unit vectors towards light and eye: x along the rows, y down the columns, z the normal.
    #[must_use]
    pub fn eval(&self, texel: Texel, light: [f32; 3], view: [f32; 3]) -> [f32; 3] {
        self.eval_at(texel, &self.catalog.grid().coord(light, view))
    }

    /// Sampler of lights for one texel and view.
    #[must_use]
    pub fn sampler(&self, texel: Texel, view: &View) -> Sampler<'_> {
        let Texel(texel) = texel;
        Sampler::new(&self.codebooks, self.catalog.grid(), texel, view)
    }

    /// One light of a [`Self::sampler`], for two random numbers.
    #[must_use]
    pub fn sample(&self, texel: Texel, view: [f32; 3], random: [f32; 2]) -> Sample {
        self.sampler(texel, &self.catalog.grid().view(view)).sample(random)
    }

    /// Density with which [`Self::sample`] draws a light, per steradian.
    #[must_use]
    pub fn pdf(&self, texel: Texel, light: [f32; 3], view: [f32; 3]) -> f32 {
        self.sampler(texel, &self.catalog.grid().view(view)).pdf(light)
    }
}
