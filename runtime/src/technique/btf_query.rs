//! Values and samples of BTFs for lists of directions, as the device computes them.

use subsurf_decoder::btf::Sample;
use subsurf_shaders::BtfLayout;
use subsurf_shaders::passes::{Choice, table};
use wgpu::{BindingResource, CommandEncoderDescriptor, TextureFormat};

use crate::asset::BtfMaterial;
use crate::error::Result;
use crate::gpu::{FullscreenPass, Gpu, Purpose, Rows, Surface2d, TextureSpec, array_size};

/// Texel and directions for which a BTF is evaluated and sampled. Directions are unit vectors: x along the rows, y down the columns, z the normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BtfQuery {
    /// Number of the texel in the file ([`Texel::number`](subsurf_decoder::btf::Texel::number)); of images, row by row.
    pub texel: u32,
    /// Direction towards the light.
    pub light: [f32; 3],
    /// Direction towards the eye.
    pub view: [f32; 3],
    /// Random numbers of the sample, 0 to 1.
    pub random: [f32; 2],
}

/// Value, density and sample for a [`BtfQuery`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BtfAnswer {
    /// Apparent BRDF times π: radiance under light of unit irradiance on a plane that faces it, linear Rec. 709.
    pub value: [f32; 3],
    /// Density with which the sampler draws the query's light, per steradian.
    pub pdf: f32,
    /// Direction towards the light that was drawn, and its density.
    pub sample: Sample,
}

/// Pipeline that answers queries about BTFs of one layout; made once.
#[derive(Debug)]
pub struct BtfQueries {
    layout: BtfLayout,
    pass: FullscreenPass,
}

/// Bits of floats: every GLES 3.0 device draws to integers, but not every one to floats.
const BITS: TextureFormat = TextureFormat::Rgba32Uint;

impl BtfQueries {
    /// Compiles the pass.
    ///
    /// # Errors
    /// [`crate::Error::Device`] if the driver refuses it.
    pub fn new(gpu: &Gpu, layout: BtfLayout) -> Result<Self> {
        let pass = FullscreenPass::new(gpu, table::BTF_QUERY.with(Choice::Btf(layout)), &[BITS; 2])?;
        Ok(Self { layout, pass })
    }

    /// Answers all queries about a material, in f32 of the device.
    ///
    /// # Errors
    /// [`crate::Error::Device`], or [`crate::Error::Unsupported`] for more queries than a texture holds.
    pub fn answer(&self, gpu: &Gpu, material: &BtfMaterial, queries: &[BtfQuery]) -> Result<Vec<BtfAnswer>> {
        material.expect(self.layout)?;
        let size = array_size(queries.len());
        // Halves of the texel's number, which floats hold.
        let halves = |q: &BtfQuery| [q.texel & 0xFFFF, q.texel >> 16].map(|half| half as f32);
        let lights = queries.iter().map(|q| [q.light[0], q.light[1], q.light[2], halves(q)[0]]);
        let views = queries.iter().map(|q| [q.view[0], q.view[1], q.view[2], halves(q)[1]]);
        let randoms = queries.iter().map(|q| [q.random[0], q.random[1], 0.0, 0.0]);
        let purpose = Purpose::Other;
        let list = |label, values: Vec<[f32; 4]>| {
            let plain = TextureSpec::array(label, queries.len(), TextureFormat::Rgba32Float);
            let spec = TextureSpec { purpose, ..plain };
            gpu.filled(&spec, bytemuck::cast_slice(&values))
        };
        let lists =
            [list("lights", lights.collect())?, list("views", views.collect())?, list("randoms", randoms.collect())?];
        let target = |label| gpu.texture(&TextureSpec { purpose, ..TextureSpec::target(label, size, BITS) });
        let answers = [target("values")?, target("samples")?];
        let of_lists = lists.each_ref().map(|list| BindingResource::TextureView(&list.view));
        let groups = [self.pass.bind(gpu, 0, &of_lists)?, self.pass.bind(gpu, 1, &material.resources())?];
        gpu.checked(|| {
            let mut encoder = gpu.device.create_command_encoder(&CommandEncoderDescriptor::default());
            let targets = answers.each_ref().map(|answer| &answer.view);
            self.pass.record(&mut encoder, &targets, &groups.each_ref(), Rows::all(size));
            gpu.queue.submit([encoder.finish()]);
        })?;
        let floats = |answer: &Surface2d| -> Result<Vec<[f32; 4]>> { gpu.read(&answer.texture) };
        let (values, samples) = (floats(&answers[0])?, floats(&answers[1])?);
        let pairs = values.into_iter().zip(samples).take(queries.len());
        let answer = |([r, g, b, pdf], [x, y, z, density]): ([f32; 4], [f32; 4])| BtfAnswer {
            value: [r, g, b],
            pdf,
            sample: Sample { light: [x, y, z], pdf: density },
        };
        Ok(pairs.map(answer).collect())
    }
}
