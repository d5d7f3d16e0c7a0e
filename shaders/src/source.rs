//! The passes, as WGSL text.

/// How a patch's reflectance is stored; each has the functions `load_pixel` and `reflectance`.
macro_rules! with_model {
    ($($part:literal),+) => {
        concat!(include_str!("../wgsl/material.wgsl"), $(include_str!(concat!("../wgsl/", $part))),+)
    };
}

/// A pass in the variants for 2-BMPP, per-pixel profiles and captures.
#[derive(Clone, Copy, Debug)]
pub struct ByModel {
    /// Two base materials per pixel.
    pub bmpp: &'static str,
    /// Per-pixel profiles.
    pub per_pixel: &'static str,
    /// An uncompressed capture.
    pub capture: &'static str,
}

/// Exitance of a flat patch; entry points `cover` and `gather`.
pub const GATHER: ByModel = ByModel {
    bmpp: with_model!("bmpp.wgsl", "pair.wgsl", "cover.wgsl", "gather.wgsl"),
    per_pixel: with_model!("per_pixel.wgsl", "pair.wgsl", "cover.wgsl", "gather.wgsl"),
    capture: with_model!("capture.wgsl", "cover.wgsl", "gather.wgsl"),
};

/// Exitance of 2-BMPP at the points of a surface; entry points `cover` and `surface_gather`.
pub const SURFACE_GATHER_BMPP: &str = with_model!("bmpp.wgsl", "pair.wgsl", "cover.wgsl", "surface_gather.wgsl");

/// Exitance of per-pixel profiles at the points of a surface; entry points `cover` and `surface_gather`.
pub const SURFACE_GATHER_PER_PIXEL: &str =
    with_model!("per_pixel.wgsl", "pair.wgsl", "cover.wgsl", "surface_gather.wgsl");

/// Irradiance at the points of a surface; entry points `cover` and `irradiance`.
pub const IRRADIANCE: &str = concat!(
    include_str!("../wgsl/fresnel.wgsl"),
    include_str!("../wgsl/cover.wgsl"),
    include_str!("../wgsl/irradiance.wgsl")
);

/// Picture of a mesh; entry points `project` and `shade`.
pub const SHADE: &str = concat!(
    include_str!("../wgsl/fresnel.wgsl"),
    include_str!("../wgsl/tone.wgsl"),
    include_str!("../wgsl/shade.wgsl")
);

/// Picture of a flat patch; entry points `cover` and `present`.
pub const PRESENT: &str = concat!(
    include_str!("../wgsl/cover.wgsl"),
    include_str!("../wgsl/tone.wgsl"),
    include_str!("../wgsl/present.wgsl")
);

/// Every pass in every variant, by name.
pub const ALL: [(&str, &str); 8] = [
    ("gather, 2-BMPP", GATHER.bmpp),
    ("gather, per-pixel profiles", GATHER.per_pixel),
    ("gather, capture", GATHER.capture),
    ("surface gather, 2-BMPP", SURFACE_GATHER_BMPP),
    ("surface gather, per-pixel profiles", SURFACE_GATHER_PER_PIXEL),
    ("irradiance", IRRADIANCE),
    ("shade", SHADE),
    ("present", PRESENT),
];
