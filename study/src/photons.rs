//! `subsurf-study photons`: captures by diffusion beside captures photon by photon, as one page.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use plotters::prelude::SeriesLabelPosition;
use serde_json::json;
use subsurf_cli::options::Size;
use subsurf_cli::outln;
use subsurf_cli::program::failure::bad_request;
use subsurf_cli::program::progress::Bars;
use subsurf_cli::simulate::MaterialArg;
use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::Addressing;
use subsurf_encoder::bssrdf::{self, Options};
use subsurf_encoder::capture::{Capture, Overrides, Scalar};
use subsurf_encoder::metrics::bssrdf::judge;
use subsurf_encoder::simulate::diffusion::{BuiltinMaterial, Finish, Method, Request};
use subsurf_encoder::write_bytes;

use crate::page::plots::{Axis, Scale, Series, chart};
use crate::page::{CSS, table};

/// Compare simulations of translucent materials by diffusion with those by photons, and 2-BMPP fitted to both.
///
/// Writes DIR/photons.html, DIR/photons.svg and DIR/photons.csv, and prints tables. Captures are kept in DIR.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The folder
    dir: PathBuf,
    /// Materials
    #[arg(long, value_enum, value_delimiter = ',', default_values = BuiltinMaterial::ALL.map(BuiltinMaterial::name))]
    materials: Vec<MaterialArg>,
    /// Pixels of a patch
    #[arg(long, default_value = "24x24", value_name = "WxH")]
    size: Size,
    /// Pixels to a side of the window, odd
    #[arg(long, default_value_t = 25, value_name = "D")]
    window: u32,
    /// Photon packets for each pixel and channel
    #[arg(long, default_value_t = 4_000)]
    photons: u64,
}

const PITCH_MM: f64 = 0.5;
const BASE_MATERIALS: usize = 32;
/// Distances in pixels that tables show.
const SHOWN: [usize; 6] = [0, 1, 2, 4, 8, 12];

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let dir = &args.dir;
    std::fs::create_dir_all(dir)
        .map_err(|error| bad_request(format!("{}: cannot make the folder: {error}", dir.display())))?;
    let mut rows = Vec::new();
    let mut fits = Vec::new();
    let mut series = Vec::new();
    let mut csv = String::from("material,channel,pixels,diffusion_by_photons,standard_error\n");
    for MaterialArg(material) in &args.materials {
        let name = material.name();
        let diffusion = capture(args, *material, Method::Diffusion, 1)?;
        let photons = capture(args, *material, Method::MonteCarlo { packets: args.photons }, 1)?;
        let ratios = Ratios::of(&diffusion, &photons, args.photons);
        for (c, channel) in ["red", "green", "blue"].iter().enumerate() {
            for (pixels, sums) in ratios.by_distance.iter().enumerate() {
                let [ratio, error] = sums[c].ratio();
                let _ = writeln!(csv, "{name},{channel},{pixels},{ratio:.5},{error:.5}");
            }
        }
        let all: Vec<[f64; 2]> = ratios.by_distance.iter().map(|sums| Sums::of_all(sums).ratio()).collect();
        let shown = SHOWN.iter().filter_map(|pixels| all.get(*pixels));
        let albedo = [format!("{:+.1} %", 100.0 * ratios.albedo), format!("{:.1} %", 100.0 * ratios.albedo_rms)];
        let cells = shown.map(|[ratio, error]| format!("{:+.1} ± {:.1} %", 100.0 * (ratio - 1.0), 100.0 * error));
        rows.push(std::iter::once(name.to_owned()).chain(albedo).chain(cells).collect::<Vec<String>>());
        let points = all.iter().enumerate().map(|(pixels, [ratio, _])| (pixels as f64, *ratio)).collect();
        series.push(Series { title: name.to_owned(), points, joined: true });
        // Photons that no fit has seen.
        let fresh = capture(args, *material, Method::MonteCarlo { packets: args.photons }, 2)?;
        for (title, fitted) in [("diffusion", &diffusion), ("photons", &photons)] {
            let options = Options { base_materials: BASE_MATERIALS, ..Options::default() };
            let encoded = bssrdf::encode(fitted, None, &options, &Bars::new())?;
            let file = Bssrdf::parse(&encoded.bytes)?;
            let judged =
                [fitted, &fresh].map(|capture| judge(capture, &file, encoded.bytes.len() as u64, &Bars::new()));
            let [own, fresh] = judged;
            let cells = [own?, fresh?].map(|judgement| {
                let psnr = judgement.psnr_db.map(|db| db.map_or("-".to_owned(), |db| format!("{db:.1}")));
                format!("{:.4}; {}", judgement.relative_error_mean, psnr.join(" / "))
            });
            let names = [name, title].map(str::to_owned);
            fits.push(names.into_iter().chain(cells).collect::<Vec<String>>());
        }
    }
    let x = Axis { title: "pixels from the lit one", range: 0.0..f64::from(args.window / 2), scale: Scale::Whole };
    let y = Axis { title: "Rd by diffusion, as a share of that by photons", range: 0.0..2.0, scale: Scale::Linear };
    let title = format!("Diffusion by photons, pixels of {PITCH_MM} mm");
    let drawn = chart(&title, &x, &y, &series, &SeriesLabelPosition::LowerRight)?;
    let distances = SHOWN.iter().filter(|pixels| **pixels <= args.window as usize / 2);
    let titles = ["", "albedo", "RMS of pixels"].map(str::to_owned).into_iter();
    let titles: Vec<String> = titles.chain(distances.map(|pixels| format!("{pixels} px"))).collect();
    let fit_titles =
        ["", "fitted to", "judged by that: error; PSNR (dB)", "judged by fresh photons"].map(str::to_owned);
    write_page(dir, &drawn, &[(&titles, &rows), (&fit_titles, &fits)])?;
    write_bytes(&dir.join("photons.csv"), csv.as_bytes())?;
    Ok(())
}

fn write_page(dir: &Path, chart: &str, tables: &[(&[String], &[Vec<String>])]) -> anyhow::Result<()> {
    let mut page = format!(
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>Diffusion and photons</title><style>{CSS}</style><body>\
         <h1>Diffusion and photons</h1><div class=\"charts\">{chart}</div>"
    );
    for (titles, rows) in tables {
        page.push_str(&table(titles, rows));
        outln!("\n| {} |", titles.join(" | "));
        outln!("|---|{}", "---:|".repeat(titles.len() - 1));
        rows.iter().for_each(|row| outln!("| {} |", row.join(" | ")));
    }
    page.push_str("</body></html>\n");
    write_bytes(&dir.join("photons.html"), page.as_bytes())?;
    let svg = chart.replacen("<svg ", "<svg xmlns=\"http://www.w3.org/2000/svg\" ", 1);
    Ok(write_bytes(&dir.join("photons.svg"), svg.as_bytes())?)
}

/// The capture of a material, simulated unless it is there already.
fn capture(args: &Args, material: BuiltinMaterial, method: Method, seed: u64) -> anyhow::Result<Capture> {
    let size = args.size.0.map(|side| side as usize);
    let map = material.map(size, Addressing::Clamp, 1);
    let request = Request {
        method,
        map: &map,
        source: json!({ "scene": material.name() }),
        addressing: Addressing::Clamp,
        pitch_mm: PITCH_MM,
        window: args.window,
        thickness_mm: 20.0,
        eta: 1.5,
        refine: 1.0,
        finish: Finish::default(),
        seed,
        scalar: Scalar::F32,
    };
    let kind = if method == Method::Diffusion { "diffusion".to_owned() } else { format!("photons-{seed}") };
    let path = args.dir.join(format!("{}-{kind}.npy", material.name()));
    if let Ok(cached) = Capture::open(&path, &Overrides::default())
        && cached.simulated() == request.sidecar().simulated.as_ref()
        && [cached.width(), cached.height(), 2 * cached.radius() + 1] == [size[0], size[1], args.window as usize]
    {
        return Ok(cached);
    }
    outln!("simulating {}", path.display());
    request.write(&path, &Bars::new())?;
    Ok(Capture::open(&path, &Overrides::default())?)
}

/// Light at one distance in one channel, in watts, from all pixels.
#[derive(Clone, Copy, Default)]
struct Sums {
    diffusion: f64,
    photons: f64,
    /// Packets of weight 1 that this light by photons would be.
    packets: f64,
}

impl Sums {
    fn of_all(channels: &[Self; 3]) -> Self {
        channels.iter().fold(Self::default(), |sum, channel| Self {
            diffusion: sum.diffusion + channel.diffusion,
            photons: sum.photons + channel.photons,
            packets: sum.packets + channel.packets,
        })
    }

    /// Diffusion by photons, and the standard error that so many packets leave.
    fn ratio(&self) -> [f64; 2] {
        let ratio = self.diffusion / self.photons;
        [ratio, ratio / self.packets.sqrt()]
    }
}

/// How far two captures are apart.
struct Ratios {
    /// By distance in pixels, to the nearest.
    by_distance: Vec<[Sums; 3]>,
    /// Light of the whole window by diffusion as a share of that by photons, less 1: of all pixels, and root mean square of each.
    albedo: f64,
    albedo_rms: f64,
}

impl Ratios {
    fn of(diffusion: &Capture, photons: &Capture, packets: u64) -> Self {
        let radius = photons.radius();
        let d = 2 * radius + 1;
        let mut by_distance = vec![[Sums::default(); 3]; radius + 1];
        let [mut a, mut b] = [0, 1].map(|_| vec![0.0_f32; photons.window_len()]);
        let (mut totals, mut squares) = ([0.0; 2], 0.0);
        for pixel in 0..photons.pixels() {
            diffusion.read_window(pixel, &mut a);
            photons.read_window(pixel, &mut b);
            let mut of_pixel = [0.0; 2];
            for (at, (a, b)) in a.iter().zip(&b).enumerate().filter(|(_, (a, b))| a.is_finite() && b.is_finite()) {
                let [dx, dy] = [at / 3 % d, at / 3 / d].map(|k| k as f64 - radius as f64);
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "distances are small")]
                let distance = dx.hypot(dy).round() as usize;
                let [a, b] = [*a, *b].map(|rd| f64::from(rd) * PITCH_MM * PITCH_MM);
                of_pixel = [of_pixel[0] + a, of_pixel[1] + b];
                if let Some(sums) = by_distance.get_mut(distance) {
                    let sums = &mut sums[at % 3];
                    sums.diffusion += a;
                    sums.photons += b;
                    sums.packets += b * packets as f64;
                }
            }
            totals = [totals[0] + of_pixel[0], totals[1] + of_pixel[1]];
            squares += (of_pixel[0] / of_pixel[1] - 1.0).powi(2);
        }
        Self {
            by_distance,
            albedo: totals[0] / totals[1] - 1.0,
            albedo_rms: (squares / photons.pixels() as f64).sqrt(),
        }
    }
}
