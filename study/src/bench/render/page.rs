//! Page of the results.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use base64::Engine as _;
use serde_json::{Value, json};
use subsurf_cli::outln;
use subsurf_encoder::write_bytes;
use subsurf_runtime::{Backend, Gpu};
use subsurf_viewer::human;

use super::super::timing::median;
use crate::page::CSS;

/// Columns of CSV files, as JSON names them.
const COLUMNS: [&str; 12] = [
    "material",
    "mesh",
    "path",
    "backend",
    "psnr_db",
    "ssim",
    "frame_median_ms",
    "frame_p95_ms",
    "gather_ms",
    "file_bytes",
    "material_bytes",
    "buffer_bytes",
];

/// Row of the table: one technique, material, mesh and device.
pub(super) struct Row {
    pub(super) material: String,
    pub(super) mesh: String,
    pub(super) path: String,
    pub(super) backend: Backend,
    /// PSNR in dB and SSIM; none of the reference itself.
    pub(super) similarity: Option<[f64; 2]>,
    /// Median and 95th percentile of frames in ms.
    pub(super) frame_ms: Option<[f64; 2]>,
    /// Time of a frame of the reference in the same run, in ms.
    pub(super) gather_ms: Option<f64>,
    pub(super) file_bytes: u64,
    pub(super) material_bytes: u64,
    pub(super) buffer_bytes: u64,
}

impl Row {
    pub(super) fn line(&self) -> String {
        let similarity =
            self.similarity.map_or("reference".to_owned(), |[psnr, ssim]| format!("{psnr:.1} dB, SSIM {ssim:.3}"));
        let time = self.frame_ms.map_or(String::new(), |[median, p95]| format!(", {median:.1} ms (p95 {p95:.1})"));
        let ratio = match (self.frame_ms, self.gather_ms) {
            (Some([median, _]), Some(gather)) if self.similarity.is_some() => {
                format!(", gather {gather:.0} ms = {:.1} ×", gather / median)
            }
            _ => String::new(),
        };
        format!(
            "{}, {}, {}: {:<18} {similarity}{time}{ratio}; file {}, material {}, buffers {}",
            self.material,
            self.mesh,
            self.backend,
            self.path,
            human(self.file_bytes),
            human(self.material_bytes),
            human(self.buffer_bytes),
        )
    }

    fn json(&self) -> Value {
        json!({
            "material": self.material, "mesh": self.mesh, "path": self.path, "backend": self.backend.to_string(),
            "psnr_db": self.similarity.map(|both| both[0]), "ssim": self.similarity.map(|both| both[1]), "frame_median_ms": self.frame_ms.map(|times| times[0]),
            "frame_p95_ms": self.frame_ms.map(|times| times[1]), "gather_ms": self.gather_ms, "file_bytes": self.file_bytes,
            "material_bytes": self.material_bytes, "buffer_bytes": self.buffer_bytes,
        })
    }

    fn cells(&self) -> String {
        let digits = |value: Option<f64>, count| value.map_or("–".to_owned(), |value| format!("{value:.count$}"));
        let time = |value| digits(value, 1);
        format!(
            "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td>\
             <td>{}</td><td>{}</td><td>{}</td></tr>",
            self.material,
            self.mesh,
            self.path,
            self.backend,
            digits(self.similarity.map(|both| both[0]), 1),
            digits(self.similarity.map(|both| both[1]), 3),
            time(self.frame_ms.map(|times| times[0])),
            time(self.frame_ms.map(|times| times[1])),
            time(self.gather_ms),
            human(self.file_bytes),
            human(self.material_bytes),
            human(self.buffer_bytes),
        )
    }
}

/// Page: rows of a table, and pictures.
pub(super) struct Page<'a> {
    pub(super) folder: &'a Path,
    pub(super) rows: Vec<Row>,
    /// Titles and file names.
    pub(super) pictures: Vec<(String, String)>,
}

impl Page<'_> {
    /// Adds a row, and prints it.
    pub(super) fn add(&mut self, row: Row) {
        outln!("{}", row.line());
        self.rows.push(row);
    }

    /// Worst and median PSNR of each technique on each device, if there are several pictures of each.
    fn summary(&self) -> Vec<String> {
        let mut of: BTreeMap<(String, &str), Vec<(f64, &Row)>> = BTreeMap::new();
        for row in &self.rows {
            if let Some([psnr_db, _]) = row.similarity {
                of.entry((row.backend.to_string(), &row.path)).or_default().push((psnr_db, row));
            }
        }
        let line = |((backend, path), mut rows): ((String, &str), Vec<(f64, &Row)>)| {
            rows.sort_by(|a, b| a.0.total_cmp(&b.0));
            let (least_db, worst) = rows[0];
            let values: Vec<f64> = rows.iter().map(|(psnr_db, _)| *psnr_db).collect();
            format!(
                "{backend}: {path:<18} {least_db:.1} dB at worst ({}, {}), {:.1} dB median of {}",
                worst.material,
                worst.mesh,
                median(&values),
                rows.len()
            )
        };
        of.into_iter().filter(|(_, rows)| rows.len() > 1).map(line).collect()
    }

    /// Rows in CSV, under their titles; nothing where there is no value.
    pub(super) fn csv(&self) -> String {
        let rows: Vec<Value> = self.rows.iter().map(Row::json).collect();
        let mut out = format!("{}\n", COLUMNS.join(","));
        let cell = |value: &Value| match value {
            Value::Null => String::new(),
            // Names are those of files: they may have commas, which names of paths have, too.
            Value::String(text) => format!("\"{}\"", text.replace('"', "\"\"")),
            number => number.to_string(),
        };
        for row in rows {
            let _ = writeln!(out, "{}", COLUMNS.map(|column| cell(&row[column])).join(","));
        }
        out
    }

    /// Table and pictures in HTML.
    pub(super) fn body(&self) -> anyhow::Result<String> {
        let mut out = String::from(
            "<table><thead><tr><th>material</th><th>mesh</th><th>path</th><th>device</th><th>PSNR, dB</th><th>SSIM</th>\
             <th>frame, ms</th><th>p95</th><th>gather, ms</th><th>file</th><th>material</th><th>buffers</th></tr></thead>",
        );
        self.rows.iter().for_each(|row| out.push_str(&row.cells()));
        out.push_str("</table>");
        for line in self.summary() {
            let _ = write!(out, "<p>{line}</p>");
        }
        out.push_str("<p class=\"note\">Below each picture its difference from the reference, ten times.</p>");
        for (title, file) in &self.pictures {
            let bytes = std::fs::read(self.folder.join(file))?;
            let data = base64::engine::general_purpose::STANDARD.encode(bytes);
            let _ = write!(out, "<h3>{title}</h3><img style=\"max-width:100%\" src=\"data:image/png;base64,{data}\">");
        }
        Ok(out)
    }

    pub(super) fn write(&self, gpus: &[(Backend, Gpu)], [width, height]: [u32; 2]) -> anyhow::Result<()> {
        let rows: Vec<Value> = self.rows.iter().map(Row::json).collect();
        write_bytes(&self.folder.join("render.json"), format!("{:#}\n", Value::Array(rows)).as_bytes())?;
        write_bytes(&self.folder.join("render.csv"), self.csv().as_bytes())?;
        let mut out = String::from("<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>paths</title>");
        let _ = write!(out, "<style>{}</style><body>", CSS);
        let devices: Vec<String> =
            gpus.iter().map(|(backend, gpu)| format!("{backend}: {}", gpu.info().name)).collect();
        let _ = write!(
            out,
            "<h1>Paths against the reference</h1><p class=\"note\">Every path draws the same scene at {width} × {height} \
             pixels: one directional light with shadow, a dim studio around, a coat of roughness 0.25. The reference gathers light \
             between points of the surface by their distances in space. PSNR is of display values over the pixels that the \
             mesh covers in either picture; SSIM is of the whole picture. Times are medians of whole frames until the device \
             is through, the light turning from frame to frame; those of one device come from one run and compare with each \
             other only. {}.</p>",
            devices.join("; ")
        );
        out.push_str(&self.body()?);
        out.push_str("</body></html>\n");
        self.summary().iter().for_each(|line| outln!("{line}"));
        write_bytes(&self.folder.join("index.html"), out.as_bytes())?;
        outln!("\n{}", self.folder.join("index.html").display());
        Ok(())
    }
}
