//! The pairs of a window, grouped by distance: offsets of equal length share interval, weight and importance.

use subsurf_decoder::bssrdf::Addressing;

use crate::capture::{neighbour, way_back};

/// Sampling of the profiles, and the pixels between which pairs are taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Geometry {
    /// Pixels in x and y.
    pub(crate) size: [usize; 2],
    /// Radius of the window in pixels, R.
    pub(crate) radius: usize,
    /// Nodes of a profile, S.
    pub(crate) nodes: usize,
    /// Radius of the last node in pixels.
    pub(crate) r_max_px: f64,
    /// What lies beyond the border.
    pub(crate) addressing: Addressing,
}

impl Geometry {
    pub(crate) fn pixels(&self) -> usize {
        self.size[0] * self.size[1]
    }

    /// Column and row of a pixel.
    pub(crate) fn position(&self, pixel: usize) -> [usize; 2] {
        [pixel % self.size[0], pixel / self.size[0]]
    }

    pub(crate) fn neighbour(&self, pixel: usize, step: [i32; 2]) -> Option<usize> {
        neighbour(self.addressing, self.size, self.position(pixel), step)
    }

    /// From the pixel that [`Geometry::neighbour`] gives back to `pixel`.
    pub(crate) fn way_back(&self, pixel: usize, step: [i32; 2]) -> [i32; 2] {
        way_back(self.addressing, self.size, self.position(pixel), step)
    }

    /// Place of a step in a capture's window, dx + dy D with both counted from the window's corner.
    pub(crate) fn place(&self, [dx, dy]: [i32; 2]) -> usize {
        let radius = i32::try_from(self.radius).expect("a window radius is below 1,024");
        usize::try_from((dx + radius) + (dy + radius) * (2 * radius + 1)).expect("steps stay in the window")
    }
}

/// One pixel of the window.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Offset {
    pub(crate) step: [i32; 2],
    /// Its place in a capture's window.
    pub(crate) place: usize,
}

/// All offsets of one length r.
#[derive(Clone, Debug)]
pub(crate) struct Ring {
    /// Number h of the node below r.
    pub(crate) h: usize,
    /// Weight w of node h + 1.
    pub(crate) w: f32,
    /// φ(r) = 1 / (1 + r²), r in pixels (Yatagawa et al. 2020, section 3.3).
    pub(crate) phi: f32,
    pub(crate) offsets: Vec<Offset>,
}

impl Ring {
    /// Whether this ring is the pixel itself, r = 0.
    pub(crate) fn is_self(&self) -> bool {
        self.h == 0 && self.w == 0.0
    }
}

/// The offsets of a window by rising distance; the first ring is the pixel itself.
pub(crate) fn rings(geometry: &Geometry) -> Vec<Ring> {
    let radius = i32::try_from(geometry.radius).expect("a window radius is below 1,024");
    let mut offsets: Vec<(i32, Offset)> = (-radius..=radius)
        .flat_map(|dy| (-radius..=radius).map(move |dx| [dx, dy]))
        .map(|step| {
            let [dx, dy] = step;
            (dx * dx + dy * dy, Offset { step, place: geometry.place(step) })
        })
        .collect();
    offsets.sort_by_key(|(r2, offset)| (*r2, offset.place));
    offsets
        .chunk_by(|a, b| a.0 == b.0)
        .map(|ring| {
            let r2 = f64::from(ring[0].0);
            let intervals = geometry.nodes - 1;
            #[allow(clippy::cast_precision_loss, reason = "at most 4,096 nodes")]
            let position = r2.sqrt() / geometry.r_max_px * intervals as f64;
            #[allow(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "the integer part of a number from 0 to 4,095"
            )]
            let h = (position as usize).min(intervals - 1);
            #[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, reason = "w is in 0 to 1")]
            let w = (position - h as f64) as f32;
            #[allow(clippy::cast_possible_truncation, reason = "φ is in 0 to 1")]
            let phi = (1.0 / (1.0 + r2)) as f32;
            Ring { h, w, phi, offsets: ring.iter().map(|(_, offset)| *offset).collect() }
        })
        .collect()
}
