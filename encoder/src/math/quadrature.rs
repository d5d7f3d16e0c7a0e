//! Numerical integration: Gauss and Legendre's rule, also towards a singular end, and the exponential integral.

use std::f64::consts::PI;

/// Nodes and weights of a rule on −1 .. 1.
pub(crate) struct Gauss {
    nodes: Vec<f64>,
    weights: Vec<f64>,
}

/// Length at which pieces towards a singularity end: that of a logarithm is integrated to 10⁻⁷ of this there.
const SHORTEST: f64 = 1e-6;

impl Gauss {
    /// The rule of `n` nodes, exact for polynomials below degree 2 n.
    pub(crate) fn new(n: u32) -> Self {
        let node = |k: u32| {
            // Roots of the Legendre polynomial P_n, by Newton's method.
            let mut x = (PI * (f64::from(k) + 0.75) / (f64::from(n) + 0.5)).cos();
            let mut slope = 0.0;
            for _ in 0..20 {
                let (mut p, mut before) = (x, 1.0);
                for j in 2..=n {
                    let j = f64::from(j);
                    (p, before) = (((2.0 * j - 1.0) * x * p - (j - 1.0) * before) / j, p);
                }
                slope = f64::from(n) * (before - x * p) / (1.0 - x * x);
                x -= p / slope;
            }
            (x, 2.0 / ((1.0 - x * x) * slope * slope))
        };
        let (nodes, weights) = (0..n).rev().map(node).unzip();
        Self { nodes, weights }
    }

    /// Nodes within `a` .. `b`, with their weights.
    pub(crate) fn over(&self, a: f64, b: f64) -> impl Iterator<Item = (f64, f64)> {
        let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
        self.nodes.iter().zip(&self.weights).map(move |(x, w)| (middle + half * x, half * w))
    }

    /// Nodes and weights for an integrand over `a` .. `b` with a logarithmic singularity at `at`, in pieces that shrink towards it.
    pub(crate) fn towards(&self, at: f64, a: f64, b: f64, visit: &mut impl FnMut(f64, f64)) {
        if a < at && at < b {
            self.towards(at, a, at, visit);
            self.towards(at, at, b, visit);
            return;
        }
        let (near, mut far) = if at <= a { (a, b) } else { (b, a) };
        loop {
            let length = (far - near).abs();
            let last = length <= SHORTEST.max(3.0 * (near - at).abs());
            let cut = if last { near } else { near + 0.25 * (far - near) };
            self.over(cut.min(far), cut.max(far)).for_each(|(x, w)| visit(x, w));
            if last {
                break;
            }
            far = cut;
        }
    }
}

/// Exponential integral E₁(x) = ∫ from x to ∞ of e^−t / t dt, of x > 0 (Abramowitz and Stegun, 5.1.11 and 5.1.22).
pub(crate) fn e1(x: f64) -> f64 {
    const EULER: f64 = 0.577_215_664_901_532_9;
    if x < 1.0 {
        let (mut sum, mut term) = (-EULER - x.ln(), -1.0);
        for k in 1..20 {
            let k = f64::from(k);
            term *= -x / k;
            sum += term / k;
        }
        return sum;
    }
    // e^−x / (x + 1 − 1 / (x + 3 − 4 / (x + 5 − ..))), from inside.
    let mut fraction = 0.0;
    for k in (1..40).rev() {
        let k = f64::from(k);
        fraction = k * k / (x + 2.0 * k + 1.0 - fraction);
    }
    (-x).exp() / (x + 1.0 - fraction)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integrals_are_those_of_tables() {
        // Abramowitz and Stegun, tables 5.1 and 5.2.
        for (x, printed) in [
            (0.1, 1.822_923_958),
            (0.5, 0.559_773_595),
            (1.0, 0.219_383_934),
            (2.0, 0.048_900_511),
            (10.0, 4.156_969e-6),
        ] {
            assert!((e1(x) / printed - 1.0).abs() < 1e-7, "E1({x}) = {}, {printed} in print", e1(x));
        }
        let gauss = Gauss::new(8);
        let power: f64 = gauss.over(0.0, 2.0).map(|(x, w)| w * x.powi(15)).sum();
        assert!((power - 4096.0).abs() < 1e-8, "∫ x¹⁵ = {power}");
        // ∫ ln |x − 0.3| over 0 .. 1.
        let mut sum = 0.0;
        gauss.towards(0.3, 0.0, 1.0, &mut |x, w| sum += w * (x - 0.3).abs().ln());
        let exact = 0.3 * 0.3_f64.ln() + 0.7 * 0.7_f64.ln() - 1.0;
        assert!((sum - exact).abs() < 1e-7, "{sum}, not {exact}");
    }
}
