//! The study as one HTML page that needs nothing beside it.

use std::fmt::Write as _;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use subsurf_viewer::human;

use super::codec::Codec;
use super::published::published;
use super::record::{PICTURED, Record, picture_path, size};
use super::shared::Shared;
use crate::page::{CSS, duration, mark, other, table};

/// Results of the study, all that its page is made from.
pub(super) struct Results<'a> {
    pub(super) folder: &'a Path,
    pub(super) materials: &'a [&'a str],
    pub(super) records: &'a [Record],
    pub(super) shared: &'a [Shared],
    /// Pixels of the images in x and in y.
    pub(super) side: u32,
    /// Every so many pairs of directions are judged.
    pub(super) every: usize,
}

const NONE: &str = "\u{2013}";
/// Codebooks as their table 3 has them.
const BOOKS: [&str; 8] = ["P1", "P2", "C", "I1", "I2", "M", "P3", "P4"];

impl Results<'_> {
    fn find(&self, material: &str, codec: Codec) -> Option<&Record> {
        self.records.iter().find(|record| record.material == material && record.label == codec.label())
    }

    pub(super) fn html(&self) -> String {
        let mut out = String::from(
            "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>subsurf study of BTFs</title>",
        );
        let _ = write!(out, "<style>{}</style><body>", CSS);
        self.introduction(&mut out);
        out.push_str("<h2>What is claimed, and whether it holds here</h2>");
        out.push_str(&self.claims());
        out.push_str("<h2>Ratios, similarity and times (their table 2)</h2>");
        out.push_str(&self.rates());
        out.push_str("<h2>Several materials in one file, nested (their C.R.⁵)</h2>");
        out.push_str(&sharing(self.shared));
        out.push_str("<h2>Codebooks: vectors that an entry stands for (their table 3)</h2>");
        out.push_str(&self.books());
        out.push_str("<h2>Evaluations in a second on one core, texel, light and view at random</h2>");
        out.push_str(&self.speeds());
        out.push_str("<h2>Pictures</h2>");
        for material in self.materials {
            self.pictures(material, &mut out);
        }
        out.push_str("</body></html>\n");
        out
    }

    fn introduction(&self, out: &mut String) {
        let side = self.side;
        let pairs = match self.every {
            1 => "all 6,561 pairs of directions".to_owned(),
            every => format!("every {every}th of 6,561 pairs of directions"),
        };
        let _ = write!(
            out,
            "<h1>Bidirectional texture functions in few bytes: a study</h1><p class=\"note\">Tables 2 and 3 of Havran, Filip \
             and Myszkowski 2010 on <b>simulated</b> materials: ray-traced reliefs of {side} × {side} texels, 81 × 81 \
             directions, 8-bit sRGB. Simulated images have no noise and no errors of registration: all codecs, and low-rank \
             ones most, look better than on measured ones. MSSIM is the mean structural similarity of Y, Cr and Cb over {pairs}; \
             ratios are to the bytes of all images.</p><p class=\"note\">\u{201c}The paper's encoder\u{201d} is its pruning \
             vector quantiser with three steps of sampling, implemented here; its thresholds, which the paper leaves open, give \
             its ratios. Baselines work on whole apparent BRDFs in the coordinates and weights that our own codecs use, in 8 \
             bits, with as many words or components as fit into the bytes named; PCA and local PCA (the best of 2, 3, 4 and 6 \
             clusters) are spared the loss of resampling. Files of factors take 1 to 4 MB once they are \
             expanded.</p><p class=\"note\">{}</p>",
            other(
                "Rows like this are numbers from the paper, of its measured materials of 256 × 256 texels on its machine: \
                 another data set, for orientation."
            ),
        );
    }

    fn claims(&self) -> String {
        let titles = [
            "",
            "nested has more luma MSSIM than the paper's encoder, at no more than half its bytes",
            "nested: mean MSSIM ≥ 0.80 at 1:764 or smaller",
            "factored: mean MSSIM ≥ 0.90 at 1:1000",
            "nested beats one-level VQ",
            "factored beats one-level VQ",
            "factored beats PCA",
            "factored beats local PCA",
        ];
        let row = |material: &&str| {
            let find = |codec| self.find(material, codec);
            let claim =
                |holds: Option<(bool, String)>| holds.map_or(NONE.to_owned(), |(holds, what)| mark(holds, &what));
            let above = |first: Codec, second: Codec| {
                let (a, b) = (find(first)?.mean_mssim(), find(second)?.mean_mssim());
                Some((a > b, format!("{a:.3} : {b:.3}")))
            };
            let paper = find(Codec::NestedAsHavran2010).zip(find(Codec::Havran2010)).map(|(nested, paper)| {
                let holds = nested.mssim[0] > paper.mssim[0] && 2 * nested.bytes <= paper.bytes;
                let (a, b) = (nested.mssim[0], paper.mssim[0]);
                (holds, format!("{a:.3} : {b:.3}, {} : {}", human(nested.bytes), human(paper.bytes)))
            });
            let at = |codec: Codec, least: f64, ratio: u64| {
                find(codec).map(|record| {
                    let holds = record.mean_mssim() >= least && ratio * record.bytes <= record.raw_bytes;
                    (holds, format!("{:.3} at 1:{}", record.mean_mssim(), record.raw_bytes / record.bytes.max(1)))
                })
            };
            vec![
                (*material).to_owned(),
                claim(paper),
                claim(at(Codec::Nested, 0.80, 764)),
                claim(at(Codec::Factored, 0.90, 1000)),
                claim(above(Codec::Nested, Codec::OneLevelAsNested)),
                claim(above(Codec::Factored, Codec::OneLevelAsFactored)),
                claim(above(Codec::Factored, Codec::Pca)),
                claim(above(Codec::Factored, Codec::LocalPca)),
            ]
        };
        let mut out = table(&titles.map(str::to_owned), &self.materials.iter().map(row).collect::<Vec<_>>());
        let factored: Vec<f64> =
            self.materials.iter().filter_map(|name| Some(self.find(name, Codec::Factored)?.mean_mssim())).collect();
        #[allow(clippy::cast_precision_loss, reason = "five")]
        let mean = factored.iter().sum::<f64>() / factored.len().max(1) as f64;
        let _ = write!(out, "<p>Mean MSSIM of factored over all materials: {mean:.4}.</p>");
        out
    }

    fn rates(&self) -> String {
        let titles = ["", "bytes", "Y", "Cr", "Cb", "mean", "PSNR (dB)", "time"].map(str::to_owned);
        let mut rows = Vec::new();
        for material in self.materials {
            for codec in Codec::ALL {
                let Some(record) = self.find(material, codec) else { continue };
                let mut row = vec![format!("{material}: {}", codec.title()), size(record.bytes, record.raw_bytes)];
                row.extend(record.mssim.iter().map(|value| format!("{value:.4}")));
                row.extend([
                    format!("{:.4}", record.mean_mssim()),
                    format!("{:.1}", record.psnr_db),
                    duration(record.seconds),
                ]);
                rows.push(row);
            }
            if let Some(theirs) = published(material) {
                let [own, pca, local] = theirs.mssim;
                let mut row = vec![other(&format!("their {}", theirs.name))];
                let size = format!("{} bytes, {}", theirs.bytes, theirs.ratio);
                row.extend([size, NONE.into(), NONE.into(), NONE.into()].map(|cell: String| other(&cell)));
                row.push(other(&format!("{own}; PCA {pca}, local PCA {local}")));
                row.extend([other(NONE), other(&format!("{} h", theirs.time))]);
                rows.push(row);
            }
        }
        table(&titles, &rows)
    }

    fn books(&self) -> String {
        let titles: Vec<String> = ["", "ratio"].into_iter().chain(BOOKS).map(str::to_owned).collect();
        let mut rows = Vec::new();
        for material in self.materials {
            for codec in [Codec::Nested, Codec::Havran2010] {
                let Some(record) = self.find(material, codec) else { continue };
                let book = |name: &&str| {
                    let found = record.books.iter().find(|(of, ..)| of == name);
                    found.map_or(NONE.to_owned(), |(_, entries, vectors)| {
                        format!("{} ({entries})", vectors / u64::from(*entries).max(1))
                    })
                };
                let first = [format!("{material}: {}", codec.title()), size(record.bytes, record.raw_bytes)];
                rows.push(first.into_iter().chain(BOOKS.iter().map(book)).collect());
            }
            if let Some(theirs) = published(material) {
                let first = [format!("their {}", theirs.name), theirs.ratio.to_owned()];
                let all = first.into_iter().chain(theirs.books.map(str::to_owned));
                rows.push(all.map(|cell| other(&cell)).collect());
            }
        }
        let note = "<p class=\"note\">Vectors to an entry, and entries in brackets.</p>";
        table(&titles, &rows) + note
    }

    fn speeds(&self) -> String {
        let titles = ["", "nested", "factored (expanded)"].map(str::to_owned);
        let rate = |material: &str, codec| {
            let rate = self.find(material, codec).and_then(|record| record.evaluations);
            rate.map_or(NONE.to_owned(), |rate| format!("{:.2} M", rate / 1e6))
        };
        let row = |material: &&str| {
            vec![(*material).to_owned(), rate(material, Codec::Nested), rate(material, Codec::Factored)]
        };
        let mut rows: Vec<Vec<String>> = self.materials.iter().map(row).collect();
        rows.push(vec![other("theirs"), other("0.31\u{2013}1.36 M"), other(NONE)]);
        table(&titles, &rows)
    }

    fn pictures(&self, material: &str, out: &mut String) {
        let _ = write!(out, "<h3>{material}</h3><div class=\"wide\">");
        let shown: Vec<(&str, &str)> = std::iter::once(("original", "original"))
            .chain(Codec::ALL.iter().map(|codec| (codec.label(), codec.title())))
            .collect();
        let titles: Vec<String> = shown.iter().map(|(_, title)| (*title).to_owned()).collect();
        let picture = |label: &str, number: usize| {
            let path = picture_path(self.folder, material, label, number);
            std::fs::read(path).map_or(NONE.to_owned(), |png| {
                format!("<img width=\"150\" alt=\"{label}\" src=\"data:image/png;base64,{}\">", STANDARD.encode(png))
            })
        };
        let rows: Vec<Vec<String>> =
            (0..PICTURED.len()).map(|number| shown.iter().map(|(label, _)| picture(label, number)).collect()).collect();
        out.push_str(&table(&titles, &rows));
        out.push_str("</div>");
    }

    /// Everything, a row for each material and codec.
    pub(super) fn csv(&self) -> String {
        let mut out = String::from(
            "material,codec,bytes,raw_bytes,mssim_y,mssim_cr,mssim_cb,psnr_db,seconds,evaluations_per_second\n",
        );
        for record in self.records {
            let Record { material, label, bytes, raw_bytes, mssim: [y, cr, cb], psnr_db, seconds, evaluations, .. } =
                record;
            let rate = evaluations.map_or(String::new(), |rate| format!("{rate:.0}"));
            let _ = writeln!(
                out,
                "{material},{label},{bytes},{raw_bytes},{y:.5},{cr:.5},{cb:.5},{psnr_db:.3},{seconds:.1},{rate}"
            );
        }
        out
    }
}

fn sharing(shared: &[Shared]) -> String {
    let row = |shared: &Shared| {
        let ((apart, of_apart), (together, of_together)) = (shared.apart, shared.together);
        #[allow(clippy::cast_precision_loss, reason = "a percentage")]
        let saved = 100.0 * (1.0 - together as f64 / apart.max(1) as f64);
        let said = if saved < 0.0 { format!("{:.0} % more", -saved) } else { format!("{saved:.0} % less") };
        vec![
            shared.title.clone(),
            format!("{}, {of_apart:.4}", human(apart)),
            format!("{}, {of_together:.4}", human(together)),
            shared.p4.to_string(),
            mark(saved >= 14.0 && of_together >= of_apart, &said),
        ]
    };
    let mut rows: Vec<Vec<String>> = shared.iter().map(row).collect();
    rows.push(vec![other("theirs, 13 LDR materials"), other(NONE), other(NONE), other(NONE), other("14 % less")]);
    let titles =
        ["", "files apart, mean MSSIM of every 61st pair", "one file", "its P4", "saved at no less similarity"];
    table(&titles.map(str::to_owned), &rows)
}
