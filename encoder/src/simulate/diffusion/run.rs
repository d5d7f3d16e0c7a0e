//! A simulated capture from solution to file.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use memmap2::Mmap;

use super::sensor::Sensor;
use super::slab::Slab;
use crate::capture::{Capture, CaptureWriter, neighbour, way_back};
use crate::error::{Error, Result};
use crate::math::parallel;
use crate::progress::Progress;

/// Processing of the solutions.
#[derive(Clone, Copy, Debug, Default)]
pub struct Finish {
    /// Leave every entry as its own solution gives it. Otherwise the two directions of a pair get their mean.
    ///
    /// Light paths can be reversed (Helmholtz), so a measured Rd is the same in both directions, up to noise. In the
    /// diffusion approximation a beam enters at a depth and leaves as a flux through the surface, and the two
    /// directions between unlike media differ: by one or two percent between media of similar mean free path and
    /// high albedo, by a factor of two between dark ones.
    pub one_way: bool,
    /// A camera's noise, added last.
    pub sensor: Option<Sensor>,
}

/// Figures of a simulation about itself.
#[derive(Clone, Copy, Debug)]
pub struct Summary {
    /// Share of the light leaving the upper face that leaves within the window, mean over pixels and channels.
    pub window_share: f64,
    /// Mean of |ln Rd(i, j) − ln Rd(j, i)| over the pairs inside the material, before it was evened out.
    pub asymmetry: f64,
}

/// Simulates a capture by diffusion and writes it. Needs room for a second one, as f32, in the same folder meanwhile.
///
/// # Errors
/// [`Error::Output`].
pub fn simulate(
    slab: &Slab<'_>,
    finish: &Finish,
    writer: &CaptureWriter<'_>,
    progress: &dyn Progress,
) -> Result<Summary> {
    complete(slab, finish, writer, |sink| slab.measure(progress, sink))
}

/// Takes what light does in one direction from `measure`, which hands rows to its argument and returns the window's share, and writes
/// the capture that becomes of it.
pub(super) fn complete(
    slab: &Slab<'_>,
    finish: &Finish,
    writer: &CaptureWriter<'_>,
    measure: impl FnOnce(&mut dyn FnMut(&[f32]) -> io::Result<()>) -> io::Result<f64>,
) -> Result<Summary> {
    let output = |source| Error::output(writer.path, source);
    let solved = scratch(writer.path).map_err(output)?;
    let mut buffered = BufWriter::new(&solved);
    let window_share =
        measure(&mut |rows: &[f32]| rows.iter().try_for_each(|rd| buffered.write_all(&rd.to_le_bytes())))
            .map_err(output)?;
    buffered.flush().map_err(output)?;
    drop(buffered);
    // SAFETY: the file has no name, and nobody else has it open.
    let map = unsafe { Mmap::map(&solved) }.map_err(output)?;
    let entries = Entries { slab, values: map.as_chunks().0 };

    let [width, height] = slab.map.size;
    let mut asymmetry = Mean::default();
    writer.write(|sink| {
        for y in 0..height {
            let windows = parallel::map(width, |x| entries.finished(y * width + x, finish));
            for (window, of_window) in windows {
                asymmetry.add(&of_window);
                sink(&window)?;
            }
        }
        Ok(())
    })?;
    Ok(Summary { window_share, asymmetry: asymmetry.value() })
}

/// Writes what a sensor makes of a capture without noise.
///
/// # Errors
/// [`Error::Output`].
pub fn expose(clean: &Capture, sensor: &Sensor, writer: &CaptureWriter<'_>) -> Result<()> {
    let [width, height] = [clean.width(), clean.height()];
    writer.write(|sink| {
        for y in 0..height {
            let exposed = parallel::map(width, |x| {
                let pixel = y * width + x;
                let mut window = vec![0.0; clean.window_len()];
                clean.read_window(pixel, &mut window);
                sensor.expose(pixel, clean.pitch_mm().into(), &mut window);
                window
            });
            exposed.iter().try_for_each(|window| sink(window))?;
        }
        Ok(())
    })
}

/// A file without a name beside `path`: gone when it is closed, whatever happens.
fn scratch(path: &Path) -> io::Result<File> {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => tempfile::tempfile_in(parent),
        _ => tempfile::tempfile_in("."),
    }
}

/// Sum and count of what a mean is taken over.
#[derive(Clone, Copy, Debug, Default)]
struct Mean {
    sum: f64,
    count: f64,
}

impl Mean {
    fn add(&mut self, other: &Self) {
        self.sum += other.sum;
        self.count += other.count;
    }

    fn value(&self) -> f64 {
        if self.count > 0.0 { self.sum / self.count } else { 0.0 }
    }
}

/// All solutions, `[pixel][dy][dx][rgb]`.
struct Entries<'a> {
    slab: &'a Slab<'a>,
    values: &'a [[u8; 4]],
}

impl Entries<'_> {
    fn window_len(&self) -> usize {
        let d = 2 * self.slab.radius + 1;
        d * d * 3
    }

    fn get(&self, pixel: usize, at: usize) -> f32 {
        f32::from_le_bytes(self.values[pixel * self.window_len() + at])
    }

    /// The window of a pixel as it is written, and how far the directions of its pairs were apart.
    fn finished(&self, pixel: usize, finish: &Finish) -> (Vec<f32>, Mean) {
        let Slab { map, radius, addressing, pitch_mm, .. } = self.slab;
        let position = [pixel % map.size[0], pixel / map.size[0]];
        let d = 2 * radius + 1;
        let signed = |k: usize| i32::try_from(k).expect("windows are small");
        let mut asymmetry = Mean::default();
        let mut window: Vec<f32> = (0..self.window_len()).map(|at| self.get(pixel, at)).collect();
        for place in 0..d * d {
            let step = [place % d, place / d].map(|k| signed(k) - signed(*radius));
            let Some(other) = neighbour(*addressing, map.size, position, step) else {
                continue;
            };
            let [back_x, back_y] = way_back(*addressing, map.size, position, step).map(|k| k + signed(*radius));
            let back = usize::try_from(back_y * signed(d) + back_x).expect("steps stay in the window");
            for c in 0..3 {
                let (there, back) = (window[place * 3 + c], self.get(other, back * 3 + c));
                // Far away a solution can be zero to its precision: not measured.
                if there > 0.0 && back > 0.0 {
                    asymmetry.add(&Mean { sum: f64::from((there / back).ln().abs()), count: 1.0 });
                }
                if !finish.one_way {
                    window[place * 3 + c] = 0.5 * (there + back);
                }
            }
        }
        if let Some(sensor) = &finish.sensor {
            sensor.expose(pixel, *pitch_mm, &mut window);
        }
        (window, asymmetry)
    }
}
