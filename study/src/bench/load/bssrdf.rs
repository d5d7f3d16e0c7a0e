//! `subsurf bench load`: load size and latency of three ways to store the same material.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::str::FromStr;

use anyhow::{Context, bail};
use serde_json::{Value, json};
use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::Addressing;
use subsurf_encoder::Progress;
use subsurf_encoder::capture::{CaptureWriter, Scalar, Sidecar};
use subsurf_encoder::synthetic::{Shape, capture_row};
use subsurf_encoder::{Unfinished, write_bytes};
use tempfile::TempDir;

use super::load_btf;
use super::timing::{Steps, Storage};
use crate::devices::{self, BackendArg};
use crate::failure::bad_request;
use crate::memory::human;
use crate::progress::Bars;
use crate::say::say;

/// Time how materials load: uncompressed capture, per-pixel profiles and 2-BMPP of the same size.
///
/// Each is read, parsed with all checks, uploaded, and drawn once (64 × 64 pixels), again and again, in a process of its
/// own, with the file in the page cache and without. Times are medians in microseconds. The materials are synthetic:
/// for timing their numbers do not matter. With --btf, a file of yours is timed beside its images.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// WIDTHxHEIGHT,WINDOW,M,S; more than once for several. The last of the usual ones has the size of the paper's onyx
    #[arg(long = "case", value_name = "WxH,D,M,S")]
    cases: Vec<CaseArg>,
    /// A BTF of nested codebooks instead, beside its images in one uncompressed array
    #[arg(long, value_name = "FILE", requires = "images", conflicts_with = "cases")]
    btf: Option<PathBuf>,
    /// The folder of images of the BTF
    #[arg(long, value_name = "FOLDER", requires = "btf")]
    images: Option<PathBuf>,
    /// Runs of each, warm and cold
    #[arg(long, default_value_t = 20)]
    pub(super) runs: usize,
    /// What draws
    #[arg(long, value_enum, default_value = "auto")]
    pub(super) backend: BackendArg,
    /// Folder for the files, which are deleted at the end; the last case needs a gigabyte
    #[arg(long, value_name = "DIR")]
    dir: Option<PathBuf>,
    /// Report as JSON
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct CaseArg(Shape);

impl FromStr for CaseArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("\"{text}\" is not WIDTHxHEIGHT,WINDOW,M,S such as 229x229,39,128,25");
        let parts: Vec<&str> = text.split(',').collect();
        let [size, window, base_materials, samples] = parts[..] else {
            return Err(wrong());
        };
        let size: crate::options::Size = size.parse()?;
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

/// The size of the demo's material, one in between, and the paper's onyx: 229 × 229 pixels, W = 39, M = 128, S = 25.
const USUAL: [&str; 3] = ["64x64,25,64,13", "128x128,25,128,13", "229x229,39,128,25"];

/// Three files of one material, and how large it is.
pub(crate) struct Case {
    pub(crate) size: [u32; 2],
    pub(crate) window: u32,
    pub(crate) base_materials: u32,
    pub(crate) samples: u32,
    /// In words: where it comes from.
    pub(crate) source: &'static str,
    /// Capture, per-pixel profiles, 2-BMPP.
    pub(crate) files: [PathBuf; 3],
}

const NAMES: [&str; 3] = ["capture", "profiles", "bmpp"];

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    if args.runs == 0 {
        return Err(bad_request("--runs is 0; a median needs one at least, and 20 to be steady"));
    }
    if let (Some(btf), Some(images)) = (&args.btf, &args.images) {
        return load_btf::run(args, btf, images);
    }
    let usual = || USUAL.iter().map(|text| text.parse::<CaseArg>()).collect::<Result<Vec<_>, _>>();
    let cases = if args.cases.is_empty() { usual().map_err(anyhow::Error::msg)? } else { args.cases.clone() };
    let folder = args.folder()?;
    let _goes_when_interrupted = Unfinished::new(folder.path());
    let mut results = Vec::new();
    for CaseArg(shape) in cases {
        let case = write_files(folder.path(), &shape)?;
        let result = measure(&case, args.runs, args.backend)?;
        for file in &case.files {
            // The folder goes at the end anyway; a gigabyte should not wait for it.
            std::fs::remove_file(file).ok();
        }
        if !args.json {
            say!("{}", markdown(&result));
        }
        results.push(result);
    }
    if args.json {
        say!("{:#}", json!({ "runs": args.runs, "device": device(args.backend)?, "cases": results }));
    }
    Ok(())
}

impl Args {
    /// A folder for files, which goes with its value.
    pub(super) fn folder(&self) -> anyhow::Result<TempDir> {
        let folder = match &self.dir {
            Some(dir) => tempfile::tempdir_in(dir),
            None => tempfile::tempdir(),
        };
        folder.map_err(|error| bad_request(format!("no folder for the files, name one with --dir: {error}")))
    }
}

pub(super) fn device(backend: BackendArg) -> anyhow::Result<String> {
    Ok(devices::name(backend.open()?.as_ref()))
}

/// Writes a synthetic material three times.
fn write_files(folder: &Path, shape: &Shape) -> anyhow::Result<Case> {
    let files = ["capture.npy", "profiles.subsurf", "bmpp.subsurf"].map(|name| folder.join(name));
    let bmpp = shape.bmpp();
    write_bytes(&files[1], &shape.per_pixel())?;
    write_bytes(&files[2], &bmpp)?;
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
    Ok(Case {
        size: shape.size,
        window: 2 * u32::from(shape.radius) + 1,
        base_materials: shape.base_materials,
        samples: shape.samples.into(),
        source: "synthetic, for timing",
        files,
    })
}

/// Loads the three files, each in a process of its own.
pub(crate) fn measure(case: &Case, runs: usize, backend: BackendArg) -> anyhow::Result<Value> {
    let bars = Bars::new();
    bars.begin(&format!("loading {} × {} pixels", case.size[0], case.size[1]), 3);
    let mut storages = Vec::new();
    for file in &case.files {
        storages.push(load_one(file, None, runs, backend)?);
        bars.advance(1);
    }
    let [capture, profiles, bmpp] = &storages[..] else {
        bail!("three files make three results");
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
    for (name, result) in NAMES.iter().zip(&storages) {
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
    }))
}

/// Loads one file in a process of its own: of a BTF, with the folder of its images.
pub(super) fn load_one(
    file: &Path,
    images: Option<&Path>,
    runs: usize,
    backend: BackendArg,
) -> anyhow::Result<Storage> {
    let backend = clap::ValueEnum::to_possible_value(&backend).context("backends have names")?;
    let mut command = Command::new(std::env::current_exe()?);
    command.args(["bench", "load-one", "--runs", &runs.to_string(), "--backend", backend.get_name()]).arg(file);
    if let Some(images) = images {
        command.arg("--images").arg(images);
    }
    let output = command.stderr(Stdio::piped()).output()?;
    if !output.status.success() {
        std::io::stderr().write_all(&output.stderr)?;
        bail!("{}: loading failed, see above", file.display());
    }
    serde_json::from_slice(&output.stdout).with_context(|| format!("{}: no result", file.display()))
}

/// A result as a table.
pub(crate) fn markdown(result: &Value) -> String {
    let mut out = String::new();
    let text = |path: &str| result.pointer(path).map(ToString::to_string).unwrap_or_default();
    let number = |path: String| result.pointer(&path).and_then(Value::as_f64);
    // Writing to a string cannot fail.
    let _ = writeln!(
        out,
        "{} × {} pixels, window {}, M = {}, S = {} ({})\n",
        text("/width"),
        text("/height"),
        text("/window"),
        text("/base_materials"),
        text("/samples"),
        text("/source").trim_matches('"'),
    );
    let _ = writeln!(out, "| | capture | per-pixel profiles | 2-BMPP |\n|---|---:|---:|---:|");
    let mut row = |name: &str, path: &str, show: fn(f64) -> String| {
        let values = NAMES.map(|storage| number(format!("/storage/{storage}{path}")));
        // Without a device there is no upload, and elsewhere than on Linux the page cache cannot be dropped.
        if values.iter().all(|value| value.is_none_or(|value| value == 0.0)) {
            return;
        }
        let [capture, profiles, bmpp] = values.map(|value| value.map_or("-".to_owned(), show));
        let _ = writeln!(out, "| {name} | {capture} | {profiles} | {bmpp} |");
    };
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bytes")]
    let bytes = |value: f64| human(value as u64);
    row("file", "/bytes", bytes);
    row("on the device", "/gpu_bytes", bytes);
    row("peak resident memory", "/peak_rss_bytes", bytes);
    row("of it before loading", "/baseline_rss_bytes", bytes);
    for (kind, label) in [("warm_us", "warm"), ("cold_us", "cold")] {
        for step in ["read", "parse", "upload", "first_frame", "total"] {
            row(&format!("{label}: {}", step.replace('_', " ")), &format!("/{kind}/{step}"), micros);
        }
    }
    for (name, path) in [("capture", "capture_over_bmpp"), ("per-pixel profiles", "profiles_over_bmpp")] {
        let ratio = |key: &str| number(format!("/ratios/{path}/{key}")).map_or("-".to_owned(), |r| format!("{r:.0}"));
        let _ = writeln!(
            out,
            "\n{name} over 2-BMPP: {} × the bytes; read, parse and upload take {} × as long warm, {} × cold",
            ratio("bytes"),
            ratio("load_warm"),
            ratio("load_cold"),
        );
    }
    let part = |name: &str| number(format!("/storage/bmpp/{name}")).map_or("-".to_owned(), micros);
    let _ = writeln!(
        out,
        "\n2-BMPP parse: structure and values {}, CRC-32 {}; a memcpy of the file {}",
        part("checks_us"),
        part("crc_us"),
        part("memcpy_us"),
    );
    out
}

/// Microseconds for people.
pub(super) fn micros(us: f64) -> String {
    match us {
        us if us >= 1e6 => format!("{:.2} s", us / 1e6),
        us if us >= 1e3 => format!("{:.2} ms", us / 1e3),
        us => format!("{us:.1} µs"),
    }
}
