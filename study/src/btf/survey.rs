//! Survey of a material's images, which its encoders and baselines share.

use subsurf_cli::encode::btf::detail;
use subsurf_cli::program::failure::bad_request;
use subsurf_cli::program::progress::Bars;
use subsurf_encoder::btf::{Images, Survey};

/// Seed of all encoders, and of the first piece of every material.
pub(super) const SEED: u64 = 1;

/// Survey of the images of some materials.
pub(super) fn survey_of(images: &[Images]) -> subsurf_encoder::Result<Survey> {
    Survey::new(images, detail(images.len()), SEED, &Bars::new())
}

/// The survey, made unless it is there.
pub(super) fn surveyed<'a>(images: &[Images], survey: &'a mut Option<Survey>) -> anyhow::Result<&'a Survey> {
    if survey.is_none() {
        *survey = Some(survey_of(images)?);
    }
    survey.as_ref().ok_or_else(|| bad_request("no survey"))
}
