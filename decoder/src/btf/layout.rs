//! `BTFH`: model, colour encoding and grid of a BTF file.

use super::colour::ColourEncoding;
use super::grid::{Grid, MAX_NODES};
use super::material::MATERIAL_BYTES;
use crate::bssrdf::layout::LENGTHS_MM;
use crate::container::record::{Field, record};
use crate::container::sections::SectionBytes;
use crate::error::ReadError;
use crate::family::Family;
use core::f32::consts::FRAC_PI_2;
use core::mem::offset_of;

/// Bytes of the `BTFH` section.
pub const HEADER_BYTES: usize = size_of::<HeaderRecord>();
/// Smallest and largest linear values.
const LINEAR_VALUES: [f32; 2] = [1e-6, 1e6];
/// Smallest reach of a grid along α and θ_v in rad, and along sin β.
const MIN_REACH: f32 = 1e-3;
/// Largest cos θ_i of the lowest measured light.
const MAX_COS_LIGHT: f32 = 0.999;

/// Model of the apparent BRDFs of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BtfModel {
    /// Nested codebooks (Havran et al. 2010).
    Nested,
    /// Tucker decomposition and codewords of texels.
    Factored,
}

impl BtfModel {
    /// Code in the header.
    fn code(self) -> u8 {
        match self {
            Self::Nested => 1,
            Self::Factored => 2,
        }
    }

    fn from_code(code: u8) -> Option<Self> {
        [Self::Nested, Self::Factored].into_iter().find(|model| model.code() == code)
    }

    /// Family of files of this model.
    #[must_use]
    pub fn family(self) -> Family {
        match self {
            Self::Nested => Family::NestedBtf,
            Self::Factored => Family::FactoredBtf,
        }
    }
}

/// Code of [`ColourEncoding::Display`].
const DISPLAY: u8 = 1;
/// Code of [`ColourEncoding::LogLuv`].
const LOG_LUV: u8 = 2;

record! {
    /// The `BTFH` section (`FORMAT.md`, section 4.1).
    HeaderRecord {
        model: u8,
        encoding: u8,
        materials: u8,
        reserved: u8,
        n_alpha: u8,
        n_beta: u8,
        n_theta: u8,
        n_phi: u8,
        alpha_max: f32,
        sin_beta_max: f32,
        theta_max: f32,
        cos_light_min: f32,
        white_or_toe: f32,
        peak: f32,
        texel_mm: f32,
    }
}

/// Header of a BTF file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BtfHeader {
    /// Model of the apparent BRDFs.
    pub model: BtfModel,
    /// Meaning of luma and chroma.
    pub encoding: ColourEncoding,
    /// Number of materials, 1 to 255.
    pub materials: u8,
    /// Nodes of directions.
    pub grid: Grid,
    /// Distance of neighbouring texels of the finest level in mm, 10⁻⁶ to 10⁶, where it is known.
    pub texel_mm: Option<f32>,
}

impl BtfHeader {
    /// The section as it stands in the file.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; HEADER_BYTES] {
        let (encoding, white_or_toe, peak) = match self.encoding {
            ColourEncoding::Display { white } => (DISPLAY, white, 0.0),
            ColourEncoding::LogLuv { toe, peak } => (LOG_LUV, toe, peak),
        };
        let Grid { n_alpha, n_beta, n_theta, n_phi, alpha_max, sin_beta_max, theta_max, cos_light_min } = self.grid;
        HeaderRecord {
            model: self.model.code(),
            encoding,
            materials: self.materials,
            reserved: 0,
            n_alpha,
            n_beta,
            n_theta,
            n_phi,
            alpha_max,
            sin_beta_max,
            theta_max,
            cos_light_min,
            white_or_toe,
            peak,
            texel_mm: self.texel_mm.unwrap_or(0.0),
        }
        .to_bytes()
    }

    /// Bytes of `MATS`.
    pub(super) fn materials_bytes(&self) -> u64 {
        u64::from(self.materials).saturating_mul(MATERIAL_BYTES as u64)
    }

    /// Reads and checks the section.
    pub(crate) fn parse(section: SectionBytes<'_>) -> Result<Self, ReadError> {
        use HeaderRecord as R;
        let record = R::from_bytes(section.at_least(HEADER_BYTES as u64)?.bytes);
        let origin = section.origin;

        let bad_model = origin.bad_field(offset_of!(R, model), record.model);
        let model = BtfModel::from_code(record.model).ok_or(bad_model)?;
        let materials = origin.integer(offset_of!(R, materials), record.materials, 1..=u8::MAX.into())?;
        let nodes = |at, value: u8, fewest| origin.integer(at, value, fewest..=MAX_NODES.into());
        let grid = Grid {
            n_alpha: nodes(offset_of!(R, n_alpha), record.n_alpha, 2)?,
            n_beta: nodes(offset_of!(R, n_beta), record.n_beta, 2)?,
            n_theta: nodes(offset_of!(R, n_theta), record.n_theta, 2)?,
            n_phi: nodes(offset_of!(R, n_phi), record.n_phi, 1)?,
            alpha_max: origin.number(offset_of!(R, alpha_max), record.alpha_max, [MIN_REACH, FRAC_PI_2])?,
            sin_beta_max: origin.number(offset_of!(R, sin_beta_max), record.sin_beta_max, [MIN_REACH, 1.0])?,
            theta_max: origin.number(offset_of!(R, theta_max), record.theta_max, [MIN_REACH, FRAC_PI_2])?,
            cos_light_min: origin.number(offset_of!(R, cos_light_min), record.cos_light_min, [0.0, MAX_COS_LIGHT])?,
        };
        let white_or_toe = || origin.number(offset_of!(R, white_or_toe), record.white_or_toe, LINEAR_VALUES);
        let encoding = match record.encoding {
            DISPLAY => ColourEncoding::Display { white: white_or_toe()? },
            LOG_LUV => {
                let (toe, [_, most]) = (white_or_toe()?, LINEAR_VALUES);
                ColourEncoding::LogLuv { toe, peak: origin.number(offset_of!(R, peak), record.peak, [toe, most])? }
            }
            other => return Err(origin.bad_field(offset_of!(R, encoding), other)),
        };
        let texel_mm = match record.texel_mm {
            0.0 => None,
            size => Some(origin.number(offset_of!(R, texel_mm), size, LENGTHS_MM)?),
        };
        Ok(Self { model, encoding, materials, grid, texel_mm })
    }
}
