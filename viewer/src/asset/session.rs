//! Session: pictures of one size, of one asset.

use subsurf_runtime::{Frame, Gpu, Renderer, RuntimeOptions};
use subsurf_scene::Scene;

use super::exposure::exposure_of;
use super::gpu::GpuAsset;
use crate::error::Result;

/// Asset, pipelines and buffers to draw pictures of one size with.
pub struct RenderSession {
    /// Material and mesh on the device.
    pub asset: GpuAsset,
    /// Pipelines of the asset's technique.
    pub renderer: Renderer,
    /// Buffers for pictures of the size.
    pub frame: Frame,
}

impl RenderSession {
    /// Compiles pipelines and allocates buffers for pictures of `size` pixels.
    ///
    /// # Errors
    /// What the device cannot do, or has no room for.
    pub fn new(gpu: &Gpu, asset: GpuAsset, scene: &Scene, size: [u32; 2], options: RuntimeOptions) -> Result<Self> {
        let renderer = Renderer::new(gpu, asset.technique(), options)?;
        let frame = renderer.prepare(gpu, &asset.drawable(), scene, size)?;
        Ok(Self { asset, renderer, frame })
    }

    /// Draws a picture: sRGB bytes, row by row from the top.
    ///
    /// # Errors
    /// The device failed.
    pub fn picture(&mut self, gpu: &Gpu, scene: &Scene) -> Result<Vec<[u8; 3]>> {
        Ok(self.renderer.picture(gpu, &mut self.frame, &self.asset.drawable(), scene)?)
    }

    /// The exposure that suits a picture of a scene.
    ///
    /// # Errors
    /// The device failed.
    pub fn exposure(&mut self, gpu: &Gpu, scene: &Scene) -> Result<f32> {
        chosen_exposure(gpu, &self.renderer, &mut self.frame, &self.asset, scene)
    }
}

/// The exposure that suits a picture of an asset.
pub(crate) fn chosen_exposure(
    gpu: &Gpu,
    renderer: &Renderer,
    frame: &mut Frame,
    asset: &GpuAsset,
    scene: &Scene,
) -> Result<f32> {
    let mut scene = scene.clone();
    let mut failed = Ok(());
    let exposure = exposure_of(|dark| {
        scene.camera.exposure = dark;
        renderer.picture(gpu, frame, &asset.drawable(), &scene).unwrap_or_else(|error| {
            failed = Err(error);
            Vec::new()
        })
    });
    failed?;
    Ok(exposure)
}
