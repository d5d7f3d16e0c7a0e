//! Sums of the light that leaves at each place.

use glam::Vec3;
use nalgebra::DMatrix;

use super::near::{Near, NearWeights};
use super::point_tree::PointTree;
use super::rd_table::RdTable;
use super::surface::Surface;
use crate::math::parallel;
use crate::progress::Progress;

/// Sources that are multiplied at a time.
const BLOCK: usize = 512;

/// Exitance q `[channel · lights + light × place]`: Σ_i R_d(‖x_i − x_o‖) Φ_i over the places within the radius of R_d, Φ_i the flux
/// that entered there (section 3.1, without 1/π); near a place, integrals over the triangles.
pub(super) struct Gather<'a> {
    pub(super) surface: &'a Surface,
    /// Φ `[light × place]` in mm².
    pub(super) flux: &'a DMatrix<f32>,
    pub(super) table: &'a RdTable,
    /// Triangles of the surface.
    pub(super) near: Near<'a>,
    /// 1, or 3.
    pub(super) channels: usize,
}

impl<'a> Gather<'a> {
    pub(super) fn new(surface: &'a Surface, flux: &'a DMatrix<f32>, table: &'a RdTable, channels: usize) -> Self {
        Self { surface, flux, table, near: Near::new(surface, table), channels }
    }

    /// The sum over all places one by one, O(N²): the check.
    #[cfg(test)]
    pub(super) fn exact(&self) -> DMatrix<f32> {
        let all: Vec<u32> = (0..).take(self.surface.len()).collect();
        let mut out = DMatrix::zeros(self.channels * self.flux.nrows(), self.surface.len());
        parallel::for_chunks(out.as_mut_slice(), self.channels * self.flux.nrows(), |place, out| {
            let at = self.surface.positions[place];
            self.add(&[all[place]], &all, &self.surface.positions, self.flux, true, out);
            self.add_near(&[all[place]], at, 0.0, out);
        });
        out
    }

    /// The same with far places taken together: those in a ball that is seen under a radius of less than `spread` of its distance.
    /// O(N log N). Advances `progress` by the number of places.
    pub(super) fn hierarchical(&self, spread: f32, progress: &dyn Progress) -> DMatrix<f32> {
        let tree = PointTree::new(&self.surface.positions, &self.surface.areas);
        let sums = self.sums(&tree);
        let centres: Vec<Vec3> = tree.nodes.iter().map(|node| node.centre).collect();
        let rows = self.channels * self.flux.nrows();
        let of_leaf = |leaf: usize| {
            let places = &tree.order[tree.nodes[leaf].points.clone()];
            let (points, nodes) = self.sources(&tree, leaf, spread);
            let mut out = vec![0.0; rows * places.len()];
            self.add(places, &points, &self.surface.positions, self.flux, true, &mut out);
            self.add(places, &nodes, &centres, &sums, false, &mut out);
            self.add_near(places, tree.nodes[leaf].centre, tree.nodes[leaf].radius, &mut out);
            progress.advance(places.len() as u64);
            out
        };
        let leaves = tree.leaves();
        let mut out = DMatrix::zeros(rows, self.surface.len());
        // In portions, so that the sums are not all there twice.
        for leaves in leaves.chunks(4 * BLOCK) {
            let sums = parallel::map(leaves.len(), |leaf| of_leaf(leaves[leaf]));
            for (leaf, sums) in leaves.iter().zip(&sums) {
                for (place, sums) in tree.order[tree.nodes[*leaf].points.clone()].iter().zip(sums.chunks(rows)) {
                    out.column_mut(*place as usize).copy_from_slice(sums);
                }
            }
        }
        out
    }

    /// Flux `[light × node]` of the points of each node.
    fn sums(&self, tree: &PointTree) -> DMatrix<f32> {
        let mut sums = DMatrix::zeros(self.flux.nrows(), tree.nodes.len());
        for (number, node) in tree.nodes.iter().enumerate().rev() {
            if let Some(second) = node.second {
                let sum = sums.column(number + 1) + sums.column(second);
                sums.set_column(number, &sum);
            } else {
                let mut sum = sums.column_mut(number);
                for place in &tree.order[node.points.clone()] {
                    sum += self.flux.column(*place as usize);
                }
            }
        }
        sums
    }

    /// Places that the places of a leaf see one by one, and nodes that they see as a whole.
    fn sources(&self, tree: &PointTree, leaf: usize, spread: f32) -> (Vec<u32>, Vec<u32>) {
        let (mut points, mut nodes) = (Vec::new(), Vec::new());
        let own = &tree.nodes[leaf];
        let mut open = vec![0];
        while let Some(number) = open.pop() {
            let node = &tree.nodes[number];
            let distance = own.centre.distance(node.centre) - own.radius;
            if distance - node.radius > self.table.radius_mm {
                continue;
            }
            if node.radius < spread * distance {
                nodes.push(u32::try_from(number).expect("fewer than 2³² nodes"));
            } else if let Some(second) = node.second {
                open.extend([second, number + 1]);
            } else {
                points.extend(&tree.order[node.points.clone()]);
            }
        }
        (points, nodes)
    }

    /// Adds what `sources` send to `places`, whose sums are `out`, `[place][channel][light]`.
    fn add(
        &self,
        places: &[u32],
        sources: &[u32],
        positions: &[Vec3],
        flux: &DMatrix<f32>,
        are_places: bool,
        out: &mut [f32],
    ) {
        for sources in sources.chunks(BLOCK) {
            let mut weights = DMatrix::zeros(sources.len(), places.len() * self.channels);
            for (number, place) in places.iter().enumerate() {
                let at = self.surface.positions[*place as usize];
                for (row, source) in sources.iter().enumerate() {
                    let rd = if are_places && source == place {
                        [0.0; 3]
                    } else {
                        self.table.at_squared(at.distance_squared(positions[*source as usize]))
                    };
                    for c in 0..self.channels {
                        weights[(row, number * self.channels + c)] = rd[c];
                    }
                }
            }
            add_weighted(flux, sources, &weights, out);
        }
    }

    /// Adds what triangles near the places in a ball send beyond what their corners do.
    fn add_near(&self, places: &[u32], centre: Vec3, radius: f32, out: &mut [f32]) {
        let NearWeights { sources, weights } = self.near.weights(places, centre, radius, self.channels);
        add_weighted(self.flux, &sources, &weights, out);
    }
}

/// Adds the flux of `sources` times `weights`, `[source × sum]`, to `out`, `[sum][light]`.
fn add_weighted(flux: &DMatrix<f32>, sources: &[u32], weights: &DMatrix<f32>, out: &mut [f32]) {
    let lights = flux.nrows();
    for (number, sources) in sources.chunks(BLOCK).enumerate() {
        let mut columns = DMatrix::zeros(lights, sources.len());
        for (column, source) in columns.as_mut_slice().chunks_mut(lights).zip(sources) {
            column.copy_from_slice(flux.column(*source as usize).as_slice());
        }
        let mut out = nalgebra::DMatrixViewMut::from_slice(out, lights, weights.ncols());
        out.gemm(1.0, &columns, &weights.rows(number * BLOCK, sources.len()), 1.0);
    }
}
