//! Slices along β, which are the windows that similarity looks at: alone, and those of a 2-D slice side by side.

use glam::Vec4;

/// Rows that are compared at a time, a number of each in a [`Vec4`].
pub(super) const LANES: usize = 4;

/// Mean and variance of a row.
fn moments(row: &[f32]) -> [f32; 2] {
    let count = row.len() as f32;
    let mean = row.iter().sum::<f32>() / count;
    // Around the mean: in one pass, rows that hardly vary would lose their last digits.
    let variance = row.iter().map(|value| (value - mean) * (value - mean)).sum::<f32>() / count;
    [mean, variance]
}

/// Set of 1-D slices with their moments.
#[derive(Clone, Debug)]
pub(super) struct Rows {
    nodes: usize,
    /// `[row][β]`.
    values: Vec<f32>,
    moments: Vec<[f32; 2]>,
}

/// A 1-D slice, its mean and its variance.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row<'a> {
    pub(super) values: &'a [f32],
    pub(super) mean: f32,
    pub(super) variance: f32,
}

impl<'a> Row<'a> {
    pub(super) fn new(values: &'a [f32]) -> Self {
        let [mean, variance] = moments(values);
        Self { values, mean, variance }
    }
}

impl Rows {
    /// None yet, of `nodes` samples.
    pub(super) fn new(nodes: usize) -> Self {
        Self { nodes, values: Vec::new(), moments: Vec::new() }
    }

    pub(super) fn push(&mut self, row: &[f32]) {
        self.values.extend_from_slice(row);
        self.moments.push(moments(row));
    }

    pub(super) fn len(&self) -> usize {
        self.moments.len()
    }

    pub(super) fn row(&self, number: usize) -> Row<'_> {
        let [mean, variance] = self.moments[number];
        Row { values: &self.values[number * self.nodes..][..self.nodes], mean, variance }
    }

    /// Samples of all rows, `[row][β]`.
    pub(super) fn values(&self) -> &[f32] {
        &self.values
    }
}

/// 2-D slices, whose rows lie side by side; beside the last there are zeros.
#[derive(Clone, Debug)]
pub(super) struct Slices {
    n_alpha: usize,
    n_beta: usize,
    /// `[slice][α / LANES][β][α % LANES]`.
    values: Vec<Vec4>,
    /// `[slice][α / LANES][α % LANES]`.
    means: Vec<Vec4>,
    variances: Vec<Vec4>,
}

/// Some rows of a 2-D slice.
#[derive(Clone, Copy, Debug)]
pub(super) struct Group<'a> {
    /// Samples at each β, a row in each lane.
    pub(super) values: &'a [Vec4],
    pub(super) means: Vec4,
    pub(super) variances: Vec4,
}

impl Slices {
    /// None yet, of `[α][β]` samples.
    pub(super) fn new([n_alpha, n_beta]: [usize; 2]) -> Self {
        Self { n_alpha, n_beta, values: Vec::new(), means: Vec::new(), variances: Vec::new() }
    }

    /// Adds 2-D slices, `[slice][α][β]`.
    pub(super) fn push(&mut self, values: &[f32]) {
        for slice in values.chunks_exact(self.n_alpha * self.n_beta) {
            for rows in slice.chunks(LANES * self.n_beta) {
                let start = self.values.len();
                self.values.resize(start + self.n_beta, Vec4::ZERO);
                let (mut means, mut variances) = (Vec4::ZERO, Vec4::ZERO);
                for (lane, row) in rows.chunks_exact(self.n_beta).enumerate() {
                    [means[lane], variances[lane]] = moments(row);
                    self.values[start..].iter_mut().zip(row).for_each(|(values, value)| values[lane] = *value);
                }
                self.means.push(means);
                self.variances.push(variances);
            }
        }
    }

    /// Number of rows of a slice.
    pub(super) fn n_alpha(&self) -> usize {
        self.n_alpha
    }

    /// Groups of rows to a slice.
    #[inline]
    pub(super) fn groups(&self) -> usize {
        self.n_alpha.div_ceil(LANES)
    }

    pub(super) fn len(&self) -> usize {
        self.means.len() / self.groups()
    }

    /// Group `number`, counted through all slices.
    #[inline]
    pub(super) fn group(&self, number: usize) -> Group<'_> {
        Group {
            values: &self.values[number * self.n_beta..][..self.n_beta],
            means: self.means[number],
            variances: self.variances[number],
        }
    }

    /// The row of a slice at a node of α.
    pub(super) fn row(&self, slice: usize, alpha: usize) -> Vec<f32> {
        let group = self.group(slice * self.groups() + alpha / LANES);
        group.values.iter().map(|values| values[alpha % LANES]).collect()
    }

    fn mean_of(&self, moments: &[Vec4], slices: std::ops::Range<usize>) -> f32 {
        let count = (slices.len() * self.n_alpha) as f32;
        let moments = &moments[slices.start * self.groups()..slices.end * self.groups()];
        moments.iter().map(|lanes| lanes.element_sum()).sum::<f32>() / count
    }

    /// Mean of all samples of some slices.
    pub(super) fn mean(&self, slices: std::ops::Range<usize>) -> f32 {
        self.mean_of(&self.means, slices)
    }

    /// Mean variance of the rows of some slices.
    pub(super) fn variance(&self, slices: std::ops::Range<usize>) -> f32 {
        self.mean_of(&self.variances, slices)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_know_their_moments() {
        let mut rows = Rows::new(3);
        rows.push(&[1.0, 2.0, 6.0]);
        rows.push(&[0.5; 3]);
        assert_eq!(rows.len(), 2);
        let Row { mean, variance, values } = rows.row(0);
        assert_eq!(values, [1.0, 2.0, 6.0]);
        assert!((mean - 3.0).abs() < 1e-6 && (variance - 14.0 / 3.0).abs() < 1e-5, "{mean} {variance}");
    }

    #[test]
    fn slices_keep_their_rows() {
        let values: Vec<f32> = (0..2 * 5 * 3).map(|k| (k * k % 7) as f32).collect();
        let mut slices = Slices::new([5, 3]);
        slices.push(&values);
        assert_eq!((slices.len(), slices.groups()), (2, 2));
        for (number, row) in values.chunks_exact(3).enumerate() {
            assert_eq!(slices.row(number / 5, number % 5), row);
            let group = slices.group(number / 5 * 2 + number % 5 / LANES);
            assert!((group.means[number % 5 % LANES] - row.iter().sum::<f32>() / 3.0).abs() < 1e-6);
        }
        let last = slices.group(3);
        assert!(last.values.iter().all(|lanes| lanes.to_array()[1..] == [0.0; 3]), "beside the last row: {last:?}");
        let mean = values[15..].iter().sum::<f32>() / 15.0;
        assert!((slices.mean(1..2) - mean).abs() < 1e-6, "zeros beside rows do not count");
    }
}
