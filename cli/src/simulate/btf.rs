//! `subsurf simulate btf`: images of a rough surface from all sides, where nothing was measured.

use std::path::PathBuf;
use std::time::Instant;

use clap::ValueEnum;
use subsurf_encoder::capture::{Pixels, bonn};
use subsurf_encoder::simulate::relief::{Request, Sample};
use subsurf_viewer::human;

use crate::outln;
use crate::program::progress::Bars;

/// Simulate a BTF: images of a rough surface under light from 81 directions, seen from 81 directions.
///
/// Rays on a relief with masking, shadows and two bounces of light between its parts. Writes a folder of 6,561 images in
/// the naming of the database of Bonn ("tl030 pl060 tv045 pv120.png": light and view, degrees from the normal and around
/// it), and btf.json, which says that they are synthetic. Values are π times the radiance under a light that gives
/// irradiance 1 to a plane that faces it: white paper has the cosine of the light. All images lie on each other, by the
/// plane at half height or below the highest parts.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The material
    #[arg(value_enum)]
    sample: SampleArg,
    /// The folder to write
    #[arg(long, short, value_name = "DIR")]
    output: PathBuf,
    /// Pixels of the images in x and in y
    #[arg(long, default_value_t = 128, value_name = "PIXELS")]
    size: u32,
    /// Multiplies values before they become 8-bit sRGB
    #[arg(long, default_value_t = 1.0, conflicts_with = "hdr")]
    exposure: f32,
    /// Write linear floats (.exr) instead of 8-bit sRGB (.png): nothing is cut off, four times the size
    #[arg(long)]
    hdr: bool,
    /// Seed of the pattern
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

/// Sample by its name on a command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SampleArg(pub Sample);

impl ValueEnum for SampleArg {
    fn value_variants<'a>() -> &'a [Self] {
        const ALL: [SampleArg; 5] = [
            SampleArg(Sample::Foil),
            SampleArg(Sample::Leather),
            SampleArg(Sample::Corduroy),
            SampleArg(Sample::Knit),
            SampleArg(Sample::Wood),
        ];
        &ALL
    }

    fn to_possible_value(&self) -> Option<clap::builder::PossibleValue> {
        Some(clap::builder::PossibleValue::new(self.0.name()).help(self.0.description()))
    }
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let sample = args.sample.0;
    let pixels = if args.hdr { Pixels::Linear } else { Pixels::Display { exposure: args.exposure } };
    let start = Instant::now();
    Request { sample, size: args.size, pixels, seed: args.seed }.write(&args.output, &Bars::new())?;
    let images = bonn().len() * bonn().len();
    let raw = 3 * images as u64 * u64::from(args.size) * u64::from(args.size) * if args.hdr { 4 } else { 1 };
    outln!(
        "{}: synthetic BTF, {images} images of {} × {} pixels, {} uncompressed, in {:.1} s",
        args.output.display(),
        args.size,
        args.size,
        human(raw),
        start.elapsed().as_secs_f64(),
    );
    Ok(())
}
