//! One pass over a capture, by blocks of rows.

use crate::bssrdf::window::{Geometry, Ring};
use crate::capture::Capture;
use crate::progress::Progress;

/// Rows whose sums are made apart from those of others. Fixed, so that results do not depend on the number of threads.
pub(crate) const BLOCK_ROWS: usize = 8;
/// Blocks that are in memory together.
pub(crate) const BLOCKS_AT_ONCE: usize = 8;

/// Bits of a pair whose three channels were all measured.
pub(super) const ALL_CHANNELS: u8 = 0b111;

/// Sums of one block of rows.
pub(super) struct Block {
    /// First row of `b`, which reaches R rows beyond the block.
    first: usize,
    /// Σ φ y a, `[pixel][node]`.
    b: Vec<[f64; 3]>,
    /// Half the light that a pixel sends out or gets, Σ ½ Rd in mm⁻²; as many pixels.
    exchange: Vec<[f64; 3]>,
    /// Sum Σ φ y² over the block's entries.
    pub(super) y2: f64,
    /// Channels that were measured, three bits per pixel of the block and place in the window; `None` if all inside the
    /// material were.
    pub(super) measured: Option<Vec<u8>>,
    /// Entries inside the material, and those of them that were measured.
    pub(super) entries: [u64; 2],
    /// Values of all windows that are too small for a measurement.
    pub(super) faint: u64,
}

impl Block {
    /// Sums over the rows of a block, from row `first` on.
    pub(super) fn read(
        capture: &Capture,
        geometry: &Geometry,
        rings: &[Ring],
        first: usize,
        progress: &dyn Progress,
    ) -> Self {
        let [width, height] = geometry.size;
        let rows = BLOCK_ROWS.min(height - first);
        let window_len = capture.window_len();
        let places = window_len / 3;
        let mut window = vec![0.0; window_len];
        let reach = (rows + 2 * geometry.radius) * (width + 2 * geometry.radius);
        // Sums of all rows that a window of the block can reach: it goes on beyond the border and is folded back later.
        let mut block = Self {
            first,
            b: vec![[0.0; 3]; reach * geometry.nodes],
            exchange: vec![[0.0; 3]; reach],
            y2: 0.0,
            measured: None,
            entries: [0; 2],
            faint: 0,
        };
        for row in 0..rows {
            for x in 0..width {
                let pixel = (first + row) * width + x;
                block.faint += capture.read_window(pixel, &mut window);
                let here = block.start(geometry, row, [x, 0], [0, 0]);
                for ring in rings {
                    let phi = f64::from(ring.phi);
                    let w = f64::from(ring.w);
                    for offset in &ring.offsets {
                        if geometry.neighbour(pixel, offset.step).is_none() {
                            continue;
                        }
                        let there = block.start(geometry, row, [x, 0], offset.step);
                        let mut channels = 0_u8;
                        for c in 0..3 {
                            let rd = window[offset.place * 3 + c];
                            if rd <= 0.0 {
                                continue;
                            }
                            channels |= 1 << c;
                            let y = 2.0 * f64::from(rd.ln());
                            block.y2 += phi * y * y;
                            for at in [here, there] {
                                block.exchange[at / geometry.nodes][c] += 0.5 * f64::from(rd);
                                block.b[at + ring.h][c] += phi * (1.0 - w) * y;
                                block.b[at + ring.h + 1][c] += phi * w * y;
                            }
                        }
                        block.entries[0] += 3;
                        block.entries[1] += u64::from(channels.count_ones());
                        if channels != ALL_CHANNELS {
                            let all = || vec![ALL_CHANNELS; rows * width * places];
                            let measured = block.measured.get_or_insert_with(all);
                            measured[(row * width + x) * places + offset.place] = channels;
                        }
                    }
                }
            }
            progress.advance(width as u64);
        }
        block
    }

    /// First value in `b` of the pixel `step` away from column x of a row of the block.
    fn start(&self, geometry: &Geometry, row: usize, [x, _]: [usize; 2], step: [i32; 2]) -> usize {
        let [column, row] = [(x, step[0]), (row, step[1])].map(|(k, step)| {
            (k + geometry.radius).wrapping_add_signed(isize::try_from(step).expect("windows are small"))
        });
        (row * (geometry.size[0] + 2 * geometry.radius) + column) * geometry.nodes
    }

    /// Adds the block's sums to those of all pixels; what lies beyond the border goes where the addressing says.
    pub(super) fn add_to(&self, geometry: &Geometry, b: &mut [[f64; 3]], exchange: &mut [[f64; 3]]) {
        let radius = i32::try_from(geometry.radius).expect("a window radius is below 1,024");
        let stride = geometry.size[0] + 2 * geometry.radius;
        let first = i32::try_from(self.first).expect("a side is below 65,536");
        for (k, profile) in self.b.chunks(geometry.nodes).enumerate() {
            let [x, y] = [k % stride, k / stride].map(|k| i32::try_from(k).expect("a side is below 65,536") - radius);
            let Some(pixel) = geometry.neighbour(0, [x, first + y]) else {
                continue;
            };
            for (sum, b) in b[pixel * geometry.nodes..].iter_mut().zip(profile) {
                for c in 0..3 {
                    sum[c] += b[c];
                }
            }
            for c in 0..3 {
                exchange[pixel][c] += self.exchange[k][c];
            }
        }
    }
}
