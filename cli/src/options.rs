//! Options: values that several commands take.

use std::path::Path;
use std::str::FromStr;

use clap::ValueEnum;
use subsurf_decoder::bssrdf::Addressing;
use subsurf_encoder::capture::{Capture, Overrides};
use subsurf_scene::{Mesh, UpAxis, load_mesh};

use crate::program::warnings::warn;

/// What lies beyond the border of a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum AddressingArg {
    /// The material ends there; a renderer draws the border pixel out.
    Clamp,
    /// The patch repeats: tileable.
    Repeat,
    /// The patch repeats, every other copy reflected.
    Mirror,
}

impl From<AddressingArg> for Addressing {
    fn from(arg: AddressingArg) -> Self {
        match arg {
            AddressingArg::Clamp => Self::Clamp,
            AddressingArg::Repeat => Self::Repeat,
            AddressingArg::Mirror => Self::Mirror,
        }
    }
}

/// Which way is up in a mesh file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum UpArg {
    /// As in glTF and most OBJ files
    Y,
    /// As in most scans and CAD files
    Z,
}

impl From<UpArg> for UpAxis {
    fn from(arg: UpArg) -> Self {
        match arg {
            UpArg::Y => Self::Y,
            UpArg::Z => Self::Z,
        }
    }
}

/// Size of a mesh and how it stands.
#[derive(clap::Args, Clone, Copy, Debug)]
pub struct MeshArgs {
    /// Longest side of the mesh in mm
    #[arg(long, default_value_t = 60.0, value_name = "MM")]
    pub extent: f32,
    /// Which way is up in the mesh
    #[arg(long, value_enum, default_value = "y")]
    pub(crate) up: UpArg,
}

impl MeshArgs {
    /// The mesh of a file or a shape; what was changed or left out of it is said.
    ///
    /// # Errors
    /// As [`load_mesh`].
    pub fn load(&self, path: &Path) -> subsurf_scene::Result<Mesh> {
        let loaded = load_mesh(path, self.extent, self.up.into())?;
        for warning in &loaded.warnings {
            warn(&format!("{}: {warning}", path.display()));
        }
        Ok(loaded.mesh)
    }
}

/// Facts about a capture that its sidecar, NAME.json, usually states.
#[derive(clap::Args, Clone, Copy, Debug)]
pub struct CaptureArgs {
    /// Distance of neighbouring pixels in mm; wins over the sidecar
    #[arg(long, value_name = "MM")]
    pitch: Option<f32>,
    /// What lies beyond the border; wins over the sidecar
    #[arg(long, value_name = "MODE")]
    addressing: Option<AddressingArg>,
    /// Refractive index; wins over the sidecar
    #[arg(long, value_name = "INDEX")]
    eta: Option<f32>,
}

impl CaptureArgs {
    /// Opens a capture, of which these facts win over those of the sidecar; warns of what is left out.
    ///
    /// # Errors
    /// As [`Capture::open`].
    pub fn open(&self, path: &Path) -> subsurf_encoder::Result<Capture> {
        let facts = Overrides { pitch_mm: self.pitch, addressing: self.addressing.map(Into::into), eta: self.eta };
        let capture = Capture::open(path, &facts)?;
        capture.warnings().iter().for_each(|warning| warn(warning));
        Ok(capture)
    }
}

/// WIDTHxHEIGHT, or one number for both.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size(
    /// Width and height.
    pub [u32; 2],
);

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (width, height) = text.split_once(['x', 'X', '×']).unwrap_or((text, text));
        let side = |text: &str| match text.trim().parse() {
            Ok(side) if side > 0 => Ok(side),
            _ => Err(format!("\"{text}\" is no number of pixels; write for example 640x480")),
        };
        Ok(Self([side(width)?, side(height)?]))
    }
}

impl std::fmt::Display for Size {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}x{}", self.0[0], self.0[1])
    }
}

/// A number of bytes: 40000, 40kB, 1.5GB.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ByteCount(
    /// Bytes.
    pub u64,
);

impl FromStr for ByteCount {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let end = text.trim_end_matches(|c: char| c.is_ascii_alphabetic()).len();
        let (number, unit) = text.split_at(end);
        let factor = match unit.to_ascii_lowercase().as_str() {
            "" | "b" => 1.0,
            "k" | "kb" => 1e3,
            "m" | "mb" => 1e6,
            "g" | "gb" => 1e9,
            _ => return Err(format!("\"{unit}\" is no unit; B, kB, MB and GB are")),
        };
        match number.trim().parse::<f64>() {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
            Ok(number) if number > 0.0 && number.is_finite() => Ok(Self((number * factor) as u64)),
            _ => Err(format!("\"{text}\" is no size; write for example 40000 or 40kB")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn byte_counts() {
        let bytes = |text: &str| text.parse::<ByteCount>().map(|count| count.0);
        assert_eq!(bytes("40000"), Ok(40_000));
        assert_eq!(bytes("40kB"), Ok(40_000));
        assert_eq!(bytes("1.5 GB"), Ok(1_500_000_000));
        assert!(["", "-1", "4 kib", "NaN", "infGB"].iter().all(|text| bytes(text).is_err()), "no sizes");
    }

    #[test]
    fn sizes() {
        assert_eq!("640x480".parse(), Ok(Size([640, 480])));
        assert_eq!("80".parse(), Ok(Size([80, 80])));
        assert!("0x1".parse::<Size>().is_err() && "ax1".parse::<Size>().is_err(), "no pixels");
    }
}
