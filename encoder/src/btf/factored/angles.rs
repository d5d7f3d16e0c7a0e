//! Tables as axes of views, axes of lights and a sparse core between them.

use nalgebra::DMatrix;
use subsurf_decoder::btf::factored::model::MAX_NUMBER;

use super::streams;
use crate::math::eigen::Eigen;
use crate::math::parallel;

/// Tables of all columns as a Tucker decomposition, in whole steps.
pub(super) struct Tucker {
    /// `[axis][view node]` and `[axis][light node]`.
    pub(super) axes: [Vec<i8>; 2],
    /// Value of a step of each axis.
    pub(super) scales: [Vec<f32>; 2],
    /// For every column `[view axis][light axis]`, in steps.
    pub(super) core: Vec<Vec<i32>>,
    /// Value of a step of the core, by columns.
    pub(super) core_steps: Vec<f32>,
    /// Value of a step of the table, by columns.
    pub(super) steps: Vec<f32>,
}

/// Fineness of axes and core.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fineness {
    /// Axes of views and of lights.
    pub(super) axes: [usize; 2],
    /// Fineness of the core.
    pub(super) core: CoreSize,
}

/// Fineness of the core, by its step or by its bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CoreSize {
    /// Its step for a column whose coefficients have a mean square of 1, in units of the decomposition's
    /// coefficients.
    Step(f32),
    /// The finest step at which it takes no more than these bytes in a file.
    Bytes(usize),
}

/// Finest and coarsest step that [`CoreSize::Bytes`] tries.
const STEPS: [f32; 2] = [1e-4, 1.0];

/// Where a number is rounded up: below one half, since a zero more takes fewer bits than it costs.
const ROUNDING: f32 = 0.36;
/// Least weight of a node, in mean weights: what was never measured still must not run away.
const LEAST_WEIGHT: f32 = 0.02;

/// Nodes and how much they count, as a product of views and lights.
struct Weights {
    views: Vec<f32>,
    lights: Vec<f32>,
}

impl Weights {
    /// Square roots of the marginals of a table `[view][light]`, whose product has its sum.
    fn new(table: &[f32], lights: usize) -> Self {
        let views = table.len() / lights;
        let total: f32 = table.iter().sum();
        let root = |sums: Vec<f32>| -> Vec<f32> {
            let mean = total / sums.len() as f32;
            sums.into_iter().map(|sum| (sum.max(LEAST_WEIGHT * mean) / total.sqrt()).sqrt()).collect()
        };
        Self {
            views: root((0..views).map(|v| table[v * lights..(v + 1) * lights].iter().sum()).collect()),
            lights: root((0..lights).map(|l| table[l..].iter().step_by(lights).sum()).collect()),
        }
    }
}

/// The leading eigenvectors, `[node × axis]`, over weights and in 8 bits.
fn axes(gram: DMatrix<f32>, count: usize, weights: &[f32]) -> (Vec<i8>, Vec<f32>) {
    let eigen = Eigen::of(gram);
    let (mut bytes, mut scales) = (Vec::new(), Vec::new());
    for vector in eigen.vectors.column_iter().take(count) {
        let plain: Vec<f32> = vector.iter().zip(weights).map(|(value, weight)| value / weight).collect();
        let scale = plain.iter().fold(1e-12_f32, |largest, value| largest.max(value.abs())) / 127.0;
        #[allow(clippy::cast_possible_truncation, reason = "at most 127")]
        bytes.extend(plain.iter().map(|value| (value / scale).round() as i8));
        scales.push(scale);
    }
    (bytes, scales)
}

/// `[node × axis]` as decoders have it.
fn decoded(bytes: &[i8], scales: &[f32]) -> DMatrix<f32> {
    let nodes = bytes.len() / scales.len();
    DMatrix::from_fn(nodes, scales.len(), |node, axis| f32::from(bytes[axis * nodes + node]) * scales[axis])
}

fn root(energy: f32) -> f32 {
    energy.sqrt().max(1e-12)
}

/// Whole steps, in the order of a core.
fn quantise(exact: &DMatrix<f32>, step: f32) -> Vec<i32> {
    let whole = |value: &f32| {
        #[allow(clippy::cast_possible_truncation, reason = "clamped")]
        let magnitude = (value.abs() / step + ROUNDING).floor().min(MAX_NUMBER as f32) as i32;
        if *value < 0.0 { -magnitude } else { magnitude }
    };
    exact.iter().map(whole).collect()
}

/// The finest step that is small enough, by halving; the coarsest if none is.
fn finest(is_small: impl Fn(f32) -> bool) -> f32 {
    let [mut fine, mut coarse] = STEPS.map(f32::ln);
    for _ in 0..10 {
        let middle = 0.5 * (fine + coarse);
        if is_small(middle.exp()) { coarse = middle } else { fine = middle }
    }
    coarse.exp()
}

/// (AᵀW²A)⁻¹AᵀW²: what is left of a table on axes.
fn projection(axes: &DMatrix<f32>, weights: &[f32]) -> DMatrix<f32> {
    let mut weighted = axes.clone();
    for (mut row, weight) in weighted.row_iter_mut().zip(weights) {
        row *= weight * weight;
    }
    let gram = weighted.tr_mul(axes);
    let ridge = DMatrix::identity(gram.nrows(), gram.nrows()) * (1e-6 * gram.diagonal().max());
    (gram + ridge).cholesky().expect("it is positive: a ridge was added").solve(&weighted.transpose())
}

impl Tucker {
    /// Of tables `[view][light]` in columns, whose coefficients have mean squares `energies`; `node_weights` say how
    /// much nodes count.
    pub(super) fn new(
        tables: &DMatrix<f32>,
        energies: &[f32],
        node_weights: &[f32],
        lights: usize,
        fineness: Fineness,
    ) -> Self {
        let weights = Weights::new(node_weights, lights);
        let views = weights.views.len();
        // Columns as matrices [light × view]: nodes of a column follow each other light by light.
        let matrices: Vec<DMatrix<f32>> = tables
            .column_iter()
            .map(|column| DMatrix::from_column_slice(lights, views, column.clone_owned().as_slice()))
            .collect();
        let grams = |of: &(dyn Fn(&DMatrix<f32>) -> DMatrix<f32> + Sync)| {
            let parts = parallel::map(matrices.len(), |k| {
                let mut weighted = matrices[k].clone() * energies[k].sqrt();
                for (view, mut column) in weighted.column_iter_mut().enumerate() {
                    let of_view = weights.views[view];
                    column.iter_mut().zip(&weights.lights).for_each(|(value, weight)| *value *= of_view * weight);
                }
                of(&weighted)
            });
            parts.iter().skip(1).fold(parts[0].clone(), |sum, part| sum + part)
        };
        let of_views = axes(grams(&|x| x.tr_mul(x)), fineness.axes[0], &weights.views);
        let of_lights = axes(grams(&|x| x * x.transpose()), fineness.axes[1], &weights.lights);
        let (view_axes, light_axes) = (decoded(&of_views.0, &of_views.1), decoded(&of_lights.0, &of_lights.1));
        let core_from_views = projection(&view_axes, &weights.views);
        let core_from_lights = projection(&light_axes, &weights.lights);
        // [light axis × view axis], whose columns are rows of the core, in units of its steps.
        let exact = parallel::map(matrices.len(), |k| {
            &core_from_lights * &matrices[k] * core_from_views.transpose() * root(energies[k])
        });
        let quantised = |step: f32| parallel::map(exact.len(), |k| quantise(&exact[k], step));
        // Finer steps would cut the largest numbers.
        let largest = exact.iter().map(DMatrix::amax).fold(0.0_f32, f32::max);
        let least = largest / (MAX_NUMBER as f32 - 1.0);
        let step = match fineness.core {
            CoreSize::Step(step) => step,
            CoreSize::Bytes(most) => finest(|step| streams::core(&quantised(step), fineness.axes[1]).len() <= most),
        }
        .max(least);
        let core = quantised(step);
        let core_steps: Vec<f32> = energies.iter().map(|energy| step / root(*energy)).collect();
        let mut tucker = Self {
            axes: [of_views.0, of_lights.0],
            scales: [of_views.1, of_lights.1],
            core,
            core_steps,
            steps: Vec::new(),
        };
        let exact = tucker.exact(lights);
        let mean = node_weights.iter().sum::<f32>() / node_weights.len() as f32;
        let step = |column: usize| {
            let counted = exact
                .column(column)
                .into_iter()
                .zip(node_weights)
                .filter(|(_, weight)| **weight >= LEAST_WEIGHT * mean);
            // Columns of zeros have some step too.
            counted.map(|(value, _)| value.abs() / 127.0).fold(1e-5 * tucker.core_steps[column], f32::max)
        };
        tucker.steps = (0..exact.ncols()).map(step).collect();
        tucker
    }

    /// Tables as they are before they are rounded, `[view][light]` in columns.
    fn exact(&self, lights: usize) -> DMatrix<f32> {
        let [views_from_core, lights_from_core] = [0, 1].map(|k| decoded(&self.axes[k], &self.scales[k]));
        let count = [views_from_core.ncols(), lights_from_core.ncols()];
        let columns = parallel::map(self.core.len(), |k| {
            let (core, step) = (&self.core[k], self.core_steps[k]);
            let core = DMatrix::from_fn(count[1], count[0], |j, i| core[i * count[1] + j] as f32 * step);
            (&lights_from_core * core * views_from_core.transpose()).as_slice().to_vec()
        });
        DMatrix::from_vec(lights * views_from_core.nrows(), columns.len(), columns.concat())
    }

    /// Tables as decoders have them, but for what rounding of sums may change in the last step.
    pub(super) fn tables(&self, lights: usize) -> DMatrix<f32> {
        let mut tables = self.exact(lights);
        for (mut column, step) in tables.column_iter_mut().zip(&self.steps) {
            column.apply(|value| *value = (*value / step).round().clamp(-127.0, 127.0) * step);
        }
        tables
    }
}
