//! Kernels of a material on meshes, beside the other techniques: pictures, errors and times against the gather.
//!
//! The material is what a capture with pixels as wide as an eightieth of the mesh would tell of the profile: one file that all techniques draw,
//! and of whose profile all kernels are made.

use std::path::{Path, PathBuf};

use serde_json::json;
use subsurf_cli::options::Size;
use subsurf_cli::outln;
use subsurf_cli::program::progress::Bars;
use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::Addressing;
use subsurf_encoder::baseline::linsss::fit;
use subsurf_encoder::bssrdf::basis::{BasisOptions, add_basis};
use subsurf_encoder::bssrdf::{HomogeneousPatch, homogeneous};
use subsurf_encoder::capture::{Capture, CaptureWriter, Overrides, Scalar, Sidecar};
use subsurf_encoder::kernel::profile::of_base;
use subsurf_encoder::kernel::{KernelMethod, Options, Profile, encode};
use subsurf_encoder::synthetic::capture_row;
use subsurf_encoder::write_bytes;

use crate::bench::render;

/// Pixels of the material along the longest side of a mesh.
const PIXELS: f32 = 80.0;
/// Share of the light of the channel that goes farthest that may leave beyond the window.
const BEYOND: f64 = 0.05;
/// Most pixels of the window's radius.
const MOST: f64 = 16.0;
/// Gaussians of LinSSS.
const GAUSSIANS: usize = 4;

/// What is drawn on which meshes.
pub(super) struct Meshes<'a> {
    pub(super) meshes: &'a [PathBuf],
    pub(super) extent_mm: f32,
    pub(super) size: [u32; 2],
    pub(super) frames: usize,
    /// Folder for files and pictures.
    pub(super) folder: PathBuf,
}

/// Kernels that are drawn, by the names of their files.
fn kernels() -> [(&'static str, Options); 8] {
    let with = |method, terms| Options { method, terms, ..Options::default() };
    [
        ("pre-integrated", Options::default()),
        ("guided", with(KernelMethod::Guided, 1)),
        ("two-gaussians", with(KernelMethod::TwoGaussians, 1)),
        ("svd-1", with(KernelMethod::Svd, 1)),
        ("svd-3", with(KernelMethod::Svd, 3)),
        ("svd-6", with(KernelMethod::Svd, 6)),
        ("gaussians-1", with(KernelMethod::Gaussians, 1)),
        ("gaussians-6", with(KernelMethod::Gaussians, 6)),
    ]
}

impl Meshes<'_> {
    /// Draws a material on all meshes: what there is to say as HTML, and the rows as CSV.
    pub(super) fn draw(&self, name: &str, profile: &Profile, eta: f64) -> anyhow::Result<(String, String)> {
        #[allow(clippy::cast_possible_truncation, reason = "as files have it")]
        let eta = eta as f32;
        let folder = self.folder.join(name);
        std::fs::create_dir_all(&folder)?;
        let pitch_mm = self.extent_mm / PIXELS;
        let reach = profile.channels.iter().map(|radial| radial.radius_of(BEYOND)).fold(0.0, f64::max);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few")]
        let radius = (reach / f64::from(pitch_mm)).ceil().clamp(3.0, MOST) as u16;
        let patch = HomogeneousPatch { side: u32::from(2 * radius + 2), radius, pitch_mm, eta };
        let file = add_basis(&homogeneous(profile, &patch)?, &BasisOptions::default(), &())?;
        let path = folder.join(format!("{name}.subsurf"));
        write_bytes(&path, &file)?;
        let material = Bssrdf::parse(&file)?;
        let seen = of_base(&material, 0)?;
        let mut paths = Vec::new();
        for (method, options) in kernels() {
            let kernel = encode(&seen, &Options { eta, ..options })?.kernel;
            paths.push(folder.join(format!("{method}.subsurf")));
            write_bytes(&paths[paths.len() - 1], &kernel.to_bytes()?)?;
        }
        write_linsss(&folder, name, &material)?;
        outln!("{name}: pixels of {pitch_mm} mm, a window of radius {radius}");
        render::section(&render::Args {
            files: vec![path],
            meshes: self.meshes.to_vec(),
            extent: self.extent_mm,
            output: folder.clone(),
            linsss: Some(folder),
            kernels: paths,
            size: Size(self.size),
            frames: self.frames,
        })
    }
}

/// LinSSS fitted to a capture of the material.
fn write_linsss(folder: &Path, name: &str, material: &Bssrdf<'_>) -> anyhow::Result<()> {
    let header = material.header();
    let path = folder.join(format!("{name}.npy"));
    let sidecar = Sidecar {
        pitch_mm: header.pitch_mm,
        // LinSSS is fitted to patches that end; where all pixels are alike, they have the same entries.
        addressing: Addressing::Clamp,
        eta: header.eta,
        simulated: Some(json!("a profile everywhere")),
    };
    let writer = CaptureWriter {
        path: &path,
        size: [header.width, header.height].map(|side| side as usize),
        radius: header.window_radius.into(),
        scalar: Scalar::F32,
        sidecar: &sidecar,
    };
    writer.write(|sink| (0..header.height).try_for_each(|y| sink(&capture_row(material, y))))?;
    let capture = Capture::open(&path, &Overrides::default())?;
    let model = fit(&capture, GAUSSIANS, &Bars::new())?;
    drop(capture);
    // It can be made again, and is hundreds of times as large as the rest.
    std::fs::remove_file(&path)?;
    write_bytes(&folder.join(format!("{name}-linsss{GAUSSIANS}.sss")), &model.to_bytes())?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use subsurf_encoder::kernel::profile::shipped;

    use super::*;

    #[test]
    fn linsss_is_fitted_to_a_material_that_is_the_same_everywhere() {
        let folder = tempfile::tempdir().unwrap();
        let patch = HomogeneousPatch { side: 8, radius: 3, pitch_mm: 0.75, eta: 1.3 };
        let file = homogeneous(&shipped::profile("skin1").unwrap(), &patch).unwrap();
        write_linsss(folder.path(), "skin1", &Bssrdf::parse(&file).unwrap()).unwrap();
        let left: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        assert!(left.iter().any(|name| name == "skin1-linsss4.sss"), "{left:?}");
        assert!(!left.iter().any(|name| name == "skin1.npy"), "the capture is taken away: {left:?}");
    }
}
