//! Transfer files along the rate-distortion curve.

use subsurf_decoder::Transfer;
use subsurf_decoder::transfer::layout::MAX_CLUSTERS;
use subsurf_scene::Mesh;

use super::curve::{Distortion, RdCurve, RdPoint, Target};
use super::search::{Codec, Search};
use crate::error::{Error, Result};
use crate::metrics::transfer::{
    FileChannel, ImageError, Reference, Views, between, precompute_with_between, radial_weights,
};
use crate::progress::Progress;
use crate::transfer::{Options, Precomputed, RdTable, Size, encode, fibonacci, file_bytes};

/// A transfer file that was tried.
pub type Point = RdPoint<TransferCandidate, Vec<u8>, TransferDistortion>;
/// Transfer files that were tried, in the order in which they were tried.
pub type Curve = RdCurve<TransferCandidate, Vec<u8>, TransferDistortion>;

/// Lights and size of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TransferCandidate {
    /// Number of lights.
    pub lights: usize,
    /// Size of what is compressed.
    pub size: Size,
}

/// Errors in images between the lights, against exact sums; of the worst channel, each divided by its largest q.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransferDistortion {
    /// Of the file.
    pub total: ImageError,
    /// Of q before it is compressed: no file of as many lights has less.
    pub interpolation: ImageError,
}

/// Minus e_rms of the worst view.
impl Distortion for TransferDistortion {
    fn quality(&self) -> f64 {
        -self.total.max
    }
}

/// Numbers of lights that are tried.
const LIGHTS: [usize; 6] = [50, 100, 200, 400, 700, 1024];
/// The number of lights that a size is first looked for with.
const USUAL_LIGHTS: usize = 2;
/// Components and bits of a vertex.
const RECORDS: [(usize, usize); 9] =
    [(4, 16), (6, 24), (8, 32), (8, 40), (10, 48), (12, 56), (14, 72), (16, 88), (16, 112)];
/// The record that a size is first looked for with.
const USUAL_RECORD: usize = 3;
/// Clusters, as quarters of [`Size::of_vertices`], and records, by falling error.
const LADDER: [(usize, usize); 11] =
    [(1, 0), (1, 1), (1, 2), (2, 2), (2, 3), (4, 2), (4, 3), (4, 4), (8, 5), (16, 6), (32, 8)];
/// The step of the ladder that a command without targets takes.
const USUAL_STEP: usize = 6;

/// What is precomputed: a mesh in mm, a profile and options.
#[derive(Clone, Copy)]
pub struct TransferSource<'a> {
    /// Mesh.
    pub mesh: &'a Mesh,
    /// Profile.
    pub table: &'a RdTable,
    /// Channels and refractive index.
    pub options: &'a Options,
}

impl TransferSource<'_> {
    /// Bytes of a candidate's file.
    fn file_bytes(&self, of: &TransferCandidate) -> Result<u64> {
        file_bytes(self.mesh.positions.len(), self.table, self.options.channels, of.lights, &of.size)
    }
}

/// The best file of a mesh that is found for a target; every file that is tried is shown to `found` as it comes.
///
/// For a quality lights are added until interpolation between them leaves room for what compression does, and then for as long as
/// the smallest size that reaches it gets smaller by them. For a number of bytes, lights and sizes of a vertex are changed in turns for as
/// long as the error falls, with as many clusters as there is room for. What memory does not suffice for is left out with a warning
/// once there is a file.
///
/// # Errors
/// As [`precompute`](crate::transfer::precompute) and [`encode`]; [`Error::Request`] if nothing reaches the target, or if it is no number.
pub fn search(
    source: &TransferSource<'_>,
    target: Target,
    progress: &dyn Progress,
    found: &mut dyn FnMut(&Point),
) -> Result<Curve> {
    if matches!(target, Target::Quality(least) if !least.is_finite() || least >= 0.0) {
        return Err(Error::Request("an error to reach must be a number above 0, for example 0.01".to_owned()));
    }
    let codec = Files { source: *source, views: Views::of(source.mesh), made: None, progress };
    let mut search = Search::new(codec, target, progress, found);
    match target {
        Target::Quality(least) => along_quality(&mut search, least)?,
        Target::Bytes(limit) => along_bytes(&mut search, limit)?,
    }
    let curve = search.finish().expect("something was tried");
    let best = curve.chosen();
    match target {
        Target::Quality(least) if best.quality() < least && !curve.stopped => {
            let why = if best.distortion.interpolation.max > -least {
                format!("shadows on the mesh are sharper than what {} lights show", best.candidate.lights)
            } else {
                "that is what compression leaves".to_owned()
            };
            Err(Error::Request(format!(
                "no file that was tried has an error of at most {:.2e} in the worst view; the best has {:.2e} in {} bytes: {why}; ask for \
                 that or more, or give lights and sizes yourself",
                -least,
                -best.quality(),
                best.bytes(),
            )))
        }
        _ => Ok(curve),
    }
}

/// Adds lights until interpolation is good enough, and on for as long as the smallest size that is makes smaller files.
fn along_quality(search: &mut Search<'_, Files<'_>>, least: f64) -> Result<()> {
    let clusters = Size::of_vertices(search.codec.source.mesh.positions.len()).clusters;
    let sizes = LADDER.map(|(quarters, record)| {
        let (components, bits) = RECORDS[record];
        Size { clusters: (quarters * clusters / 4).clamp(1, MAX_CLUSTERS.into()), components, bits }
    });
    for (step, lights) in LIGHTS.into_iter().enumerate() {
        let is_last = step + 1 == LIGHTS.len();
        let before = search.smallest();
        let ladder = sizes.map(|size| TransferCandidate { lights, size });
        let is_smaller = |of: &TransferCandidate| {
            before.is_none_or(|before| search.codec.source.file_bytes(of).is_ok_and(|bytes| bytes < before as u64))
        };
        let ladder: Vec<TransferCandidate> = ladder.into_iter().filter(is_smaller).collect();
        if ladder.is_empty() {
            break;
        }
        let interpolation = match search.codec.made(lights) {
            Ok(made) => made.interpolation,
            Err(Error::Request(what)) if !search.points.is_empty() => {
                search.progress.warn(&format!("more lights are not tried: {what}"));
                break;
            }
            Err(Error::Request(what)) => {
                return Err(Error::Request(format!("{what}; ask for a larger error, or for one channel")));
            }
            Err(other) => return Err(other),
        };
        if search.progress.stopped() {
            if search.points.is_empty() {
                // The one file that there is time for.
                search.try_out(&ladder[USUAL_STEP])?;
            }
            break;
        }
        if -interpolation.max < least {
            if before.is_some() {
                break;
            }
            if !is_last {
                continue;
            }
        }
        match search.bisect(&ladder) {
            Err(Error::Request(what)) if !search.points.is_empty() => {
                search.progress.warn(&format!("larger files are not tried: {what}"));
                break;
            }
            goes_on => {
                if !goes_on? || before.is_some() && search.smallest() == before {
                    break;
                }
            }
        }
    }
    Ok(())
}

/// Changes lights and bits of a vertex in turns, for as long as the error falls.
fn along_bytes(search: &mut Search<'_, Files<'_>>, limit: u64) -> Result<()> {
    let source = search.codec.source;
    let vertices = source.mesh.positions.len();
    let bytes = |candidate: &TransferCandidate| source.file_bytes(candidate);
    // The most clusters that there is room for.
    let within = |[lights, record]: [usize; 2]| -> Result<Option<TransferCandidate>> {
        let (components, bits) = RECORDS[record];
        let of = |clusters| TransferCandidate { lights: LIGHTS[lights], size: Size { clusters, components, bits } };
        let (mut fits, mut too_many) = (0, usize::from(MAX_CLUSTERS) + 1);
        while fits + 1 < too_many {
            let clusters = fits.midpoint(too_many);
            *(if bytes(&of(clusters))? <= limit { &mut fits } else { &mut too_many }) = clusters;
        }
        Ok((fits > 0).then(|| of(fits)))
    };
    // The usual place, or the nearest below it where a file fits.
    let mut at = [USUAL_LIGHTS, USUAL_RECORD];
    while within(at)?.is_none() {
        match at {
            [0, 0] => {
                let [(components, bits), ..] = RECORDS;
                let least =
                    bytes(&TransferCandidate { lights: LIGHTS[0], size: Size { clusters: 1, components, bits } })?;
                return Err(Error::Request(format!(
                    "no file that is tried takes {limit} bytes or less; the smallest takes {least}, {:.1} bytes per vertex, and one \
                     channel takes less than three",
                    least as f64 / vertices as f64
                )));
            }
            [lights, record] if record > 0 => at = [lights, record - 1],
            [lights, _] => at = [lights - 1, USUAL_RECORD],
        }
    }
    let (mut steps, mut tried) = (vec![at], Vec::new());
    let mut quality = f64::NEG_INFINITY;
    while let Some(next) = steps.pop() {
        tried.push(next);
        let Some(candidate) = within(next)? else { continue };
        let found = match search.try_out(&candidate) {
            Ok(trial) => trial.quality.unwrap_or(f64::NEG_INFINITY),
            Err(Error::Request(what)) if !search.points.is_empty() => {
                search.progress.warn(&format!("{} lights are not tried: {what}", candidate.lights));
                continue;
            }
            Err(other) => return Err(other),
        };
        if search.progress.stopped() {
            break;
        }
        if found <= quality {
            continue;
        }
        // From a better place all neighbours are worth a look; lights, which cost more work, after sizes of as many.
        quality = found;
        let [lights, record] = next;
        let neighbours = [
            (lights + 1 < LIGHTS.len()).then_some([lights + 1, record]),
            lights.checked_sub(1).map(|lights| [lights, record]),
            (record + 1 < RECORDS.len()).then_some([lights, record + 1]),
            record.checked_sub(1).map(|record| [lights, record]),
        ];
        steps = neighbours.into_iter().flatten().filter(|place| !tried.contains(place)).collect();
    }
    Ok(())
}

/// q for a number of lights.
struct Interpolated {
    of: Precomputed,
    /// The same and that between the lights, as references have it.
    all: Precomputed,
    /// Weights of the lights for directions between them.
    weights: Vec<Vec<f32>>,
    interpolation: ImageError,
}

/// Files of one mesh, judged by exact sums.
struct Files<'a> {
    source: TransferSource<'a>,
    views: Views,
    /// The last that was asked for.
    made: Option<Interpolated>,
    progress: &'a dyn Progress,
}

impl Files<'_> {
    fn made(&mut self, lights: usize) -> Result<&Interpolated> {
        let TransferSource { mesh, table, options } = self.source;
        if self.made.as_ref().is_none_or(|made| made.of.light_count() != lights) {
            self.made = None;
            let directions = fibonacci(lights);
            let all = precompute_with_between(mesh, table, &directions, options, self.progress)?;
            let weights = radial_weights(&directions, &between())?;
            let interpolation = self.worst(&all, |reference, _| reference.total(reference.q(), &weights));
            let of = all.select(&(0..lights).collect::<Vec<usize>>());
            self.made = Some(Interpolated { of, all, weights, interpolation });
        }
        Ok(self.made.as_ref().expect("it was just made"))
    }

    /// The larger of the errors of all channels.
    fn worst(&self, all: &Precomputed, error: impl Fn(&Reference<'_>, usize) -> ImageError) -> ImageError {
        let of = |channel| error(&Reference::new(self.source.mesh, &self.views, all, channel), channel);
        (0..all.channels).map(of).reduce(ImageError::larger).expect("at least one channel")
    }
}

impl Codec for Files<'_> {
    type Candidate = TransferCandidate;
    type File = Vec<u8>;
    type Distortion = TransferDistortion;

    fn encode(&mut self, candidate: &TransferCandidate) -> Result<Vec<u8>> {
        let (TransferSource { mesh, table, options }, progress) = (self.source, self.progress);
        let Interpolated { of, .. } = self.made(candidate.lights)?;
        encode(mesh, table, of, options.eta, &candidate.size, progress)
    }

    fn judge(&self, file: &Vec<u8>) -> Result<TransferDistortion> {
        let Interpolated { all, weights, interpolation, .. } =
            self.made.as_ref().expect("what was encoded was made before");
        self.progress.begin("images", all.channels as u64);
        let file = &Transfer::parse(file).map_err(|source| Error::OwnOutput { source })?;
        let total = self.worst(all, |reference, channel| {
            let error = reference.total(&FileChannel { file, channel, largest: reference.largest() }, weights);
            self.progress.advance(1);
            error
        });
        Ok(TransferDistortion { total, interpolation: *interpolation })
    }
}

#[cfg(test)]
mod tests {
    use subsurf_scene::torus;

    use super::*;
    use crate::kernel::Profile;
    use crate::simulate::diffusion::Medium;

    #[test]
    fn targets_choose_lights_and_sizes() {
        let mesh = torus(4.0, 1.5, 10);
        let profile = Profile::dipole(&Medium::measured("marble").unwrap(), 1.5).unwrap();
        let table = RdTable::of(&profile).unwrap();
        let options = Options { channels: 1, eta: 1.5 };
        let source = TransferSource { mesh: &mesh, table: &table, options: &options };
        let mut shown = 0;
        let mut run = |target| search(&source, target, &(), &mut |_| shown += 1);

        let [rough, fine] = [0.12, 0.06].map(|error| run(Target::Quality(-error)).unwrap());
        for (curve, error) in [(&rough, 0.12), (&fine, 0.06)] {
            let chosen = curve.chosen();
            assert!(chosen.distortion.total.max <= error, "{:?}", chosen.distortion);
            let reaches = |point: &&Point| point.distortion.total.max <= error;
            assert!(curve.points.iter().filter(reaches).all(|point| point.bytes() >= chosen.bytes()), "the smallest");
            for point in &curve.points {
                let TransferCandidate { lights, size } = &point.candidate;
                let expected = file_bytes(mesh.positions.len(), &table, 1, *lights, size).unwrap();
                assert_eq!(expected, point.bytes() as u64, "bytes are known before: {:?}", point.candidate);
            }
        }
        let [few, many] = [&rough, &fine].map(|curve| curve.chosen().candidate.lights);
        assert!(few < many && rough.chosen().bytes() < fine.chosen().bytes(), "{few} and {many} lights");

        // 50 lights reach it as well, in larger files.
        let more = run(Target::Quality(-0.0638)).unwrap();
        let (chosen, of_fewer) = (more.chosen(), more.points.iter().filter(|point| point.candidate.lights == 50));
        let reached = of_fewer.filter(|point| point.distortion.total.max <= 0.0638).map(|point| point.bytes()).min();
        assert!(
            chosen.candidate.lights > 50 && reached.is_some_and(|bytes| bytes > chosen.bytes()),
            "{reached:?}, {:?}",
            chosen.candidate
        );

        let limit = 2 * rough.chosen().bytes() as u64;
        let most = run(Target::Bytes(limit)).unwrap();
        assert!(
            most.points.len() > 2 && most.points.iter().all(|point| point.bytes() as u64 <= limit),
            "{limit} bytes"
        );
        assert!(most.chosen().distortion.total.max < rough.chosen().distortion.total.max, "what room is for is used");
        for (target, reason) in [
            (Target::Bytes(1_000), "bytes per vertex"),
            (Target::Quality(0.0), "above 0"),
            (Target::Quality(f64::NAN), "above 0"),
            (Target::Quality(-1e-9), "1024 lights show; ask for"),
        ] {
            let refused = run(target).unwrap_err().to_string();
            assert!(refused.contains(reason), "{refused}");
        }
        assert!(shown > 6, "{shown} files were shown");
    }

    /// An interruption that came before anything was tried.
    struct Stopped;

    impl Progress for Stopped {
        fn begin(&self, _: &str, _: u64) {}
        fn advance(&self, _: u64) {}
        fn warn(&self, _: &str) {}
        fn stopped(&self) -> bool {
            true
        }
    }

    #[test]
    fn an_interrupted_search_gives_one_file() {
        let mesh = torus(4.0, 1.5, 8);
        let profile = Profile::dipole(&Medium::measured("marble").unwrap(), 1.5).unwrap();
        let table = RdTable::of(&profile).unwrap();
        let source = TransferSource { mesh: &mesh, table: &table, options: &Options { channels: 1, eta: 1.5 } };
        for target in [Target::Quality(-1e-9), Target::Bytes(20_000)] {
            let curve = search(&source, target, &Stopped, &mut |_| {}).unwrap();
            assert!(curve.stopped && curve.points.len() == 1, "{} files for {target:?}", curve.points.len());
        }
    }
}
