//! The device that everything is drawn with.

use std::fmt;

use half::f16;
use subsurf_shaders::TargetFormat;
use wgpu::rwh::HasDisplayHandle;
use wgpu::wgt::WgpuHasDisplayHandle;
use wgpu::{
    Adapter, AdapterInfo, Buffer, BufferDescriptor, BufferSize, BufferUsages, Color, Device, DeviceDescriptor,
    ErrorFilter, ExperimentalFeatures, Extent3d, Features, Instance, InstanceDescriptor, Limits, MemoryHints, Queue,
    RequestAdapterOptions, Surface, SurfaceTarget, TextureDescriptor, TextureDimension, TextureFormat, TextureUsages,
    Trace,
};

use super::backend::{Backend, adapters, instance, ready};
use super::cache::PipelineCache;
use super::ledger::Ledger;
use crate::error::{Error, Result};

/// What timing passes takes. A device that has it is opened with it; none needs it.
pub(crate) const TIMESTAMPS: Features = Features::TIMESTAMP_QUERY.union(Features::TIMESTAMP_QUERY_INSIDE_ENCODERS);
/// What is written to find out whether a device is lost.
const PROBE: [u8; 4] = [0; 4];

/// Device and queue, within the limits of WebGL2, and the ledger of what lives on the device.
#[derive(Debug)]
pub struct Gpu {
    pub(crate) device: Device,
    pub(crate) queue: Queue,
    target_format: TargetFormat,
    info: AdapterInfo,
    ledger: Ledger,
    /// Full-screen passes that were compiled, with their targets: loads share them.
    pub(super) fullscreen: PipelineCache,
    /// Room for [`PROBE`].
    probe: Buffer,
}

/// Device that draws to a window, and what it takes to make the window's surface anew when it is lost.
#[derive(Debug)]
pub struct OnScreen<'w> {
    /// Device that draws to the surface.
    pub gpu: Gpu,
    /// Surface of the window, not configured yet. Drop it before the window.
    pub surface: Surface<'w>,
    /// Entry to the API, which made the surface.
    pub instance: Instance,
    /// Adapter, which knows the formats of the surface.
    pub adapter: Adapter,
}

/// Device that was opened before there is a window, and what it takes to draw to windows that come and go, as they do on Android
/// with every pause of an app.
#[derive(Debug)]
pub struct OffScreen {
    /// Device.
    pub gpu: Gpu,
    /// Entry to the API, which makes surfaces of windows.
    pub instance: Instance,
    /// Adapter, which knows what surfaces it can draw to, and their formats.
    pub adapter: Adapter,
}

/// Format of targets: half floats where they can be drawn to, which takes GL_EXT_color_buffer_half_float or GL_EXT_color_buffer_float.
fn target_format_of(device: &Device) -> TargetFormat {
    let scope = device.push_error_scope(ErrorFilter::Validation);
    let _ = device.create_texture(&TextureDescriptor {
        label: Some("probe"),
        size: Extent3d::default(),
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format: TextureFormat::Rgba16Float,
        usage: TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    if ready(scope.pop()).flatten().is_some() { TargetFormat::Packed } else { TargetFormat::Half }
}

impl Gpu {
    /// Opens the best device of a backend, without a window, within `Limits::downlevel_webgl2_defaults()` but for the
    /// size of textures.
    ///
    /// # Errors
    /// [`Error::NoDevice`] if the driver lists none, or refuses it.
    pub fn open(backend: Backend) -> Result<Self> {
        Ok(Self::open_off_screen(backend, None)?.gpu)
    }

    /// Opens the best device of a backend, within the same limits, for windows that come later: those of a display, where the
    /// window system has one; Android's needs none.
    ///
    /// # Errors
    /// [`Error::NoDevice`] if the driver lists none, or refuses it.
    pub fn open_off_screen(backend: Backend, display: Option<Box<dyn WgpuHasDisplayHandle>>) -> Result<OffScreen> {
        let instance = Instance::new(InstanceDescriptor { display, ..instance(backend) });
        let none = || Error::NoDevice { backend, reason: "the driver lists none".to_owned() };
        let adapter = adapters(&instance, backend).into_iter().next().ok_or_else(none)?;
        Ok(OffScreen { gpu: Self::of(&adapter, backend)?, instance, adapter })
    }

    /// Opens the best device of a backend that draws to a window, within the same limits.
    ///
    /// # Errors
    /// [`Error::NoDevice`] if the driver lists none for this window, or refuses it.
    pub fn open_for<'w>(
        backend: Backend,
        display: impl HasDisplayHandle + fmt::Debug + Send + Sync + 'static,
        window: impl Into<SurfaceTarget<'w>>,
    ) -> Result<OnScreen<'w>> {
        let none = |reason: String| Error::NoDevice { backend, reason };
        let instance = Instance::new(instance(backend).with_display_handle(Box::new(display)));
        let surface = instance.create_surface(window).map_err(|error| none(error.to_string()))?;
        let adapter = adapters(&instance, backend).into_iter().find(|adapter| adapter.is_surface_supported(&surface));
        // WebGL2 has a device only for who has the canvas.
        let of_surface = || {
            let options = RequestAdapterOptions { compatible_surface: Some(&surface), ..Default::default() };
            ready(instance.request_adapter(&options)).and_then(|adapter| adapter.ok())
        };
        let adapter = adapter
            .or_else(of_surface)
            .ok_or_else(|| none("the driver lists none that draws to this window".to_owned()))?;
        Ok(OnScreen { gpu: Self::of(&adapter, backend)?, surface, instance, adapter })
    }

    fn of(adapter: &Adapter, backend: Backend) -> Result<Self> {
        let request = adapter.request_device(&DeviceDescriptor {
            label: Some("subsurf"),
            required_features: adapter.features() & TIMESTAMPS,
            required_limits: Limits::downlevel_webgl2_defaults().using_resolution(adapter.limits()),
            experimental_features: ExperimentalFeatures::disabled(),
            memory_hints: MemoryHints::MemoryUsage,
            trace: Trace::Off,
        });
        let none = |reason: String| Error::NoDevice { backend, reason };
        let opened = ready(request).ok_or_else(|| none("it is not opened at once".to_owned()))?;
        let (device, queue) = opened.map_err(|error| none(error.to_string()))?;
        Ok(Self::from_device(device, queue, adapter.get_info()))
    }

    /// Wraps a device that the caller owns; `info` is what its adapter says. `Limits::downlevel_webgl2_defaults()` are enough.
    #[must_use]
    pub fn from_device(device: Device, queue: Queue, info: AdapterInfo) -> Self {
        let target_format = target_format_of(&device);
        let probe = device.create_buffer(&BufferDescriptor {
            label: Some("probe"),
            size: PROBE.len() as u64,
            usage: BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let (ledger, fullscreen) = (Ledger::default(), PipelineCache::default());
        Self { target_format, device, queue, info, ledger, fullscreen, probe }
    }

    /// Storage of intermediate targets.
    #[must_use]
    pub fn target_format(&self) -> TargetFormat {
        self.target_format
    }

    /// The same device with another layout of intermediate targets: for drivers that claim to draw to half floats and fail.
    #[must_use]
    pub fn with_target_format(self, target_format: TargetFormat) -> Self {
        Self { target_format, fullscreen: PipelineCache::default(), ..self }
    }

    /// Texture format of intermediate targets.
    pub(crate) fn target_texture_format(&self) -> TextureFormat {
        match self.target_format {
            TargetFormat::Half => TextureFormat::Rgba16Float,
            TargetFormat::Packed => TextureFormat::Rgba16Uint,
        }
    }

    /// Colour to clear an intermediate target with.
    pub(crate) fn clear_colour(&self, colour: Color) -> Color {
        match self.target_format {
            TargetFormat::Half => colour,
            TargetFormat::Packed => {
                let bits = |value: f64| f16::from_f64(value).to_bits().into();
                Color { r: bits(colour.r), g: bits(colour.g), b: bits(colour.b), a: bits(colour.a) }
            }
        }
    }

    /// Refuses to do what takes half floats that can be drawn to.
    pub(crate) fn expect_half_targets(&self, what: &'static str) -> Result<()> {
        match self.target_format {
            TargetFormat::Half => Ok(()),
            TargetFormat::Packed => Err(Error::NoHalfFloats { what }),
        }
    }

    /// Device, for passes of the host's own.
    #[must_use]
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// Queue of the device.
    #[must_use]
    pub fn queue(&self) -> &Queue {
        &self.queue
    }

    /// Name, kind and driver of the device.
    #[must_use]
    pub fn info(&self) -> &AdapterInfo {
        &self.info
    }

    /// Ledger of the bytes on the device.
    #[must_use]
    pub fn ledger(&self) -> &Ledger {
        &self.ledger
    }

    /// Runs `work`.
    ///
    /// # Errors
    /// [`Error::Device`] with the first complaint of the device about it.
    pub(crate) fn checked<T>(&self, work: impl FnOnce() -> T) -> Result<T> {
        // Shader errors of GLES come as internal ones.
        let filters = [ErrorFilter::Validation, ErrorFilter::Internal, ErrorFilter::OutOfMemory];
        let scopes = filters.map(|filter| self.device.push_error_scope(filter));
        let result = work();
        let mut failed = None;
        for scope in scopes.into_iter().rev() {
            failed = failed.or(ready(scope.pop()).flatten());
        }
        failed.map_or(Ok(result), |error| Err(Error::Device(error.to_string())))
    }

    /// Writes to a buffer before the next submission.
    ///
    /// # Errors
    /// [`Error::Device`] if the device is lost: it takes everything else in silence then.
    pub(crate) fn write(&self, buffer: &Buffer, bytes: &[u8]) -> Result<()> {
        let lost = || Error::Device("it is lost: open another one, and load again".to_owned());
        let size = BufferSize::new(bytes.len() as u64).ok_or_else(lost)?;
        let mut staging = self.checked(|| self.queue.write_buffer_with(buffer, 0, size))?.ok_or_else(lost)?;
        staging.copy_from_slice(bytes);
        Ok(())
    }

    /// Refuses to go on with a device that is lost.
    ///
    /// # Errors
    /// [`Error::Device`] if it is.
    pub fn expect_alive(&self) -> Result<()> {
        self.write(&self.probe, &PROBE)
    }

    /// Submits what is still waiting to be uploaded, and waits until the device has done everything.
    ///
    /// # Errors
    /// [`Error::Device`] if the device is lost.
    pub fn finish(&self) -> Result<()> {
        self.queue.submit([]);
        loop {
            // The GL backend gives up after two seconds of waiting, however long it was asked to wait.
            match self.device.poll(wgpu::PollType::wait_indefinitely()) {
                Ok(_) => return self.expect_alive(),
                Err(wgpu::PollError::Timeout) => {}
                Err(error) => return Err(Error::Device(error.to_string())),
            }
        }
    }
}
