//! Blocks of BTFs.

use bytemuck::{Pod, Zeroable};
use subsurf_decoder::Btf;
use subsurf_decoder::btf::layout::MAX_STAGES;
use subsurf_decoder::btf::{Codebooks, PackedTable, Tone};

/// `BtfTable` of `btf_words.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct BtfTable {
    /// First bit in the file.
    pub start: u32,
    /// Bits of an item.
    pub width: u32,
    /// Bits of a row.
    pub row_bits: u32,
    /// Bits of an index.
    pub index_bits: u32,
    /// The largest index.
    pub last: u32,
    /// Bits of a code that are not its sign.
    pub code_mask: u32,
    /// Where the sign of a code is.
    pub sign_at: u32,
    /// 1 if codes have signs.
    pub sign_mask: u32,
    /// Code c stands for 2^((offset + (c << step)) / 64).
    pub step: u32,
    /// See `step`.
    pub offset: i32,
    #[doc(hidden)]
    pub pad: [u32; 2],
}

/// `BtfBooks` of `btf_words.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct BtfBooks {
    /// P6, P4, P3 and P2 of each stage.
    pub chains: [BtfTable; 4 * MAX_STAGES],
    /// M: index of P2 and, above it, one of I2.
    pub merged: BtfTable,
    /// I2: indices of I1.
    pub i2: BtfTable,
    /// I1: indices of C.
    pub i1: BtfTable,
    /// Of each stage, first bit of the lowest eight bits of the codes of P2.
    pub p2_bytes: [u32; MAX_STAGES],
    /// Of each stage, first bit of P1.
    pub p1: [u32; MAX_STAGES],
    /// Of each stage, 1 if values of P1 have signs.
    pub is_signed: [u32; MAX_STAGES],
    /// First bit of C.
    pub colours: u32,
    /// First bit of the tints.
    pub tints: u32,
    /// Number of tints.
    pub tint_count: u32,
    /// First bit of a tint in items of P6 of the first stage.
    pub tint_at: u32,
    /// Of the index of I2 in M.
    pub i2_mask: u32,
    /// The largest index of I2.
    pub last_i2: u32,
    /// Additive stages, 1 to 4.
    pub stages: u32,
    /// 1 if chroma is divided by luma.
    pub is_relative: u32,
    /// Chroma of code 0.
    pub first: [f32; 2],
    /// Chroma of a step of a code.
    pub step: [f32; 2],
    /// n_α, n_β, n_θ, n_φ.
    pub nodes: [u32; 4],
    /// Of the grid, in rad.
    pub alpha_max: f32,
    /// Of the grid.
    pub sin_beta_max: f32,
    /// Of the grid, in rad.
    pub theta_max: f32,
    /// Of the grid.
    pub cos_light_min: f32,
    /// 1 display, 2 LogLuv.
    pub tone: u32,
    /// Linear value of display white, or the toe of LogLuv.
    pub white: f32,
    /// log2(1 + peak / toe); 0 for displays.
    pub octaves: f32,
    /// The last word of the file.
    pub last_word: u32,
}

impl BtfBooks {
    /// Of a file of nested codebooks; `None` if its bits are more than 32-bit numbers count, which takes 512 MiB.
    #[must_use]
    pub fn of(btf: &Btf<'_>) -> Option<Self> {
        let codebooks = Codebooks::of(btf);
        let (chroma, grid) = (&codebooks.books.chroma, btf.grid());
        u32::try_from(btf.file().len()).ok()?.checked_mul(8)?;
        let mut books = Self::zeroed();
        let used = codebooks.stages.iter().zip(&codebooks.books.stages).take(codebooks.books.count).enumerate();
        for (stage, (tables, of_books)) in used {
            for (to, table) in books.chains.iter_mut().skip(4 * stage).zip(&tables.tables) {
                *to = BtfTable::new(table, of_books.is_signed);
            }
            books.p2_bytes[stage] = bit(tables.p2_bytes);
            books.p1[stage] = bit(tables.p1);
            books.is_signed[stage] = u32::from(of_books.is_signed);
        }
        let [p6, ..] = &codebooks.stages[0].tables;
        let (tone, white, octaves) = match btf.header().tone {
            Tone::Display { white } => (1, white, 0.0),
            Tone::LogLuv { toe, peak } => (2, toe, (1.0 + peak / toe).log2()),
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
            stages: u32::try_from(codebooks.books.count).unwrap_or(1),
            is_relative: u32::from(chroma.is_relative),
            first: chroma.first,
            step: chroma.step,
            nodes: [grid.n_alpha, grid.n_beta, grid.n_theta, grid.n_phi].map(u32::from),
            alpha_max: grid.alpha_max,
            sin_beta_max: grid.sin_beta_max,
            theta_max: grid.theta_max,
            cos_light_min: grid.cos_light_min,
            tone,
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

/// The lowest `width` bits, of at most 31.
fn mask(width: u32) -> u32 {
    (1 << width) - 1
}

/// First bit of a byte of a file whose bits fit into 32-bit numbers.
fn bit(byte: u64) -> u32 {
    u32::try_from(8 * byte).unwrap_or(0)
}

/// Which texels a pixel shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BtfFiltering {
    /// The nearest one, of the nearest mipmap level.
    Nearest,
    /// Four, linearly, of the nearest mipmap level.
    Bilinear,
    /// Four of each of both levels around, linearly.
    Trilinear,
}

/// Most mipmap levels of a material.
pub const MAX_LEVELS: usize = 16;

/// `BtfTexture` of `btf_texture.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct BtfTexture {
    /// First texel, width and height of each mipmap level, the finest first.
    pub levels: [[u32; 4]; MAX_LEVELS],
    /// Number of levels.
    pub count: u32,
    /// 0 nearest, 1 bilinear, 2 trilinear.
    pub filtering: u32,
    /// Samples of light from all around, for a pixel.
    pub samples: u32,
    #[doc(hidden)]
    pub pad: u32,
}

impl BtfTexture {
    /// Of one material of a file, filtered; `None` if there is no such material.
    #[must_use]
    pub fn of(btf: &Btf<'_>, material: usize) -> Option<Self> {
        let of = btf.materials().nth(material)?;
        let mut levels = [[0; 4]; MAX_LEVELS];
        for (to, level) in levels.iter_mut().zip(0..of.levels) {
            let [width, height] = of.size(level);
            *to = [btf.texel(material, level, [0, 0])?.number(), width, height, 0];
        }
        Some(Self { levels, count: of.levels.into(), filtering: 2, samples: 0, pad: 0 })
    }

    /// Of a texture of one level, its texels row by row.
    #[must_use]
    pub fn plain([width, height]: [u32; 2]) -> Self {
        let mut levels = [[0; 4]; MAX_LEVELS];
        levels[0] = [0, width, height, 0];
        Self { levels, count: 1, filtering: 2, samples: 0, pad: 0 }
    }

    /// The same, filtered in another way, with so many samples of light from all around for a pixel.
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

/// Most rings of measured directions.
pub const MAX_RINGS_OF_DIRECTIONS: usize = 16;

/// `BtfImages` of `btf_images.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct BtfImages {
    /// Rings of lights: angle from the normal in rad, number of directions, number of the first.
    pub light_rings: [[f32; 4]; MAX_RINGS_OF_DIRECTIONS],
    /// Likewise of views.
    pub view_rings: [[f32; 4]; MAX_RINGS_OF_DIRECTIONS],
    /// Rings of lights and of views.
    pub rings: [u32; 2],
    /// Pixels of an image.
    pub size: [u32; 2],
    /// Images to a row of a layer.
    pub tiles: u32,
    /// Linear value of display white.
    pub white: f32,
    /// cos θ of the lowest light.
    pub cos_light_min: f32,
    #[doc(hidden)]
    pub pad: u32,
}
