//! Truncated SVD of a material's images, which its encoders and baselines share.

use subsurf_cli::program::failure::bad_request;
use subsurf_cli::program::progress::Bars;
use subsurf_encoder::btf::{TruncatedSvd, presets};
use subsurf_encoder::capture::Images;

/// Seed of all encoders, and of the first piece of every material.
pub(super) const SEED: u64 = 1;

/// Truncated SVD of the images of some materials.
pub(super) fn svd_of(images: &[Images]) -> subsurf_encoder::Result<TruncatedSvd> {
    TruncatedSvd::new(images, presets::ranks(images.len()), SEED, &Bars::new())
}

/// The decomposition, made unless it is there.
pub(super) fn shared_svd<'a>(images: &[Images], svd: &'a mut Option<TruncatedSvd>) -> anyhow::Result<&'a TruncatedSvd> {
    if svd.is_none() {
        *svd = Some(svd_of(images)?);
    }
    svd.as_ref().ok_or_else(|| bad_request("no decomposition"))
}
