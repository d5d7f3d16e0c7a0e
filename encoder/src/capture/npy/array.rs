//! The array of a capture: header checks, and windows as f32.

use std::path::Path;

use half::f16;
use npyz::{DType, NpyHeader, Order};
use subsurf_decoder::bssrdf::layout;

use crate::error::{Error, Result};

/// Element type of a capture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scalar {
    /// Little-endian binary32, `<f4`.
    F32,
    /// Little-endian binary16, `<f2`.
    F16,
}

impl Scalar {
    /// Bytes of one value.
    #[must_use]
    pub fn bytes(self) -> usize {
        match self {
            Self::F32 => 4,
            Self::F16 => 2,
        }
    }
}

/// Where the values of a capture lie.
#[derive(Clone, Copy, Debug)]
pub(super) struct Array {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) radius: usize,
    scalar: Scalar,
    /// First byte of the values.
    start: usize,
}

const EXPECTED: &str =
    "a C-order little-endian f4 or f2 array of shape (H, W, D, D, 3), D odd, as numpy.save writes it";

/// The longest header that is read. NumPy pads short ones to a multiple of 64.
const MAX_HEADER: usize = 4_096;
/// Brackets within brackets: a dictionary, and in it the shape.
const MAX_NESTING: usize = 2;
/// Digits of the largest shape there can be, (65535, 65535, 2047, 2047, 3): products of fewer fit in 64 bits.
const MAX_DIGITS: usize = 19;

/// Refuses headers that would keep the parser busy for ever or overflow its arithmetic.
fn check_header_text(file: &[u8]) -> std::result::Result<(), String> {
    // Magic and version; then the length of the text as u16, or from version 2 on as u32.
    let start = if file.get(6) == Some(&1) { 10 } else { 12 };
    let text = file.get(start..).unwrap_or_default();
    let text = &text[..text.iter().position(|byte| *byte == b'\n').unwrap_or(text.len())];
    if text.len() > MAX_HEADER {
        return Err(format!("a .npy header of more than {MAX_HEADER} bytes"));
    }
    let mut depth = 0_usize;
    for byte in text {
        match byte {
            b'(' | b'[' | b'{' => depth += 1,
            b')' | b']' | b'}' => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth > MAX_NESTING {
            return Err("a nested type or shape".to_owned());
        }
    }
    let after = |byte: u8| text.iter().position(|b| *b == byte).unwrap_or(text.len());
    let shape = text.get(after(b'(')..after(b')')).unwrap_or_default();
    if shape.iter().filter(|byte| byte.is_ascii_digit()).count() > MAX_DIGITS {
        return Err(format!("shape {}", String::from_utf8_lossy(shape).trim_start_matches('(')));
    }
    Ok(())
}

/// A side of a patch in pixels, if a file could hold it.
fn check_side(path: &Path, what: &str, pixels: u64) -> Result<usize> {
    let limit = u64::from(layout::MAX_SIDE);
    match usize::try_from(pixels) {
        Ok(side) if (1..=limit).contains(&pixels) => Ok(side),
        _ => Err(Error::input(path, format!("{what} {pixels}"), format!("{what} from 1 to {limit} pixels"))),
    }
}

pub(super) fn parse(path: &Path, file: &[u8]) -> Result<Array> {
    let wrong = |found: String| Error::input(path, found, EXPECTED);
    check_header_text(file).map_err(wrong)?;
    let mut rest = file;
    let header =
        NpyHeader::from_reader(&mut rest).map_err(|error| wrong(format!("not a readable .npy header ({error})")))?;
    let start = file.len() - rest.len();

    let scalar = match header.dtype() {
        DType::Plain(ty) if ty.to_string() == "<f4" => Scalar::F32,
        DType::Plain(ty) if ty.to_string() == "<f2" => Scalar::F16,
        other => return Err(wrong(format!("type {}", other.descr()))),
    };
    if header.order() != Order::C {
        return Err(wrong("Fortran order".to_owned()));
    }
    let shape = header.shape().to_vec();
    let &[height, width, d, d_x, 3] = &shape[..] else {
        return Err(wrong(format!("shape {shape:?}")));
    };
    if d != d_x {
        return Err(wrong(format!("shape {shape:?}: the window is not square")));
    }
    let limit = 2 * u64::from(layout::MAX_WINDOW_RADIUS) + 1;
    if d % 2 == 0 || d > limit {
        return Err(Error::input(
            path,
            format!("shape {shape:?}: a window of {d} pixels"),
            format!("an odd window of at most {limit} pixels"),
        ));
    }
    let array = Array {
        width: check_side(path, "width", width)?,
        height: check_side(path, "height", height)?,
        radius: usize::from(u16::try_from(d / 2).unwrap_or(u16::MAX)),
        scalar,
        start,
    };
    // At most 65,535² · 2,047² · 3 · 4 < 2⁵⁸: no overflow.
    let need = (array.width * array.height * array.window_len() * scalar.bytes()) as u64;
    let have = (file.len() - start) as u64;
    if have < need {
        return Err(Error::input(
            path,
            format!("the file is cut: {have} bytes of values"),
            format!("{need} bytes for shape {shape:?}"),
        ));
    }
    Ok(array)
}

impl Array {
    pub(super) fn window_len(&self) -> usize {
        let d = 2 * self.radius + 1;
        d * d * 3
    }

    /// The window of one pixel; values that are no measurement become 0.
    pub(super) fn read(&self, file: &[u8], pixel: usize, out: &mut [f32]) {
        let bytes = self.window_len() * self.scalar.bytes();
        let window = &file[self.start + pixel * bytes..][..bytes];
        let out = &mut out[..self.window_len()];
        let measured = |rd: f32| if rd.is_finite() && rd > 0.0 { rd } else { 0.0 };
        match self.scalar {
            Scalar::F32 => {
                for (out, value) in out.iter_mut().zip(window.as_chunks().0) {
                    *out = measured(f32::from_le_bytes(*value));
                }
            }
            Scalar::F16 => {
                for (out, value) in out.iter_mut().zip(window.as_chunks().0) {
                    *out = measured(f16::from_le_bytes(*value).to_f32());
                }
            }
        }
    }
}
