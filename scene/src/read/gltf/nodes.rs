//! Nodes: where they put meshes.

use glam::{Mat4, Quat, Vec3};
use serde::Deserialize;
use serde_json::Value;

use super::accessor::Accessors;
use super::document::{Document, Instancing, Node, Whole, named};
use super::primitive::{Builder, Placing};
use super::skin::joint_matrices;
use crate::read::raw::Result;

/// Places of the nodes.
struct Nodes<'a> {
    document: &'a Document,
    /// Scene from node, of those that were visited.
    world: Vec<Option<Mat4>>,
    /// Nodes that are drawn.
    drawn: Vec<usize>,
}

/// Adds all primitives of the scene.
pub(super) fn place(document: &Document, accessors: Accessors<'_>, builder: &mut Builder<'_>) -> Result<()> {
    let mut nodes = Nodes { document, world: vec![None; document.nodes.len()], drawn: Vec::new() };
    let mut is_child = vec![false; document.nodes.len()];
    for &Whole(child) in document.nodes.iter().flat_map(|node| &node.children) {
        if let Some(is_child) = is_child.get_mut(child) {
            *is_child = true;
        }
    }
    let roots: Vec<Whole> = (0..is_child.len()).filter(|&node| !is_child[node]).map(Whole).collect();
    // Without scenes, all nodes are drawn.
    let scene = document.scene.unwrap_or_default().0;
    match document.scenes.get(scene) {
        Some(scene) => nodes.visit(&scene.nodes, true)?,
        None if document.scenes.is_empty() => nodes.visit(&roots, true)?,
        None => return Err(format!("names scene {scene}; there are {}, counted from 0", document.scenes.len())),
    }
    // Joints may be outside of the scene.
    nodes.visit(&roots, false)?;

    for &number in &nodes.drawn {
        let node = &document.nodes[number];
        let Some(mesh) = node.mesh else {
            continue;
        };
        let at = |error: String| format!("node {number}: {error}");
        let mesh_of = named(&document.meshes, "mesh", mesh).map_err(at)?;
        let world = nodes.world[number].unwrap_or(Mat4::IDENTITY);
        let placing = Placing {
            instances: instances(node, accessors).map_err(at)?.into_iter().map(|local| world * local).collect(),
            joints: node.skin.map(|skin| nodes.joints(skin, accessors)).transpose().map_err(at)?,
        };
        let weights = node.weights.as_deref().or(mesh_of.weights.as_deref()).unwrap_or(&[]);
        for (k, primitive) in mesh_of.primitives.iter().enumerate() {
            let added = builder.add(primitive, weights, &placing);
            added.map_err(|error| format!("mesh {}, primitive {k}: {error}", mesh.0))?;
        }
    }
    Ok(())
}

impl Nodes<'_> {
    /// Visits nodes and all below them, the last first; for drawing, or else for their places, once is enough.
    fn visit(&mut self, roots: &[Whole], for_drawing: bool) -> Result<()> {
        let mut stack: Vec<_> = roots.iter().map(|&Whole(node)| (node, Mat4::IDENTITY, for_drawing)).collect();
        while let Some((number, parent, is_drawn)) = stack.pop() {
            let node = named(&self.document.nodes, "node", Whole(number))?;
            let world = parent * local(node);
            if !for_drawing && self.world[number].is_some() {
                continue;
            }
            if self.world[number].replace(world).is_some() {
                return Err(format!("node {number} is in the scene twice; nodes make a tree"));
            }
            let is_drawn = is_drawn && !is_hidden(node);
            if is_drawn {
                self.drawn.push(number);
            }
            stack.extend(node.children.iter().map(|&Whole(child)| (child, world, is_drawn)));
        }
        Ok(())
    }

    fn joints(&self, skin: Whole, accessors: Accessors<'_>) -> Result<Vec<Mat4>> {
        let of = named(&self.document.skins, "skin", skin)?;
        joint_matrices(accessors, of, &self.world).map_err(|error| format!("skin {}: {error}", skin.0))
    }
}

/// Parent from node.
fn local(node: &Node) -> Mat4 {
    let from_parts = || {
        Mat4::from_scale_rotation_translation(
            node.scale.map_or(Vec3::ONE, Vec3::from),
            node.rotation.map_or(Quat::IDENTITY, Quat::from_array),
            node.translation.map_or(Vec3::ZERO, Vec3::from),
        )
    };
    node.matrix.map_or_else(from_parts, |matrix| Mat4::from_cols_array(&matrix))
}

/// KHR_node_visibility.
fn is_hidden(node: &Node) -> bool {
    node.extensions.get("KHR_node_visibility").and_then(|extension| extension.get("visible"))
        == Some(&Value::Bool(false))
}

/// Node from each instance (EXT_mesh_gpu_instancing); the node itself if there are none.
fn instances(node: &Node, accessors: Accessors<'_>) -> Result<Vec<Mat4>> {
    let Some(extension) = node.extensions.get("EXT_mesh_gpu_instancing") else {
        return Ok(vec![Mat4::IDENTITY]);
    };
    let Instancing { attributes } = Instancing::deserialize(extension).map_err(|error| error.to_string())?;
    let of = |name: &str| attributes.get(name).copied();
    let translations = of("TRANSLATION").map(|number| accessors.vectors(number)).transpose()?;
    let rotations = of("ROTATION").map(|number| accessors.vectors(number)).transpose()?;
    let scales = of("SCALE").map(|number| accessors.vectors(number)).transpose()?;
    let counts = [translations.as_ref().map(Vec::len), rotations.as_ref().map(Vec::len), scales.as_ref().map(Vec::len)];
    // Attributes that are not of places, such as colours, do not count instances.
    let count = counts.into_iter().flatten().min().unwrap_or(1);
    let matrix = |k: usize| {
        Mat4::from_scale_rotation_translation(
            scales.as_ref().map_or(Vec3::ONE, |scales| Vec3::from_array(scales[k])),
            rotations.as_ref().map_or(Quat::IDENTITY, |rotations| Quat::from_array(rotations[k]).normalize()),
            translations.as_ref().map_or(Vec3::ZERO, |translations| Vec3::from_array(translations[k])),
        )
    };
    Ok((0..count).map(matrix).collect())
}
