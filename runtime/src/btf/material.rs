//! A BTF file on the device, as it is.

use subsurf_decoder::Btf;
use subsurf_shaders::uniform::{BTF_ROW, BtfBooks};
use wgpu::{BindingResource, Buffer, TextureFormat};

use crate::context::Gpu;
use crate::error::{Error, Result};
use crate::ledger::Tracked;
use crate::resource::{ROW, Slot, Surface2d, TextureSpec};

/// A BTF that was uploaded: its file, word by word, and a block that says where its codebooks are.
#[derive(Debug)]
pub struct BtfMaterial {
    words: Surface2d,
    books: Tracked<Buffer>,
}

// Shaders split the number of a word by this.
const _: () = assert!(ROW == BTF_ROW, "words stand in rows of plain arrays");

/// Bindings of a BTF's group.
pub(crate) const SLOTS: [Slot; 2] = [Slot::Uniform, Slot::Uint];

impl BtfMaterial {
    /// Uploads a file as it is, in 32-bit words: it takes as many bytes on the device as on the disk, and less than one
    /// row of 8 KiB and 2 KiB more.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if the device takes no texture of that size.
    pub fn upload(gpu: &Gpu, btf: &Btf<'_>) -> Result<Self> {
        let file = btf.file();
        let too_large = || Error::Unsupported { what: "bytes of a BTF", need: file.len() as u64, have: 512 << 20 };
        let books = BtfBooks::of(btf).ok_or_else(too_large)?;
        // Of the last word, zeros are missing.
        let mut bytes = file.to_vec();
        bytes.resize(file.len().next_multiple_of(4), 0);
        let words = TextureSpec::array("BTF", bytes.len() / 4, TextureFormat::R32Uint);
        Ok(Self { words: gpu.filled(&words, &bytes)?, books: gpu.uniform("codebooks", &books) })
    }

    /// Bytes of its texture and uniforms on the device.
    #[must_use]
    pub fn gpu_bytes(&self) -> u64 {
        self.words.texture.bytes() + self.books.bytes()
    }

    /// Resources of its group, in the order of [`SLOTS`].
    pub(crate) fn resources(&self) -> [BindingResource<'_>; 2] {
        [self.books.as_entire_binding(), BindingResource::TextureView(&self.words.view)]
    }
}
