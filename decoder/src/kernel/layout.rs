//! The `KERN` header and the sizes of the sections that follow from it.

use super::method::KernelMethod;
use crate::container::index::row_major;
use crate::container::record::{Field, record};
use crate::container::sections::SectionBytes;
use crate::error::ReadError;
use crate::section::Section;
use core::mem::offset_of;
use core::num::Saturating;

/// Bytes of the `KERN` section.
pub const HEADER_BYTES: usize = size_of::<KernelRecord>();
/// Largest number of terms.
pub const MAX_TERMS: u8 = 6;
/// Smallest and largest number of taps, both sides and the centre.
pub const TAPS: [u8; 2] = [5, 65];
/// Smallest and largest number of nodes of the tail.
pub const TAIL_NODES: [u16; 2] = [2, 1_024];
/// Bytes of a node of the tail.
pub(crate) const TAIL_NODE_BYTES: u64 = 12;
/// Smallest and largest radius in mm.
pub const RADII_MM: [f32; 2] = [1e-6, 1e6];
/// Smallest and largest variance in mm².
pub const VARIANCES: [f32; 2] = [1e-12, 1e12];
/// Largest refractive index.
pub const MAX_ETA: f32 = 4.0;
/// Largest magnitude of a weight.
pub const MAX_WEIGHT: f32 = 16.0;
/// Largest distance of what the weights add up to from the reflectance.
pub const ENERGY_TOLERANCE: f32 = 1.0 / 1024.0;
/// Code of linear Rec. 709, the one colour space there is.
pub const LINEAR_REC709: u8 = 1;

record! {
    /// The `KERN` section (`FORMAT.md`, section 6.1).
    KernelRecord {
        method: u8,
        colour_space: u8,
        terms: u8,
        taps: u8,
        tail_nodes: u16,
        reserved: u16,
        signs: u32,
        radius_mm: f32,
        depth_variance: f32,
        eta: f32,
    }
}

/// Header of a kernel file: sizes, signs and units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KernelHeader {
    /// How the kernel was made.
    pub method: KernelMethod,
    /// Number of products a(x) a(y), 1 to 6.
    pub terms: u8,
    /// Number of taps of a 1-D kernel, both sides and the centre; odd, 5 to 65.
    pub taps: u8,
    /// Nodes of the tail, 2 to 1,024.
    pub tail_nodes: u16,
    /// Bit 3 t + c is set where s_tc = −1.
    pub signs: u32,
    /// Distance in mm beyond which the profile is 0; larger than all offsets; 10⁻⁶ to 10⁶.
    pub radius_mm: f32,
    /// τ_max in mm²: a sample at another depth counts exp(−d_z² / (2 τ_max)) of its weight; 10⁻¹² to 10¹².
    pub depth_variance: f32,
    /// Refractive index of the material against air, 1 to 4.
    pub eta: f32,
}

impl KernelHeader {
    /// The section as it stands in the file.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; HEADER_BYTES] {
        KernelRecord {
            method: self.method.code(),
            colour_space: LINEAR_REC709,
            terms: self.terms,
            taps: self.taps,
            tail_nodes: self.tail_nodes,
            reserved: 0,
            signs: self.signs,
            radius_mm: self.radius_mm,
            depth_variance: self.depth_variance,
            eta: self.eta,
        }
        .to_bytes()
    }

    /// Reads and checks the section.
    pub(crate) fn parse(section: SectionBytes<'_>) -> Result<Self, ReadError> {
        use KernelRecord as R;
        let record = R::from_bytes(section.at_least(HEADER_BYTES as u64)?.bytes);
        let origin = section.origin;
        let R { method, colour_space, terms, taps, tail_nodes, signs, .. } = record;
        let bad_method = origin.bad_field(offset_of!(R, method), method);
        let method = KernelMethod::from_code(method).ok_or(bad_method)?;
        let rec709 = LINEAR_REC709.into();
        origin.integer(offset_of!(R, colour_space), colour_space, rec709..=rec709)?;
        let terms = origin.integer(offset_of!(R, terms), terms, 1..=MAX_TERMS.into())?;
        let [fewest, most] = TAPS.map(u32::from);
        if taps.is_multiple_of(2) {
            return Err(origin.bad_field(offset_of!(R, taps), taps));
        }
        let taps = origin.integer(offset_of!(R, taps), taps, fewest..=most)?;
        let [fewest, most] = TAIL_NODES.map(u32::from);
        let tail_nodes = origin.integer(offset_of!(R, tail_nodes), tail_nodes, fewest..=most)?;
        // One bit for each term and channel, none beyond them.
        let last_signs = 1_u32.wrapping_shl(u32::from(terms).wrapping_mul(3)).wrapping_sub(1);
        let signs = origin.integer(offset_of!(R, signs), signs, 0..=last_signs)?;
        Ok(Self {
            method,
            terms,
            taps,
            tail_nodes,
            signs,
            radius_mm: origin.number(offset_of!(R, radius_mm), record.radius_mm, RADII_MM)?,
            depth_variance: origin.number(offset_of!(R, depth_variance), record.depth_variance, VARIANCES)?,
            eta: origin.number(offset_of!(R, eta), record.eta, [1.0, MAX_ETA])?,
        })
    }

    /// Number of taps of one side with the centre, (taps + 1) / 2.
    #[must_use]
    pub fn side(&self) -> usize {
        usize::from(self.taps).wrapping_add(1) >> 1
    }

    /// Sign s_t of a term for each channel, −1 or 1; zeros out of range.
    #[must_use]
    pub fn sign(&self, term: usize) -> [f32; 3] {
        if term >= self.terms.into() {
            return [0.0; 3];
        }
        let first = row_major(term, 3, 0);
        [0, 1, 2].map(|channel: usize| {
            let bit = u32::try_from(first.wrapping_add(channel)).unwrap_or(0);
            if self.signs.wrapping_shr(bit) & 1 == 0 { 1.0 } else { -1.0 }
        })
    }

    /// Bytes that a section must have, as `FORMAT.md` says.
    #[must_use]
    pub fn section_bytes(&self, section: Section) -> u64 {
        const RGB: Saturating<u64> = Saturating(3);
        const F32: Saturating<u64> = Saturating(4);
        let [terms, side, nodes] = [self.terms.into(), self.side() as u64, self.tail_nodes.into()].map(Saturating);
        let bytes = match section {
            Section::KernelHeader => Saturating(HEADER_BYTES as u64),
            Section::KernelOffsets => side * F32,
            Section::KernelWeights => terms * side * RGB * F32,
            Section::KernelTail => nodes * Saturating(TAIL_NODE_BYTES),
            Section::TwoGaussians => RGB * RGB * F32,
            _ => Saturating(0),
        };
        bytes.0
    }
}
