//! From what is known of materials to a file of factors.

use nalgebra::DMatrix;
use subsurf_decoder::btf::{BtfHeader, BtfModel, Grid};

use super::angles::{Fineness, Tucker};
use super::sizes::{Sizes, positive};
use super::space::{Components, Space};
use super::texels::{quantise, steps};
use super::write::Contents;
use crate::btf::TruncatedSvd;
use crate::btf::materials::materials;
use crate::btf::mipmaps::Mipmaps;
use crate::btf::resample::{Measured, Resampler};
use crate::capture::Images;
use crate::error::Result;
use crate::progress::Progress;

/// What a file of factors is to be, whatever its size.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Nodes of directions.
    pub grid: Grid,
    /// How much errors of chroma count beside those of luma; 1.5 as a rule.
    pub chroma_weight: f32,
    /// Names of the materials.
    pub names: Vec<String>,
    /// Whether to make mipmaps.
    pub has_mipmaps: bool,
    /// Seed of the first codewords.
    pub seed: u64,
}

/// Materials that were decomposed together, on the nodes of a grid: what factors of all sizes are made from.
pub struct Prepared<'a> {
    svd: &'a TruncatedSvd,
    options: Options,
    measured: Measured,
    /// The decomposition's functions of luma, and of chroma in each channel, `[pair × component]`.
    bases: [Vec<DMatrix<f32>>; 2],
    /// The decomposition's coefficients of all texels of all levels, of luma and of chroma.
    texels: [DMatrix<f32>; 2],
    ratios: Vec<[f32; 2]>,
    /// All components of luma and of chroma as the grid shows them.
    components: [Components; 2],
    /// Weight of every node of the grid.
    node_weights: Vec<f32>,
}

impl<'a> Prepared<'a> {
    /// Materials whose components are fitted to the nodes of the grid.
    ///
    /// # Errors
    /// [`Error::Request`](crate::Error::Request) for a weight of chroma that is not above 0.
    pub fn new(materials: &[Images], svd: &'a TruncatedSvd, options: Options) -> Result<Self> {
        positive("weight of chroma", options.chroma_weight)?;
        let (lights, views) = (materials[0].lights(), materials[0].views());
        let resampler = Resampler::new(&options.grid, lights, views);
        let measured = Measured::new(&options.grid, lights, views);
        let mipmaps = Mipmaps::new(&svd.sizes, options.has_mipmaps);
        let texels = [&svd.luma.texels, &svd.chroma.texels].map(|texels| mipmaps.of(texels));
        let ratios = mipmaps.of_ratios(&svd.ratios, &svd.luma.texels);
        let bases = [vec![svd.luma.basis.clone()], vec![svd.chroma_basis(0), svd.chroma_basis(1)]];
        let space = Space { measured: &measured, weights: &svd.weights };
        let components = [0, 1].map(|k| space.components(&resampler, &bases[k], &texels[k]));
        let squares: Vec<f32> = svd.weights.iter().map(|weight| weight * weight).collect();
        let node_weights = measured.spread(&squares);
        Ok(Self { svd, options, measured, bases, texels, ratios, components, node_weights })
    }

    /// Texels of all levels of all materials.
    #[must_use]
    pub fn texels(&self) -> usize {
        self.ratios.len()
    }

    /// Nodes of views and of lights.
    pub(super) fn nodes(&self) -> [usize; 2] {
        [self.options.grid.view_nodes(), self.options.grid.light_nodes()]
    }

    /// A file of some sizes.
    ///
    /// # Errors
    /// [`Error::Request`](crate::Error::Request) for sizes out of range, or too many materials.
    pub fn encode(&self, sizes: &Sizes, progress: &dyn Progress) -> Result<Vec<u8>> {
        sizes.check()?;
        let (svd, options) = (self.svd, &self.options);
        let (count, materials) = materials(&svd.sizes, &options.names, options.has_mipmaps)?;
        progress.begin("factors", steps(sizes.stages.len()));
        let [of_luma, of_chroma] =
            [(0, sizes.luma), (1, sizes.chroma)].map(|(k, most)| most.min(self.components[k].count()));
        let grid = &options.grid;
        let tucker = self.tucker([of_luma, of_chroma], sizes);

        // Texels for the tables as they will be decoded.
        let decoded = tucker.tables(grid.light_nodes());
        let part = |first: usize, count: usize| decoded.columns(first, count).into_owned();
        let tables = [vec![part(0, of_luma)], vec![part(of_luma, of_chroma), part(of_luma + of_chroma, of_chroma)]];
        let space = Space { measured: &self.measured, weights: &svd.weights };
        let [luma, chroma] = [0, 1].map(|k| space.coefficients(&tables[k], &self.bases[k], &self.texels[k]));
        // An error of ρ is one of all of a texel's luma.
        let mean_square = luma.norm_squared() / luma.ncols() as f32;
        let ratio_step = sizes.word_step / (options.chroma_weight * mean_square.sqrt().max(1e-6));
        let chroma_step = sizes.word_step / options.chroma_weight;
        let columns = DMatrix::from_fn(2 + of_chroma + of_luma, self.texels(), |row, texel| match row {
            0 | 1 => self.ratios[texel][row] / ratio_step,
            _ if row < 2 + of_chroma => chroma[(row - 2, texel)] / chroma_step,
            _ => luma[(row - 2 - of_chroma, texel)] / sizes.word_step,
        });
        let texels = quantise(&columns, &sizes.stages, options.seed, progress);
        let coefficient_step = |column: usize| if column < of_luma { sizes.word_step } else { chroma_step };
        let factors: Vec<f32> =
            tucker.steps.iter().enumerate().map(|(column, step)| step * coefficient_step(column)).collect();
        Ok(Contents {
            header: BtfHeader {
                model: BtfModel::Factored,
                encoding: svd.tone,
                materials: count,
                grid: *grid,
                texel_mm: None,
            },
            materials: &materials,
            components: [of_luma, of_chroma],
            tucker: &tucker,
            texels: &texels,
            ratio_steps: [ratio_step; 2],
            factors: &factors,
        }
        .to_bytes())
    }

    /// The tables of so many components of luma and of chroma, both channels of it.
    fn tucker(&self, [of_luma, of_chroma]: [usize; 2], sizes: &Sizes) -> Tucker {
        let [luma, chroma] = &self.components;
        let weight = self.options.chroma_weight * self.options.chroma_weight;
        let of_both: Vec<f32> = chroma.energies.iter().take(of_chroma).map(|energy| weight * energy).collect();
        let energies: Vec<f32> = luma.energies[..of_luma].iter().chain(&of_both).chain(&of_both).copied().collect();
        let counts = [of_luma, of_chroma, of_chroma];
        let columns = luma
            .tables
            .iter()
            .chain(&chroma.tables)
            .zip(counts)
            .flat_map(|(table, count)| table.as_slice()[..count * table.nrows()].iter().copied());
        let tables = DMatrix::from_iterator(self.node_weights.len(), energies.len(), columns);
        let grid = &self.options.grid;
        let fineness = Fineness {
            axes: [sizes.axes[0].min(grid.view_nodes()), sizes.axes[1].min(grid.light_nodes())],
            core: sizes.core,
        };
        Tucker::new(&tables, &energies, &self.node_weights, grid.light_nodes(), fineness)
    }
}
