//! The table of passes; those of separable kernels are in [`kernel`](super::kernel), of light volumes in
//! [`volume`](super::volume), of what is precomputed for vertices in [`transfer`](super::transfer), of rivals in
//! [`linsss`](super::linsss).

use super::binding::Binding::{
    self, Filtered, FilteredLayers, Float, FloatLayers, Nearest, Sampler, Target, TargetLayers, Uniform,
};
use super::file::{File, wgsl};
use super::pass::{Group, Part, Pass};

pub(super) const ARRAY: Part = Part::File(wgsl!("lib/array"));
pub(super) const FULLSCREEN: Part = Part::File(wgsl!("lib/fullscreen"));
pub(super) const FRESNEL: Part = Part::File(wgsl!("lib/fresnel"));
pub(super) const OBJECT: Part = Part::File(wgsl!("lib/mesh/object"));
pub(super) const SCENE: Part = Part::File(wgsl!("lib/scene"));
pub(super) const COAT: Part = Part::File(wgsl!("lib/coat"));
pub(super) const TONE: Part = Part::File(wgsl!("lib/tone"));
pub(super) const DISPLAY: Part = Part::File(wgsl!("lib/display"));
pub(super) const MAPPING: Part = Part::File(wgsl!("lib/mesh/mapping"));
pub(super) const PATCH_LAYERS: Part = Part::File(wgsl!("lib/mesh/patch_layers"));
pub(super) const VERTEX: Part = Part::File(wgsl!("lib/mesh/vertex"));
pub(super) const VERTEX_NONE: Part = Part::File(wgsl!("lib/mesh/vertex_none"));
pub(super) const VISIBILITIES: Part = Part::File(wgsl!("lib/visibilities"));
const EXITANCE_VERTEX: Part = Part::File(wgsl!("lib/mesh/exitance_vertex"));
pub(super) const SHADING: Part = Part::File(wgsl!("lib/mesh/shading"));
const BTF_VERTEX: Part = Part::File(wgsl!("lib/mesh/btf_vertex"));
const BTF_TANGENTS: Part = Part::File(wgsl!("lib/mesh/btf_tangents"));
const BTF_TEXTURE: Part = Part::File(wgsl!("material/btf/btf_texture"));
const TSM: Part = Part::File(wgsl!("lib/screen/tsm"));
pub(super) const HOST_SHADOW: Part = Part::File(wgsl!("lib/screen/host_shadow"));
pub(super) const TSM_VISIBILITY: Part = Part::File(wgsl!("lib/screen/tsm_visibility"));
const TRANSMISSION: Part = Part::File(wgsl!("lib/screen/transmission"));
pub(super) const SPREAD: Part = Part::File(wgsl!("lib/screen/spread"));
pub(super) const NEIGHBOURS: Part = Part::File(wgsl!("lib/screen/neighbours"));
pub(super) const UPSAMPLING: Part = Part::File(wgsl!("lib/screen/upsampling"));
pub(super) const SUMS: Part = Part::File(wgsl!("lib/screen/sums"));
const SEPARABLE_BASIS: Part = Part::File(wgsl!("lib/blur/separable_basis"));
pub(super) const BLUR: Part = Part::File(wgsl!("lib/blur/blur"));
const DOMAIN_PATCH: Part = Part::File(wgsl!("lib/blur/domain_patch"));
pub(super) const SCREEN: Part = Part::File(wgsl!("lib/blur/screen"));
const DOMAIN_SCREEN: Part = Part::File(wgsl!("lib/blur/domain_screen"));
const MAPS_IRRADIANCE: Part = Part::File(wgsl!("lib/blur/maps_irradiance"));
const MAPS_STAGE: Part = Part::File(wgsl!("lib/blur/maps_stage"));
pub(super) const STAGE_SUM: Part = Part::File(wgsl!("lib/blur/stage_sum"));
pub(super) const VOLUME: Part = Part::File(wgsl!("lib/volume/volume"));
const VOLUME_SUMS: Part = Part::File(wgsl!("lib/volume/volume_sums"));

/// Whether the shader encodes for the display; an override of passes that draw pictures of meshes.
pub const ENCODE_SRGB: &str = "ENCODE_SRGB";
/// Whether light is tone-mapped; an override of the same passes.
pub const TONE_MAP: &str = "TONE_MAP";

/// Whether lights may have shadow maps of the host's own; an override of passes that look up visibilities of lights.
pub const HOST_SHADOWS: &str = "HOST_SHADOWS";

/// Bind group 0 of pictures of meshes: scene, positions of the translucent shadow maps, reflections and their sampler.
pub(super) const LIT: Group = Group::Fixed(&[Uniform, Target, Filtered, Sampler]);

/// Bind group 2 of passes that draw meshes: the object.
pub(super) const OF_OBJECT: Group = Group::Fixed(&[Binding::Object]);

/// Bind group 3 of passes that look up visibilities of lights: the host's shadow maps, and their sampler.
pub const HOST_SHADOW_MAPS: &[Binding] = &[Float, Float, Float, Float, Float, Float, Float, Float, Nearest];

pub(super) const OF_HOST: Group = Group::Fixed(HOST_SHADOW_MAPS);

/// Row of a pass without overrides.
pub(super) const fn pass(file: File, parts: &'static [Part], vertex: &'static str, groups: &'static [Group]) -> Pass {
    Pass { file, parts, vertex, groups, overrides: &[] }
}

/// Row of a full-screen pass.
pub(super) const fn fullscreen(file: File, parts: &'static [Part], groups: &'static [Group]) -> Pass {
    pass(file, parts, "fullscreen", groups)
}

/// Row of a picture of a mesh whose lights have shadow maps.
pub(super) const fn shaded(file: File, parts: &'static [Part], groups: &'static [Group]) -> Pass {
    Pass { overrides: &[TONE_MAP, ENCODE_SRGB, HOST_SHADOWS], ..pass(file, parts, "project", groups) }
}

/// Row of a picture of a mesh whose vertices know what lights reach.
const fn picture(file: File, parts: &'static [Part], groups: &'static [Group]) -> Pass {
    Pass { overrides: &[TONE_MAP, ENCODE_SRGB], ..pass(file, parts, "project", groups) }
}

/// Exitance of a flat patch, by the reference sum.
pub static GATHER: Pass = fullscreen(
    wgsl!("pass/patch/gather"),
    &[Part::TargetFormat, Part::MaterialLayout, FULLSCREEN],
    &[Group::Material, Group::Fixed(&[Uniform, Float])],
);

/// Picture of a flat patch from its exitance.
pub static PRESENT: Pass = fullscreen(
    wgsl!("pass/patch/present"),
    &[Part::TargetFormat, FULLSCREEN, TONE],
    &[Group::Fixed(&[Uniform, Target])],
);

/// Blur of a flat patch by one kernel for all pixels, along one axis.
pub static HOMOGENEOUS: Pass =
    fullscreen(wgsl!("pass/patch/homogeneous"), &[FULLSCREEN], &[Group::Fixed(&[Uniform, Nearest, Float])]);

/// First stage of the cascade on a flat patch, along rows.
pub static BLUR_PATCH_FIRST: Pass = fullscreen(
    wgsl!("pass/patch/blur_patch_first"),
    &[Part::TargetFormat, Part::Terms, FULLSCREEN, DOMAIN_PATCH, BLUR, MAPS_IRRADIANCE],
    &[Group::Fixed(&[Uniform, Uniform, FloatLayers, Float])],
);

/// Stages of the cascade on a flat patch, along rows or along columns, but for the first and the last.
pub static BLUR_PATCH: Pass = fullscreen(
    wgsl!("pass/patch/blur_patch"),
    &[Part::TargetFormat, Part::Terms, FULLSCREEN, DOMAIN_PATCH, BLUR, MAPS_STAGE],
    &[Group::Maps(&[Uniform, Uniform, TargetLayers])],
);

/// Sum over the stages of the cascade on a flat patch so far, once one of them is through.
pub static SUM_PATCH: Pass = fullscreen(
    wgsl!("pass/patch/sum_patch"),
    &[Part::TargetFormat, Part::Terms, FULLSCREEN, DOMAIN_PATCH, BLUR, MAPS_STAGE, STAGE_SUM],
    &[Group::Maps(&[Uniform, Uniform, TargetLayers, TargetLayers])],
);

/// Last stage of the cascade on a flat patch, along columns, and the exitance.
pub static BLUR_PATCH_LAST: Pass = fullscreen(
    wgsl!("pass/patch/blur_patch_last"),
    &[Part::TargetFormat, Part::Terms, FULLSCREEN, DOMAIN_PATCH, BLUR, MAPS_STAGE, STAGE_SUM],
    &[Group::Maps(&[Uniform, Uniform, TargetLayers, TargetLayers, FilteredLayers])],
);

/// Coefficients of the separable basis of every pixel, or its albedo, from the planes of a file.
pub static PROFILE_SUMS: Pass = fullscreen(
    wgsl!("pass/patch/profile_sums"),
    &[Part::TargetFormat, Part::FittedLayout, ARRAY, FULLSCREEN],
    &[Group::Material, Group::Fixed(&[Float])],
);

/// Next mipmap level of layers over a patch.
pub static PATCH_REDUCE: Pass =
    fullscreen(wgsl!("pass/patch/patch_reduce"), &[Part::TargetFormat, FULLSCREEN], &[Group::Fixed(&[FloatLayers])]);

/// Irradiance that enters a surface at each of its points.
pub static IRRADIANCE: Pass = fullscreen(
    wgsl!("pass/surface/irradiance"),
    &[Part::TargetFormat, FRESNEL, OBJECT, SCENE, VISIBILITIES, FULLSCREEN],
    &[Group::Fixed(&[Uniform]), Group::Fixed(&[Float, Float, Binding::Uint]), OF_OBJECT],
);

/// Exitance at the points of a surface, by the reference sum.
pub static SURFACE_GATHER: Pass = fullscreen(
    wgsl!("pass/surface/surface_gather"),
    &[Part::TargetFormat, Part::FittedLayout, ARRAY, FULLSCREEN],
    &[Group::Material, Group::Fixed(&[Uniform, Float, Binding::Uint, Binding::Uint, Target])],
);

/// Picture of a mesh from the exitance of its vertices.
pub static SHADE_VERTEX: Pass = picture(
    wgsl!("pass/surface/shade_vertex"),
    &[
        Part::TargetFormat,
        TONE,
        DISPLAY,
        FRESNEL,
        OBJECT,
        SCENE,
        COAT,
        MAPPING,
        VISIBILITIES,
        ARRAY,
        EXITANCE_VERTEX,
        VERTEX,
        SHADING,
    ],
    &[LIT, Group::Fixed(&[Target, Binding::Uint]), OF_OBJECT],
);

/// Translucent shadow map of a light.
pub static TSM_RENDER: Pass = pass(
    wgsl!("pass/tsm/tsm_render"),
    &[Part::TargetFormat, FRESNEL, OBJECT, SCENE, MAPPING, TSM],
    "project",
    &[Group::Fixed(&[Uniform]), Group::Fixed(&[Uniform]), OF_OBJECT],
);

/// Next mipmap level of a translucent shadow map.
pub static TSM_REDUCE: Pass = fullscreen(
    wgsl!("pass/tsm/tsm_reduce"),
    &[Part::TargetFormat, FULLSCREEN, TSM],
    &[Group::Fixed(&[Uniform, Target, Target, Target])],
);

/// G-buffer of a mesh for splats: positions, texture coordinates, albedo.
pub static SURFACE_GBUFFER: Pass = pass(
    wgsl!("pass/splat/surface_gbuffer"),
    &[FRESNEL, OBJECT, SCENE, MAPPING, PATCH_LAYERS, VISIBILITIES, VERTEX_NONE, VERTEX],
    "project",
    &[Group::Fixed(&[Uniform]), Group::Fixed(&[FilteredLayers, Sampler]), OF_OBJECT],
);

/// Light of samples of a translucent shadow map, spread over what lies around them.
pub static SPLAT: Pass = pass(
    wgsl!("pass/splat/splat"),
    &[Part::FittedLayout],
    "splat_quad",
    &[Group::Material, Group::Fixed(&[Uniform, Float, Float, Float, Float, Float, Float])],
);

/// Sum of all rings of splats.
pub static SPLAT_RESOLVE: Pass = fullscreen(
    wgsl!("pass/splat/splat_resolve"),
    &[FULLSCREEN, NEIGHBOURS],
    &[Group::Fixed(&[Uniform, Float, Float, Float, Float, Float, Float, Float])],
);

/// Picture of a mesh from the resolved splats.
pub static SHADE_SPLAT: Pass = shaded(
    wgsl!("pass/splat/shade_splat"),
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
    ],
    &[LIT, Group::Fixed(&[FilteredLayers, Sampler, Uniform, Float]), OF_OBJECT, OF_HOST],
);

/// G-buffer for the separable blurs on the screen: L weighted irradiance maps, and transmitted light.
pub static SEPARABLE_GBUFFER: Pass = Pass {
    overrides: &[HOST_SHADOWS],
    ..pass(
        wgsl!("pass/separable/separable_gbuffer"),
        &[
            Part::TargetFormat,
            Part::Terms,
            FRESNEL,
            OBJECT,
            SCENE,
            MAPPING,
            HOST_SHADOW,
            TSM_VISIBILITY,
            PATCH_LAYERS,
            SEPARABLE_BASIS,
            VISIBILITIES,
            VERTEX_NONE,
            VERTEX,
            SPREAD,
            VOLUME,
            VOLUME_SUMS,
            TRANSMISSION,
        ],
        "project",
        &[
            Group::Fixed(&[Uniform, Target]),
            Group::Maps(&[FilteredLayers, Sampler, Uniform, Target, Target, Uniform, TargetLayers]),
            OF_OBJECT,
            OF_HOST,
        ],
    )
};

/// Stages of the cascade on the screen, along rows or along columns.
pub static BLUR_SCREEN: Pass = fullscreen(
    wgsl!("pass/separable/blur_screen"),
    &[Part::TargetFormat, Part::Terms, FULLSCREEN, SCREEN, DOMAIN_SCREEN, BLUR],
    &[Group::Maps(&[Uniform, Uniform, TargetLayers])],
);

/// Sum over the stages of the cascade on the screen so far, once one of them is through.
pub static SUM_SCREEN: Pass = fullscreen(
    wgsl!("pass/separable/sum_screen"),
    &[Part::TargetFormat, Part::Terms, FULLSCREEN, SCREEN, DOMAIN_SCREEN, BLUR, STAGE_SUM],
    &[Group::Maps(&[Uniform, Uniform, TargetLayers, TargetLayers])],
);

/// Last stage of the cascade on the screen, along columns, and the sum over all stages.
pub static BLUR_SCREEN_LAST: Pass = fullscreen(
    wgsl!("pass/separable/blur_screen_last"),
    &[Part::TargetFormat, Part::Terms, FULLSCREEN, SCREEN, DOMAIN_SCREEN, BLUR, STAGE_SUM],
    &[Group::Maps(&[Uniform, Uniform, TargetLayers, TargetLayers])],
);

/// Picture of a mesh from L blurred maps on the screen.
pub static SHADE_SEPARABLE: Pass = shaded(
    wgsl!("pass/separable/shade_separable"),
    &[
        Part::TargetFormat,
        Part::Terms,
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
        SEPARABLE_BASIS,
        VISIBILITIES,
        VERTEX_NONE,
        VERTEX,
        NEIGHBOURS,
        UPSAMPLING,
        SUMS,
        SHADING,
    ],
    &[LIT, Group::Maps(&[FilteredLayers, Sampler, Uniform, TargetLayers]), OF_OBJECT, OF_HOST],
);

/// Values and light samples of a BTF for lists of directions.
pub static BTF_QUERY: Pass = fullscreen(
    wgsl!("pass/btf/btf_query"),
    &[Part::BtfLayout, TONE, FULLSCREEN],
    &[Group::Fixed(&[Float, Float, Float]), Group::Btf(&[])],
);

/// Picture of a mesh of a BTF.
pub static SHADE_BTF: Pass = shaded(
    wgsl!("pass/btf/shade_btf"),
    &[
        Part::TargetFormat,
        Part::BtfLayout,
        TONE,
        DISPLAY,
        FRESNEL,
        OBJECT,
        SCENE,
        COAT,
        HOST_SHADOW,
        TSM_VISIBILITY,
        BTF_VERTEX,
        BTF_TEXTURE,
        BTF_TANGENTS,
        Part::Ambient,
    ],
    &[LIT, Group::Btf(&[Uniform]), OF_OBJECT, OF_HOST],
);
