//! What the tests of several crates share.

pub mod fits;
pub mod frames;
pub mod kernels;
pub mod meshes;
pub mod mutate;
pub mod nested;
pub mod program;
pub mod transfer;
pub mod vectors;

use std::path::{Path, PathBuf};

use subsurf_decoder::Section;
use subsurf_decoder::bssrdf::basis::BasisSize;
use subsurf_decoder::bssrdf::layout::MODEL_2BMPP;
use subsurf_decoder::bssrdf::{Addressing, BssrdfHeader, Coding};
use subsurf_encoder::bssrdf::basis::{BasisChoice, BasisOptions, FittedBasis, add_basis};
use subsurf_encoder::bssrdf::write_file;
use subsurf_encoder::capture::{Capture, CaptureWriter, Overrides, Scalar, Sidecar};
use subsurf_encoder::simulate::diffusion::{BuiltinMaterial, Finish, Slab, simulate};
use subsurf_encoder::synthetic::Shape;

/// A small synthetic material of seven base materials.
#[must_use]
pub fn shape(size: [u32; 2], radius: u16, addressing: Addressing) -> Shape {
    Shape { size, radius, samples: radius + 2, base_materials: 7, addressing }
}

/// A file of [`shape`], with a basis to draw separable blurs by: what a fit starts from, made in no time.
///
/// # Panics
/// If it is refused.
#[must_use]
pub fn drawable(size: [u32; 2], radius: u16, addressing: Addressing) -> Vec<u8> {
    let choice = BasisChoice::Size(BasisSize { terms: 2, gaussians: 4 });
    let options = BasisOptions { choice, steps: 0 };
    add_basis(&shape(size, radius, addressing).bmpp(), &options, &()).expect("a file of our own")
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
    let sidecar = Sidecar { pitch_mm: 0.5, addressing, eta: 1.4, simulated: None };
    let writer = CaptureWriter { path: &path, size, radius, scalar: Scalar::F32, sidecar: &sidecar };
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

/// Simulates the capture of a square piece of a scene, 20 mm thick, in air (η = 1.5), on a coarse grid, and opens it.
///
/// # Panics
/// If it cannot be written.
#[must_use]
pub fn simulated(
    folder: &Path,
    scene: BuiltinMaterial,
    side: usize,
    radius: usize,
    pitch_mm: f32,
    addressing: Addressing,
    finish: &Finish,
) -> Capture {
    let path = folder.join("capture.npy");
    let map = scene.map([side; 2], addressing, 1);
    // A fifth of the usual voxels: a fit meets fields of the same kind, in a tenth of the time.
    let slab =
        Slab { map: &map, addressing, pitch_mm: pitch_mm.into(), radius, thickness_mm: 20.0, eta: 1.5, refine: 0.4 };
    let sidecar = Sidecar { pitch_mm, addressing, eta: 1.5, simulated: None };
    let writer = CaptureWriter { path: &path, size: [side; 2], radius, scalar: Scalar::F32, sidecar: &sidecar };
    simulate(&slab, finish, &writer, &()).expect("a temporary folder can be written to");
    open(&path)
}

/// Opens a capture with what its sidecar says.
///
/// # Panics
/// If it is refused.
#[must_use]
pub fn open(path: &Path) -> Capture {
    Capture::open(path, &Overrides::default()).expect("a capture of our own")
}

/// The example of `decoder/FORMAT.md`, section 3, with its profiles filled in.
#[must_use]
pub fn format_example() -> Vec<u8> {
    let header = BssrdfHeader {
        model: MODEL_2BMPP,
        coding: Coding::Exact,
        addressing: Addressing::Clamp,
        width: 2,
        height: 1,
        window_radius: 1,
        samples: 2,
        base_materials: 2,
        pitch_mm: 0.5,
        r_max_mm: 1.0,
        eta: 1.5,
    };
    let floats = |values: &[f32]| values.iter().flat_map(|value| value.to_le_bytes()).collect();
    let profiles = [-1.0, -2.0, -3.0, -2.0, -4.0, -6.0, -3.0, -2.0, -1.0, -5.0, -5.0, -5.0];
    let sections = [
        (Section::BaseProfiles, floats(&profiles)),
        (Section::MixtureRatios, floats(&[1.0, 0.25])),
        (Section::BaseIndices, vec![0, 1, 1, 0]),
    ];
    write_file(&header, &sections)
}

/// The same file with a separable basis of numbers that one can follow: L = 2, A = 2; with S = 2, 140 bytes.
///
/// # Panics
/// Never.
#[must_use]
pub fn format_basis() -> FittedBasis {
    FittedBasis {
        size: BasisSize { terms: 2, gaussians: 2 },
        samples: 2,
        sigmas: vec![0.5, 2.0],
        weights: vec![
            [0.5, 0.25, 0.125],
            [0.25, 0.125, 0.0625],
            [-0.125, 0.0, 0.125],
            [0.0, 0.5, -0.5],
            [0.0625, 0.125, 0.25],
            [1.0, 2.0, 3.0],
        ],
        projection: vec![[1.0, 2.0, 3.0], [0.5, 0.0, -0.5], [-1.0, 1.0, 0.0], [2.0, 4.0, 8.0]],
        psnr_db: 0.0,
    }
}
