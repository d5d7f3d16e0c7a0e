//! Instances of a node's mesh (EXT_mesh_gpu_instancing).

use glam::{Mat4, Quat, Vec3};
use serde::Deserialize;

use super::accessor::Accessors;
use super::document::{Instancing, Node};
use crate::read::raw::Result;

/// Where the instances of a mesh are. Small files can claim many: each is placed when it is asked for.
pub(super) struct Instances {
    /// Scene from node.
    world: Mat4,
    translations: Option<Vec<[f32; 3]>>,
    rotations: Option<Vec<[f32; 4]>>,
    scales: Option<Vec<[f32; 3]>>,
    count: usize,
}

impl Instances {
    /// Those of a node that is at `world`; the node itself if it says nothing of them.
    pub(super) fn new(node: &Node, world: Mat4, accessors: Accessors<'_>) -> Result<Self> {
        let mut out = Self { world, translations: None, rotations: None, scales: None, count: 1 };
        let Some(extension) = node.extensions.get("EXT_mesh_gpu_instancing") else {
            return Ok(out);
        };
        let Instancing { attributes } = Instancing::deserialize(extension).map_err(|error| error.to_string())?;
        let of = |name: &str| attributes.get(name).copied();
        out.translations = of("TRANSLATION").map(|number| accessors.vectors(number)).transpose()?;
        out.rotations = of("ROTATION").map(|number| accessors.vectors(number)).transpose()?;
        out.scales = of("SCALE").map(|number| accessors.vectors(number)).transpose()?;
        let counts = [
            out.translations.as_ref().map(Vec::len),
            out.rotations.as_ref().map(Vec::len),
            out.scales.as_ref().map(Vec::len),
        ];
        // Attributes that are not of places, such as colours, do not count instances.
        out.count = counts.into_iter().flatten().min().unwrap_or(1);
        Ok(out)
    }

    /// Number of instances.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// Scene from each instance.
    pub(super) fn matrices(&self) -> impl Iterator<Item = Mat4> {
        let local = |k: usize| {
            Mat4::from_scale_rotation_translation(
                self.scales.as_ref().map_or(Vec3::ONE, |scales| Vec3::from_array(scales[k])),
                self.rotations.as_ref().map_or(Quat::IDENTITY, |rotations| Quat::from_array(rotations[k]).normalize()),
                self.translations.as_ref().map_or(Vec3::ZERO, |translations| Vec3::from_array(translations[k])),
            )
        };
        (0..self.count).map(move |k| self.world * local(k))
    }
}
