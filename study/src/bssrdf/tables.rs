//! Tables of the page, and what they are to show.

use std::fmt::Write as _;

use super::record::Record;
use super::results::Results;
use crate::page::{duration, mark, table};
use subsurf_viewer::human;

/// `a` is better than `b` by this many dB under every light, least first.
fn least_gain(a: &Record, b: &Record) -> Option<f64> {
    let gains = a.psnr_db.iter().zip(b.psnr_db).filter_map(|(a, b)| Some((*a)? - b?));
    gains.min_by(f64::total_cmp)
}

/// `a` against `b`: share of its error, and the least gain in PSNR.
fn better(a: &Record, b: Option<&Record>) -> String {
    let Some((b, gain)) = b.and_then(|b| Some((b, least_gain(a, b)?))) else {
        return "\u{2013}".to_owned();
    };
    let share = a.relative_error / b.relative_error;
    mark(share < 1.0 && gain > 0.0, &format!("{share:.2} × the error, at least {gain:+.1} dB"))
}

/// Table of what is claimed, and whether it holds for every capture.
pub(super) fn claims(study: &Results<'_>) -> String {
    let titles = [
        "",
        "K = 2 better than the paper's fit, same size",
        "K = 2 better than LSP clusters, same size",
        "K = 2 at least 20 × faster than the paper's fit",
        "error does not rise with K = 1, 2, 3, 5",
        "24 bits per pixel within 0.05 dB of 48",
        "16 bits per pixel within 0.5 dB of 48",
    ];
    let mut rows = Vec::new();
    for (material, noisy) in study.materials.iter().flat_map(|m| [(m, false), (m, true)]) {
        let find = |label| study.find(material, noisy, label);
        let Some(two) = find("k2") else {
            continue;
        };
        let faster = find("paper-k2").map_or("\u{2013}".to_owned(), |paper| {
            let ratio = paper.seconds / two.seconds;
            mark(ratio >= 20.0, &format!("{ratio:.0} × ({} / {})", duration(paper.seconds), duration(two.seconds)))
        });
        let errors: Vec<f64> =
            ["k1", "k2", "k3", "k5"].iter().filter_map(|k| find(k)).map(|record| record.relative_error).collect();
        let falling = errors.windows(2).all(|pair| pair[1] <= pair[0]);
        let shown = errors.iter().map(|error| format!("{error:.5}")).collect::<Vec<_>>().join(", ");
        let within = |label, limit: f64| {
            let change = find(label).and_then(|smaller| Some(smaller.psnr_db[0]? - two.psnr_db[0]?));
            change.map_or("\u{2013}".to_owned(), |change| mark(change >= -limit, &format!("{change:+.2} dB")))
        };
        rows.push(vec![
            format!("{material}{}", if noisy { ", with noise" } else { "" }),
            better(two, find("paper-k2")),
            better(two, find("clusters-equal")),
            faster,
            mark(falling, &shown),
            within("k2-small", 0.05),
            within("k2-palette", 0.5),
        ]);
    }
    let note = "<p class=\"note\">Gains in dB are the least of uniform, disc and line light; the last two columns are uniform \
                light. Same size: at most the bytes of K = 2, M = 128, less than one more base material below it.</p>";
    table(&titles.map(str::to_owned), &rows) + note
}

/// Table of the precisions of K = 2, and of what a compressor would still find.
pub(super) fn precision(study: &Results<'_>) -> String {
    let titles =
        ["", "", "bytes", "relative error", "PSNR uniform / disc / line (dB)", "deflate would save", "LZ4 would save"];
    let mut rows = Vec::new();
    for material in study.materials {
        for label in ["k2", "k2-small", "k2-palette", "k2-half"] {
            let Some(record) = study.find(material, false, label) else {
                continue;
            };
            #[allow(clippy::cast_precision_loss, reason = "a percentage")]
            let saved = |packed: u64| format!("{:.1} %", 100.0 * (1.0 - packed as f64 / record.bytes as f64));
            let db = record.psnr_db.map(|db| db.map_or("-".to_owned(), |db| format!("{db:.2}")));
            rows.push(vec![
                if label == "k2" { material.clone() } else { String::new() },
                study.title(label),
                human(record.bytes),
                format!("{:.5}", record.relative_error),
                db.join(" / "),
                saved(record.deflated),
                saved(record.lz4),
            ]);
        }
    }
    table(&titles.map(str::to_owned), &rows)
}

/// All records as comma-separated values, for spreadsheets.
pub(super) fn csv(study: &Results<'_>) -> String {
    let mut out = String::from(
        "material,noise,fit,K,M,bytes,seconds,relative_error,psnr_uniform_db,psnr_disc_db,psnr_line_db,ssim_uniform,\
         ssim_disc,ssim_line,deflated_bytes,lz4_bytes\n",
    );
    for record in study.records {
        let optional = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
        let Record { material, noisy, label, per_pixel, base_materials, bytes, seconds, relative_error, .. } = record;
        let numbers = record.psnr_db.iter().chain(&record.ssim).map(|value| optional(*value)).collect::<Vec<_>>();
        // Writing to a string cannot fail.
        let _ = writeln!(
            out,
            "{material},{noisy},{label},{per_pixel},{base_materials},{bytes},{seconds:.3},{relative_error},{},{},{}",
            numbers.join(","),
            record.deflated,
            record.lz4,
        );
    }
    out
}
