//! Captures of known files, with and without holes, and their fits.

use std::path::{Path, PathBuf};

use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::{Addressing, Coding};
use subsurf_encoder::bssrdf::{Encoded, Method, Options, encode};
use subsurf_encoder::capture::{CaptureWriter, Scalar, Sidecar};
use subsurf_encoder::metrics::bssrdf::compare;
use subsurf_encoder::metrics::psnr_db;
use subsurf_encoder::synthetic::{capture_row, unit};

use crate::{open, shape, write_capture};

/// Options of every method, K and coding.
#[must_use]
pub fn kinds() -> [Options; 10] {
    let direct = Options::default();
    let [song, clusters] = [Method::Song2009, Method::Clusters].map(|method| Options { method, ..direct });
    let [one, three, five] = [1, 3, 5].map(|per_pixel| Options { per_pixel, ..direct });
    let [small, palette] = [Coding::SmallRatios, Coding::Palette].map(|coding| Options { coding, ..direct });
    let paper = Options { method: Method::Yatagawa2020, ..direct };
    [song, clusters, paper, one, direct, three, five, small, palette, Options { half_profiles: true, ..direct }]
}

/// A capture of what a synthetic 2-BMPP file stands for.
///
/// # Panics
/// If it cannot be written.
#[must_use]
pub fn capture_of_bmpp(folder: &Path, size: [u32; 2], radius: u16, addressing: Addressing) -> PathBuf {
    let file = shape(size, radius, addressing).bmpp();
    let material = Bssrdf::parse(&file).unwrap();
    let path = folder.join("bmpp.npy");
    let sidecar = Sidecar { pitch_mm: 0.5, addressing, eta: 1.4, simulated: None };
    let writer = CaptureWriter {
        path: &path,
        size: size.map(|side| side as usize),
        radius: radius.into(),
        scalar: Scalar::F32,
        sidecar: &sidecar,
    };
    writer.write(|sink| (0..size[1]).try_for_each(|y| sink(&capture_row(&material, y)))).unwrap();
    path
}

/// Fit of a capture with so many base materials.
///
/// # Panics
/// If it is refused.
#[must_use]
pub fn fit(path: &Path, kind: Options, base_materials: usize) -> Encoded {
    encode(&open(path), None, &Options { base_materials, ..kind }, &()).unwrap()
}

/// Mean relative albedo error, and PSNR under uniform light in dB.
///
/// # Panics
/// If the file is refused.
#[must_use]
pub fn quality(path: &Path, file: &[u8]) -> (f64, f64) {
    let material = Bssrdf::parse(file).unwrap();
    let comparison = compare(&open(path), &material, &()).unwrap();
    let uniform = comparison.lit[0].normalised().unwrap();
    (comparison.albedo.mean_relative_error(), psnr_db(&uniform.reference, &uniform.image))
}

/// A copy of a capture in which some entries, and some single channels, are replaced by no measurement.
///
/// # Panics
/// If it cannot be written.
#[must_use]
pub fn with_holes(folder: &Path, path: &Path, hole: impl Fn(u32) -> f32) -> PathBuf {
    let capture = open(path);
    let mut windows = vec![0.0; capture.pixels() * capture.window_len()];
    for (pixel, window) in windows.chunks_mut(capture.window_len()).enumerate() {
        capture.read_window(pixel, window);
    }
    let size = [capture.width(), capture.height()];
    let len = capture.window_len();
    write_capture(folder, "holes.npy", size, capture.radius(), capture.addressing(), |pixel, place, c| {
        let n = u32::try_from(pixel * len + place * 3).unwrap();
        let (entry, channel) = (unit(n) < 0.2, unit(0x5000_0000 + n) < 0.1 && c == 2);
        // A pixel needs something: its own exitance stays.
        if (entry || channel) && place != len / 6 { hole(n) } else { windows[pixel * len + place * 3 + c] }
    })
}
