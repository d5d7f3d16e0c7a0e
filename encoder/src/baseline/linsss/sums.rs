//! What a fit reads of a capture: sums over the pixels at each distance.

use crate::capture::Capture;
use crate::error::{Error, Result};

/// Sums of Rd pitch² of every pixel with those at one distance, for all distances of a window.
pub(super) struct RingSums {
    pub(super) size: [usize; 2],
    pub(super) radius: usize,
    /// Squared distances in pixels.
    pub(super) r2: Vec<usize>,
    /// Mean of both directions, shape `[c][distance][pixel]`.
    pub(super) of: [Vec<Vec<f32>>; 3],
    /// Σ (Rd pitch²)² over all pairs, both directions, by channel.
    pub(super) squares: [f64; 3],
}

impl RingSums {
    /// Reads all windows once.
    pub(super) fn read(capture: &Capture) -> Result<Self> {
        let (size, radius, pixels) = ([capture.width(), capture.height()], capture.radius(), capture.pixels());
        let largest = 2 * radius * radius;
        let mut r2: Vec<usize> = (0..=radius).flat_map(|y| (0..=y).map(move |x| x * x + y * y)).collect();
        r2.sort_unstable();
        r2.dedup();
        let mut ring_of = vec![0; largest + 1];
        r2.iter().enumerate().for_each(|(ring, r2)| ring_of[*r2] = ring);
        let mut of = [0, 1, 2].map(|_| vec![vec![0.0_f32; pixels]; r2.len()]);
        let mut squares = [0.0_f64; 3];
        let mut window = vec![0.0; capture.window_len()];
        let area = capture.pitch_mm() * capture.pitch_mm();
        let reach = i32::try_from(radius).expect("a window radius is below 1,024");
        let steps = (-reach..=reach).flat_map(|dy| (-reach..=reach).map(move |dx| [dx, dy]));
        let steps: Vec<[i32; 2]> = steps.collect();
        for pixel in 0..pixels {
            capture.read_window(pixel, &mut window);
            let [x, y] = [pixel % size[0], pixel / size[0]];
            for (place, [dx, dy]) in steps.iter().enumerate() {
                let Some(other) = capture.neighbour(x, y, *dx, *dy) else {
                    continue;
                };
                let ring = ring_of[(dx * dx + dy * dy).unsigned_abs() as usize];
                for c in 0..3 {
                    let rd = window[3 * place + c] * area;
                    if rd <= 0.0 {
                        let path = capture.path().display();
                        return Err(Error::Request(format!(
                            "{path}: pixel ({x}, {y}) was not measured at ({dx}, {dy}) from it; LinSSS is fitted to captures of \
                             all pairs"
                        )));
                    }
                    // Light paths can be reversed: both directions of a pair are one number of the model.
                    of[c][ring][pixel] += 0.5 * rd;
                    of[c][ring][other] += 0.5 * rd;
                    squares[c] += f64::from(rd).powi(2);
                }
            }
        }
        Ok(Self { size, radius, r2, of, squares })
    }
}
