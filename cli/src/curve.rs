//! A rate-distortion curve for people and for programs.

use serde_json::{Value, json};
use subsurf_encoder::rate::{Point, Walked};

use crate::compare::db;
use crate::encode::coding_name;
use crate::outln;
use subsurf_viewer::human;

/// One model that was tried.
pub(crate) fn line(point: &Point) -> String {
    let [uniform, disc, line] = point.psnr_db.map(db);
    let options = &point.options;
    format!(
        "  {:>8}  K = {}  {:<7}  M = {:<3}  {} profiles  error {:.4}  PSNR {uniform} / {disc} / {line} dB",
        human(point.encoded.bytes.len() as u64),
        options.per_pixel,
        coding_name(options.coding),
        point.encoded.base_materials,
        if options.half_profiles { "f16" } else { "f32" },
        point.relative_error,
    )
}

/// All of them by size; those that a smaller one beats are set apart.
pub(crate) fn print(walked: &Walked) {
    let mut points: Vec<(usize, &Point)> = walked.points.iter().enumerate().collect();
    points.sort_by_key(|(_, point)| point.encoded.bytes.len());
    outln!("rate-distortion curve, PSNR under uniform / disc / line light (* best of its size, > chosen):");
    let mut highest = f64::NEG_INFINITY;
    for (number, point) in points {
        let uniform = point.psnr_db[0].unwrap_or(f64::NEG_INFINITY);
        let mark = if number == walked.best {
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

pub(crate) fn to_json(walked: &Walked) -> Value {
    let points = walked.points.iter().enumerate().map(|(number, point)| {
        let [uniform, disc, line] = point.psnr_db;
        json!({
            "chosen": number == walked.best,
            "bytes": point.encoded.bytes.len(),
            "per_pixel": point.options.per_pixel,
            "coding": coding_name(point.options.coding),
            "base_materials": point.encoded.base_materials,
            "half_profiles": point.options.half_profiles,
            "relative_error_mean": point.relative_error,
            "psnr_db": { "uniform": uniform, "disc": disc, "line": line },
        })
    });
    points.collect()
}
