//! Values that `render` and `view` take.

use std::path::Path;
use std::str::FromStr;

use glam::Vec3;
use subsurf_encoder::metrics::bssrdf::Light;
use subsurf_encoder::picture::Picture;
use subsurf_scene::Environment;
use subsurf_viewer::{Angles, MappingChoice, Scattering, Set};

use crate::program::failure::bad_request;
use crate::program::warnings::warn;

/// Technique by which light in a translucent material is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum TechniqueArg {
    /// Every point gathers light from all others within reach: the reference
    Gather,
    /// Every place that the light reaches is spread over what lies around it; for meshes
    Splat,
    /// Weighted irradiance maps and shared Gaussians: many times faster, and an approximation
    Separable,
    /// The same with one mean profile everywhere, as if the material were not heterogeneous; for comparison
    Homogeneous,
    /// Separable kernel of a homogeneous material, on the screen; for kernel files, on meshes
    Kernel,
    /// Scattering precomputed for the vertices of one mesh; for files of `subsurf transfer`, on that mesh
    Transfer,
    /// Light leaves where it enters, as if the material were opaque; for comparison
    Opaque,
}

/// Where a translucent material lies on a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum MappingArg {
    /// Texture coordinates if the mesh has any, repeated so that the material keeps its size; else box
    Auto,
    /// Texture coordinates
    Uv,
    /// Projected from the side that each normal faces most
    Box,
}

impl TechniqueArg {
    /// Technique for a translucent material that is no kernel.
    pub(crate) fn scattering(self) -> anyhow::Result<Scattering> {
        Ok(match self {
            Self::Gather => Scattering::Gather,
            Self::Splat => Scattering::Splat,
            Self::Separable => Scattering::Separable,
            Self::Homogeneous => Scattering::Homogeneous,
            Self::Opaque => Scattering::Opaque,
            Self::Transfer => {
                return Err(bad_request(
                    "--technique transfer is for files of subsurf transfer, which are of one mesh",
                ));
            }
            Self::Kernel => {
                return Err(bad_request("--technique kernel is for kernel files; this one has pixels: take separable"));
            }
        })
    }
}

impl From<MappingArg> for MappingChoice {
    fn from(arg: MappingArg) -> Self {
        match arg {
            MappingArg::Auto => Self::Auto,
            MappingArg::Uv => Self::Uv,
            MappingArg::Box => Self::Box,
        }
    }
}

/// What stands around a mesh, and from where both are lit and seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum SceneArg {
    /// The mesh alone, lit over the right shoulder in a dim studio
    Studio,
    /// The mesh on a plate of the same material, lit from behind on a dark stage
    Hero,
}

impl From<SceneArg> for Set {
    fn from(arg: SceneArg) -> Self {
        match arg {
            SceneArg::Studio => Self::Studio,
            SceneArg::Hero => Self::Hero,
        }
    }
}

/// Light on a patch or on a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum LightArg {
    Pattern(Light),
    Direction(Vec3),
}

impl FromStr for LightArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if let Some(light) = Light::ALL.into_iter().find(|light| light.name() == text) {
            return Ok(Self::Pattern(light));
        }
        let numbers: Option<Vec<f32>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
        match numbers.as_deref() {
            Some(&[x, y, z]) if Vec3::new(x, y, z).try_normalize().is_some() => {
                Ok(Self::Direction(Vec3::new(x, y, z).normalize()))
            }
            _ => Err("expected uniform, disc, line or a direction such as 1,2,1".to_owned()),
        }
    }
}

/// Degrees around the up axis and above the horizon, separated by a comma.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AnglesArg(pub(crate) Angles);

impl FromStr for AnglesArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Option<Vec<f32>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
        match numbers.as_deref() {
            Some(&[around, up]) if up.abs() < 90.0 && around.is_finite() => Ok(Self(Angles { around, up })),
            _ => Err("expected two angles in degrees, the second between -90 and 90, such as 30,15".to_owned()),
        }
    }
}

/// An equirectangular picture; those of integers are taken as sRGB. Radiances out of range are clamped, with a warning.
pub(crate) fn read_environment(path: &Path) -> anyhow::Result<Environment> {
    let mut picture = Picture::open(path)?.into_linear();
    let brightest = picture.largest().min(Environment::BRIGHTEST);
    let clamped = picture.clamp(brightest);
    if clamped > 0 {
        let (path, pixels) = (path.display(), picture.pixels().len());
        warn(&format!(
            "{path}: {clamped} of {pixels} pixels are negative, infinite or NaN; they are clamped to 0 to {brightest}"
        ));
    }
    Environment::equirectangular(picture.size(), picture.pixels())
        .map_err(|error| bad_request(format!("{}: {error}", path.display())))
}
