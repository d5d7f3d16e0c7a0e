//! Values that several commands take.

use std::str::FromStr;

use clap::ValueEnum;
use subsurf_decoder::bssrdf::Addressing;
use subsurf_encoder::capture::Overrides;

/// What lies beyond the border of a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum AddressingArg {
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

/// Facts about a capture that its sidecar, NAME.json, usually states.
#[derive(clap::Args, Clone, Copy, Debug)]
pub(crate) struct CaptureArgs {
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
    pub(crate) fn overrides(&self) -> Overrides {
        Overrides { pitch_mm: self.pitch, addressing: self.addressing.map(Into::into), eta: self.eta }
    }
}

/// WIDTHxHEIGHT, or one number for both.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Size(pub(crate) [u32; 2]);

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes() {
        assert_eq!("640x480".parse(), Ok(Size([640, 480])));
        assert_eq!("80".parse(), Ok(Size([80, 80])));
        assert!("0x1".parse::<Size>().is_err() && "ax1".parse::<Size>().is_err(), "no pixels");
    }
}
