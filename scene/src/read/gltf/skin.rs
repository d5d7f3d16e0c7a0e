//! Skins: vertices that several nodes move.

use glam::Mat4;

use super::accessor::Accessors;
use super::document::{Skin, Whole, named};
use crate::read::raw::Result;

/// Matrix of each joint: from where a vertex was bound to where it is in the scene.
pub(super) fn joint_matrices(accessors: Accessors<'_>, skin: &Skin, world: &[Option<Mat4>]) -> Result<Vec<Mat4>> {
    let bound = match skin.inverse_bind_matrices {
        Some(number) => accessors.vectors::<16>(number)?,
        None => Vec::new(),
    };
    let joint = |(k, &node): (usize, &Whole)| {
        let world = named(world, "node", node)?;
        let bound = bound.get(k).map_or(Mat4::IDENTITY, Mat4::from_cols_array);
        Ok(world.unwrap_or(Mat4::IDENTITY) * bound)
    };
    skin.joints.iter().enumerate().map(joint).collect()
}

/// Means of the matrices of joints, one for each vertex. `sets` are joints and weights, four a vertex in each.
pub(super) fn vertex_matrices(sets: &[[Vec<[f32; 4]>; 2]], joints: &[Mat4]) -> Result<Vec<Mat4>> {
    let count = sets.iter().flatten().map(Vec::len).min().unwrap_or(0);
    (0..count).map(|vertex| vertex_matrix(sets, vertex, joints)).collect()
}

fn vertex_matrix(sets: &[[Vec<[f32; 4]>; 2]], vertex: usize, joints: &[Mat4]) -> Result<Mat4> {
    let (mut sum, mut total) = (Mat4::ZERO, 0.0);
    for [numbers, weights] in sets {
        for (number, &weight) in numbers[vertex].iter().zip(&weights[vertex]) {
            if weight != 0.0 {
                #[allow(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "joints have numbers of 16 bits"
                )]
                let joint = joints.get(*number as usize);
                let joint = joint.ok_or_else(|| format!("vertex {vertex} names joint {number} of {}", joints.len()))?;
                sum += *joint * weight;
                total += weight;
            }
        }
    }
    // Weights add up to 1, but for rounding; a vertex without any follows the first joint.
    Ok(if total == 0.0 { joints.first().copied().unwrap_or(Mat4::IDENTITY) } else { sum * (1.0 / total) })
}
