//! Seeded gradient noise on a torus (Perlin 2002, *Improving noise*).

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// Noise that repeats after one unit in u and in v.
pub(crate) struct Noise {
    permutation: [u8; 256],
}

/// Where a position lies among scattered points; distances in lattice cells.
pub(crate) struct Cell {
    /// Distance from the nearest point.
    pub(crate) distance: f64,
    /// How much farther the second nearest is; 0 on a border.
    pub(crate) border: f64,
    /// Number of the nearest point.
    pub(crate) number: i64,
}

impl Noise {
    pub(crate) fn new(seed: u64) -> Self {
        let mut rng = Pcg64::seed_from_u64(seed);
        let mut permutation: [u8; 256] = std::array::from_fn(|k| u8::try_from(k).expect("k < 256"));
        // Fisher-Yates.
        for k in (1..256).rev() {
            permutation.swap(k, rng.random_range(0..=k));
        }
        Self { permutation }
    }

    /// A random number in 0 .. 1 that belongs to an integer.
    pub(crate) fn value(&self, k: i64) -> f64 {
        f64::from(self.hash(k, 7)) / 256.0
    }

    fn hash(&self, x: i64, y: i64) -> u8 {
        let byte = |value: i64| usize::try_from(value.rem_euclid(256)).expect("0 ≤ value < 256");
        let row = self.permutation[byte(x)];
        self.permutation[byte(i64::from(row) + y)]
    }

    /// One octave with `frequency` lattice cells per unit, about −0.7 to 0.7.
    fn octave(&self, u: f64, v: f64, frequency: i64) -> f64 {
        #[allow(clippy::cast_precision_loss, reason = "frequencies are small")]
        let cells = frequency as f64;
        let (x, y) = (u * cells, v * cells);
        #[allow(clippy::cast_possible_truncation, reason = "lattice coordinates are small")]
        let (i, j) = (x.floor() as i64, y.floor() as i64);
        let (x, y) = (x - x.floor(), y - y.floor());
        let corner = |di: i64, dj: i64| {
            let hash = self.hash((i + di).rem_euclid(frequency), (j + dj).rem_euclid(frequency));
            let angle = f64::from(hash) / 256.0 * std::f64::consts::TAU;
            #[allow(clippy::cast_precision_loss, reason = "0 or 1")]
            let (dx, dy) = (x - di as f64, y - dj as f64);
            angle.cos() * dx + angle.sin() * dy
        };
        let fade = |t: f64| t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
        let lerp = |a: f64, b: f64, t: f64| a + t * (b - a);
        let top = lerp(corner(0, 0), corner(1, 0), fade(x));
        let bottom = lerp(corner(0, 1), corner(1, 1), fade(x));
        lerp(top, bottom, fade(y))
    }

    /// `octaves` octaves from `frequency` up, each half as strong as the one before; about −1 to 1.
    pub(crate) fn fractal(&self, u: f64, v: f64, frequency: i64, octaves: i32) -> f64 {
        (0..octaves).map(|k| self.octave(u, v, frequency << k) * 0.5_f64.powi(k)).sum()
    }

    /// Cells around scattered points (Worley 1996, *A cellular texture basis function*), one point to a lattice cell;
    /// `frequency` lattice cells per unit in u and in v.
    pub(crate) fn cell(&self, u: f64, v: f64, frequency: [i64; 2]) -> Cell {
        #[allow(clippy::cast_precision_loss, reason = "frequencies are small")]
        let [x, y] = [u * frequency[0] as f64, v * frequency[1] as f64];
        #[allow(clippy::cast_possible_truncation, reason = "lattice coordinates are small")]
        let (i, j) = (x.floor() as i64, y.floor() as i64);
        let mut nearest = Cell { distance: f64::INFINITY, border: 0.0, number: 0 };
        let mut second = f64::INFINITY;
        for (dj, di) in (-1..=1).flat_map(|dj| (-1..=1).map(move |di| (dj, di))) {
            let number = (j + dj).rem_euclid(frequency[1]) * frequency[0] + (i + di).rem_euclid(frequency[0]);
            let jitter = |axis: i64| f64::from(self.hash(number, 11 + axis)) / 256.0;
            #[allow(clippy::cast_precision_loss, reason = "lattice coordinates are small")]
            let (px, py) = ((i + di) as f64 + jitter(0), (j + dj) as f64 + jitter(1));
            let distance = (x - px).hypot(y - py);
            if distance < nearest.distance {
                second = nearest.distance;
                nearest = Cell { distance, border: 0.0, number };
            } else {
                second = second.min(distance);
            }
        }
        nearest.border = second - nearest.distance;
        nearest
    }

    /// Narrow ridges along the zeros of the noise: 1 on a ridge, falling to 0 over `width`.
    pub(crate) fn ridge(&self, u: f64, v: f64, frequency: i64, octaves: i32, width: f64) -> f64 {
        let distance = self.fractal(u, v, frequency, octaves).abs() / width;
        (1.0 - distance).max(0.0)
    }
}
