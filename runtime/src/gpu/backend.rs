//! Graphics APIs, and the devices that a machine has for each.

use std::fmt;

use pollster::block_on;
use wgpu::{Adapter, AdapterInfo, Backends, DeviceType, GlDebugFns, Instance, InstanceDescriptor, InstanceFlags};

/// Graphics API.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Backend {
    /// Vulkan.
    Vulkan,
    /// OpenGL ES 3.0 and up, or OpenGL where that is what the driver opens.
    Gl,
}

impl fmt::Display for Backend {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Vulkan => "Vulkan",
            Self::Gl => "OpenGL ES",
        })
    }
}

impl Backend {
    /// Both APIs.
    pub const ALL: [Self; 2] = [Self::Vulkan, Self::Gl];

    fn flag(self) -> Backends {
        match self {
            Self::Vulkan => Backends::VULKAN,
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
    let mut adapters = block_on(instance.enumerate_adapters(backend.flag()));
    adapters.sort_by_key(|adapter| rank(&adapter.get_info()));
    adapters
}

/// Devices of this machine for an API, the best first.
#[must_use]
pub fn devices(backend: Backend) -> Vec<AdapterInfo> {
    adapters(&Instance::new(instance(backend)), backend).iter().map(Adapter::get_info).collect()
}
