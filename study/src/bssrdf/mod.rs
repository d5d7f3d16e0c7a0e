//! `subsurf-study bssrdf`: the experiments on translucent materials.

mod figures;
mod page;
mod plan;
mod published;
mod record;
mod results;
mod tables;

use std::path::PathBuf;
use std::time::Instant;

use serde_json::json;
use subsurf_cli::options::Size;
use subsurf_cli::outln;
use subsurf_cli::program::failure::bad_request;
use subsurf_cli::program::progress::Bars;
use subsurf_cli::simulate::MaterialArg;
use subsurf_decoder::bssrdf::Addressing;
use subsurf_encoder::capture::{Capture, CaptureWriter, Overrides, Scalar};
use subsurf_encoder::simulate::diffusion::{BuiltinMaterial, Finish, MediumMap, Method, Request, Sensor, expose};
use subsurf_encoder::write_bytes;
use subsurf_viewer::human;

use self::record::{FitCase, Record, capture_name};
use self::results::Results;
use crate::page::duration;

/// Repeat the experiments of Yatagawa et al. 2020 on simulated materials, with and without measurement noise.
///
/// Writes DIR/study.html, a page with tables, curves and pictures that needs nothing beside it, and DIR/study.csv. Captures
/// and fits are kept in DIR: a study that was interrupted goes on where it was. The whole of it takes about an hour on
/// two cores, most of it for the paper's own method; the page is there, and grows, after every capture.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The folder
    dir: PathBuf,
    /// Materials
    #[arg(long, value_enum, value_delimiter = ',', default_values = MATERIALS)]
    materials: Vec<MaterialArg>,
    /// Pixels of a patch
    #[arg(long, default_value = "96x96", value_name = "WxH")]
    size: Size,
    /// Pixels to a side of the window, odd
    #[arg(long, default_value_t = 25, value_name = "D")]
    window: u32,
    /// K for which the paper's own method is run, too; hours for 3 and 5
    #[arg(long, value_delimiter = ',', default_value = "2", value_name = "K", value_parser = ["1", "2", "3", "5"])]
    paper: Vec<String>,
    /// Leave the paper's own method out
    #[arg(long, conflicts_with = "paper")]
    no_paper: bool,
    /// Photons of the captures with noise
    #[arg(long, default_value_t = 1e6)]
    photons: f64,
    /// Leave the captures with noise out
    #[arg(long)]
    clean_only: bool,
}

/// Names of the materials of the study.
pub(crate) const MATERIALS: [&str; 6] = ["stone", "chessboard", "onyx", "blue-wax", "yellow-wax", "jade"];
const PITCH_MM: f64 = 0.5;
const SEED: u64 = 1;

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let dir = &args.dir;
    check(args)?;
    for folder in ["captures", "fits", "pictures"].map(|name| dir.join(name)) {
        std::fs::create_dir_all(&folder)
            .map_err(|error| bad_request(format!("{}: cannot make the folder: {error}", folder.display())))?;
    }
    let papers = if args.no_paper { &[][..] } else { &args.paper };
    let fits = plan::fits(papers, SEED);
    let halves: &[bool] = if args.clean_only { &[false] } else { &[false, true] };
    let mut chosen: Vec<BuiltinMaterial> = Vec::new();
    for material in &args.materials {
        if !chosen.contains(&material.0) {
            chosen.push(material.0);
        }
    }
    let materials: Vec<String> = chosen.iter().map(|material| material.name().to_owned()).collect();
    let mut records: Vec<Record> = Vec::new();
    let start = Instant::now();
    let all = halves.len() * materials.len();
    for (done, (noisy, material)) in
        halves.iter().flat_map(|noisy| chosen.iter().map(|material| (*noisy, *material))).enumerate()
    {
        let name = material.name();
        let truth = capture(args, material, false)?;
        let exposed = if noisy { Some(capture(args, material, true)?) } else { None };
        let capture = exposed.as_ref().unwrap_or(&truth);
        let case = FitCase { material: name, noisy, capture, truth: &truth, folder: dir };
        outln!("{} ({} of {all})", case.name(), done + 1);
        for fit in &fits {
            let (record, fresh) = case.record(fit)?;
            let psnr = record.psnr_db[0].map_or("-".to_owned(), |db| format!("{db:.1} dB"));
            let cached = if fresh { "" } else { ", kept" };
            outln!(
                "  {:<20} {:>8}  {:>8}  error {:.5}  {psnr}{cached}",
                fit.title,
                human(record.bytes),
                duration(record.seconds),
                record.relative_error,
            );
            records.push(record);
        }
        let results = Results {
            folder: dir,
            materials: &materials,
            records: &records,
            fits: &fits,
            size: [truth.width(), truth.height()],
            window: args.window,
            pitch_mm: PITCH_MM,
            photons: (!args.clean_only).then_some(args.photons),
            capture_bytes: truth.file_bytes(),
        };
        write_bytes(&dir.join("study.html"), results.html()?.as_bytes())?;
        write_bytes(&dir.join("study.csv"), tables::csv(&results).as_bytes())?;
    }
    let page = std::path::absolute(dir.join("study.html"))?;
    outln!("{} after {}; numbers in study.csv beside it", page.display(), duration(start.elapsed().as_secs_f64()));
    Ok(())
}

/// Refuses what would only fail after an hour.
fn check(args: &Args) -> anyhow::Result<()> {
    let sensor = (!args.clean_only).then_some(Sensor { photons: args.photons, seed: SEED });
    for material in &args.materials {
        // Voxels depend on the media, of which a corner of the patch has most.
        let corner = material.0.map([16; 2], Addressing::Clamp, SEED);
        request(args, material.0, &corner, sensor).check()?;
    }
    Ok(())
}

/// The capture of a material, simulated unless it is there already.
fn capture(args: &Args, material: BuiltinMaterial, noisy: bool) -> anyhow::Result<Capture> {
    let size = args.size.0.map(|side| side as usize);
    let path = args.dir.join("captures").join(format!("{}.npy", capture_name(material.name(), noisy)));
    let sensor = noisy.then_some(Sensor { photons: args.photons, seed: SEED });
    let map = material.map(size, Addressing::Clamp, SEED);
    let request = request(args, material, &map, sensor);
    let sidecar = request.sidecar();
    if let Ok(cached) = Capture::open(&path, &Overrides::default())
        && cached.simulated() == sidecar.simulated.as_ref()
        && [cached.width(), cached.height(), 2 * cached.radius() + 1] == [size[0], size[1], args.window as usize]
    {
        return Ok(cached);
    }
    if let Some(sensor) = &sensor {
        let clean = capture(args, material, false)?;
        let writer =
            CaptureWriter { path: &path, size, radius: clean.radius(), scalar: Scalar::F32, sidecar: &sidecar };
        expose(&clean, sensor, &writer)?;
    } else {
        outln!("simulating {}", material.name());
        request.write(&path, &Bars::new())?;
    }
    Ok(Capture::open(&path, &Overrides::default())?)
}

fn request<'a>(args: &Args, material: BuiltinMaterial, map: &'a MediumMap, sensor: Option<Sensor>) -> Request<'a> {
    Request {
        method: Method::Diffusion,
        map,
        source: json!({ "scene": material.name() }),
        addressing: Addressing::Clamp,
        pitch_mm: PITCH_MM,
        window: args.window,
        thickness_mm: 20.0,
        eta: 1.5,
        refine: 1.0,
        finish: Finish { one_way: false, sensor },
        seed: SEED,
        scalar: Scalar::F32,
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    #[test]
    fn materials_are_built_in() {
        for name in MATERIALS {
            assert!(BuiltinMaterial::ALL.iter().any(|material| material.name() == name), "{name}");
            assert!(published::published(name).is_some(), "{name}");
        }
    }

    #[test]
    fn captures_with_noise_have_names_of_their_own() {
        assert_ne!(capture_name("jade", true), capture_name("jade", false));
        let picture = record::picture_path(Path::new("d"), "jade", "k2", "error");
        assert_eq!(picture, Path::new("d/pictures/jade-k2-error.png"));
    }
}
