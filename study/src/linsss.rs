//! `subsurf-study linsss`: the patches of a study as LinSSS has them, a rival that is drawn by blurs, too.

use std::path::{Path, PathBuf};
use std::time::Instant;

use subsurf_cli::outln;
use subsurf_cli::program::failure::bad_request;
use subsurf_cli::program::progress::Bars;
use subsurf_cli::simulate::MaterialArg;
use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::Addressing;
use subsurf_encoder::baseline::linsss::{LinSss, MAX_GAUSSIANS, fit};
use subsurf_encoder::bssrdf::basis::{BasisOptions, fit_basis, with_basis};
use subsurf_encoder::capture::{Capture, Overrides};
use subsurf_encoder::metrics::bssrdf::{Light, compare};
use subsurf_encoder::metrics::psnr_db;
use subsurf_encoder::write_bytes;
use subsurf_shaders::separable::ProjectedBasis;
use subsurf_viewer::{human, read};

use crate::bssrdf::MATERIALS;

/// Fit LinSSS (Yatagawa et al. 2020b) to the captures of a study, and compare it with its 2-BMPP files.
///
/// Prints a table: PSNR in dB under uniform, disc and line light against the capture, over the pairs that it has. Fits are kept
/// beside those of the study, as the authors' program reads them (.sss); a minute or two for a material of 96 × 96 pixels.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The folder of `subsurf-study bssrdf`
    dir: PathBuf,
    /// Materials
    #[arg(long, value_enum, value_delimiter = ',', default_values = MATERIALS)]
    materials: Vec<MaterialArg>,
    /// Numbers of Gaussians, 1 to 8
    #[arg(long, value_delimiter = ',', default_value = "4,8", value_name = "H")]
    gaussians: Vec<usize>,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    if let Some(wrong) = args.gaussians.iter().find(|count| !(1..=MAX_GAUSSIANS).contains(*count)) {
        return Err(bad_request(format!("--gaussians {wrong}; LinSSS has 1 to {MAX_GAUSSIANS}")));
    }
    outln!("| | | file | device | uniform / disc / line (dB) | as it is drawn (dB) |");
    outln!("|---|---|---:|---:|---:|---:|");
    for material in &args.materials {
        let name = material.0.name();
        let capture = Capture::open(&args.dir.join("captures").join(format!("{name}.npy")), &Overrides::default())?;
        let path = args.dir.join("fits").join(format!("{name}-k2.subsurf"));
        let plain = read(&path)?;
        let bytes = with_basis(&plain, &fit_basis(&Bssrdf::parse(&plain)?, &BasisOptions::default(), &())?)?;
        let file = Bssrdf::parse(&bytes)?;
        let basis = ProjectedBasis::of(&file).expect("a file with a basis");
        let compared = compare(&capture, &file, &Bars::new())?;
        let of_file = db(&compared.psnr_db().map(Option::unwrap_or_default));
        let truth = Truth::new(&capture, compared.lit.map(|lit| lit.reference));
        let drawn = truth.psnr(|irradiance| separable_within(&basis, irradiance, capture.radius()));
        let of_basis = basis.numbers().size();
        outln!(
            "| {name} | 2-BMPP, L = {}, A = {} | {} | | {of_file} | {drawn} |",
            of_basis.terms,
            of_basis.gaussians,
            human(bytes.len() as u64),
        );
        for count in &args.gaussians {
            let model = fitted(&args.dir, name, &capture, *count)?;
            outln!(
                "| | LinSSS, {count} Gaussians | {} | {} | {} | {} |",
                human(model.to_bytes().len() as u64),
                human(model.device_bytes()),
                truth.psnr(|irradiance| model.exitance(irradiance)),
                truth.psnr(|irradiance| model.exitance_by_pyramid(irradiance)),
            );
        }
    }
    Ok(())
}

/// The fit of a capture, from the study's folder if it is there and not older than the capture.
fn fitted(folder: &Path, name: &str, capture: &Capture, gaussians: usize) -> anyhow::Result<LinSss> {
    let path = folder.join("fits").join(format!("{name}-linsss{gaussians}.sss"));
    let changed = |path: &Path| std::fs::metadata(path).and_then(|facts| facts.modified());
    let is_newer = changed(&path).is_ok_and(|fit| changed(capture.path()).is_ok_and(|capture| fit >= capture));
    let cached = is_newer.then(|| std::fs::read(&path).ok()).flatten();
    let cached = cached.and_then(|bytes| LinSss::parse(&bytes, capture.pitch_mm()));
    let shape = ([capture.width(), capture.height()], capture.radius(), gaussians);
    if let Some(model) = cached.filter(|model| (model.size, model.radius, model.sigmas.len()) == shape) {
        return Ok(model);
    }
    let start = Instant::now();
    let model = fit(capture, gaussians, &Bars::new())?;
    eprintln!("{name}: {gaussians} Gaussians fitted in {:.0} s", start.elapsed().as_secs_f64());
    write_bytes(&path, &model.to_bytes())?;
    Ok(model)
}

/// A patch as the capture has it under each light.
struct Truth {
    /// Irradiance of every pixel, and what leaves there.
    lit: Vec<(Vec<f32>, Vec<[f64; 3]>)>,
}

impl Truth {
    fn new(capture: &Capture, exitance: [Vec<[f64; 3]>; 3]) -> Self {
        let size = [capture.width(), capture.height()];
        let irradiance = |light: Light| {
            let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x, y]));
            pixels.map(|pixel| light.irradiance(pixel, size)).collect()
        };
        Self { lit: Light::ALL.map(irradiance).into_iter().zip(exitance).collect() }
    }

    /// PSNR in dB under each light of what `draw` makes of an irradiance; peak 1 the largest exitance of the capture.
    fn psnr(&self, draw: impl Fn(&[f32]) -> Vec<[f64; 3]>) -> String {
        let of = |(irradiance, expected): &(Vec<f32>, Vec<[f64; 3]>)| {
            let peak = expected.iter().flatten().copied().fold(1e-30, f64::max);
            let scaled = |image: &[[f64; 3]]| image.iter().map(|rgb| rgb.map(|value| value / peak)).collect::<Vec<_>>();
            psnr_db(&scaled(expected), &scaled(&draw(irradiance)))
        };
        db(&self.lit.iter().map(of).collect::<Vec<_>>())
    }
}

fn db(values: &[f64]) -> String {
    values.iter().map(|value| format!("{value:.1}")).collect::<Vec<_>>().join(" / ")
}

/// Exitance of a separable basis, by the blurs that are drawn, of light on the patch alone: nothing was captured beyond it.
fn separable_within(basis: &ProjectedBasis, irradiance: &[f32], margin: usize) -> Vec<[f64; 3]> {
    let numbers = basis.numbers();
    let [width, height] = [numbers.header().width as usize, numbers.header().height as usize];
    // Black around, as far as a window reaches.
    let padded = [width + 2 * margin, height + 2 * margin];
    let place = |pixel: usize| (pixel / width + margin) * padded[0] + pixel % width + margin;
    let size = padded.map(|side| u32::try_from(side).expect("sides are below 65,536"));
    let cascade = numbers.cascade();
    let mut exitance = vec![[0.0; 3]; width * height];
    for (l, c) in (0..numbers.size().terms).flat_map(|l| (0..3).map(move |c| (l, c))) {
        // G_a * c_l E.
        let mut map = vec![0.0; padded[0] * padded[1]];
        let weighted = basis.coefficients_of(l).iter().zip(irradiance).map(|(rgb, e)| rgb[c] * e);
        weighted.enumerate().for_each(|(pixel, value)| map[place(pixel)] = value);
        let mut between = vec![0.0; map.len()];
        for (a, stage) in cascade.stages().iter().enumerate() {
            stage.blur(&mut map, &mut between, size, Addressing::Clamp);
            for m in 0..numbers.size().terms {
                let weight = numbers.weights_of(l, m)[a][c];
                for (pixel, (sum, rgb)) in exitance.iter_mut().zip(basis.coefficients_of(m)).enumerate() {
                    sum[c] += f64::from(rgb[c] * weight * map[place(pixel)]);
                }
            }
        }
    }
    exitance
}
