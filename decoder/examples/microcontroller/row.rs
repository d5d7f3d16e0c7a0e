//! One row of a patch from the pieces of its file, without `std`, heap, or any other row in memory.
//!
//! Drawn is what leaves the patch under even light: the albedo. That of a pixel is a sum over its whole window, which a few kilobytes do not hold; here it is
//! a product of powers of the albedos of its two base materials, a_x = a_1^t a_2^(1−t). It is exact where both are one or differ by a factor, and too bright
//! elsewhere (Hölder: Σ f^t g^(1−t) ≤ (Σ f)^t (Σ g)^(1−t)); neighbours are taken to be like the pixel itself.

use core::fmt;
use heapless::Vec;
use subsurf_decoder::bssrdf::layout::MODEL_2BMPP;
use subsurf_decoder::bssrdf::{BssrdfHeader, Coding};
use subsurf_decoder::container::bytes::F32Le;
use subsurf_decoder::push::{Piece, Row};
use subsurf_decoder::{ReadError, Section};

/// Pixels of the widest row.
pub(crate) const WIDTH: usize = 229;
/// Base materials at most.
pub(crate) const MATERIALS: usize = 160;
/// Buffer of a reader: section table of up to eight sections, and a row of ratios.
pub(crate) const BUFFER: usize = 28 + 8 * 24 + 4 * WIDTH;

/// Why there is no row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Problem {
    /// Something is wrong with the file.
    File(ReadError),
    /// Not a 2-BMPP file with exact coding and f32 profiles, at most [`WIDTH`] pixels wide and of at most [`MATERIALS`] base materials.
    Unsupported,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(error) => error.fmt(f),
            Self::Unsupported => f.write_str("not a patch that this program draws"),
        }
    }
}

/// Painter of row `y`.
pub(crate) struct Painter {
    y: u32,
    header: Option<BssrdfHeader>,
    /// Node of the profile before the one that comes.
    last: [f32; 3],
    /// Albedos of the base materials; a sum for the one whose nodes come.
    albedos: Vec<[f32; 3], MATERIALS>,
    /// t of the row.
    ratios: Vec<f32, WIDTH>,
}

impl Painter {
    pub(crate) const fn new(y: u32) -> Self {
        Self { y, header: None, last: [0.0; 3], albedos: Vec::new(), ratios: Vec::new() }
    }

    /// Takes a piece of the file; `draw` gets every pixel of the row as sRGB when it comes.
    pub(crate) fn take(&mut self, piece: Piece<'_>, draw: &mut dyn FnMut([u8; 3])) -> Result<(), Problem> {
        match (piece, self.header) {
            (Piece::Bssrdf(header), _) => self.begin(header),
            (Piece::Row(Row { section: Section::BaseProfiles, number, bytes }), Some(header)) => {
                self.node(&header, number, F32Le::new(bytes))
            }
            (Piece::Row(Row { section: Section::MixtureRatios, number, bytes }), _) if number == self.y => {
                self.ratios.clear();
                self.ratios.extend(F32Le::new(bytes).iter().take(WIDTH));
                Ok(())
            }
            (Piece::Row(Row { section: Section::BaseIndices, number, bytes }), _) if number == self.y => {
                for (pair, t) in bytes.as_chunks().0.iter().zip(&self.ratios) {
                    draw(self.pixel(*pair, *t));
                }
                Ok(())
            }
            // A kernel, a BTF, a file with profiles as half floats.
            (Piece::Btf(_) | Piece::Kernel(_) | Piece::Row(Row { section: Section::HalfProfiles, .. }), _) => {
                Err(Problem::Unsupported)
            }
            _ => Ok(()),
        }
    }

    fn begin(&mut self, header: &BssrdfHeader) -> Result<(), Problem> {
        let fits = header.width as usize <= WIDTH && header.base_materials as usize <= MATERIALS;
        if header.model != MODEL_2BMPP || header.coding != Coding::Exact || !fits {
            return Err(Problem::Unsupported);
        }
        self.header = Some(*header);
        Ok(())
    }

    /// Adds what lies between the node before and this one to the albedo of the material, Σ exp(P̂) pitch² over a window.
    fn node(&mut self, header: &BssrdfHeader, number: u32, node: F32Le<'_>) -> Result<(), Problem> {
        let (h, node) = (number % u32::from(header.samples), [0, 1, 2].map(|c| node.get(c).unwrap_or(0.0)));
        if h == 0 {
            self.last = node;
            return self.albedos.push([0.0; 3]).map_err(|_| Problem::Unsupported);
        }
        let Some(sum) = self.albedos.last_mut() else { return Ok(()) };
        for [dx, dy] in places(header, h) {
            let knot = header.distance_mm(dx, dy).and_then(|r_mm| header.knot(r_mm));
            let Some(knot) = knot.filter(|knot| knot.h + 1 == h as usize) else { continue };
            // As many pixels of the window are as far away.
            let pixels = if dx == 0 {
                1.0
            } else if dy == 0 || dx == dy {
                4.0
            } else {
                8.0
            };
            let area = pixels * header.pitch_mm * header.pitch_mm;
            for ((sum, last), node) in sum.iter_mut().zip(self.last).zip(node) {
                *sum += area * libm::expf(last + knot.w * (node - last));
            }
        }
        self.last = node;
        Ok(())
    }

    /// Colour of a pixel.
    fn pixel(&self, pair: [u8; 2], t: f32) -> [u8; 3] {
        let [a, b] = pair.map(|base| self.albedos.get(usize::from(base)).copied().unwrap_or([0.0; 3]));
        [0, 1, 2].map(|c| srgb(libm::powf(a[c], t) * libm::powf(b[c], 1.0 - t)))
    }
}

/// Places of a window, 0 ≤ dy ≤ dx, that may lie between nodes h − 1 and h.
fn places(header: &BssrdfHeader, h: u32) -> impl Iterator<Item = [i32; 2]> {
    // Distances of both nodes in pixels, and a bit more.
    let step_px = header.r_max_mm / header.pitch_mm / f32::from(header.samples - 1);
    let [inner, outer] = [(h as f32 - 1.0) * step_px - 0.01, h as f32 * step_px + 0.01];
    let range = (inner.max(0.0) * inner.max(0.0), outer * outer);
    let offsets = (0..=i32::from(header.window_radius)).flat_map(|dx| (0..=dx).map(move |dy| [dx, dy]));
    offsets.filter(move |[dx, dy]| {
        let r2 = (dx * dx + dy * dy) as f32;
        range.0 <= r2 && r2 <= range.1
    })
}

/// A linear value as sRGB has it (IEC 61966-2-1).
fn srgb(linear: f32) -> u8 {
    #![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates, as it should")]
    let value = if linear > 0.003_130_8 { 1.055 * libm::powf(linear, 1.0 / 2.4) - 0.055 } else { 12.92 * linear };
    (value * 255.0 + 0.5) as u8
}
