//! Passes of light volumes.

use super::binding::Binding::{FilteredLayers, Sampler, Target, TargetLayers, Uniform};
use super::file::wgsl;
use super::pass::{Group, Part, Pass};
use super::table::{BLUR, FULLSCREEN, SCENE, STAGE_SUM, VOLUME, fullscreen};

const DOMAIN_VOLUME: Part = Part::File(wgsl!("lib/volume/domain_volume"));

/// Light that enters, added to the cells of a volume.
pub static FILL_VOLUME: Pass = fullscreen(
    wgsl!("pass/volume/fill_volume"),
    &[Part::TargetFormat, Part::Terms, SCENE, FULLSCREEN, VOLUME],
    &[Group::Fixed(&[Uniform, Target]), Group::Fixed(&[FilteredLayers, Sampler, Uniform, Target, Target])],
);

/// Stages of the cascade in a volume, along one axis.
pub static BLUR_VOLUME: Pass = fullscreen(
    wgsl!("pass/volume/blur_volume"),
    &[Part::TargetFormat, Part::Terms, FULLSCREEN, VOLUME, BLUR, DOMAIN_VOLUME],
    &[Group::Maps(&[Uniform, Uniform, TargetLayers])],
);

/// Sum over the stages of the cascade in a volume so far, once one of them is through.
pub static SUM_VOLUME: Pass = fullscreen(
    wgsl!("pass/volume/sum_volume"),
    &[Part::TargetFormat, Part::Terms, FULLSCREEN, VOLUME, BLUR, DOMAIN_VOLUME, STAGE_SUM],
    &[Group::Maps(&[Uniform, Uniform, TargetLayers, TargetLayers])],
);
