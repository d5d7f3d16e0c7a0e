//! Nodes: where they put meshes.

use glam::{Mat4, Quat, Vec3};
use serde_json::Value;

use super::accessor::Accessors;
use super::document::{Document, Node, Whole, named};
use super::instances::Instances;
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
            instances: Instances::new(node, world, accessors).map_err(at)?,
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
