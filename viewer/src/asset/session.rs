//! Session: pictures of one size, of one asset.

use subsurf_runtime::{Frame, Gpu, Input, PictureTarget, Renderer, RuntimeOptions};
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
    /// Picture of the size.
    pub picture: PictureTarget,
    size: [u32; 2],
}

impl RenderSession {
    /// Compiles pipelines and allocates buffers for pictures of `size` pixels.
    ///
    /// # Errors
    /// What the device cannot do, or has no room for.
    pub fn new(gpu: &Gpu, asset: GpuAsset, scene: &Scene, size: [u32; 2], options: RuntimeOptions) -> Result<Self> {
        let renderer = Renderer::for_technique(gpu, asset.technique(), options)?;
        let picture = PictureTarget::new(gpu, size, &options)?;
        let objects = [asset.object(scene.roughness)];
        let frame = renderer.prepare(gpu, &Input::new(scene, &objects, size), size)?;
        Ok(Self { asset, renderer, frame, picture, size })
    }

    /// Hands everything that a frame takes to `draw`.
    ///
    /// # Errors
    /// Those of `draw`.
    pub fn with<T, E>(
        &mut self,
        scene: &Scene,
        draw: impl FnOnce(&Renderer, &mut Frame, &Input<'_>, &PictureTarget) -> std::result::Result<T, E>,
    ) -> std::result::Result<T, E> {
        let objects = [self.asset.object(scene.roughness)];
        draw(&self.renderer, &mut self.frame, &Input::new(scene, &objects, self.size), &self.picture)
    }

    /// Draws a picture: sRGB bytes, row by row from the top.
    ///
    /// # Errors
    /// The device failed.
    pub fn picture(&mut self, gpu: &Gpu, scene: &Scene) -> Result<Vec<[u8; 3]>> {
        Ok(self.with(scene, |renderer, frame, input, picture| renderer.picture(gpu, frame, input, picture))?)
    }

    /// The exposure that suits a picture of a scene.
    ///
    /// # Errors
    /// The device failed.
    pub fn exposure(&mut self, gpu: &Gpu, scene: &Scene) -> Result<f32> {
        self.with(scene, |renderer, frame, input, picture| chosen_exposure(gpu, renderer, frame, input, picture))
    }

    /// Gives a scene the exposure that is `asked` for, else the one that suits its picture.
    ///
    /// # Errors
    /// The device failed.
    pub fn expose(&mut self, gpu: &Gpu, scene: &mut Scene, asked: Option<f32>) -> Result<()> {
        scene.camera.exposure = match asked {
            Some(exposure) => exposure,
            None => self.exposure(gpu, scene)?,
        };
        Ok(())
    }
}

/// The exposure that suits a picture.
pub(crate) fn chosen_exposure(
    gpu: &Gpu,
    renderer: &Renderer,
    frame: &mut Frame,
    input: &Input<'_>,
    picture: &PictureTarget,
) -> Result<f32> {
    let mut failed = Ok(());
    let exposure = exposure_of(|dark| {
        let input = Input { exposure: dark, ..*input };
        renderer.picture(gpu, frame, &input, picture).unwrap_or_else(|error| {
            failed = Err(error);
            Vec::new()
        })
    });
    failed?;
    Ok(exposure)
}
