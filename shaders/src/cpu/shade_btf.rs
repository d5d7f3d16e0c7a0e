//! Twin of `shade_btf.wgsl`, `btf_texture.wgsl`, `btf_tangents.wgsl` and `btf_ambient.wgsl`; that of the other BTF files is the decoder.

use std::f32::consts::PI;

use glam::{Vec2, Vec3, Vec4};
use subsurf_decoder::NestedBtf;
use subsurf_decoder::btf::{Texel, View};
use subsurf_scene::MAX_LIGHTS;

use super::raster::{Covered, rasterise};
use super::{Reflections, display, incident, neutral, srgb};
use crate::uniform::{BtfFiltering, Scene};

/// Material of a BTF, and how it is filtered.
#[derive(Clone, Copy, Debug)]
pub struct BtfSurface<'a> {
    /// The file.
    pub btf: &'a NestedBtf<'a>,
    /// Number of the material.
    pub material: usize,
    /// Which texels a pixel shows.
    pub filtering: BtfFiltering,
    /// Number of samples of the environment for a pixel.
    pub samples: u32,
}

/// Mesh with tangents.
#[derive(Clone, Copy, Debug)]
pub struct BtfTriangles<'a> {
    /// Positions of the vertices in mm.
    pub positions: &'a [Vec3],
    /// Unit normals of the vertices.
    pub normals: &'a [Vec3],
    /// Texture coordinates in copies of the material, v down.
    pub uvs: &'a [Vec2],
    /// Unit vectors along the rows of the material; in the fourth place, 1 if normal × tangent goes down its columns, −1 if up.
    pub tangents: &'a [Vec4],
    /// Visibility of each light from the vertices, 0 to 1.
    pub visibilities: &'a [[f32; MAX_LIGHTS]],
    /// Numbers of the vertices of the triangles.
    pub triangles: &'a [[u32; 3]],
}

/// Picture of a mesh in display values, `size` pixels, row by row from the top, in front of a `background`.
///
/// # Panics
/// If an index leads outside the vertices, or there is no such material.
#[must_use]
pub fn shade_btf(
    mesh: &BtfTriangles<'_>,
    surface: &BtfSurface<'_>,
    scene: &Scene,
    reflections: &Reflections<'_>,
    size: [u32; 2],
    background: [u8; 3],
) -> Vec<[u8; 3]> {
    rasterise(mesh.positions, mesh.triangles, &scene.clip_from_world, size, background, |covered| {
        let visibility = covered.blend_all(mesh.visibilities);
        let light = light_of(mesh, surface, scene, reflections, covered, visibility) / PI * scene.exposure;
        display(srgb(neutral(light.into())))
    })
}

/// Tangent frame in world space: unit vectors along the rows of the material, down its columns, and along its normal.
struct Tangents([Vec3; 3]);

impl Tangents {
    /// Frame for the side that is seen, whichever way the triangle winds: `plane` is any normal of it.
    fn new(normal: Vec3, tangent: Vec4, plane: Vec3, to_eye: Vec3) -> Self {
        let normal = normal.normalize();
        let x = (tangent.truncate() - normal * tangent.truncate().dot(normal)).normalize();
        let y = normal.cross(x) * if tangent.w >= 0.0 { 1.0 } else { -1.0 };
        let side = normal.dot(plane) * plane.dot(to_eye);
        Self([x, y, normal * if side >= 0.0 { 1.0 } else { -1.0 }])
    }

    /// World-space direction in the frame.
    fn local(&self, direction: Vec3) -> [f32; 3] {
        self.0.map(|axis| direction.dot(axis))
    }

    /// Direction of the frame in world space.
    fn world(&self, direction: [f32; 3]) -> Vec3 {
        self.0.iter().zip(direction).map(|(axis, part)| *axis * part).sum()
    }
}

/// π times the radiance towards the eye.
fn light_of(
    mesh: &BtfTriangles<'_>,
    surface: &BtfSurface<'_>,
    scene: &Scene,
    reflections: &Reflections<'_>,
    covered: &Covered,
    visibility: [f32; MAX_LIGHTS],
) -> Vec3 {
    let (uv, position) = (covered.blend(mesh.uvs), covered.blend(mesh.positions));
    let lod = surface.level_of_detail(covered.slopes(mesh.uvs));
    let [dx, dy] = covered.slopes(mesh.positions);
    let to_eye = (Vec3::from(scene.eye_mm) - position).normalize();
    let tangents = Tangents::new(covered.blend(mesh.normals), covered.blend(mesh.tangents), dx.cross(dy), to_eye);
    let seen = surface.btf.grid().view(tangents.local(to_eye));
    let taps = surface.taps(uv, lod);
    let mut light = surface.ambient_light(&taps, &seen, &tangents, reflections, covered.pixel);
    for number in 0..scene.lights as usize {
        let (towards, irradiance) = incident(scene, number, position);
        let towards = tangents.local(towards);
        let seen = taps.iter().map(|(texel, weight)| *weight * surface.value(*texel, towards, &seen));
        light += irradiance * visibility[number] * seen.sum::<Vec3>();
    }
    light
}

/// Three random numbers, 0 to 1, of a pixel, always the same (hash of three integers by Jarzynski and Olano 2020).
fn random_numbers([x, y]: [u32; 2]) -> [f32; 3] {
    let mut v = [x, y, 0].map(|k: u32| k.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    let mix = |v: &mut [u32; 3]| {
        for (to, a, b) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
            v[to] = v[to].wrapping_add(v[a].wrapping_mul(v[b]));
        }
    };
    mix(&mut v);
    v = v.map(|k| k ^ (k >> 16));
    mix(&mut v);
    #[allow(clippy::cast_precision_loss, reason = "24 bits")]
    v.map(|k| (k >> 8) as f32 / 16_777_216.0)
}

impl BtfSurface<'_> {
    /// Value of a texel: π times the radiance under light of unit irradiance on a plane that faces it.
    fn value(&self, texel: Texel, light: [f32; 3], seen: &View) -> Vec3 {
        self.btf.header().encoding.linear(self.btf.eval_for(texel, light, seen)).into()
    }

    /// Texels of a mipmap level, columns and rows.
    fn size(&self, level: u8) -> [u32; 2] {
        self.btf.materials().nth(self.material).expect("a material of the file").size(level)
    }

    /// Number of mipmap levels.
    fn levels(&self) -> u8 {
        self.btf.materials().nth(self.material).expect("a material of the file").levels
    }

    /// Mipmap level, not rounded, for screen-space derivatives of the texture coordinates.
    fn level_of_detail(&self, slopes: [Vec2; 2]) -> f32 {
        #[allow(clippy::cast_precision_loss, reason = "sides are below 65,536")]
        let size = Vec2::from(self.size(0).map(|side| side as f32));
        let texels2 = slopes.map(|slope| (slope * size).length_squared()).into_iter().fold(1e-12, f32::max);
        (0.5 * texels2.log2()).clamp(0.0, f32::from(self.levels() - 1))
    }

    /// Texels and weights of a pixel.
    fn taps(&self, uv: Vec2, lod: f32) -> Vec<(Texel, f32)> {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a level")]
        let level = |lod: f32| lod as u8;
        let texel = |level, at: Vec2| {
            #[allow(clippy::cast_possible_truncation, reason = "texels")]
            let at = at.to_array().map(|k| k as i32);
            self.btf.texel(self.material, level, at).expect("a level of the material")
        };
        #[allow(clippy::cast_precision_loss, reason = "sides are below 65,536")]
        let texel_coord = |level| (uv - uv.floor()) * Vec2::from(self.size(level).map(|side| side as f32));
        let of_level = |level: u8, share: f32| {
            let at = texel_coord(level) - 0.5;
            let (low, part) = (at.floor(), at - at.floor());
            let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].map(Vec2::from);
            corners.map(|corner| {
                let weights = (1.0 - corner) * (1.0 - part) + corner * part;
                (texel(level, low + corner), weights.x * weights.y * share)
            })
        };
        match self.filtering {
            BtfFiltering::Nearest => {
                let level = level(lod + 0.5);
                vec![(texel(level, texel_coord(level)), 1.0)]
            }
            BtfFiltering::Bilinear => of_level(level(lod + 0.5), 1.0).to_vec(),
            BtfFiltering::Trilinear => {
                let (finer, part) = (level(lod), lod.fract());
                let coarser = (finer + 1).min(self.levels() - 1);
                [of_level(finer, 1.0 - part), of_level(coarser, part)].concat()
            }
        }
    }

    /// π times the radiance under the environment: the mean of F(light) L(light) / density over samples.
    fn ambient_light(
        &self,
        taps: &[(Texel, f32)],
        seen: &View,
        tangents: &Tangents,
        reflections: &Reflections<'_>,
        pixel: [u32; 2],
    ) -> Vec3 {
        let chance = random_numbers(pixel);
        let mut left = chance[2];
        let mut drawn = taps[0].0;
        for (texel, weight) in taps.iter().filter(|(_, weight)| *weight > 0.0) {
            if left >= 0.0 {
                drawn = *texel;
            }
            left -= weight;
        }
        let sampler = self.btf.sampler(drawn, seen);
        #[allow(clippy::cast_precision_loss, reason = "at most a thousand")]
        let count = self.samples as f32;
        let sample = |k: u32| {
            #[allow(clippy::cast_precision_loss, reason = "at most a thousand")]
            let k = k as f32;
            let random = [(chance[0] + k / count).fract(), (chance[1] + k * 0.618_034).fract()];
            let sample = sampler.sample(random);
            let roughness = (1.0 / (count * sample.pdf * 4.0 * PI)).sqrt().sqrt().min(1.0);
            let radiance = reflections.radiance(tangents.world(sample.light), roughness);
            self.value(drawn, sample.light, seen) * radiance / sample.pdf
        };
        (0..self.samples).map(sample).sum::<Vec3>() / count.max(1.0)
    }
}
