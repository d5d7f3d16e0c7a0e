//! Error of BTF files against the images they were made from.

use subsurf_decoder::btf::factored::ExpansionMemory;
use subsurf_decoder::btf::{ColourEncoding, Evaluate};
use subsurf_decoder::{Content, Family, File, ReadError};

use super::image::{psnr_of_mse_db, ssim_of_planes};
use crate::capture::Images;
use crate::math::parallel;
use crate::progress::Progress;

/// Error of a BTF file, means over pairs of directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BtfError {
    /// Mean structural similarity of Y, Cr and Cb (Wang et al. 2004), 1 for equal images; `None` for images smaller than
    /// its window, 11 × 11 pixels.
    pub mssim: Option<[f64; 3]>,
    /// Peak signal-to-noise ratio in dB over all pixels: of RGB display values, or of l where images are linear.
    pub psnr_db: f64,
    /// Pairs that were compared.
    pub pairs: usize,
}

impl BtfError {
    /// Mean of the three channels' structural similarities, as Havran et al. 2010 report it.
    #[must_use]
    pub fn mean_mssim(&self) -> Option<f64> {
        self.mssim.map(|mssim| mssim.iter().sum::<f64>() / 3.0)
    }
}

/// What `then` makes of a BTF file of either model, factors expanded.
///
/// # Errors
/// The decoder's reason, if it refuses the file.
///
/// # Panics
/// If there is no memory to expand factors into.
pub fn with_file<R>(bytes: &[u8], then: impl FnOnce(&(dyn Evaluate + Sync)) -> R) -> Result<R, ReadError> {
    match File::parse(bytes)?.content() {
        Content::NestedBtf(btf) => Ok(then(&btf)),
        Content::FactoredBtf(btf) => {
            let mut memory = ExpansionMemory::default();
            Ok(then(&btf.expand_in(&mut memory).expect("memory for one to four megabytes")))
        }
        other => Err(ReadError::OtherFamily { found: other.family(), expected: Family::NestedBtf }),
    }
}

/// Error of the full-size level of a material of a file against images, over some pairs of directions. Channels are those
/// of the file's tone, Cr and Cb around ½ as images store them.
///
/// # Panics
/// If the file has no such material.
#[must_use]
pub fn compare(
    images: &Images,
    file: &(impl Evaluate + Sync + ?Sized),
    material: usize,
    pairs: &[usize],
    progress: &dyn Progress,
) -> BtfError {
    let tone = file.catalog().header().encoding;
    compare_images(images, tone, pairs, |pair| decode(images, file, material, pair), progress)
}

/// Error of images that come from anywhere, `decode` by pair, whose channels are of this tone; otherwise as [`compare`].
#[must_use]
pub fn compare_images(
    images: &Images,
    tone: ColourEncoding,
    pairs: &[usize],
    decode: impl Fn(usize) -> Vec<[f32; 3]> + Sync,
    progress: &dyn Progress,
) -> BtfError {
    progress.begin("comparing", pairs.len() as u64);
    let width = images.size()[0] as usize;
    let each: Vec<(Option<[f64; 3]>, f64)> = parallel::map(pairs.len(), |k| {
        let found = of_pair(images, &decode(pairs[k]), pairs[k], tone, width);
        progress.advance(1);
        found
    });
    let count = each.len() as f64;
    let mse = each.iter().map(|(_, mse)| mse).sum::<f64>() / count;
    BtfError { mssim: mean(each.iter().map(|(mssim, _)| *mssim)), psnr_db: psnr_of_mse_db(mse), pairs: pairs.len() }
}

/// Step from one pair of directions that [`judge`] compares to the next; a prime, so that all lights and views are among
/// them.
pub const PAIR_STEP: usize = 61;

/// Mean error of all materials of a file over every [`PAIR_STEP`]th pair of directions.
///
/// # Errors
/// The decoder's reason, if it refuses the file.
pub fn judge(materials: &[Images], bytes: &[u8], progress: &dyn Progress) -> Result<BtfError, ReadError> {
    let errors = with_file(bytes, |file| -> Vec<BtfError> {
        let of = |(number, images): (usize, &Images)| {
            let pairs: Vec<usize> = (0..images.pairs()).step_by(PAIR_STEP).collect();
            compare(images, file, number, &pairs, progress)
        };
        materials.iter().enumerate().map(of).collect()
    })?;
    let count = errors.len() as f64;
    Ok(BtfError {
        mssim: mean(errors.iter().map(|error| error.mssim)),
        psnr_db: errors.iter().map(|error| error.psnr_db).sum::<f64>() / count,
        pairs: errors.iter().map(|error| error.pairs).sum(),
    })
}

/// Mean of similarities by channel; `None` if one is not known.
fn mean(mssim: impl Iterator<Item = Option<[f64; 3]>>) -> Option<[f64; 3]> {
    let all: Vec<[f64; 3]> = mssim.collect::<Option<_>>()?;
    Some([0, 1, 2].map(|c: usize| all.iter().map(|mssim| mssim[c]).sum::<f64>() / all.len() as f64))
}

/// Image of a pair of directions as a file has it, row by row: display values or linear, by the file's tone.
///
/// # Panics
/// If the file has no such material.
#[must_use]
pub fn decode(images: &Images, file: &(impl Evaluate + ?Sized), material: usize, pair: usize) -> Vec<[f32; 3]> {
    let (lights, views) = (images.lights(), images.views());
    let (light, view) = (lights[pair / views.len()], views[pair % views.len()]);
    let grid = file.catalog().grid();
    let cell = grid.coord_for(light.to_array(), &grid.view(view.to_array()));
    let first = file.catalog().texel(material, 0, [0; 2]).expect("the material is there");
    let mut values = vec![[0.0; 3]; images.texels()];
    file.eval_texels(first, &cell, &mut values);
    values
}

/// Structural similarities of the three channels, and mean squared error, of one pair of directions.
fn of_pair(
    images: &Images,
    decoded: &[[f32; 3]],
    pair: usize,
    tone: ColourEncoding,
    width: usize,
) -> (Option<[f64; 3]>, f64) {
    let centre = match tone {
        ColourEncoding::Display { .. } => [0.0, 0.5, 0.5],
        ColourEncoding::LogLuv { .. } => [0.0; 3],
    };
    let mut planes = [const { Vec::new() }; 6];
    let mut squares = 0.0;
    images.each(pair, |texel, rgb| {
        // What was measured was clipped to what can be shown; so is what is compared with it.
        let other = match tone {
            ColourEncoding::Display { .. } => decoded[texel].map(|value| value.min(1.0)),
            ColourEncoding::LogLuv { .. } => decoded[texel],
        };
        let (first, second) = (tone.encode(rgb), tone.encode(other));
        squares += match tone {
            ColourEncoding::Display { .. } => {
                rgb.iter().zip(other).map(|(a, b)| f64::from(a - b).powi(2)).sum::<f64>() / 3.0
            }
            ColourEncoding::LogLuv { .. } => f64::from(first[0] - second[0]).powi(2),
        };
        for c in 0..3 {
            planes[c].push(f64::from(first[c] + centre[c]));
            planes[3 + c].push(f64::from(second[c] + centre[c]));
        }
    });
    let of = |c: usize| ssim_of_planes(&planes[c], &planes[3 + c], width);
    let mssim = of(0).zip(of(1)).zip(of(2)).map(|((luma, first), second)| [luma, first, second]);
    (mssim, squares / decoded.len() as f64)
}
