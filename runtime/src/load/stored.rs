//! What is loaded when loads are timed: files, and what they are compared with.

use glam::Vec3;
use subsurf_decoder::bssrdf::BssrdfHeader;
use subsurf_shaders::MaterialLayout;

use crate::asset::{BtfImages, BtfMaterial, Material};
use crate::error::{Error, Result};
use crate::gpu::Gpu;
use crate::technique::Technique;

/// What the bytes of a file are, and how the first frame shows them.
#[derive(Clone, Debug)]
pub enum Stored {
    /// Translucent material in one of the layouts of a `.subsurf` file: gathered on a flat patch.
    Planes(MaterialLayout),
    /// `.subsurf` file for splats, separable blurs or as a BTF: on a mesh.
    File(Technique),
    /// File of a transfer: on the mesh that it is of.
    #[cfg(feature = "transfer")]
    Transfer(Box<subsurf_scene::Mesh>),
    /// Uncompressed capture of this size, `[y][x][dy][dx][rgb]` of little-endian f32: gathered on a flat patch.
    Capture(BssrdfHeader),
    /// Uncompressed images of a BTF: on a mesh.
    Images(RawImages),
}

/// Array of the images of a BTF, `[light][view][y][x][rgb]` of sRGB bytes.
#[derive(Clone, Debug)]
pub struct RawImages {
    /// Width and height of an image in pixels.
    pub size: [u32; 2],
    /// Unit vectors towards the lights: x along rows, y down, z the normal.
    pub lights: Vec<Vec3>,
    /// Unit vectors towards the eyes, likewise.
    pub views: Vec<Vec3>,
}

impl RawImages {
    /// Bytes of the array.
    pub(super) fn bytes(&self) -> usize {
        self.lights.len() * self.views.len() * self.image_bytes()
    }

    fn image_bytes(&self) -> usize {
        3 * self.size.map(|side| side as usize).iter().product::<usize>()
    }

    /// Uploads an array of as many bytes.
    pub(super) fn upload(&self, gpu: &Gpu, bytes: &[u8]) -> Result<Material> {
        let images = BtfImages { size: self.size, lights: &self.lights, views: &self.views, white: 1.0 };
        let len = self.image_bytes();
        let image = |light: usize, view: usize| {
            let number = light * self.views.len() + view;
            bytes.get(number * len..(number + 1) * len).unwrap_or(&[]).as_chunks().0.to_vec()
        };
        Ok(Material::Btf(BtfMaterial::upload_images(gpu, &images, image)?.into(), 0))
    }
}

/// Bytes of an uncompressed capture.
pub(super) fn capture_bytes(header: &BssrdfHeader) -> usize {
    let side = 2 * usize::from(header.window_radius) + 1;
    header.width as usize * header.height as usize * side * side * 3 * size_of::<f32>()
}

pub(super) fn expect_length(bytes: &[u8], wanted: usize) -> Result<()> {
    if bytes.len() == wanted {
        return Ok(());
    }
    Err(Error::Usage(format!("{} bytes where an array of that size has {wanted}", bytes.len())))
}
