//! Loading, step by step: from the bytes of a file to its first frame on a device. Benchmarks and tests time it.

use std::time::{Duration, Instant};

use glam::Vec3;
use subsurf_decoder::bssrdf::BssrdfHeader;
use subsurf_decoder::{Bssrdf, File};
use subsurf_runtime::{
    BssrdfPlanes, BtfImages, BtfLayout, BtfMaterial, Gpu, GpuMesh, Input, Material, MaterialLayout, Object, PatchLight,
    PatchRenderer, PictureTarget, Region, Renderer, RuntimeOptions, Technique, VertexData,
};
use subsurf_scene::{Mapping, Scene, relief};

use crate::error::{Error, Result};
use crate::request::RenderRequest;

/// Pixels to a side of the first frame.
const FRAME: u32 = 64;
/// Copies of a material on the mesh of the first frame.
const COPIES: [f32; 2] = [4.0; 2];

/// What the bytes of a file are, and how the first frame shows them.
#[derive(Clone, Debug)]
pub enum Stored {
    /// Translucent material in one of the layouts of a `.subsurf` file: gathered on a flat patch.
    Planes(MaterialLayout),
    /// Translucent material with a separable basis of so many terms: on a mesh.
    Separable(usize),
    /// Uncompressed capture of this size, `[y][x][dy][dx][rgb]` of little-endian f32: gathered on a flat patch.
    Capture(BssrdfHeader),
    /// BTF in nested codebooks: on a mesh.
    Btf,
    /// Uncompressed images of a BTF, `[light][view][y][x][rgb]` of sRGB bytes: on a mesh.
    Images {
        /// Width and height of an image in pixels.
        size: [u32; 2],
        /// Unit vectors towards the lights: x along rows, y down, z the normal.
        lights: Vec<Vec3>,
        /// Unit vectors towards the eyes, likewise.
        views: Vec<Vec3>,
    },
}

/// Load of one file: how long each step took, and what the device holds then.
#[derive(Clone, Copy, Debug)]
pub struct Loading {
    /// All checks, CRCs included.
    pub parse: Duration,
    /// Onto the device, until it has everything.
    pub upload: Duration,
    /// First frame of 64 × 64 pixels at most, until it is done.
    pub first_frame: Duration,
    /// Bytes of the material on the device.
    pub gpu_bytes: u64,
}

/// What an application has before it loads its first material: pipelines, and a mesh.
pub struct Loader<'a> {
    gpu: &'a Gpu,
    stored: Stored,
    ready: Ready,
}

/// Pipelines, by what they draw.
enum Ready {
    Flat(PatchRenderer),
    Mesh { renderer: Box<Renderer>, mesh: Box<GpuMesh>, scene: Box<Scene> },
}

impl<'a> Loader<'a> {
    /// Compiles the pipelines.
    ///
    /// # Errors
    /// The device cannot draw it.
    pub fn new(gpu: &'a Gpu, stored: Stored) -> Result<Self> {
        let ready = match &stored {
            Stored::Planes(layout) => Ready::Flat(PatchRenderer::new(gpu, *layout)?),
            Stored::Capture(_) => Ready::Flat(PatchRenderer::new(gpu, MaterialLayout::Capture)?),
            Stored::Separable(terms) => Ready::mesh(gpu, Technique::Separable(*terms))?,
            Stored::Btf => Ready::mesh(gpu, Technique::Btf(BtfLayout::Nested))?,
            Stored::Images { .. } => Ready::mesh(gpu, Technique::Btf(BtfLayout::Images))?,
        };
        Ok(Self { gpu, stored, ready })
    }

    /// Loads a file, once.
    ///
    /// # Errors
    /// The bytes are not what they should be, or the device has no room for them.
    pub fn load(&self, bytes: &[u8]) -> Result<Loading> {
        match &self.ready {
            Ready::Flat(renderer) => self.load_flat(renderer, bytes),
            Ready::Mesh { renderer, mesh, scene } => self.load_on(renderer, mesh, scene, bytes),
        }
    }

    fn load_flat(&self, renderer: &PatchRenderer, bytes: &[u8]) -> Result<Loading> {
        let gpu = self.gpu;
        let begin = Instant::now();
        let (file, header) = match &self.stored {
            // There is nothing to check in an array but its length.
            Stored::Capture(header) => {
                expect_length(bytes, capture_bytes(header))?;
                (None, *header)
            }
            _ => {
                let file = Bssrdf::parse(bytes).map_err(subsurf_runtime::Error::from)?;
                let header = *file.header();
                (Some(file), header)
            }
        };
        let parsed = Instant::now();
        let planes = match &file {
            Some(file) => BssrdfPlanes::upload(gpu, file)?,
            None => BssrdfPlanes::upload_capture(gpu, &header, bytes)?,
        };
        let size = [header.width, header.height];
        let light = PatchLight::upload(gpu, size, &vec![[1.0; 3]; size.map(|side| side as usize).iter().product()])?;
        gpu.finish()?;
        let uploaded = Instant::now();
        let frame = size.map(|side| side.min(FRAME));
        let region = Region { origin: [0, 1].map(|k| (size[k] - frame[k]) / 2), size: frame };
        let exitance = renderer.gather(gpu, &planes, &light, region)?;
        renderer.picture(gpu, &exitance, frame, 1.0)?;
        Ok(Loading {
            parse: parsed - begin,
            upload: uploaded - parsed,
            first_frame: uploaded.elapsed(),
            gpu_bytes: planes.gpu_bytes(),
        })
    }

    fn load_on(&self, renderer: &Renderer, mesh: &GpuMesh, scene: &Scene, bytes: &[u8]) -> Result<Loading> {
        let gpu = self.gpu;
        let begin = Instant::now();
        let file = match &self.stored {
            Stored::Images { size, lights, views } => {
                expect_length(bytes, lights.len() * views.len() * image_bytes(*size))?;
                None
            }
            _ => Some(File::parse(bytes).map_err(subsurf_runtime::Error::from)?),
        };
        let parsed = Instant::now();
        let material = match (&file, &self.stored) {
            (None, Stored::Images { size, lights, views }) => {
                let images = BtfImages { size: *size, lights, views, white: 1.0 };
                let image = |light: usize, view: usize| image_of(bytes, light * views.len() + view, *size).to_vec();
                Material::Btf(BtfMaterial::upload_images(gpu, &images, image)?.into(), 0)
            }
            (Some(file), _) => Material::load(gpu, file)?,
            (None, _) => return Err(Error::Request("no file to load".to_owned())),
        };
        gpu.finish()?;
        let uploaded = Instant::now();
        let objects = [Object::new(mesh, &material, Mapping::Uv(COPIES), scene.roughness)];
        let input = Input::new(scene, &objects, [FRAME; 2]);
        let picture = PictureTarget::new(gpu, [FRAME; 2], renderer.options())?;
        let mut frame = renderer.prepare(gpu, &input, [FRAME; 2])?;
        renderer.draw_now(gpu, &mut frame, &input, &picture.target())?;
        gpu.finish()?;
        Ok(Loading {
            parse: parsed - begin,
            upload: uploaded - parsed,
            first_frame: uploaded.elapsed(),
            gpu_bytes: material.gpu_bytes(),
        })
    }
}

impl Ready {
    fn mesh(gpu: &Gpu, technique: Technique) -> Result<Self> {
        let mesh = relief(20.0, 8, 22);
        let tangents = mesh.tangents()?;
        let known = VertexData { tangents: Some(&tangents), ..Default::default() };
        Ok(Self::Mesh {
            renderer: Box::new(Renderer::for_technique(gpu, technique, RuntimeOptions::default())?),
            mesh: Box::new(GpuMesh::upload(gpu, &mesh, known)?),
            scene: Box::new(RenderRequest::usual([FRAME; 2]).scene(&mesh)),
        })
    }
}

/// Bytes of an uncompressed capture.
fn capture_bytes(header: &BssrdfHeader) -> usize {
    let side = 2 * usize::from(header.window_radius) + 1;
    header.width as usize * header.height as usize * side * side * 3 * size_of::<f32>()
}

/// Bytes of an image of sRGB bytes.
fn image_bytes(size: [u32; 2]) -> usize {
    3 * size.map(|side| side as usize).iter().product::<usize>()
}

/// Pixels of one of the images in an array; none beyond the last.
fn image_of(bytes: &[u8], number: usize, size: [u32; 2]) -> &[[u8; 3]] {
    let len = image_bytes(size);
    bytes.get(number * len..(number + 1) * len).unwrap_or(&[]).as_chunks().0
}

fn expect_length(bytes: &[u8], wanted: usize) -> Result<()> {
    if bytes.len() == wanted {
        return Ok(());
    }
    Err(Error::Request(format!("{} bytes where an array of that size has {wanted}", bytes.len())))
}
