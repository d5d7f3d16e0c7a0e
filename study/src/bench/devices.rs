//! Devices to measure.

use subsurf_cli::outln;
use subsurf_runtime::{Backend, Gpu, TargetFormat};

/// The devices that draw by every path, and what they are.
pub(super) fn to_compare() -> Vec<(Backend, Gpu)> {
    let mut gpus = Vec::new();
    for backend in Backend::ALL {
        match Gpu::open(backend) {
            Ok(gpu) if gpu.target_format() == TargetFormat::Packed => {
                outln!(
                    "{backend}: {} has no half floats to draw to, which splats and flat patches need",
                    gpu.info().name
                );
            }
            Ok(gpu) => {
                outln!("{backend}: {} ({})", gpu.info().name, gpu.info().driver_info);
                gpus.push((backend, gpu));
            }
            Err(_) => outln!("{backend}: no device"),
        }
    }
    gpus
}
