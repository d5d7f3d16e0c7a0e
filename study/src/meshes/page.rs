//! The page, its tables and its CSV.

use std::fmt::Write as _;

use subsurf_cli::outln;

use super::figures;
use super::published::{INTERPOLATION, LLOYD_SNR_DB, Published, TABLE};
use super::record::{Interpolation, Measured, Record};
use crate::page::{CSS, mark, other, table};

/// Share by which radial basis functions should be below the four nearest lights.
const REDUCTION: f64 = 0.4;
/// Bytes per vertex with which our files should be closer to exact sums than the paper's scheme is.
const BYTES: f64 = 10.0;

/// All that was measured, by the names of the meshes.
pub(super) struct Page<'a> {
    pub(super) records: &'a [(String, Record)],
    pub(super) material: &'a str,
    pub(super) extent_mm: f32,
}

/// A table: its title, its columns, and its rows.
struct Table {
    title: &'static str,
    columns: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Page<'_> {
    pub(super) fn html(&self) -> anyhow::Result<String> {
        let lights = self.records.first().map_or(0, |(_, record)| record.key.lights);
        let mut out = format!(
            "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>Transfer on meshes</title><style>{CSS}</style><body>\
             <h1>Scattering precomputed for meshes</h1><p class=\"note\">Our transfer files beside what Hao and Varshney 2004, \
             <i>Real-time rendering of translucent meshes</i>, store: {}, meshes {} mm long, one channel, {lights} lights on a spiral. q is divided by \
             its largest value. e<sub>rms</sub> is theirs (section 3.3): the root-mean-square error of an orthographic image of 256 × 256 pixels with its \
             background, over 100 views from random sides, each under one of 24 lights between the stored ones; \u{201c}worst\u{201d} is that of the worst \
             view, \u{201c}all\u{201d} the one over all. \u{201c}Against exact sums\u{201d} each scheme has its own interpolation: the paper's the four nearest \
             lights by inverse angles, ours radial basis functions; all else compares with q that is not compressed, between the lights by radial basis functions \
             in both, and by the four nearest, a mean of four errors, where that is said.</p>\
             <p class=\"note\">Reference points are each the vertex that is farthest from those before it, in place of a simplified mesh; weights are barycentric, \
             16 bits each. Spherical harmonics are least squares at the lights. Bytes count all that is stored, of ours whole files; those of reference points \
             have the number of a triangle for each vertex, which the paper leaves out. A PCA is a file of ours with one cluster. Seconds are those to add up q for the \
             lights and two dozen directions to compare with, and those to compress it. A tick says that errors are at least {:.0} % less, and of our files that they \
             are smaller than theirs, or closer.</p>\
             <p class=\"note\">{}</p>",
            self.material,
            self.extent_mm,
            100.0 * REDUCTION,
            other(
                "Numbers like this are the paper's, of its meshes and its material: another data set, for orientation."
            ),
        );
        for (mut found, theirs) in [(self.lights(), published_lights()), (self.summary(), published_summary())] {
            let padded = |cells: Vec<String>| {
                let empty = found.columns.len() - cells.len();
                cells.iter().map(|cell| other(cell)).chain(std::iter::repeat_n(String::new(), empty)).collect()
            };
            found.rows.extend(theirs.into_iter().map(padded).collect::<Vec<Vec<String>>>());
            let _ =
                write!(out, "<h2>{}</h2><div class=\"wide\">{}</div>", found.title, table(&found.columns, &found.rows));
        }
        let _ = write!(out, "<div class=\"charts\">{}</div>", figures::lights(self.records)?);
        for (name, record) in self.records {
            let _ = write!(out, "<h2>{name}, {} vertices</h2>", record.vertices);
            let _ = write!(out, "<div class=\"charts\">{}</div>", figures::schemes(name, record)?);
            let _ = write!(out, "<p class=\"note\">A byte for each light: {:.1} dB SNR.</p>", record.lloyd_snr_db);
            let found = schemes(record);
            out.push_str(&table(&found.columns, &found.rows));
        }
        out.push_str("</body></html>\n");
        Ok(out)
    }

    /// Prints the tables that are about all meshes.
    pub(super) fn print(&self) {
        for Table { title, columns, rows } in [self.lights(), self.summary()] {
            outln!("\n{title}\n\n| {} |", columns.join(" | "));
            outln!("|---|{}", "---:|".repeat(columns.len() - 1));
            rows.iter().for_each(|row| outln!("| {} |", row.join(" | ")));
        }
    }

    /// Light between the stored directions.
    fn lights(&self) -> Table {
        let columns = [
            "",
            "lights",
            "precomputed in",
            "four nearest: worst",
            "all",
            "radial: worst",
            "all",
            "less: worst",
            "all",
        ];
        let row = |name: &String, of: &Interpolation| {
            let Interpolation { lights, seconds, four_nearest, radial } = of;
            let less = |a: f64, b: f64| mark(a <= (1.0 - REDUCTION) * b, &format!("{:.0} %", 100.0 * (1.0 - a / b)));
            let errors = [four_nearest.max, four_nearest.rms, radial.max, radial.rms].map(thousandths);
            let less = [less(radial.max, four_nearest.max), less(radial.rms, four_nearest.rms)];
            let first = [name.clone(), lights.to_string(), format!("{seconds:.1} s")];
            first.into_iter().chain(errors).chain(less).collect()
        };
        let all = self.records.iter().flat_map(|(name, record)| record.interpolations.iter().map(move |of| (name, of)));
        let rows = all.map(|(name, of)| row(name, of)).collect();
        let title = "Light between the stored directions, q not compressed, against exact sums (its Figure 5)";
        Table { title, columns: columns.map(str::to_owned).into(), rows }
    }

    /// The paper's scheme and ours, as in its Table I.
    fn summary(&self) -> Table {
        let columns = [
            "",
            "vertices",
            "a byte for each: SNR",
            "theirs: points",
            "bytes as they count",
            "all bytes",
            "worst",
            "against exact sums: all",
            "ours: bytes",
            "worst",
            "against exact sums: all",
            "bytes at no more error",
            "against exact sums at 10 bytes: all",
            "seconds",
        ];
        let rows = self.records.iter().map(|(name, record)| summary_row(name, record)).collect();
        Table { title: "The paper's scheme and ours (its Table I)", columns: columns.map(str::to_owned).into(), rows }
    }

    /// All schemes.
    pub(super) fn csv(&self) -> String {
        let mut out = String::from(
            "mesh,vertices,lights,scheme,bytes_per_vertex,compression_worst,compression_all,compression_by_four_worst,\
             compression_by_four_all,total_worst,total_all\n",
        );
        for (name, record) in self.records {
            for of in &record.schemes {
                let errors = of.errors().map(|error| format!("{:.6},{:.6}", error.max, error.rms)).join(",");
                let (vertices, lights, title) = (record.vertices, record.key.lights, of.kind.title());
                let _ = writeln!(out, "\"{name}\",{vertices},{lights},\"{title}\",{:.3},{errors}", of.bytes);
            }
        }
        out
    }

    /// Light between the stored directions.
    pub(super) fn lights_csv(&self) -> String {
        let mut out =
            String::from("mesh,vertices,lights,seconds,four_nearest_worst,four_nearest_all,radial_worst,radial_all\n");
        for (name, record) in self.records {
            for Interpolation { lights, seconds, four_nearest, radial } in &record.interpolations {
                let _ = writeln!(
                    out,
                    "\"{name}\",{},{lights},{seconds:.2},{:.6},{:.6},{:.6},{:.6}",
                    record.vertices, four_nearest.max, four_nearest.rms, radial.max, radial.rms
                );
            }
        }
        out
    }
}

/// What the paper has of light between the stored directions, in the first columns.
fn published_lights() -> Vec<Vec<String>> {
    vec![["their four meshes", "200", "", &thousandths(INTERPOLATION)].map(str::to_owned).into()]
}

/// What the paper has of its scheme, in the first columns.
fn published_summary() -> Vec<Vec<String>> {
    let row = |of: &Published| {
        let snr = if of.name == "teapot" { format!("{LLOYD_SNR_DB} dB") } else { String::new() };
        vec![of.name.to_owned(), of.vertices.to_string(), snr, of.points.to_string(), of.bytes.to_string()]
    };
    TABLE.iter().map(row).collect()
}

fn summary_row(name: &str, record: &Record) -> Vec<String> {
    let (theirs, ours) = (record.theirs(), record.ours());
    let points = theirs.kind.points().map_or_else(String::new, |points| points.to_string());
    let fewer = record.smallest(|of| of.compression.max <= theirs.compression.max);
    let fewer =
        fewer.map_or_else(|| mark(false, "none"), |of| mark(of.bytes < theirs.bytes, &format!("{:.1}", of.bytes)));
    let closest = record.closest(BYTES);
    let closest = closest.map_or_else(
        || mark(false, "none"),
        |of| mark(of.total.rms < theirs.total.rms, &format!("{} ({:.1} bytes)", thousandths(of.total.rms), of.bytes)),
    );
    let seconds: f64 =
        record.interpolations.iter().filter(|of| of.lights == record.key.lights).map(|of| of.seconds).sum();
    vec![
        name.to_owned(),
        record.vertices.to_string(),
        format!("{:.1} dB", record.lloyd_snr_db),
        points,
        theirs.bytes_without_indices.map_or_else(String::new, |bytes| format!("{bytes:.1}")),
        format!("{:.1}", theirs.bytes),
        thousandths(theirs.compression.max),
        thousandths(theirs.total.rms),
        format!("{:.1}", ours.bytes),
        thousandths(ours.compression.max),
        thousandths(ours.total.rms),
        fewer,
        closest,
        format!("{:.0} + {:.0}", seconds, record.compress_seconds),
    ]
}

fn schemes(record: &Record) -> Table {
    let columns = [
        "",
        "bytes per vertex",
        "without indices",
        "worst",
        "all",
        "by four nearest lights: worst",
        "all",
        "against exact sums: worst",
        "all",
    ]
    .map(str::to_owned);
    let row = |of: &Measured| {
        let first = [
            of.kind.title(),
            format!("{:.1}", of.bytes),
            of.bytes_without_indices.map_or_else(String::new, |bytes| format!("{bytes:.1}")),
        ];
        let errors = of.errors().into_iter().flat_map(|error| [error.max, error.rms]).map(thousandths);
        first.into_iter().chain(errors).collect()
    };
    Table { title: "", columns: columns.into(), rows: record.schemes.iter().map(row).collect() }
}

/// An error in thousandths.
fn thousandths(error: f64) -> String {
    format!("{:.2}e-3", 1e3 * error)
}
