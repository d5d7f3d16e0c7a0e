//! Rows of the passes of separable kernels.

use super::binding::Binding::{Float, Target, Uniform};
use super::file::wgsl;
use super::layout::TERMS_1;
use super::pass::{Group, Part, Pass};
use super::table::{
    COAT, DISPLAY, FRESNEL, FULLSCREEN, HOST_SHADOW, HOST_SHADOWS, LIT, NEIGHBOURS, OBJECT, OF_HOST, OF_OBJECT, SCENE,
    SCREEN, SHADING, SPREAD, SUMS, TONE, TSM_VISIBILITY, UPSAMPLING, VERTEX, VERTEX_NONE, VISIBILITIES, fullscreen,
    pass, shaded,
};

const KERNEL: Part = Part::File(wgsl!("lib/blur/kernel"));
const KERNEL_PROFILE: Part = Part::File(wgsl!("lib/blur/kernel_profile"));
const KERNEL_TRANSMISSION: Part = Part::File(wgsl!("lib/screen/kernel_transmission"));

/// G-buffer for separable kernels on the screen, with light that is transmitted from behind.
pub static KERNEL_GBUFFER: Pass = Pass {
    overrides: &[HOST_SHADOWS],
    ..pass(
        wgsl!("pass/kernel/kernel_gbuffer"),
        &[
            Part::TargetFormat,
            FRESNEL,
            OBJECT,
            SCENE,
            HOST_SHADOW,
            TSM_VISIBILITY,
            VISIBILITIES,
            VERTEX_NONE,
            VERTEX,
            SPREAD,
            KERNEL_PROFILE,
            KERNEL_TRANSMISSION,
        ],
        "project",
        &[Group::Fixed(&[Uniform, Target]), Group::Fixed(&[Uniform, Float, Target]), OF_OBJECT, OF_HOST],
    )
};

/// Blur by a term of a separable kernel on the screen, along rows.
pub static BLUR_KERNEL: Pass = fullscreen(
    wgsl!("pass/kernel/blur_kernel"),
    &[Part::TargetFormat, FULLSCREEN, SCREEN, KERNEL],
    &[Group::Fixed(&[Uniform, Uniform, Target])],
);

/// Blur by a term of a separable kernel on the screen along columns, and the sum over the terms so far.
pub static SUM_KERNEL: Pass = fullscreen(
    wgsl!("pass/kernel/sum_kernel"),
    &[Part::TargetFormat, FULLSCREEN, SCREEN, KERNEL],
    &[Group::Fixed(&[Uniform, Uniform, Target, Target])],
);

/// Plain copy of a map: what blurs are timed against.
pub static COPY: Pass =
    fullscreen(wgsl!("pass/kernel/copy"), &[Part::TargetFormat, FULLSCREEN], &[Group::Fixed(&[Target])]);

/// Picture of a mesh from light that a separable kernel has blurred on the screen.
pub static SHADE_KERNEL: Pass = shaded(
    wgsl!("pass/kernel/shade_kernel"),
    &[
        Part::TargetFormat,
        TONE,
        DISPLAY,
        FRESNEL,
        OBJECT,
        SCENE,
        COAT,
        HOST_SHADOW,
        TSM_VISIBILITY,
        VISIBILITIES,
        VERTEX_NONE,
        VERTEX,
        NEIGHBOURS,
        UPSAMPLING,
        Part::File(TERMS_1),
        SUMS,
        KERNEL_PROFILE,
        SHADING,
    ],
    &[LIT, Group::Fixed(&[Uniform, Target, Uniform]), OF_OBJECT, OF_HOST],
);
