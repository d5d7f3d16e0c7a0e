//! Devices: opening, describing, waiting, losing.

use std::ffi::{c_char, c_void};
use std::mem::offset_of;
use std::ops::Deref;
use std::sync::{Arc, Mutex, PoisonError};

use subsurf_c::SubsurfStatus;
use subsurf_c::shared::{Handle, Kind, Versioned, fill, not_null, write};
use subsurf_runtime::wgpu::{self, Adapter, DeviceType, Instance};
use subsurf_runtime::{Backend, Error, Gpu, OffScreen, Purpose, TargetFormat};

use crate::fault::{Fault, Result, call, one_line};
use crate::input::{one_of, take};
use crate::window::{Display, SubsurfWindowSystem};

/// Graphics API.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SubsurfBackend {
    /// The first that has a device: Vulkan before OpenGL ES; Direct3D 12 before both.
    Automatic = 0,
    /// Vulkan.
    Vulkan = 1,
    /// OpenGL ES 3.0 and newer.
    Gl = 2,
    /// Metal, of Apple's systems.
    Metal = 3,
    /// Direct3D 12, of Windows.
    Dx12 = 4,
}

/// Device that draws, with its queue.
///
/// Ownership: `subsurf_gpu_open` gives one, `subsurf_gpu_close` takes it back; what was made on it keeps what it needs.
/// Threads: any number at once, but for `subsurf_gpu_close`, which needs the handle for itself.
pub struct SubsurfGpu {
    /// What is there is a [`Handle`] of [`OpenGpu`].
    _opaque: [u8; 0],
}

/// How a device is opened. Set `struct_size` to `sizeof(SubsurfGpuOptions)`; zeros are the usual choice.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SubsurfGpuOptions {
    /// Bytes of the caller's struct.
    pub struct_size: u32,
    /// A `SubsurfBackend`.
    pub backend: u32,
    /// A `SubsurfWindowSystem`: whose windows surfaces will be opened of.
    pub window_system: u32,
    /// Display of X11 or Wayland, which the caller keeps open until everything of the device is closed; null for others.
    pub display: *mut c_void,
}

/// Description of a device. Set `struct_size` to `sizeof(SubsurfGpuInfo)` before it is filled.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SubsurfGpuInfo {
    /// Bytes of the caller's struct.
    pub struct_size: u32,
    /// Graphics API.
    pub backend: SubsurfBackend,
    /// Whether the processor draws, without a graphics card.
    pub is_software: u32,
    /// Whether half floats can be drawn to: light is kept in them; without them, splats are not drawn.
    pub draws_half_floats: u32,
    /// Most texels to a side of a texture.
    pub most_texels: u32,
    /// Name of the device in UTF-8, zero-terminated, cut if it is longer.
    pub device: [c_char; 128],
    /// Name and version of its driver, likewise.
    pub driver: [c_char; 256],
}

/// Bytes on a device by their purpose: textures and buffers as they were asked for; what drivers add is not known. Set
/// `struct_size` to `sizeof(SubsurfGpuMemory)` before it is filled.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SubsurfGpuMemory {
    /// Bytes of the caller's struct.
    pub struct_size: u32,
    /// Tables and maps of materials.
    pub materials_bytes: u64,
    /// Vertices and triangles.
    pub meshes_bytes: u64,
    /// What lights see.
    pub light_views_bytes: u64,
    /// Maps and blocks of frames.
    pub frames_bytes: u64,
    /// Pictures, depth, and what is on its way to or from the device.
    pub others_bytes: u64,
}

// SAFETY: `repr(C)`, and the size is first.
unsafe impl Versioned for SubsurfGpuOptions {
    const NAME: &'static str = "SubsurfGpuOptions";
    const FIRST_BYTES: usize = offset_of!(Self, display) + size_of::<*mut c_void>();
}

// SAFETY: `repr(C)`, and the size is first.
unsafe impl Versioned for SubsurfGpuInfo {
    const NAME: &'static str = "SubsurfGpuInfo";
    const FIRST_BYTES: usize = offset_of!(Self, driver) + 256;
}

// SAFETY: `repr(C)`, and the size is first.
unsafe impl Versioned for SubsurfGpuMemory {
    const NAME: &'static str = "SubsurfGpuMemory";
    const FIRST_BYTES: usize = offset_of!(Self, others_bytes) + size_of::<u64>();
}

/// What is behind a handle, and behind everything that was made on the device.
pub(crate) struct SharedGpu {
    pub(crate) gpu: Gpu,
    pub(crate) instance: Instance,
    pub(crate) adapter: Adapter,
    pub(crate) backend: Backend,
    pub(crate) display: Option<Display>,
    /// What the driver complained of that no call was told.
    complaint: Arc<Mutex<Option<String>>>,
}

/// Share of a device.
#[derive(Clone)]
pub(crate) struct OpenGpu(Arc<SharedGpu>);

impl Kind for OpenGpu {
    const NAME: &'static str = "SubsurfGpu";
    const WORD: u64 = 0x5ab5_0f11_e0be_0002;
}

impl Deref for OpenGpu {
    type Target = SharedGpu;

    fn deref(&self) -> &SharedGpu {
        &self.0
    }
}

impl OpenGpu {
    fn open(backend: Backend, display: Option<Display>) -> Result<Self> {
        let of_display = display.map(|display| Box::new(display) as Box<dyn wgpu::wgt::WgpuHasDisplayHandle>);
        let opened = Gpu::open_off_screen(backend, of_display);
        let OffScreen { gpu, instance, adapter } = opened.map_err(|error| Fault::of(&error, None))?;
        let complaint = Arc::new(Mutex::new(None));
        let heard = complaint.clone();
        // By default the process ends.
        gpu.device().on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            *heard.lock().unwrap_or_else(PoisonError::into_inner) = Some(one_line(&error.to_string()));
        }));
        Ok(Self(Arc::new(SharedGpu { gpu, instance, adapter, backend, display, complaint })))
    }

    /// The device behind a handle.
    ///
    /// # Safety
    /// As [`Handle::of`] says.
    pub(crate) unsafe fn of<'g>(gpu: *const SubsurfGpu) -> Result<&'g Self> {
        // SAFETY: the caller's word; what is there is such a handle.
        Ok(unsafe { Handle::<Self>::of("gpu", gpu.cast()) }?)
    }

    /// Whether both are the same device.
    pub(crate) fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl SharedGpu {
    /// Result of what was done on the device, and what the driver complained of meanwhile.
    pub(crate) fn told<T>(&self, result: subsurf_runtime::Result<T>) -> Result<T> {
        let complaint = self.complaint.lock().unwrap_or_else(PoisonError::into_inner).take();
        let result = result.and_then(|value| complaint.map_or(Ok(value), |text| Err(Error::Device(text))));
        result.map_err(|error| Fault::of(&error, Some(&self.gpu)))
    }
}

/// Opens a device: the best of an API, discrete ones first, software last.
///
/// `options`: null for the usual choice, pictures alone. `*gpu_out`: the handle; only written on success.
/// Errors: `INVALID_ARGUMENT`, `NO_DEVICE`, whose text says why; `OUT_OF_MEMORY`.
/// Ownership: the struct is not needed afterwards; a display is, as the struct says.
/// Threads: any. It takes about 10 ms, more with the first use of a driver.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_gpu_open(
    options: *const SubsurfGpuOptions,
    gpu_out: *mut *mut SubsurfGpu,
) -> SubsurfStatus {
    call(|| {
        not_null("gpu_out", gpu_out)?;
        let usual = SubsurfGpuOptions { struct_size: 0, backend: 0, window_system: 0, display: std::ptr::null_mut() };
        // SAFETY: the caller's struct, of numbers and a pointer.
        let options = if options.is_null() { usual } else { unsafe { take("options", options, usual) }? };
        let all: Vec<Option<Backend>> = [None].into_iter().chain(BACKENDS.map(|(_, backend)| Some(backend))).collect();
        let wanted = one_of("backend", options.backend, &all)?;
        let systems = [
            SubsurfWindowSystem::None,
            SubsurfWindowSystem::Android,
            SubsurfWindowSystem::X11,
            SubsurfWindowSystem::Wayland,
        ];
        let display = Display::new(one_of("window_system", options.window_system, &systems)?, options.display)?;
        let wanted: &[Backend] = wanted.as_ref().map_or(&Backend::ALL, std::slice::from_ref);
        let mut opened = Err(Fault::invalid("no backend to try".to_owned()));
        for backend in wanted {
            opened = OpenGpu::open(*backend, display);
            if opened.is_ok() {
                break;
            }
        }
        let handle = Handle::create(opened?)?.as_ptr().cast();
        // SAFETY: the pointer was not null.
        Ok(unsafe { write("gpu_out", gpu_out, handle) }?)
    })
}

/// APIs by their names in the header, in its order from 1 on.
const BACKENDS: [(SubsurfBackend, Backend); 4] = [
    (SubsurfBackend::Vulkan, Backend::Vulkan),
    (SubsurfBackend::Gl, Backend::Gl),
    (SubsurfBackend::Metal, Backend::Metal),
    (SubsurfBackend::Dx12, Backend::Dx12),
];

/// Text in a field of the header, cut between characters, zero-terminated.
fn text<const N: usize>(text: &str) -> [c_char; N] {
    let mut end = text.len().min(N - 1);
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    let mut field = [0; N];
    for (place, byte) in field.iter_mut().zip(&text.as_bytes()[..end]) {
        *place = c_char::from_ne_bytes([*byte]);
    }
    field
}

/// What a device is.
///
/// `info`: filled as far as its `struct_size` reaches.
/// Errors: `INVALID_ARGUMENT`.
/// Ownership: the struct is the caller's.
/// Threads: any.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_gpu_info(gpu: *const SubsurfGpu, info: *mut SubsurfGpuInfo) -> SubsurfStatus {
    call(|| {
        // SAFETY: the caller's handle.
        let open = unsafe { OpenGpu::of(gpu) }?;
        let adapter = open.gpu.info();
        let backend = BACKENDS.iter().find(|(_, backend)| *backend == open.backend);
        let value = SubsurfGpuInfo {
            struct_size: 0,
            backend: backend.map_or(SubsurfBackend::Automatic, |(named, _)| *named),
            is_software: (adapter.device_type == DeviceType::Cpu).into(),
            draws_half_floats: (open.gpu.target_format() == TargetFormat::Half).into(),
            most_texels: open.gpu.device().limits().max_texture_dimension_2d,
            device: text(&adapter.name),
            driver: text(format!("{} {}", adapter.driver, adapter.driver_info).trim()),
        };
        // SAFETY: the caller's struct.
        Ok(unsafe { fill("info", info, value) }?)
    })
}

/// Bytes on a device.
///
/// `memory`: filled as far as its `struct_size` reaches.
/// Errors: `INVALID_ARGUMENT`.
/// Ownership: the struct is the caller's.
/// Threads: any.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_gpu_memory(gpu: *const SubsurfGpu, memory: *mut SubsurfGpuMemory) -> SubsurfStatus {
    call(|| {
        // SAFETY: the caller's handle.
        let ledger = unsafe { OpenGpu::of(gpu) }?.gpu.ledger();
        let value = SubsurfGpuMemory {
            struct_size: 0,
            materials_bytes: ledger.bytes_of(Purpose::Material),
            meshes_bytes: ledger.bytes_of(Purpose::Mesh),
            light_views_bytes: ledger.bytes_of(Purpose::LightView),
            frames_bytes: ledger.bytes_of(Purpose::Frame),
            others_bytes: ledger.bytes_of(Purpose::Other),
        };
        // SAFETY: the caller's struct.
        Ok(unsafe { fill("memory", memory, value) }?)
    })
}

/// Waits until a device has done everything that it was given.
///
/// Errors: `INVALID_ARGUMENT`, `DEVICE_LOST`, `DEVICE_FAILED`.
/// Threads: any.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_gpu_finish(gpu: *const SubsurfGpu) -> SubsurfStatus {
    call(|| {
        // SAFETY: the caller's handle.
        let open = unsafe { OpenGpu::of(gpu) }?;
        open.told(open.gpu.finish())
    })
}

/// Loses a device on purpose, as a reset of its driver would: everything on it fails with `DEVICE_LOST` from now on, and its memory is
/// free. For tests of how an app gets over it.
///
/// Errors: `INVALID_ARGUMENT`.
/// Threads: any.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_gpu_lose(gpu: *const SubsurfGpu) -> SubsurfStatus {
    call(|| {
        // SAFETY: the caller's handle.
        unsafe { OpenGpu::of(gpu) }?.gpu.device().destroy();
        Ok(())
    })
}

/// Closes a device. Null is ignored, and so is what is no handle.
///
/// Ownership: the handle is gone; the device goes with the last that was made on it.
/// Threads: any, once no other uses the handle.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_gpu_close(gpu: *mut SubsurfGpu) {
    close::<OpenGpu, _>(gpu);
}

/// Drops what is behind a handle.
pub(crate) fn close<T: Kind, H>(handle: *mut H) {
    call(|| {
        // SAFETY: the caller's handle, of this kind or another, which is given up.
        unsafe { Handle::<T>::close(handle.cast()) };
        Ok(())
    });
}
