//! Checks a BTF file once; after that nothing can fail.

use super::codebooks::Nested;
use super::sampler::{Sample, Sampler};
use crate::btf::catalog::{Catalog, Texel};
use crate::btf::grid::{Cell, Grid, View};
use crate::btf::layout::{Header, Material, Model};
use crate::container::sections::Sections;
use crate::container::{Container, Crc};
use crate::error::{ReadError, Section};

/// A checked BTF file of nested codebooks.
#[derive(Clone, Copy, Debug)]
pub struct Btf<'a> {
    file: &'a [u8],
    catalog: Catalog<'a>,
    nested: Nested<'a>,
    /// Of the tone.
    octaves: f32,
}

impl<'a> Btf<'a> {
    /// Checks everything and borrows the file; factors are read by [`Factored`](crate::btf::Factored).
    ///
    /// # Errors
    /// The first thing that is wrong.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, ReadError> {
        Self::parse_with(bytes, Crc::Check)
    }

    /// [`Self::parse`], on request without comparing checksums; all other checks run.
    ///
    /// # Errors
    /// The first thing that is wrong.
    pub fn parse_with(bytes: &'a [u8], crc: Crc) -> Result<Self, ReadError> {
        let container = Container::parse(bytes)?;
        let file = bytes.get(..container.file_bytes()).unwrap_or(bytes);
        let sections = Sections { container: &container, crc };
        let catalog = Catalog::read(&sections)?;
        let nested = match catalog.header().model {
            Model::Nested => Nested::parse(&sections, catalog.grid(), catalog.texels())?,
            Model::Factored => {
                let offset = sections.start(Section::BtfHeader);
                return Err(ReadError::BadField { section: Section::BtfHeader, offset, value: 2 });
            }
        };
        let octaves = catalog.header().tone.octaves();
        Ok(Self { file, catalog, nested, octaves })
    }

    /// Header and materials.
    #[must_use]
    pub fn catalog(&self) -> &Catalog<'a> {
        &self.catalog
    }

    /// The bytes that it was read from.
    #[must_use]
    pub fn file(&self) -> &'a [u8] {
        self.file
    }

    /// What the file says of itself.
    #[must_use]
    pub fn header(&self) -> &Header {
        self.catalog.header()
    }

    /// Nodes of directions.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        self.catalog.grid()
    }

    /// Its materials.
    pub fn materials(&self) -> impl Iterator<Item = Material> + 'a {
        self.catalog.materials()
    }

    /// Its codebooks.
    #[must_use]
    pub fn nested(&self) -> &Nested<'a> {
        &self.nested
    }

    /// A texel by material, mipmap level and coordinates, which repeat; `None` if there is no such material or level.
    #[must_use]
    pub fn texel(&self, material: usize, level: u8, [x, y]: [i32; 2]) -> Option<Texel> {
        self.catalog.texel(material, level, [x, y])
    }

    /// Value of a texel at a place of the grid, as images have it ([`Tone`](crate::btf::Tone)): π times the radiance under
    /// light of unit irradiance on a plane that faces it, so that white paper has cos θ_i.
    #[must_use]
    pub fn eval_cell(&self, texel: Texel, cell: &Cell) -> [f32; 3] {
        let Texel(texel) = texel;
        let [y, a, b] = self.nested.channels(texel, cell);
        self.catalog.header().tone.decode_in(self.octaves, [y, a, b]).map(|value| value * cell.fade)
    }

    /// [`Self::eval_cell`] for a light and a prepared view.
    #[must_use]
    pub fn eval_for(&self, texel: Texel, light: [f32; 3], view: &View) -> [f32; 3] {
        self.eval_cell(texel, &self.catalog.grid().cell(light, view))
    }

    /// [`Self::eval_cell`] for unit vectors towards light and eye: x along the rows, y down the columns, z the normal.
    #[must_use]
    pub fn eval(&self, texel: Texel, light: [f32; 3], view: [f32; 3]) -> [f32; 3] {
        self.eval_cell(texel, &self.catalog.grid().pair(light, view))
    }

    /// Draws lights for one texel and view.
    #[must_use]
    pub fn sampler(&self, texel: Texel, view: &View) -> Sampler<'_> {
        let Texel(texel) = texel;
        Sampler::new(&self.nested, self.catalog.grid(), texel, view)
    }

    /// One light of a [`Self::sampler`], for two random numbers.
    #[must_use]
    pub fn sample(&self, texel: Texel, view: [f32; 3], random: [f32; 2]) -> Sample {
        self.sampler(texel, &self.catalog.grid().view(view)).sample(random)
    }

    /// The density with which [`Self::sample`] draws a light, per steradian.
    #[must_use]
    pub fn pdf(&self, texel: Texel, light: [f32; 3], view: [f32; 3]) -> f32 {
        self.sampler(texel, &self.catalog.grid().view(view)).pdf(light)
    }
}
