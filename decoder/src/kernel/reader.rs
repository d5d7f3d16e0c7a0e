//! Reads and checks a kernel file once; afterwards its tables are borrowed and nothing can fail.

use super::layout::{ENERGY_TOLERANCE, KernelHeader, MAX_WEIGHT, VARIANCES};
use crate::container::Crc;
use crate::container::bytes::F32Le;
use crate::container::origin::Origin;
use crate::container::sections::{SectionBytes, Sections};
use crate::detect;
use crate::error::ReadError;
use crate::family::Family;
use crate::section::Section;

/// Colour channels.
pub(super) const RGB: usize = 3;

/// Checked kernel file: a homogeneous diffusion profile R_d(r) and its separable kernel.
///
/// A_c(x, y) = Σ_t s_tc a_tc(x) a_tc(y) for each colour channel c, linear Rec. 709. Light E becomes the exitance
/// M(x, y) = Σ_t s_t Σ_i Σ_j w_ti w_tj E(x + o_i, y + o_j), with even kernels: o_−i = −o_i and w_t,−i = w_ti
/// (Jimenez et al. 2015, Separable Subsurface Scattering).
#[derive(Clone, Copy, Debug)]
pub struct Kernel<'a> {
    header: KernelHeader,
    /// o_i in mm, shape `[side]`.
    offsets: F32Le<'a>,
    /// w, shape `[terms][side][rgb]`.
    weights: F32Le<'a>,
    /// T, shape `[tail_nodes][rgb]`.
    tail: F32Le<'a>,
    two_gaussians: Option<TwoGaussians>,
}

/// Two Gaussians in one dimension that a kernel was made of: a(x) = w G(x; τ_near) + (1 − w) G(x; τ_far) for each colour channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoGaussians {
    /// Share w of the narrow one, 0 to 1.
    pub weight: [f32; 3],
    /// Variance of the narrow one in mm², 10⁻¹² to 10¹².
    pub tau_near: [f32; 3],
    /// Variance of the wide one in mm², `tau_near` to 10¹².
    pub tau_far: [f32; 3],
}

impl<'a> Kernel<'a> {
    /// Reads and checks a file: structure, sizes, every value, and all CRCs.
    ///
    /// # Errors
    /// The first thing that is wrong, with section, offset and numbers.
    pub fn parse(file: &'a [u8]) -> Result<Self, ReadError> {
        Self::parse_with(file, Crc::Check)
    }

    /// [`Kernel::parse`] with a choice about the sections' CRC-32.
    ///
    /// # Errors
    /// As [`Kernel::parse`].
    pub fn parse_with(file: &'a [u8], crc: Crc) -> Result<Self, ReadError> {
        Self::read(&Sections::parse(file, crc)?)
    }

    /// Reads and checks all sections.
    #[inline(never)]
    pub(crate) fn read(sections: &Sections<'a>) -> Result<Self, ReadError> {
        let header = KernelHeader::parse(detect::header(sections, Section::KernelHeader, Family::Kernel)?)?;
        let sized = |section| sections.sized(section, header.section_bytes(section));
        let weights = sized(Section::KernelWeights)?;
        let kernel = Self {
            header,
            offsets: offsets(sized(Section::KernelOffsets)?, header.radius_mm)?,
            weights: checked_weights(weights)?,
            tail: tail(sized(Section::KernelTail)?)?,
            two_gaussians: if sections.has(Section::TwoGaussians) {
                Some(TwoGaussians::parse(sized(Section::TwoGaussians)?)?)
            } else {
                None
            },
        };
        check_energy(weights.origin, kernel.energy(), kernel.reflectance())?;
        Ok(kernel)
    }

    /// Sizes, signs and units.
    #[must_use]
    pub fn header(&self) -> &KernelHeader {
        &self.header
    }

    /// Offsets o_i in mm from the centre on: 0 first, rising, less than the radius; shape `[side]`.
    #[must_use]
    pub fn offsets(&self) -> F32Le<'a> {
        self.offsets
    }

    /// Weights w_ti, integrals of a_t over the interval of tap i, from the centre on; −16 to 16; shape `[terms][side][rgb]`.
    #[must_use]
    pub fn weights(&self) -> F32Le<'a> {
        self.weights
    }

    /// Nodes of the tail T, 0 to 1, falling to 0; node k is at radius (k / (tail_nodes − 1))² mm; shape `[tail_nodes][rgb]`.
    #[must_use]
    pub fn tail(&self) -> F32Le<'a> {
        self.tail
    }

    /// The two Gaussians that the kernel was made of, where the file has them.
    #[must_use]
    pub fn two_gaussians(&self) -> Option<&TwoGaussians> {
        self.two_gaussians.as_ref()
    }
}

/// Values of a section, each within the range that `range` gives for its number and itself.
pub(crate) fn checked<'a>(
    section: SectionBytes<'a>,
    range: &mut dyn FnMut(usize, f32) -> [f32; 2],
) -> Result<F32Le<'a>, ReadError> {
    let values = F32Le::new(section.bytes);
    for (k, value) in values.iter().enumerate() {
        section.origin.at_item(k, size_of::<f32>()).number(0, value, range(k, value))?;
    }
    Ok(values)
}

/// Weights, all within ±[`MAX_WEIGHT`].
pub(super) fn checked_weights(section: SectionBytes<'_>) -> Result<F32Le<'_>, ReadError> {
    checked(section, &mut |_, _| [-MAX_WEIGHT, MAX_WEIGHT])
}

/// ||A_c||_1 = ||R_d||_1: the kernel, whose weights are at `origin`, neither makes light nor loses it.
pub(super) fn check_energy(origin: Origin, energy: [f32; 3], reflectance: [f32; 3]) -> Result<(), ReadError> {
    for (reflectance, energy) in reflectance.into_iter().zip(energy) {
        origin.number(0, energy, [reflectance - ENERGY_TOLERANCE, reflectance + ENERGY_TOLERANCE])?;
    }
    Ok(())
}

/// Offsets that begin with 0, rise and stay within the radius.
pub(super) fn offsets(section: SectionBytes<'_>, radius_mm: f32) -> Result<F32Le<'_>, ReadError> {
    let mut next = [0.0, 0.0];
    checked(section, &mut |_, offset| core::mem::replace(&mut next, [offset.next_up(), radius_mm.next_down()]))
}

/// Rows of rgb that begin within 0 to 1, never rise and end with 0.
pub(crate) fn tail(section: SectionBytes<'_>) -> Result<F32Le<'_>, ReadError> {
    tail_after(section, TAIL_START, true)
}

/// What the first node of a tail may not exceed.
pub(crate) const TAIL_START: [f32; 3] = [1.0; 3];

/// Nodes of a tail, none of which exceeds the one before it; the last of all is 0.
pub(crate) fn tail_after(
    section: SectionBytes<'_>,
    mut before: [f32; RGB],
    has_last: bool,
) -> Result<F32Le<'_>, ReadError> {
    let last = if has_last { F32Le::new(section.bytes).len().saturating_sub(RGB) } else { usize::MAX };
    checked(section, &mut |k, value| {
        let [red, green, blue] = before;
        before = [green, blue, value];
        [0.0, if k < last { red } else { 0.0 }]
    })
}

impl TwoGaussians {
    /// The section as it stands in the file: w, τ_near, τ_far.
    pub fn to_bytes(&self) -> impl Iterator<Item = u8> {
        [self.weight, self.tau_near, self.tau_far].into_iter().flatten().flat_map(f32::to_le_bytes)
    }

    /// Reads and checks the section.
    pub(super) fn parse(section: SectionBytes<'_>) -> Result<Self, ReadError> {
        let [least, most] = VARIANCES;
        // Each far variance is at least the near one, three numbers before.
        let mut before = [least; RGB];
        let values = checked(section, &mut |k, value| {
            let [red, green, blue] = before;
            before = [green, blue, value];
            if k < RGB { [0.0, 1.0] } else { [if k < 2 * RGB { least } else { red }, most] }
        })?;
        let [weight, tau_near, tau_far] = [0, RGB, RGB.wrapping_add(RGB)].map(|at| values.rgb_at(at));
        Ok(Self { weight, tau_near, tau_far })
    }
}
