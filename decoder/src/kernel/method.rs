//! The ways from a diffusion profile to a separable kernel.

/// Way by which a separable kernel was made of a diffusion profile (Jimenez et al. 2015). Nothing that is drawn depends on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KernelMethod {
    /// Truncated singular value decomposition of the profile in the plane (eq. S.4).
    Svd,
    /// Profile integrated along an axis (eq. S.6).
    PreIntegrated,
    /// Best separable profile under a guide function (eq. S.7).
    Guided,
    /// An artist's sum of two Gaussians in one dimension (section E).
    TwoGaussians,
    /// Sum of Gaussians of the plane (d'Eon et al. 2007; eq. S.1).
    Gaussians,
}

impl KernelMethod {
    /// All methods, in the order of their codes from 1.
    pub const ALL: [Self; 5] = [Self::Svd, Self::PreIntegrated, Self::Guided, Self::TwoGaussians, Self::Gaussians];

    /// Name in commands and reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Svd => "svd",
            Self::PreIntegrated => "pre-integrated",
            Self::Guided => "guided",
            Self::TwoGaussians => "two-gaussians",
            Self::Gaussians => "gaussians",
        }
    }

    /// Code in the header.
    #[must_use]
    pub fn code(self) -> u8 {
        match self {
            Self::Svd => 1,
            Self::PreIntegrated => 2,
            Self::Guided => 3,
            Self::TwoGaussians => 4,
            Self::Gaussians => 5,
        }
    }

    /// Method of a code in the header.
    #[must_use]
    pub fn from_code(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|method| method.code() == code)
    }
}
