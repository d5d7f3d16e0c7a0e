//! The fit at one size, and the cheapest size that an error allows.

use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::basis::BasisSize;

use super::descend::descend;
use super::fitted::FittedBasis;
use super::nodes::Nodes;
use super::params::Params;
use super::patch::{Patch, patches};
use super::render::psnr_db;
use super::start::start;
use crate::error::Result;
use crate::progress::Progress;

/// Sizes `[L, A]` that are tried, from cheap to dear: a second map costs more than two Gaussians.
const SIZES: [[usize; 2]; 4] = [[1, 2], [1, 3], [2, 3], [2, 4]];
/// The largest of them.
pub(super) const LARGEST: [usize; 2] = SIZES[SIZES.len() - 1];

/// Size of a basis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BasisChoice {
    /// The cheapest, up to L = 2 and A = 4, with which uniform, disc and line light come this close to the gather, PSNR in dB;
    /// the closest where none does.
    Psnr(f64),
    /// This one.
    Size(BasisSize),
}

/// Options of the fit of a separable basis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BasisOptions {
    /// Size.
    pub choice: BasisChoice,
    /// Steps of the joint fit; with 0 what it starts from is taken: functions of a singular value decomposition, each product
    /// of two as a sum of Gaussians.
    pub steps: usize,
}

impl Default for BasisOptions {
    fn default() -> Self {
        Self { choice: BasisChoice::Psnr(45.0), steps: 6 }
    }
}

/// Fit of a separable basis to a file. It depends on file and options alone, not on the number of threads.
///
/// # Errors
/// [`Error::Request`](crate::Error::Request) for a size out of range, and for a material that gives back far more light than it
/// takes.
pub fn fit_basis(material: &Bssrdf<'_>, options: &BasisOptions, progress: &dyn Progress) -> Result<FittedBasis> {
    let sizes = match options.choice {
        BasisChoice::Psnr(_) => SIZES.map(|[terms, gaussians]| BasisSize { terms, gaussians }).to_vec(),
        BasisChoice::Size(size) if size.is_in_range() => vec![size],
        BasisChoice::Size(size) => {
            let message = format!("a separable basis of {size:?}; there can be 1 or 2 terms and 1 to 8 Gaussians");
            return Err(crate::error::Error::Request(message));
        }
    };
    let nodes = Nodes::of(material);
    progress.begin("gathering for the separable basis", 1);
    let patches = patches(material, &nodes);
    progress.advance(1);
    let mut best: Option<(f64, Params)> = None;
    for size in sizes {
        let mut params = start(material.header(), &patches, size);
        descend(&mut params, &patches, options.steps, progress);
        let reached = psnr_db(&params, &patches);
        if best.as_ref().is_none_or(|(most, _)| reached > *most) {
            best = Some((reached, params));
        }
        if matches!(options.choice, BasisChoice::Psnr(least) if reached >= least) || progress.stopped() {
            break;
        }
    }
    let (reached, params) = best.expect("at least one size was tried");
    FittedBasis::new(&params, &nodes, &largest(&params, &patches), reached)
}

/// Largest |c_l| over the pixels that the fit looks at, shape `[l][c]`.
fn largest(params: &Params, patches: &[Patch]) -> Vec<[f64; 3]> {
    let of = |l: usize| [0, 1, 2].map(|c| patches.iter().map(|patch| patch.largest(params, l, c)).fold(0.0, f64::max));
    (0..params.size.terms).map(of).collect()
}
