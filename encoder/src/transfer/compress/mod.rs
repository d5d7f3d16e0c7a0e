//! q in few bytes per vertex: clustered principal components, whose coefficients are quantised.

mod cpca;
mod quantise;

use nalgebra::DMatrix;
use subsurf_decoder::transfer::layout::{MAX_BITS, MAX_CLUSTERS, MAX_COMPONENTS};

use self::cpca::Projected;
pub(super) use self::quantise::Quantised;
use super::precompute::Precomputed;
use crate::error::{Error, Result};
use crate::progress::Progress;

/// Size of a compressed q.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// Clusters of vertices, 1 to 256.
    pub clusters: usize,
    /// Principal components of each, 1 to 16.
    pub components: usize,
    /// Bits of a vertex's coefficients together, from one for each component to 120.
    pub bits: usize,
}

impl Size {
    /// What suits a mesh of that many vertices: 8 components of 40 bits, and a cluster for some 400 vertices, since below that clusters
    /// weigh more than what they save.
    #[must_use]
    pub fn of_vertices(vertices: usize) -> Self {
        Self { clusters: (vertices / 400).clamp(16, MAX_CLUSTERS.into()), components: 8, bits: 40 }
    }

    /// Axes that clusters share: with the third root of the number of all components, which on meshes of 8,000 to 150,000 vertices under 200
    /// lights brought the least error for the bytes; no more than cost as much as numbers of each cluster for every light and channel, and
    /// one more than the components of a cluster.
    #[must_use]
    pub fn axes(&self, channels: usize, lights: usize) -> usize {
        let (values, columns) = (channels * lights, self.clusters * (self.components + 2));
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "at most 216 of a size that files have"
        )]
        let enough = (AXES * libm::cbrt((self.clusters * self.components) as f64)) as usize;
        enough.min(values * columns / (values + columns)).max(self.components + 1).min(values)
    }

    /// Refuses sizes that files do not have.
    ///
    /// # Errors
    /// [`Error::Request`] for numbers out of range.
    pub fn check(&self) -> Result<()> {
        let Self { clusters, components, bits } = *self;
        let most = (components * usize::from(MAX_BITS)).min(120);
        if !(1..=usize::from(MAX_CLUSTERS)).contains(&clusters)
            || !(1..=MAX_COMPONENTS).contains(&components)
            || !(components..=most).contains(&bits)
        {
            return Err(Error::Request(format!(
                "{clusters} clusters, {components} components, {bits} bits; expected 1 to {MAX_CLUSTERS}, 1 to {MAX_COMPONENTS}, \
                 and 1 to {MAX_BITS} bits for each component, 120 together"
            )));
        }
        Ok(())
    }
}

/// Axes by the third root of the components of all clusters: 171 for 256 clusters of 8.
const AXES: f64 = 13.5;
/// Largest value of an axis and of a component.
const LARGEST: f32 = 127.0;
/// Least scale of a channel, for one in which no light leaves: the file's least.
const LEAST_SCALE: f32 = 1e-12;

/// q divided by the largest value of its channel, and these values.
fn normalised(of: &Precomputed) -> (DMatrix<f32>, Vec<f32>) {
    let lights = of.light_count();
    let scale = |c: usize| of.q.rows(c * lights, lights).amax().max(LEAST_SCALE);
    let scales: Vec<f32> = (0..of.channels).map(scale).collect();
    let mut q = of.q.clone();
    for (c, scale) in scales.iter().enumerate() {
        q.rows_mut(c * lights, lights).scale_mut(1.0 / scale);
    }
    (q, scales)
}

/// Clusters and codes of q.
pub(super) fn compress(of: &Precomputed, size: &Size, progress: &dyn Progress) -> Quantised {
    let (q, scales) = normalised(of);
    let projected = Projected::new(&q, size.axes(of.channels, of.light_count()));
    drop(q);
    let clusters = projected.cluster(size, progress);
    Quantised::new(projected, scales, &clusters, size.bits)
}

/// Values in a byte each, the largest as 127 or −127.
fn signed(values: &[f32]) -> Vec<i8> {
    let largest = values.iter().fold(0.0_f32, |largest, value| largest.max(value.abs()));
    let factor = if largest > 0.0 { LARGEST / largest } else { 0.0 };
    #[allow(clippy::cast_possible_truncation, reason = "within −127 to 127")]
    let byte = |value: &f32| (value * factor).round() as i8;
    values.iter().map(byte).collect()
}
