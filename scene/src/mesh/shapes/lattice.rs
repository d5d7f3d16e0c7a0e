//! Lattices of quads that shapes are bent from.

use glam::{Vec2, Vec3};

use crate::mesh::triangles::Mesh;

/// Number of quads around a rounded edge.
pub(super) const EDGE: u16 = 8;

/// Mesh of `columns` × `rows` equal quads in u and v; `place` gives position and normal.
pub(super) fn grid([columns, rows]: [u16; 2], place: impl Fn(Vec2) -> (Vec3, Vec3)) -> Mesh {
    lattice(&spans(&[(1.0, columns)]), &spans(&[(1.0, rows)]), place)
}

/// Borders of steps from 0 to 1; of each span is given its length in any unit and its number of steps.
pub(super) fn spans(spans: &[(f32, u16)]) -> Vec<f32> {
    let length: f32 = spans.iter().map(|(length, _)| length).sum();
    let mut borders = vec![0.0];
    let mut start = 0.0;
    for &(span, steps) in spans {
        borders.extend((1..=steps).map(|k| (start + span * f32::from(k) / f32::from(steps)) / length));
        start += span;
    }
    borders
}

/// Mesh of quads between all given u and v, each growing; `place` gives position and normal.
pub(super) fn lattice(us: &[f32], vs: &[f32], place: impl Fn(Vec2) -> (Vec3, Vec3)) -> Mesh {
    let uvs: Vec<Vec2> = vs.iter().flat_map(|v| us.iter().map(|u| Vec2::new(*u, *v))).collect();
    let (positions, normals) = uvs.iter().map(|uv| place(*uv)).unzip();
    let index = |k: usize| u32::try_from(k).expect("sides of fewer than 2¹⁶ quads");
    let (stride, rows) = (index(us.len()), index(vs.len()));
    let quads = (0..rows - 1).flat_map(|y| (0..stride - 1).map(move |x| y * stride + x));
    let triangles = quads.flat_map(|a| [[a, a + 1, a + stride], [a + 1, a + stride + 1, a + stride]]).collect();
    Mesh { positions, normals, uvs: Some(uvs), sides: None, triangles }
}
