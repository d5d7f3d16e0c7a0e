//! Files of at most so many bytes.

use super::angles::CoreSize;
use super::encode::Prepared;
use super::sizes::{OF_CORE, Sizes};
use crate::error::{Error, Result};
use crate::progress::Progress;

/// Bytes of a file that may be left over.
const SLACK: f64 = 0.01;
/// Files that [`Prepared::encode_to`] tries.
const TRIES: usize = 4;

impl Prepared<'_> {
    /// Builds a file of at most so many bytes, a few times where its parts turn out larger or smaller than usual; says
    /// what it has.
    ///
    /// # Errors
    /// As [`Self::encode`]; [`Error::Request`] if no file is that small.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a part of a number of bytes")]
    pub fn encode_to(&self, bytes: usize, progress: &dyn Progress) -> Result<(Vec<u8>, Sizes)> {
        let mut sizes = Sizes::for_bytes(bytes, self.texels(), self.nodes());
        let mut best: Option<(Vec<u8>, Sizes)> = None;
        let mut least = usize::MAX;
        for _ in 0..TRIES {
            let file = self.encode(&sizes, progress)?;
            least = least.min(file.len());
            let CoreSize::Bytes(core) = sizes.core else { break };
            let off = file.len() as f64 - bytes as f64;
            let is_near = off <= 0.0 && -off <= SLACK * bytes as f64;
            let is_better = off <= 0.0 && best.as_ref().is_none_or(|(best, _)| best.len() < file.len());
            if is_better {
                best = Some((file, sizes.clone()));
            }
            if is_near || progress.stopped() {
                break;
            }
            // The core takes what is left, or gives up what is missing; components go before it is too coarse.
            let usual = OF_CORE * bytes as f64;
            let wanted = core as f64 - off - 0.3 * SLACK * bytes as f64;
            if wanted < 0.5 * usual {
                let fewer =
                    (sizes.luma as f64 * (1.0 - (usual - wanted) / (0.5 * bytes as f64)).clamp(0.3, 0.95)) as usize;
                sizes.luma = fewer.max(2);
                let count = 2 + sizes.chroma + sizes.luma;
                sizes.stages.iter_mut().for_each(|stage| stage.count = count);
            }
            sizes.core = CoreSize::Bytes(wanted.clamp(0.5 * usual, 2.5 * usual) as usize);
        }
        best.ok_or_else(|| Error::Request(format!("no file of factors is that small; this one takes {least} bytes")))
    }
}
