//! From what is known of materials to nested codebooks.

use nalgebra::DMatrix;
use subsurf_decoder::btf::{BtfHeader, BtfModel, ColourEncoding, Grid};

use super::chroma::{ChromaSizes, Hues};
use super::database::Database;
use super::luma::{STEPS, Space};
use super::sizes::{Sizes, check_stages};
use crate::btf::TruncatedSvd;
use crate::btf::materials::materials;
use crate::btf::mipmaps::Mipmaps;
use crate::btf::resample::{Measured, Resampler};
use crate::capture::Images;
use crate::error::Result;
use crate::math::parallel;
use crate::progress::Progress;

/// What a file of nested codebooks is to be.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Nodes of directions.
    pub grid: Grid,
    /// Most entries of the codebooks of chroma.
    pub chroma: ChromaSizes,
    /// Names of the materials.
    pub names: Vec<String>,
    /// Whether to make mipmaps.
    pub has_mipmaps: bool,
    /// Seed of the first codewords.
    pub seed: u64,
}

/// Materials that were decomposed together, on the nodes of a grid: what codebooks of all sizes are made from.
pub struct Prepared<'a> {
    svd: &'a TruncatedSvd,
    options: Options,
    measured: Measured,
    /// Components of luma, and of both channels of chroma, at nodes.
    tables: [DMatrix<f32>; 3],
    /// Coefficients of luma and chroma of all texels of all levels, and their ρ.
    texels: [DMatrix<f32>; 2],
    ratios: Vec<[f32; 2]>,
}

impl<'a> Prepared<'a> {
    /// Fits the components to the nodes.
    #[must_use]
    pub fn new(materials: &[Images], svd: &'a TruncatedSvd, options: Options) -> Self {
        let (lights, views) = (materials[0].lights(), materials[0].views());
        let resampler = Resampler::new(&options.grid, lights, views);
        let measured = Measured::new(&options.grid, lights, views);
        let mipmaps = Mipmaps::new(&svd.sizes, options.has_mipmaps);
        let texels = [&svd.luma.texels, &svd.chroma.texels].map(|texels| mipmaps.of(texels));
        let ratios = mipmaps.of_ratios(&svd.ratios, &svd.luma.texels);
        let tables =
            [&svd.luma.basis, &svd.chroma_basis(0), &svd.chroma_basis(1)].map(|basis| fitted(&resampler, svd, basis));
        Self { svd, options, measured, tables, texels, ratios }
    }

    /// Builds codebooks of at most these sizes, a stage each.
    ///
    /// # Errors
    /// [`Error::Request`](crate::Error::Request) for no stage or more than four, or too many materials.
    pub fn encode(&self, stages: &[Sizes], progress: &dyn Progress) -> Result<Database> {
        let (svd, options) = (self.svd, &self.options);
        check_stages(stages.len())?;
        let (count, materials) = materials(&svd.sizes, &options.names, options.has_mipmaps)?;
        progress.begin("codebooks", STEPS * stages.len() as u64);
        let [luma, chroma] = &self.texels;
        let [of_luma, of_a, of_b] = &self.tables;
        let space = Space {
            grid: options.grid,
            measured: &self.measured,
            weights: &svd.weights,
            basis: &svd.luma.basis,
            tables: of_luma,
        };
        let mut left = luma.clone();
        let mut built = Vec::new();
        for (number, sizes) in stages.iter().enumerate() {
            let stage = space.build(&left, *sizes, number > 0, options.seed, progress);
            left = stage.remainder(&left);
            built.push(stage);
        }
        let energies: Vec<f32> = luma.column_iter().map(|texel| texel.norm_squared()).collect();
        let squares: Vec<f32> = svd.weights.iter().map(|weight| weight * weight).collect();
        let node_weights = mean_over_views(&self.measured.spread(&squares), options.grid.light_nodes());
        let hues = Hues {
            grid: options.grid,
            ratios: &self.ratios,
            texels: chroma,
            tables: [of_a, of_b],
            node_weights: &node_weights,
            energies: &energies,
            is_relative: matches!(svd.tone, ColourEncoding::Display { .. }),
        };
        let chroma = hues.build(&mut built[0], options.chroma);
        Ok(Database {
            header: BtfHeader {
                model: BtfModel::Nested,
                encoding: svd.tone,
                materials: count,
                grid: options.grid,
                texel_mm: None,
            },
            materials,
            stages: built.into_iter().map(|stage| stage.chain).collect(),
            chroma,
        })
    }
}

/// Tables of components at nodes, without the weights of pairs.
fn fitted(resampler: &Resampler, svd: &TruncatedSvd, basis: &DMatrix<f32>) -> DMatrix<f32> {
    let columns = parallel::map(basis.ncols(), |component| {
        let plain: Vec<f32> =
            basis.column(component).iter().zip(&svd.weights).map(|(value, weight)| value / weight).collect();
        resampler.fit(&plain)
    });
    DMatrix::from_vec(resampler.nodes(), columns.len(), columns.concat())
}

fn mean_over_views(values: &[f32], light: usize) -> Vec<f32> {
    let count = (values.len() / light) as f32;
    (0..light).map(|k| values[k..].iter().step_by(light).sum::<f32>() / count).collect()
}
