//! A BTF file on the device, as it is.

use subsurf_decoder::NestedBtf;
use subsurf_shaders::BtfStorage;
use subsurf_shaders::uniform::{BTF_ROW, BtfBooks, BtfTexture};
use wgpu::{BindingResource, Buffer, TextureFormat, TextureView};

use crate::context::Gpu;
use crate::error::{Error, Result};
use crate::ledger::Tracked;
use crate::resource::{ROW, Slot, Surface2d, TextureSpec};

/// A BTF that was uploaded: its file, word by word, with a block that says where its codebooks are; or its images.
#[derive(Debug)]
pub struct BtfMaterial {
    storage: BtfStorage,
    /// Of its materials.
    textures: Vec<BtfTexture>,
    texture: Surface2d,
    view: TextureView,
    block: Tracked<Buffer>,
}

// Shaders split the number of a word by this.
const _: () = assert!(ROW == BTF_ROW, "words stand in rows of plain arrays");

/// Bindings of a BTF's group, but for what says which of its materials is drawn.
pub(crate) fn slots(storage: BtfStorage) -> [Slot; 2] {
    match storage {
        BtfStorage::Nested => [Slot::Uniform, Slot::Uint],
        BtfStorage::Images => [Slot::Uniform, Slot::FloatLayers],
    }
}

impl BtfMaterial {
    /// Uploads a file as it is, in 32-bit words: it takes as many bytes on the device as on the disk, and less than one
    /// row of 8 KiB and 2 KiB more.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if the device takes no texture of that size.
    pub fn upload(gpu: &Gpu, btf: &NestedBtf<'_>) -> Result<Self> {
        let file = btf.file();
        let too_large = || Error::Unsupported { what: "bytes of a BTF", need: file.len() as u64, have: 512 << 20 };
        let books = BtfBooks::of(btf).ok_or_else(too_large)?;
        // Of the last word, zeros are missing.
        let mut bytes = file.to_vec();
        bytes.resize(file.len().next_multiple_of(4), 0);
        let words = TextureSpec::array("BTF", bytes.len() / 4, TextureFormat::R32Uint);
        let materials = usize::from(btf.header().materials);
        let textures = (0..materials).filter_map(|number| BtfTexture::of(btf, number)).collect();
        let words = gpu.filled(&words, &bytes)?;
        let view = words.view.clone();
        Ok(Self::new(BtfStorage::Nested, textures, words, view, gpu.uniform("codebooks", &books)))
    }

    pub(super) fn new(
        storage: BtfStorage,
        textures: Vec<BtfTexture>,
        texture: Surface2d,
        view: TextureView,
        block: Tracked<Buffer>,
    ) -> Self {
        Self { storage, textures, texture, view, block }
    }

    /// How it is stored.
    #[must_use]
    pub fn storage(&self) -> BtfStorage {
        self.storage
    }

    /// Refuses a material of another storage than a pass was built for.
    pub(crate) fn expect(&self, storage: BtfStorage) -> Result<()> {
        if self.storage == storage {
            return Ok(());
        }
        Err(Error::Device(format!("this draws BTFs as {storage:?}, the material is stored as {:?}", self.storage)))
    }

    /// Bytes of its texture and uniforms on the device.
    #[must_use]
    pub fn gpu_bytes(&self) -> u64 {
        self.texture.texture.bytes() + self.block.bytes()
    }

    /// Levels of its materials.
    pub(crate) fn textures(&self) -> &[BtfTexture] {
        &self.textures
    }

    /// Resources of its group, in the order of [`slots`].
    pub(crate) fn resources(&self) -> [BindingResource<'_>; 2] {
        [self.block.as_entire_binding(), BindingResource::TextureView(&self.view)]
    }
}
