//! The matrices A of all pixels, each distinct one once.

use std::collections::HashMap;

use subsurf_decoder::bssrdf::Addressing;

use super::counts::COUNTS;
use crate::bssrdf::window::{Geometry, Ring};
use crate::math::banded::Banded;
use crate::math::lanes::{self, ZERO};
use crate::math::parallel;

/// A_i, and the part of it that comes from pairs of a pixel with itself.
#[derive(Clone, Debug)]
pub(crate) struct Matrix {
    /// Matrix A_i = Σ_j φ n a aᵀ.
    pub(crate) all: Banded,
    /// The same sum over the offsets that lead back to the pixel: r = 0, and more where a small patch repeats.
    pub(crate) own: Banded,
}

impl Matrix {
    /// The curvature of the cost in the pixel's own profile: a pair with itself moves at both ends.
    pub(crate) fn curvature(&self) -> Banded {
        let mut sum = self.all.clone();
        sum.add_scaled(1.0, &self.own);
        sum
    }
}

/// A_i of every pixel. Without missing entries it depends on the distance from the border alone.
pub(super) fn matrices(geometry: &Geometry, rings: &[Ring], counts: Option<&[u8]>) -> (Vec<Matrix>, Vec<u32>) {
    let window = rings.iter().map(|ring| ring.offsets.len()).sum::<usize>();
    let matrix = |pixel: usize| {
        let mut matrix = Matrix { all: Banded::new(geometry.nodes), own: Banded::new(geometry.nodes) };
        let mut at = pixel * window;
        for ring in rings {
            let (mut all, mut own) = (ZERO, ZERO);
            for offset in &ring.offsets {
                let other = geometry.neighbour(pixel, offset.step);
                if other.is_some() {
                    let n = counts.map_or([2.0, 2.0, 2.0, 0.0], |counts| COUNTS[usize::from(counts[at])]);
                    lanes::add_scaled(&mut all, ring.phi, &n);
                    if other == Some(pixel) {
                        lanes::add_scaled(&mut own, ring.phi, &n);
                    }
                }
                at += 1;
            }
            matrix.all.add_hat(ring.h, ring.w, &all);
            matrix.own.add_hat(ring.h, ring.w, &own);
        }
        matrix
    };
    let numbers = 0..u32::try_from(geometry.pixels()).expect("captures have fewer than 2³² pixels");
    if counts.is_some() {
        return (parallel::map(geometry.pixels(), matrix), numbers.collect());
    }
    let mut known: HashMap<[usize; 4], u32> = HashMap::new();
    let mut matrices = Vec::new();
    let matrix_of = (0..geometry.pixels())
        .map(|pixel| {
            *known.entry(border_class(geometry, pixel)).or_insert_with(|| {
                matrices.push(matrix(pixel));
                u32::try_from(matrices.len() - 1).expect("no more matrices than pixels")
            })
        })
        .collect();
    (matrices, matrix_of)
}

/// Pixels of one class have the same A: distances from the borders up to R, without regard to reflections.
fn border_class(geometry: &Geometry, pixel: usize) -> [usize; 4] {
    if geometry.addressing == Addressing::Repeat {
        return [0; 4];
    }
    let position = geometry.position(pixel);
    let mut axes = [0, 1].map(|axis| {
        let before = position[axis].min(geometry.radius);
        let behind = (geometry.size[axis] - 1 - position[axis]).min(geometry.radius);
        [before.min(behind), before.max(behind)]
    });
    axes.sort_unstable();
    [axes[0][0], axes[0][1], axes[1][0], axes[1][1]]
}
