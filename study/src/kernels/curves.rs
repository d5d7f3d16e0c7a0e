//! Charts of profiles: by distance, linear and logarithmic, by mean free paths, and beside models in closed form.

use plotters::prelude::SeriesLabelPosition;
use subsurf_encoder::kernel::Profile;
use subsurf_encoder::kernel::profile::Radial;
use subsurf_encoder::simulate::diffusion::Medium;

use crate::page::plots::{Axis, Scale, Series, chart};

const CHANNELS: [&str; 3] = ["red", "green", "blue"];
/// Share of the light beyond the linear chart.
const BEYOND: f64 = 0.03;
/// Decades of the logarithmic charts.
const DECADES: f64 = 1e-6;
/// Mean free paths that are shown.
const PATHS: f64 = 24.0;
/// Mean free paths from where on logarithmic charts of R_d begin: its peak, as high as the innermost ring is narrow, would take all
/// decades.
const NEAREST: f64 = 0.1;

/// Charts of a material, as SVG.
pub(super) fn charts(name: &str, profile: &Profile) -> anyhow::Result<String> {
    let medium = Medium::measured(name).expect("names are those of the list");
    let weighted = |r: f64, rd: f64| std::f64::consts::TAU * r * rd;
    let of = |radial: &Radial, [start, end]: [f64; 2], value: &dyn Fn(f64, f64) -> f64, unit: f64| -> Vec<(f64, f64)> {
        let rings = radial.edges_mm().windows(2).zip(radial.rd());
        let points = rings.map(|(edges, rd)| (0.5 * (edges[0] + edges[1]), *rd));
        points
            .filter(|(r, rd)| (start..=end).contains(r) && *rd > 0.0)
            .map(|(r, rd)| (r / unit, value(r, rd)))
            .collect()
    };
    let channels = |end: f64, value: &dyn Fn(f64, f64) -> f64, paths: bool| -> Vec<Series> {
        let series = |c: usize| {
            let unit = if paths { medium.mean_free_path_mm(c) } else { 1.0 };
            let range = if paths { [NEAREST * unit, end * unit] } else { [0.0, end] };
            Series { title: CHANNELS[c].to_owned(), points: of(&profile.channels[c], range, value, unit), joined: true }
        };
        // The legend's colours go by the order: blue, red, green.
        [2, 0, 1].map(series).into()
    };
    let end = profile.channels.iter().map(|radial| radial.radius_of(BEYOND)).fold(0.0, f64::max);
    let far = profile.channels.iter().map(|radial| radial.radius_of(1e-3)).fold(0.0, f64::max);
    let mut out = String::new();
    let linear = channels(end, &weighted, false);
    let title = format!("{name}: 2πr R_d(r)");
    let y = Axis { title: "mm⁻¹", range: 0.0..1.05 * largest(&linear), scale: Scale::Linear };
    out.push_str(&chart(&title, &axis("r (mm)", end), &y, &linear, &SeriesLabelPosition::UpperRight)?);
    let logarithmic = channels(far, &weighted, false);
    let y = decades("mm⁻¹", &logarithmic);
    out.push_str(&chart(&title, &axis("r (mm)", far), &y, &logarithmic, &SeriesLabelPosition::UpperRight)?);
    let paths = channels(PATHS, &|_, rd| rd, true);
    let title = format!("{name}: R_d(r) by mean free paths");
    let y = decades("mm⁻²", &paths);
    out.push_str(&chart(&title, &axis("r / MFP", PATHS), &y, &paths, &SeriesLabelPosition::UpperRight)?);
    // Green beside models.
    let dipole = Profile::dipole(&medium, Medium::measured_eta(name))?;
    let burley = Profile::normalised_diffusion(profile.reflectance(), &medium)?;
    let range = [NEAREST, PATHS].map(|paths| paths * medium.mean_free_path_mm(1));
    let series = [("Monte Carlo", profile), ("dipole", &dipole), ("Burley", &burley)].map(|(title, profile)| Series {
        title: title.to_owned(),
        points: of(&profile.channels[1], range, &|_, rd| rd, medium.mean_free_path_mm(1)),
        joined: true,
    });
    let title = format!("{name}: R_d(r) of green beside models");
    let y = decades("mm⁻²", &series);
    out.push_str(&chart(&title, &axis("r / MFP", PATHS), &y, &series, &SeriesLabelPosition::UpperRight)?);
    Ok(out)
}

fn axis(title: &'static str, end: f64) -> Axis {
    Axis { title, range: 0.0..end, scale: Scale::Linear }
}

/// Logarithmic axis from the largest value down.
fn decades(title: &'static str, series: &[Series]) -> Axis {
    let top = 2.0 * largest(series);
    Axis { title, range: DECADES * top..top, scale: Scale::Logarithmic }
}

fn largest(series: &[Series]) -> f64 {
    series.iter().flat_map(|series| &series.points).map(|point| point.1).fold(1e-30, f64::max)
}
