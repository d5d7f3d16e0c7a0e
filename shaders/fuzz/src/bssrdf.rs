//! BSSRDFs: what replaces them (mean profile, basis, sums over profiles), gathers on a patch and on a mesh.

use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::basis::MAX_GAUSSIANS;
use subsurf_scene::{Mapping, MeanProfile, Placement, SurfacePoints};
use subsurf_shaders::cpu::{Triangles, gather, irradiance, profile_sums, shade_vertex, surface_gather};
use subsurf_shaders::separable::{ProfileSums, ProjectedBasis};
use subsurf_shaders::uniform::{BlurStage, MOST_TAPS, Material, Transmission};
use subsurf_shaders::{mean_kernel, softening_gain};

use crate::are_finite;
use crate::stage::{BACKGROUND, SIZE, stage};

/// Largest window whose sums are made: they take its square for every pixel.
const MOST_RADIUS: u16 = 3;
/// Largest patch.
const MOST_PIXELS: u64 = 64;
/// Relative difference of sums in another order.
const ROUNDING: f32 = 1e-4;

/// All that is made of a BSSRDF.
///
/// # Panics
/// If something is no number, or not what the decoder says.
pub fn bssrdf(material: &Bssrdf<'_>) {
    let header = material.header();
    let block = Material::new(header, 1);
    assert!(block.nodes_per_mm.is_finite() && block.nodes_per_mm > 0.0, "{block:?}");
    if header.window_radius > MOST_RADIUS || u64::from(header.pixels()) > MOST_PIXELS {
        return;
    }
    let fade_mm = [2.0, 3.2].map(|pixels| pixels * header.pitch_mm);
    let gain = softening_gain(&MeanProfile::of(material), header, fade_mm);
    assert!(gain.as_flattened().iter().all(|gain| gain.is_finite() && *gain >= 0.0), "{gain:?}");
    let kernel = mean_kernel(material);
    assert!(kernel.len() == usize::from(header.window_radius) + 1 && are_finite(&kernel), "{kernel:?}");

    let sums = ProfileSums::albedo(material);
    let albedos = profile_sums(material, &sums);
    // Of the brightest profiles they are infinite.
    assert!(albedos[0].as_flattened().iter().all(|albedo| *albedo >= 0.0), "{albedos:?}");
    patch(material);
    if let Some(basis) = ProjectedBasis::of(material) {
        separable(&basis);
    }
    ball(material);
}

/// Gather of a patch under light of 1: the albedos, where it says what lies beyond its border.
fn patch(material: &Bssrdf<'_>) {
    let header = material.header();
    let size = [header.width, header.height];
    let found = gather(material, &vec![[1.0; 3]; header.pixels() as usize], [0; 2], size);
    let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x, y].map(u32::cast_signed)));
    for (pixel, found) in pixels.zip(&found) {
        let albedo = material.albedo(pixel);
        for c in 0..3 {
            let (found, albedo) = (found[c], albedo[c]);
            let is_same = (found - albedo).abs() <= ROUNDING * albedo || (found.is_infinite() && albedo.is_infinite());
            assert!(is_same, "{found} gathered, an albedo of {albedo} at {pixel:?}");
        }
    }
}

/// Blocks and pictures of a separable basis, as it is, without heterogeneity and without scattering.
fn separable(basis: &ProjectedBasis) {
    for basis in [basis, &basis.homogeneous(), &basis.opaque()] {
        let numbers = basis.numbers();
        let (stages, gaussians) = (BlurStage::cascade(numbers), numbers.size().gaussians);
        assert!(stages.len() == gaussians && gaussians <= MAX_GAUSSIANS, "{gaussians} Gaussians");
        for [stage, _] in &stages {
            assert!(stage.sigma.is_finite() && stage.sigma > 0.0 && stage.taps > 0 && stage.stride > 0, "{stage:?}");
            assert!([0.0, 1e-3, 1.0, 1e9].iter().all(|scale| stage.screen_taps(*scale) <= MOST_TAPS as u32));
            assert!(stage.in_volume(1.0, 0.9, true)[0].step > 0.0, "{stage:?}");
        }
        assert_eq!(Transmission::new(numbers).gaussians as usize, gaussians);
        let texels = numbers.sums().texels();
        assert!(texels.as_flattened().iter().all(|value| value.is_finite()), "{texels:?}");
        let lit = basis.exitance(&basis.albedo());
        assert_eq!(lit.len(), basis.coefficients_of(0).len(), "a value for every pixel");
    }
}

/// Picture of the ball by gathering.
fn ball(material: &Bssrdf<'_>) {
    let (stage, header) = (stage(), material.header());
    let blocks = stage.blocks(&Placement::new(&stage.mesh, Mapping::Box, header));
    let points = SurfacePoints::new(&stage.mesh, Mapping::Box, header, &stage.visibilities);
    let light = irradiance(&blocks, &points);
    assert!(are_finite(&light), "light that enters");
    let exitances = points.of_vertices(&surface_gather(material, &points, &light));
    let triangles = Triangles {
        positions: &stage.mesh.positions,
        normals: &stage.mesh.normals,
        exitances: &exitances,
        visibilities: &stage.visibilities,
        triangles: &stage.mesh.triangles,
    };
    let picture = shade_vertex(&triangles, &blocks, &stage.reflections(), SIZE, BACKGROUND);
    assert!(picture.iter().any(|pixel| *pixel != BACKGROUND), "the ball is in the picture");
}
