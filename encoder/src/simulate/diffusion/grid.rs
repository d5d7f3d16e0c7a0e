//! The voxels around one source pixel: a box that is fine where light enters and coarse far away.

/// Edges of the cells along one axis in mm, and which pixel each cell belongs to.
#[derive(Clone, Debug)]
pub(super) struct Axis {
    /// Edges, one more than cells; 0 is the middle of the source pixel, or the surface.
    pub(super) edges: Vec<f64>,
    /// Pixel offset of each cell from the source pixel; empty for the depth axis.
    pub(super) pixel: Vec<i32>,
}

impl Axis {
    pub(super) fn cells(&self) -> usize {
        self.edges.len() - 1
    }

    pub(super) fn width(&self, cell: usize) -> f64 {
        self.edges[cell + 1] - self.edges[cell]
    }
}

/// Voxels for one source pixel; the same for all pixels and channels of a capture.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    /// Cells along x, and along y alike.
    pub(super) lateral: Axis,
    /// Cells along the depth.
    pub(super) depth: Axis,
}

/// A cell is at most NEAR · mean free path + FAR · distance from the source pixel wide ..
const NEAR: f64 = 0.25;
const FAR: f64 = 0.3;
/// .. and at most this many decay lengths 1/σ_tr: a cell of width h decays too slowly by (σ_tr h)²/24.
const DECAY: f64 = 0.7;
/// At most this many cells across a pixel: finer structure is averaged over the pixel anyway.
const MAX_PER_PIXEL: f64 = 12.0;
/// First cell below the surface, in mean free paths, and growth from one cell to the next below it.
const DEPTH: f64 = 0.2;
const DEPTH_GROWTH: f64 = 1.4;
/// Growth from one cell to the next beyond the window.
const MARGIN_GROWTH: f64 = 1.4;

/// The shortest lengths that a grid has to resolve, in mm.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scales {
    /// Transport mean free path 1/σ_t'.
    pub(super) mean_free_path: f64,
    /// Decay length 1/σ_tr; infinite without absorption.
    pub(super) decay: f64,
}

impl Grid {
    /// A grid for a window of `radius` pixels on a slab, reaching `margin_mm` beyond the window.
    ///
    /// `refine` divides every cell's width; 1 keeps entries within a few percent of the limit (see the tests).
    pub(super) fn new(
        pitch_mm: f64,
        radius: usize,
        thickness_mm: f64,
        margin_mm: f64,
        scales: Scales,
        refine: f64,
    ) -> Self {
        Self {
            lateral: lateral(pitch_mm, radius, margin_mm, scales, refine),
            depth: depth(thickness_mm, scales.mean_free_path, refine),
        }
    }

    pub(super) fn cells(&self) -> usize {
        self.lateral.cells() * self.lateral.cells() * self.depth.cells()
    }
}

fn lateral(pitch_mm: f64, radius: usize, margin_mm: f64, scales: Scales, refine: f64) -> Axis {
    let radius = i32::try_from(radius).expect("a window radius is below 1,024");
    // One half, from the middle of the source pixel outwards: edges and pixel of each cell.
    let mut edges = vec![0.0];
    let mut pixels = Vec::new();
    for k in 0..=radius {
        let (near, far) = (f64::from(k) - 0.5, f64::from(k) + 0.5);
        let distance = (near * pitch_mm).max(0.0);
        let widest = NEAR * scales.mean_free_path + FAR * distance;
        let widest = widest.min(DECAY * scales.decay) / refine;
        // Even across the source pixel, of which this half has one half.
        let count = (pitch_mm / widest).ceil().clamp(1.0, (MAX_PER_PIXEL * refine).max(1.0));
        let count = if k == 0 { (count / 2.0).ceil() * 2.0 } else { count };
        let start = if k == 0 { count / 2.0 } else { 0.0 };
        let mut cell = start + 1.0;
        while cell <= count {
            edges.push((near + (far - near) * cell / count) * pitch_mm);
            pixels.push(k);
            cell += 1.0;
        }
    }
    // Beyond the window only the light that comes back matters.
    let mut width = pitch_mm / refine;
    let mut edge = edges[edges.len() - 1];
    let end = edge + margin_mm;
    while edge < end {
        width *= 1.0 + (MARGIN_GROWTH - 1.0) / refine;
        let middle = edge + 0.5 * width;
        edge += width;
        edges.push(edge);
        #[allow(clippy::cast_possible_truncation, reason = "saturates; patches have at most 65,535 pixels")]
        pixels.push((middle / pitch_mm).round() as i32);
    }
    let mirrored = edges.iter().skip(1).rev().map(|edge| -edge);
    let pixel = pixels.iter().rev().map(|pixel| -pixel).chain(pixels.iter().copied());
    Axis { edges: mirrored.chain(edges.iter().copied()).collect(), pixel: pixel.collect() }
}

fn depth(thickness_mm: f64, mfp_mm: f64, refine: f64) -> Axis {
    let mut edges = vec![0.0];
    let mut width = DEPTH * mfp_mm / refine;
    let mut edge = 0.0;
    while edge < thickness_mm {
        edge = if edge + 1.5 * width < thickness_mm { edge + width } else { thickness_mm };
        edges.push(edge);
        width *= 1.0 + (DEPTH_GROWTH - 1.0) / refine;
    }
    Axis { edges, pixel: Vec::new() }
}
