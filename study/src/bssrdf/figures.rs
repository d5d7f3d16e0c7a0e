//! Charts and ratio maps of the page.

use std::fmt::Write as _;

use plotters::chart::SeriesLabelPosition;

use super::record::Record;
use super::results::Results;
use crate::page::colour::grey;
use crate::page::panel::{Bar, Row, panel};
use crate::page::plots::{Axis, Scale, Series, chart, widened};

/// Charts of error against K, and of quality against size.
pub(super) fn charts(study: &Results<'_>, out: &mut String) -> anyhow::Result<()> {
    out.push_str("<h2>Curves</h2><div class=\"charts\">");
    let halves = study.halves();
    for &(noisy, with) in &halves {
        let series: Vec<Series> = study
            .materials
            .iter()
            .map(|material| {
                let record = |k: u32| study.find(material, noisy, &format!("k{k}"));
                let points = [1, 2, 3, 5].into_iter().filter_map(|k| Some((f64::from(k), record(k)?.relative_error)));
                // Nothing stands at 0 on a logarithmic axis.
                let points = points.filter(|point| point.1 > 0.0);
                Series { title: material.clone(), points: points.collect(), joined: true }
            })
            .collect();
        let y = widened(series.iter().flat_map(|series| &series.points).map(|point| point.1));
        let title = format!("Error against K, captures {with}");
        let x = Axis { title: "K", range: 0.5..5.5, scale: Scale::Whole };
        let y = Axis { title: "mean relative error of the albedo", range: y, scale: Scale::Logarithmic };
        out.push_str(&chart(&title, &x, &y, &series, &SeriesLabelPosition::UpperRight)?);
    }
    for (material, (noisy, with)) in study.materials.iter().flat_map(|m| halves.iter().map(move |half| (m, *half))) {
        let points = |labels: &[&str]| -> Vec<(f64, f64)> {
            let records = labels.iter().filter_map(|label| study.find(material, noisy, label));
            #[allow(clippy::cast_precision_loss, reason = "a place in a chart")]
            let point =
                |record: &Record| Some((record.bytes as f64 / 1e3, record.psnr_db[0].filter(|db| db.is_finite())?));
            records.filter_map(point).collect()
        };
        let series =
            |title: &str, labels: &[&str], joined| Series { title: title.to_owned(), points: points(labels), joined };
        let mut all = vec![
            series("K = 1, 2, 3, 5; M = 128", &["k1", "k2", "k3", "k5"], true),
            series("K = 2; M = 8, 32, 128", &["k2-m8", "k2-m32", "k2"], true),
            series("K = 2; 16, 24 bits, f16", &["k2-palette", "k2-small", "k2-half"], false),
            series("K = 1, equal bytes", &["k1-equal"], false),
            series("LSP clusters", &["clusters-equal"], false),
            series("paper's fit", &["paper-k1", "paper-k2", "paper-k3", "paper-k5"], false),
            series("Song et al.", &["song"], false),
        ];
        all.retain(|series| !series.points.is_empty());
        if all.is_empty() {
            continue;
        }
        let every = || all.iter().flat_map(|series| &series.points);
        let x = widened(every().map(|point| point.0));
        let y = every().map(|point| point.1).fold(f64::INFINITY, f64::min) - 4.0
            ..every().map(|point| point.1).fold(0.0, f64::max) + 4.0;
        let title = format!("Quality against size: {material}, {with}");
        let x = Axis { title: "kB", range: x, scale: Scale::Logarithmic };
        let y = Axis { title: "PSNR, uniform light (dB)", range: y, scale: Scale::Linear };
        out.push_str(&chart(&title, &x, &y, &all, &SeriesLabelPosition::LowerRight)?);
    }
    out.push_str("</div>");
    Ok(())
}

/// Chart and maps of the mixture ratios of K = 3 and 5, in falling order.
pub(super) fn ratios(study: &Results<'_>, out: &mut String) -> anyhow::Result<()> {
    out.push_str("<h2>Mixture ratios, sorted (their figure 4)</h2><div class=\"charts\">");
    for k in [3, 5] {
        let series: Vec<Series> = study
            .materials
            .iter()
            .filter_map(|material| {
                let record = study.find(material, false, &format!("k{k}"))?;
                let points = (1..).zip(&record.sorted_ratios).map(|(rank, t)| (f64::from(rank), *t));
                Some(Series { title: material.clone(), points: points.collect(), joined: true })
            })
            .collect();
        let title = format!("Mean of the ratios by rank, K = {k}");
        let x = Axis { title: "rank", range: 0.5..5.5, scale: Scale::Whole };
        let y = Axis { title: "mean mixture ratio", range: 0.0..1.0, scale: Scale::Linear };
        out.push_str(&chart(&title, &x, &y, &series, &SeriesLabelPosition::UpperRight)?);
    }
    out.push_str("</div>");
    let ticks = ["0", "0.5", "1"].map(str::to_owned).into_iter().zip([0.0, 0.5, 1.0]).collect();
    #[allow(clippy::cast_possible_truncation, reason = "a shade")]
    let bar = Bar { title: "mixture ratio", ticks, colour: |place| grey(place as f32) };
    let maps: Vec<(u32, u32)> = [3, 5].into_iter().flat_map(|k| (1..=k).map(move |rank| (k, rank))).collect();
    let columns: Vec<String> = maps.iter().map(|(k, rank)| format!("K = {k}, #{rank}")).collect();
    let rows: Vec<Row> = study
        .materials
        .iter()
        .map(|material| {
            let picture =
                |(k, rank): &(u32, u32)| study.picture(material, false, &format!("k{k}"), &format!("ratio{rank}"));
            Row { title: material.clone(), pictures: maps.iter().map(picture).collect() }
        })
        .collect();
    let _ = write!(out, "<div class=\"wide\">{}</div>", panel(&columns, &rows, study.mm(), Some(&bar)));
    Ok(())
}
