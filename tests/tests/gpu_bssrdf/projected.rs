//! What is drawn over a patch when its file is loaded.

use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::Addressing;
use subsurf_decoder::bssrdf::basis::BasisSize;
use subsurf_encoder::bssrdf::basis::{BasisChoice, BasisOptions, add_basis};
use subsurf_runtime::{Backend, Load};
use subsurf_shaders::cpu;
use subsurf_shaders::separable::{ProfileSums, ProjectedBasis};
use subsurf_tests::shape;

use crate::{FITTED, HALF_ULP, SUM_TOLERANCE, file, open};

/// Layers over the patch are drawn when a file is loaded: coefficients, albedo and all their levels, held to the twins.
fn projected(backend: Backend) {
    let gpu = open(backend);
    let size = [23, 17];
    for layout in FITTED {
        let file = file(layout, &shape(size, 4, Addressing::Repeat));
        let material = Bssrdf::parse(&file).unwrap();
        let splats = Load::splat(&gpu, &material).unwrap().finish().unwrap();
        let albedo = cpu::profile_sums(&material, &ProfileSums::albedo(&material)).remove(0);
        assert_levels(&format!("{backend}, {layout:?}, albedo"), albedo, size, 1.0, |level| {
            splats.read_albedo(&gpu, level).unwrap()
        });

        let choice = BasisChoice::Size(BasisSize { terms: 2, gaussians: 3 });
        let file = add_basis(&file, &BasisOptions { choice, steps: 1 }, &()).unwrap();
        let material = Bssrdf::parse(&file).unwrap();
        let basis = ProjectedBasis::of(&material).unwrap();
        let uploaded = Load::separable(&gpu, &material, basis.numbers()).unwrap().finish().unwrap();
        // As in `separable`: every map on the way is rounded, with weights of both signs.
        let layers = [(basis.coefficients_of(0).to_vec(), 1.0), (basis.coefficients_of(1).to_vec(), 1.0)];
        for (l, (expected, ulps)) in layers.into_iter().chain([(basis.albedo(), 9.0)]).enumerate() {
            assert_levels(&format!("{backend}, {layout:?}, layer {l}"), expected, size, ulps, |level| {
                uploaded.read(&gpu, l, level).unwrap()
            });
        }
        // Splats of a file with a basis take their albedo from it.
        let splats = Load::splat(&gpu, &material).unwrap().finish().unwrap();
        assert_levels(&format!("{backend}, {layout:?}, albedo by basis"), basis.albedo(), size, 9.0, |level| {
            splats.read_albedo(&gpu, level).unwrap()
        });
    }
}

/// Holds all levels of a layer to means of its finest, within so many roundings of the largest value and one more a level.
fn assert_levels(
    what: &str,
    mut expected: Vec<[f32; 3]>,
    mut size: [u32; 2],
    ulps: f32,
    read: impl Fn(u32) -> Vec<[f32; 3]>,
) {
    let largest = expected.iter().flatten().map(|value| value.abs()).fold(0.0, f32::max);
    for level in 0..=size[0].max(size[1]).ilog2() {
        let found = read(level);
        assert_eq!(found.len(), expected.len(), "{what}, level {level}");
        let errors = found.iter().flatten().zip(expected.iter().flatten()).map(|(a, b)| (a - b).abs() / largest);
        let worst = errors.fold(0.0, f32::max);
        let roundings = ulps + level as f32;
        assert!(worst <= roundings * HALF_ULP + SUM_TOLERANCE, "{what}, level {level}: {worst:.2e}");
        (expected, size) = cpu::patch_reduce(&expected, size);
    }
}

#[test]
fn projected_on_vulkan() {
    projected(Backend::Vulkan);
}

#[test]
fn projected_on_gles_3_0() {
    projected(Backend::Gl);
}
