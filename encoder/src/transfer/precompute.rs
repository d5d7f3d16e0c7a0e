//! From a mesh and a profile to q.

use nalgebra::DMatrix;
use subsurf_scene::Mesh;

use super::gather::Gather;
use super::irradiance::entered;
use super::rd_table::RdTable;
use super::surface::Surface;
use crate::error::{Error, Result};
use crate::memory;
use crate::progress::Progress;

/// Radius of a ball of places by its distance below which they are taken together. At 0.12 sums are within 0.3 % of the brightest
/// of the exact ones (a test holds it).
const SPREAD: f32 = 0.12;
/// Share of the area that may be too coarse for a material without a warning. It is too coarse where neighbours are farther apart than
/// the radius within which half of the light leaves: most of what a vertex sends then stays with it.
const COARSE: f32 = 0.05;

/// What is precomputed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// 3 for red, green and blue; 1 for their mean, which is less work.
    pub channels: usize,
    /// Refractive index of the material against air, 1 to 4.
    pub eta: f32,
}

/// Exitance q at the vertices of a mesh for some directions of light.
///
/// q is the radiant exitance at a vertex, without the boundary on the way out, under directional light of irradiance 1 on a plane
/// across it: 0 to about 1.
#[derive(Clone, Debug)]
pub struct Precomputed {
    /// Unit directions towards the lights.
    pub lights: Vec<[f32; 3]>,
    /// 1 or 3.
    pub channels: usize,
    /// q, `[channel · lights + light × place]`.
    pub q: DMatrix<f32>,
    /// Place of each vertex of the mesh, a column of `q`.
    pub place_of: Vec<u32>,
}

impl Precomputed {
    /// Number of lights.
    #[must_use]
    pub fn light_count(&self) -> usize {
        self.lights.len()
    }

    /// The same for some of the lights, by their numbers.
    #[must_use]
    pub fn select(&self, lights: &[usize]) -> Self {
        let all = self.lights.len();
        let rows: Vec<usize> =
            (0..self.channels).flat_map(|c| lights.iter().map(move |light| c * all + light)).collect();
        Self {
            lights: lights.iter().map(|light| self.lights[*light]).collect(),
            channels: self.channels,
            q: self.q.select_rows(&rows),
            place_of: self.place_of.clone(),
        }
    }
}

/// Exitance at every vertex of a mesh in mm, for light from each of `lights`, unit vectors towards it. Vertices of one place get
/// one value. Warns when the mesh is too coarse for the material.
///
/// Takes about 10 + 4 channels bytes of memory per light and place.
///
/// # Errors
/// [`Error::Request`] for no lights, channels or an η that there are not, and where memory does not suffice.
pub fn precompute(
    mesh: &Mesh,
    table: &RdTable,
    lights: &[[f32; 3]],
    options: &Options,
    progress: &dyn Progress,
) -> Result<Precomputed> {
    if lights.is_empty() || !matches!(options.channels, 1 | 3) || !(1.0..=4.0).contains(&options.eta) {
        return Err(Error::Request(format!(
            "{} lights, {} channels, a refractive index of {}; expected some lights, 1 or 3 channels, an index from 1 to 4",
            lights.len(),
            options.channels,
            options.eta
        )));
    }
    let surface = Surface::new(mesh);
    let places = surface.len();
    // Flux of places and of nodes, of which there are about 0.3 to a place, q, and a portion of q; triangles by place and in a tree.
    let bytes = places as u64 * (lights.len() as u64 * (10 + 4 * options.channels as u64) + 200);
    memory::expect(bytes, || format!("scattering of {} lights at {places} places", lights.len()))?;
    let half = table.half_radius_mm();
    let coarse = surface.coarser_than(half);
    if coarse > COARSE {
        progress.warn(&format!(
            "vertices are more than {half:.3} mm apart on {:.0} % of the surface, and half of the light leaves within that: the mesh is too \
             coarse for the material there, subdivide it",
            100.0 * coarse
        ));
    }
    progress.begin("light that enters", places as u64);
    let flux = entered(mesh, &surface, lights, options.eta, progress);
    progress.begin("light that leaves", places as u64);
    let grey;
    let table = if options.channels == 1 {
        grey = table.grey();
        &grey
    } else {
        table
    };
    let gather = Gather::new(&surface, &flux, table, options.channels);
    let q = gather.hierarchical(SPREAD, progress);
    let total: f64 = q.iter().map(|value| f64::from(*value)).sum();
    if !total.is_finite() || total <= 0.0 {
        return Err(Error::Request(
            "no light leaves the mesh, or more than numbers hold: are its normals turned inwards, or its size not in mm?".to_owned(),
        ));
    }
    Ok(Precomputed { lights: lights.to_vec(), channels: options.channels, q, place_of: surface.place_of })
}

#[cfg(test)]
mod tests {
    use glam::{Vec3, Vec3Swizzles};
    use subsurf_scene::{knot, plate, sphere};

    use super::*;
    use crate::kernel::Profile;
    use crate::simulate::diffusion::Medium;
    use crate::transfer::fibonacci;

    fn marble() -> RdTable {
        RdTable::of(&Profile::dipole(&Medium::measured("marble").unwrap(), 1.5).unwrap()).unwrap()
    }

    #[test]
    fn the_hierarchy_gives_the_exact_sum() {
        let mesh = knot(10.0, 3.0, 24).fitted(20.0).unwrap();
        let (surface, table, lights) = (Surface::new(&mesh), marble(), fibonacci(12));
        let flux = entered(&mesh, &surface, &lights, 1.5, &());
        let gather = Gather::new(&surface, &flux, &table, 3);
        let (exact, quick) = (gather.exact(), gather.hierarchical(SPREAD, &()));
        let difference = &exact - &quick;
        let rms = difference.norm() / (exact.len() as f32).sqrt();
        println!("{} places: rms {rms:.2e}, max {:.2e} of {:.3}", surface.len(), difference.amax(), exact.amax());
        assert!(difference.amax() < 0.003 * exact.amax(), "{} of {}", difference.amax(), exact.amax());
        assert!(difference.norm() > 0.0, "far places were taken together");
        let rough = gather.hierarchical(0.6, &());
        assert!((&exact - rough).norm() > 3.0 * difference.norm(), "a wider spread is rougher");
    }

    #[test]
    fn a_plate_reflects_what_the_profile_does() {
        // Wide and thick beside the radius within which almost all light leaves.
        let profile = Profile::dipole(&Medium::measured("ketchup").unwrap(), 1.3).unwrap();
        let table = RdTable::of(&profile).unwrap();
        let mesh = plate(30.0, 15.0, 40).subdivided(1.2).unwrap();
        let up = [0.0, 1.0, 0.0];
        let options = Options { channels: 3, eta: 1.3 };
        let of = precompute(&mesh, &table, &[up], &options, &()).unwrap();
        let middle = mesh
            .positions
            .iter()
            .zip(&of.place_of)
            .filter(|(at, _)| at.y > -0.1 && (2.0..8.0).contains(&at.xz().length()));
        let mirrored = ((1.3_f32 - 1.0) / 2.3).powi(2);
        let (mut sum, mut count) = ([0.0; 3], 0.0);
        for (_, place) in middle {
            sum = [0, 1, 2].map(|c| sum[c] + of.q[(c, *place as usize)]);
            count += 1.0;
        }
        for c in 0..3 {
            let expected = table.reflectance()[c] * (1.0 - mirrored);
            let found = sum[c] / count;
            assert!((found - expected).abs() < 0.05 * expected, "channel {c}: {found} of {expected}");
        }
    }

    #[test]
    fn seams_get_one_value_and_send_as_one_surface() {
        let whole = sphere(5.0, 12);
        let lights = fibonacci(5);
        let options = Options { channels: 1, eta: 1.5 };
        let of = |mesh: &Mesh| precompute(mesh, &marble(), &lights, &options, &()).unwrap();
        // The same triangles, each with corners of its own, which are in one place, or apart as by rounding.
        let corner = |of: &[Vec3]| whole.triangles.iter().flatten().map(|k| of[*k as usize]).collect::<Vec<Vec3>>();
        let triangles = (0..u32::try_from(whole.triangles.len()).unwrap()).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]);
        let whole_q = of(&whole);
        for (apart_mm, bound) in [(0.0, 1e-5), (2e-6, 1e-4)] {
            let mut corners = corner(&whole.positions);
            for (at, sign) in corners.iter_mut().zip([0.0, 1.0, -1.0].into_iter().cycle()) {
                *at += sign * apart_mm;
            }
            let triangles = triangles.clone().collect();
            let apart_q = of(&Mesh::new(corners, corner(&whole.normals), None, triangles, 1.0).unwrap());
            let mut most = 0.0_f32;
            for (corner, vertex) in whole.triangles.iter().flatten().enumerate() {
                let [a, b] = [
                    whole_q.q.column(whole_q.place_of[*vertex as usize] as usize),
                    apart_q.q.column(apart_q.place_of[corner] as usize),
                ];
                most = most.max((a - b).amax());
            }
            assert!(most < bound * whole_q.q.amax(), "{apart_mm}: {most} of {}", whole_q.q.amax());
        }
    }

    #[test]
    fn coarse_meshes_are_told() {
        struct Warnings(std::sync::Mutex<Vec<String>>);
        impl Progress for Warnings {
            fn begin(&self, _: &str, _: u64) {}
            fn advance(&self, _: u64) {}
            fn warn(&self, message: &str) {
                self.0.lock().unwrap().push(message.to_owned());
            }
        }
        let options = Options { channels: 1, eta: 1.5 };
        let fine = sphere(2.0, 40);
        // Almost all vertices are close to each other, but on a third of the area; and on all but some 3 % of it.
        let (mixed, small) = (fine.clone().with(sphere(1.8, 4)), sphere(10.0, 60).with(sphere(1.8, 4)));
        for (mesh, is_coarse) in [(&sphere(100.0, 16), true), (&fine, false), (&mixed, true), (&small, false)] {
            let warnings = Warnings(Default::default());
            precompute(mesh, &marble(), &[[0.0, 1.0, 0.0]], &options, &warnings).unwrap();
            let warnings = warnings.0.into_inner().unwrap();
            assert_eq!(!warnings.is_empty(), is_coarse, "{warnings:?}");
        }
        let none = Options { channels: 2, ..options };
        assert!(precompute(&sphere(1.0, 8), &marble(), &[[0.0, 1.0, 0.0]], &none, &()).is_err(), "two channels");
    }
}
