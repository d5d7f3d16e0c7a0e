//! Captures: measured or simulated diffuse reflectance between pixels of a flat patch.

mod array;
mod sidecar;
mod write;

use std::fs::File;
use std::path::{Path, PathBuf};

use memmap2::Mmap;
use subsurf_decoder::bssrdf::{Addressing, layout};

use crate::error::{Error, Result};
pub use array::Scalar;
pub use sidecar::{Overrides, Sidecar, sidecar_path};
pub use write::CaptureWriter;

/// A capture on disk, memory-mapped: a NumPy array of shape (H, W, D, D, 3), D = 2 R + 1.
///
/// Entry `[y, x, dy, dx, c]` is the diffuse reflectance Rd in mm⁻², linear Rec. 709, from the pixel (x, y), where light
/// enters, to (x + dx − R, y + dy − R), where it leaves. Entries that are NaN, infinite, zero or negative were not
/// measured.
pub struct Capture {
    path: PathBuf,
    map: Mmap,
    array: array::Array,
    sidecar: Sidecar,
}

impl Capture {
    /// Maps `path` and reads its sidecar, `NAME.json`; `overrides` win over the sidecar.
    ///
    /// # Errors
    /// [`Error::Input`] for a wrong type, order or shape, a cut file, a broken sidecar or a missing pitch.
    pub fn open(path: &Path, overrides: &Overrides) -> Result<Self> {
        let file = File::open(path).map_err(|error| Error::input(path, error, "a capture (.npy) that can be read"))?;
        // SAFETY: the mapping is read-only. Another process that truncates or rewrites the file meanwhile breaks
        // every reader of maps; captures are written under another name and renamed, never changed in place.
        let map = unsafe { Mmap::map(&file) }
            .map_err(|error| Error::input(path, error, "a capture (.npy) that can be mapped"))?;
        let array = array::parse(path, &map)?;
        let sidecar = Sidecar::load(path, overrides)?;
        Ok(Self { path: path.to_owned(), map, array, sidecar })
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Length of the file in bytes.
    #[must_use]
    pub fn file_bytes(&self) -> u64 {
        self.map.len() as u64
    }

    /// Pixels in x.
    #[must_use]
    pub fn width(&self) -> usize {
        self.array.width
    }

    /// Pixels in y.
    #[must_use]
    pub fn height(&self) -> usize {
        self.array.height
    }

    /// N.
    #[must_use]
    pub fn pixels(&self) -> usize {
        self.array.width * self.array.height
    }

    /// R: windows reach this many pixels to every side.
    #[must_use]
    pub fn radius(&self) -> usize {
        self.array.radius
    }

    /// Distance of neighbouring pixels in mm.
    #[must_use]
    pub fn pitch_mm(&self) -> f32 {
        self.sidecar.pitch_mm
    }

    /// What lies beyond the border.
    #[must_use]
    pub fn addressing(&self) -> Addressing {
        self.sidecar.addressing
    }

    /// Where a simulated capture comes from, as its sidecar says.
    #[must_use]
    pub fn simulated(&self) -> Option<&serde_json::Value> {
        self.sidecar.simulated.as_ref()
    }

    /// Refractive index.
    #[must_use]
    pub fn eta(&self) -> f32 {
        self.sidecar.eta
    }

    /// Values of one window: D · D · 3.
    #[must_use]
    pub fn window_len(&self) -> usize {
        self.array.window_len()
    }

    /// Copies the window of pixel number `pixel`, `[dy][dx][rgb]` in mm⁻²; what was not measured becomes 0.
    ///
    /// # Panics
    /// If `pixel` ≥ N or `out` is shorter than a window.
    pub fn read_window(&self, pixel: usize, out: &mut [f32]) {
        assert!(pixel < self.pixels(), "pixel {pixel} of {}", self.pixels());
        self.array.read(&self.map, pixel, out);
    }

    /// The pixel at `x + dx`, `y + dy`, as far as the material reaches: with clamp addressing nothing is measured
    /// beyond the border, else the patch goes on as the addressing says.
    #[must_use]
    pub fn neighbour(&self, x: usize, y: usize, dx: i32, dy: i32) -> Option<usize> {
        neighbour(self.addressing(), [self.width(), self.height()], [x, y], [dx, dy])
    }
}

/// Number of the pixel at `from` + `step` in a patch of `size`; `None` beyond the border of a patch that clamps.
#[must_use]
pub fn neighbour(addressing: Addressing, size: [usize; 2], from: [usize; 2], step: [i32; 2]) -> Option<usize> {
    let coordinate = |axis: usize| {
        let n = u32::try_from(size[axis]).ok()?;
        let x = i32::try_from(from[axis]).ok()? + step[axis];
        let inside = addressing.map(x, n);
        let same = i32::try_from(inside) == Ok(x);
        (same || addressing != Addressing::Clamp).then_some(inside as usize)
    };
    Some(coordinate(1)? * size[0] + coordinate(0)?)
}

/// The step that leads back: from the pixel that [`neighbour`] gives for `from` and `step`, to `from`.
///
/// The opposite step, but for mirrored patches: beyond an odd number of reflections an axis runs the other way, and the
/// way back has the sign of the way there.
#[must_use]
pub fn way_back(addressing: Addressing, size: [usize; 2], from: [usize; 2], step: [i32; 2]) -> [i32; 2] {
    [0, 1].map(|axis| {
        let n = i64::try_from(size[axis]).unwrap_or(i64::MAX);
        let x = i64::try_from(from[axis]).unwrap_or(i64::MAX).saturating_add(step[axis].into());
        let reflected = addressing == Addressing::Mirror && x.div_euclid(n) % 2 != 0;
        if reflected { step[axis] } else { -step[axis] }
    })
}

/// Checks a size that captures and files share.
pub(crate) fn check_side(path: &Path, what: &str, pixels: u64) -> Result<usize> {
    let limit = u64::from(layout::MAX_SIDE);
    match usize::try_from(pixels) {
        Ok(side) if (1..=limit).contains(&pixels) => Ok(side),
        _ => Err(Error::input(path, format!("{what} {pixels}"), format!("{what} from 1 to {limit} pixels"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_back_lead_back() {
        let size = [3, 4];
        for addressing in [Addressing::Clamp, Addressing::Repeat, Addressing::Mirror] {
            for (x, y) in (0..4).flat_map(|y| (0..3).map(move |x| (x, y))) {
                for step in (-9..=9).flat_map(|dy| (-9..=9).map(move |dx| [dx, dy])) {
                    let Some(other) = neighbour(addressing, size, [x, y], step) else {
                        continue;
                    };
                    let back = way_back(addressing, size, [x, y], step);
                    let there = [other % size[0], other / size[0]];
                    let case = format!("{addressing:?}, {step:?} from {x}, {y}");
                    assert_eq!(neighbour(addressing, size, there, back), Some(y * size[0] + x), "{case}");
                    assert_eq!(way_back(addressing, size, there, back), step, "{case}");
                }
            }
        }
    }
}
