//! How far a file is from the images of a BTF.

use rayon::prelude::*;
use subsurf_decoder::btf::factored::ExpansionMemory;
use subsurf_decoder::btf::{ColourEncoding, Evaluate};
use subsurf_decoder::{Content, Family, File, ReadError};

use super::image::ssim_of_planes;
use crate::btf::Images;
use crate::progress::Progress;

/// Means over pairs of directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BtfError {
    /// Structural similarity of luma and both chroma channels; none of images smaller than its window, 11 × 11 pixels.
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

/// Reads a BTF file of either model, and expands factors.
///
/// # Errors
/// What is wrong with it.
///
/// # Panics
/// If there is no memory to expand it into.
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

/// Compares images with the full-size level of a material at some pairs of directions. Channels are those of the file's
/// tone, Cr and Cb around ½ as images store them.
///
/// # Panics
/// If the file has no such material.
#[must_use]
pub fn compare(
    images: &Images,
    file: &(impl Evaluate + Sync + ?Sized),
    material: usize,
    pairs: &[usize],
    progress: &impl Progress,
) -> BtfError {
    let tone = file.catalog().header().encoding;
    compare_images(images, tone, pairs, |pair| decode(images, file, material, pair), progress)
}

/// [`compare`] with images that come from anywhere, whose channels are of this tone.
#[must_use]
pub fn compare_images(
    images: &Images,
    tone: ColourEncoding,
    pairs: &[usize],
    decode: impl Fn(usize) -> Vec<[f32; 3]> + Sync,
    progress: &impl Progress,
) -> BtfError {
    progress.begin("comparing", pairs.len() as u64);
    let width = images.size()[0] as usize;
    let each: Vec<(Option<[f64; 3]>, f64)> = pairs
        .par_iter()
        .map(|pair| {
            let found = of_pair(images, &decode(*pair), *pair, tone, width);
            progress.advance(1);
            found
        })
        .collect();
    let count = each.len() as f64;
    let mse = each.iter().map(|(_, mse)| mse).sum::<f64>() / count;
    BtfError { mssim: mean(each.iter().map(|(mssim, _)| *mssim)), psnr_db: -10.0 * mse.log10(), pairs: pairs.len() }
}

/// Mean of similarities, if all are known.
pub(crate) fn mean(mssim: impl Iterator<Item = Option<[f64; 3]>>) -> Option<[f64; 3]> {
    let all: Vec<[f64; 3]> = mssim.collect::<Option<_>>()?;
    Some([0, 1, 2].map(|c: usize| all.iter().map(|mssim| mssim[c]).sum::<f64>() / all.len() as f64))
}

/// The image of a pair as a file has it.
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

/// Structural similarities, and mean squared error.
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
