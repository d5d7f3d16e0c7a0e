//! All passes.

use super::pass::Pass;
use super::{kernel, linsss, table};

/// All passes.
pub static ALL: [&Pass; 35] = [
    &table::GATHER,
    &table::PRESENT,
    &table::HOMOGENEOUS,
    &table::BLUR_PATCH_FIRST,
    &table::BLUR_PATCH,
    &table::SUM_PATCH,
    &table::BLUR_PATCH_LAST,
    &table::PROFILE_SUMS,
    &table::PATCH_REDUCE,
    &table::IRRADIANCE,
    &table::SURFACE_GATHER,
    &table::SHADE_VERTEX,
    &table::TSM_RENDER,
    &table::TSM_REDUCE,
    &table::SURFACE_GBUFFER,
    &table::SPLAT,
    &table::SPLAT_RESOLVE,
    &table::SHADE_SPLAT,
    &table::SEPARABLE_GBUFFER,
    &table::BLUR_SCREEN,
    &table::SUM_SCREEN,
    &table::BLUR_SCREEN_LAST,
    &table::SHADE_SEPARABLE,
    &kernel::KERNEL_GBUFFER,
    &kernel::BLUR_KERNEL,
    &kernel::SUM_KERNEL,
    &kernel::SHADE_KERNEL,
    &kernel::COPY,
    &linsss::LINSSS_GBUFFER,
    &linsss::LINSSS_BLUR,
    &linsss::LINSSS_REDUCE,
    &linsss::LINSSS_LOOKUP,
    &linsss::SHADE_LINSSS,
    &table::BTF_QUERY,
    &table::SHADE_BTF,
];
