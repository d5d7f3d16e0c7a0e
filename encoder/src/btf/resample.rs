//! From measured directions to the nodes of a grid: the values whose interpolation comes closest to what was measured.
//!
//! Two separable, regularised least-squares fits that invert the decoder's own weights, lights for every view, then
//! views. Radial basis functions (Havran et al. 2010, section 4.1) interpolate the measurements, but what is read back
//! between the nodes is 2.7 to 3.5 dB farther from them.

use crate::math::envelope::EnvelopeCholesky;
use crate::math::parallel;
use glam::Vec3;
use nalgebra::{DMatrix, DVector};
use subsurf_decoder::btf::{Grid, LerpCoord, View};

/// Weight of squared second differences between nodes.
const SMOOTHNESS: f64 = 2e-3;
/// Weight of squared values, which keeps nodes that nothing says anything of at zero.
const SMALLNESS: f64 = 1e-6;
/// Views this close to the normal have no azimuth: they are measured once and stand for all azimuths.
const POLE: f32 = 1e-3;

/// Fits and evaluates tables over a grid, for one set of measured directions.
pub struct Resampler {
    grid: Grid,
    views: usize,
    /// Views with an azimuth, and the pole's once for every node of φ_v.
    rows: Vec<Row>,
    /// Nodes of light from measured lights, for each azimuth of a view.
    nodes_from_lights: Vec<DMatrix<f64>>,
    /// Nodes of view from rows.
    views_from_rows: DMatrix<f64>,
}

struct Row {
    /// Number of the measured view.
    view: usize,
    /// Number of its azimuth.
    azimuth: usize,
}

/// Azimuths closer than that, in turns, are one.
const SAME_AZIMUTH: f32 = 1e-5;

/// Four weighted nodes of a table, at most.
type Weights = Vec<(usize, f64)>;

fn product(first: LerpCoord, second: LerpCoord, stride: usize) -> Weights {
    let pair = |place: LerpCoord| place.nodes.into_iter().zip(place.weights());
    let both = |(a, wa): (u32, f32)| {
        pair(second).map(move |(b, wb)| (a as usize * stride + b as usize, f64::from(wa) * f64::from(wb)))
    };
    pair(first).flat_map(both).collect()
}

/// Nodes `[α][β]` of a light.
fn light_weights(grid: &Grid, light: Vec3, view: &View) -> Weights {
    let cell = grid.coord_for(light.to_array(), view);
    product(cell.alpha, cell.beta, usize::from(grid.n_beta))
}

/// Nodes `[φ][θ]` of a view.
fn view_weights(grid: &Grid, view: &View) -> Weights {
    product(view.phi, view.theta, usize::from(grid.n_theta))
}

/// Second differences along both axes of a table of `[first][second]` nodes; the first may be a ring.
fn differences([first, second]: [usize; 2], is_ring: bool) -> Vec<Weights> {
    let at = |a: usize, b: usize| (a % first) * second + b;
    let triple = |[a, b, c]: [usize; 3]| vec![(a, 1.0), (b, -2.0), (c, 1.0)];
    let mut rows = Vec::new();
    for (a, b) in (0..first).flat_map(|a| (0..second).map(move |b| (a, b))) {
        if is_ring && first > 2 || a > 0 && a + 1 < first {
            rows.push(triple([at(a + first - 1, b), at(a, b), at(a + 1, b)]));
        }
        if b > 0 && b + 1 < second {
            rows.push(triple([at(a, b - 1), at(a, b), at(a, b + 1)]));
        }
    }
    rows
}

/// Product AᵀA of sparse rows A.
fn square(rows: &[Weights], columns: usize) -> DMatrix<f64> {
    let mut sum = DMatrix::zeros(columns, columns);
    for row in rows {
        for (a, wa) in row {
            for (b, wb) in row {
                sum[(*a, *b)] += wa * wb;
            }
        }
    }
    sum
}

/// (WᵀW + λ DᵀD + ε I)⁻¹ Wᵀ.
fn inverse(weights: &[Weights], squared_differences: &DMatrix<f64>) -> DMatrix<f64> {
    let nodes = squared_differences.ncols();
    let normal = square(weights, nodes) + squared_differences * SMOOTHNESS;
    let normal = normal + DMatrix::identity(nodes, nodes) * SMALLNESS;
    let factor = EnvelopeCholesky::new(&normal).expect("it is positive: ε > 0");
    let mut product = DMatrix::zeros(nodes, weights.len());
    parallel::for_chunks(product.as_mut_slice(), nodes, |number, column| {
        weights[number].iter().for_each(|(node, weight)| column[*node] += weight);
        factor.solve(column);
    });
    product
}

impl Resampler {
    /// Fits of values at pairs of `lights` and `views`.
    #[must_use]
    pub fn new(grid: &Grid, lights: &[Vec3], views: &[Vec3]) -> Self {
        let stood_for: Vec<(usize, Vec3)> = views
            .iter()
            .enumerate()
            .flat_map(|(number, view)| {
                let is_pole = view.truncate().length() < POLE;
                let azimuths = if is_pole { usize::from(grid.n_phi) } else { 1 };
                (0..azimuths).map(move |k| {
                    let phi = std::f32::consts::TAU * k as f32 / azimuths as f32;
                    let nudged = Vec3::new(1e-5 * phi.cos(), 1e-5 * phi.sin(), 1.0);
                    (number, if is_pole { nudged } else { *view })
                })
            })
            .collect();
        let light_nodes = grid.light_nodes();
        let sides = [grid.n_alpha, grid.n_beta].map(usize::from);
        let smooth = square(&differences(sides, false), light_nodes);
        // Frames of lights depend on a view's azimuth alone.
        let (mut azimuths, mut rows): (Vec<(f32, View)>, Vec<Row>) = (Vec::new(), Vec::new());
        for (view, direction) in &stood_for {
            let turns = direction.truncate().to_angle() / std::f32::consts::TAU;
            let is_same = |(other, _): &(f32, View)| {
                let apart = (other - turns).abs();
                apart.min(1.0 - apart) < SAME_AZIMUTH
            };
            let azimuth = azimuths.iter().position(is_same).unwrap_or_else(|| {
                azimuths.push((turns, grid.view(direction.to_array())));
                azimuths.len() - 1
            });
            rows.push(Row { view: *view, azimuth });
        }
        let of_azimuth = |(_, direction): &(f32, View)| {
            let weights: Vec<_> = lights.iter().map(|light| light_weights(grid, *light, direction)).collect();
            inverse(&weights, &smooth)
        };
        let nodes_from_lights = parallel::map(azimuths.len(), |k| of_azimuth(&azimuths[k]));
        let of_views: Vec<_> =
            stood_for.iter().map(|(_, view)| view_weights(grid, &grid.view(view.to_array()))).collect();
        let sides = [grid.n_phi, grid.n_theta].map(usize::from);
        let views_from_rows = inverse(&of_views, &square(&differences(sides, true), grid.view_nodes()));
        Self { grid: *grid, views: views.len(), rows, nodes_from_lights, views_from_rows }
    }

    /// Nodes of a table.
    pub(crate) fn nodes(&self) -> usize {
        self.grid.light_nodes() * self.grid.view_nodes()
    }

    /// Table `[φ_v][θ_v][α][β]` of values at all pairs, light after light.
    #[must_use]
    #[allow(clippy::cast_possible_truncation, reason = "tables are f32")]
    pub fn fit(&self, values: &[f32]) -> Vec<f32> {
        let lights = values.len() / self.views;
        let mut at_rows = DMatrix::zeros(self.rows.len(), self.grid.light_nodes());
        for (number, row) in self.rows.iter().enumerate() {
            let measured = DVector::from_fn(lights, |light, _| f64::from(values[light * self.views + row.view]));
            at_rows.row_mut(number).tr_copy_from(&(&self.nodes_from_lights[row.azimuth] * measured));
        }
        let nodes = &self.views_from_rows * at_rows;
        // Row by row: nalgebra keeps columns together.
        nodes.transpose().iter().map(|value| *value as f32).collect()
    }

    /// [`Self::fit`] of many, side by side in columns; in f32, and several times faster.
    #[allow(clippy::cast_possible_truncation, reason = "tables are f32")]
    pub(crate) fn fit_all(&self, values: &DMatrix<f32>) -> DMatrix<f32> {
        let (count, nodes) = (values.ncols(), self.grid.light_nodes());
        let lights = values.nrows() / self.views;
        let mut at_rows = DMatrix::zeros(nodes * count, self.rows.len());
        let nodes_from_lights: Vec<DMatrix<f32>> =
            self.nodes_from_lights.iter().map(|nodes| nodes.map(|weight| weight as f32)).collect();
        for (number, row) in self.rows.iter().enumerate() {
            let measured = DMatrix::from_fn(lights, count, |light, k| values[(light * self.views + row.view, k)]);
            let fitted = &nodes_from_lights[row.azimuth] * measured;
            at_rows.column_mut(number).copy_from_slice(fitted.as_slice());
        }
        let at_nodes = at_rows * self.views_from_rows.transpose().cast::<f32>();
        let mut tables = DMatrix::zeros(nodes * self.views_from_rows.nrows(), count);
        for (view, column) in at_nodes.column_iter().enumerate() {
            for (k, slice) in column.as_slice().chunks_exact(nodes).enumerate() {
                tables.column_mut(k).rows_mut(view * nodes, nodes).copy_from_slice(slice);
            }
        }
        tables
    }
}

/// Interpolates tables at measured pairs of directions, as the decoder does.
pub struct Measured {
    light_nodes: usize,
    view_nodes: usize,
    /// Nodes of φ_v and θ_v of each view.
    views: Vec<Weights>,
    /// Nodes of α and β of each light, for each view.
    lights: Vec<Vec<Weights>>,
}

impl Measured {
    /// Interpolation at pairs of `lights` and `views`.
    #[must_use]
    pub fn new(grid: &Grid, lights: &[Vec3], views: &[Vec3]) -> Self {
        let prepared: Vec<View> = views.iter().map(|view| grid.view(view.to_array())).collect();
        let of_lights = |view: &View| lights.iter().map(|light| light_weights(grid, *light, view)).collect();
        Self {
            light_nodes: grid.light_nodes(),
            view_nodes: grid.view_nodes(),
            views: prepared.iter().map(|view| view_weights(grid, view)).collect(),
            lights: prepared.iter().map(of_lights).collect(),
        }
    }

    /// Values at all pairs, light after light, of a table.
    #[must_use]
    #[allow(clippy::cast_possible_truncation, reason = "weights of f32 values")]
    pub fn read(&self, table: &[f32]) -> Vec<f32> {
        let count = self.views.len();
        let mut values = vec![0.0; self.lights.first().map_or(0, Vec::len) * count];
        let mut slice = vec![0.0; self.light_nodes];
        for (view, (nodes, lights)) in self.views.iter().zip(&self.lights).enumerate() {
            slice.fill(0.0);
            for (node, weight) in nodes {
                for (sum, value) in slice.iter_mut().zip(&table[node * self.light_nodes..]) {
                    *sum += *weight as f32 * value;
                }
            }
            for (light, nodes) in lights.iter().enumerate() {
                values[light * count + view] = nodes.iter().map(|(node, weight)| *weight as f32 * slice[*node]).sum();
            }
        }
        values
    }

    /// How much each node of a table counts in sums over all pairs that weigh them by `weights`: the adjoint of
    /// [`Self::read`].
    #[must_use]
    #[allow(clippy::cast_possible_truncation, reason = "tables are f32")]
    pub fn spread(&self, weights: &[f32]) -> Vec<f32> {
        let count = self.views.len();
        let mut table = vec![0.0; self.view_nodes * self.light_nodes];
        for (view, (view_nodes, lights)) in self.views.iter().zip(&self.lights).enumerate() {
            for (light, light_nodes) in lights.iter().enumerate() {
                let weight = weights[light * count + view];
                for (view_node, view_weight) in view_nodes {
                    for (light_node, light_weight) in light_nodes {
                        table[view_node * self.light_nodes + light_node] +=
                            weight * (view_weight * light_weight) as f32;
                    }
                }
            }
        }
        table
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::capture::bonn;

    /// What varies slowly with both directions comes back from the nodes; on the pole, whatever the azimuth.
    #[test]
    fn tables_give_back_what_was_measured() {
        let directions: Vec<Vec3> = bonn().iter().map(|direction| direction.unit()).collect();
        let grid = Grid { n_theta: 6, theta_max: 75.0_f32.to_radians(), ..Grid::PAPER };
        let value = |light: Vec3, view: Vec3| {
            let half = (light + view).normalize();
            light.z * (0.5 + 0.2 * light.x + 0.1 * view.y) + 0.3 * half.z.powi(8)
        };
        let values: Vec<f32> =
            directions.iter().flat_map(|light| directions.iter().map(move |view| value(*light, *view))).collect();
        let resampler = Resampler::new(&grid, &directions, &directions);
        let table = resampler.fit(&values);
        let twice = DMatrix::from_fn(values.len(), 2, |pair, k| values[pair] * (k + 1) as f32);
        let tables = resampler.fit_all(&twice);
        let error = table.iter().zip(tables.column(1).iter()).map(|(a, b)| (2.0 * a - b).abs()).fold(0.0, f32::max);
        assert!(error < 1e-4, "many at a time are fitted as one: {error}");
        let measured = Measured::new(&grid, &directions, &directions);
        let back = measured.read(&table);
        let squares: f32 = values.iter().zip(&back).map(|(a, b)| (a - b) * (a - b)).sum();
        let rms = (squares / values.len() as f32).sqrt();
        assert!(rms < 4e-3, "{rms}");
        // The adjoint: ⟨read(t), w⟩ = ⟨t, spread(w)⟩.
        let dot = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| f64::from(*a) * f64::from(*b)).sum::<f64>();
        let (left, right) = (dot(&back, &values), dot(&table, &measured.spread(&values)));
        assert!((left - right).abs() < 1e-4 * left, "{left} {right}");
    }
}
