//! How materials and intermediate targets are stored on the device: each way is a list of WGSL files.

use super::binding::Binding;
use super::file::{File, wgsl};

/// Storage of four values in a texel of an intermediate target, for later passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TargetFormat {
    /// Four half floats.
    Half,
    /// Bits of four half floats in integers, which every GLES 3.0 device draws to. They cannot be blended or filtered: splats
    /// need [`TargetFormat::Half`].
    Packed,
}

impl TargetFormat {
    /// All formats.
    pub const ALL: [Self; 2] = [Self::Half, Self::Packed];

    pub(super) const fn files(self) -> &'static [File] {
        match self {
            Self::Half => &[wgsl!("lib/target_half")],
            Self::Packed => &[wgsl!("lib/target_packed")],
        }
    }
}

/// Storage of the diffuse reflectance of a material; the files of each have the functions `load_pixel`, `partner_at` and
/// `reflectance`, and of all but captures `pack_pixel` and `unpack_pixel`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MaterialLayout {
    /// One base material per pixel.
    Bmpp1,
    /// Two base materials per pixel, an index for each.
    Bmpp2,
    /// Two base materials per pixel, from a palette of pairs.
    Bmpp2Palette,
    /// Three base materials per pixel.
    Bmpp3,
    /// Five base materials per pixel.
    Bmpp5,
    /// Log-scale profile for every pixel.
    PerPixel,
    /// Every entry of an uncompressed capture, which can only be drawn flat.
    Capture,
}

impl MaterialLayout {
    /// All layouts.
    pub const ALL: [Self; 7] =
        [Self::Bmpp1, Self::Bmpp2, Self::Bmpp2Palette, Self::Bmpp3, Self::Bmpp5, Self::PerPixel, Self::Capture];

    pub(super) const fn files(self) -> &'static [File] {
        match self {
            Self::Bmpp1 => &[
                wgsl!("material/material"),
                wgsl!("material/base_profiles"),
                wgsl!("material/bmpp1"),
                wgsl!("material/reflectance"),
            ],
            Self::Bmpp2 => &[
                wgsl!("material/material"),
                wgsl!("material/base_profiles"),
                wgsl!("material/bmpp2"),
                wgsl!("material/bmpp2_indices"),
                wgsl!("material/reflectance"),
            ],
            Self::Bmpp2Palette => &[
                wgsl!("material/material"),
                wgsl!("material/base_profiles"),
                wgsl!("material/bmpp2"),
                wgsl!("material/bmpp2_palette"),
                wgsl!("material/reflectance"),
            ],
            Self::Bmpp3 => &[
                wgsl!("material/bmpp3"),
                wgsl!("material/material"),
                wgsl!("material/base_profiles"),
                wgsl!("material/bmpp_k"),
                wgsl!("material/reflectance"),
            ],
            Self::Bmpp5 => &[
                wgsl!("material/bmpp5"),
                wgsl!("material/material"),
                wgsl!("material/base_profiles"),
                wgsl!("material/bmpp_k"),
                wgsl!("material/reflectance"),
            ],
            Self::PerPixel => &[wgsl!("material/material"), wgsl!("material/per_pixel"), wgsl!("material/reflectance")],
            Self::Capture => &[wgsl!("lib/array"), wgsl!("material/material"), wgsl!("material/capture")],
        }
    }

    /// Bind group of a material.
    #[must_use]
    pub const fn bindings(self) -> &'static [Binding] {
        match self {
            Self::Bmpp1 => &[Binding::Uniform, Binding::Float, Binding::Uint],
            Self::Bmpp2 => &[Binding::Uniform, Binding::Float, Binding::Float, Binding::Uint],
            Self::Bmpp2Palette => &[Binding::Uniform, Binding::Float, Binding::Uint, Binding::Uint],
            Self::Bmpp3 | Self::Bmpp5 => &[Binding::Uniform, Binding::Float, Binding::FloatLayers, Binding::UintLayers],
            Self::PerPixel | Self::Capture => &[Binding::Uniform, Binding::FloatLayers],
        }
    }
}

/// Storage of a bidirectional texture function; the files of each have the functions `view_coord`, `apparent_brdf`,
/// `btf_value`, `light_sampler`, `sample_light` and `light_density`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BtfLayout {
    /// Nested codebooks: a file as it is.
    Nested,
    /// Image for every pair of a light and a view, uncompressed.
    Images,
}

impl BtfLayout {
    /// All layouts.
    pub const ALL: [Self; 2] = [Self::Nested, Self::Images];

    pub(super) const fn files(self) -> &'static [File] {
        match self {
            Self::Nested => &[
                wgsl!("material/btf/btf_words"),
                wgsl!("material/btf/btf_angle"),
                wgsl!("material/btf/btf_grid"),
                wgsl!("material/btf/btf_chain"),
                wgsl!("material/btf/btf_colour"),
                wgsl!("material/btf/btf_sampler"),
            ],
            Self::Images => &[wgsl!("material/btf/btf_angle"), wgsl!("material/btf/btf_images")],
        }
    }

    /// First bindings of the bind group of a BTF.
    #[must_use]
    pub const fn bindings(self) -> &'static [Binding] {
        match self {
            Self::Nested => &[Binding::Uniform, Binding::Uint],
            Self::Images => &[Binding::Uniform, Binding::FloatLayers],
        }
    }
}

/// One map of irradiance.
pub(super) const TERMS_1: File = wgsl!("lib/blur/terms_1");

/// Files for L weighted irradiance maps, 1 or 2.
pub(super) const fn terms(terms: usize) -> &'static [File] {
    match terms {
        1 => &[TERMS_1],
        _ => &[wgsl!("lib/blur/terms_2")],
    }
}

/// Files for light of the environment on BTFs.
pub(super) const fn ambient(has_ambient: bool) -> &'static [File] {
    if has_ambient { &[wgsl!("material/btf/btf_ambient")] } else { &[wgsl!("material/btf/ambient_none")] }
}
