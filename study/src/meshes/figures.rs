//! Charts of the page.

use plotters::chart::SeriesLabelPosition;
use subsurf_encoder::transfer::Size;

use super::published::{TEAPOT, TEAPOT_HARMONICS};
use super::record::{Interpolation, Kind, Measured, Record};
use crate::page::plots::{Axis, Scale, Series, chart, widened};

/// e_rms of the worst view.
const Y: &str = "e_rms of the worst view";
/// Factors of axes that make room for legends.
const BESIDE: f64 = 2.0;
const BELOW: f64 = 60.0;

/// Errors by the number of lights, of all meshes (their Figure 5): one chart for each interpolation, with the same axes.
pub(super) fn lights(records: &[(String, Record)]) -> anyhow::Result<String> {
    let of = |value: fn(&Interpolation) -> f64| -> Vec<Series> {
        let series = |(name, record): &(String, Record)| Series {
            title: name.clone(),
            points: record.interpolations.iter().map(|of| (of.lights as f64, value(of))).collect(),
            joined: true,
        };
        records.iter().map(series).collect()
    };
    let charts =
        [("Four nearest lights", of(|of| of.four_nearest.max)), ("Radial basis functions", of(|of| of.radial.max))];
    let points = || charts.iter().flat_map(|(_, series)| series).flat_map(|series| &series.points);
    let [mut x, y] = [widened(points().map(|point| point.0)), widened(points().map(|point| point.1))];
    x.end *= BESIDE;
    let mut out = String::new();
    for (title, series) in &charts {
        let x = Axis { title: "lights", range: x.clone(), scale: Scale::Logarithmic };
        let y = Axis { title: Y, range: y.clone(), scale: Scale::Logarithmic };
        out.push_str(&chart(title, &x, &y, series, &SeriesLabelPosition::UpperRight)?);
    }
    Ok(out)
}

/// Errors by bytes, and by the number of reference points (their Figure 9), of one mesh.
pub(super) fn schemes(name: &str, record: &Record) -> anyhow::Result<String> {
    let points = |x: &dyn Fn(&Measured) -> Option<f64>| -> Vec<(f64, f64)> {
        record.schemes.iter().filter_map(|of| Some((x(of)?, of.compression.max))).collect()
    };
    let series = |title: &str, joined, x: &dyn Fn(&Measured) -> Option<f64>| {
        let mut points = points(x);
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        Series { title: title.to_owned(), points, joined }
    };
    let by_bytes = |title: &str, is_of: &dyn Fn(Kind) -> bool| {
        series(title, true, &|of: &Measured| is_of(of.kind).then_some(of.bytes))
    };
    let default = Size::of_vertices(record.vertices);
    let has_default_components = |kind: Kind| match kind {
        Kind::Clusters { clusters, components, bits } => {
            clusters > 1 && [components, bits] == [default.components, default.bits]
        }
        _ => false,
    };
    let has_default_clusters =
        |kind: Kind| matches!(kind, Kind::Clusters { clusters, .. } if clusters == default.clusters);
    let theirs =
        |title: &str, points: &[(f64, f64)]| Series { title: title.to_owned(), points: points.into(), joined: false };
    let by_points = |order: usize| {
        let title = format!("{} functions", order * order);
        series(&title, true, &move |of: &Measured| match of.kind {
            Kind::ReferencePoints { points, order: found } if found == order => Some(points as f64),
            _ => None,
        })
    };
    let is_points = |kind: Kind, wanted: usize| matches!(kind, Kind::ReferencePoints { order, .. } if order == wanted);
    let size = [
        by_bytes("ours: clusters", &has_default_components),
        by_bytes("reference points, 9 functions", &|kind| is_points(kind, 3)),
        by_bytes("ours: components", &has_default_clusters),
        by_bytes("reference points, 36 functions", &|kind| is_points(kind, 6)),
        by_bytes("one PCA", &|kind| matches!(kind, Kind::Clusters { clusters: 1, .. })),
        by_bytes("spherical harmonics", &|kind| matches!(kind, Kind::Harmonics { .. })),
        by_bytes("a byte for each light", &|kind| kind == Kind::Lloyd),
        theirs("their teapot, harmonics", &TEAPOT_HARMONICS),
    ];
    let number = [by_points(3), by_points(6), theirs("their teapot, 9 functions", &TEAPOT)];
    let mut out = String::new();
    for (what, title, series, legend, below) in [
        ("error by size", "bytes per vertex, all counted", &size[..], SeriesLabelPosition::LowerLeft, BELOW),
        ("error by reference points", "reference points", &number, SeriesLabelPosition::UpperRight, 1.0),
    ] {
        let every = || series.iter().flat_map(|series| &series.points);
        let x = Axis { title, range: widened(every().map(|point| point.0)), scale: Scale::Logarithmic };
        let y = widened(every().map(|point| point.1));
        let y = Axis { title: Y, range: y.start / below..y.end, scale: Scale::Logarithmic };
        out.push_str(&chart(&format!("{name}: {what}"), &x, &y, series, &legend)?);
    }
    Ok(out)
}
