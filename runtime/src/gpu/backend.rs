//! Graphics APIs, and the devices that a machine has for each.

use std::fmt;
use std::pin::pin;
use std::task::{Context, Poll, Waker};

use wgpu::{Adapter, AdapterInfo, Backends, DeviceType, GlDebugFns, Instance, InstanceDescriptor, InstanceFlags};

/// Graphics API.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Backend {
    /// Vulkan.
    Vulkan,
    /// Metal, of Apple's systems.
    Metal,
    /// Direct3D 12, of Windows.
    Dx12,
    /// OpenGL ES 3.0 and up, or OpenGL where that is what the driver opens; in a browser WebGL2.
    Gl,
}

impl fmt::Display for Backend {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Vulkan => "Vulkan",
            Self::Metal => "Metal",
            Self::Dx12 => "Direct3D 12",
            Self::Gl => "OpenGL ES",
        })
    }
}

impl Backend {
    /// APIs of this system, in the order in which they are tried.
    #[cfg(target_vendor = "apple")]
    pub const ALL: [Self; 1] = [Self::Metal];
    /// APIs of this system, in the order in which they are tried.
    #[cfg(windows)]
    pub const ALL: [Self; 3] = [Self::Dx12, Self::Vulkan, Self::Gl];
    /// APIs of a browser.
    #[cfg(target_arch = "wasm32")]
    pub const ALL: [Self; 1] = [Self::Gl];
    /// APIs of this system, in the order in which they are tried.
    #[cfg(not(any(target_vendor = "apple", windows, target_arch = "wasm32")))]
    pub const ALL: [Self; 2] = [Self::Vulkan, Self::Gl];

    fn flag(self) -> Backends {
        match self {
            Self::Vulkan => Backends::VULKAN,
            Self::Metal => Backends::METAL,
            Self::Dx12 => Backends::DX12,
            Self::Gl => Backends::GL,
        }
    }
}

/// Entry to an API, without debug layers.
pub(super) fn instance(backend: Backend) -> InstanceDescriptor {
    let mut descriptor = InstanceDescriptor {
        backends: backend.flag(),
        flags: InstanceFlags::empty(),
        ..InstanceDescriptor::new_without_display_handle()
    };
    // Debug groups crash drivers of Mali and Adreno.
    descriptor.backend_options.gl.debug_fns = GlDebugFns::Disabled;
    descriptor
}

/// Result of a future that is ready at once, as those of all our backends are: nothing is waited for. `None` where a
/// device of the caller's own answers later, as WebGPU's do in a browser.
pub(super) fn ready<T>(future: impl Future<Output = T>) -> Option<T> {
    match pin!(future).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(result) => Some(result),
        Poll::Pending => None,
    }
}

/// Rank of an adapter, 0 the best: discrete GPUs first, software renderers last.
fn rank(info: &AdapterInfo) -> u8 {
    match info.device_type {
        DeviceType::DiscreteGpu => 0,
        DeviceType::IntegratedGpu => 1,
        DeviceType::VirtualGpu => 2,
        DeviceType::Other => 3,
        DeviceType::Cpu => 4,
    }
}

/// Adapters of an API, the best first.
pub(super) fn adapters(instance: &Instance, backend: Backend) -> Vec<Adapter> {
    let mut adapters = ready(instance.enumerate_adapters(backend.flag())).unwrap_or_default();
    adapters.sort_by_key(|adapter| rank(&adapter.get_info()));
    adapters
}

/// Devices of this machine for an API, the best first.
#[must_use]
pub fn devices(backend: Backend) -> Vec<AdapterInfo> {
    adapters(&Instance::new(instance(backend)), backend).iter().map(Adapter::get_info).collect()
}
