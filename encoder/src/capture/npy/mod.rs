//! Captures as NumPy arrays: measured or simulated diffuse reflectance between pixels of a flat patch.

mod array;
mod neighbour;
mod sidecar;
mod write;

use std::fs::File;
use std::path::{Path, PathBuf};

use memmap2::Mmap;
use subsurf_decoder::bssrdf::Addressing;

use crate::error::{Error, Result};
pub use array::Scalar;
pub use neighbour::{neighbour, way_back};
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

    /// Number of pixels, N.
    #[must_use]
    pub fn pixels(&self) -> usize {
        self.array.width * self.array.height
    }

    /// Radius of the window, R: pixels to every side.
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
