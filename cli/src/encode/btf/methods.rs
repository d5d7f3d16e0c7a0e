//! The three ways to make a file.

use subsurf_decoder::btf::Grid;
use subsurf_encoder::btf::nested::{ChromaSizes, Extent};
use subsurf_encoder::btf::rate::{self, Point, Rung, Target, Walked};
use subsurf_encoder::btf::{Detail, Images, Survey, factored, nested, paper};

use super::Args;
use super::report::line;
use crate::outln;
use crate::program::progress::Bars;
use subsurf_viewer::human;

/// Components that files of some materials are made from: as many as factors can have, and more than codebooks can hold.
pub fn detail(materials: usize) -> Detail {
    Detail { luma: 128 + 32 * (materials - 1), chroma: 32 }
}

/// Codebooks of chroma of some materials.
fn chroma(materials: usize) -> ChromaSizes {
    let each = 64 * materials;
    ChromaSizes { i2: each, i1: each, colours: each.min(256), tints: each.min(256) }
}

/// What errors of chroma count beside those of luma, in factors.
const CHROMA_WEIGHT: f32 = 1.5;
/// Bytes of images to a byte of factors where nothing is asked for.
const USUAL_RATIO: u64 = 1000;
/// Bytes that the angular side of factors takes where few texels share it.
const LEAST_USUAL: u64 = 150_000;
/// Ratios that are tried for a quality.
const RATIOS: [u64; 8] = [4000, 2800, 2000, 1400, 1000, 700, 500, 350];
/// What thresholds of pruning are multiplied by for a quality or a number of bytes.
const LOOSENESS: [f32; 8] = [4.0, 2.8, 2.0, 1.4, 1.0, 0.7, 0.5, 0.35];

/// A file, and how it came about.
pub(super) struct Made {
    pub(super) bytes: Vec<u8>,
    /// What was asked of the encoder.
    pub(super) name: String,
    /// If sizes were chosen.
    pub(super) walked: Option<Walked>,
}

/// A file, or why there is none.
pub type Encoded = subsurf_encoder::Result<Vec<u8>>;

/// Bytes of factors where nothing is asked for.
pub fn usual_bytes(survey: &Survey) -> u64 {
    (survey.raw_bytes / USUAL_RATIO).max(LEAST_USUAL)
}

/// Options that all methods take.
#[derive(Clone)]
pub struct Common {
    /// Nodes of the directions.
    pub grid: Grid,
    /// Names of the materials.
    pub names: Vec<String>,
    /// Whether mipmaps are made.
    pub has_mipmaps: bool,
    /// Seed of the first codewords.
    pub seed: u64,
}

impl Common {
    /// The encoder of nested codebooks.
    pub fn nested<'a>(self, materials: &[Images], survey: &'a Survey) -> nested::Prepared<'a> {
        let Self { grid, names, has_mipmaps, seed } = self;
        let chroma = chroma(materials.len());
        nested::Prepared::new(materials, survey, nested::Options { grid, chroma, names, has_mipmaps, seed })
    }

    /// The encoder of factors.
    pub fn factored<'a>(
        self,
        materials: &[Images],
        survey: &'a Survey,
    ) -> subsurf_encoder::Result<factored::Prepared<'a>> {
        let Self { grid, names, has_mipmaps, seed } = self;
        let options = factored::Options { grid, chroma_weight: CHROMA_WEIGHT, names, has_mipmaps, seed };
        factored::Prepared::new(materials, survey, options)
    }

    /// The paper's encoder with its thresholds times `looseness`.
    pub fn paper(self, materials: &[Images], looseness: f32) -> Encoded {
        let Self { grid, names, has_mipmaps, seed } = self;
        let usual = paper::Options::default();
        let similarity = usual.similarity.times(looseness);
        let options = paper::Options { grid, similarity, names, has_mipmaps, seed, ..usual };
        Ok(paper::encode(materials, &options, &Bars::new())?.to_bytes())
    }
}

pub(super) fn nested(args: &Args, materials: &[Images], common: Common) -> anyhow::Result<Made> {
    let survey = Survey::new(materials, detail(materials.len()), args.seed, &Bars::new())?;
    let prepared = common.nested(materials, &survey);
    let encode = |extent: &Extent| -> Encoded { Ok(prepared.encode(&extent.sizes(), &Bars::new())?.to_bytes()) };
    let usual = Extent { p4: args.p4.max(1), stages: args.stages };
    choose(args, materials, &usual, &Extent::LADDER, encode)
}

/// Thresholds of pruning in the usual ones.
#[derive(Clone, Copy)]
struct Looseness(f32);

impl Rung for Looseness {
    fn name(&self) -> String {
        format!("thresholds × {:.3}", self.0)
    }

    #[allow(clippy::cast_possible_truncation, reason = "from 0 to 1")]
    fn between(&self, next: &Self, part: f64) -> Option<Self> {
        let factor = (next.0 / self.0).powf(part as f32);
        // Thresholds that are closer make no difference.
        ((self.0 / next.0).ln().abs() > 0.05).then_some(Self(self.0 * factor))
    }
}

/// Bytes of factors at most.
#[derive(Clone, Copy)]
struct AtMost(u64);

impl Rung for AtMost {
    fn name(&self) -> String {
        format!("at most {}", human(self.0))
    }

    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_precision_loss,
        clippy::cast_sign_loss,
        reason = "millions, not negative"
    )]
    fn between(&self, next: &Self, part: f64) -> Option<Self> {
        let (low, high) = (self.0 as f64, next.0 as f64);
        (high > 1.02 * low).then_some(Self((low + part * (high - low)) as u64))
    }
}

pub(super) fn paper(args: &Args, materials: &[Images], common: &Common) -> anyhow::Result<Made> {
    let encode = |Looseness(factor): &Looseness| common.clone().paper(materials, *factor);
    choose(args, materials, &Looseness(1.0), &LOOSENESS.map(Looseness), encode)
}

pub(super) fn factored(args: &Args, materials: &[Images], common: Common) -> anyhow::Result<Made> {
    let survey = Survey::new(materials, detail(materials.len()), args.seed, &Bars::new())?;
    let prepared = common.factored(materials, &survey)?;
    let encode = |AtMost(bytes): &AtMost| -> Encoded {
        Ok(prepared.encode_to(usize::try_from(*bytes).unwrap_or(usize::MAX), &Bars::new())?.0)
    };
    let ladder = match args.target() {
        // One file of that size; no other can be better.
        Some(Target::Bytes(bytes)) => vec![AtMost(bytes)],
        _ => RATIOS.map(|ratio| AtMost(survey.raw_bytes / ratio)).to_vec(),
    };
    choose(args, materials, &AtMost(usual_bytes(&survey)), &ladder, encode)
}

/// The usual sizes, or those of the ladder that reach the target.
fn choose<R: Rung>(
    args: &Args,
    materials: &[Images],
    usual: &R,
    ladder: &[R],
    encode: impl Fn(&R) -> Encoded,
) -> anyhow::Result<Made> {
    let Some(target) = args.target() else {
        return Ok(Made { bytes: encode(usual)?, name: usual.name(), walked: None });
    };
    let said = |point: &Point| {
        if !args.json {
            outln!("{}", line(point));
        }
    };
    let walked = rate::walk(materials, ladder, target, &Bars::new(), encode, said)?;
    let Point { bytes, name, .. } = walked.points[walked.best].clone();
    Ok(Made { bytes, name, walked: Some(walked) })
}
