//! `subsurf simulate profile`: diffuse reflectance profiles by Monte Carlo.

use std::path::PathBuf;
use std::time::Instant;

use clap::builder::PossibleValuesParser;
use subsurf_encoder::check_target;
use subsurf_encoder::simulate::diffusion::Medium;
use subsurf_encoder::simulate::diffusion::medium::MEASURED;
use subsurf_encoder::simulate::monte_carlo::profile::{Material, PACKETS, Profiles, Settings};
use subsurf_encoder::simulate::monte_carlo::{Layer, Stack};

use crate::outln;
use crate::program::failure::bad_request;
use crate::program::interrupt::Graceful;
use crate::program::progress::Bars;
use crate::program::threads;

/// Simulate a diffuse reflectance profile R_d(r) by Monte Carlo: how much light leaves how far from a thin beam.
///
/// Photon packets in layers with refraction and Henyey-Greenstein scattering, as MCML has them (Wang, Jacques and Zheng
/// 1995); red, green and blue each for themselves. Writes NAME.csv: R_d in mm⁻² of every ring, with standard errors.
#[derive(clap::Args)]
#[command(after_help = HELP)]
pub(super) struct Args {
    /// A measured material (Jensen et al. 2001), half-infinite
    #[arg(long, value_parser = PossibleValuesParser::new(MEASURED.map(|(name, _)| name)), required_unless_present = "layers")]
    material: Option<String>,
    /// A layer of your own, once for each from the top; see below
    #[arg(long = "layer", value_name = "a=..,s=..", conflicts_with = "material")]
    layers: Vec<String>,
    /// The .csv file to write
    #[arg(long, short)]
    output: PathBuf,
    /// Photon packets per channel
    #[arg(long, default_value_t = PACKETS)]
    photons: u64,
    /// Refractive index of --material, 1 to 4 [default: 1.5 for marble, 1.3 for all others]
    #[arg(long, conflicts_with = "layers")]
    eta: Option<f64>,
    /// Width of a ring in mm [default: a 20th of the smallest mean free path]
    #[arg(long, value_name = "MM")]
    ring: Option<f64>,
    /// Radius of the last ring in mm [default: 32 of the largest mean free paths]
    #[arg(long, value_name = "MM")]
    reach: Option<f64>,
    /// Seed of the random numbers: the same gives the same file
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Threads to use, at most eight for each core; the file is the same for any number
    #[arg(long)]
    threads: Option<usize>,
}

const HELP: &str = "\
Layers: --layer a=0.03/0.17/0.48,s=7.4/8.8/10.1,g=0.9,eta=1.4,d=0.5
  a    absorption σ_a in mm⁻¹: one number, or red/green/blue
  s    scattering σ_s in mm⁻¹, not reduced: one number, or red/green/blue
  g    mean cosine of scattering, −1 to 1 [default: 0]
  eta  refractive index, 1 to 4 [default: 1.3]
  d    thickness in mm [default: infinite, in the last layer]
Above is air; below a finite last layer is air too.

Ctrl-C once: what was traced so far is written.

  subsurf simulate profile --material skin1 -o skin1.csv
  subsurf simulate profile --layer a=0.1,s=20,g=0.8,d=0.2 --layer a=0.02/0.1/0.3,s=15,g=0.8 -o skin.csv --photons 1000000";

pub(super) fn run(args: &Args) -> anyhow::Result<()> {
    threads::set(args.threads)?;
    check_target(&args.output)?;
    let material = match &args.material {
        Some(name) => {
            let medium = Medium::measured(name).ok_or_else(|| bad_request(format!("no material is called {name}")))?;
            Material::half_space(medium, args.eta.unwrap_or(Medium::measured_eta(name)))
        }
        None => layered(&args.layers)?,
    };
    let settings = Settings {
        packets: args.photons,
        seed: args.seed,
        dr_mm: args.ring,
        reach_mm: args.reach,
        ..Settings::default()
    };
    let start = Instant::now();
    let profiles = {
        let _graceful = Graceful::new();
        material.simulate(&settings, &Bars::new())?
    };
    profiles.write_csv(&args.output)?;
    report(args, &profiles, start.elapsed().as_secs_f64());
    Ok(())
}

fn report(args: &Args, profiles: &Profiles, seconds: f64) {
    let rings = profiles.channels[0].rd.len();
    let packets: u64 = profiles.channels.iter().map(|channel| channel.packets).sum();
    outln!(
        "{}: {rings} rings of {:.4} mm, {packets} photon packets in {seconds:.1} s",
        args.output.display(),
        profiles.dr_mm
    );
    outln!("         reflected             absorbed              transmitted           mirrored  beyond the rings");
    for (channel, name) in profiles.channels.iter().zip(["red", "green", "blue"]) {
        let [r, a, t] = [channel.reflected, channel.absorbed, channel.transmitted]
            .map(|part| format!("{:.5} ± {:.5}", part.mean, part.standard_error));
        outln!("{name:<6}   {r:<20}  {a:<20}  {t:<20}  {:.4}    {:.5}", channel.specular, channel.beyond);
    }
}

/// The material of `--layer`s from the top.
fn layered(texts: &[String]) -> anyhow::Result<Material> {
    let layers: Vec<[Layer; 3]> = texts.iter().map(|text| layer(text)).collect::<anyhow::Result<_>>()?;
    let stack = |c: usize| {
        let layers: Vec<Layer> = layers.iter().map(|channels| channels[c]).collect();
        // Nothing is mirrored at the bottom of what has none.
        let last = layers.last().copied();
        let eta_below = last.filter(|layer| layer.thickness_mm.is_infinite()).map_or(1.0, |layer| layer.eta);
        Stack { eta_above: 1.0, layers, eta_below }
    };
    Ok(Material { channels: [stack(0), stack(1), stack(2)] })
}

/// A layer in red, green and blue.
fn layer(text: &str) -> anyhow::Result<[Layer; 3]> {
    let [mut a, mut s] = [None; 2];
    let [mut g, mut eta, mut thickness_mm] = [0.0, 1.3, f64::INFINITY];
    for part in text.split(',') {
        let wrong = || bad_request(format!("--layer {text}: {part} is none of a=, s=, g=, eta= and d= with a number"));
        let (key, value) = part.split_once('=').ok_or_else(wrong)?;
        let number = || value.trim().parse::<f64>().map_err(|_| wrong());
        match key.trim() {
            "a" => a = Some(channels(value).ok_or_else(wrong)?),
            "s" => s = Some(channels(value).ok_or_else(wrong)?),
            "g" => g = number()?,
            "eta" => eta = number()?,
            "d" => thickness_mm = number()?,
            _ => return Err(wrong()),
        }
    }
    let (Some(a), Some(s)) = (a, s) else {
        return Err(bad_request(format!("--layer {text}: absorption a= and scattering s= have to be given")));
    };
    Ok(std::array::from_fn(|c| Layer { eta, sigma_a: a[c], sigma_s: s[c], g, thickness_mm }))
}

/// One number for all channels, or three with `/` between them.
fn channels(text: &str) -> Option<[f64; 3]> {
    let numbers: Vec<f64> = text.split('/').map(|number| number.trim().parse().ok()).collect::<Option<_>>()?;
    match numbers[..] {
        [all] => Some([all; 3]),
        [r, g, b] => Some([r, g, b]),
        _ => None,
    }
}
