//! Truncated singular value decomposition of materials: luma and chroma as few components, texel by texel and direction by
//! direction. All encoders but the baselines begin with it.

use nalgebra::DMatrix;
use subsurf_decoder::btf::ColourEncoding;

use crate::btf::materials::common_tone;
use crate::capture::Images;
use crate::error::Result;
use crate::math::parallel;
use crate::math::svd::{Columns, LowRank, PASSES};
use crate::progress::Progress;

/// Luma Y and chroma C of all texels at all pairs of directions, in components.
///
/// Y_x(d) = Σ_c u_xc b_cd / w_d, and C_x(d) = ρ_x Y_x(d) + Σ_c v_xc q_cd / w_d for both channels. The weights w_d make
/// errors count as they do in structural similarity: little where an image has much contrast.
pub struct TruncatedSvd {
    /// Encoding of the channels.
    pub tone: ColourEncoding,
    /// Texels in x and in y of every material; their texels follow each other.
    pub sizes: Vec<[u32; 2]>,
    /// Weight w of each pair of directions.
    pub weights: Vec<f32>,
    /// Luma: coefficients u of texels, and functions b · w of pairs.
    pub luma: LowRank,
    /// Ratio ρ of chroma to luma of every texel, both channels; zero for linear images, whose chroma u' v' does not grow
    /// with luma.
    pub ratios: Vec<[f32; 2]>,
    /// Chroma beyond ρ Y: coefficients v of texels, and functions q · w of both channels of a pair, then of the next.
    pub chroma: LowRank,
    /// Bytes of the images.
    pub raw_bytes: u64,
}

/// Numbers of components that a decomposition keeps.
#[derive(Clone, Copy, Debug)]
pub struct Ranks {
    /// Components of luma.
    pub luma: usize,
    /// Components of chroma.
    pub chroma: usize,
}

/// (0.03)², the constant of structural similarity that keeps flat images from counting more and more.
const FLAT_VARIANCE: f32 = 9e-4;
/// Side of the squares whose variances stand for local contrast, as large as the window of structural similarity.
const SQUARE: usize = 11;
/// How far weights follow structural similarity, whose loss is err² / (2 σ² + C₂): 1 would be all the way, and gives
/// away more dB than it gains.
const FOLLOWING: f32 = 0.6;

/// All materials' images as luma and chroma.
struct Channels<'a> {
    materials: &'a [Images],
    tone: ColourEncoding,
    texels: usize,
}

impl Channels<'_> {
    /// Hands over luma and chroma of all texels at one pair, with their numbers.
    fn each(&self, pair: usize, mut with: impl FnMut(usize, [f32; 3])) {
        let mut start = 0;
        for images in self.materials {
            images.each(pair, |texel, rgb| with(start + texel, self.tone.encode(rgb)));
            start += images.texels();
        }
    }

    /// Weights of all pairs: 1 over the spread of structural similarity's loss, as far as they follow it, 1 on average.
    fn weights(&self, pairs: usize, progress: &dyn Progress) -> Vec<f32> {
        let weigh = |pair: usize| {
            let mut luma = vec![0.0; self.texels];
            self.each(pair, |texel, [y, ..]| luma[texel] = y);
            progress.advance(1);
            let mut start = 0;
            let mut sum = 0.0;
            for images in self.materials {
                let plane = &luma[start..start + images.texels()];
                sum += local_variance(plane, images.size()[0] as usize) * images.texels() as f32;
                start += images.texels();
            }
            (sum / self.texels as f32 + 0.5 * FLAT_VARIANCE).powf(-0.5 * FOLLOWING)
        };
        let weights: Vec<f32> = parallel::map(pairs, weigh);
        let mean = weights.iter().sum::<f32>() / pairs as f32;
        weights.iter().map(|weight| weight / mean).collect()
    }

    /// ρ of all texels: Σ w² C Y / Σ w² Y².
    fn ratios(&self, weights: &[f32], progress: &dyn Progress) -> Vec<[f32; 2]> {
        // Pairs in a fixed number of shares, whose sums are added in order: the same on any number of threads.
        let share = weights.len().div_ceil(16);
        let sums = |first: usize| {
            let mut sums = vec![[0.0_f32; 3]; self.texels];
            for (pair, weight) in weights.iter().enumerate().skip(first).take(share) {
                self.each(pair, |texel, [y, a, b]| {
                    let weighted = weight * weight * y;
                    let [yy, ya, yb] = sums[texel];
                    sums[texel] = [yy + weighted * y, ya + weighted * a, yb + weighted * b];
                });
                progress.advance(1);
            }
            sums
        };
        let starts: Vec<usize> = (0..weights.len()).step_by(share).collect();
        let mut total = vec![[0.0_f32; 3]; self.texels];
        for part in parallel::map(starts.len(), |k| sums(starts[k])) {
            for (total, part) in total.iter_mut().zip(part) {
                *total = std::array::from_fn(|k| total[k] + part[k]);
            }
        }
        let ratio = |[yy, ya, yb]: [f32; 3]| if yy > 0.0 { [ya / yy, yb / yy] } else { [0.0; 2] };
        total.into_iter().map(ratio).collect()
    }
}

/// Mean variance inside of squares.
fn local_variance(plane: &[f32], width: usize) -> f32 {
    let height = plane.len() / width;
    let (mut sum, mut count) = (0.0, 0.0);
    for (y, x) in (0..height).step_by(SQUARE).flat_map(|y| (0..width).step_by(SQUARE).map(move |x| (y, x))) {
        let rows = (y..(y + SQUARE).min(height)).map(|y| &plane[y * width + x..y * width + (x + SQUARE).min(width)]);
        let (mut first, mut second, mut n) = (0.0, 0.0, 0.0);
        for value in rows.flatten() {
            (first, second, n) = (first + value, second + value * value, n + 1.0);
        }
        sum += second - first * first / n;
        count += n;
    }
    (sum / count).max(0.0)
}

impl TruncatedSvd {
    /// Functions q · w of one channel of chroma, `[pair × component]`.
    pub(crate) fn chroma_basis(&self, channel: usize) -> DMatrix<f32> {
        let rows: Vec<usize> = (0..self.weights.len()).map(|pair| 2 * pair + channel).collect();
        self.chroma.basis.select_rows(&rows)
    }

    /// Decomposition of all images of some materials, by a few passes over them.
    ///
    /// # Errors
    /// [`Error::Request`](crate::Error::Request) if the materials do not go into one file.
    pub fn new(materials: &[Images], detail: Ranks, seed: u64, progress: &dyn Progress) -> Result<Self> {
        let tone = common_tone(materials)?;
        let pairs = materials[0].pairs();
        let texels = materials.iter().map(Images::texels).sum();
        let channels = Channels { materials, tone, texels };
        progress.begin("weighing directions", 2 * pairs as u64);
        let weights = channels.weights(pairs, progress);
        let ratios = match tone {
            ColourEncoding::Display { .. } => channels.ratios(&weights, progress),
            ColourEncoding::LogLuv { .. } => vec![[0.0; 2]; texels],
        };
        progress.begin("components of luma", PASSES * pairs as u64);
        let fill = |pair: usize, out: &mut [f32]| {
            channels.each(pair, |texel, [y, ..]| out[texel] = weights[pair] * y);
        };
        let luma = Columns { rows: texels, columns: pairs, group: 1, fill }.decompose(detail.luma, seed, progress);
        // Codebooks and factors of black have luma too.
        let luma = if luma.rank() == 0 { LowRank::zero(texels, pairs) } else { luma };
        progress.begin("components of chroma", PASSES * 2 * pairs as u64);
        let fill = |pair: usize, out: &mut [f32]| {
            let (first, second) = out.split_at_mut(texels);
            channels.each(pair, |texel, [y, a, b]| {
                let [of_a, of_b] = ratios[texel];
                first[texel] = weights[pair] * (a - of_a * y);
                second[texel] = weights[pair] * (b - of_b * y);
            });
        };
        let chroma =
            Columns { rows: texels, columns: 2 * pairs, group: 2, fill }.decompose(detail.chroma, seed, progress);
        Ok(Self {
            tone,
            sizes: materials.iter().map(Images::size).collect(),
            weights,
            luma,
            ratios,
            chroma,
            raw_bytes: materials.iter().map(Images::bytes).sum(),
        })
    }

    /// Number of texels of all materials.
    #[must_use]
    pub fn texels(&self) -> usize {
        self.ratios.len()
    }
}
