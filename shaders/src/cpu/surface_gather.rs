//! Twin of `surface_gather.wgsl`.

use glam::{UVec3, Vec3, Vec4Swizzles};
use rayon::prelude::*;
use subsurf_decoder::Bssrdf;
use subsurf_scene::{PointGrid, SurfacePoints};

use crate::rgb::Rgb;

fn cell_of(grid: &PointGrid, position_mm: Vec3) -> UVec3 {
    let cell = ((position_mm - grid.origin_mm) / grid.cell_mm).floor();
    let last = grid.cells - 1;
    cell.clamp(Vec3::ZERO, last.as_vec3()).as_uvec3()
}

fn cell_start(points: &SurfacePoints, cell: u32) -> usize {
    points.cell_starts[cell as usize].min(points.grid.points) as usize
}

/// Exitance Σ Rd(x_i, x_o) E(x_i) dA at every point, r the distance in space.
///
/// # Panics
/// If the tables of `points` do not fit each other or `irradiance`.
#[must_use]
pub fn surface_gather(material: &Bssrdf<'_>, points: &SurfacePoints, irradiance: &[Rgb]) -> Vec<Rgb> {
    let r_max_mm = material.header().r_max_mm;
    let cells = points.grid.cells;
    let profile = |point: usize| material.profile(points.pixels[point].map(i32::from));
    let exitance = |point: usize| {
        let x_o = points.positions[point].xyz();
        let p_o = profile(point);
        let (low, high) = (cell_of(&points.grid, x_o - r_max_mm), cell_of(&points.grid, x_o + r_max_mm));
        let mut sum = [0.0; 3];
        for z in low.z..=high.z {
            for y in low.y..=high.y {
                // The cells of a row follow each other, and so do their points.
                let row = (z * cells.y + y) * cells.x;
                for i in cell_start(points, row + low.x)..cell_start(points, row + high.x + 1) {
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
    (0..points.grid.points as usize).into_par_iter().map(exitance).collect()
}
