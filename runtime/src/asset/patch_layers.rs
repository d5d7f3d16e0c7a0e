//! Filtered values over a patch on the device, with mipmap levels.

use half::f16;
use subsurf_decoder::bssrdf::{Addressing, BssrdfHeader};
use subsurf_shaders::Rgb;
use wgpu::{AddressMode, FilterMode, MipmapFilterMode, Sampler, SamplerDescriptor, TextureFormat, TextureView};

use crate::error::Result;
use crate::gpu::{Gpu, Surface2d, TextureSpec, layers_of};

/// Array of filtered values over a patch, rgb, with mipmap levels.
///
/// Indices of base materials cannot be filtered; albedos and coefficients can.
#[derive(Debug)]
pub(crate) struct PatchLayers {
    surface: Surface2d,
    /// View of all layers and levels.
    pub(crate) all: TextureView,
    /// Sampler that filters and wraps as the patch does.
    pub(crate) sampler: Sampler,
}

impl PatchLayers {
    /// Uploads layers, each `[row][column]` over the patch, as half floats.
    ///
    /// # Errors
    /// [`crate::Error::Unsupported`] if the device takes no texture of that size.
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

    /// Bytes on the device.
    pub(crate) fn bytes(&self) -> u64 {
        self.surface.texture.bytes()
    }
}

/// Sampler that is linear between texels and levels. A patch that clamps is mirrored: its border would be drawn out otherwise.
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

/// Next mipmap level: means over the pixels, and parts of pixels, that each of its pixels covers; and its size.
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

/// For each of `to` pixels of a line, which of `from` pixels it covers, and which share of it each covers.
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

/// Mean over a span, with its shares as weights.
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
