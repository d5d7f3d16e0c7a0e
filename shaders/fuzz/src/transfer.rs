//! Transfers: light as weights of the file's lights, exitance of the vertices, and pictures of the ball as if it were their mesh.

use glam::{Mat4, Vec3};
use subsurf_decoder::Transfer;
use subsurf_decoder::transfer::LightWeights;
use subsurf_scene::Placement;
use subsurf_shaders::cpu::{KernelMesh, shade_transfer, transfer_exitance};
use subsurf_shaders::{TransferLight, transfer_tint};

use crate::are_finite;
use crate::stage::{BACKGROUND, SIZE, stage};

/// Most lights whose weights are solved for.
const MOST_LIGHTS: usize = 12;

/// All that is made of a transfer.
///
/// # Panics
/// If something is no number, or tints are not positive.
pub fn transfer(transfer: &Transfer<'_>) {
    let (stage, header) = (stage(), transfer.header());
    let tint = transfer_tint(transfer);
    assert!(are_finite(&[tint]) && tint.iter().all(|tint| *tint >= 0.0), "{tint:?}");
    let lights = usize::from(header.lights);
    let mut buffer = vec![0.0; LightWeights::buffer_len(lights)];
    if lights > MOST_LIGHTS || LightWeights::new(transfer.lights(), &mut buffer).is_none() {
        return;
    }
    let blocks = stage.blocks(&Placement::of_homogeneous_within(stage.mesh.bounding_sphere(), header.eta));
    let light = TransferLight::new(transfer.lights(), &blocks.scene, &Mat4::IDENTITY, Vec3::ZERO, &stage.reflections());
    let exitance = transfer_exitance(transfer, &light);
    assert_eq!(exitance.len(), header.vertices as usize, "a value for every vertex");
    // As much of the ball as the file has vertices for.
    let is_there = |triangle: &&[u32; 3]| triangle.iter().all(|vertex| *vertex < header.vertices);
    let triangles: Vec<[u32; 3]> = stage.mesh.triangles.iter().filter(is_there).copied().collect();
    let mesh = KernelMesh { triangles: &triangles, ..stage.triangles() };
    let picture = shade_transfer(transfer, &mesh, &blocks, &stage.reflections(), SIZE, BACKGROUND);
    assert_eq!(picture.len(), (SIZE[0] * SIZE[1]) as usize, "a value for every pixel");
}
