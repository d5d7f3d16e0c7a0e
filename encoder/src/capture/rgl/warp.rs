//! The warp between directions and the unit square, in which a measurement varies slowly (Dupuy and Jakob 2018).

/// A density on the unit square, bilinear between nodes, with its integrals along rows and over them.
///
/// Values are `[y][x]`, steps between nodes count as 1. All are divided by the integral over the square, unless that is 0.
#[derive(Debug)]
pub(super) struct Density {
    /// Nodes in x and in y, at least two each.
    size: [usize; 2],
    values: Vec<f64>,
    /// Integrals along x up to each node.
    along: Vec<f64>,
    /// Integrals over whole rows up to each y.
    over: Vec<f64>,
}

impl Density {
    /// Tables of densities that are not negative.
    pub(super) fn new(size: [usize; 2], values: &[f32]) -> Self {
        let [columns, rows] = size;
        let mut values: Vec<f64> = values.iter().map(|value| f64::from(*value)).collect();
        let mut along = vec![0.0; values.len()];
        for (along, row) in along.chunks_exact_mut(columns).zip(values.chunks_exact(columns)) {
            for x in 1..columns {
                along[x] = along[x - 1] + 0.5 * (row[x - 1] + row[x]);
            }
        }
        let of_row = |along: &[f64], y: usize| along[(y + 1) * columns - 1];
        let mut over = vec![0.0; rows];
        for y in 1..rows {
            over[y] = over[y - 1] + 0.5 * (of_row(&along, y - 1) + of_row(&along, y));
        }
        let total = over[rows - 1];
        if total > 0.0 {
            values.iter_mut().chain(&mut along).chain(&mut over).for_each(|value| *value /= total);
        }
        Self { size, values, along, over }
    }
}

/// Mixture of two densities of one size.
#[derive(Clone, Copy)]
pub(super) struct Mixture<'a> {
    pub(super) of: [&'a Density; 2],
    /// Share of the second.
    pub(super) share: f64,
}

impl Mixture<'_> {
    fn mix(&self, value: impl Fn(&Density) -> f64) -> f64 {
        (1.0 - self.share) * value(self.of[0]) + self.share * value(self.of[1])
    }

    /// Place in the unit square whose share of the mass is below a place in it: x along the row, then y over rows. Where
    /// there is no mass, places stay where they are.
    pub(super) fn cumulative(&self, place: [f64; 2]) -> [f64; 2] {
        let [columns, rows] = self.of[0].size;
        let ((x, fx), (y, fy)) = (node(place[0], columns), node(place[1], rows));
        let at = |y: usize, x: usize| y * columns + x;
        // Between the rows around the place: density left and right of it, and integrals to its left and over all.
        let between = |table: fn(&Density) -> &[f64], x: usize| {
            (1.0 - fy) * self.mix(|of| table(of)[at(y, x)]) + fy * self.mix(|of| table(of)[at(y + 1, x)])
        };
        let (left, right) = (between(|of| &of.values, x), between(|of| &of.values, x + 1));
        let below = between(|of| &of.along, x) + fx * left + 0.5 * fx * fx * (right - left);
        let whole = between(|of| &of.along, columns - 1);
        // Over rows: the integral of a linear function.
        let [first, second] = [y, y + 1].map(|y| self.mix(|of| of.along[at(y, columns - 1)]));
        let over = self.mix(|of| of.over[y]) + fy * first + 0.5 * fy * fy * (second - first);
        let total = self.mix(|of| of.over[rows - 1]);
        let share =
            |part: f64, whole: f64, else_: f64| if whole > 0.0 { (part / whole).clamp(0.0, 1.0) } else { else_ };
        [share(below, whole, place[0]), share(over, total, place[1])]
    }
}

/// Node below a coordinate from 0 to 1 of so many nodes, and how far it is to the next, 0 to 1.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "casts saturate; the last but one is the limit"
)]
pub(super) fn node(coordinate: f64, count: usize) -> (usize, f64) {
    let at = coordinate * (count - 1) as f64;
    let below = (at as usize).min(count - 2);
    (below, at - below as f64)
}
