//! BTFs on the device: the file as it is.

use subsurf_decoder::NestedBtf;
use subsurf_shaders::BtfLayout;
use subsurf_shaders::uniform::{BtfCodebooks, BtfTexture};
use wgpu::{BindingResource, Buffer, TextureFormat};

use crate::error::{Error, Result};
use crate::gpu::{Fill, Gpu, Purpose, Surface2d, TextureSpec, Tracked};

/// BTF on the device: its file, word by word, and a block that says where its codebooks are; or its images.
#[derive(Debug)]
pub struct BtfMaterial {
    layout: BtfLayout,
    /// Mipmap levels of each material.
    textures: Vec<BtfTexture>,
    texture: Surface2d,
    block: Tracked<Buffer>,
}

impl BtfMaterial {
    /// Uploads a file as it is, in 32-bit words: it takes as many bytes on the device as on the disk, and less than one
    /// row of 8 KiB and 2 KiB more.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if the device takes no texture of that size.
    pub fn upload(gpu: &Gpu, btf: &NestedBtf<'_>) -> Result<Self> {
        let (material, fills) = Self::begin(gpu, btf)?;
        fills.iter().try_for_each(|fill| fill.write(gpu))?;
        Ok(material)
    }

    /// Makes the texture of a file; it has to be filled.
    ///
    /// # Errors
    /// As [`BtfMaterial::upload`].
    pub(crate) fn begin<'a>(gpu: &Gpu, btf: &NestedBtf<'a>) -> Result<(Self, Vec<Fill<'a>>)> {
        let file = btf.file();
        let too_large = || Error::Unsupported { what: "bytes of a BTF", need: file.len() as u64, have: 512 << 20 };
        let books = BtfCodebooks::of(btf).ok_or_else(too_large)?;
        let materials = usize::from(btf.header().materials);
        let textures = (0..materials).filter_map(|number| BtfTexture::of(btf, number)).collect();
        let words = gpu.texture(&TextureSpec::array("BTF", file.len().div_ceil(4), TextureFormat::R32Uint))?;
        let fills = Fill::pieces(&words.texture, 0, file).collect();
        let block = gpu.uniform(Purpose::Material, "codebooks", &books);
        Ok((Self::new(BtfLayout::Nested, textures, words, block), fills))
    }

    pub(super) fn new(
        layout: BtfLayout,
        textures: Vec<BtfTexture>,
        texture: Surface2d,
        block: Tracked<Buffer>,
    ) -> Self {
        Self { layout, textures, texture, block }
    }

    /// Layout of the BTF on the device.
    #[must_use]
    pub fn layout(&self) -> BtfLayout {
        self.layout
    }

    /// Refuses a BTF of another layout than a pass was built for.
    pub(crate) fn expect(&self, layout: BtfLayout) -> Result<()> {
        if self.layout == layout {
            return Ok(());
        }
        Err(Error::Usage(format!("this draws BTFs as {layout:?}, the material is stored as {:?}", self.layout)))
    }

    /// Bytes of textures and blocks on the device.
    #[must_use]
    pub fn gpu_bytes(&self) -> u64 {
        self.texture.texture.bytes() + self.block.bytes()
    }

    /// Mipmap levels of each material.
    pub(crate) fn textures(&self) -> &[BtfTexture] {
        &self.textures
    }

    /// Resources of its group, in the order of [`BtfLayout::bindings`].
    pub(crate) fn resources(&self) -> [BindingResource<'_>; 2] {
        [self.block.as_entire_binding(), BindingResource::TextureView(&self.texture.view)]
    }
}
