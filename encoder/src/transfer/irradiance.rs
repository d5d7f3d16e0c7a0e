//! Light that enters the surface from each direction.

use glam::Vec3;
use nalgebra::DMatrix;
use subsurf_scene::{Mesh, Occluder};

use super::rd_table::single;
use super::surface::Surface;
use crate::math::parallel;
use crate::progress::Progress;
use crate::simulate::fresnel;

/// Places that one thread handles at a time.
const BLOCK: usize = 256;

/// Flux in mm² that enters at each place `[light × place]`, under light of irradiance 1 on a plane across it: the sum over the
/// vertices there of F_t(η, ω) (n · ω) ΔA, 0 where they face away or the mesh is in the way (section 3.1).
///
/// Advances `progress` by the number of places.
pub(super) fn entered(
    mesh: &Mesh,
    surface: &Surface,
    lights: &[[f32; 3]],
    eta: f32,
    progress: &dyn Progress,
) -> DMatrix<f32> {
    let occluder = Occluder::new(mesh);
    let mut flux = DMatrix::zeros(lights.len(), surface.len());
    let of_place = |place: usize, flux: &mut [f32]| {
        for &(vertex, area) in &surface.senders[place] {
            let normal = mesh.normals[vertex as usize];
            for (flux, light) in flux.iter_mut().zip(lights) {
                let direction = Vec3::from(*light);
                let cosine = normal.dot(direction);
                if cosine > 0.0 && occluder.is_reached(surface.positions[place], normal, direction, f32::INFINITY) {
                    *flux += transmittance(eta, cosine) * cosine * area;
                }
            }
        }
    };
    parallel::for_chunks(flux.as_mut_slice(), BLOCK * lights.len(), |block, columns| {
        for (place, flux) in (block * BLOCK..).zip(columns.chunks_mut(lights.len())) {
            of_place(place, flux);
        }
        progress.advance((columns.len() / lights.len()) as u64);
    });
    flux
}

/// Fresnel transmittance F_t from air into the material, at an angle of the given cosine.
fn transmittance(eta: f32, cosine: f32) -> f32 {
    1.0 - single(fresnel::reflectance(1.0 / f64::from(eta), f64::from(cosine.min(1.0))))
}
