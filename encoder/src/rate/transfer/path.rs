//! Which lights and sizes are tried.

use subsurf_decoder::transfer::layout::MAX_CLUSTERS;

use super::TransferCandidate;
use super::files::Files;
use crate::error::{Error, Result};
use crate::rate::search::Search;
use crate::transfer::Size;

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

/// Adds lights until interpolation is good enough, and on for as long as the smallest size that is makes smaller files.
pub(super) fn along_quality(search: &mut Search<'_, Files<'_>>, least: f64) -> Result<()> {
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
pub(super) fn along_bytes(search: &mut Search<'_, Files<'_>>, limit: u64) -> Result<()> {
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
