//! Capture and file evaluated side by side, on every measured pair.

use subsurf_decoder::Bssrdf;

use super::light::Light;
use super::relit::Relit;
use crate::capture::Capture;
use crate::error::{Error, Result};
use crate::math::parallel;
use crate::metrics::image::{psnr_db, ssim};
use crate::progress::Progress;

/// Diffuse albedo ρ_d(x) = Σ_y Rd(x, y) pitch² of light that enters at x, and the patch under each of [`Light::ALL`].
///
/// Only pairs that the capture measured count, on both sides.
pub struct Comparison {
    /// Diffuse albedo of every pixel, from the capture and from the file.
    pub albedo: Relit,
    /// Exitance under uniform, disc and line light.
    pub lit: [Relit; 3],
}

/// Error of a file against its capture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BssrdfError {
    /// Mean relative error of the diffuse albedo, see [`Relit::mean_relative_error`].
    pub relative_error: f64,
    /// PSNR in dB under each of [`Light::ALL`], see [`Comparison::psnr_db`].
    pub psnr_db: [Option<f64>; 3],
}

impl Comparison {
    /// The numbers that say how far the file is from the capture.
    #[must_use]
    pub fn error(&self) -> BssrdfError {
        BssrdfError { relative_error: self.albedo.mean_relative_error(), psnr_db: self.psnr_db() }
    }

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

/// Comparison of a capture with a file on every measured pair.
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
    let mut faint = 0;
    progress.begin("comparing", pixels as u64);
    let firsts: Vec<usize> = (0..capture.height()).step_by(BLOCK_ROWS).collect();
    for firsts in firsts.chunks(BLOCKS_AT_ONCE) {
        let blocks: Vec<(Comparison, u64)> = parallel::map(firsts.len(), |k| {
            let mut block = new();
            let mut faint = 0;
            let last = (firsts[k] + BLOCK_ROWS).min(capture.height());
            for y in firsts[k]..last {
                for x in 0..capture.width() {
                    faint += add_source(capture, material, [x, y], &mut block);
                }
                progress.advance(capture.width() as u64);
            }
            (block, faint)
        });
        for (block, of_block) in &blocks {
            faint += of_block;
            total.albedo.add(&block.albedo);
            for (total, block) in total.lit.iter_mut().zip(&block.lit) {
                total.add(block);
            }
        }
    }
    if faint > 0 {
        progress.warn(&capture.faint_warning(faint));
    }
    Ok(total)
}

/// Adds the light that enters at one pixel to where it leaves; returns how many values are too small for a measurement.
fn add_source(capture: &Capture, material: &Bssrdf<'_>, [x, y]: [usize; 2], sums: &mut Comparison) -> u64 {
    let size = [capture.width(), capture.height()];
    let source = y * size[0] + x;
    let mut window = vec![0.0; capture.window_len()];
    let faint = capture.read_window(source, &mut window);
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
    faint
}
