//! What the tests of several crates share.

use std::path::{Path, PathBuf};

use subsurf_decoder::bssrdf::Addressing;
use subsurf_encoder::capture::{Capture, CaptureWriter, Overrides, Scalar, Sidecar};
use subsurf_encoder::synthetic::Shape;

/// A small synthetic material of seven base materials.
#[must_use]
pub fn shape(size: [u32; 2], radius: u16, addressing: Addressing) -> Shape {
    Shape {
        size,
        radius,
        samples: radius + 2,
        base_materials: 7,
        addressing,
    }
}

/// Writes a capture whose entries come from `rd` (pixel, place in the window, channel), in mm⁻².
///
/// # Panics
/// If it cannot be written.
pub fn write_capture(
    folder: &Path,
    name: &str,
    size: [usize; 2],
    radius: usize,
    addressing: Addressing,
    rd: impl Fn(usize, usize, usize) -> f32,
) -> PathBuf {
    let path = folder.join(name);
    let sidecar = Sidecar {
        pitch_mm: 0.5,
        addressing,
        eta: 1.4,
        simulated: None,
    };
    let writer = CaptureWriter {
        path: &path,
        size,
        radius,
        scalar: Scalar::F32,
        sidecar: &sidecar,
    };
    let places = (2 * radius + 1).pow(2);
    let result = writer.write(|sink| {
        for pixel in 0..size[0] * size[1] {
            let window: Vec<f32> = (0..places * 3).map(|k| rd(pixel, k / 3, k % 3)).collect();
            sink(&window)?;
        }
        Ok(())
    });
    result.expect("a temporary folder can be written to");
    path
}

/// Opens a capture with what its sidecar says.
///
/// # Panics
/// If it is refused.
#[must_use]
pub fn open(path: &Path) -> Capture {
    Capture::open(path, &Overrides::default()).expect("a capture of our own")
}
