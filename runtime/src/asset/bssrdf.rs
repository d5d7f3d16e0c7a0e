//! Scattering materials on the device: the planes of a file, or an uncompressed capture.

use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::{BaseMaterials, BssrdfHeader, BssrdfModel, Mixtures, Profiles};
use subsurf_shaders::MaterialLayout;
use subsurf_shaders::uniform::{self, BASE_ROWS, ROW};
use wgpu::{BindingResource, Buffer, TextureFormat};

use crate::error::{Error, Result};
use crate::gpu::{Fill, Gpu, Purpose, Surface2d, TextureSpec, Tracked};

/// Layout of a file on the device.
#[must_use]
pub fn layout_of(material: &Bssrdf<'_>) -> MaterialLayout {
    let BssrdfModel::BaseMaterials(planes) = material.model() else {
        return MaterialLayout::PerPixel;
    };
    match planes.mixtures {
        Mixtures::One(_) | Mixtures::OneOfMany(_) => MaterialLayout::Bmpp1,
        Mixtures::Two { .. } | Mixtures::TwoSmall { .. } => MaterialLayout::Bmpp2,
        Mixtures::Palette { .. } => MaterialLayout::Bmpp2Palette,
        Mixtures::Several { count: 3, .. } => MaterialLayout::Bmpp3,
        Mixtures::Several { .. } => MaterialLayout::Bmpp5,
    }
}

/// Planes of a scattering material on the device, in one of the layouts.
#[derive(Debug)]
pub struct BssrdfPlanes {
    layout: MaterialLayout,
    header: BssrdfHeader,
    uniform: Tracked<Buffer>,
    textures: Vec<Surface2d>,
}

impl BssrdfPlanes {
    /// Uploads the planes of a file, each as one texture, as they stand in the file. Only the small table of base
    /// profiles is widened from three channels to four, so that a node is one load instead of three.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if the device takes no texture of that size.
    pub fn upload(gpu: &Gpu, material: &Bssrdf<'_>) -> Result<Self> {
        let (planes, fills) = Self::begin(gpu, material)?;
        fills.iter().try_for_each(|fill| fill.write(gpu))?;
        Ok(planes)
    }

    /// Makes the textures of the planes; they have to be filled.
    ///
    /// # Errors
    /// As [`BssrdfPlanes::upload`].
    pub(crate) fn begin<'a>(gpu: &Gpu, material: &Bssrdf<'a>) -> Result<(Self, Vec<Fill<'a>>)> {
        let header = material.header();
        let size = [header.width, header.height];
        let layout = layout_of(material);
        let mut planes = Planes { gpu, size, textures: Vec::new(), fills: Vec::new() };
        match material.model() {
            BssrdfModel::PerPixel(profiles) => {
                let count = 3 * u32::from(header.samples);
                planes.layers("local profiles", count, TextureFormat::R32Float, profiles.profiles.as_bytes())?;
            }
            BssrdfModel::BaseMaterials(BaseMaterials { profiles, mixtures }) => {
                planes.base_profiles(header, *profiles)?;
                planes.mixtures(*mixtures)?;
            }
        }
        Ok((Self::new(gpu, layout, header, ROW, planes.textures), planes.fills))
    }

    /// Uploads an uncompressed capture, `[y][x][dy][dx][rgb]` of little-endian f32, for comparison: sizes, pitch and
    /// window come from `header`.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if the device has not enough layers.
    pub fn upload_capture(gpu: &Gpu, header: &BssrdfHeader, entries: &[u8]) -> Result<Self> {
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
        Ok(Self::new(gpu, MaterialLayout::Capture, header, rows, vec![texture]))
    }

    fn new(gpu: &Gpu, layout: MaterialLayout, header: &BssrdfHeader, rows: u32, textures: Vec<Surface2d>) -> Self {
        let block = uniform::Material::new(header, rows);
        Self { layout, header: *header, uniform: gpu.uniform(Purpose::Material, "material", &block), textures }
    }

    /// Layout of the material on the device.
    #[must_use]
    pub fn layout(&self) -> MaterialLayout {
        self.layout
    }

    /// BssrdfHeader of the file: size, pitch and window of the patch.
    #[must_use]
    pub fn header(&self) -> &BssrdfHeader {
        &self.header
    }

    /// Bytes of textures and blocks on the device.
    #[must_use]
    pub fn gpu_bytes(&self) -> u64 {
        self.textures.iter().map(|surface| surface.texture.bytes()).sum::<u64>() + self.uniform.bytes()
    }

    /// Resources of the material's group, in the order of [`MaterialLayout::bindings`].
    pub(crate) fn resources(&self) -> Vec<BindingResource<'_>> {
        let uniform = std::iter::once(self.uniform.as_entire_binding());
        uniform.chain(self.textures.iter().map(|surface| BindingResource::TextureView(&surface.view))).collect()
    }

    /// Refuses a material of another layout than a pass was built for.
    pub(crate) fn expect(&self, layout: MaterialLayout) -> Result<()> {
        if self.layout == layout {
            return Ok(());
        }
        Err(Error::Usage(format!("this renderer draws {layout:?}, the material is stored as {:?}", self.layout)))
    }
}

/// Textures of a file, in the order of [`MaterialLayout::bindings`].
struct Planes<'g, 'a> {
    gpu: &'g Gpu,
    /// Width and height of the patch in pixels.
    size: [u32; 2],
    textures: Vec<Surface2d>,
    fills: Vec<Fill<'a>>,
}

impl<'a> Planes<'_, 'a> {
    /// Adds a texture of one layer.
    fn texture(&mut self, spec: &TextureSpec, bytes: &'a [u8]) -> Result<()> {
        let surface = self.gpu.texture(spec)?;
        self.fills.extend(Fill::pieces(&surface.texture, 0, bytes));
        self.textures.push(surface);
        Ok(())
    }

    /// Adds a texture of one texel for each pixel of the patch.
    fn table(&mut self, label: &'static str, format: TextureFormat, bytes: &'a [u8]) -> Result<()> {
        self.texture(&TextureSpec::table(label, self.size, format), bytes)
    }

    /// Adds `count` layers of one texel for each pixel of the patch.
    fn layers(&mut self, label: &'static str, count: u32, format: TextureFormat, bytes: &'a [u8]) -> Result<()> {
        let surface = self.gpu.texture(&TextureSpec::layered(label, self.size, count, format))?;
        let plane = bytes.len() / count as usize;
        for (bytes, layer) in bytes.chunks(plane).zip(0..) {
            self.fills.extend(Fill::pieces(&surface.texture, layer, bytes));
        }
        self.textures.push(surface);
        Ok(())
    }

    /// Adds the table of base profiles, widened to four channels; columns of [`BASE_ROWS`] materials stand beside each other.
    fn base_profiles(&mut self, header: &BssrdfHeader, profiles: Profiles<'_>) -> Result<()> {
        let (format, channel, source) = match profiles {
            Profiles::F32(values) => (TextureFormat::Rgba32Float, 4, values.as_bytes()),
            Profiles::F16(values) => (TextureFormat::Rgba16Float, 2, values.as_bytes()),
        };
        let samples = u32::from(header.samples);
        let width = header.base_materials.div_ceil(BASE_ROWS) * samples;
        let rows = header.base_materials.min(BASE_ROWS);
        let spec = TextureSpec::table("base profiles", [width, rows], format);
        let surface = self.gpu.texture(&spec)?;
        let mut texels = vec![0; (width * rows) as usize * 4 * channel];
        for (number, node) in source.chunks(3 * channel).enumerate() {
            let (base, h) = (number / samples as usize, number % samples as usize);
            let (column, row) = (base / BASE_ROWS as usize * samples as usize + h, base % BASE_ROWS as usize);
            texels[(row * width as usize + column) * 4 * channel..][..3 * channel].copy_from_slice(node);
        }
        self.fills.push(Fill::whole(&surface.texture, texels));
        self.textures.push(surface);
        Ok(())
    }

    /// Adds the planes that say of which base materials a pixel is mixed.
    fn mixtures(&mut self, mixtures: Mixtures<'a>) -> Result<()> {
        match mixtures {
            Mixtures::One(indices) => self.table("base indices", TextureFormat::R8Uint, indices),
            Mixtures::OneOfMany(indices) => self.table("base indices", TextureFormat::R16Uint, indices.as_bytes()),
            Mixtures::Two { ratios, indices } => {
                self.table("mixture ratios", TextureFormat::R32Float, ratios.as_bytes())?;
                self.table("base indices", TextureFormat::Rg8Uint, indices.as_flattened())
            }
            Mixtures::TwoSmall { ratios, indices } => {
                self.table("mixture ratios", TextureFormat::R8Unorm, ratios)?;
                self.table("base indices", TextureFormat::Rg8Uint, indices.as_flattened())
            }
            Mixtures::Palette { pairs, codes } => {
                self.table("palette codes", TextureFormat::R16Uint, codes.as_bytes())?;
                let count = u32::try_from(pairs.len()).unwrap_or(u32::MAX);
                self.texture(&TextureSpec::table("pairs", [count, 1], TextureFormat::Rg8Uint), pairs.as_flattened())
            }
            Mixtures::Several { ratios, indices, count } => {
                let count = u32::try_from(count).unwrap_or(u32::MAX);
                self.layers("mixture ratios", count, TextureFormat::R32Float, ratios.as_bytes())?;
                self.layers("base indices", count, TextureFormat::R8Uint, indices)
            }
        }
    }
}
