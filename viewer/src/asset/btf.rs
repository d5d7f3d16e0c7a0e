//! How bidirectional texture functions lie on meshes, and the images that they were made from.

use glam::{Vec2, Vec3};
use subsurf_runtime::{BtfImages, BtfMaterial, Gpu};
use subsurf_scene::Mesh;

use crate::error::{Error, Result};

/// Uncompressed images of a BTF, to be drawn beside its file.
pub trait BtfImageSet: Send + Sync {
    /// Width and height of every image in pixels.
    fn size(&self) -> [u32; 2];

    /// Directions towards the lights, of length 1: x along rows, y down, z the normal.
    fn lights(&self) -> &[Vec3];

    /// Directions towards the eye, likewise.
    fn views(&self) -> &[Vec3];

    /// Linear value that stands as 255 in an image.
    fn white(&self) -> f32;

    /// sRGB bytes of the image under a light, seen from a view: row by row from the top.
    fn image(&self, light: usize, view: usize) -> Vec<[u8; 3]>;
}

/// Brings images to a device.
///
/// # Errors
/// The device has no room for them.
pub fn upload_images(gpu: &Gpu, images: &dyn BtfImageSet) -> Result<BtfMaterial> {
    let (lights, views) = (images.lights(), images.views());
    let description = BtfImages { size: images.size(), lights, views, white: images.white() };
    Ok(BtfMaterial::upload_images(gpu, &description, |light, view| images.image(light, view))?)
}

/// Refuses a mesh that BTFs cannot lie on.
///
/// # Errors
/// [`Error::Request`] if it has no texture coordinates.
pub fn expect_uvs(mesh: &Mesh) -> Result<()> {
    if mesh.uvs.is_some() {
        return Ok(());
    }
    Err(Error::Request(
        "the mesh has no texture coordinates, which say how a BTF lies on it: unwrap it in a modelling program (in \
         Blender: Edit Mode, UV, Smart UV Project) and export them"
            .to_owned(),
    ))
}

/// A copy is this share of the longest side of the mesh.
const SHARE_OF_MESH: f64 = 0.2;

/// Copies of a material of `size` texels along u and v: whole numbers of them, in which texels are about square and a
/// copy is about a fifth of the longest side of the mesh.
#[must_use]
pub fn repeats(mesh: &Mesh, [width, height]: [u32; 2]) -> [f32; 2] {
    let Some(uvs) = &mesh.uvs else {
        return [1.0; 2];
    };
    // mm along u and along v to a unit of them, on average.
    let (mut along_u, mut along_v, mut area) = (0.0, 0.0, 0.0);
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|k| mesh.positions[k as usize]);
        let [ta, tb, tc]: [Vec2; 3] = triangle.map(|k| uvs[k as usize]);
        let (e1, e2, t1, t2): (Vec3, Vec3, Vec2, Vec2) = (b - a, c - a, tb - ta, tc - ta);
        // Twice the area in texture coordinates cancels: ∂P/∂u = (e1 t2.y − e2 t1.y) / (t1 × t2).
        along_u += f64::from((e1 * t2.y - e2 * t1.y).length());
        along_v += f64::from((e2 * t1.x - e1 * t2.x).length());
        area += f64::from(t1.perp_dot(t2).abs());
    }
    let [low, high] = mesh.bounds();
    let copy_mm = SHARE_OF_MESH * f64::from((high - low).max_element());
    let larger = f64::from(width.max(height));
    let copies = |along: f64, texels: u32| {
        let copies = along / area / (copy_mm * f64::from(texels) / larger);
        #[allow(clippy::cast_possible_truncation, reason = "a small whole number")]
        let whole = if copies.is_finite() { copies.round().clamp(1.0, 1_000.0) as f32 } else { 1.0 };
        whole
    };
    [copies(along_u, width), copies(along_v, height)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use subsurf_scene::{sphere, torus};

    #[test]
    fn copies_are_about_square_and_a_fifth_of_the_mesh() {
        // 20 mm in radius: 126 mm around the equator, 63 mm from pole to pole, and 80 mm around on average.
        assert_eq!(repeats(&sphere(20.0, 32), [64, 64]), [10.0, 8.0]);
        assert_eq!(repeats(&sphere(20.0, 32), [64, 32]), [10.0, 16.0]);
        // 2 π 18 mm along the middle of a tube of 2 π 8 mm.
        assert_eq!(repeats(&torus(18.0, 8.0, 32), [128, 128]), [11.0, 5.0]);
    }
}
