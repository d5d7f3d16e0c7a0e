//! Rows of the passes of LinSSS, a rival.

use super::binding::Binding::{FilteredLayers, Sampler, Target, TargetLayers, Uniform};
use super::file::wgsl;
use super::pass::{Group, Part, Pass};
use super::table::{
    COAT, DISPLAY, FRESNEL, FULLSCREEN, HOST_SHADOW, HOST_SHADOWS, LIT, MAPPING, NEIGHBOURS, OBJECT, OF_HOST,
    OF_OBJECT, PATCH_LAYERS, SCENE, SHADING, SPREAD, TONE, TSM_VISIBILITY, UPSAMPLING, VERTEX, VERTEX_NONE,
    VISIBILITIES, fullscreen, pass, shaded,
};

const LINSSS: Part = Part::File(wgsl!("lib/linsss"));
const LINSSS_STAGE: Part = Part::File(wgsl!("lib/linsss_stage"));

/// G-buffer for LinSSS: light that enters, weighted for one Gaussian, and transmitted.
pub static LINSSS_GBUFFER: Pass = Pass {
    overrides: &[HOST_SHADOWS],
    ..pass(
        wgsl!("pass/linsss/linsss_gbuffer"),
        &[
            Part::TargetFormat,
            FRESNEL,
            OBJECT,
            SCENE,
            MAPPING,
            HOST_SHADOW,
            TSM_VISIBILITY,
            PATCH_LAYERS,
            VISIBILITIES,
            VERTEX_NONE,
            VERTEX,
            SPREAD,
            LINSSS,
        ],
        "project",
        &[
            Group::Fixed(&[Uniform, Target]),
            Group::Fixed(&[FilteredLayers, Sampler, Uniform, Target, Target]),
            OF_OBJECT,
            OF_HOST,
        ],
    )
};

/// Blur of two maps by one Gaussian of LinSSS along one axis.
pub static LINSSS_BLUR: Pass = fullscreen(
    wgsl!("pass/linsss/linsss_blur"),
    &[Part::TargetFormat, FULLSCREEN, LINSSS_STAGE],
    &[Group::Fixed(&[Uniform, Target, Target])],
);

/// Next level of the pyramid of light of LinSSS.
pub static LINSSS_REDUCE: Pass = fullscreen(
    wgsl!("pass/linsss/linsss_reduce"),
    &[Part::TargetFormat, FULLSCREEN, LINSSS_STAGE],
    &[Group::Fixed(&[Uniform, Target])],
);

/// Light blurred by one Gaussian of LinSSS, from the pyramid.
pub static LINSSS_LOOKUP: Pass = fullscreen(
    wgsl!("pass/linsss/linsss_lookup"),
    &[Part::TargetFormat, FULLSCREEN, LINSSS_STAGE],
    &[Group::Fixed(&[Uniform, Target, Target, Target])],
);

/// Picture of a mesh by LinSSS.
pub static SHADE_LINSSS: Pass = shaded(
    wgsl!("pass/linsss/shade_linsss"),
    &[
        Part::TargetFormat,
        TONE,
        DISPLAY,
        FRESNEL,
        OBJECT,
        SCENE,
        COAT,
        MAPPING,
        HOST_SHADOW,
        TSM_VISIBILITY,
        PATCH_LAYERS,
        VISIBILITIES,
        VERTEX_NONE,
        VERTEX,
        NEIGHBOURS,
        UPSAMPLING,
        SHADING,
        LINSSS,
    ],
    &[
        LIT,
        Group::Fixed(&[FilteredLayers, Sampler, Uniform, Uniform, TargetLayers, TargetLayers, Target]),
        OF_OBJECT,
        OF_HOST,
    ],
);
