//! Compressed BTFs of the database of Bonn.
//!
//! A `.btf` file of the database UBO2014 (Weinmann, Gall, Klein 2014) holds one big matrix, pairs of a light and a view
//! against texels, as factors U and S V of a truncated singular value decomposition: of each channel of decorrelated
//! colours by itself (DFMF), or of red, green and blue together (FMF). All is little-endian:
//!
//! | field | type | |
//! |---|---|---|
//! | signature | 8 to 10 characters | `!DFMF08FCR`, `!FMF12FCER`, `!FMF06FCR` or `!FMF06FC` |
//! | header size, version | 2 u32 | from here to before the views; 1 to 4 |
//! | set-up, sensor, light source | 3 × 80 characters | |
//! | pixels per mm, RGB scale | f32, 3 f32 | the latter is applied by no public reader, and not here |
//! | cosine flag | u32 | from version 2 |
//! | XML | u32 length, text | from version 3 |
//! | channels | u32 count, each u32 length, name | from version 4; 3 otherwise |
//! | views | u32 count | |
//! | each view | θ, φ in f32 radians, u32 count of lights, their θ, φ | lights are the same for all views |
//! | width, height | 2 u32 | |
//! | rotations | u32 count, each 9 f32 | where the signature ends with R |
//! | DFMF: components, colour model | 2 u32 | the largest number; [`colour`] |
//! | DFMF: mean colour, axes | 3 f32, 9 f32 | |
//! | FMF12: version | u8 | 0 to 2 |
//! | FMF12: dynamic range reduction | u32 | from 1; other than 0 for logarithms |
//! | FMF12: height map | u32 width, u32 height, f16 each | from 2 |
//! | FMF: components | u32 | |
//! | bytes of a number | u8 | 2, 4 or 8; from here on once (FMF) or for each channel (DFMF) |
//! | components, rows of U, rows of S V | 3 u32 | |
//! | S, U, S V | components, components each row | row by row |
//!
//! Row v · lights + l of U is that of a pair, row y · width + x of S V that of a texel, the first row on top; in FMF
//! three rows of U follow each other, for red, green and blue. U and S V may change places.

mod colour;
mod factors;
mod header;
mod source;

use std::fs::File;
use std::path::{Path, PathBuf};

use glam::Vec3;
use memmap2::Mmap;
use rayon::prelude::*;

use crate::capture::bytes::Bytes;
use crate::error::{Error, Result};
use colour::Colour;
use factors::Channel;
use header::Header;

/// A compressed BTF of the database of Bonn (UBO2014, `.btf`) on disk, memory-mapped: full-matrix factorisations, FMF
/// and DFMF. Images are made when they are asked for.
///
/// The file has angles in radians and does not say which way azimuths go. They are taken to go from the rows' direction
/// *up* the image, against the columns', and are turned here: public readers that draw with these files put the last
/// row at texture coordinate v = 0, and use directions as they are, in a frame whose second axis is that of v. It has
/// not been confirmed with a measured file.
///
/// Refused are frames that rotate from pixel to pixel, which no public reader applies; colours as Lab or spectra, and
/// other than three channels; and what is factorised otherwise (PVF) or not at all (BDI).
#[derive(Debug)]
pub struct Ubo {
    path: PathBuf,
    map: Mmap,
    layout: Layout,
}

/// What is where in a file.
#[derive(Debug)]
struct Layout {
    header: Header,
    channels: [Channel; 3],
    colour: Colour,
}

impl Ubo {
    /// Maps a `.btf` file of UBO2014, and looks where everything is.
    ///
    /// # Errors
    /// [`Error::Input`] if it is another file, cut, or of a kind that is not read.
    pub fn open(path: &Path) -> Result<Self> {
        let file = File::open(path).map_err(|error| Error::input(path, error, "a BTF (.btf) that can be read"))?;
        // SAFETY: the mapping is read-only. Another process that truncates or rewrites the file meanwhile breaks
        // every reader of maps; databases are not changed in place.
        let map = unsafe { Mmap::map(&file) }
            .map_err(|error| Error::input(path, error, "a BTF (.btf) that can be mapped"))?;
        let layout = Layout::parse(path, &map)?;
        Ok(Self { path: path.to_owned(), map, layout })
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Unit vectors towards the lights: x along the rows, y down the columns, z away from the sample.
    #[must_use]
    pub fn lights(&self) -> &[Vec3] {
        &self.layout.header.lights
    }

    /// Unit vectors towards the viewer, in the same frame.
    #[must_use]
    pub fn views(&self) -> &[Vec3] {
        &self.layout.header.views
    }

    /// Pixels in x and in y.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.layout.header.size
    }

    /// Whether the file says that its values have the cosine of the light's angle to the normal in them. The database's
    /// own library then divides by it; [`Ubo::read`] does not.
    #[must_use]
    pub fn has_cosine(&self) -> bool {
        self.layout.header.cosine
    }

    /// One image, row by row: linear RGB as the file has it, neither clipped nor scaled. Compression leaves some values
    /// below zero.
    ///
    /// # Errors
    /// [`Error::Request`] if there is no such light or view; [`Error::Input`] if a value is not finite.
    pub fn read(&self, light: usize, view: usize) -> Result<Vec<[f32; 3]>> {
        self.layout.read(&self.path, &self.map, light, view)
    }
}

impl Layout {
    fn parse(path: &Path, file: &[u8]) -> Result<Self> {
        let mut bytes = Bytes::new(path, file);
        let header = Header::parse(&mut bytes)?;
        let (channels, colour) = factors::parse(&mut bytes, &header)?;
        Ok(Self { header, channels, colour })
    }

    fn read(&self, path: &Path, file: &[u8], light: usize, view: usize) -> Result<Vec<[f32; 3]>> {
        let (lights, views) = (self.header.lights.len(), self.header.views.len());
        if light >= lights || view >= views {
            let path = path.display();
            return Err(Error::Request(format!("{path}: light {light}, view {view}: there are {lights} and {views}")));
        }
        let pairs = self.channels.map(|channel| channel.pair(file, view * lights + light));
        let value = |texel| {
            let channels = std::array::from_fn(|c| self.channels[c].value(file, texel, &pairs[c]));
            self.colour.decode(channels)
        };
        let [width, height] = self.header.size.map(|pixels| pixels as usize);
        let texels = (0..width * height).into_par_iter().with_min_len(width);
        let colours = texels.map(|texel| {
            let colour = value(texel);
            if !colour.is_finite() {
                let found = format!("light {light}, view {view}: a colour of {colour} at texel {texel}");
                return Err(Error::input(path, found, "finite values"));
            }
            Ok(colour.to_array())
        });
        colours.collect()
    }
}

#[cfg(test)]
mod tests;
