//! Captures as NumPy arrays: measured or simulated diffuse reflectance between pixels of a flat patch.

mod archive;
mod array;
mod header_text;
mod neighbour;
mod sidecar;
mod write;

use std::fs::File;
use std::ops::Range;
use std::path::{Path, PathBuf};

use memmap2::Mmap;
use subsurf_decoder::bssrdf::Addressing;

use crate::error::{Error, Result};
use archive::Entry;
use array::Array;
pub use array::Scalar;
pub use neighbour::{neighbour, way_back};
pub use sidecar::{Overrides, Sidecar, sidecar_path};
pub use write::{CaptureWriter, check_capture_target};

/// A capture on disk, memory-mapped: a NumPy array of shape (H, W, D, D, 3), D = 2 R + 1, in C or Fortran order, of
/// binary16, 32 or 64 in either order of bytes, as a `.npy` file or in a `.npz` file.
///
/// Entry `[y, x, dy, dx, c]` is the diffuse reflectance Rd in mm⁻², linear Rec. 709, from the pixel (x, y), where light
/// enters, to (x + dx − R, y + dy − R), where it leaves. Entries that are NaN, infinite, zero, negative or
/// below 1.2 · 10⁻³⁸ were not measured.
pub struct Capture {
    path: PathBuf,
    file_bytes: u64,
    values: Values,
    array: Array,
    sidecar: Sidecar,
    warnings: Vec<String>,
}

/// Bytes of an array, header included.
enum Values {
    /// A part of a mapped file.
    Mapped(Mmap, Range<usize>),
    /// In memory, where the file is compressed.
    Inflated(Vec<u8>),
}

impl Values {
    fn bytes(&self) -> &[u8] {
        match self {
            Self::Mapped(map, range) => &map[range.clone()],
            Self::Inflated(bytes) => bytes,
        }
    }
}

impl Capture {
    /// Maps `path` and reads its sidecar, `NAME.json`; `overrides` win over the sidecar.
    ///
    /// # Errors
    /// [`Error::Input`] for a wrong type or shape, a cut file, a broken sidecar or a missing pitch.
    pub fn open(path: &Path, overrides: &Overrides) -> Result<Self> {
        let wrong = |found: &dyn std::fmt::Display| Error::input(path, found, "a capture (.npy) that can be read");
        // Pipes and devices cannot be mapped.
        if !std::fs::metadata(path).map_err(|error| wrong(&error))?.is_file() {
            return Err(wrong(&"not a file"));
        }
        let file = File::open(path).map_err(|error| wrong(&error))?;
        // SAFETY: the mapping is read-only. Another process that truncates or rewrites the file meanwhile breaks
        // every reader of maps; captures are written under another name and renamed, never changed in place.
        let map = unsafe { Mmap::map(&file) }.map_err(|error| wrong(&error))?;
        let file_bytes = map.len() as u64;
        let mut warnings = Vec::new();
        let values = if map.starts_with(archive::MAGIC) {
            let (entry, others) = archive::open(path, &map)?;
            if !others.is_empty() {
                let (path, count) = (path.display(), others.len());
                warnings.push(format!("{path}: other arrays are left out ({count}): {}", others.join(", ")));
            }
            match entry {
                Entry::Stored(range) => Values::Mapped(map, range),
                Entry::Inflated(bytes) => Values::Inflated(bytes),
            }
        } else {
            Values::Mapped(map, 0..usize::try_from(file_bytes).expect("the file is mapped"))
        };
        let array = Array::parse(path, values.bytes())?;
        if array.bytes_behind > 0 {
            warnings.push(format!("{}: {} bytes behind the array are left out", path.display(), array.bytes_behind));
        }
        let (sidecar, unknown) = Sidecar::load(path, overrides)?;
        warnings.extend(unknown);
        Ok(Self { path: path.to_owned(), file_bytes, values, array, sidecar, warnings })
    }

    /// What is left out of the file or its sidecar, a line each.
    #[must_use]
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// What to say of so many values that are too small for a measurement.
    pub(crate) fn faint_warning(&self, count: u64) -> String {
        let (path, least) = (self.path.display(), f32::MIN_POSITIVE);
        format!("{path}: {count} values are positive, but below {least:e} mm⁻²; they count as not measured")
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Length of the file in bytes.
    #[must_use]
    pub fn file_bytes(&self) -> u64 {
        self.file_bytes
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
    /// Returns how many values are too small for a measurement: positive, but below 1.2 · 10⁻³⁸.
    ///
    /// # Panics
    /// If `pixel` ≥ N or `out` is shorter than a window.
    pub fn read_window(&self, pixel: usize, out: &mut [f32]) -> u64 {
        assert!(pixel < self.pixels(), "pixel {pixel} of {}", self.pixels());
        self.array.read(self.values.bytes(), pixel, out)
    }

    /// The pixel at `x + dx`, `y + dy`, as far as the material reaches: with clamp addressing nothing is measured
    /// beyond the border, else the patch goes on as the addressing says.
    #[must_use]
    pub fn neighbour(&self, x: usize, y: usize, dx: i32, dy: i32) -> Option<usize> {
        neighbour(self.addressing(), [self.width(), self.height()], [x, y], [dx, dy])
    }
}
