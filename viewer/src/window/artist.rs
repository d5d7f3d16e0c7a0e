//! Numbers of two Gaussians that the panel changes, and what makes a kernel of them.

use subsurf_decoder::Kernel;
use subsurf_decoder::kernel::TwoGaussians;

use crate::error::Result;

/// Makes a kernel file of an artist's numbers. It is called on another thread, while they change.
pub type MakeKernel = dyn Fn(&Artist) -> Result<Vec<u8>> + Send + Sync;

/// Artist's model of a homogeneous material: along an axis, light spreads by w G(near) + (1 − w) G(far) (Jimenez et al. 2015, supplement,
/// section E). Arrays are linear Rec. 709.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Artist {
    /// Share w of the near Gaussian, 0 to 1.
    pub weight: [f32; 3],
    /// Standard deviation of the near Gaussian in mm.
    pub near_mm: [f32; 3],
    /// Standard deviation of the far Gaussian in mm, not less than the near one's.
    pub far_mm: [f32; 3],
    /// Diffuse reflectance ‖R_d‖₁, in (0, 1].
    pub reflectance: [f32; 3],
    /// Factor of all distances.
    pub strength: f32,
    /// Refractive index against air.
    pub eta: f32,
    /// Taps of the kernel, both sides and the centre.
    pub taps: u8,
}

impl Artist {
    /// Numbers of a kernel, if it was made of two Gaussians.
    #[must_use]
    pub fn of(kernel: &Kernel<'_>) -> Option<Self> {
        let TwoGaussians { weight, tau_near, tau_far } = *kernel.two_gaussians()?;
        let header = kernel.header();
        Some(Self {
            weight,
            near_mm: tau_near.map(f32::sqrt),
            far_mm: tau_far.map(f32::sqrt),
            reflectance: kernel.reflectance(),
            strength: 1.0,
            eta: header.eta,
            taps: header.taps,
        })
    }

    /// The two Gaussians, all distances times the strength.
    #[must_use]
    pub fn two_gaussians(&self) -> TwoGaussians {
        let variances = |sigmas_mm: [f32; 3]| sigmas_mm.map(|sigma| (self.strength * sigma).powi(2));
        TwoGaussians { weight: self.weight, tau_near: variances(self.near_mm), tau_far: variances(self.far_mm) }
    }
}

#[cfg(test)]
mod tests {
    use subsurf_tests::kernels::{SKIN, skin};

    use super::*;

    #[test]
    fn numbers_are_those_of_the_file_and_strength_scales_distances() {
        let file = skin(17).to_bytes().unwrap();
        let artist = Artist::of(&Kernel::parse(&file).unwrap()).unwrap();
        assert_eq!((artist.weight, artist.reflectance, artist.taps), (SKIN.weight, [0.8, 0.6, 0.5], 17));
        let close = |a: [f32; 3], b: [f32; 3]| (0..3).all(|c| (a[c] / b[c] - 1.0).abs() < 1e-6);
        let (same, twice) = (artist.two_gaussians(), Artist { strength: 2.0, ..artist }.two_gaussians());
        assert!(close(same.tau_near, SKIN.tau_near) && close(same.tau_far, SKIN.tau_far), "{same:?}");
        assert!(close(twice.tau_far, SKIN.tau_far.map(|tau| 4.0 * tau)), "{twice:?}");
        let other = subsurf_tests::kernels::difference(9).to_bytes().unwrap();
        assert_eq!(Artist::of(&Kernel::parse(&other).unwrap()), None, "of no Gaussians");
    }
}
