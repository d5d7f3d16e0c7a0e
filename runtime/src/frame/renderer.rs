//! Frames: what lights see, light that scatters by a technique, and the picture, recorded one after the other.

use std::sync::Arc;
use std::time::{Duration, Instant};

use subsurf_scene::Scene;
use subsurf_shaders::{MaterialLayout, uniform};
use wgpu::{BindGroup, BindingResource, CommandEncoder, CommandEncoderDescriptor, TextureView};

use super::options::RuntimeOptions;
use super::plan::{self, LEAST_LIGHT_TEXELS, Plan};
use crate::error::{Error, Result};
use crate::gpu::{DEPTH, Gpu, Surface2d, TextureSpec};
use crate::technique::common::{Common, Lap, reflection_sampler};
use crate::technique::drawable::{Drawable, Technique};
use crate::technique::mesh_pass::{MeshPass, Target};
use crate::technique::pipelines::{Bindings, Pipelines};
use crate::technique::tsm::{self, TranslucentShadowMaps};
use crate::technique::{btf, gather, separable, splat};

/// Bytes that uniform blocks of all passes are sure not to exceed.
const UNIFORMS: u64 = 32 << 10;

/// Pipelines of one technique; made at load, never in a frame.
#[derive(Debug)]
pub struct Renderer {
    options: RuntimeOptions,
    technique: Technique,
    tsm_render: MeshPass,
    pipelines: Arc<dyn Pipelines>,
}

/// Buffers, maps and bind groups for pictures of one size of one drawable.
#[derive(Debug)]
pub struct Frame {
    plan: Plan,
    common: Common,
    lights: TranslucentShadowMaps,
    scene: BindGroup,
    depth: Surface2d,
    /// Target of pixels with several samples.
    samples: Option<Surface2d>,
    technique: Technique,
    bindings: Box<dyn Bindings>,
}

impl Renderer {
    /// Compiles the passes of a technique.
    ///
    /// # Errors
    /// [`Error::Device`] if the driver refuses them; captures are not drawn on meshes. [`Error::NoHalfFloats`] for splats
    /// where there is nothing to add them up in.
    pub fn new(gpu: &Gpu, technique: Technique, options: RuntimeOptions) -> Result<Self> {
        let RuntimeOptions { format, samples, light_texels, .. } = options;
        if !light_texels.is_power_of_two() || light_texels < LEAST_LIGHT_TEXELS {
            return Err(Error::Device(format!(
                "light_texels is {light_texels}; it must be a power of two, at least {LEAST_LIGHT_TEXELS}"
            )));
        }
        if let Technique::Gather(MaterialLayout::Capture) | Technique::Splat(MaterialLayout::Capture) = technique {
            return Err(Error::Device("captures are drawn flat, not on meshes".to_owned()));
        }
        let pipelines: Arc<dyn Pipelines> = match technique {
            Technique::Gather(layout) => Arc::new(gather::Passes::new(gpu, layout, format, samples)?),
            Technique::Splat(layout) => Arc::new(splat::Passes::new(gpu, layout, format, samples)?),
            Technique::Separable(terms) => Arc::new(separable::Passes::new(gpu, terms, format, samples)?),
            Technique::Btf(layout) => Arc::new(btf::Passes::new(gpu, layout, options.btf, format, samples)?),
        };
        Ok(Self { options, technique, tsm_render: tsm::pass(gpu)?, pipelines })
    }

    /// Makes room for pictures of `size` pixels of a drawable, within the budget: shadow maps and maps become coarser until
    /// everything fits.
    ///
    /// # Errors
    /// [`Error::OverBudget`] if even the coarsest does not, before anything is allocated;
    /// [`Error::Device`] if the drawable is for another technique.
    pub fn prepare(&self, gpu: &Gpu, drawable: &Drawable<'_>, scene: &Scene, size: [u32; 2]) -> Result<Frame> {
        let lights = u32::try_from(scene.lights.len()).unwrap_or(u32::MAX);
        let plan = Plan {
            size,
            light_texels: self.options.light_texels,
            lights: lights.clamp(1, plan::light_layers(lights)),
            divisor: self.divisor(drawable, scene, size),
            samples: self.options.samples,
        };
        let placement = &drawable.mesh().placement;
        let bytes = |plan: &Plan| {
            let of_picture = plan.picture_bytes(self.options.format);
            self.pipelines.bytes(plan, placement) + of_picture + Common::BYTES + UNIFORMS
        };
        let plan = plan.within(self.options.budget_bytes, gpu.ledger().bytes(), bytes)?;
        let common = Common::new(gpu)?;
        let levels = self.pipelines.light_levels(&plan, placement);
        let lights = TranslucentShadowMaps::new(gpu, &self.tsm_render, &common.block, &plan, levels)?;
        let bindings = self.pipelines.clone().bind(gpu, drawable, &common, &lights, &plan)?;
        let sampler = reflection_sampler(gpu);
        let of_scene = [
            common.block.as_entire_binding(),
            BindingResource::TextureView(&lights.all[0]),
            BindingResource::TextureView(&common.reflections.view),
            BindingResource::Sampler(&sampler),
        ];
        let attachment = |label, format, samples| {
            gpu.texture(&TextureSpec { samples, ..TextureSpec::attachment(label, size, format) })
        };
        Ok(Frame {
            scene: self.pipelines.shade().bind(gpu, 0, &of_scene)?,
            depth: attachment("depth", DEPTH, plan.samples)?,
            samples: match plan.samples {
                1 => None,
                samples => Some(attachment("samples", self.options.format, samples)?),
            },
            plan,
            common,
            lights,
            technique: self.technique,
            bindings,
        })
    }

    /// Pixels of the picture to a side of a texel of the maps.
    fn divisor(&self, drawable: &Drawable<'_>, scene: &Scene, size: [u32; 2]) -> u32 {
        let distance_mm = scene.camera.eye_mm.distance(drawable.mesh().placement.bounds.centre_mm);
        #[allow(clippy::cast_precision_loss, reason = "pictures are a few thousand pixels wide")]
        let pixels_per_mm = 0.5 * size[1] as f32 / (0.5 * scene.camera.fov_y_rad).tan() / distance_mm;
        self.pipelines.divisor(drawable, self.options.light_texels, pixels_per_mm)
    }

    /// Draws a scene to a view of the format and size that were agreed on.
    ///
    /// # Errors
    /// [`Error::Device`] if frame or drawable are for another technique, or the device is lost.
    pub fn draw(
        &self,
        gpu: &Gpu,
        frame: &mut Frame,
        drawable: &Drawable<'_>,
        scene: &Scene,
        target: &TextureView,
    ) -> Result<()> {
        self.update(gpu, frame, drawable, scene)?;
        gpu.checked(|| {
            let encoder = gpu.device.create_command_encoder(&CommandEncoderDescriptor::default());
            let encoder = self.record(encoder, frame, drawable, scene, target, &mut |_, encoder| encoder);
            gpu.queue.submit([encoder.finish()]);
        })
    }

    /// Draws pass by pass, and gives the name of each and the time until the device was through with it. The sum is more than
    /// a frame takes, for nothing overlaps.
    ///
    /// # Errors
    /// [`Error::Device`] if frame or drawable are for another technique, or the device is lost.
    pub fn draw_timed(
        &self,
        gpu: &Gpu,
        frame: &mut Frame,
        drawable: &Drawable<'_>,
        scene: &Scene,
        target: &TextureView,
    ) -> Result<Vec<(&'static str, Duration)>> {
        let mut times = Vec::new();
        let begin = Instant::now();
        self.update(gpu, frame, drawable, scene)?;
        gpu.finish()?;
        times.push(("update", begin.elapsed()));
        let new = || gpu.device.create_command_encoder(&CommandEncoderDescriptor::default());
        let mut failed = Ok(());
        gpu.checked(|| {
            let mut begin = Instant::now();
            let mut lap = |name, encoder: CommandEncoder| {
                gpu.queue.submit([encoder.finish()]);
                failed = gpu.finish().and(std::mem::replace(&mut failed, Ok(())));
                times.push((name, begin.elapsed()));
                begin = Instant::now();
                new()
            };
            self.record(new(), frame, drawable, scene, target, &mut lap);
        })?;
        failed?;
        Ok(times)
    }

    /// Uploads what has changed since the last frame.
    fn update(&self, gpu: &Gpu, frame: &mut Frame, drawable: &Drawable<'_>, scene: &Scene) -> Result<()> {
        if frame.technique != self.technique {
            return Err(Error::Device("the frame is for another technique than the renderer".to_owned()));
        }
        let plan = frame.plan;
        let mut block = uniform::Scene::new(scene, &drawable.mesh().placement, plan.size, plan.light_texels);
        // Lights that came after the frame was prepared have no view: they shine once it is prepared anew.
        block.lights = block.lights.min(plan.lights);
        gpu.queue.write_buffer(&frame.common.block, 0, bytemuck::bytes_of(&block));
        frame.common.show(gpu, scene)?;
        frame.bindings.update(gpu, drawable, scene, &block, &plan)
    }

    /// Records all passes of a frame; `lap` is called after each.
    fn record(
        &self,
        mut encoder: CommandEncoder,
        frame: &Frame,
        drawable: &Drawable<'_>,
        scene: &Scene,
        target: &TextureView,
        lap: Lap<'_>,
    ) -> CommandEncoder {
        let mesh = drawable.mesh();
        let lights = scene.lights.len().min(frame.plan.lights as usize);
        frame.lights.record(&mut encoder, &self.tsm_render, mesh, lights);
        encoder = lap("shadow maps", encoder);
        encoder = frame.bindings.record(encoder, mesh, lights, &frame.plan, lap);
        let (view, resolved) = match &frame.samples {
            Some(samples) => (&samples.view, Some(target)),
            None => (target, None),
        };
        let target = Target { view, clear: self.options.background, resolved };
        let groups = [&frame.scene, frame.bindings.shade()];
        self.pipelines.shade().record(&mut encoder, &[target], &frame.depth.view, &groups, mesh);
        lap("shade", encoder)
    }

    /// Draws a scene and reads the picture back: 8-bit rgb, row by row from the top.
    ///
    /// # Errors
    /// [`Error::Device`] as [`Renderer::draw`], or if the format of the renderer has not four bytes.
    pub fn picture(
        &self,
        gpu: &Gpu,
        frame: &mut Frame,
        drawable: &Drawable<'_>,
        scene: &Scene,
    ) -> Result<Vec<[u8; 3]>> {
        let target = gpu.target(frame.plan.size, self.options.format)?;
        self.draw(gpu, frame, drawable, scene, target.view())?;
        let texels = gpu.read_picture(&target)?;
        Ok(texels.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect())
    }
}

impl Frame {
    /// Sizes that were chosen within the budget.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }
}
