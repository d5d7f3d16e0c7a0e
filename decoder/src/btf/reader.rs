//! Checks a BTF file once; after that nothing can fail.

use super::grid::{Cell, Grid, View};
use super::layout::{Header, MATERIAL_BYTES, Material, Model};
use super::nested::{Nested, Sample, Sampler};
use super::sections::Sections;
use crate::container::{Container, Crc};
use crate::error::{ReadError, Section};

/// A texel of one of the mipmap levels of one of the materials of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Texel(u32);

impl Texel {
    /// Its number in the file: texels row by row, level by level, material by material.
    #[must_use]
    pub fn number(self) -> u32 {
        let Self(number) = self;
        number
    }
}

/// A checked BTF file.
#[derive(Clone, Copy, Debug)]
pub struct Btf<'a> {
    file: &'a [u8],
    header: Header,
    materials: &'a [[u8; MATERIAL_BYTES]],
    nested: Nested<'a>,
    /// Of the tone.
    octaves: f32,
}

impl<'a> Btf<'a> {
    /// Checks everything and borrows the file.
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
        let (start, bytes) = sections.any(Section::BtfHeader)?;
        let header = Header::parse(bytes, start)?;
        let need = usize::from(header.materials).saturating_mul(MATERIAL_BYTES) as u64;
        let materials: &[[u8; MATERIAL_BYTES]] = sections.sized(Section::Materials, need)?.as_chunks().0;
        let mut texels = 0_u32;
        for (at, material) in (0..).step_by(MATERIAL_BYTES).zip(materials) {
            let material = Material::parse(material, sections.start(Section::Materials).saturating_add(at))?;
            texels = texels.saturating_add(material.texels(u8::MAX));
        }
        let nested = match header.model {
            Model::Nested => Nested::parse(&sections, &header.grid, texels)?,
            Model::Factored => {
                return Err(ReadError::BadField { section: Section::BtfHeader, offset: start, value: 2 });
            }
        };
        Ok(Self { file, header, materials, nested, octaves: header.tone.octaves() })
    }

    /// The bytes that it was read from.
    #[must_use]
    pub fn file(&self) -> &'a [u8] {
        self.file
    }

    /// What the file says of itself.
    #[must_use]
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// Nodes of directions.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        &self.header.grid
    }

    /// Its materials.
    pub fn materials(&self) -> impl Iterator<Item = Material> + 'a {
        // All were read before.
        self.materials.iter().filter_map(|bytes| Material::parse(bytes, 0).ok())
    }

    /// Its codebooks.
    #[must_use]
    pub fn nested(&self) -> &Nested<'a> {
        &self.nested
    }

    /// A texel by material, mipmap level and coordinates, which repeat; `None` if there is no such material or level.
    #[must_use]
    pub fn texel(&self, material: usize, level: u8, [x, y]: [i32; 2]) -> Option<Texel> {
        let of = self.materials().nth(material)?;
        let Texel(first) = self.first_texel(material, level)?;
        let [width, height] = of.size(level).map(u32::cast_signed);
        let (x, y) = (x.checked_rem_euclid(width)?, y.checked_rem_euclid(height)?);
        let inside = y.wrapping_mul(width).wrapping_add(x).cast_unsigned();
        Some(Texel(first.wrapping_add(inside)))
    }

    /// The first texel of a mipmap level of a material, others following row by row; `None` if there is no such material
    /// or level.
    #[must_use]
    pub fn first_texel(&self, material: usize, level: u8) -> Option<Texel> {
        let of = self.materials().nth(material).filter(|of| level < of.levels)?;
        let before = self.materials().take(material).fold(0_u32, |sum, other| sum.wrapping_add(other.texels(u8::MAX)));
        Some(Texel(before.wrapping_add(of.texels(level))))
    }

    /// Value of a texel at a place of the grid, as images have it ([`Tone`](super::Tone)): π times the radiance under
    /// light of unit irradiance on a plane that faces it, so that white paper has cos θ_i.
    #[must_use]
    pub fn eval_cell(&self, texel: Texel, cell: &Cell) -> [f32; 3] {
        let Texel(texel) = texel;
        let [y, a, b] = self.nested.channels(texel, cell);
        self.header.tone.decode_in(self.octaves, [y, a, b]).map(|value| value * cell.fade)
    }

    /// [`Self::eval_cell`] for a light and a prepared view.
    #[must_use]
    pub fn eval_for(&self, texel: Texel, light: [f32; 3], view: &View) -> [f32; 3] {
        self.eval_cell(texel, &self.header.grid.cell(light, view))
    }

    /// [`Self::eval_cell`] for unit vectors towards light and eye: x along the rows, y down the columns, z the normal.
    #[must_use]
    pub fn eval(&self, texel: Texel, light: [f32; 3], view: [f32; 3]) -> [f32; 3] {
        self.eval_cell(texel, &self.header.grid.pair(light, view))
    }

    /// Draws lights for one texel and view.
    #[must_use]
    pub fn sampler(&self, texel: Texel, view: &View) -> Sampler<'_> {
        let Texel(texel) = texel;
        Sampler::new(&self.nested, &self.header.grid, texel, view)
    }

    /// One light of a [`Self::sampler`], for two random numbers.
    #[must_use]
    pub fn sample(&self, texel: Texel, view: [f32; 3], random: [f32; 2]) -> Sample {
        self.sampler(texel, &self.header.grid.view(view)).sample(random)
    }

    /// The density with which [`Self::sample`] draws a light, per steradian.
    #[must_use]
    pub fn pdf(&self, texel: Texel, light: [f32; 3], view: [f32; 3]) -> f32 {
        self.sampler(texel, &self.header.grid.view(view)).pdf(light)
    }
}
