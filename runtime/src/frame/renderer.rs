//! A frame: what lights see, light that scatters by one of the paths, and the picture.

use std::time::{Duration, Instant};

use subsurf_scene::Scene;
use subsurf_shaders::{Storage, uniform};
use wgpu::{BindGroup, BindingResource, CommandEncoder, CommandEncoderDescriptor, TextureView};

use super::drawable::{Drawable, Technique};
use super::options::RuntimeOptions;
use super::plan::{self, LEAST_LIGHT_TEXELS, Plan};
use crate::error::{Error, Result};
use crate::gpu::{DEPTH, Gpu, Surface2d, TextureSpec};
use crate::technique::common::{Common, Lap, reflection_sampler};
use crate::technique::light_views::{self, LightViews};
use crate::technique::mesh_pass::{MeshPass, Target};
use crate::technique::{btf, gather, separable, splat};

/// The pipelines of a path; made at load, never in a frame.
#[derive(Debug)]
pub struct Renderer {
    options: RuntimeOptions,
    light_view: MeshPass,
    passes: Passes,
}

#[derive(Debug)]
enum Passes {
    Gather(gather::Passes),
    Splat(splat::Passes),
    Separable(separable::Passes),
    Btf(btf::Passes),
}

/// Everything that a picture of one size of one model needs on the device.
#[derive(Debug)]
pub struct Frame {
    plan: Plan,
    common: Common,
    lights: LightViews,
    scene: BindGroup,
    depth: Surface2d,
    /// Where pixels have several samples.
    samples: Option<Surface2d>,
    buffers: Buffers,
}

#[derive(Debug)]
#[allow(clippy::large_enum_variant, reason = "one or two at a time, and they stay where they are")]
enum Buffers {
    Gather(gather::Buffers),
    Splat(splat::Buffers),
    Separable(separable::Buffers),
    Btf(btf::Buffers),
}

impl Renderer {
    /// Compiles the passes of a path.
    ///
    /// # Errors
    /// [`Error::Device`] if the driver refuses them; captures are not drawn on meshes. [`Error::NoHalfFloats`] for splats
    /// where there is nothing to add them up in.
    pub fn new(gpu: &Gpu, path: Technique, options: RuntimeOptions) -> Result<Self> {
        let RuntimeOptions { format, samples, light_texels, .. } = options;
        if !light_texels.is_power_of_two() || light_texels < LEAST_LIGHT_TEXELS {
            return Err(Error::Device(format!(
                "light_texels is {light_texels}; it must be a power of two, at least {LEAST_LIGHT_TEXELS}"
            )));
        }
        if let Technique::Gather(Storage::Capture) | Technique::Splat(Storage::Capture) = path {
            return Err(Error::Device("captures are drawn flat, not on meshes".to_owned()));
        }
        let passes = match path {
            Technique::Gather(storage) => Passes::Gather(gather::Passes::new(gpu, storage, format, samples)?),
            Technique::Splat(storage) => Passes::Splat(splat::Passes::new(gpu, storage, format, samples)?),
            Technique::Separable(terms) => Passes::Separable(separable::Passes::new(gpu, terms, format, samples)?),
            Technique::Btf(storage) => Passes::Btf(btf::Passes::new(gpu, storage, options.btf, format, samples)?),
        };
        Ok(Self { options, light_view: light_views::pass(gpu)?, passes })
    }

    /// Makes room for pictures of `size` of a model, within the budget: views of lights and maps become coarser
    /// until everything fits.
    ///
    /// # Errors
    /// [`Error::OverBudget`] if even the coarsest does not, before anything is allocated;
    /// [`Error::Device`] if the model is for another path.
    pub fn prepare(&self, gpu: &Gpu, model: &Drawable<'_>, scene: &Scene, size: [u32; 2]) -> Result<Frame> {
        let lights = u32::try_from(scene.lights.len()).unwrap_or(u32::MAX);
        let plan = Plan {
            size,
            light_texels: self.options.light_texels,
            lights: lights.clamp(1, plan::light_layers(lights)),
            divisor: divisor(scene, model, size, self.options.light_texels),
            samples: self.options.samples,
        };
        let placement = &model.mesh().placement;
        let of_path = |plan: &Plan| match &self.passes {
            Passes::Gather(_) | Passes::Btf(_) => plan.light_bytes(1),
            Passes::Splat(passes) => passes.bytes(plan, placement),
            Passes::Separable(passes) => passes.bytes(plan),
        };
        let bytes = |plan: &Plan| of_path(plan) + plan.picture_bytes(self.options.format) + Common::BYTES + UNIFORMS;
        let plan = plan.within(self.options.budget_bytes, gpu.ledger().bytes(), bytes)?;
        let common = Common::new(gpu)?;
        let levels = match &self.passes {
            Passes::Splat(_) => splat::Levels::new(placement, plan.light_texels).count(),
            Passes::Gather(_) | Passes::Separable(_) | Passes::Btf(_) => 1,
        };
        let lights = LightViews::new(gpu, &self.light_view, &common.block, &plan, levels)?;
        let (shade, buffers) = match (&self.passes, model) {
            (Passes::Gather(passes), Drawable::Gather { mesh, points, material }) => {
                let buffers = gather::Buffers::new(gpu, passes, mesh, material, points, &common)?;
                (&passes.shade, Buffers::Gather(buffers))
            }
            (Passes::Splat(passes), Drawable::Splat { material, .. }) => {
                let buffers = splat::Buffers::new(gpu, passes, material, &common, &lights, &plan, placement)?;
                (&passes.shade, Buffers::Splat(buffers))
            }
            (Passes::Separable(passes), Drawable::Separable { material, .. }) => {
                let buffers = separable::Buffers::new(gpu, passes, material, &common, &lights, &plan)?;
                (&passes.shade, Buffers::Separable(buffers))
            }
            (Passes::Btf(passes), Drawable::Btf { mesh, material, number }) => {
                mesh.expect_tangents()?;
                let buffers = btf::Buffers::new(gpu, passes, material, *number, self.options.btf)?;
                (&passes.shade, Buffers::Btf(buffers))
            }
            _ => return Err(Error::Device("the model is for another path than the renderer".to_owned())),
        };
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
            scene: shade.bind(gpu, 0, &of_scene)?,
            depth: attachment("depth", DEPTH, plan.samples)?,
            samples: match plan.samples {
                1 => None,
                samples => Some(attachment("samples", self.options.format, samples)?),
            },
            plan,
            common,
            lights,
            buffers,
        })
    }

    /// Draws a scene to a view of the format and size that were agreed on.
    ///
    /// # Errors
    /// [`Error::Device`].
    pub fn draw(
        &self,
        gpu: &Gpu,
        frame: &mut Frame,
        model: &Drawable<'_>,
        scene: &Scene,
        target: &TextureView,
    ) -> Result<()> {
        self.update(gpu, frame, model, scene)?;
        gpu.checked(|| {
            let encoder = gpu.device.create_command_encoder(&CommandEncoderDescriptor::default());
            let encoder = self.record(encoder, frame, model, scene, target, &mut |_, encoder| encoder);
            gpu.queue.submit([encoder.finish()]);
        })
    }

    /// The same, pass by pass: what each took until the device was through with it. The sum is more than a frame takes,
    /// for nothing overlaps.
    ///
    /// # Errors
    /// [`Error::Device`].
    pub fn draw_timed(
        &self,
        gpu: &Gpu,
        frame: &mut Frame,
        model: &Drawable<'_>,
        scene: &Scene,
        target: &TextureView,
    ) -> Result<Vec<(&'static str, Duration)>> {
        let mut times = Vec::new();
        let begin = Instant::now();
        self.update(gpu, frame, model, scene)?;
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
            self.record(new(), frame, model, scene, target, &mut lap);
        })?;
        failed?;
        Ok(times)
    }

    /// Uploads what has changed; gathers, where that is the path and the light has changed.
    fn update(&self, gpu: &Gpu, frame: &mut Frame, model: &Drawable<'_>, scene: &Scene) -> Result<()> {
        let mesh = model.mesh();
        let plan = frame.plan;
        let mut block = uniform::Scene::new(scene, &mesh.placement, plan.size, plan.light_texels);
        // Lights that came after the frame was prepared have no view: they shine once it is prepared anew.
        block.lights = block.lights.min(plan.lights);
        gpu.queue.write_buffer(&frame.common.block, 0, bytemuck::bytes_of(&block));
        frame.common.show(gpu, scene)?;
        match (&mut frame.buffers, &self.passes, model) {
            (Buffers::Gather(buffers), Passes::Gather(passes), Drawable::Gather { points, .. }) => {
                buffers.gather(gpu, passes, mesh, points, &block)?;
            }
            (Buffers::Splat(buffers), Passes::Splat(_), _) => buffers.update(gpu, scene, &block, &plan),
            (Buffers::Separable(buffers), Passes::Separable(_), _) => {
                buffers.update(gpu, scene, &block, &plan, self.options.jitters);
            }
            (Buffers::Btf(_), Passes::Btf(_), Drawable::Btf { .. }) => mesh.expect_tangents()?,
            _ => return Err(Error::Device("the frame is for another path than the renderer".to_owned())),
        }
        Ok(())
    }

    /// All passes of a frame; `lap` is called after each.
    fn record(
        &self,
        mut encoder: CommandEncoder,
        frame: &Frame,
        model: &Drawable<'_>,
        scene: &Scene,
        target: &TextureView,
        lap: Lap<'_>,
    ) -> CommandEncoder {
        let mesh = model.mesh();
        let lights = scene.lights.len().min(frame.plan.lights as usize);
        frame.lights.record(&mut encoder, &self.light_view, mesh, lights);
        encoder = lap("light views", encoder);
        let (shade, group) = match (&frame.buffers, &self.passes) {
            (Buffers::Splat(buffers), Passes::Splat(passes)) => {
                encoder = buffers.record(encoder, passes, mesh, lights, &frame.plan, lap);
                (&passes.shade, &buffers.shade)
            }
            (Buffers::Separable(buffers), Passes::Separable(passes)) => {
                encoder = buffers.record(encoder, passes, mesh, lap);
                (&passes.shade, &buffers.shade)
            }
            (Buffers::Gather(buffers), Passes::Gather(passes)) => (&passes.shade, &buffers.shade),
            (Buffers::Btf(buffers), Passes::Btf(passes)) => (&passes.shade, &buffers.shade),
            // Refused by `update`.
            _ => return encoder,
        };
        let (view, resolved) = match &frame.samples {
            Some(samples) => (&samples.view, Some(target)),
            None => (target, None),
        };
        let target = Target { view, clear: self.options.background, resolved };
        shade.record(&mut encoder, &[target], &frame.depth.view, &[&frame.scene, group], mesh);
        lap("shade", encoder)
    }

    /// Draws a scene and reads the picture back: rows of 8-bit values from the top.
    ///
    /// # Errors
    /// [`Error::Device`], also if the format of the renderer has not four bytes.
    pub fn picture(&self, gpu: &Gpu, frame: &mut Frame, model: &Drawable<'_>, scene: &Scene) -> Result<Vec<[u8; 3]>> {
        let target = gpu.target(frame.plan.size, self.options.format)?;
        self.draw(gpu, frame, model, scene, target.view())?;
        let texels = gpu.read_picture(&target)?;
        Ok(texels.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect())
    }
}

impl Frame {
    /// What was chosen within the budget.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }
}

/// Texels of the narrowest Gaussian, σ, at the middle of the scene: maps are made as coarse as that.
const NARROWEST_TEXELS: f32 = 0.8;

/// Pixels of the picture to a side of a texel of the maps.
fn divisor(scene: &Scene, model: &Drawable<'_>, size: [u32; 2], light_texels: u32) -> u32 {
    let placement = &model.mesh().placement;
    let distance = scene.camera.eye_mm.distance(placement.bounds.centre_mm);
    #[allow(clippy::cast_precision_loss, reason = "pictures are a few thousand pixels wide")]
    let pixels_per_mm = 0.5 * size[1] as f32 / (0.5 * scene.camera.fov_y_rad).tan() / distance;
    match model {
        Drawable::Gather { .. } | Drawable::Btf { .. } => 1,
        Drawable::Splat { .. } => splat::divisor(placement, light_texels, pixels_per_mm),
        Drawable::Separable { material, .. } => {
            let narrowest = material.narrowest_pixels() * placement.pitch_mm * pixels_per_mm;
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
            let divisor = (narrowest / NARROWEST_TEXELS).clamp(1.0, 4.0) as u32;
            // Of what is no number nothing is left.
            divisor.max(1)
        }
    }
}

/// Bytes that uniform blocks of all passes are sure not to exceed.
const UNIFORMS: u64 = 32 << 10;
