//! Rows of the passes of what is precomputed for vertices.

use super::binding::Binding::{Float, Uint, Uniform};
use super::file::wgsl;
use super::pass::{Group, Part, Pass};
use super::table::{
    ARRAY, COAT, DISPLAY, FRESNEL, HOST_SHADOW, LIT, OBJECT, OF_HOST, OF_OBJECT, SCENE, SHADING, TONE, TSM_VISIBILITY,
    VERTEX, VERTEX_NONE, VISIBILITIES, shaded,
};

const TRANSFER_VERTEX: Part = Part::File(wgsl!("lib/mesh/transfer_vertex"));

/// Picture of a mesh from what is precomputed for its vertices.
pub static SHADE_TRANSFER: Pass = shaded(
    wgsl!("pass/transfer/shade_transfer"),
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
        ARRAY,
        TRANSFER_VERTEX,
        VERTEX,
        SHADING,
    ],
    &[LIT, Group::Fixed(&[Uniform, Uint, Float]), OF_OBJECT, OF_HOST],
);

/// Picture of the coat of a mesh, without scattered light: what pictures with it are timed against.
pub static SHADE_COAT: Pass = shaded(
    wgsl!("pass/transfer/shade_coat"),
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
        SHADING,
    ],
    &[LIT, Group::Fixed(&[]), OF_OBJECT, OF_HOST],
);
