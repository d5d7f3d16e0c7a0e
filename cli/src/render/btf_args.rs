//! Arguments that say how BTFs are drawn.

use std::path::PathBuf;
use std::str::FromStr;

use subsurf_decoder::NestedBtf;
use subsurf_runtime::{BtfFiltering, BtfOptions};
use subsurf_scene::Mesh;
use subsurf_viewer::{material_number, repeats};

use crate::program::failure::bad_request;

/// How BTFs lie on meshes and how they are looked up.
#[derive(clap::Args, Clone, Debug, Default)]
#[command(next_help_heading = "Bidirectional texture functions")]
pub(crate) struct BtfArgs {
    /// Copies of the material along u and v of the mesh's texture coordinates; so many that a copy is a fifth of the
    /// mesh's longest side if not given
    #[arg(long, value_name = "N|U,V")]
    pub(crate) repeat: Option<Copies>,
    /// Which material of a file that has several: its name, or its number from 0
    #[arg(long, value_name = "NAME|N")]
    pub(crate) material: Option<String>,
    /// Importance samples of the environment for every pixel: more of them, less grain; 0 leaves it out
    #[arg(long, value_name = "N")]
    pub(crate) samples: Option<u32>,
    /// Which texels a pixel shows; trilinear if not given
    #[arg(long, value_enum)]
    pub(crate) filter: Option<FilterArg>,
    /// The folder of images that the file was made from: drawn uncompressed beside it
    #[arg(long, value_name = "FOLDER")]
    pub(crate) images: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum FilterArg {
    /// The nearest one: the fastest
    Nearest,
    /// Four, linearly
    Bilinear,
    /// Four of each of the two nearest mipmap levels, where the file has several
    Trilinear,
}

/// Copies of a material along u and v.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Copies(pub(crate) [f32; 2]);

impl FromStr for Copies {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (u, v) = text.split_once(',').unwrap_or((text, text));
        match (u.trim().parse(), v.trim().parse()) {
            (Ok(u), Ok(v)) if [u, v].iter().all(|n: &f32| n.is_finite() && *n > 0.0 && *n <= 10_000.0) => {
                Ok(Self([u, v]))
            }
            _ => Err("expected a number of copies, or two for u and v, such as 4 or 6,2".to_owned()),
        }
    }
}

/// Most samples of the environment for a pixel.
const MAX_SAMPLES: u32 = 1_024;

impl BtfArgs {
    /// Refuses what cannot be drawn.
    pub(crate) fn check(&self) -> anyhow::Result<()> {
        match self.samples {
            Some(samples) if samples > MAX_SAMPLES => {
                Err(bad_request(format!("--samples is {samples}; at most {MAX_SAMPLES} are drawn")))
            }
            _ => Ok(()),
        }
    }

    /// Refuses options that say nothing to a material that is no BTF.
    pub(crate) fn expect_none(&self) -> anyhow::Result<()> {
        let given = [
            ("--repeat", self.repeat.is_some()),
            ("--material", self.material.is_some()),
            ("--samples", self.samples.is_some()),
            ("--filter", self.filter.is_some()),
            ("--images", self.images.is_some()),
        ];
        match given.iter().find(|(_, is_given)| *is_given) {
            Some((name, _)) => Err(bad_request(format!("{name} is for BTFs; this file is a translucent material"))),
            None => Ok(()),
        }
    }

    pub(crate) fn options(&self, usual: BtfOptions) -> BtfOptions {
        BtfOptions {
            filtering: match self.filter {
                None => usual.filtering,
                Some(FilterArg::Nearest) => BtfFiltering::Nearest,
                Some(FilterArg::Bilinear) => BtfFiltering::Bilinear,
                Some(FilterArg::Trilinear) => BtfFiltering::Trilinear,
            },
            samples: self.samples.unwrap_or(usual.samples),
        }
    }

    /// The number of the material that is asked for; the first one if none is.
    pub(crate) fn number(&self, btf: &NestedBtf<'_>) -> anyhow::Result<usize> {
        let Some(asked) = &self.material else {
            return Ok(0);
        };
        let names: Vec<String> = btf.materials().map(|material| material.name().to_owned()).collect();
        material_number(&names, asked).ok_or_else(|| {
            bad_request(format!("--material {asked}: the file has {}, and 0 to {}", names.join(", "), names.len() - 1))
        })
    }

    /// Copies of a material of `size` texels to the unit square of a mesh's texture coordinates.
    pub(crate) fn copies(&self, mesh: &Mesh, size: [u32; 2]) -> [f32; 2] {
        self.repeat.map_or_else(|| repeats(mesh, size), |Copies(copies)| copies)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_copies() {
        assert_eq!("4".parse(), Ok(Copies([4.0; 2])));
        assert_eq!("6, 2.5".parse(), Ok(Copies([6.0, 2.5])));
        assert!(["0", "-1", "a", "1,2,3", "inf"].iter().all(|text| text.parse::<Copies>().is_err()), "no copies");
    }
}
