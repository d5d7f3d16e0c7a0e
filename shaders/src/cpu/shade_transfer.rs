//! Twin of `shade_transfer.wgsl`.

use glam::Vec3;
use subsurf_decoder::Transfer;
use subsurf_decoder::transfer::LightWeights;
use subsurf_scene::MAX_LIGHTS;

use super::raster::rasterise;
use super::shading::{Point, shaded};
use super::{KernelMesh, Reflections};
use crate::rgb::Rgb;
use crate::uniform::Blocks;
use crate::{TransferLight, transfer_tint};

/// Exitance of all vertices of a mesh under some light, at least 0, linear Rec. 709.
///
/// # Panics
/// If two lights of the file are one.
#[must_use]
pub fn transfer_exitance(transfer: &Transfer<'_>, light: &TransferLight) -> Vec<Rgb> {
    let header = transfer.header();
    let mut buffer = vec![0.0; LightWeights::buffer_len(header.lights.into())];
    let between = LightWeights::new(transfer.lights(), &mut buffer).expect("lights that are several");
    let (weights, tint) = (light.weights(&between), transfer_tint(transfer));
    let channels = usize::from(header.channels);
    let mut table = vec![0.0; header.table_len()];
    let mut found = vec![[0.0; 3]; header.vertices as usize];
    let mut exitance = vec![0.0; channels * found.len()];
    for c in 0..3 {
        transfer.light_table(&weights.iter().map(|rgb| tint[c] * rgb[c]).collect::<Vec<f32>>(), &mut table);
        transfer.exitance(&table, 0, &mut exitance);
        for (rgb, exitance) in found.iter_mut().zip(exitance.chunks_exact(channels)) {
            rgb[c] = exitance[c.min(channels - 1)].max(0.0);
        }
    }
    found
}

/// Picture of a mesh in display values, `size` pixels, row by row from the top, in front of a `background`; nothing is in shadow but by
/// the mesh itself, which does not hide what the coat reflects.
///
/// # Panics
/// If the file is of fewer vertices, or two of its lights are one.
#[must_use]
pub fn shade_transfer(
    transfer: &Transfer<'_>,
    mesh: &KernelMesh<'_>,
    blocks: &Blocks,
    reflections: &Reflections<'_>,
    size: [u32; 2],
    background: [u8; 3],
) -> Vec<[u8; 3]> {
    let (scene, transform) = (&blocks.scene, glam::Mat4::from_cols_array_2d(&blocks.object.world_from_mesh));
    let light = TransferLight::new(transfer.lights(), scene, &transform, scene.centre_mm.into(), reflections);
    let exitances: Vec<Vec3> = transfer_exitance(transfer, &light).into_iter().map(Vec3::from).collect();
    rasterise(mesh.positions, mesh.triangles, &scene.clip_from_world, size, background, |covered| {
        let point = Point {
            position_mm: covered.blend(mesh.positions),
            normal: covered.blend(mesh.normals),
            exitance: covered.blend(&exitances),
            visibility: [1.0; MAX_LIGHTS],
        };
        shaded(blocks, reflections, &point)
    })
}
