//! Transfer files along the rate-distortion curve.

mod files;
mod path;

use subsurf_scene::Mesh;

use self::files::Files;
use super::curve::{Distortion, RdCurve, RdPoint, Target};
use super::search::Search;
use crate::error::{Error, Result};
use crate::metrics::transfer::ImageError;
use crate::progress::Progress;
use crate::transfer::{Options, RdTable, Size, file_bytes};

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
/// As [`precompute`](crate::transfer::precompute) and [`encode`](crate::transfer::encode); [`Error::Request`] if nothing reaches the
/// target, or if it is no number.
pub fn search(
    source: &TransferSource<'_>,
    target: Target,
    progress: &dyn Progress,
    found: &mut dyn FnMut(&Point),
) -> Result<Curve> {
    if matches!(target, Target::Quality(least) if !least.is_finite() || least >= 0.0) {
        return Err(Error::Request("an error to reach must be a number above 0, for example 0.01".to_owned()));
    }
    let codec = Files::new(*source, progress);
    let mut search = Search::new(codec, target, progress, found);
    match target {
        Target::Quality(least) => path::along_quality(&mut search, least)?,
        Target::Bytes(limit) => path::along_bytes(&mut search, limit)?,
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
