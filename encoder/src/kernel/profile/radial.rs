//! Radially symmetric profiles of one channel, constant in rings, and their integrals in closed form.

use std::f64::consts::{FRAC_PI_4, PI};

use subsurf_decoder::kernel::layout::{RADII_MM, VARIANCES};

/// Share of the light that may leave beyond a kernel's radius; it is moved within.
const BEYOND: f64 = 1e-3;

/// R_d(r) of one channel in mm⁻², constant in rings and 0 beyond the last.
#[derive(Clone, Debug, PartialEq)]
pub struct Radial {
    /// Radii in mm between which rings lie, one more than there are rings; the first is 0, ascending.
    edges_mm: Vec<f64>,
    /// R_d of each ring in mm⁻².
    rd: Vec<f64>,
    /// How much R_d falls from each ring to the next: the profile as a sum of discs.
    falls: Vec<f64>,
}

impl Radial {
    /// Profile of rings between `edges_mm`, which ascend from 0, one more than values.
    pub(crate) fn new(edges_mm: Vec<f64>, rd: Vec<f64>) -> Self {
        let next = rd.iter().skip(1).chain([&0.0]);
        let falls = rd.iter().zip(next).map(|(rd, next)| rd - next).collect();
        Self { edges_mm, rd, falls }
    }

    /// Profile of which T(d), given as `tail`, is known: `rings` rings as far as `radius_mm`, narrow near 0.
    pub(crate) fn of_tail(radius_mm: f64, rings: u32, tail: impl Fn(f64) -> f64) -> Self {
        let edges: Vec<f64> = (0..=rings).map(|k| radius_mm * (f64::from(k) / f64::from(rings)).powi(2)).collect();
        let ring = |edges: &[f64]| {
            let area = PI * (edges[1] * edges[1] - edges[0] * edges[0]);
            (tail(edges[0]) - tail(edges[1])) / area
        };
        let rd = edges.windows(2).map(ring).collect();
        Self::new(edges, rd)
    }

    /// Radii between rings in mm, from 0 to [`Self::radius_mm`].
    #[must_use]
    pub fn edges_mm(&self) -> &[f64] {
        &self.edges_mm
    }

    /// R_d of the rings in mm⁻².
    #[must_use]
    pub fn rd(&self) -> &[f64] {
        &self.rd
    }

    /// R_d in mm⁻² at a distance.
    #[must_use]
    pub fn at(&self, r_mm: f64) -> f64 {
        let ring = self.edges_mm.partition_point(|edge| *edge <= r_mm);
        ring.checked_sub(1).and_then(|ring| self.rd.get(ring)).copied().unwrap_or(0.0)
    }

    /// Radius in mm beyond which there is nothing.
    #[must_use]
    pub fn radius_mm(&self) -> f64 {
        self.edges_mm[self.rd.len()]
    }

    /// Radii and values of the discs whose sum the profile is.
    pub(crate) fn discs(&self) -> impl Iterator<Item = (f64, f64)> + Clone {
        self.edges_mm[1..].iter().copied().zip(self.falls.iter().copied())
    }

    /// ‖R_d‖₁ = ∫ R_d 2πr dr, the diffuse reflectance.
    #[must_use]
    pub fn energy(&self) -> f64 {
        self.discs().map(|(r, fall)| fall * PI * r * r).sum()
    }

    /// ‖R_d‖₂² = ∫ R_d² 2πr dr in mm⁻².
    #[must_use]
    pub fn square(&self) -> f64 {
        let rings = self.edges_mm.windows(2).zip(&self.rd);
        rings.map(|(edges, rd)| rd * rd * PI * (edges[1] * edges[1] - edges[0] * edges[0])).sum()
    }

    /// Variance along an axis in mm²: ½ ∫ r² R_d 2πr dr / ‖R_d‖₁.
    #[must_use]
    pub fn variance_mm2(&self) -> f64 {
        self.discs().map(|(r, fall)| fall * FRAC_PI_4 * r.powi(4)).sum::<f64>() / self.energy()
    }

    /// T(d) = ∫_d^∞ R_d(u) 2πu du: what leaves farther than `d_mm` from where it entered.
    #[must_use]
    pub fn tail(&self, d_mm: f64) -> f64 {
        let rings = self.edges_mm.windows(2).zip(&self.rd).rev();
        let ring = |(edges, rd): (&[f64], &f64)| {
            let from = edges[0].max(d_mm);
            rd * PI * (edges[1] * edges[1] - from * from)
        };
        rings.take_while(|(edges, _)| edges[1] > d_mm).map(ring).sum()
    }

    /// Smallest radius in mm beyond which at most `share` of the light leaves.
    #[must_use]
    pub fn radius_of(&self, share: f64) -> f64 {
        let allowed = share * self.energy();
        let mut beyond = 0.0;
        for (edges, rd) in self.edges_mm.windows(2).zip(&self.rd).rev() {
            let [a, b] = [edges[0] * edges[0], edges[1] * edges[1]];
            let ring = rd * PI * (b - a);
            if beyond + ring > allowed {
                // π R_d (b − r²) is what may still be left out of this ring.
                return (b - (allowed - beyond) / (rd * PI)).max(a).sqrt();
            }
            beyond += ring;
        }
        0.0
    }

    /// a_p(x) = ∫ R_d(√(x² + y²)) dy, in mm⁻¹: chords of discs (eq. S.5).
    #[must_use]
    pub fn along_axis(&self, x_mm: f64) -> f64 {
        self.discs().map(|(r, fall)| fall * 2.0 * (r * r - x_mm * x_mm).max(0.0).sqrt()).sum()
    }

    /// ∫_0^x a_p in closed form, without unit: half-segments of discs.
    #[must_use]
    pub fn along_axis_to(&self, x_mm: f64) -> f64 {
        self.discs().map(|(r, fall)| fall * 2.0 * below_arc(r, x_mm.min(r))).sum()
    }

    /// ∫_0^x ∫_0^y R_d in closed form, without unit: quarters of discs within a rectangle.
    #[must_use]
    pub fn corner(&self, x_mm: f64, y_mm: f64) -> f64 {
        self.discs().map(|(r, fall)| fall * quarter_within(r, x_mm, y_mm)).sum()
    }

    /// The profile with all values times `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self::new(self.edges_mm.clone(), self.rd.iter().map(|rd| rd * factor).collect())
    }

    /// The profile within `radius_mm`, scaled so that its energy stays: what left beyond leaves within.
    #[must_use]
    pub fn cut(&self, radius_mm: f64) -> Self {
        let inside = self.edges_mm.iter().take_while(|edge| **edge < radius_mm).count();
        let mut edges: Vec<f64> = self.edges_mm[..inside].to_vec();
        edges.push(radius_mm.min(self.radius_mm()));
        let rd = self.rd[..edges.len() - 1].to_vec();
        let cut = Self::new(edges, rd);
        let factor = self.energy() / cut.energy();
        cut.scaled(factor)
    }

    /// The profile as far as it reaches but for a thousandth of its light; what was found and what is expected, where files of
    /// kernels have no such radius or variance.
    pub(crate) fn limited(&self) -> Result<Self, (String, String)> {
        let cut = self.cut(self.radius_of(BEYOND));
        let sizes = [("radius", "mm", cut.radius_mm(), RADII_MM), ("variance", "mm²", cut.variance_mm2(), VARIANCES)];
        for (name, unit, size, [least, most]) in sizes {
            if !(f64::from(least)..=f64::from(most)).contains(&size) {
                let expected = format!("{least:e} to {most:e} {unit}: are radii in mm?");
                return Err((format!("a {name} of {size:.3e} {unit}"), expected));
            }
        }
        Ok(cut)
    }

    /// The profile in fewer rings, each at least `growth` of its inner radius wide, of the same energies.
    #[must_use]
    pub fn condensed(&self, growth: f64) -> Self {
        let mut edges = vec![0.0];
        let mut rd = Vec::new();
        let mut energy = 0.0;
        for (ring, value) in self.edges_mm.windows(2).zip(&self.rd) {
            energy += value * PI * (ring[1] * ring[1] - ring[0] * ring[0]);
            let inner = edges[edges.len() - 1];
            // Radii are multiples of others, and hit this bound but for rounding.
            if ring[1] - inner >= growth * inner * (1.0 - 1e-9) || ring[1] >= self.radius_mm() {
                rd.push(energy / (PI * (ring[1] * ring[1] - inner * inner)));
                edges.push(ring[1]);
                energy = 0.0;
            }
        }
        Self::new(edges, rd)
    }
}

/// ∫_0^x √(r² − t²) dt, with x ≤ r.
fn below_arc(r: f64, x: f64) -> f64 {
    0.5 * (x * (r * r - x * x).max(0.0).sqrt() + r * r * (x / r).asin())
}

/// Area of a quarter disc of radius r within the rectangle from 0 to (x, y).
fn quarter_within(r: f64, x: f64, y: f64) -> f64 {
    let (x, y) = (x.min(r), y.min(r));
    if x * x + y * y <= r * r {
        return x * y;
    }
    // Up to x₀ the rectangle's top is below the arc, from there on the arc is below it.
    let x0 = (r * r - y * y).max(0.0).sqrt();
    x0 * y + below_arc(r, x) - below_arc(r, x0)
}
