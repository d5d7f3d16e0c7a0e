//! Blocks of BTFs.

use bytemuck::{Pod, Zeroable};
use subsurf_decoder::NestedBtf;
use subsurf_decoder::btf::nested::layout::MAX_STAGES;
use subsurf_decoder::btf::{CodebookOffsets, ColourEncoding, PackedTable};

/// `BtfTable` of `btf_words.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct BtfTable {
    /// First bit of the table in the file.
    pub start: u32,
    /// Number of bits of an item.
    pub width: u32,
    /// Number of bits of a row.
    pub row_bits: u32,
    /// Number of bits of an index.
    pub index_bits: u32,
    /// Largest valid index.
    pub last: u32,
    /// Mask of a code without its sign.
    pub code_mask: u32,
    /// Bit of the sign of a code.
    pub sign_at: u32,
    /// 1 if codes have signs.
    pub sign_mask: u32,
    /// Shift of codes: the scale of code c is 2^((offset + (c << step)) / 64).
    pub step: u32,
    /// Exponent of code 0 in 1/64 octaves.
    pub offset: i32,
    #[doc(hidden)]
    pub pad: [u32; 2],
}

/// `BtfCodebooks` of `btf_words.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct BtfCodebooks {
    /// Tables P6, P4, P3 and P2 of each stage; shape `[stage][4]`.
    pub chains: [BtfTable; 4 * MAX_STAGES],
    /// Table M: index of P2 and, above it, one of I2.
    pub merged: BtfTable,
    /// Table I2: indices of I1.
    pub i2: BtfTable,
    /// Table I1: indices of C.
    pub i1: BtfTable,
    /// First bit of the low bytes of the codes of P2, for each stage.
    pub p2_bytes: [u32; MAX_STAGES],
    /// First bit of P1, for each stage.
    pub p1: [u32; MAX_STAGES],
    /// 1 if values of P1 have signs, for each stage.
    pub is_signed: [u32; MAX_STAGES],
    /// First bit of C.
    pub colours: u32,
    /// First bit of the tints.
    pub tints: u32,
    /// Number of tints.
    pub tint_count: u32,
    /// First bit of the number of a tint in items of P6 of the first stage.
    pub tint_at: u32,
    /// Mask of the index of I2 in M.
    pub i2_mask: u32,
    /// Largest valid index of I2.
    pub last_i2: u32,
    /// Additive stages, 1 to 4.
    pub stages: u32,
    /// 1 if chroma is divided by luma.
    pub is_relative: u32,
    /// Chroma of code 0.
    pub first: [f32; 2],
    /// Chroma of a step of a code.
    pub step: [f32; 2],
    /// Nodes of the grid: n_α, n_β, n_θ, n_φ.
    pub nodes: [u32; 4],
    /// Largest α of the grid in rad.
    pub alpha_max: f32,
    /// Largest sin β of the grid.
    pub sin_beta_max: f32,
    /// Largest θ of the grid in rad.
    pub theta_max: f32,
    /// Cosine of the angle from the normal of the lowest measured light.
    pub cos_light_min: f32,
    /// 1 display values, 2 LogLuv.
    pub colour_encoding: u32,
    /// Radiance value of display white, linear, or the toe of LogLuv.
    pub white: f32,
    /// log2(1 + peak / toe) of LogLuv; 0 for display values.
    pub octaves: f32,
    /// Number of the last word of the file.
    pub last_word: u32,
}

impl BtfCodebooks {
    /// Block for a file of nested codebooks; `None` if its bits are more than 32-bit numbers count, which takes 512 MiB.
    #[must_use]
    pub fn of(btf: &NestedBtf<'_>) -> Option<Self> {
        let codebooks = CodebookOffsets::of(btf);
        let (chroma, grid) = (&codebooks.sizes.chroma, btf.grid());
        u32::try_from(btf.file().len()).ok()?.checked_mul(8)?;
        let mut books = Self::zeroed();
        let used = codebooks.stages.iter().zip(&codebooks.sizes.stages).take(codebooks.sizes.count).enumerate();
        for (stage, (tables, of_books)) in used {
            for (to, table) in books.chains.iter_mut().skip(4 * stage).zip(&tables.tables) {
                *to = BtfTable::new(table, of_books.is_signed);
            }
            books.p2_bytes[stage] = bit(tables.p2_bytes);
            books.p1[stage] = bit(tables.p1);
            books.is_signed[stage] = u32::from(of_books.is_signed);
        }
        let [p6, ..] = &codebooks.stages[0].tables;
        let (colour_encoding, white, octaves) = match btf.header().encoding {
            ColourEncoding::Display { white } => (1, white, 0.0),
            ColourEncoding::LogLuv { toe, peak } => (2, toe, (1.0 + peak / toe).log2()),
        };
        Some(Self {
            merged: BtfTable::new(&codebooks.merged, false),
            i2: BtfTable::new(&codebooks.i2, false),
            i1: BtfTable::new(&codebooks.i1, false),
            colours: bit(codebooks.colours),
            tints: bit(codebooks.tints),
            tint_count: chroma.tints,
            tint_at: p6.index_bits + u32::from(p6.scales.bits),
            i2_mask: mask(codebooks.merged.width - codebooks.merged.index_bits),
            last_i2: chroma.i2 - 1,
            stages: u32::try_from(codebooks.sizes.count).unwrap_or(1),
            is_relative: u32::from(chroma.is_relative),
            first: chroma.first,
            step: chroma.step,
            nodes: [grid.n_alpha, grid.n_beta, grid.n_theta, grid.n_phi].map(u32::from),
            alpha_max: grid.alpha_max,
            sin_beta_max: grid.sin_beta_max,
            theta_max: grid.theta_max,
            cos_light_min: grid.cos_light_min,
            colour_encoding,
            white,
            octaves,
            last_word: u32::try_from(btf.file().len().div_ceil(4) - 1).ok()?,
            ..books
        })
    }
}

impl BtfTable {
    fn new(table: &PackedTable, is_signed: bool) -> Self {
        let sign = u32::from(is_signed && table.scales.bits > 0);
        let below = u32::from(table.scales.bits) - sign;
        Self {
            start: bit(table.start),
            width: table.width,
            row_bits: table.width * u32::from(table.nodes),
            index_bits: table.index_bits,
            last: table.len.max(1) - 1,
            code_mask: mask(below),
            sign_at: below,
            sign_mask: sign,
            step: table.scales.step.into(),
            offset: table.scales.offset.into(),
            pad: [0; 2],
        }
    }
}

/// Mask of the lowest `width` bits, at most 31.
fn mask(width: u32) -> u32 {
    (1 << width) - 1
}

/// First bit of a byte of a file whose bits fit into 32-bit numbers.
fn bit(byte: u64) -> u32 {
    u32::try_from(8 * byte).unwrap_or(0)
}

/// Filter of the texels of a BTF.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BtfFiltering {
    /// Nearest texel of the nearest mipmap level.
    Nearest,
    /// Four texels of the nearest mipmap level, linearly.
    Bilinear,
    /// Four texels of each of the two levels around, linearly.
    Trilinear,
}

/// Largest number of mipmap levels of a material.
pub const MAX_LEVELS: usize = 16;

/// `BtfTexture` of `btf_texture.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct BtfTexture {
    /// First texel, width and height of each mipmap level, the finest first.
    pub levels: [[u32; 4]; MAX_LEVELS],
    /// Number of levels.
    pub count: u32,
    /// 0 nearest texel, 1 bilinear in the nearest level, 2 trilinear.
    pub filtering: u32,
    /// Number of samples of the environment for a pixel of the picture.
    pub samples: u32,
    #[doc(hidden)]
    pub pad: u32,
}

impl BtfTexture {
    /// Block for one material of a file, trilinear; `None` if there is no such material.
    #[must_use]
    pub fn of(btf: &NestedBtf<'_>, material: usize) -> Option<Self> {
        let of = btf.materials().nth(material)?;
        let mut levels = [[0; 4]; MAX_LEVELS];
        for (to, level) in levels.iter_mut().zip(0..of.levels) {
            let [width, height] = of.size(level);
            *to = [btf.texel(material, level, [0, 0])?.number(), width, height, 0];
        }
        Some(Self { levels, count: of.levels.into(), filtering: 2, samples: 0, pad: 0 })
    }

    /// Block for a texture of one level, its texels row by row.
    #[must_use]
    pub fn plain([width, height]: [u32; 2]) -> Self {
        let mut levels = [[0; 4]; MAX_LEVELS];
        levels[0] = [0, width, height, 0];
        Self { levels, count: 1, filtering: 2, samples: 0, pad: 0 }
    }

    /// The block with another filter and number of samples of the environment for a pixel.
    #[must_use]
    pub fn drawn(self, filtering: BtfFiltering, samples: u32) -> Self {
        let filtering = match filtering {
            BtfFiltering::Nearest => 0,
            BtfFiltering::Bilinear => 1,
            BtfFiltering::Trilinear => 2,
        };
        Self { filtering, samples, ..self }
    }
}

/// Largest number of rings of measured directions.
pub const MAX_RINGS_OF_DIRECTIONS: usize = 16;

/// `BtfImages` of `btf_images.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct BtfImages {
    /// Rings of directions of lights: angle from the normal in rad, number of directions, number of the first.
    pub light_rings: [[f32; 4]; MAX_RINGS_OF_DIRECTIONS],
    /// Rings of directions of views, likewise.
    pub view_rings: [[f32; 4]; MAX_RINGS_OF_DIRECTIONS],
    /// Numbers of rings of lights and of views.
    pub rings: [u32; 2],
    /// Pixels of an image, columns and rows.
    pub size: [u32; 2],
    /// Images to a row of a layer, which holds those of all lights.
    pub tiles: u32,
    /// Radiance value of display white, linear.
    pub white: f32,
    /// Cosine of the angle from the normal of the lowest light.
    pub cos_light_min: f32,
    #[doc(hidden)]
    pub pad: u32,
}
