//! BTFs on the device, uncompressed: every image. What a compressed BTF is compared with.

use glam::Vec3;
use subsurf_shaders::BtfLayout;
use subsurf_shaders::uniform::{self, BtfTexture, MAX_RINGS_OF_DIRECTIONS};
use wgpu::TextureFormat;

use super::btf::BtfMaterial;
use crate::error::{Error, Result};
use crate::gpu::{Gpu, Purpose, TextureSpec};

/// Size and directions of the images of one material, one for every pair of a light and a view.
#[derive(Clone, Copy, Debug)]
pub struct BtfImages<'a> {
    /// Width and height of an image in pixels.
    pub size: [u32; 2],
    /// Unit vectors towards the lights: x along the rows, y down the columns, z the normal. They lie on rings around the
    /// normal, each with equal steps of azimuth from 0 on.
    pub lights: &'a [Vec3],
    /// Unit vectors towards the eyes, on rings likewise.
    pub views: &'a [Vec3],
    /// Linear value of display white.
    pub white: f32,
}

/// Directions on rings around the normal.
#[derive(Debug, PartialEq)]
struct Rings {
    /// Of each ring, angle from the normal in rad, number of directions, number of the first.
    rings: Vec<[f32; 3]>,
    /// For each place on the rings, from the innermost, the direction that was given.
    order: Vec<usize>,
}

/// Angles this far apart, in rad, are of different rings.
const APART: f32 = 2e-3;

impl Rings {
    /// Sorts directions into rings; `what` names them in errors.
    fn of(directions: &[Vec3], what: &str) -> Result<Self> {
        let wrong = |reason: String| Error::Images(format!("{what}: {reason}"));
        let angles = |k: &usize| {
            let direction = directions[*k];
            let theta = direction.truncate().length().atan2(direction.z);
            let phi = direction.y.atan2(direction.x).rem_euclid(std::f32::consts::TAU);
            // A full turn but for rounding is none; straight above there is no azimuth.
            let is_none = theta < APART || phi > std::f32::consts::TAU - 1e-4;
            (theta, if is_none { 0.0 } else { phi })
        };
        let mut order: Vec<usize> = (0..directions.len()).collect();
        order.sort_by(|a, b| angles(a).0.total_cmp(&angles(b).0));
        let mut rings = Vec::new();
        let mut sorted = Vec::new();
        for ring in order.chunk_by(|a, b| (angles(a).0 - angles(b).0).abs() < APART) {
            let mut ring = ring.to_vec();
            ring.sort_by(|a, b| angles(a).1.total_cmp(&angles(b).1));
            let theta = angles(&ring[0]).0;
            let step = std::f32::consts::TAU / ring.len() as f32;
            for (k, direction) in ring.iter().enumerate() {
                let phi = angles(direction).1;
                // Directions are given in whole degrees, some of them.
                if (phi - k as f32 * step).abs() > 0.02 {
                    return Err(wrong(format!(
                        "{} directions {:.0}° from the normal are not in equal steps of azimuth from 0° on, such as {:.0}°",
                        ring.len(),
                        theta.to_degrees(),
                        phi.to_degrees()
                    )));
                }
            }
            rings.push([theta, ring.len() as f32, sorted.len() as f32]);
            sorted.extend(ring);
        }
        if rings.is_empty() || rings.len() > MAX_RINGS_OF_DIRECTIONS {
            return Err(wrong(format!(
                "{} rings of directions; 1 to {MAX_RINGS_OF_DIRECTIONS} can be drawn",
                rings.len()
            )));
        }
        Ok(Self { rings, order: sorted })
    }

    /// Rings as the uniform block has them.
    fn block(&self) -> [[f32; 4]; MAX_RINGS_OF_DIRECTIONS] {
        let mut block = [[0.0; 4]; MAX_RINGS_OF_DIRECTIONS];
        for (to, [theta, count, first]) in block.iter_mut().zip(&self.rings) {
            *to = [*theta, *count, *first, 0.0];
        }
        block
    }
}

impl BtfMaterial {
    /// Uploads images as they are, four bytes a pixel: layers of a texture for views, tiles of a layer for lights. `image`
    /// gives the pixels of a light and a view, by their numbers, as display values, row by row.
    ///
    /// # Errors
    /// [`Error::Images`] if directions do not lie on rings; [`Error::Unsupported`] if the device has not enough layers, or
    /// textures that are large enough.
    ///
    /// # Panics
    /// If an image has fewer pixels than its size says.
    pub fn upload_images(
        gpu: &Gpu,
        images: &BtfImages<'_>,
        mut image: impl FnMut(usize, usize) -> Vec<[u8; 3]>,
    ) -> Result<Self> {
        let (lights, views) = (Rings::of(images.lights, "lights")?, Rings::of(images.views, "views")?);
        let [width, height] = images.size;
        let count = u32::try_from(images.lights.len()).unwrap_or(u32::MAX);
        let tiles = count.isqrt() + u32::from(!count.isqrt().pow(2).eq(&count));
        let side = |pixels: u32, tiles: u32| pixels.saturating_mul(tiles);
        let size = [side(width, tiles), side(height, count.div_ceil(tiles))];
        let layers = u32::try_from(images.views.len()).unwrap_or(u32::MAX);
        let texture = gpu.texture(&TextureSpec::layered("images", size, layers, TextureFormat::Rgba8Unorm))?;
        let row = size[0] as usize;
        let mut layer = vec![[0_u8; 4]; row * size[1] as usize];
        for (view, number) in views.order.iter().zip(0..) {
            for (light, tile) in lights.order.iter().zip(0_u32..) {
                let pixels = image(*light, *view);
                let first = (tile / tiles * height) as usize * row + (tile % tiles * width) as usize;
                for y in 0..height as usize {
                    let line = &pixels[y * width as usize..][..width as usize];
                    for (to, [r, g, b]) in layer[first + y * row..].iter_mut().zip(line) {
                        *to = [*r, *g, *b, 255];
                    }
                }
            }
            gpu.checked(|| gpu.fill(&texture.texture, number, layer.as_flattened()))?;
            // Copies wait in buffers of their own until they are submitted: do not let them all wait together.
            gpu.finish()?;
        }
        let lowest = images.lights.iter().map(|light| light.z).fold(1.0, f32::min);
        let small = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        let block = uniform::BtfImages {
            light_rings: lights.block(),
            view_rings: views.block(),
            rings: [small(lights.rings.len()), small(views.rings.len())],
            size: images.size,
            tiles,
            white: images.white,
            cos_light_min: lowest,
            pad: 0,
        };
        let textures = vec![BtfTexture::plain(images.size)];
        Ok(Self::new(BtfLayout::Images, textures, texture, gpu.uniform(Purpose::Material, "images", &block)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn direction(theta_deg: f32, phi_deg: f32) -> Vec3 {
        let (sin, cos) = theta_deg.to_radians().sin_cos();
        let (sin_phi, cos_phi) = phi_deg.to_radians().sin_cos();
        Vec3::new(sin * cos_phi, sin * sin_phi, cos)
    }

    #[test]
    fn directions_are_sorted_into_rings() {
        let shuffled =
            [(30.0, 270.0), (0.0, 0.0), (60.0, 120.0), (30.0, 0.0), (60.0, 240.0), (30.0, 180.0), (30.0, 90.0)];
        let mut directions: Vec<Vec3> = shuffled.iter().map(|(theta, phi)| direction(*theta, *phi)).collect();
        directions.push(direction(60.0, 0.0));
        let rings = Rings::of(&directions, "lights").unwrap();
        assert_eq!(rings.order, [1, 3, 6, 5, 0, 7, 2, 4]);
        let counts: Vec<[f32; 2]> = rings.rings.iter().map(|[_, count, first]| [*count, *first]).collect();
        assert_eq!(counts, [[1.0, 0.0], [4.0, 1.0], [3.0, 5.0]]);
        directions.pop();
        let error = Rings::of(&directions, "lights").unwrap_err().to_string();
        assert!(error.contains("lights: 2 directions 60° from the normal") && error.contains("120°"), "{error}");
        let many: Vec<Vec3> = (0_u8..20).map(|k| direction(f32::from(k) * 4.0, 0.0)).collect();
        assert!(Rings::of(&many, "views").unwrap_err().to_string().contains("20 rings"), "too many");
    }
}
