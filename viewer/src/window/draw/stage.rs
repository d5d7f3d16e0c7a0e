//! Stage: everything on the device, which goes as a whole when the device is lost.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use subsurf_runtime::wgpu::{
    BindGroup, Color, CommandEncoderDescriptor, LoadOp, Operations, PollType, RenderPassColorAttachment,
    RenderPassDescriptor, StoreOp, TextureFormat, TextureView, TextureViewDescriptor,
};
use subsurf_runtime::{Backend, Frame, Gpu, Input, PictureTarget, Plan, Renderer, RuntimeOptions};
use subsurf_scene::{Mesh, Scene};
use web_time::Instant;
use winit::event_loop::EventLoopProxy;
use winit::window::Window;

use super::compose::{Composer, Shows};
use super::painter::{Overlay, Painter};
use super::surface::Canvas;
use crate::asset::{GpuAsset, chosen_exposure};
use crate::error::{Error, Result};
use crate::window::assets::MaterialFile;
use crate::window::event::{Event, EventKind};
use crate::window::job::{Computed, Key};

/// Role of a picture: the one in the window, or what it is compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::window) enum Role {
    Shown,
    Reference,
}

impl Role {
    pub(in crate::window) const ALL: [Self; 2] = [Self::Shown, Self::Reference];
}

/// Size and distance that the buffers of a frame were made for.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Fit {
    size: [u32; 2],
    distance_mm: f32,
}

impl Fit {
    /// The resolution of maps follows the distance; not with every step.
    const MARGIN: f32 = 1.25;

    fn of(scene: &Scene, size: [u32; 2]) -> Self {
        Self { size, distance_mm: scene.camera.eye_mm.distance(scene.camera.target_mm) }
    }

    fn serves(&self, wanted: &Self) -> bool {
        let ratio = self.distance_mm / wanted.distance_mm;
        self.size == wanted.size && (1.0 / Self::MARGIN..=Self::MARGIN).contains(&ratio)
    }
}

/// Picture: what it is of, and its buffers.
struct Drawn {
    key: Key,
    asset: GpuAsset,
    /// `None` where there was no room for them.
    buffers: Option<(Fit, Frame, PictureTarget)>,
}

/// Device, the window's surface, pipelines, and the pictures.
pub(in crate::window) struct Stage {
    pub(in crate::window) gpu: Gpu,
    pub(in crate::window) canvas: Canvas,
    is_lost: Arc<AtomicBool>,
    composer: Composer,
    painter: Painter,
    options: RuntimeOptions,
    /// Pipelines, compiled once for each technique; none before the first.
    renderer: Option<Renderer>,
    drawn: [Option<Drawn>; 2],
    pictures: Option<BindGroup>,
}

impl Stage {
    /// Opens the first of several backends that works.
    pub(in crate::window) fn open(
        backends: &[Backend],
        window: &Arc<Window>,
        options: RuntimeOptions,
        proxy: &EventLoopProxy<Event>,
        number: u32,
    ) -> Result<Self> {
        let mut failed = None;
        for backend in backends {
            match Canvas::open(*backend, window) {
                Ok((canvas, gpu)) => return Ok(Self::new(canvas, gpu, options, proxy, number)),
                Err(error) => failed = Some(error),
            }
        }
        Err(failed.unwrap_or_else(|| Error::Request("no backend to try".to_owned())))
    }

    fn new(canvas: Canvas, gpu: Gpu, options: RuntimeOptions, proxy: &EventLoopProxy<Event>, number: u32) -> Self {
        let (lost, wrong) = (proxy.clone(), proxy.clone());
        let is_lost = Arc::new(AtomicBool::new(false));
        let flag = is_lost.clone();
        gpu.device().set_device_lost_callback(move |_, reason| {
            flag.store(true, Ordering::Relaxed);
            // Nobody is there any more when the window closes.
            let _ = lost.send_event(Event(EventKind::DeviceLost { number, reason }));
        });
        gpu.device().on_uncaptured_error(Arc::new(move |error: subsurf_runtime::wgpu::Error| {
            let _ = wrong.send_event(Event(EventKind::DeviceError(error.to_string())));
        }));
        let format = canvas.format();
        Self {
            composer: Composer::new(&gpu, format),
            painter: Painter::new(&gpu, format),
            renderer: None,
            drawn: [None, None],
            pictures: None,
            options,
            is_lost,
            canvas,
            gpu,
        }
    }

    /// Whether the device is gone; an [`EventKind::DeviceLost`] has come or will.
    pub(in crate::window) fn is_lost(&self) -> bool {
        // The device says so only when it is asked, and has nothing else to say then.
        let _ = self.gpu.device().poll(PollType::Poll);
        self.is_lost.load(Ordering::Relaxed)
    }

    /// Identity of the picture in a role.
    pub(in crate::window) fn key(&self, role: Role) -> Option<&Key> {
        self.drawn[role as usize].as_ref().map(|drawn| &drawn.key)
    }

    /// Whether there is something to show.
    pub(in crate::window) fn has_picture(&self, role: Role) -> bool {
        self.drawn[role as usize].as_ref().is_some_and(|drawn| drawn.buffers.is_some())
    }

    /// What was chosen within the budget.
    pub(in crate::window) fn plan(&self) -> Option<&Plan> {
        let (_, frame, _) = self.drawn[Role::Shown as usize].as_ref()?.buffers.as_ref()?;
        Some(frame.plan())
    }

    /// Bytes of the material and of the mesh that are shown.
    pub(in crate::window) fn model_bytes(&self) -> Option<[u64; 2]> {
        let asset = &self.drawn[Role::Shown as usize].as_ref()?.asset;
        Some([asset.material_bytes(), asset.mesh_bytes()])
    }

    /// Shows what was compared with, and compares with what was shown.
    pub(in crate::window) fn swap(&mut self) {
        self.drawn.swap(0, 1);
        self.pictures = None;
    }

    pub(in crate::window) fn clear(&mut self, role: Role) {
        self.drawn[role as usize] = None;
        self.pictures = None;
    }

    /// Brings another model to the device. What was there goes first: both might not fit.
    pub(in crate::window) fn place(
        &mut self,
        role: Role,
        key: Key,
        computed: &Computed,
        material: &MaterialFile,
        mesh: &Mesh,
    ) -> Result<()> {
        self.clear(role);
        let asset = computed.upload(&self.gpu, material, mesh)?;
        let renderer = match &mut self.renderer {
            Some(renderer) => renderer,
            None => self.renderer.insert(Renderer::new(&self.gpu, self.options)?),
        };
        renderer.compile(&self.gpu, asset.technique())?;
        self.drawn[role as usize] = Some(Drawn { key, asset, buffers: None });
        Ok(())
    }

    /// Draws a picture of the size of the window, and waits for it. How long that took, if there was anything to draw.
    pub(in crate::window) fn draw(&mut self, role: Role, scene: &Scene) -> Result<Option<Duration>> {
        let (Some(drawn), Some(renderer)) = (&mut self.drawn[role as usize], &self.renderer) else {
            return Ok(None);
        };
        let gpu = &self.gpu;
        let fit = Fit::of(scene, self.canvas.size());
        let objects = [drawn.asset.object(scene.roughness)];
        let input = Input::new(scene, &objects, fit.size);
        if !drawn.buffers.as_ref().is_some_and(|(made, ..)| made.serves(&fit)) {
            // The old ones go first, for they count in the budget.
            (drawn.buffers, self.pictures) = (None, None);
            let picture = PictureTarget::new(gpu, fit.size, &self.options)?;
            drawn.buffers = Some((fit, renderer.prepare(gpu, &input, fit.size)?, picture));
        }
        let Some((_, frame, picture)) = &mut drawn.buffers else {
            return Ok(None);
        };
        let begin = Instant::now();
        renderer.draw_now(gpu, frame, &input, &picture.target())?;
        gpu.finish()?;
        Ok(Some(begin.elapsed()))
    }

    /// The exposure that suits what is shown.
    pub(in crate::window) fn exposure(&mut self, scene: &Scene) -> Result<Option<f32>> {
        let shown = &mut self.drawn[Role::Shown as usize];
        let (Some(Drawn { asset, buffers: Some((fit, frame, picture)), .. }), Some(renderer)) = (shown, &self.renderer)
        else {
            return Ok(None);
        };
        let objects = [asset.object(scene.roughness)];
        chosen_exposure(&self.gpu, renderer, frame, &Input::new(scene, &objects, fit.size), picture).map(Some)
    }

    pub(in crate::window) fn painter(&mut self) -> (&mut Painter, &Gpu) {
        (&mut self.painter, &self.gpu)
    }

    /// Shows the picture with the panel over it; whether the window took it.
    pub(in crate::window) fn present(&mut self, shows: Shows, overlay: &Overlay, window: &Window) -> Result<bool> {
        let Some(texture) = self.canvas.texture(&self.gpu)? else {
            return Ok(false);
        };
        let view = texture.texture.create_view(&TextureViewDescriptor::default());
        self.compose(&view, shows, overlay);
        window.pre_present_notify();
        self.gpu.queue().present(texture);
        Ok(true)
    }

    /// What the window shows, row by row from the top.
    pub(in crate::window) fn capture(&mut self, shows: Shows, overlay: &Overlay) -> Result<Vec<[u8; 3]>> {
        let format = self.canvas.format();
        let target = self.gpu.target(self.canvas.size(), format)?;
        self.compose(target.view(), shows, overlay);
        let texels = self.gpu.read_picture(&target)?;
        let is_bgra = matches!(format, TextureFormat::Bgra8Unorm | TextureFormat::Bgra8UnormSrgb);
        let rgb = |[a, b, c, _]: [u8; 4]| if is_bgra { [c, b, a] } else { [a, b, c] };
        Ok(texels.into_iter().map(rgb).collect())
    }

    fn compose(&mut self, target: &TextureView, shows: Shows, overlay: &Overlay) {
        let view = |role: Role| {
            let (_, _, picture) = self.drawn[role as usize].as_ref()?.buffers.as_ref()?;
            Some(picture.view())
        };
        if self.pictures.is_none()
            && let Some(picture) = view(Role::Shown)
        {
            let reference = view(Role::Reference).unwrap_or(picture);
            self.pictures = Some(self.composer.bind(&self.gpu, picture, reference));
        }
        let mut encoder = self.gpu.device().create_command_encoder(&CommandEncoderDescriptor::default());
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("compose"),
            color_attachments: &[Some(RenderPassColorAttachment {
                view: target,
                depth_slice: None,
                resolve_target: None,
                ops: Operations { load: LoadOp::Clear(Color::BLACK), store: StoreOp::Store },
            })],
            depth_stencil_attachment: None,
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        if let Some(pictures) = &self.pictures {
            self.composer.record(&mut pass, pictures, shows);
        }
        self.painter.record(&self.gpu, &mut pass, overlay, self.canvas.size());
        drop(pass);
        self.gpu.queue().submit([encoder.finish()]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn buffers_serve_until_the_size_or_the_resolution_changes() {
        let made = Fit { size: [640, 480], distance_mm: 100.0 };
        for (size, distance_mm, serves) in [
            ([640, 480], 100.0, true),
            ([640, 480], 120.0, true),
            ([640, 480], 130.0, false),
            ([640, 480], 85.0, true),
            ([640, 480], 75.0, false),
            ([641, 480], 100.0, false),
        ] {
            assert_eq!(made.serves(&Fit { size, distance_mm }), serves, "{size:?} at {distance_mm} mm");
        }
    }
}
