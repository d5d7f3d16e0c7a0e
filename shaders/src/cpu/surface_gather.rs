//! Twin of `surface_gather.wgsl`.

use glam::{UVec3, Vec3, Vec4, Vec4Swizzles};
use rayon::prelude::*;
use subsurf_decoder::Bssrdf;

use super::Rgb;
use crate::uniform::Surface;

/// Points spread over a surface, sorted into the cells of a grid.
#[derive(Clone, Copy, Debug)]
pub struct Points<'a> {
    /// The grid.
    pub surface: Surface,
    /// Position in mm, and the area in mm² that the point stands for.
    pub positions: &'a [Vec4],
    /// Pixel of the material at each point.
    pub pixels: &'a [[u16; 2]],
    /// First point of every cell, `[z][y][x]`, and one more entry: the number of points.
    pub cell_starts: &'a [u32],
}

impl Points<'_> {
    fn cell_of(&self, position_mm: Vec3) -> UVec3 {
        let surface = &self.surface;
        let cell = ((position_mm - Vec3::from(surface.origin_mm)) / surface.cell_mm).floor();
        let last = UVec3::from(surface.cells) - 1;
        cell.clamp(Vec3::ZERO, last.as_vec3()).as_uvec3()
    }

    fn cell_start(&self, cell: u32) -> usize {
        self.cell_starts[cell as usize].min(self.surface.points) as usize
    }
}

/// Exitance Σ Rd(x_i, x_o) E(x_i) dA at every point, r the distance in space.
///
/// # Panics
/// If the tables of `points` do not fit each other or `irradiance`.
#[must_use]
pub fn surface_gather(material: &Bssrdf<'_>, points: &Points<'_>, irradiance: &[Rgb]) -> Vec<Rgb> {
    let r_max_mm = material.header().r_max_mm;
    let cells = points.surface.cells;
    let profile = |point: usize| material.profile(points.pixels[point].map(i32::from));
    let exitance = |point: usize| {
        let x_o = points.positions[point].xyz();
        let p_o = profile(point);
        let (low, high) = (points.cell_of(x_o - r_max_mm), points.cell_of(x_o + r_max_mm));
        let mut sum = [0.0; 3];
        for z in low.z..=high.z {
            for y in low.y..=high.y {
                // The cells of a row follow each other, and so do their points.
                let row = (z * cells[1] + y) * cells[0];
                for i in points.cell_start(row + low.x)..points.cell_start(row + high.x + 1) {
                    let x_i = points.positions[i];
                    let Some(knot) = material.knot(x_i.xyz().distance(x_o)) else {
                        continue;
                    };
                    let rd = material.rd_at(&profile(i), &p_o, knot);
                    for c in 0..3 {
                        sum[c] += rd[c] * irradiance[i][c] * x_i.w;
                    }
                }
            }
        }
        sum
    };
    (0..points.surface.points as usize).into_par_iter().map(exitance).collect()
}
