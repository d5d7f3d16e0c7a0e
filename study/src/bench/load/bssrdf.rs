//! Load size and latency of three ways to store the same translucent material.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use anyhow::{Context, bail};
use clap::ValueEnum;
use serde_json::{Value, json};
use subsurf_cli::info::parse;
use subsurf_cli::options::Size;
use subsurf_cli::program::failure::bad_request;
use subsurf_cli::program::progress::Bars;
use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::basis::BasisSize;
use subsurf_decoder::bssrdf::{Addressing, BssrdfHeader};
use subsurf_encoder::Progress;
use subsurf_encoder::bssrdf::basis::{BasisChoice, BasisOptions, add_basis};
use subsurf_encoder::capture::{CaptureWriter, Scalar, Sidecar};
use subsurf_encoder::synthetic::{Shape, capture_row};
use subsurf_encoder::write_bytes;
use subsurf_viewer::read;

use super::options::{LoadOptions, Way, load_one};
use super::results::{Steps, Storage};

/// Size of a synthetic material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct CaseArg(pub(super) Shape);

impl FromStr for CaseArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("\"{text}\" is not WIDTHxHEIGHT,WINDOW,M,S such as 229x229,39,128,25");
        let parts: Vec<&str> = text.split(',').collect();
        let [size, window, base_materials, samples] = parts[..] else {
            return Err(wrong());
        };
        let size: Size = size.parse()?;
        let window: u16 = window.parse().map_err(|_| wrong())?;
        let base_materials: u32 = base_materials.parse().map_err(|_| wrong())?;
        let samples: u16 = samples.parse().map_err(|_| wrong())?;
        let sound =
            window % 2 == 1 && window < 2_048 && (1..=256).contains(&base_materials) && (2..=4_096).contains(&samples);
        let sound = sound && size.0.iter().all(|side| *side <= 65_535);
        let shape = Shape { size: size.0, radius: window / 2, samples, base_materials, addressing: Addressing::Clamp };
        sound.then_some(Self(shape)).ok_or_else(wrong)
    }
}

/// Usual cases: the size of the demo's material, one in between, and the paper's onyx: 229 × 229 pixels, W = 39, M = 128, S = 25.
pub(super) const USUAL: [&str; 3] = ["64x64,25,64,13", "128x128,25,128,13", "229x229,39,128,25"];

/// Case: files of one material, and how large it is.
pub(super) struct Case {
    pub(super) size: [u32; 2],
    pub(super) window: u32,
    pub(super) base_materials: u32,
    pub(super) samples: u32,
    /// Origin of the files, in words.
    pub(super) source: &'static str,
    /// Capture, per-pixel profiles, 2-BMPP, 2-BMPP with a separable basis.
    pub(super) files: [PathBuf; 4],
}

/// Ways to load a material, as results name them: number of the file, and what draws it.
pub(super) const STORAGES: [(&str, usize, Way); 6] = [
    ("capture", 0, Way::Gather),
    ("profiles", 1, Way::Gather),
    ("profiles_splat", 1, Way::Splat),
    ("bmpp", 2, Way::Gather),
    ("bmpp_splat", 2, Way::Splat),
    ("separable", 3, Way::Separable),
];

impl Case {
    /// Files that are there: a capture, its per-pixel profiles and its 2-BMPP, with a basis.
    pub(super) fn of_files([capture, profiles, bmpp]: [PathBuf; 3]) -> anyhow::Result<Self> {
        let bytes = read(&bmpp)?;
        let material = parse(&bmpp, &bytes)?;
        if material.basis().is_none() {
            let name = bmpp.display();
            return Err(bad_request(format!("{name}: no separable basis, add one with `subsurf encode --add-basis`")));
        }
        Ok(Self::new(material.header(), "files", [capture, profiles, bmpp.clone(), bmpp]))
    }

    fn new(header: &BssrdfHeader, source: &'static str, files: [PathBuf; 4]) -> Self {
        Self {
            size: [header.width, header.height],
            window: 2 * u32::from(header.window_radius) + 1,
            base_materials: header.base_materials,
            samples: header.samples.into(),
            source,
            files,
        }
    }
}

/// Writes a synthetic material in every way.
pub(super) fn write_files(folder: &Path, shape: &Shape) -> anyhow::Result<Case> {
    let names = ["capture.npy", "profiles.subsurf", "bmpp.subsurf", "separable.subsurf"];
    let files = names.map(|name| folder.join(name));
    let bmpp = shape.bmpp();
    write_bytes(&files[1], &shape.per_pixel())?;
    write_bytes(&files[2], &bmpp)?;
    // The largest usual basis, from the start of the fit: only the count of its numbers matters.
    let choice = BasisChoice::Size(BasisSize { terms: 2, gaussians: 4 });
    write_bytes(&files[3], &add_basis(&bmpp, &BasisOptions { choice, steps: 0 }, &())?)?;
    let material = Bssrdf::parse(&bmpp)?;
    let header = *material.header();
    let sidecar = Sidecar {
        pitch_mm: header.pitch_mm,
        addressing: header.addressing,
        eta: header.eta,
        simulated: Some(json!("for timing only")),
    };
    let writer = CaptureWriter {
        path: &files[0],
        size: shape.size.map(|side| side as usize),
        radius: shape.radius.into(),
        scalar: Scalar::F32,
        sidecar: &sidecar,
    };
    let bars = Bars::new();
    bars.begin("writing a synthetic capture", shape.size[1].into());
    writer.write(|sink| {
        for y in 0..shape.size[1] {
            sink(&capture_row(&material, y))?;
            bars.advance(1);
        }
        Ok(())
    })?;
    Ok(Case::new(&header, "synthetic, for timing", files))
}

/// Loads the files for every technique, each in a process of its own.
pub(super) fn measure(case: &Case, options: &LoadOptions) -> anyhow::Result<Value> {
    let bars = Bars::new();
    bars.begin(&format!("loading {} × {} pixels", case.size[0], case.size[1]), STORAGES.len() as u64);
    let has_device = options.has_device()?;
    let mut storages = Vec::new();
    for (name, file, way) in STORAGES {
        // Only devices draw meshes.
        if way == Way::Gather || has_device {
            let named = way.to_possible_value().context("ways have names")?;
            let more = ["--way".as_ref(), named.get_name().as_ref()];
            storages.push((name, load_one(&case.files[file], &more, options)?));
        }
        bars.advance(1);
    }
    let of = |wanted: &str| storages.iter().find(|(name, _)| *name == wanted).map(|(_, storage)| storage);
    let (Some(capture), Some(profiles), Some(bmpp)) = (of("capture"), of("profiles"), of("bmpp")) else {
        bail!("what is gathered is always loaded");
    };
    let ratios = |other: &Storage| {
        let load = |steps: &Option<Steps>| steps.map(|steps| steps.load());
        #[allow(clippy::cast_precision_loss, reason = "ratios for people")]
        let bytes = other.bytes as f64 / bmpp.bytes as f64;
        json!({
            "bytes": bytes,
            "load_warm": other.warm_us.load() / bmpp.warm_us.load(),
            "load_cold": load(&other.cold_us).zip(load(&bmpp.cold_us)).map(|(other, bmpp)| other / bmpp),
            "total_warm": other.warm_us.total / bmpp.warm_us.total,
        })
    };
    let parse_over_memcpy = bmpp.parts_us.get("checks_us").zip(bmpp.parts_us.get("memcpy_us")).map(|(a, b)| a / b);
    let mut storage = serde_json::Map::new();
    for (name, result) in &storages {
        storage.insert((*name).to_owned(), serde_json::to_value(result)?);
    }
    Ok(json!({
        "pixels": u64::from(case.size[0]) * u64::from(case.size[1]),
        "width": case.size[0],
        "height": case.size[1],
        "window": case.window,
        "base_materials": case.base_materials,
        "samples": case.samples,
        "source": case.source,
        "storage": storage,
        "ratios": { "capture_over_bmpp": ratios(capture), "profiles_over_bmpp": ratios(profiles) },
        "bmpp_checks_over_memcpy": parse_over_memcpy,
        "separable_cpu_over_bmpp": of("separable").map(|separable| separable.warm_us.cpu() / bmpp.warm_us.cpu()),
    }))
}
