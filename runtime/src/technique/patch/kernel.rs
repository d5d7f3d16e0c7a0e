//! Blurs of a separable kernel over a whole screen, and plain copies that move as many bytes: for those who time them.

use subsurf_shaders::passes::{Pass, kernel};
use subsurf_shaders::uniform::ScreenDomain;
use wgpu::{BindGroup, BindingResource, Buffer, CommandEncoder, CommandEncoderDescriptor};

use super::surface::PatchLight;
use crate::asset::KernelMaterial;
use crate::error::Result;
use crate::gpu::{FullscreenPass, Gpu, HALF, Purpose, Rows, Surface2d, TextureSpec, Tracked};

/// Screen that a plane of a homogeneous material covers, parallel to it.
#[derive(Debug)]
pub struct KernelScreen {
    passes: [FullscreenPass; 3],
    /// Light that enters; light blurred along rows; sums of terms by turns.
    maps: [Surface2d; 4],
    /// Along rows and along columns, for each term.
    terms: Vec<[BindGroup; 2]>,
    /// Copies of the light that enters, and of what that gave.
    copies: [BindGroup; 2],
    size: [u32; 2],
    /// What the bind groups read.
    _domain: Tracked<Buffer>,
}

/// Places of the maps.
const ENTERED: usize = 0;
const BETWEEN: usize = 1;
const SUMS: usize = 2;

impl KernelScreen {
    /// Screen of `size` texels, of which `texels_per_mm` lie on a mm, as many as `light` has.
    ///
    /// # Errors
    /// [`crate::Error::Usage`] for light of another size; [`crate::Error::NoHalfFloats`]; the device has no room for it.
    pub fn new(
        gpu: &Gpu,
        material: &KernelMaterial,
        light: &PatchLight,
        size: [u32; 2],
        texels_per_mm: f32,
        is_jittered: bool,
    ) -> Result<Self> {
        gpu.expect_half_targets("timed blurs of kernels")?;
        light.expect(size)?;
        let compiled = |pass: &'static Pass| FullscreenPass::new(gpu, pass.only(), &[HALF]);
        let passes = [compiled(&kernel::BLUR_KERNEL)?, compiled(&kernel::SUM_KERNEL)?, compiled(&kernel::COPY)?];
        let map = |label| gpu.texture(&TextureSpec::target(label, size, HALF));
        let maps = [map("light that enters")?, map("light blurred along rows")?, map("sums")?, map("sums")?];
        // Parallel: a mm covers as much everywhere.
        let domain = ScreenDomain {
            size,
            focal_texels: [texels_per_mm; 2],
            middle_mm: 1.0,
            pitch_mm: 1.0,
            perspective: 0.0,
            is_jittered: is_jittered.into(),
        };
        let domain = gpu.uniform(Purpose::Frame, "screen", &domain);
        let texture = BindingResource::TextureView;
        let terms = (0..material.terms()).map(|term| {
            let ([along_rows, along_columns], screen) = (material.term(term), domain.as_entire_binding());
            let [entered, between, before] = [ENTERED, BETWEEN, SUMS + term % 2].map(|k| &maps[k].view);
            Ok([
                passes[0].bind(gpu, 0, &[along_rows, screen.clone(), texture(entered)])?,
                passes[1].bind(gpu, 0, &[along_columns, screen, texture(between), texture(before)])?,
            ])
        });
        let terms = terms.collect::<Result<_>>()?;
        let copies = [
            passes[2].bind(gpu, 0, &[texture(&maps[ENTERED].view)])?,
            passes[2].bind(gpu, 0, &[texture(&maps[BETWEEN].view)])?,
        ];
        let of_light = passes[2].bind(gpu, 0, &[texture(light.view())])?;
        let screen = Self { passes, maps, terms, copies, size, _domain: domain };
        screen.submitted(gpu, |encoder| screen.pass(encoder, 2, ENTERED, &of_light))?;
        Ok(screen)
    }

    /// Bytes that the blurs of all terms move, if each texel of each map that a pass reads is read once: half floats of light in and
    /// out, and the sum before of columns.
    #[must_use]
    pub fn blur_bytes(&self) -> u64 {
        self.terms.len() as u64 * 5 * self.map_bytes()
    }

    /// Bytes that a copy moves, in and out.
    #[must_use]
    pub fn copy_bytes(&self) -> u64 {
        2 * self.map_bytes()
    }

    /// Blurs all terms, `count` times in one submission.
    ///
    /// # Errors
    /// [`crate::Error::Device`] if the device is lost.
    pub fn blur(&self, gpu: &Gpu, count: usize) -> Result<()> {
        self.submitted(gpu, |encoder| {
            for _ in 0..count {
                for (term, [rows, columns]) in self.terms.iter().enumerate() {
                    self.pass(encoder, 0, BETWEEN, rows);
                    self.pass(encoder, 1, SUMS + (term + 1) % 2, columns);
                }
            }
        })
    }

    /// Copies a map, `count` times in one submission.
    ///
    /// # Errors
    /// [`crate::Error::Device`] if the device is lost.
    pub fn copy(&self, gpu: &Gpu, count: usize) -> Result<()> {
        self.submitted(gpu, |encoder| {
            for turn in 0..count {
                self.pass(encoder, 2, [BETWEEN, SUMS][turn % 2], &self.copies[turn % 2]);
            }
        })
    }

    /// Light after the last blur: linear Rec. 709, row by row.
    ///
    /// # Errors
    /// [`crate::Error::Device`] if the device is lost.
    pub fn read(&self, gpu: &Gpu) -> Result<Vec<[f32; 3]>> {
        gpu.read_rgb(&self.maps[SUMS + self.terms.len() % 2].texture)
    }

    fn map_bytes(&self) -> u64 {
        TextureSpec::target("", self.size, HALF).bytes()
    }

    fn pass(&self, encoder: &mut CommandEncoder, pass: usize, to: usize, group: &BindGroup) {
        self.passes[pass].record(encoder, &[&self.maps[to].view], &[group], Rows::all(self.size));
    }

    fn submitted(&self, gpu: &Gpu, record: impl FnOnce(&mut CommandEncoder)) -> Result<()> {
        gpu.checked(|| {
            let mut encoder = gpu.device.create_command_encoder(&CommandEncoderDescriptor::default());
            record(&mut encoder);
            gpu.queue.submit([encoder.finish()]);
        })
    }
}
