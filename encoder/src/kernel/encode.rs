//! From a profile to a kernel.

use subsurf_decoder::kernel::layout::{MAX_ETA, MAX_TERMS, TAPS};
use subsurf_decoder::kernel::{KernelMethod, TwoGaussians};

use super::grid::{Grid, Separable};
use super::method::{fit_two_gaussians, gaussians, guided, pre_integrated, svd, two_gaussians};
use super::profile::{Profile, Radial, check_two_gaussians};
use super::taps::Taps;
use super::{Kernel, Term};
use crate::error::{Error, Result};
use crate::math::parallel;
use crate::metrics::kernel::{KernelErrors, Truth};

/// Entries of the table T(d).
const TAIL: usize = 64;
/// Cells along half an axis in which kernels are fitted and judged.
const CELLS: usize = 128;

/// How a kernel is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Way from the profile to separable terms.
    pub method: KernelMethod,
    /// Terms N of [`KernelMethod::Svd`] and [`KernelMethod::Gaussians`], 1 to 6; all others have one.
    pub terms: usize,
    /// Taps of both sides and the middle, odd, 5 to 65.
    pub taps: usize,
    /// k of [`KernelMethod::Guided`], from 0, near scattering, to 4, far scattering.
    pub guide: f64,
    /// Gaussians of [`KernelMethod::TwoGaussians`]; `None`: fitted to the profile.
    pub two_gaussians: Option<TwoGaussians>,
    /// Refractive index of the material against air, 1 to 4.
    pub eta: f32,
}

impl Default for Options {
    /// Pre-integrated, 25 taps; k = 1.55, neutral by section D; η = 1.3.
    fn default() -> Self {
        Self { method: KernelMethod::PreIntegrated, terms: 1, taps: 25, guide: 1.55, two_gaussians: None, eta: 1.3 }
    }
}

/// A kernel, and how far off its terms are.
#[derive(Clone, Debug, PartialEq)]
pub struct Encoded {
    /// The kernel in taps.
    pub kernel: Kernel,
    /// Terms of red, green and blue before they become taps.
    pub separable: [Separable; 3],
    /// Errors of these terms against the exact profile in the plane.
    pub errors: KernelErrors,
}

/// Kernel of a profile.
///
/// # Errors
///
/// [`Error::Request`] for numbers of terms or taps, guides or Gaussians that there are not, and for a profile that reflects more
/// than all light.
pub fn encode(profile: &Profile, options: &Options) -> Result<Encoded> {
    options.check()?;
    let profile = profile.condensed().limited()?;
    let fitted: Vec<(Separable, KernelErrors, [f64; 3])> = parallel::map(3, |c| {
        let truth = Truth::new(&profile.channels[c], CELLS);
        let (separable, two) = options.fit(&truth, c);
        let errors = truth.errors(&separable);
        (separable, errors, two)
    });
    let radius = profile.channels.iter().map(Radial::radius_mm).fold(0.0, f64::max);
    let taps = Taps::new(&profile.channels, radius, options.taps);
    let weights = |t: usize| {
        let channels: Vec<Vec<f64>> = fitted.iter().map(|(separable, _, _)| taps.weights(separable, t)).collect();
        let tap = |i: usize| std::array::from_fn(|c| single(channels[c][i]));
        (0..taps.offsets.len()).map(tap).collect()
    };
    let signs = |t: usize| std::array::from_fn(|c| if fitted[c].0.terms[t].0 < 0.0 { -1 } else { 1 });
    let terms = (0..fitted[0].0.terms.len()).map(|t| Term { sign: signs(t), weights: weights(t) }).collect();
    let is_two = options.method == KernelMethod::TwoGaussians;
    let two_gaussians = is_two.then(|| {
        let number = |k: usize| std::array::from_fn(|c| single(fitted[c].2[k]));
        TwoGaussians { weight: number(0), tau_near: number(1), tau_far: number(2) }
    });
    let depth_variance = match two_gaussians {
        Some(two) => two.tau_near.into_iter().chain(two.tau_far).fold(0.0, f32::max),
        None => single(profile.channels.iter().map(Radial::variance_mm2).fold(0.0, f64::max)),
    };
    let kernel = Kernel {
        method: options.method,
        radius: single(radius),
        reflectance: profile.reflectance().map(single),
        depth_variance,
        eta: options.eta,
        offsets: taps.offsets.iter().map(|offset| single(*offset)).collect(),
        terms,
        tail: tail(&profile, radius),
        two_gaussians,
    };
    let errors = KernelErrors::mean(fitted.iter().map(|(_, errors, _)| *errors));
    Ok(Encoded { kernel, separable: std::array::from_fn(|c| fitted[c].0.clone()), errors })
}

/// Errors of methods and numbers of terms on one profile, without taps.
///
/// # Errors
///
/// As [`encode`].
pub fn compare(profile: &Profile, options: &[Options]) -> Result<Vec<KernelErrors>> {
    options.iter().try_for_each(Options::check)?;
    let profile = profile.condensed().limited()?;
    let truths = parallel::map(3, |c| Truth::new(&profile.channels[c], CELLS));
    // All channels of all options at once.
    let errors = parallel::map(3 * options.len(), |k| {
        let (options, c) = (&options[k / 3], k % 3);
        truths[c].errors(&options.fit(&truths[c], c).0)
    });
    Ok(errors.chunks(3).map(|channels| KernelErrors::mean(channels.iter().copied())).collect())
}

impl Options {
    /// Refuses what no kernel can be made with, whatever the profile.
    ///
    /// # Errors
    /// [`Error::Request`] for numbers of terms or taps, guides, indices or Gaussians out of range.
    pub fn check(&self) -> Result<()> {
        let refuse = |text: String| Err(Error::Request(text));
        let [fewest, most] = TAPS.map(usize::from);
        if !(1..=usize::from(MAX_TERMS)).contains(&self.terms) {
            return refuse(format!("{} terms; expected 1 to {MAX_TERMS}", self.terms));
        }
        if self.terms > 1 && !matches!(self.method, KernelMethod::Svd | KernelMethod::Gaussians) {
            return refuse(format!(
                "{} terms of method {}; expected 1, or the methods svd or gaussians",
                self.terms,
                self.method.name()
            ));
        }
        if !(fewest..=most).contains(&self.taps) || self.taps.is_multiple_of(2) {
            return refuse(format!("{} taps; expected an odd number from {fewest} to {most}", self.taps));
        }
        if !(0.0..=4.0).contains(&self.guide) {
            return refuse(format!("a guide of {}; expected 0, near scattering, to 4, far scattering", self.guide));
        }
        if !(1.0..=MAX_ETA).contains(&self.eta) {
            return refuse(format!("a refractive index of {}; expected 1 to {MAX_ETA}", self.eta));
        }
        self.two_gaussians.as_ref().map_or(Ok(()), check_two_gaussians)
    }

    /// Terms of channel `c`, and its two Gaussians, which mean nothing for other methods.
    fn fit(&self, truth: &Truth<'_>, c: usize) -> (Separable, [f64; 3]) {
        let (radial, grid): (&Radial, &Grid) = (truth.radial, &truth.grid);
        let two = || match self.two_gaussians {
            Some(two) => [two.weight[c], two.tau_near[c], two.tau_far[c]].map(f64::from),
            None => fit_two_gaussians(radial, grid),
        };
        let mut given = [0.0; 3];
        let mut separable = match self.method {
            KernelMethod::Svd => svd(&truth.plane, grid, self.terms),
            KernelMethod::PreIntegrated => pre_integrated(radial, grid),
            KernelMethod::Guided => guided(radial, grid, self.guide),
            KernelMethod::TwoGaussians => {
                given = two();
                two_gaussians(given, radial.energy(), grid)
            }
            KernelMethod::Gaussians => gaussians(radial, grid, self.terms),
        };
        // Ã = A ‖R_d‖₁ / ‖A‖₁ (section B); others lose no more than what is beyond the radius.
        separable.rescale(radial.energy());
        (separable, given)
    }
}

/// T(d_i) `[i][rgb]` at d_i = radius (i / (m − 1))².
fn tail(profile: &Profile, radius: f64) -> Vec<[f32; 3]> {
    let entry = |i: usize| {
        #[allow(clippy::cast_precision_loss, reason = "entries are few")]
        let d = radius * (i as f64 / (TAIL - 1) as f64).powi(2);
        // What rounding leaves at the radius is nothing.
        std::array::from_fn(|c| if i == TAIL - 1 { 0.0 } else { single(profile.channels[c].tail(d)) })
    };
    (0..TAIL).map(entry).collect()
}

/// In single precision, as files have it.
#[allow(clippy::cast_possible_truncation, reason = "rounded, as files have it")]
fn single(value: f64) -> f32 {
    value as f32
}
