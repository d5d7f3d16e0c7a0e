//! A rate-distortion curve for people and for programs.

use serde_json::{Value, json};
use subsurf_decoder::bssrdf::Coding;
use subsurf_encoder::rate::bssrdf::{Curve, Point};
use subsurf_viewer::human;

use crate::compare::db;
use crate::outln;

/// Name of a coding on the command line.
pub(super) fn coding_name(coding: Coding) -> &'static str {
    match coding {
        Coding::Exact => "exact",
        Coding::SmallRatios => "small",
        Coding::Palette => "palette",
    }
}

/// Line about one model that was tried.
pub(super) fn line(point: &Point) -> String {
    let [uniform, disc, line] = point.distortion.psnr_db.map(db);
    let options = &point.candidate;
    format!(
        "  {:>8}  K = {}  {:<7}  M = {:<3}  {} profiles  error {:.4}  PSNR {uniform} / {disc} / {line} dB",
        human(point.bytes() as u64),
        options.per_pixel,
        coding_name(options.coding),
        point.file.base_materials,
        if options.half_profiles { "f16" } else { "f32" },
        point.distortion.relative_error,
    )
}

/// Prints all models that were tried by size; those that a smaller one beats are set apart.
pub(super) fn print(curve: &Curve) {
    let mut points: Vec<(usize, &Point)> = curve.points.iter().enumerate().collect();
    points.sort_by_key(|(_, point)| point.bytes());
    outln!("rate-distortion curve, PSNR under uniform / disc / line light (* best of its size, > chosen):");
    let mut highest = f64::NEG_INFINITY;
    for (number, point) in points {
        let uniform = point.distortion.psnr_db[0].unwrap_or(f64::NEG_INFINITY);
        let mark = if number == curve.best {
            '>'
        } else if uniform > highest {
            '*'
        } else {
            ' '
        };
        highest = highest.max(uniform);
        outln!("{mark}{}", line(point));
    }
}

/// All models that were tried, in the order in which they were.
pub(super) fn to_json(curve: &Curve) -> Value {
    let points = curve.points.iter().enumerate().map(|(number, point)| {
        let [uniform, disc, line] = point.distortion.psnr_db;
        json!({
            "chosen": number == curve.best,
            "bytes": point.bytes(),
            "per_pixel": point.candidate.per_pixel,
            "coding": coding_name(point.candidate.coding),
            "base_materials": point.file.base_materials,
            "half_profiles": point.candidate.half_profiles,
            "relative_error_mean": point.distortion.relative_error,
            "psnr_db": { "uniform": uniform, "disc": disc, "line": line },
        })
    });
    points.collect()
}
