//! Profiles of points between which R_d falls exponentially.

use std::f64::consts::TAU;

use super::Radial;

/// Width of rings by their outer radius.
const WIDTH: f64 = 0.04;
/// Rings between two points, at least.
const LEAST: f64 = 4.0;
/// Rings between two points, at most.
const MOST: f64 = 400.0;
/// Places at which a ring is sampled.
const PLACES: u32 = 8;

/// Rings of points (r in mm, R_d in mm⁻²) of ascending radii: constant up to the first, nothing beyond the last.
pub(super) fn rings(points: &[(f64, f64)]) -> Radial {
    let (first, rd) = points[0];
    let mut edges = vec![0.0];
    let mut values = Vec::new();
    if first > 0.0 {
        edges.push(first);
        values.push(rd);
    }
    for pair in points.windows(2) {
        let ((from, a), (to, b)) = (pair[0], pair[1]);
        let between = |r: f64| {
            let w = (r - from) / (to - from);
            // Equal factors for equal distances; straight where one of them is 0.
            if a > 0.0 && b > 0.0 { a * (b / a).powf(w) } else { a + w * (b - a) }
        };
        let rings = ((to - from) / (WIDTH * to)).ceil().clamp(LEAST, MOST);
        let mut ring = 0.0;
        while ring < rings {
            let [inner, outer] = [ring, ring + 1.0].map(|k| from + (to - from) * (k / rings));
            // ∫ R_d 2πr dr by its middles, over the area they have.
            let width = (outer - inner) / f64::from(PLACES);
            let middles = (0..PLACES).map(|k| inner + (f64::from(k) + 0.5) * width);
            let (energy, area) = middles
                .fold((0.0, 0.0), |(energy, area), r| (energy + between(r) * TAU * r * width, area + TAU * r * width));
            edges.push(outer);
            values.push(energy / area);
            ring += 1.0;
        }
    }
    Radial::new(edges, values)
}
