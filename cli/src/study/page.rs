//! The study as one HTML page that needs nothing beside it.

use std::fmt::Write as _;
use std::path::Path;

use super::colour::{ERRORS, colour};
use super::panel::{Bar, Row, panel};
use super::plan::BASE_MATERIALS;
use super::published::{METHODS, Published, published};
use super::record::{Record, capture_name, picture_path};
use super::tables::{cell, claims, precision, table};
use super::{figures, plan};
use crate::memory::human;

/// Everything the page is made from.
pub(super) struct Study<'a> {
    pub(super) folder: &'a Path,
    pub(super) materials: &'a [String],
    pub(super) records: &'a [Record],
    pub(super) fits: &'a [plan::Fit],
    pub(super) size: [usize; 2],
    pub(super) window: u32,
    pub(super) pitch_mm: f64,
    pub(super) photons: Option<f64>,
    pub(super) capture_bytes: u64,
}

impl Study<'_> {
    pub(super) fn find(&self, material: &str, noisy: bool, label: &str) -> Option<&Record> {
        self.records.iter().find(|r| r.material == material && r.noisy == noisy && r.label == label)
    }

    pub(super) fn title(&self, label: &str) -> String {
        let fit = self.fits.iter().find(|fit| fit.label == label);
        fit.map_or_else(|| label.to_owned(), |fit| fit.title.clone())
    }

    pub(super) fn has_noise(&self) -> bool {
        self.records.iter().any(|record| record.noisy)
    }

    /// Labels of the paper's own fits that were made.
    fn papers(&self) -> impl Iterator<Item = &str> {
        self.fits.iter().map(|fit| fit.label.as_str()).filter(|label| label.starts_with("paper"))
    }

    /// The page.
    pub(super) fn html(&self) -> anyhow::Result<String> {
        let mut out =
            String::from("<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>subsurf study</title>");
        let _ = write!(out, "<style>{}</style><body>", include_str!("page.css"));
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
                " Captures \u{201c}with noise\u{201d} went through a camera that counts {photons:.0e} photons where all light \
                 of the lit pixel leaves; fits to them are judged by the capture without noise."
            )
        });
        let _ = write!(
            out,
            "<h1>Heterogeneous subsurface scattering in few bytes: a study</h1><p class=\"note\">The experiments of \
             Yatagawa, Todo, Yamaguchi and Morishima 2020 (tables 2, 5 and 6, figures 4, 5, 9 and 10) on <b>simulated</b> \
             materials: {width} × {height} pixels of {} mm, window {}, {} each as a capture, M = {BASE_MATERIALS} base \
             materials where nothing else is said.{noise} Fits are ours (alternation of exact steps) but for those called \
             the paper's fit (L-BFGS-B or multipliers, and PatchMatch, also implemented here). \
             <span class=\"other\">Numbers like this are the paper's own, of its measured materials on its machine: \
             another data set, here for orientation.</span></p>",
            self.pitch_mm,
            self.window,
            human(self.capture_bytes),
        );
    }

    /// A table of one number per material and method, the paper's own beneath.
    fn by_material(
        &self,
        noisy: bool,
        labels: &[&str],
        number: impl Fn(&Record) -> Option<String>,
        theirs: impl Fn(&Published, usize) -> Option<String>,
    ) -> String {
        let rows = labels.iter().map(|label| {
            let cells = self.materials.iter().map(|material| {
                let ours = self.find(material, noisy, label).and_then(&number);
                let column = METHODS.iter().position(|method| method == label);
                let theirs = column.zip(published(material)).and_then(|(column, paper)| theirs(paper, column));
                cell(ours, theirs)
            });
            std::iter::once(self.title(label)).chain(cells).collect()
        });
        let titles = std::iter::once(String::new()).chain(self.materials.iter().map(|material| {
            published(material).map_or(material.clone(), |paper| {
                format!("{material}<br><span class=\"other\">{}, {}</span>", paper.name, paper.pixels)
            })
        }));
        table(&titles.collect::<Vec<_>>(), &rows.collect::<Vec<_>>())
    }

    fn sizes_and_times(&self, out: &mut String) {
        out.push_str("<h2>Sizes and times (their table 2)</h2><h3>Bytes</h3>");
        let bytes = |paper: &Published, at: usize| {
            // Their table 2 has K = 1 with 128 base materials.
            let at = if at == 1 { None } else { Some(at) };
            at.and_then(|at| paper.bytes[at]).map(|bytes| human(bytes.round() as u64))
        };
        let labels = ["song", "k1", "k2", "k3", "k5"];
        let of_k1 = |label: &'static str| if label == "k1" { "k1-equal" } else { label };
        let theirs = |value: fn(&Published, usize) -> Option<String>, label: &'static str, paper: &Published| {
            METHODS.iter().position(|method| *method == of_k1(label)).and_then(|at| value(paper, at))
        };
        let rows = |number: &dyn Fn(&Record) -> String, value: fn(&Published, usize) -> Option<String>| {
            labels.map(|label| {
                let cells = self.materials.iter().map(|material| {
                    let ours = self.find(material, false, label).map(number);
                    cell(ours, published(material).and_then(|paper| theirs(value, label, paper)))
                });
                std::iter::once(self.title(label)).chain(cells).collect::<Vec<_>>()
            })
        };
        let titles: Vec<String> = std::iter::once(String::new()).chain(self.materials.iter().cloned()).collect();
        let mut sizes = vec![
            std::iter::once("capture".to_owned())
                .chain(self.materials.iter().map(|material| {
                    let theirs = published(material).map(|paper| human((paper.original_mb * 1e6) as u64));
                    cell(Some(human(self.capture_bytes)), theirs)
                }))
                .collect::<Vec<_>>(),
        ];
        sizes.extend(rows(&|record| human(record.bytes), bytes));
        out.push_str(&table(&titles, &sizes));
        out.push_str("<h3>Time from capture to file</h3>");
        let mut times = rows(&|record| duration(record.seconds), |paper, at| paper.seconds[at].map(duration)).to_vec();
        times.extend(self.papers().map(|label| {
            let cells = self.materials.iter();
            let cells =
                cells.map(|material| cell(self.find(material, false, label).map(|r| duration(r.seconds)), None));
            std::iter::once(self.title(label)).chain(cells).collect()
        }));
        out.push_str(&table(&titles, &times));
    }

    fn labels_compared(&self) -> Vec<&str> {
        let mut labels = METHODS.to_vec();
        labels.insert(2, "k1");
        labels.extend(self.papers());
        labels
    }

    fn halves(&self) -> Vec<(bool, &'static str)> {
        let mut halves = vec![(false, "without noise")];
        if self.has_noise() {
            halves.push((true, "with noise"));
        }
        halves
    }

    fn errors(&self, out: &mut String) {
        out.push_str("<h2>Mean relative error of the diffuse albedo (their table 5)</h2>");
        for (noisy, title) in self.halves() {
            let _ = write!(out, "<h3>Captures {title}</h3>");
            out.push_str(&self.by_material(
                noisy,
                &self.labels_compared(),
                |record| Some(format!("{:.5}", record.relative_error)),
                |paper, at| (!noisy).then(|| format!("{:.4}", paper.relative_error[at])),
            ));
        }
    }

    fn similarity(&self, out: &mut String) {
        out.push_str("<h2>PSNR and SSIM of the lit patch (their table 6)</h2>");
        let db = |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.1}"));
        for (noisy, title) in self.halves() {
            let _ = write!(out, "<h3>PSNR in dB, uniform light (disc / line), captures {title}</h3>");
            out.push_str(&self.by_material(
                noisy,
                &self.labels_compared(),
                |record| {
                    let [uniform, disc, line] = record.psnr_db.map(db);
                    Some(format!("{uniform} ({disc} / {line})"))
                },
                |paper, at| (!noisy).then(|| format!("{:.1}", paper.psnr_db[at])),
            ));
            let _ = write!(out, "<h3>SSIM, uniform light, captures {title}</h3>");
            out.push_str(&self.by_material(
                noisy,
                &self.labels_compared(),
                |record| record.ssim[0].map(|ssim| format!("{ssim:.5}")),
                |paper, at| (!noisy).then(|| format!("{:.3}", paper.ssim[at])),
            ));
        }
    }

    pub(super) fn mm(&self) -> [f64; 2] {
        #[allow(clippy::cast_precision_loss, reason = "a length on a picture")]
        self.size.map(|side| side as f64 * self.pitch_mm)
    }

    pub(super) fn picture(&self, material: &str, noisy: bool, label: &str, what: &str) -> Option<Vec<u8>> {
        std::fs::read(picture_path(self.folder, &capture_name(material, noisy), label, what)).ok()
    }

    fn appearance(&self, out: &mut String) {
        out.push_str("<h2>Appearance under three lights, and errors of the albedo (their figures 5 and 9)</h2>");
        let mut labels = vec!["original", "song", "clusters-equal", "k1", "k1-equal", "k2", "k3", "k5"];
        labels.extend(self.papers());
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
                        record.psnr_db[0].map_or("-".to_owned(), |db| format!("{db:.1}")),
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
    let ticks = ticks.map(|error: f64| (format!("{error}"), (error.log10() - low) / (high - low)));
    Bar { title: "relative error", ticks: ticks.to_vec(), colour }
}

/// Seconds for people.
pub(super) fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 100.0 => format!("{s:.1} s"),
        s if s < 3_600.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3_600.0),
    }
}
