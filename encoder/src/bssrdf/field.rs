//! A profile for every pixel, with a border as wide as the window: neighbours are plain offsets.

use subsurf_decoder::bssrdf::Addressing;

use crate::bssrdf::window::Geometry;
use crate::math::lanes::{Lanes, ZERO};

/// Log-scale profiles `[y][x][node]` with R pixels of border on every side.
#[derive(Clone, Debug)]
pub(crate) struct Field {
    geometry: Geometry,
    /// Pixels to a row, border included.
    stride: usize,
    values: Vec<Lanes>,
}

impl Field {
    pub(crate) fn new(geometry: Geometry) -> Self {
        let [width, height] = geometry.size.map(|n| n + 2 * geometry.radius);
        Self { geometry, stride: width, values: vec![ZERO; width * height * geometry.nodes] }
    }

    /// Bytes of a field's values.
    pub(crate) fn bytes(geometry: &Geometry) -> usize {
        let [width, height] = geometry.size.map(|n| n + 2 * geometry.radius);
        width * height * geometry.nodes * size_of::<Lanes>()
    }

    /// First value of a pixel.
    fn start(&self, pixel: usize) -> usize {
        let [x, y] = self.geometry.position(pixel);
        let radius = self.geometry.radius;
        ((y + radius) * self.stride + x + radius) * self.geometry.nodes
    }

    /// Values from one pixel to the one `step` away.
    pub(crate) fn delta(&self, step: [i32; 2]) -> isize {
        let stride = isize::try_from(self.stride).expect("rows are short");
        let nodes = isize::try_from(self.geometry.nodes).expect("profiles are short");
        let [dx, dy] = step.map(|step| isize::try_from(step).expect("windows are small"));
        (dy * stride + dx) * nodes
    }

    /// The profile of a pixel.
    pub(crate) fn at(&self, pixel: usize) -> &[Lanes] {
        &self.values[self.start(pixel)..][..self.geometry.nodes]
    }

    /// Nodes h and h + 1 of the pixel `delta` values away from `pixel`, which may be in the border.
    #[inline]
    pub(crate) fn pair(&self, start: usize, delta: isize) -> &[Lanes; 2] {
        let at = start.wrapping_add_signed(delta);
        self.values[at..].first_chunk().expect("windows end at the border")
    }

    /// The value `delta` values away.
    #[inline]
    pub(crate) fn value(&self, start: usize, delta: isize) -> &Lanes {
        &self.values[start.wrapping_add_signed(delta)]
    }

    /// [`Field::pair`]'s `start` for node h of a pixel.
    pub(crate) fn node(&self, pixel: usize, h: usize) -> usize {
        self.start(pixel) + h
    }

    /// Replaces the profile of a pixel; call [`Field::fill_border`] after a batch of these.
    pub(crate) fn set(&mut self, pixel: usize, profile: &[Lanes]) {
        let start = self.start(pixel);
        self.values[start..][..self.geometry.nodes].copy_from_slice(profile);
    }

    /// Brings the border up to date: copies by the addressing mode, or zeros where the material ends.
    pub(crate) fn fill_border(&mut self) {
        if self.geometry.addressing == Addressing::Clamp {
            return;
        }
        let radius = i32::try_from(self.geometry.radius).expect("a window radius is below 1,024");
        let [width, height] = self.geometry.size.map(|n| i32::try_from(n).expect("a side is below 65,536"));
        let nodes = self.geometry.nodes;
        for y in -radius..height + radius {
            for x in -radius..width + radius {
                if (0..width).contains(&x) && (0..height).contains(&y) {
                    continue;
                }
                let from = self.geometry.neighbour(0, [x, y]).expect("patches that go on have no end");
                let from = self.start(from);
                let [column, row] = [x, y].map(|k| usize::try_from(k + radius).expect("k ≥ −R"));
                let to = (row * self.stride + column) * nodes;
                self.values.copy_within(from..from + nodes, to);
            }
        }
    }
}
