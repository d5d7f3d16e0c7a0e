//! Diffuse albedo and the patch under three lights, from the capture and from a file (Yatagawa et al. 2020, section 4).

use rayon::prelude::*;
use subsurf_decoder::Bssrdf;

use super::image::{psnr_db, ssim};
use crate::capture::Capture;
use crate::error::{Error, Result};
use crate::progress::Progress;

/// Irradiance patterns on a patch of W pixels width.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Light {
    /// 1 everywhere.
    Uniform,
    /// 1 in a disc of radius W/6 around the centre.
    Disc,
    /// 1 on a vertical line, 4 pixels wide, through the centre.
    Line,
}

impl Light {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Uniform, Self::Disc, Self::Line];

    /// Its name on the command line and in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Uniform => "uniform",
            Self::Disc => "disc",
            Self::Line => "line",
        }
    }

    /// Irradiance at the centre of pixel (x, y) of a patch of `size`.
    #[must_use]
    pub fn irradiance(self, [x, y]: [usize; 2], size: [usize; 2]) -> f32 {
        #[allow(clippy::cast_precision_loss, reason = "sides are below 65,536")]
        let from_centre = |k: usize, n: usize| k as f32 + 0.5 - n as f32 / 2.0;
        let (dx, dy) = (from_centre(x, size[0]), from_centre(y, size[1]));
        #[allow(clippy::cast_precision_loss, reason = "sides are below 65,536")]
        let lit = match self {
            Self::Uniform => true,
            Self::Disc => dx.hypot(dy) <= size[0] as f32 / 6.0,
            Self::Line => dx.abs() <= 2.0,
        };
        f32::from(u8::from(lit))
    }
}

/// A patch as it looks from the capture and from a file, linear Rec. 709, row by row.
#[derive(Clone, Debug)]
pub struct Relit {
    /// From the capture.
    pub reference: Vec<[f64; 3]>,
    /// From the file.
    pub image: Vec<[f64; 3]>,
}

impl Relit {
    fn new(pixels: usize) -> Self {
        Self { reference: vec![[0.0; 3]; pixels], image: vec![[0.0; 3]; pixels] }
    }

    fn add(&mut self, other: &Self) {
        let sums = self.reference.iter_mut().chain(&mut self.image);
        for (sum, value) in sums.zip(other.reference.iter().chain(&other.image)) {
            for c in 0..3 {
                sum[c] += value[c];
            }
        }
    }

    /// Both images divided by the largest value of the reference; `None` if the reference is black.
    #[must_use]
    pub fn normalised(&self) -> Option<Self> {
        let peak = self.reference.iter().flatten().fold(0.0_f64, |peak, &value| peak.max(value));
        if peak <= 0.0 {
            return None;
        }
        let scale = |image: &[[f64; 3]]| image.iter().map(|rgb| rgb.map(|value| value / peak)).collect();
        Some(Self { reference: scale(&self.reference), image: scale(&self.image) })
    }

    /// Mean of [`Relit::relative_errors`] over the pixels that have one.
    #[must_use]
    pub fn mean_relative_error(&self) -> f64 {
        let errors: Vec<f64> = self.relative_errors().into_iter().flatten().collect();
        #[allow(clippy::cast_precision_loss, reason = "pixels fit in 2⁵³")]
        let count = errors.len().max(1) as f64;
        errors.iter().sum::<f64>() / count
    }

    /// Relative error ‖ρ − ρ'‖/‖ρ‖ of every pixel, over the three channels; `None` where the reference is black, for
    /// nothing was measured there.
    #[must_use]
    pub fn relative_errors(&self) -> Vec<Option<f64>> {
        let norm = |rgb: [f64; 3]| rgb.iter().map(|value| value * value).sum::<f64>().sqrt();
        let pairs = self.reference.iter().zip(&self.image);
        pairs
            .map(|(reference, image)| {
                let difference = [0, 1, 2].map(|c| reference[c] - image[c]);
                (norm(*reference) > 0.0).then(|| norm(difference) / norm(*reference))
            })
            .collect()
    }
}

/// Diffuse albedo ρ_d(x) = Σ_y Rd(x, y) pitch² of light that enters at x, and the patch under each of [`Light::ALL`].
///
/// Only pairs that the capture measured count, on both sides.
pub struct Comparison {
    /// Albedo of every pixel.
    pub albedo: Relit,
    /// Exitance under uniform, disc and line light.
    pub lit: [Relit; 3],
}

impl Comparison {
    /// PSNR in dB under each of [`Light::ALL`], peak 1 the reference's largest value; `None` where the light meets
    /// nothing that was measured.
    #[must_use]
    pub fn psnr_db(&self) -> [Option<f64>; 3] {
        self.lit.each_ref().map(|lit| lit.normalised().map(|lit| psnr_db(&lit.reference, &lit.image)))
    }

    /// SSIM of the same pictures, `width` pixels wide; `None` there, too, and for patches smaller than its window.
    #[must_use]
    pub fn ssim(&self, width: usize) -> [Option<f64>; 3] {
        self.lit.each_ref().map(|lit| lit.normalised().and_then(|lit| ssim(&lit.reference, &lit.image, width)))
    }
}

/// Rows whose sums are made apart from those of others, so that results do not depend on the number of threads.
const BLOCK_ROWS: usize = 16;
const BLOCKS_AT_ONCE: usize = 4;

/// Evaluates capture and file on every measured pair.
///
/// # Errors
/// [`Error::Request`] if the file is of another size or window than the capture.
pub fn compare(capture: &Capture, material: &Bssrdf<'_>, progress: &dyn Progress) -> Result<Comparison> {
    let header = material.header();
    let ours = [capture.width(), capture.height(), capture.radius()];
    let theirs = [header.width as usize, header.height as usize, header.window_radius.into()];
    if ours != theirs {
        return Err(Error::Request(format!(
            "the capture has {} × {} pixels and a window radius of {}, the file {} × {} and {}: not the same material",
            ours[0], ours[1], ours[2], theirs[0], theirs[1], theirs[2],
        )));
    }
    let pixels = capture.pixels();
    let new = || Comparison { albedo: Relit::new(pixels), lit: std::array::from_fn(|_| Relit::new(pixels)) };
    let mut total = new();
    progress.begin("comparing", pixels as u64);
    let firsts: Vec<usize> = (0..capture.height()).step_by(BLOCK_ROWS).collect();
    for firsts in firsts.chunks(BLOCKS_AT_ONCE) {
        let blocks: Vec<Comparison> = firsts
            .par_iter()
            .map(|&first| {
                let mut block = new();
                let last = (first + BLOCK_ROWS).min(capture.height());
                for y in first..last {
                    for x in 0..capture.width() {
                        add_source(capture, material, [x, y], &mut block);
                    }
                    progress.advance(capture.width() as u64);
                }
                block
            })
            .collect();
        for block in &blocks {
            total.albedo.add(&block.albedo);
            for (total, block) in total.lit.iter_mut().zip(&block.lit) {
                total.add(block);
            }
        }
    }
    Ok(total)
}

/// Adds the light that enters at one pixel to where it leaves.
fn add_source(capture: &Capture, material: &Bssrdf<'_>, [x, y]: [usize; 2], sums: &mut Comparison) {
    let size = [capture.width(), capture.height()];
    let source = y * size[0] + x;
    let mut window = vec![0.0; capture.window_len()];
    capture.read_window(source, &mut window);
    let irradiance = Light::ALL.map(|light| f64::from(light.irradiance([x, y], size)));
    let area = f64::from(capture.pitch_mm()).powi(2);
    let radius = i32::try_from(capture.radius()).expect("a window radius is below 1,024");
    let signed = |k: usize| i32::try_from(k).expect("a side is below 65,536");
    let from = [signed(x), signed(y)];
    let p_i = material.profile(from);

    let steps = (-radius..=radius).flat_map(|dy| (-radius..=radius).map(move |dx| [dx, dy]));
    for ([dx, dy], rd) in steps.zip(window.as_chunks::<3>().0) {
        let Some(target) = capture.neighbour(x, y, dx, dy) else {
            continue;
        };
        let knot = material.distance_mm(dx, dy).and_then(|r_mm| material.knot(r_mm));
        let model =
            knot.map_or([0.0; 3], |knot| material.rd_at(&p_i, &material.profile([from[0] + dx, from[1] + dy]), knot));
        for c in 0..3 {
            if rd[c] <= 0.0 {
                continue;
            }
            let (reference, image) = (f64::from(rd[c]) * area, f64::from(model[c]) * area);
            sums.albedo.reference[source][c] += reference;
            sums.albedo.image[source][c] += image;
            for (lit, irradiance) in sums.lit.iter_mut().zip(irradiance) {
                lit.reference[target][c] += irradiance * reference;
                lit.image[target][c] += irradiance * image;
            }
        }
    }
}
