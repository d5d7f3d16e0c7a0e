//! Pictures on a device, to draw to and to read back.

use std::ffi::c_void;

use subsurf_c::SubsurfStatus;
use subsurf_c::shared::{Handle, Kind, not_null, write};
use subsurf_runtime::wgpu::TextureFormat;
use subsurf_runtime::{ColourTarget, RuntimeOptions};

use crate::canvas::Canvas;
use crate::fault::{Fault, Result, call};
use crate::gpu::{OpenGpu, SubsurfGpu, close};

/// Picture on a device, of 8 bits to red, green, blue and coverage.
///
/// Ownership: `subsurf_picture_create` gives one, `subsurf_picture_close` takes it back; it keeps its device.
/// Threads: any, one at a time.
pub struct SubsurfPicture {
    /// What is there is a [`Handle`] of [`OpenPicture`].
    _opaque: [u8; 0],
}

/// What is behind a handle.
pub(crate) struct OpenPicture {
    gpu: OpenGpu,
    colour: ColourTarget,
    size: [u32; 2],
    format: TextureFormat,
}

impl Kind for OpenPicture {
    const NAME: &'static str = "SubsurfPicture";
    const WORD: u64 = 0x5ab5_0f11_e0be_0007;
}

impl OpenPicture {
    /// The picture behind a handle.
    ///
    /// # Safety
    /// As [`Handle::of`] says.
    pub(crate) unsafe fn of<'p>(picture: *const SubsurfPicture) -> Result<&'p Self> {
        // SAFETY: the caller's word; what is there is such a handle.
        Ok(unsafe { Handle::<Self>::of("picture", picture.cast()) }?)
    }

    /// Refuses a renderer of another device.
    pub(crate) fn expect_on(&self, gpu: &OpenGpu) -> Result<()> {
        let other = || Fault::invalid("the picture is on another SubsurfGpu than the renderer".to_owned());
        self.gpu.is(gpu).then_some(()).ok_or_else(other)
    }

    pub(crate) fn canvas(&self) -> Canvas<'_> {
        Canvas { view: self.colour.view(), format: self.format, size: self.size }
    }
}

/// Makes a picture.
///
/// `width`, `height`: pixels, 1 to `SubsurfGpuInfo::most_texels`. `*picture_out`: the handle; only written on success.
/// Errors: `INVALID_ARGUMENT`, `UNSUPPORTED`, `OUT_OF_MEMORY`, `DEVICE_LOST`, `DEVICE_FAILED`.
/// Ownership: none besides the handle.
/// Threads: any.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_picture_create(
    gpu: *const SubsurfGpu,
    width: u32,
    height: u32,
    picture_out: *mut *mut SubsurfPicture,
) -> SubsurfStatus {
    call(|| {
        // SAFETY: the caller's handle.
        let gpu = unsafe { OpenGpu::of(gpu) }?;
        not_null("picture_out", picture_out)?;
        if width == 0 || height == 0 {
            return Err(Fault::invalid(format!("{width} x {height} pixels, expected is 1 at least in each direction")));
        }
        let (size, format) = ([width, height], RuntimeOptions::default().format);
        gpu.told(gpu.gpu.expect_alive())?;
        let colour = gpu.told(gpu.gpu.target(size, format))?;
        let handle = Handle::create(OpenPicture { gpu: gpu.clone(), colour, size, format })?.as_ptr().cast();
        // SAFETY: the caller's pointer, which is not null.
        Ok(unsafe { write("picture_out", picture_out, handle) }?)
    })
}

/// Waits until a picture is drawn, and copies it: red, green, blue and coverage of display values, a byte each, rows from the top.
///
/// `pixels`: room for `length` bytes, at least `row_bytes` for each row. `row_bytes`: from one row to the next, at least 4 for each pixel; 0 stands
/// for no gap.
/// Errors: `INVALID_ARGUMENT`, `OUT_OF_MEMORY`, `DEVICE_LOST`, `DEVICE_FAILED`.
/// Ownership: the bytes are the caller's.
/// Threads: any, one at a time for the picture.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_picture_read(
    picture: *const SubsurfPicture,
    pixels: *mut c_void,
    length: usize,
    row_bytes: usize,
) -> SubsurfStatus {
    call(|| {
        // SAFETY: the caller's handle.
        let open = unsafe { OpenPicture::of(picture) }?;
        not_null("pixels", pixels)?;
        let [width, height] = open.size.map(|side| side as usize);
        let least = 4 * width;
        let row_bytes = if row_bytes == 0 { least } else { row_bytes };
        if row_bytes < least {
            return Err(Fault::invalid(format!("row_bytes is {row_bytes}, expected are {least} at least, or 0")));
        }
        let need = row_bytes.saturating_mul(height);
        if length < need {
            return Err(Fault::invalid(format!("length is {length}, expected are {need} bytes at least")));
        }
        let texels = gpu_texels(open)?;
        for (y, row) in texels.chunks_exact(width).enumerate() {
            // SAFETY: rows are within the caller's bytes, and as long as that.
            unsafe {
                let to = pixels.cast::<u8>().add(y * row_bytes);
                row.as_ptr().cast::<u8>().copy_to_nonoverlapping(to, least);
            }
        }
        Ok(())
    })
}

fn gpu_texels(open: &OpenPicture) -> Result<Vec<[u8; 4]>> {
    open.gpu.told(open.gpu.gpu.read_picture(&open.colour))
}

/// Closes a picture. Null is ignored, and so is what is no handle.
///
/// Ownership: the handle is gone, and what is on the device once it is drawn.
/// Threads: any, once no other uses the handle.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_picture_close(picture: *mut SubsurfPicture) {
    close::<OpenPicture, _>(picture);
}
