//! Materials of LinSSS (Yatagawa et al. 2020b) on the device: a rival that is drawn beside our techniques.

use half::f16;
use subsurf_decoder::bssrdf::BssrdfHeader;
use subsurf_shaders::uniform::{Linsss, MAX_LINSSS_GAUSSIANS};

use super::patch_layers::PatchLayers;
use crate::error::{Error, Result};
use crate::gpu::Gpu;

/// Weights and Gaussians of a LinSSS material, Rd = ½ Σ_h (W_h(x_o) + W_h(x_i)) G(r; σ_h), each Gaussian with the integral 1.
#[derive(Clone, Debug)]
pub struct LinsssModel {
    /// Size, pitch, refractive index and addressing of the patch.
    pub header: BssrdfHeader,
    /// Standard deviations σ_h by channel, in pixels of the patch.
    pub sigmas_px: Vec<[f32; 3]>,
    /// Weights W_h of every pixel, row by row; linear Rec. 709, shape `[h][pixel]`.
    pub weights: Vec<Vec<[f32; 3]>>,
    /// Exitance of every pixel under uniform light, by which that of the environment is scattered.
    pub albedo: Vec<[f32; 3]>,
    /// Whether products of blurred weights and blurred light stand for blurs of their products, and a pyramid for the blurs of
    /// light, as the authors draw; else all is blurred.
    pub is_shortcut: bool,
}

/// LinSSS material on the device.
#[derive(Debug)]
pub struct LinsssMaterial {
    header: BssrdfHeader,
    /// Layers W_h, or W_h + G_h * W_h for the shortcut, and the albedo.
    pub(crate) layers: PatchLayers,
    pub(crate) block: Linsss,
    narrowest_px: f32,
}

impl LinsssMaterial {
    /// Brings a material to the device, as half floats.
    ///
    /// # Errors
    /// [`Error::Usage`] for a number of Gaussians that is not 1 to 8, or planes of another size than the patch;
    /// [`Error::Unsupported`] if the device takes no texture of that size.
    pub fn upload(gpu: &Gpu, model: &LinsssModel) -> Result<Self> {
        let LinsssModel { header, sigmas_px, weights, albedo, is_shortcut } = model;
        let count = sigmas_px.len();
        let pixels = header.width as usize * header.height as usize;
        let planes: Vec<&Vec<[f32; 3]>> = weights.iter().chain([albedo]).collect();
        if !(1..=MAX_LINSSS_GAUSSIANS).contains(&count)
            || planes.len() != count + 1
            || planes.iter().any(|plane| plane.len() != pixels)
        {
            let (found, size) = (planes.len(), [header.width, header.height]);
            return Err(Error::Usage(format!(
                "{found} planes for {count} Gaussians on {size:?} pixels; LinSSS has 1 to 8 Gaussians, a plane for each and one more"
            )));
        }
        let layers = PatchLayers::new(gpu, header, count + 1)?;
        for (h, (plane, layer)) in planes.into_iter().zip(0..).enumerate() {
            let blurred = if *is_shortcut && h < count { doubled(plane, header, sigmas_px[h]) } else { plane.clone() };
            fill(gpu, &layers, layer, &blurred, [header.width as usize, header.height as usize]);
        }
        let mut block = Linsss { gaussians: u32::try_from(count).unwrap_or(0), ..Linsss::default() };
        block.is_exact = u32::from(!is_shortcut);
        for (to, sigma) in block.sigmas_mm.iter_mut().zip(sigmas_px) {
            let [r, g, b] = sigma.map(|sigma| sigma * header.pitch_mm);
            *to = [r, g, b, 0.0];
        }
        let narrowest_px = sigmas_px.iter().flatten().copied().fold(f32::INFINITY, f32::min);
        Ok(Self { header: *header, layers, block, narrowest_px })
    }

    /// Size, pitch and window of the patch.
    #[must_use]
    pub fn header(&self) -> &BssrdfHeader {
        &self.header
    }

    /// Bytes on the device.
    #[must_use]
    pub fn gpu_bytes(&self) -> u64 {
        self.layers.bytes()
    }

    /// Number of Gaussians.
    pub(crate) fn gaussians(&self) -> usize {
        self.block.gaussians as usize
    }

    /// Whether it is drawn by the authors' shortcut.
    pub(crate) fn is_shortcut(&self) -> bool {
        self.block.is_exact == 0
    }

    /// Standard deviation of the narrowest Gaussian of any channel, in pixels of the patch.
    pub(crate) fn narrowest_pixels(&self) -> f32 {
        self.narrowest_px
    }
}

/// W + G * W: the addressing of the patch goes on beyond its border.
fn doubled(plane: &[[f32; 3]], header: &BssrdfHeader, sigma_px: [f32; 3]) -> Vec<[f32; 3]> {
    let size = [header.width, header.height];
    let at = |x: i32, y: i32| {
        plane[(header.addressing.map(y, size[1]) * size[0] + header.addressing.map(x, size[0])) as usize]
    };
    let mut out = plane.to_vec();
    for c in 0..3 {
        #[allow(clippy::cast_possible_truncation, reason = "a few dozen pixels")]
        let radius = (4.0 * sigma_px[c]).ceil() as i32;
        #[allow(clippy::cast_precision_loss, reason = "a few dozen pixels")]
        let weight = |d: i32| (-0.5 * (d as f32 / sigma_px[c]).powi(2)).exp();
        let total: f32 = (-radius..=radius).map(weight).sum();
        let along = |from: &dyn Fn(i32, i32) -> f32, [dx, dy]: [i32; 2]| -> Vec<f32> {
            let pixels = (0..size[1].cast_signed()).flat_map(|y| (0..size[0].cast_signed()).map(move |x| [x, y]));
            let sum =
                |[x, y]: [i32; 2]| (-radius..=radius).map(|d| weight(d) * from(x + d * dx, y + d * dy)).sum::<f32>();
            pixels.map(|pixel| sum(pixel) / total).collect()
        };
        let rows = along(&|x, y| at(x, y)[c], [1, 0]);
        let of_rows = |x: i32, y: i32| {
            rows[(header.addressing.map(y, size[1]) * size[0] + header.addressing.map(x, size[0])) as usize]
        };
        let both = along(&of_rows, [0, 1]);
        out.iter_mut().zip(&both).for_each(|(out, blurred)| out[c] += blurred);
    }
    out
}

/// Fills all levels of a layer: means of two by two.
fn fill(gpu: &Gpu, layers: &PatchLayers, layer: u32, plane: &[[f32; 3]], size: [usize; 2]) {
    let (mut plane, mut size) = (plane.to_vec(), size);
    for level in 0..layers.surface.texture.mip_level_count() {
        let texels = plane.iter().flat_map(|[r, g, b]| [*r, *g, *b, 1.0].map(|value| f16::from_f32(value).to_bits()));
        let texels: Vec<u16> = texels.collect();
        gpu.fill_level(&layers.surface.texture, layer, level, bytemuck::cast_slice(&texels));
        let next = size.map(|side| (side / 2).max(1));
        let texel = |x: usize, y: usize| plane[y.min(size[1] - 1) * size[0] + x.min(size[0] - 1)];
        let mean = |x: usize, y: usize| {
            let four =
                [texel(2 * x, 2 * y), texel(2 * x + 1, 2 * y), texel(2 * x, 2 * y + 1), texel(2 * x + 1, 2 * y + 1)];
            [0, 1, 2].map(|c| 0.25 * four.iter().map(|rgb| rgb[c]).sum::<f32>())
        };
        let halved = (0..next[1]).flat_map(|y| (0..next[0]).map(move |x| [x, y])).map(|[x, y]| mean(x, y)).collect();
        (plane, size) = (halved, next);
    }
}
