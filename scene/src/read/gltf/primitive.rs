//! Primitives: vertices and triangles of a mesh, and what puts them into the scene.

use std::borrow::Cow;

use glam::{Mat4, Vec2, Vec3};
use serde::Deserialize;
use serde_json::Value;

use super::accessor::Accessors;
use super::document::{Draco, Primitive};
use super::draco::Stream;
use super::instances::Instances;
use super::skin::vertex_matrices;
use crate::read::raw::{Raw, Result, count};

/// Mode of a primitive that does not say it: three vertices to a triangle. The next two are strips and fans.
const TRIANGLES: usize = 4;

/// What a node does to its mesh.
pub(super) struct Placing {
    pub(super) instances: Instances,
    /// Scene from where a skinned mesh was bound, for each joint. The node of such a mesh does not move it.
    pub(super) joints: Option<Vec<Mat4>>,
}

/// The mesh so far.
pub(super) struct Builder<'a> {
    accessors: Accessors<'a>,
    pub(super) out: Raw,
    has_normals: bool,
    has_uvs: bool,
    /// Primitives that are points or lines.
    thin: usize,
    /// Primitives without positions.
    empty: usize,
}

/// Primitive before it is placed.
struct Local {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    triangles: Vec<[u32; 3]>,
    /// Joints and weights.
    sets: Vec<[Vec<[f32; 4]>; 2]>,
}

/// Map of points, the same of normals, and whether it turns the inside out.
struct Transform {
    points: Mat4,
    normals: Mat4,
    is_mirrored: bool,
}

impl From<Mat4> for Transform {
    fn from(points: Mat4) -> Self {
        Self { points, normals: points.inverse().transpose(), is_mirrored: points.determinant() < 0.0 }
    }
}

/// Where the attributes of a primitive are.
struct Source<'a> {
    accessors: Accessors<'a>,
    primitive: &'a Primitive,
    mode: usize,
    draco: Option<(Stream, Draco)>,
}

impl<'a> Source<'a> {
    fn new(accessors: Accessors<'a>, primitive: &'a Primitive, mode: usize) -> Result<Self> {
        let draco = match primitive.extensions.get("KHR_draco_mesh_compression") {
            None => None,
            Some(extension) => {
                let draco = Draco::deserialize(extension).map_err(|error| format!("Draco: {error}"))?;
                let view = accessors.buffers.view(draco.buffer_view)?;
                Some((Stream::decode(view.bytes)?, draco))
            }
        };
        Ok(Self { accessors, primitive, mode, draco })
    }

    /// Attribute of a name, a vector of N numbers a vertex, if there is one.
    fn get<const N: usize>(&self, name: &str) -> Result<Option<Vec<[f32; N]>>> {
        let Some(&accessor) = self.primitive.attributes.get(name) else {
            return Ok(None);
        };
        let in_stream = self.draco.as_ref().and_then(|(stream, draco)| Some((stream, *draco.attributes.get(name)?)));
        let vectors = match in_stream {
            Some((stream, number)) => stream.vectors(number, self.accessors.is_normalised(accessor)),
            None if name == "POSITION" && self.accessors.is_empty(accessor) => {
                // One that is not there says so itself.
                self.accessors.vectors::<N>(accessor)?;
                Err(format!("accessor {} has no bufferView, so that all is zero", accessor.0))
            }
            None => self.accessors.vectors(accessor),
        };
        vectors.map(Some).map_err(|error| format!("{name}: {error}"))
    }

    fn triangles(&self, vertices: usize) -> Result<Vec<[u32; 3]>> {
        if let Some((stream, _)) = &self.draco {
            return Ok(stream.triangles());
        }
        let indices: Cow<'_, [u32]> = match self.primitive.indices {
            Some(number) => self
                .accessors
                .indices::<1>(number)
                .map_err(|error| format!("indices: {error}"))?
                .into_flattened()
                .into(),
            None => (0..count(vertices)?).collect::<Vec<_>>().into(),
        };
        let mut out = Raw::default();
        match self.mode {
            5 => out.add_strip(&indices),
            6 => out.triangles.extend(indices.windows(2).skip(1).map(|pair| [pair[0], pair[1], indices[0]])),
            _ => out.triangles.extend_from_slice(indices.as_chunks().0),
        }
        Ok(out.triangles)
    }

    fn read(&self, weights: &[f32], is_skinned: bool) -> Result<Local> {
        let positions = self.get("POSITION")?.unwrap_or_default();
        let vertices = positions.len();
        let mut local = Local {
            positions: positions.into_iter().map(Vec3::from_array).collect(),
            normals: self.get("NORMAL")?.unwrap_or_default().into_iter().map(Vec3::from_array).collect(),
            uvs: self.get("TEXCOORD_0")?.unwrap_or_default().into_iter().map(Vec2::from_array).collect(),
            triangles: self.triangles(vertices)?,
            sets: Vec::new(),
        };
        if let Some(index) = local.triangles.iter().flatten().find(|&&index| index as usize >= vertices) {
            return Err(format!("names vertex {index}; there are {vertices}, counted from 0"));
        }
        self.dequantise(&mut local.uvs);
        for uv in &mut local.uvs {
            // glTF counts v downwards.
            uv.y = 1.0 - uv.y;
        }
        for k in (0..).take_while(|_| is_skinned) {
            let set = [self.get(&format!("JOINTS_{k}"))?, self.get(&format!("WEIGHTS_{k}"))?];
            let [Some(joints), Some(weights)] = set else { break };
            local.sets.push([joints, weights]);
        }
        for (target, weight) in self.primitive.targets.iter().zip(weights).filter(|(_, weight)| **weight != 0.0) {
            for (name, values) in [("POSITION", &mut local.positions), ("NORMAL", &mut local.normals)] {
                let Some(&accessor) = target.get(name) else { continue };
                let steps = self.accessors.vectors(accessor).map_err(|error| format!("morph target: {error}"))?;
                for (value, step) in values.iter_mut().zip(steps) {
                    *value += *weight * Vec3::from_array(step);
                }
            }
        }
        Ok(local)
    }

    /// Puts texture coordinates that are stored as integers to where the base colour's texture has them: KHR_mesh_quantization
    /// keeps their scale in KHR_texture_transform.
    fn dequantise(&self, uvs: &mut [Vec2]) {
        let attribute = self.primitive.attributes.get("TEXCOORD_0");
        if attribute.is_none_or(|&accessor| self.accessors.is_float(accessor)) {
            return;
        }
        let material = self.primitive.material.and_then(|material| self.accessors.document.materials.get(material.0));
        let transform = material.and_then(|material| {
            material.pointer("/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform")
        });
        let Some(transform) = transform else { return };
        let pair =
            |name: &str| <[f32; 2]>::deserialize(transform.get(name).unwrap_or(&Value::Null)).map(Vec2::from_array);
        let (scale, offset) = (pair("scale").unwrap_or(Vec2::ONE), pair("offset").unwrap_or(Vec2::ZERO));
        #[allow(clippy::cast_possible_truncation, reason = "an angle")]
        let angle = transform.get("rotation").and_then(Value::as_f64).unwrap_or(0.0) as f32;
        // Counter-clockwise where v counts downwards.
        let turn = Vec2::from_angle(-angle);
        for uv in uvs {
            *uv = offset + turn.rotate(scale * *uv);
        }
    }
}

impl<'a> Builder<'a> {
    pub(super) fn new(accessors: Accessors<'a>) -> Self {
        Self { accessors, out: Raw::default(), has_normals: false, has_uvs: false, thin: 0, empty: 0 }
    }

    /// Adds a primitive, its morph targets weighted, where a node puts it.
    pub(super) fn add(&mut self, primitive: &Primitive, weights: &[f32], placing: &Placing) -> Result<()> {
        let mode = primitive.mode.map_or(TRIANGLES, |mode| mode.0);
        match mode {
            0..=3 => {
                self.thin += 1;
                return Ok(());
            }
            TRIANGLES..=6 => {}
            _ => return Err(format!("mode {mode}; expected 0 to 6")),
        }
        if !primitive.attributes.contains_key("POSITION") {
            self.empty += 1;
            return Ok(());
        }
        let source = Source::new(self.accessors, primitive, mode)?;
        let mut local = source.read(weights, placing.joints.is_some())?;
        if local.triangles.is_empty() {
            return Ok(());
        }
        self.has_normals |= !local.normals.is_empty();
        self.has_uvs |= !local.uvs.is_empty();
        local.normals.resize(local.positions.len(), Vec3::NAN);
        local.uvs.resize(local.positions.len(), Vec2::NAN);
        match &placing.joints {
            Some(joints) if !local.sets.is_empty() => {
                let mut matrices = vertex_matrices(&local.sets, joints)?;
                matrices.resize(local.positions.len(), Mat4::IDENTITY);
                let transforms: Vec<Transform> = matrices.into_iter().map(Transform::from).collect();
                self.place(&local, |vertex| &transforms[vertex])
            }
            _ => {
                // Before there is memory for any.
                count(local.positions.len().saturating_mul(placing.instances.count()))?;
                placing.instances.matrices().try_for_each(|instance| {
                    let transform = Transform::from(instance);
                    self.place(&local, |_| &transform)
                })
            }
        }
    }

    fn place<'t>(&mut self, local: &Local, transform: impl Fn(usize) -> &'t Transform) -> Result<()> {
        let first = count(self.out.positions.len())?;
        count(self.out.positions.len() + local.positions.len())?;
        count(self.out.triangles.len() + local.triangles.len())?;
        for (vertex, (position, normal)) in local.positions.iter().zip(&local.normals).enumerate() {
            let Transform { points, normals, .. } = transform(vertex);
            self.out.positions.push(points.transform_point3(*position).as_dvec3());
            self.out.normals.push(normals.transform_vector3(*normal).normalize_or_zero());
        }
        self.out.uvs.extend_from_slice(&local.uvs);
        self.out.triangles.extend(local.triangles.iter().map(|&[a, b, c]| {
            let turned = if transform(a as usize).is_mirrored { [a, c, b] } else { [a, b, c] };
            turned.map(|index| first + index)
        }));
        Ok(())
    }

    /// The mesh of all primitives.
    pub(super) fn finish(mut self) -> Raw {
        if !self.has_normals {
            self.out.normals.clear();
        }
        if !self.has_uvs {
            self.out.uvs.clear();
        }
        self.out.leave_out(self.thin, "primitives of points or lines");
        self.out.leave_out(self.empty, "primitives without positions");
        self.out
    }
}
