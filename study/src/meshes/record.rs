//! What was measured on a mesh.

use serde::{Deserialize, Serialize};
use subsurf_encoder::metrics::transfer::ImageError;
use subsurf_encoder::transfer::Size;

/// What the numbers of a record depend on: what was measured with the same is not measured again.
#[derive(Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Key {
    pub(super) material: String,
    pub(super) lights: usize,
    pub(super) geometry_crc: [u32; 2],
    /// Sizes of our files, the default among them.
    pub(super) sizes: Vec<Kind>,
}

/// What was measured on a mesh.
#[derive(Serialize, Deserialize)]
pub(super) struct Record {
    pub(super) key: Key,
    pub(super) vertices: usize,
    /// By the number of lights, ascending.
    pub(super) interpolations: Vec<Interpolation>,
    /// Of a byte for each light.
    pub(super) lloyd_snr_db: f64,
    /// Time in s to compress q to the default size.
    pub(super) compress_seconds: f64,
    pub(super) schemes: Vec<Measured>,
}

/// Errors between lights of q that is not compressed, against exact sums.
#[derive(Serialize, Deserialize)]
pub(super) struct Interpolation {
    pub(super) lights: usize,
    /// Time in s to precompute them, and two dozen more to compare with.
    pub(super) seconds: f64,
    pub(super) four_nearest: ImageError,
    pub(super) radial: ImageError,
}

/// A way to store q.
#[derive(Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Kind {
    /// A byte for each light.
    Lloyd,
    /// Spherical harmonics.
    Harmonics { order: usize },
    /// Reference points, and spherical harmonics of the differences.
    ReferencePoints { points: usize, order: usize },
    /// Our files.
    Clusters { clusters: usize, components: usize, bits: usize },
}

/// What a way to store q takes, and how far off it is.
#[derive(Serialize, Deserialize)]
pub(super) struct Measured {
    pub(super) kind: Kind,
    /// Bytes per vertex, all counted.
    pub(super) bytes: f64,
    /// Those of reference points without their numbers at each vertex, as the paper counts.
    pub(super) bytes_without_indices: Option<f64>,
    /// Against q that is not compressed, both with radial basis functions between the lights.
    pub(super) compression: ImageError,
    /// The same with the four nearest lights, which hide a part of it: they are a mean of four errors.
    pub(super) compression_by_four: ImageError,
    /// Against exact sums, each with its own interpolation: the paper's four nearest lights, or our radial basis functions.
    pub(super) total: ImageError,
}

impl Measured {
    /// Errors in the order of the page.
    pub(super) fn errors(&self) -> [ImageError; 3] {
        [self.compression, self.compression_by_four, self.total]
    }
}

impl Kind {
    pub(super) fn of_size(size: Size) -> Self {
        let Size { clusters, components, bits } = size;
        Self::Clusters { clusters, components, bits }
    }

    /// What it is, in a line.
    pub(super) fn title(self) -> String {
        match self {
            Self::Lloyd => "a byte for each light (Lloyd)".to_owned(),
            Self::Harmonics { order } => format!("spherical harmonics, n = {order}"),
            Self::ReferencePoints { points, order } => {
                format!("{points} reference points, {} functions", order * order)
            }
            Self::Clusters { clusters: 1, components, bits } => {
                format!("one PCA, {components} components, {bits} bits")
            }
            Self::Clusters { clusters, components, bits } => {
                format!("{clusters} clusters, {components} components, {bits} bits")
            }
        }
    }

    /// Number of reference points, if it has some.
    pub(super) fn points(self) -> Option<usize> {
        if let Self::ReferencePoints { points, .. } = self { Some(points) } else { None }
    }

    /// Whether it is the paper's.
    pub(super) fn is_theirs(self) -> bool {
        !matches!(self, Self::Clusters { .. })
    }
}

impl Record {
    /// The paper's scheme, with 9 functions and as many points as the paper has for a mesh of that many vertices: the last of its kind.
    pub(super) fn theirs(&self) -> &Measured {
        let is_it = |of: &&Measured| matches!(of.kind, Kind::ReferencePoints { order: 3, .. });
        self.schemes.iter().rfind(is_it).expect("every record has reference points")
    }

    /// Our file of the default size.
    pub(super) fn ours(&self) -> &Measured {
        let kind = Kind::of_size(Size::of_vertices(self.vertices));
        self.schemes.iter().find(|of| of.kind == kind).expect("every record has the default size")
    }

    /// Our smallest file that meets a condition.
    pub(super) fn smallest(&self, meets: impl Fn(&Measured) -> bool) -> Option<&Measured> {
        let ours = self.schemes.iter().filter(|of| !of.kind.is_theirs() && meets(of));
        ours.min_by(|a, b| a.bytes.total_cmp(&b.bytes))
    }

    /// Our file with the least total error of at most so many bytes per vertex.
    pub(super) fn closest(&self, bytes: f64) -> Option<&Measured> {
        let ours = self.schemes.iter().filter(|of| !of.kind.is_theirs() && of.bytes <= bytes);
        ours.min_by(|a, b| a.total.rms.total_cmp(&b.total.rms))
    }
}
