//! A factorised material on the device.

use half::f16;
use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::{Addressing, BssrdfHeader};
use subsurf_shaders::cpu::{self, Rgb};
use subsurf_shaders::separable::{Factors, softened};
use subsurf_shaders::uniform;
use wgpu::{AddressMode, Buffer, FilterMode, MipmapFilterMode, Sampler, SamplerDescriptor, TextureFormat, TextureView};

use crate::context::Gpu;
use crate::error::{Error, Result};
use crate::ledger::Tracked;
use crate::material::{Material, layers_of};
use crate::resource::{Surface2d, TextureSpec};

/// Layers of filtered values over a patch, with levels for small pictures.
///
/// Indices of base materials cannot be filtered; albedos and factors can.
#[derive(Debug)]
pub(crate) struct PatchLayers {
    surface: Surface2d,
    pub(crate) all: TextureView,
    pub(crate) sampler: Sampler,
}

impl PatchLayers {
    /// Uploads layers as half floats.
    pub(crate) fn upload(gpu: &Gpu, header: &BssrdfHeader, layers: Vec<Vec<Rgb>>) -> Result<Self> {
        let size = [header.width, header.height];
        let count = u32::try_from(layers.len()).unwrap_or(u32::MAX);
        let levels = size[0].max(size[1]).ilog2() + 1;
        let spec = TextureSpec::layered("layers of the patch", size, count, TextureFormat::Rgba16Float);
        let surface = gpu.texture(&TextureSpec { levels, ..spec })?;
        for (mut pixels, layer) in layers.into_iter().zip(0..) {
            let mut side = size;
            for level in 0..levels {
                // Half floats hold no more.
                let clamped = |value: f32| value.clamp(-65_504.0, 65_504.0);
                let texels = pixels.iter().flat_map(|[r, g, b]| [*r, *g, *b, 1.0].map(clamped));
                let texels: Vec<u16> = texels.map(|value| f16::from_f32(value).to_bits()).collect();
                gpu.checked(|| gpu.fill_level(&surface.texture, layer, level, bytemuck::cast_slice(&texels)))?;
                (pixels, side) = halved(&pixels, side);
            }
        }
        Ok(Self { all: layers_of(&surface), surface, sampler: sampler(gpu, header.addressing) })
    }

    pub(crate) fn bytes(&self) -> u64 {
        self.surface.texture.bytes()
    }
}

/// Refuses factors that are not as many as they say.
fn whole(factors: &Factors) -> Result<()> {
    let detail = factors.detail;
    let error = || Error::Device(format!("factors that are not as many as {detail:?} and the patch take"));
    factors.is_whole().then_some(()).ok_or_else(error)
}

/// Albedo of every pixel under uniform light.
fn albedo(factors: &Factors) -> Vec<Rgb> {
    cpu::separable(factors, &vec![[1.0; 3]; factors.coefficients_of(0).len()])
}

/// A material for splatting: its planes, and its albedo under uniform light.
#[derive(Debug)]
pub struct SplatMaterial {
    pub(crate) planes: Material,
    pub(crate) albedo: PatchLayers,
    /// What softening takes, by [`softened`].
    pub(crate) softened: [Rgb; 8],
}

impl SplatMaterial {
    /// Uploads the planes of a file as they stand in it, and the albedo that its factors give.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if the device takes no texture of that size; [`Error::Device`] if some factors are missing.
    pub fn upload(gpu: &Gpu, material: &Bssrdf<'_>, factors: &Factors) -> Result<Self> {
        whole(factors)?;
        Ok(Self {
            planes: Material::upload(gpu, material)?,
            softened: softened(material),
            albedo: PatchLayers::upload(gpu, material.header(), vec![albedo(factors)])?,
        })
    }

    /// The planes alone.
    #[must_use]
    pub fn planes(&self) -> &Material {
        &self.planes
    }

    /// Bytes on the device.
    #[must_use]
    pub fn gpu_bytes(&self) -> u64 {
        self.planes.gpu_bytes() + self.albedo.bytes()
    }
}

/// A factorised material: factors c_l and albedo over the patch, and the cascade that goes with them.
#[derive(Debug)]
pub struct SeparableMaterial {
    header: BssrdfHeader,
    terms: usize,
    /// c_l, a layer each, and the albedo under uniform light.
    pub(crate) layers: PatchLayers,
    /// Along rows and along columns, for each a.
    stages: Vec<[Tracked<Buffer>; 2]>,
    through: Tracked<Buffer>,
    narrowest_pixels: f32,
}

impl SeparableMaterial {
    /// Uploads factors as half floats.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if the device takes no texture of that size; [`Error::Device`] if some are missing.
    pub fn upload(gpu: &Gpu, factors: &Factors) -> Result<Self> {
        whole(factors)?;
        let terms = factors.detail.terms;
        let layers = (0..terms).map(|l| factors.coefficients_of(l).to_vec()).chain([albedo(factors)]);
        let stages = uniform::Stage::cascade(factors);
        Ok(Self {
            header: factors.header,
            terms,
            layers: PatchLayers::upload(gpu, &factors.header, layers.collect())?,
            through: gpu.uniform("through", &uniform::Through::new(factors)),
            narrowest_pixels: factors.sigmas.first().copied().unwrap_or(1.0),
            stages: stages.iter().map(|axes| axes.map(|block| gpu.uniform("stage", &block))).collect(),
        })
    }

    /// Size, pitch, window and so on.
    #[must_use]
    pub fn header(&self) -> &BssrdfHeader {
        &self.header
    }

    /// L.
    #[must_use]
    pub fn terms(&self) -> usize {
        self.terms
    }

    /// Refuses passes for another number of terms.
    pub(crate) fn expect(&self, terms: usize) -> Result<()> {
        if self.terms == terms {
            return Ok(());
        }
        Err(Error::Device(format!("this renderer draws L = {terms}, the material has L = {}", self.terms)))
    }

    /// Bytes on the device.
    #[must_use]
    pub fn gpu_bytes(&self) -> u64 {
        self.layers.bytes() + self.stages.iter().flatten().chain([&self.through]).map(Tracked::bytes).sum::<u64>()
    }

    /// Weights of all Gaussians.
    pub(crate) fn through(&self) -> &Buffer {
        &self.through
    }

    /// σ of the narrowest Gaussian, in pixels of the patch.
    pub(crate) fn narrowest_pixels(&self) -> f32 {
        self.narrowest_pixels
    }

    pub(crate) fn stages(&self) -> &[[Tracked<Buffer>; 2]] {
        &self.stages
    }
}

/// Linear between texels and levels. A patch that clamps is mirrored: its border would be drawn out otherwise.
fn sampler(gpu: &Gpu, addressing: Addressing) -> Sampler {
    let mode = match addressing {
        Addressing::Repeat => AddressMode::Repeat,
        Addressing::Clamp | Addressing::Mirror => AddressMode::MirrorRepeat,
    };
    gpu.device.create_sampler(&SamplerDescriptor {
        label: Some("patch"),
        address_mode_u: mode,
        address_mode_v: mode,
        mag_filter: FilterMode::Linear,
        min_filter: FilterMode::Linear,
        mipmap_filter: MipmapFilterMode::Linear,
        ..Default::default()
    })
}

/// Means over the pixels, and parts of pixels, that each pixel of the next level covers.
fn halved(pixels: &[Rgb], size: [u32; 2]) -> (Vec<Rgb>, [u32; 2]) {
    let half = size.map(|side| (side / 2).max(1));
    let column = |image: &[Rgb], width: u32, x: u32, y: u32| image[(y * width + x) as usize];
    let across = spans(size[0], half[0]);
    let down = spans(size[1], half[1]);
    let rows: Vec<Rgb> = (0..size[1])
        .flat_map(|y| across.iter().map(move |span| (y, span)))
        .map(|(y, span)| mean(span, |x| column(pixels, size[0], x, y)))
        .collect();
    let all = down.iter().flat_map(|span| (0..half[0]).map(move |x| (x, span)));
    (all.map(|(x, span)| mean(span, |y| column(&rows, half[0], x, y))).collect(), half)
}

/// The pixels of a line of `from` that each of `to` covers, and how much of each.
#[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, reason = "sides are below 65,536")]
#[allow(clippy::cast_sign_loss, reason = "positions are not negative")]
fn spans(from: u32, to: u32) -> Vec<Vec<(u32, f32)>> {
    let step = from as f32 / to as f32;
    let span = |k: u32| {
        let (low, high) = (k as f32 * step, (k + 1) as f32 * step);
        let covered = low as u32..(high.ceil() as u32).min(from);
        let part = |x: u32| (high.min((x + 1) as f32) - low.max(x as f32)).max(0.0) / step;
        covered.map(|x| (x, part(x))).collect()
    };
    (0..to).map(span).collect()
}

fn mean(span: &[(u32, f32)], at: impl Fn(u32) -> Rgb) -> Rgb {
    span.iter().fold([0.0; 3], |sum, &(x, part)| {
        let value = at(x);
        [0, 1, 2].map(|c| sum[c] + part * value[c])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_keep_the_mean() {
        let size = [7, 5];
        let pixels: Vec<Rgb> = (0..35_u8).map(|k| [f32::from(k), f32::from(k % 3), 1.0]).collect();
        let mean = |pixels: &[Rgb], c: usize| pixels.iter().map(|rgb| rgb[c]).sum::<f32>() / pixels.len() as f32;
        let (mut level, mut side) = halved(&pixels, size);
        assert_eq!(side, [3, 2]);
        while side != [1, 1] {
            for c in 0..3 {
                assert!((mean(&level, c) - mean(&pixels, c)).abs() < 1e-4, "{side:?}, channel {c}");
            }
            (level, side) = halved(&level, side);
        }
    }
}
