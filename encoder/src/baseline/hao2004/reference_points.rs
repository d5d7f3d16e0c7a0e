//! Reference points (section 4.2).

use nalgebra::{DMatrix, DVector};

use super::harmonics::Harmonics;
use super::lloyd::{LLOYD_ROUNDS, Lloyd};
use super::tiling::Tiling;
use crate::transfer::Scheme;

/// Largest code of a weight.
const MOST: f32 = 65_535.0;

/// q at reference points, a byte for each light, and of all vertices the weights of three points, and what is left in spherical
/// harmonics, a byte for each coefficient.
pub struct ReferencePoints {
    /// q of the points as bytes give it back, `[light × point]`.
    points: DMatrix<f32>,
    /// Points of each vertex with their weights.
    corners: Vec<[(u32, f32); 3]>,
    differences: Harmonics,
    /// Bytes of which points a vertex has.
    index_bytes: u64,
    /// Bytes of all else.
    other_bytes: u64,
}

impl ReferencePoints {
    /// Reference points of q `[light × vertex]` at unit directions, with harmonics of an order: 3 and 6 in the paper.
    #[must_use]
    pub fn new(q: &DMatrix<f32>, lights: &[[f32; 3]], tiling: &Tiling, order: usize) -> Self {
        let own: Vec<usize> = tiling.points.iter().map(|vertex| *vertex as usize).collect();
        let lloyd = Lloyd::new(q.select_columns(&own).as_slice(), LLOYD_ROUNDS);
        let points = DMatrix::from_iterator(lights.len(), own.len(), lloyd.values());
        let corners = |(triangle, weights): &(u32, [f32; 3])| {
            let [a, b] = [0, 1].map(|k| (weights[k] * MOST).round() / MOST);
            let [i, j, k] = tiling.triangles[*triangle as usize];
            [(i, a), (j, b), (k, 1.0 - a - b)]
        };
        let corners: Vec<[(u32, f32); 3]> = tiling.barycentric.iter().map(corners).collect();
        let mut rest = q.clone();
        for (mut rest, corners) in rest.column_iter_mut().zip(&corners) {
            for (point, weight) in corners {
                rest.axpy(-weight, &points.column(*point as usize), 1.0);
            }
        }
        let differences = Harmonics::new(&rest, lights, order, 1);
        // A vertex names its triangle, and triangles their points: three points for each vertex would be twice as much.
        let bits = |count: usize| u64::from(count.next_power_of_two().trailing_zeros());
        let index_bits =
            bits(tiling.triangles.len()) * q.ncols() as u64 + 3 * bits(own.len()) * tiling.triangles.len() as u64;
        let other_bytes = lloyd.bytes() + 4 * q.ncols() as u64 + differences.bytes();
        Self { points, corners, differences, index_bytes: index_bits.div_ceil(8), other_bytes }
    }

    /// Bytes of all that is stored.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.other_bytes + self.index_bytes
    }

    /// Bytes as the paper counts: without which points a vertex has.
    #[must_use]
    pub fn bytes_without_indices(&self) -> u64 {
        self.other_bytes
    }
}

impl Scheme for ReferencePoints {
    fn exitance(&self, weights: &[f32]) -> Vec<f32> {
        let points = self.points.tr_mul(&DVector::from_column_slice(weights));
        let mut out = self.differences.exitance(weights);
        for (out, corners) in out.iter_mut().zip(&self.corners) {
            *out += corners.iter().map(|(point, weight)| weight * points[*point as usize]).sum::<f32>();
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use subsurf_scene::knot;

    use super::*;
    use crate::kernel::Profile;
    use crate::simulate::diffusion::Medium;
    use crate::transfer::{Options, RdTable, fibonacci, precompute};

    #[test]
    fn more_points_are_closer_and_all_are_exact_but_for_the_byte() {
        let mesh = knot(10.0, 3.0, 10).fitted(20.0).unwrap();
        let table = RdTable::of(&Profile::dipole(&Medium::measured("marble").unwrap(), 1.5).unwrap()).unwrap();
        let lights = fibonacci(40);
        let of = precompute(&mesh, &table, &lights, &Options { channels: 1, eta: 1.5 }, &()).unwrap();
        let vertices: Vec<usize> = of.place_of.iter().map(|place| *place as usize).collect();
        let q = of.q.select_columns(&vertices) / of.q.amax();
        let error = |stored: &dyn Scheme| {
            let of_light = |j: usize| {
                let one: Vec<f32> = (0..lights.len()).map(|k| if k == j { 1.0 } else { 0.0 }).collect();
                let found = stored.exitance(&one);
                found.iter().zip(q.row(j).iter()).map(|(a, b)| (a - b).powi(2)).sum::<f32>()
            };
            ((0..lights.len()).map(of_light).sum::<f32>() / q.len() as f32).sqrt()
        };
        let places = of.q.ncols();
        let stored = [places / 40, places / 10, places / 3, places]
            .map(|count| ReferencePoints::new(&q, &lights, &Tiling::new(&mesh, &of.place_of, count), 3));
        let errors: Vec<f32> = stored.iter().map(|stored| error(stored)).collect();
        let alone = error(&Harmonics::new(&q, &lights, 3, 2));
        let byte = error(&Lloyd::new(q.as_slice(), LLOYD_ROUNDS));
        println!("{places} places: {errors:.5?}; harmonics alone {alone:.5}, a byte each {byte:.5}");
        assert!(errors.is_sorted_by(|a, b| a > b), "{errors:?}");
        assert!(errors[1] < 0.8 * alone, "{errors:?}, {alone}");
        assert!(errors[3] < 1.2 * byte, "{errors:?}, {byte}");
        assert!(stored.is_sorted_by_key(ReferencePoints::bytes), "and take more room");
        assert!(stored.iter().all(|stored| stored.bytes() > stored.bytes_without_indices()), "indices count");
    }
}
