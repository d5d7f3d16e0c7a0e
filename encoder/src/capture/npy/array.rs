//! The array of a capture: header checks, and windows as f32.

use std::path::Path;

use half::f16;
use npyz::{DType, Endianness, NpyHeader, Order, TypeChar, TypeStr};
use subsurf_decoder::bssrdf::layout;

use super::header_text::check_header_text;
use crate::error::{Error, Result};

/// Element type of a capture that is written.
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

/// Element type of a capture that is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Element {
    /// 2, 4 or 8.
    bytes: usize,
    is_big_endian: bool,
}

impl Element {
    fn of(ty: &TypeStr) -> Option<Self> {
        let bytes = ty.num_bytes().filter(|bytes| [2, 4, 8].contains(bytes))?;
        let is_big_endian = ty.endianness() == Endianness::Big;
        (ty.type_char() == TypeChar::Float).then_some(Self { bytes, is_big_endian })
    }
}

/// What the header of an array states.
pub(super) struct Header {
    element: Element,
    order: Order,
    pub(super) shape: Vec<u64>,
    /// First byte of the values.
    start: usize,
}

/// Where the values of a capture lie.
#[derive(Clone, Copy, Debug)]
pub(super) struct Array {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) radius: usize,
    /// Bytes behind the values.
    pub(super) bytes_behind: u64,
    element: Element,
    order: Order,
    /// First byte of the values.
    start: usize,
}

pub(super) const EXPECTED: &str =
    "an array of shape (H, W, D, D, 3), D odd, of type f2, f4 or f8, as numpy.save or numpy.savez writes it";

impl Header {
    /// Reads the header of an array, of which `file` has the beginning at least.
    pub(super) fn parse(file: &[u8]) -> std::result::Result<Self, String> {
        check_header_text(file)?;
        let mut rest = file;
        let header = NpyHeader::from_reader(&mut rest).map_err(|error| {
            // Of a drawing of the place, where it is and what it should be.
            let text = error.to_string();
            let mut lines = text.lines().map(|line| line.trim_matches([' ', '-', '>', '=', '|']));
            let (first, last) = (lines.next().unwrap_or_default(), lines.next_back());
            let last = last.map_or_else(String::new, |last| format!(": {last}"));
            format!("not a readable .npy header ({first}{last})")
        })?;
        let element = match header.dtype() {
            DType::Plain(ty) => Element::of(&ty).ok_or_else(|| format!("type {}", header.dtype().descr()))?,
            other => return Err(format!("type {}", other.descr())),
        };
        let start = file.len() - rest.len();
        Ok(Self { element, order: header.order(), shape: header.shape().to_vec(), start })
    }
}

/// A side of a patch in pixels, if a file could hold it.
fn check_side(path: &Path, what: &str, pixels: u64) -> Result<usize> {
    let limit = u64::from(layout::MAX_SIDE);
    match usize::try_from(pixels) {
        Ok(side) if (1..=limit).contains(&pixels) => Ok(side),
        _ => Err(Error::input(path, format!("{what} {pixels}"), format!("{what} from 1 to {limit} pixels"))),
    }
}

/// Values of one window of `radius`.
fn window_len(radius: usize) -> usize {
    let d = 2 * radius + 1;
    d * d * 3
}

impl Array {
    pub(super) fn parse(path: &Path, file: &[u8]) -> Result<Self> {
        let wrong = |found: String| Error::input(path, found, EXPECTED);
        let Header { element, order, shape, start } = Header::parse(file).map_err(wrong)?;
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
        let (width, height) = (check_side(path, "width", width)?, check_side(path, "height", height)?);
        let radius = usize::from(u16::try_from(d / 2).unwrap_or(u16::MAX));
        // At most 65,535² · 2,047² · 3 · 8 < 2⁵⁹: no overflow.
        let need = (width * height * window_len(radius) * element.bytes) as u64;
        let have = (file.len() - start) as u64;
        if have < need {
            return Err(Error::input(
                path,
                format!("the file is cut: {have} bytes of values"),
                format!("{need} bytes for shape {shape:?}"),
            ));
        }
        Ok(Self { width, height, radius, bytes_behind: have - need, element, order, start })
    }

    pub(super) fn window_len(&self) -> usize {
        window_len(self.radius)
    }

    /// The window of one pixel; values that are no measurement become 0. Returns how many of them are positive, but below
    /// the normal numbers of single precision.
    pub(super) fn read(&self, file: &[u8], pixel: usize, out: &mut [f32]) -> u64 {
        let values = &file[self.start..];
        let of_f4 = |value: u32| f64::from(f32::from_bits(value));
        match (self.element.bytes, self.element.is_big_endian) {
            (4, false) => self.fill(values, pixel, out, |bytes| of_f4(u32::from_le_bytes(bytes))),
            (4, true) => self.fill(values, pixel, out, |bytes| of_f4(u32::from_be_bytes(bytes))),
            (2, false) => self.fill(values, pixel, out, |bytes| f16::from_le_bytes(bytes).to_f64()),
            (2, true) => self.fill(values, pixel, out, |bytes| f16::from_be_bytes(bytes).to_f64()),
            (_, false) => self.fill(values, pixel, out, f64::from_le_bytes),
            (_, true) => self.fill(values, pixel, out, f64::from_be_bytes),
        }
    }

    fn fill<const N: usize>(&self, bytes: &[u8], pixel: usize, out: &mut [f32], value: impl Fn([u8; N]) -> f64) -> u64 {
        let values: &[[u8; N]] = bytes.as_chunks().0;
        let out = &mut out[..self.window_len()];
        let mut faint = 0;
        let mut set = |out: &mut f32, bytes: [u8; N]| {
            let (rd, is_faint) = measured(value(bytes));
            *out = rd;
            faint += u64::from(is_faint);
        };
        match self.order {
            Order::C => {
                let window = &values[pixel * out.len()..][..out.len()];
                out.iter_mut().zip(window).for_each(|(out, bytes)| set(out, *bytes));
            }
            Order::Fortran => {
                // The first index runs fastest: y, x, dy, dx, c.
                let d = 2 * self.radius + 1;
                let first = pixel / self.width + self.height * (pixel % self.width);
                let pixels = self.width * self.height;
                for (k, out) in out.iter_mut().enumerate() {
                    let (place, c) = (k / 3, k % 3);
                    let at = place / d + d * (place % d) + d * d * c;
                    set(out, values[first + pixels * at]);
                }
            }
        }
        faint
    }
}

/// A value as a measurement, 0 if it is none; and whether it is one that is too small.
fn measured(rd: f64) -> (f32, bool) {
    #[allow(clippy::cast_possible_truncation, reason = "what is too large becomes infinite")]
    let single = rd as f32;
    let is_faint = rd > 0.0 && single < f32::MIN_POSITIVE;
    (if single.is_finite() && single >= f32::MIN_POSITIVE { single } else { 0.0 }, is_faint)
}
