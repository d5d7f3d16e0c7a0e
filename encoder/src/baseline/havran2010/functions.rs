//! Apparent BRDFs at the nodes of a grid, made when they are needed: those of all texels take a hundred bytes for every
//! byte of a file.

use nalgebra::DMatrix;
use rayon::prelude::*;
use subsurf_decoder::btf::{ColourEncoding, Grid};

use super::rows::Slices;
use crate::btf::Resampler;
use crate::capture::Images;
use crate::math::parallel;

/// Texels that are fitted at a time by one thread.
const CHUNK: usize = 32;

/// One apparent BRDF, all channels `[φ_v][θ_v][α][β]`.
#[derive(Clone, Debug)]
pub(super) struct Function {
    /// Luma, not negative.
    pub(super) luma: Slices,
    /// Chroma from 0 to 1, see [`centre`].
    pub(super) chroma: [Slices; 2],
}

/// What is added to chroma: images store Cr and Cb around ½, and u' and v' as they are.
pub(super) fn centre(tone: ColourEncoding) -> f32 {
    match tone {
        ColourEncoding::Display { .. } => 0.5,
        ColourEncoding::LogLuv { .. } => 0.0,
    }
}

/// Where apparent BRDFs come from.
pub(super) struct Functions<'a> {
    materials: &'a [Images],
    tone: ColourEncoding,
    grid: Grid,
    resampler: Resampler,
}

impl<'a> Functions<'a> {
    pub(super) fn new(materials: &'a [Images], tone: ColourEncoding, grid: Grid) -> Self {
        let resampler = Resampler::new(&grid, materials[0].lights(), materials[0].views());
        Self { materials, tone, grid, resampler }
    }

    /// The mean apparent BRDFs of groups of texels, which are numbered through all materials.
    pub(super) fn means(&self, groups: &[&[u32]]) -> Vec<Function> {
        let measured = self.measured(groups);
        let (pairs, count) = (self.materials[0].pairs(), groups.len());
        let starts: Vec<usize> = (0..count).step_by(CHUNK).collect();
        let chunk = |start: usize| {
            let group = |column: usize| start + column / 3;
            let columns = 3 * CHUNK.min(count - start);
            let values =
                DMatrix::from_fn(pairs, columns, |pair, column| measured[pair * count + group(column)][column % 3]);
            let tables = self.resampler.fit_all(&values);
            let function = |k: usize| self.function([0, 1, 2].map(|c| tables.column(3 * k + c).as_slice().to_vec()));
            (0..columns / 3).map(function).collect::<Vec<_>>()
        };
        parallel::map(starts.len(), |k| chunk(starts[k])).into_iter().flatten().collect()
    }

    /// Mean channels of groups of texels, `[pair][group]`.
    fn measured(&self, groups: &[&[u32]]) -> Vec<[f32; 3]> {
        let texels: usize = self.materials.iter().map(Images::texels).sum();
        let mut is_wanted = vec![false; texels];
        groups.iter().copied().flatten().for_each(|texel| is_wanted[*texel as usize] = true);
        let mut measured = vec![[0.0; 3]; self.materials[0].pairs() * groups.len()];
        measured.par_chunks_mut(groups.len()).enumerate().for_each_init(
            || vec![[0.0; 3]; texels],
            |channels, (pair, means)| {
                let mut start = 0;
                for images in self.materials {
                    images.each(pair, |texel, rgb| {
                        if is_wanted[start + texel] {
                            channels[start + texel] = self.tone.encode(rgb);
                        }
                    });
                    start += images.texels();
                }
                for (mean, group) in means.iter_mut().zip(groups) {
                    let sum = |c: usize| group.iter().map(|texel| channels[*texel as usize][c]).sum::<f32>();
                    *mean = [0, 1, 2].map(|c| sum(c) / group.len() as f32);
                }
            },
        );
        measured
    }

    fn function(&self, mut tables: [Vec<f32>; 3]) -> Function {
        if self.grid.sin_beta_max >= 1.0 {
            tables.iter_mut().for_each(|table| self.join_poles(table));
        }
        let centre = centre(self.tone);
        let [luma, a, b] = &mut tables;
        luma.iter_mut().for_each(|value| *value = value.max(0.0));
        a.iter_mut().chain(b).for_each(|value| *value = (*value + centre).clamp(0.0, 1.0));
        let [luma, a, b] = tables.map(|table| {
            let mut slices = Slices::new([self.grid.n_alpha, self.grid.n_beta].map(usize::from));
            slices.push(&table);
            slices
        });
        Function { luma, chroma: [a, b] }
    }

    /// Gives all slices the same ends: β = ±90° is one direction whatever α is.
    fn join_poles(&self, table: &mut [f32]) {
        let n_beta = usize::from(self.grid.n_beta);
        for lights in table.chunks_exact_mut(self.grid.light_nodes()) {
            for pole in [0, n_beta - 1] {
                let mean = lights.iter().skip(pole).step_by(n_beta).sum::<f32>() / f32::from(self.grid.n_alpha);
                lights.iter_mut().skip(pole).step_by(n_beta).for_each(|value| *value = mean);
            }
        }
    }
}
