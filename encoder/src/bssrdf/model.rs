//! K-BMPP models while they are fitted.

use std::collections::BTreeMap;

use subsurf_decoder::bssrdf::layout::MAX_CODED_RATIO;
use subsurf_decoder::bssrdf::{Coding, Mixture};

use crate::bssrdf::clusters::Clusters;
use crate::bssrdf::field::Field;
use crate::bssrdf::normal::{BLOCK_ROWS, BLOCKS_AT_ONCE, Normal};
use crate::math::lanes::{self, Lanes, ZERO};
use crate::math::parallel;

/// A K-BMPP model relative to the mean profile.
pub(crate) struct Model {
    pub(crate) nodes: usize,
    /// Base materials per pixel, K.
    pub(crate) per_pixel: usize,
    /// Ratios are whole multiples of 1/levels, if they are to be stored so.
    pub(crate) levels: Option<f32>,
    /// The only pairs there may be, sorted.
    pub(crate) palette: Option<Vec<[usize; 2]>>,
    /// Log-scale base profiles `[base][node]`, relative to the mean profile.
    pub(crate) bases: Vec<Lanes>,
    pub(crate) mixtures: Vec<Mixture>,
}

impl Model {
    /// Model of one base material per pixel: every pixel is its cluster.
    pub(crate) fn of_clusters(clusters: Clusters, nodes: usize) -> Self {
        let mixture = |&cluster: &usize| {
            let cluster = u16::try_from(cluster).expect("at most 65,536 clusters");
            Mixture { bases: [cluster; 5], ratios: [1.0, 0.0, 0.0, 0.0, 0.0] }
        };
        let mixtures = clusters.cluster_of.iter().map(mixture).collect();
        Self { nodes, per_pixel: 1, levels: None, palette: None, bases: clusters.centres, mixtures }
    }

    /// Leaves out base materials that no pixel has: a capture may have fewer distinct profiles than were asked for.
    pub(crate) fn drop_unused(&mut self) {
        let mut used = vec![false; self.count()];
        for (base, _) in (0..self.mixtures.len()).flat_map(|pixel| self.parts(pixel)) {
            used[base] = true;
        }
        let mut kept = 0;
        let number = |&used: &bool| {
            let number = u16::try_from(kept).expect("at most 65,536 base materials");
            kept += usize::from(used);
            number
        };
        let numbers: Vec<u16> = used.iter().map(number).collect();
        for base in self.mixtures.iter_mut().flat_map(|mixture| &mut mixture.bases[..self.per_pixel]) {
            *base = numbers[usize::from(*base)];
        }
        let bases = self.bases.chunks(self.nodes).zip(&used).filter(|(_, used)| **used);
        self.bases = bases.flat_map(|(base, _)| base).copied().collect();
    }

    /// Number of base materials, M.
    pub(crate) fn count(&self) -> usize {
        self.bases.len() / self.nodes
    }

    /// Restricts what the search may find to what a coding can store; a palette to the `most` used pairs.
    pub(crate) fn restrict(&mut self, coding: Coding, most: usize) {
        self.levels = match coding {
            Coding::Exact => None,
            Coding::SmallRatios => Some(f32::from(u8::MAX)),
            Coding::Palette => Some(f32::from(MAX_CODED_RATIO)),
        };
        if coding == Coding::Palette {
            // The pairs that most pixels have; of equals the first.
            let mut uses: BTreeMap<[usize; 2], usize> = BTreeMap::new();
            for mixture in &self.mixtures {
                let [a, b] = [mixture.bases[0], mixture.bases[1]].map(usize::from);
                *uses.entry([a.min(b), a.max(b)]).or_default() += 1;
            }
            let mut pairs: Vec<([usize; 2], usize)> = uses.into_iter().collect();
            pairs.sort_by_key(|(_, uses)| std::cmp::Reverse(*uses));
            let mut pairs: Vec<[usize; 2]> = pairs.into_iter().map(|(pair, _)| pair).collect();
            pairs.truncate(most);
            pairs.sort_unstable();
            self.palette = Some(pairs);
        }
    }

    /// Log-scale profile of a base material `[node]`, relative to the mean profile.
    pub(crate) fn base(&self, base: usize) -> &[Lanes] {
        &self.bases[base * self.nodes..][..self.nodes]
    }

    /// b_k and t_k of one pixel.
    pub(crate) fn parts(&self, pixel: usize) -> impl Iterator<Item = (usize, f32)> {
        let Mixture { bases, ratios } = self.mixtures[pixel];
        bases.into_iter().zip(ratios).take(self.per_pixel).map(|(base, t)| (base.into(), t))
    }

    /// P̂_x = Σ t_k P̂_{b_k} of one pixel (eq. 4).
    pub(crate) fn profile(&self, pixel: usize) -> Vec<Lanes> {
        let mut profile = vec![ZERO; self.nodes];
        for (base, t) in self.parts(pixel) {
            for (sum, p) in profile.iter_mut().zip(self.base(base)) {
                lanes::add_scaled(sum, t, p);
            }
        }
        profile
    }

    /// Log-scale profiles of all pixels, relative to the mean profile.
    pub(crate) fn field(&self, normal: &Normal) -> Field {
        let mut field = Field::new(normal.geometry);
        self.write_to(&mut field);
        field
    }

    /// Replaces all pixels' profiles, border included.
    pub(crate) fn write_to(&self, field: &mut Field) {
        let profiles: Vec<Vec<Lanes>> = parallel::map(self.mixtures.len(), |pixel| self.profile(pixel));
        for (pixel, profile) in profiles.iter().enumerate() {
            field.set(pixel, profile);
        }
        field.fill_border();
    }

    /// Uᵀ v with U the ratios and v of each pixel computed on the way: `[base][node]`. Sums are made by blocks of rows and
    /// then in order, so that they do not depend on the number of threads.
    pub(crate) fn gather(&self, normal: &Normal, v: impl Fn(usize, &mut [Lanes]) + Sync) -> Vec<Lanes> {
        let nodes = self.nodes;
        let [width, height] = normal.geometry.size;
        let block = |first: usize| {
            let mut sums = vec![ZERO; self.bases.len()];
            let mut image = vec![ZERO; nodes];
            for pixel in first * width..(first + BLOCK_ROWS).min(height) * width {
                v(pixel, &mut image);
                for (base, t) in self.parts(pixel) {
                    for (sum, image) in sums[base * nodes..].iter_mut().zip(&image) {
                        lanes::add_scaled(sum, t, image);
                    }
                }
            }
            sums
        };
        let firsts: Vec<usize> = (0..height).step_by(BLOCK_ROWS).collect();
        let mut total = vec![ZERO; self.bases.len()];
        for firsts in firsts.chunks(BLOCKS_AT_ONCE) {
            let blocks: Vec<Vec<Lanes>> = parallel::map(firsts.len(), |k| block(firsts[k]));
            for sums in &blocks {
                for (total, sum) in total.iter_mut().zip(sums) {
                    lanes::add(total, sum);
                }
            }
        }
        total
    }
}
