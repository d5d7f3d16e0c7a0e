//! A material on the device, in one of three storages.

use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::{Header, Model};
use subsurf_shaders::uniform;
use wgpu::{BindingResource, Buffer, TextureFormat, TextureView, TextureViewDescriptor, TextureViewDimension};

use crate::context::Gpu;
use crate::error::{Error, Result};
use crate::ledger::Tracked;
use crate::resource::{ROW, Slot, Surface2d, TextureSpec};

/// How a material's reflectance is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Storage {
    /// Two base materials per pixel.
    Bmpp,
    /// Per-pixel profiles.
    PerPixel,
    /// Every entry of an uncompressed capture.
    Capture,
}

impl Storage {
    /// Bindings of the material's group.
    pub(crate) fn slots(self) -> &'static [Slot] {
        match self {
            Self::Bmpp => &[Slot::Uniform, Slot::Float, Slot::Float, Slot::Uint],
            Self::PerPixel | Self::Capture => &[Slot::Uniform, Slot::FloatLayers],
        }
    }
}

/// A material that was uploaded.
#[derive(Debug)]
pub struct Material {
    storage: Storage,
    header: Header,
    uniform: Tracked<Buffer>,
    textures: Vec<Surface2d>,
    views: Vec<TextureView>,
}

impl Material {
    /// Uploads the planes of a file, each as one texture, as they stand in the file. Only the small table of base
    /// profiles is widened from three channels to four, so that a node is one load instead of three.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if the device takes no texture of that size.
    pub fn upload(gpu: &Gpu, material: &Bssrdf<'_>) -> Result<Self> {
        let header = material.header();
        let size = [header.width, header.height];
        let channels = 3 * u32::from(header.samples);
        match material.model() {
            Model::BaseMaterials(planes) => {
                let profiles = [u32::from(header.samples), header.base_materials];
                let profiles = TextureSpec::table("base profiles", profiles, TextureFormat::Rgba32Float);
                let nodes = planes.profiles.as_bytes().as_chunks::<12>().0;
                let nodes: Vec<u8> = nodes.iter().flat_map(|rgb| rgb.iter().copied().chain([0; 4])).collect();
                let ratios = TextureSpec::table("mixture ratios", size, TextureFormat::R32Float);
                let indices = TextureSpec::table("base indices", size, TextureFormat::Rg8Uint);
                let textures = vec![
                    gpu.filled(&profiles, &nodes)?,
                    gpu.filled(&ratios, planes.ratios.as_bytes())?,
                    gpu.filled(&indices, planes.indices.as_flattened())?,
                ];
                let views = textures.iter().map(|surface| surface.view.clone()).collect();
                Ok(Self::new(gpu, Storage::Bmpp, header, [ROW; 2], textures, views))
            }
            Model::PerPixel(planes) => {
                let spec = TextureSpec::layered("local profiles", size, channels, TextureFormat::R32Float);
                let texture = gpu.texture(&spec)?;
                let plane = size[0] as usize * size[1] as usize * 4;
                gpu.checked(|| {
                    for (bytes, layer) in planes.profiles.as_bytes().chunks(plane).zip(0..) {
                        gpu.fill(&texture.texture, layer, bytes);
                    }
                })?;
                let views = vec![layers_of(&texture)];
                Ok(Self::new(gpu, Storage::PerPixel, header, [ROW; 2], vec![texture], views))
            }
        }
    }

    /// Uploads an uncompressed capture, `[y][x][dy][dx][rgb]` of little-endian f32, for comparison: sizes, pitch and
    /// window come from `header`.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if the device has not enough layers.
    pub fn upload_capture(gpu: &Gpu, header: &Header, entries: &[u8]) -> Result<Self> {
        let rows = entries.len().div_ceil(ROW as usize * 4);
        let layers = rows.div_ceil(ROW as usize).max(2);
        let small = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        let rows = small(rows.div_ceil(layers));
        let layer = ROW as usize * rows as usize * 4;
        let spec = TextureSpec::layered("capture", [ROW, rows], small(layers), TextureFormat::R32Float);
        let texture = gpu.texture(&spec)?;
        for (bytes, layer) in entries.chunks(layer).zip(0..) {
            gpu.checked(|| gpu.fill(&texture.texture, layer, bytes))?;
            // Copies wait in buffers of their own until they are submitted: do not let them all wait together.
            gpu.finish()?;
        }
        let views = vec![layers_of(&texture)];
        Ok(Self::new(gpu, Storage::Capture, header, [ROW, rows], vec![texture], views))
    }

    fn new(
        gpu: &Gpu,
        storage: Storage,
        header: &Header,
        layer: [u32; 2],
        textures: Vec<Surface2d>,
        views: Vec<TextureView>,
    ) -> Self {
        let block = uniform::Material::new(header, layer);
        Self { storage, header: *header, uniform: gpu.uniform("material", &block), textures, views }
    }

    /// How it is stored.
    #[must_use]
    pub fn storage(&self) -> Storage {
        self.storage
    }

    /// Size, pitch, window and so on.
    #[must_use]
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// Bytes of its textures and uniforms on the device.
    #[must_use]
    pub fn gpu_bytes(&self) -> u64 {
        self.textures.iter().map(|surface| surface.texture.bytes()).sum::<u64>() + self.uniform.bytes()
    }

    /// Resources of the material's group, in the order of [`Storage::slots`].
    pub(crate) fn resources(&self) -> Vec<BindingResource<'_>> {
        let uniform = std::iter::once(self.uniform.as_entire_binding());
        uniform.chain(self.views.iter().map(BindingResource::TextureView)).collect()
    }

    /// Refuses a material of another storage than a renderer was built for.
    pub(crate) fn expect(&self, storage: Storage) -> Result<()> {
        if self.storage == storage {
            return Ok(());
        }
        Err(Error::Device(format!("this renderer draws {storage:?}, the material is stored as {:?}", self.storage)))
    }
}

fn layers_of(surface: &Surface2d) -> TextureView {
    surface
        .texture
        .create_view(&TextureViewDescriptor { dimension: Some(TextureViewDimension::D2Array), ..Default::default() })
}
