//! The study as one HTML page that needs nothing beside it.

use std::fmt::Write as _;

use subsurf_cli::compare::db;
use subsurf_viewer::human;

use super::figures;
use super::plan::BASE_MATERIALS;
use super::published::{COMPARED, Published, SIZED, published};
use super::record::Record;
use super::results::Results;
use super::tables::{claims, precision};
use crate::page::colour::{ERRORS, colour};
use crate::page::panel::{Bar, Row, panel};
use crate::page::{CSS, duration, other, table};

impl Results<'_> {
    /// The page in HTML.
    pub(super) fn html(&self) -> anyhow::Result<String> {
        let mut out =
            String::from("<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>subsurf study</title>");
        let _ = write!(out, "<style>{}</style><body>", CSS);
        self.introduction(&mut out);
        out.push_str("<h2>What is claimed, and whether it holds here</h2>");
        out.push_str(&claims(self));
        self.sizes_and_times(&mut out);
        self.errors(&mut out);
        self.similarity(&mut out);
        out.push_str("<h2>Smaller than 48 bits per pixel</h2>");
        out.push_str(&precision(self));
        figures::charts(self, &mut out)?;
        figures::ratios(self, &mut out)?;
        self.appearance(&mut out);
        self.base_material_numbers(&mut out);
        out.push_str("</body></html>\n");
        Ok(out)
    }

    fn introduction(&self, out: &mut String) {
        let [width, height] = self.size;
        let noise = self.photons.map_or(String::new(), |photons| {
            format!(
                "<p class=\"note\">Captures \u{201c}with noise\u{201d} went through a camera that counts {photons:e} photons \
                 where all light of the lit pixel leaves; fits to them are judged by the capture without noise, which is also \
                 the \u{201c}original\u{201d} among the pictures.</p>"
            )
        });
        let _ = write!(
            out,
            "<h1>Heterogeneous subsurface scattering in few bytes: a study</h1><p class=\"note\">The experiments of \
             Yatagawa, Todo, Yamaguchi and Morishima 2020 (tables 2, 5 and 6, figures 4, 5, 9 and 10) on <b>simulated</b> \
             materials, called after the measured ones they are meant to be like: {width} × {height} pixels of {} mm, window \
             {}, S = {}, M = {BASE_MATERIALS} base materials where nothing else is said, {} threads. Captures are solutions of \
             the diffusion equation in a slab (coefficients of Jensen et al. 2001; the blue pigment is invented) with the \
             two directions of every pair made equal, as in nature; measured captures are less kind to any model.</p>\
             <p class=\"note\">\u{201c}Song et al.\u{201d} are per-pixel profiles, \u{201c}LSP clusters\u{201d} their k-means. \
             \u{201c}The paper's fit\u{201d} is its own algorithm (L-BFGS-B or multipliers, and PatchMatch: 20 rounds of at most \
             500 steps) implemented here; on these captures it does not beat the clusters, as it does on theirs. All other \
             fits alternate exact steps, and in the end weigh errors of the albedo beside the cost of eq. 5 that the \
             baselines minimise: the albedo and the picture under uniform light profit. With 24 and 16 bits per pixel they \
             weigh 1.2 and 4 times as much.</p>{noise}<p class=\"note\">{}</p>",
            self.pitch_mm,
            self.window,
            self.window / 2 + 1,
            rayon::current_num_threads(),
            other(
                "Rows like this are numbers from the paper, of its measured materials on its machine: another data set, for \
                 orientation."
            ),
        );
    }

    /// A table with a row per fit, then the paper's own rows; `theirs` gives its numbers by row.
    fn by_material(
        &self,
        noisy: bool,
        labels: &[&str],
        number: impl Fn(&Record) -> Option<String>,
        names: &[&str],
        theirs: impl Fn(&'static Published, usize) -> &'static str,
    ) -> String {
        let none = || "\u{2013}".to_owned();
        let mut rows: Vec<Vec<String>> = labels
            .iter()
            .map(|label| {
                let find = |material: &String| self.find(material, noisy, label).and_then(&number).unwrap_or_else(none);
                std::iter::once(self.title(label)).chain(self.materials.iter().map(find)).collect()
            })
            .collect();
        // Their materials were measured, and had their own noise: one set of rows will do.
        for (at, name) in names.iter().enumerate().filter(|_| !noisy) {
            let cell = |material: &String| other(published(material).map_or("\u{2013}", |paper| theirs(paper, at)));
            let name = other(&format!("their {name}"));
            rows.push(std::iter::once(name).chain(self.materials.iter().map(cell)).collect());
        }
        let title = |material: &String| match published(material) {
            Some(paper) if !noisy => {
                format!("{material}<br>{}", other(&format!("{}, {} pixels", paper.name, paper.pixels)))
            }
            _ => material.clone(),
        };
        let titles: Vec<String> = std::iter::once(String::new()).chain(self.materials.iter().map(title)).collect();
        table(&titles, &rows)
    }

    fn sizes_and_times(&self, out: &mut String) {
        let _ = write!(
            out,
            "<h2>Sizes and times (their table 2)</h2><h3>Bytes; a capture has {}</h3>",
            human(self.capture_bytes)
        );
        let mut labels = vec!["song", "k1", "k2", "k3", "k5", "clusters-equal", "k1-equal"];
        labels.extend(self.papers());
        let size = |record: &Record| {
            let bases = match record.base_materials {
                0 => String::new(),
                count => format!(", M = {count}"),
            };
            Some(format!("{}{bases}", human(record.bytes)))
        };
        let names: Vec<&str> = std::iter::once("original").chain(SIZED).collect();
        out.push_str(&self.by_material(false, &labels, size, &names, |paper, at| {
            if at == 0 { paper.original } else { paper.bytes[at - 1] }
        }));
        out.push_str("<h3>Time from capture to file, measured once</h3>");
        let time = |record: &Record| Some(duration(record.seconds));
        out.push_str(&self.by_material(false, &labels, time, &SIZED[1..], |paper, at| paper.times[at]));
    }

    fn errors(&self, out: &mut String) {
        out.push_str("<h2>Mean relative error of the diffuse albedo (their table 5)</h2>");
        for (noisy, title) in self.halves() {
            let _ = write!(out, "<h3>Captures {title}</h3>");
            out.push_str(&self.by_material(
                noisy,
                &self.labels_compared(),
                |record| Some(format!("{:.5}", record.relative_error)),
                &COMPARED,
                |paper, at| paper.relative_error[at],
            ));
        }
    }

    fn similarity(&self, out: &mut String) {
        out.push_str("<h2>PSNR and SSIM of the lit patch (their table 6)</h2>");
        for (noisy, title) in self.halves() {
            let _ = write!(out, "<h3>PSNR in dB, uniform light (disc / line), captures {title}</h3>");
            out.push_str(&self.by_material(
                noisy,
                &self.labels_compared(),
                |record| {
                    let [uniform, disc, line] = record.psnr_db.map(db);
                    Some(format!("{uniform} ({disc} / {line})"))
                },
                &COMPARED,
                |paper, at| paper.psnr_db[at],
            ));
            let _ = write!(out, "<h3>SSIM, uniform light, captures {title}</h3>");
            out.push_str(&self.by_material(
                noisy,
                &self.labels_compared(),
                |record| record.ssim[0].map(|ssim| format!("{ssim:.5}")),
                &COMPARED,
                |paper, at| paper.ssim[at],
            ));
        }
    }

    fn appearance(&self, out: &mut String) {
        out.push_str("<h2>Appearance under three lights, and errors of the albedo (their figures 5 and 9)</h2>");
        let labels: Vec<&str> = std::iter::once("original").chain(self.labels_compared()).collect();
        for (noisy, title) in self.halves() {
            for material in self.materials {
                let _ = write!(out, "<h3>{material}, {title}</h3><div class=\"wide\">");
                out.push_str(&self.appearance_of(material, noisy, &labels, &["uniform", "disc", "line", "error"]));
                out.push_str("</div>");
            }
        }
    }

    fn appearance_of(&self, material: &str, noisy: bool, labels: &[&str], whats: &[&str]) -> String {
        let columns: Vec<String> = labels.iter().map(|label| self.title(label)).collect();
        let rows: Vec<Row> = whats
            .iter()
            .map(|what| Row {
                title: if *what == "error" { "albedo error".to_owned() } else { (*what).to_owned() },
                pictures: labels.iter().map(|label| self.picture(material, noisy, label, what)).collect(),
            })
            .collect();
        panel(&columns, &rows, self.mm(), Some(&error_bar()))
    }

    fn base_material_numbers(&self, out: &mut String) {
        out.push_str("<h2>Numbers of base materials, K = 2 (their figure 10)</h2>");
        let labels = ["original", "k2-m8", "k2-m32", "k2"];
        for material in self.materials {
            let _ = write!(out, "<h3>{material}</h3><div class=\"wide\">");
            out.push_str(&self.appearance_of(material, false, &labels, &["uniform", "error"]));
            let rows: Vec<Vec<String>> = labels[1..]
                .iter()
                .filter_map(|label| self.find(material, false, label))
                .map(|record| {
                    vec![
                        format!("M = {}", record.base_materials),
                        human(record.bytes),
                        format!("{:.5}", record.relative_error),
                        db(record.psnr_db[0]),
                    ]
                })
                .collect();
            let titles = ["", "bytes", "relative error", "PSNR uniform (dB)"].map(str::to_owned);
            out.push_str(&table(&titles, &rows));
            out.push_str("</div>");
        }
    }
}

fn error_bar() -> Bar {
    let [low, high] = ERRORS.map(f64::log10);
    let ticks = [1e-4, 1e-3, 1e-2, 1e-1];
    let ticks = ticks.map(|error: f64| {
        // The ends stand for what lies beyond them, too.
        let bound = if error == ERRORS[0] {
            "≤ "
        } else if error == ERRORS[1] {
            "≥ "
        } else {
            ""
        };
        (format!("{bound}{error}"), (error.log10() - low) / (high - low))
    });
    Bar { title: "relative error", ticks: ticks.to_vec(), colour }
}
