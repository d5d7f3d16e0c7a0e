//! Kernels to `.subsurf` files, through the decoder's own layout.

use subsurf_decoder::Section;
use subsurf_decoder::kernel::{KernelHeader, TwoGaussians};

use super::model::Kernel;
use crate::error::{Error, Result};
use crate::file::container;
use crate::file::reread::reread;

impl Kernel {
    /// File of the kernel, read again by the decoder. The first node of the tail is the reflectance.
    ///
    /// # Errors
    /// [`Error::Request`] if there are more terms, taps or nodes than a file can count, or tables of different lengths;
    /// [`Error::OwnOutput`] if the decoder refuses a value.
    pub fn to_bytes(&self) -> Result<Vec<u8>> {
        let side = self.offsets.len();
        let lengths = [self.terms.len(), side, self.tail.len()];
        let refuse = || {
            Error::Request(format!(
                "a kernel of {lengths:?} terms, taps of one side and nodes of the tail; a file has up to 6, 33 and 1,024"
            ))
        };
        let [terms, taps] = [self.terms.len(), (2 * side).saturating_sub(1)].map(|count| u8::try_from(count).ok());
        let (Some(terms), Some(taps), Ok(tail_nodes)) = (terms, taps, u16::try_from(self.tail.len())) else {
            return Err(refuse());
        };
        if let Some(term) = self.terms.iter().find(|term| term.weights.len() != side) {
            let found = term.weights.len();
            return Err(Error::Request(format!(
                "a kernel of {side} taps on one side has a term of {found}; all need the same number"
            )));
        }
        let minus = self.terms.iter().flat_map(|term| term.sign).enumerate().filter(|(_, sign)| *sign < 0);
        let header = KernelHeader {
            method: self.method,
            terms,
            taps,
            tail_nodes,
            signs: minus.fold(0, |signs, (bit, _)| {
                signs | 1_u32.checked_shl(u32::try_from(bit).unwrap_or(u32::MAX)).unwrap_or(0)
            }),
            radius_mm: self.radius,
            depth_variance: self.depth_variance,
            eta: self.eta,
        };
        let weights = self.terms.iter().flat_map(|term| term.weights.iter().flatten());
        let tail = std::iter::once(&self.reflectance).chain(self.tail.iter().skip(1)).flatten();
        let [offsets, weights, tail] = [bytes(self.offsets.iter()), bytes(weights), bytes(tail)];
        let two_gaussians = self.two_gaussians.as_ref().map(|two| TwoGaussians::to_bytes(two).collect::<Vec<u8>>());
        let header = header.to_bytes();
        let sections = [
            (Section::KernelHeader, &header[..]),
            (Section::KernelOffsets, &offsets),
            (Section::KernelWeights, &weights),
            (Section::KernelTail, &tail),
        ];
        let two_gaussians = two_gaussians.as_ref().map(|bytes| (Section::TwoGaussians, &bytes[..]));
        reread(container::write(sections.into_iter().chain(two_gaussians)))
    }
}

fn bytes<'a>(values: impl Iterator<Item = &'a f32>) -> Vec<u8> {
    values.flat_map(|value| value.to_le_bytes()).collect()
}
