//! Twin of `btf_shade.wgsl` and `btf_texture.wgsl`; that of the shaders before them is the decoder.

use std::f32::consts::PI;

use glam::{Vec2, Vec3, Vec4};
use subsurf_decoder::Btf;
use subsurf_decoder::btf::{Texel, View};
use subsurf_scene::MAX_LIGHTS;

use super::raster::{Covered, rasterise};
use super::{Reflections, display, incident, neutral, srgb};
use crate::uniform::{BtfFiltering, Scene};

/// One material of a BTF, and how it is looked up.
#[derive(Clone, Copy, Debug)]
pub struct BtfSurface<'a> {
    /// The file.
    pub btf: &'a Btf<'a>,
    /// Number of the material.
    pub material: usize,
    /// Which texels a pixel shows.
    pub filtering: BtfFiltering,
    /// Samples of light from all around, for a pixel.
    pub samples: u32,
}

/// A textured mesh.
#[derive(Clone, Copy, Debug)]
pub struct BtfTriangles<'a> {
    /// Positions of the vertices in mm.
    pub positions: &'a [Vec3],
    /// Unit normals of the vertices.
    pub normals: &'a [Vec3],
    /// Copies of the material, v down.
    pub uvs: &'a [Vec2],
    /// Along the rows of the material; in the fourth place, 1 if normal × tangent goes down its columns, −1 if up.
    pub tangents: &'a [Vec4],
    /// How much of each light reaches the vertices.
    pub visibilities: &'a [[f32; MAX_LIGHTS]],
    /// Vertices of the triangles.
    pub triangles: &'a [[u32; 3]],
}

/// Draws a mesh in front of a `background` of display values, `size` pixels, row by row from the top.
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
    let visibilities: Vec<Vec4> = mesh.visibilities.iter().map(|seen| Vec4::from(*seen)).collect();
    rasterise(mesh.positions, mesh.triangles, &scene.clip_from_world, size, background, |covered| {
        let visibility = covered.blend(&visibilities).to_array();
        let light = light_of(mesh, surface, scene, reflections, covered, visibility) / PI * scene.exposure;
        display(srgb(neutral(light.into())))
    })
}

/// The material's own directions, in the world: along its rows, down its columns, and away from it.
struct Tangents([Vec3; 3]);

impl Tangents {
    /// The side that is seen, whichever way the triangle winds: `plane` is any normal of it.
    fn new(normal: Vec3, tangent: Vec4, plane: Vec3, to_eye: Vec3) -> Self {
        let normal = normal.normalize();
        let x = (tangent.truncate() - normal * tangent.truncate().dot(normal)).normalize();
        let y = normal.cross(x) * if tangent.w >= 0.0 { 1.0 } else { -1.0 };
        let side = normal.dot(plane) * plane.dot(to_eye);
        Self([x, y, normal * if side >= 0.0 { 1.0 } else { -1.0 }])
    }

    fn local(&self, direction: Vec3) -> [f32; 3] {
        self.0.map(|axis| direction.dot(axis))
    }

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
    let detail = surface.detail(covered.slopes(mesh.uvs));
    let [dx, dy] = covered.slopes(mesh.positions);
    let to_eye = (Vec3::from(scene.eye_mm) - position).normalize();
    let tangents = Tangents::new(covered.blend(mesh.normals), covered.blend(mesh.tangents), dx.cross(dy), to_eye);
    let seen = surface.btf.grid().view(tangents.local(to_eye));
    let taps = surface.taps(uv, detail);
    let mut light = surface.around(&taps, &seen, &tangents, reflections, covered.pixel);
    for number in 0..scene.lights as usize {
        let (towards, irradiance) = incident(scene, number, position);
        let towards = tangents.local(towards);
        let seen = taps.iter().map(|(texel, weight)| *weight * surface.value(*texel, towards, &seen));
        light += irradiance * visibility[number] * seen.sum::<Vec3>();
    }
    light
}

/// Three numbers from 0 to 1 for a pixel (hash of three integers by Jarzynski and Olano 2020).
fn chances([x, y]: [u32; 2]) -> [f32; 3] {
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
    fn value(&self, texel: Texel, light: [f32; 3], seen: &View) -> Vec3 {
        self.btf.header().tone.linear(self.btf.eval_for(texel, light, seen)).into()
    }

    fn size(&self, level: u8) -> [u32; 2] {
        self.btf.materials().nth(self.material).expect("a material of the file").size(level)
    }

    fn levels(&self) -> u8 {
        self.btf.materials().nth(self.material).expect("a material of the file").levels
    }

    /// Mipmap level, not rounded, where texture coordinates change like this from pixel to pixel.
    fn detail(&self, slopes: [Vec2; 2]) -> f32 {
        #[allow(clippy::cast_precision_loss, reason = "sides are below 65,536")]
        let size = Vec2::from(self.size(0).map(|side| side as f32));
        let texels2 = slopes.map(|slope| (slope * size).length_squared()).into_iter().fold(1e-12, f32::max);
        (0.5 * texels2.log2()).clamp(0.0, f32::from(self.levels() - 1))
    }

    /// Texels and weights of a pixel.
    fn taps(&self, uv: Vec2, detail: f32) -> Vec<(Texel, f32)> {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a level")]
        let level = |detail: f32| detail as u8;
        let texel = |level, at: Vec2| {
            #[allow(clippy::cast_possible_truncation, reason = "texels")]
            let at = at.to_array().map(|k| k as i32);
            self.btf.texel(self.material, level, at).expect("a level of the material")
        };
        #[allow(clippy::cast_precision_loss, reason = "sides are below 65,536")]
        let place = |level| (uv - uv.floor()) * Vec2::from(self.size(level).map(|side| side as f32));
        let of_level = |level: u8, share: f32| {
            let at = place(level) - 0.5;
            let (low, part) = (at.floor(), at - at.floor());
            let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].map(Vec2::from);
            corners.map(|corner| {
                let weights = (1.0 - corner) * (1.0 - part) + corner * part;
                (texel(level, low + corner), weights.x * weights.y * share)
            })
        };
        match self.filtering {
            BtfFiltering::Nearest => {
                let level = level(detail + 0.5);
                vec![(texel(level, place(level)), 1.0)]
            }
            BtfFiltering::Bilinear => of_level(level(detail + 0.5), 1.0).to_vec(),
            BtfFiltering::Trilinear => {
                let (finer, part) = (level(detail), detail.fract());
                let coarser = (finer + 1).min(self.levels() - 1);
                [of_level(finer, 1.0 - part), of_level(coarser, part)].concat()
            }
        }
    }

    /// π times the radiance under light from all around: the mean of F(light) L(light) / density over samples.
    fn around(
        &self,
        taps: &[(Texel, f32)],
        seen: &View,
        tangents: &Tangents,
        reflections: &Reflections<'_>,
        pixel: [u32; 2],
    ) -> Vec3 {
        let chance = chances(pixel);
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
