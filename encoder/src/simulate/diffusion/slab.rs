//! Virtual measurement: what a camera and a projector would see of a slab of given media.

use subsurf_decoder::bssrdf::Addressing;

use super::grid::{Grid, Scales};
use super::medium::Medium;
use super::solver::{Rgb, System};
use crate::math::parallel;
use crate::progress::Progress;
use crate::simulate::fresnel::boundary_a;

/// The medium below every pixel of a patch; it goes straight down.
#[derive(Clone, Debug)]
pub struct MediumMap {
    /// Pixels in x and y.
    pub size: [usize; 2],
    /// Medium of every pixel, row by row.
    pub media: Vec<Medium>,
}

/// A slab to be measured.
///
/// Every pixel in turn is lit by a collimated beam as wide as the pixel; light diffuses as −∇·(D∇φ) + σ_a φ = Q, with
/// D = 1/(3 σ_t') and Q = σ_s' exp(−σ_t' z) below the pixel, leaves through both faces by the partial-current
/// condition φ = 2 A D ∂φ/∂n, and is measured as Rd = φ/(2 A), averaged over each pixel of the window.
#[derive(Clone, Copy, Debug)]
pub struct Slab<'a> {
    /// Media below all pixels.
    pub map: &'a MediumMap,
    /// What lies beyond the border of the map.
    pub addressing: Addressing,
    /// Distance of neighbouring pixels in mm.
    pub pitch_mm: f64,
    /// R: the window has D = 2 R + 1 pixels to a side.
    pub radius: usize,
    /// Thickness in mm.
    pub thickness_mm: f64,
    /// Refractive index.
    pub eta: f64,
    /// How much finer than usual the voxels are; 1 is usual.
    pub refine: f64,
}

/// Residual at which a solution is taken, relative to the source: that moves no entry by more than 10⁻³ of itself.
const TOLERANCE: f64 = 1e-5;
/// The box reaches beyond the window by this many thicknesses.
const MARGIN: f64 = 1.5;

impl Slab<'_> {
    /// Measures the windows of all pixels, some rows at a time, and hands them on in order:
    /// `[y][x][dy][dx][rgb]` in mm⁻². Entries beyond the border of a patch that clamps are NaN: not measured.
    ///
    /// Returns the share of the light leaving the upper face that leaves within the window, mean over pixels and
    /// channels.
    ///
    /// # Errors
    /// Whatever `sink` returns.
    pub fn measure<E>(&self, progress: &dyn Progress, mut sink: impl FnMut(&[f32]) -> Result<(), E>) -> Result<f64, E> {
        let [width, height] = self.map.size;
        let grid = self.grid();
        let d = 2 * self.radius + 1;
        let row_len = width * d * d * 3;
        // Enough rows to keep all threads busy, few enough to stay small.
        let rows_at_once = rayon::current_num_threads() * 2;
        let mut rows = vec![0.0; row_len * rows_at_once];
        let mut share = 0.0;
        progress.begin("simulating", (width * height) as u64);
        for first in (0..height).step_by(rows_at_once) {
            let count = rows_at_once.min(height - first);
            let rows = &mut rows[..count * row_len];
            let shares =
                parallel::map_chunks(rows, row_len, |k, row| self.measure_row(&grid, first + k, row, progress));
            share += shares.iter().sum::<f64>();
            sink(rows)?;
        }
        #[allow(clippy::cast_precision_loss, reason = "pixels fit in 2⁵³")]
        let pixels = (width * height) as f64;
        Ok(share / pixels)
    }

    /// Number of voxels that each pixel takes.
    #[must_use]
    pub fn voxels(&self) -> usize {
        self.grid().cells()
    }

    fn grid(&self) -> Grid {
        let channels = self.map.media.iter().flat_map(|medium| [0, 1, 2].map(|c| (medium, c)));
        let infinite = Scales { mean_free_path: f64::INFINITY, decay: f64::INFINITY };
        let shortest = channels.fold(infinite, |shortest, (medium, c)| Scales {
            mean_free_path: shortest.mean_free_path.min(medium.mean_free_path_mm(c)),
            decay: shortest.decay.min(medium.decay_length_mm(c)),
        });
        let margin_mm = MARGIN * self.thickness_mm;
        Grid::new(self.pitch_mm, self.radius, self.thickness_mm, margin_mm, shortest, self.refine)
    }

    /// The windows of one row; returns the sum of their shares. A solution is the first guess for the pixel beside it,
    /// whose surroundings differ little.
    fn measure_row(&self, grid: &Grid, y: usize, out: &mut [f32], progress: &dyn Progress) -> f64 {
        let lateral = grid.lateral.cells();
        let mut system = System::new([grid.depth.cells(), lateral, lateral]);
        let window_len = out.len() / self.map.size[0];
        let mut share = 0.0;
        for (x, window) in out.chunks_mut(window_len).enumerate() {
            let media = self.media_below(grid, x, y);
            self.assemble(grid, &media, &mut system);
            system.solve(TOLERANCE);
            share += self.read_surface(grid, &media, &system, [x, y], window);
            progress.advance(1);
        }
        share
    }

    /// The medium below every lateral cell, [y][x].
    fn media_below(&self, grid: &Grid, x: usize, y: usize) -> Vec<Medium> {
        let at = |from: usize, step: i32, n: usize| {
            let (from, n) = (i32::try_from(from), u32::try_from(n));
            let (from, n) = (from.expect("a side is below 65,536"), n.expect("a side is below 65,536"));
            self.addressing.map(from.saturating_add(step), n) as usize
        };
        let [width, height] = self.map.size;
        let pixels = &grid.lateral.pixel;
        let mut media = Vec::with_capacity(pixels.len() * pixels.len());
        for &py in pixels {
            let row = at(y, py, height) * width;
            media.extend(pixels.iter().map(|&px| self.map.media[row + at(x, px, width)]));
        }
        media
    }

    fn assemble(&self, grid: &Grid, media: &[Medium], system: &mut System) {
        let (lateral, depth) = (&grid.lateral, &grid.depth);
        let n = lateral.cells();
        let bottom = depth.cells() - 1;
        let boundary = 2.0 * boundary_a(self.eta);
        let diffusion: Vec<Rgb> =
            media.iter().map(|medium| [0, 1, 2].map(|c| medium.mean_free_path_mm(c) / 3.0)).collect();
        let pixel_area = self.pitch_mm * self.pitch_mm;

        for y in 0..n {
            for x in 0..n {
                let column = x + y * n;
                let (wx, wy) = (lateral.width(x), lateral.width(y));
                let area = wx * wy;
                let d = diffusion[column];
                // Conductance per depth to the next column in x and y: two half cells in series; none at the end.
                let series = |wide: f64, w: f64, next: usize, w_next: f64| {
                    [0, 1, 2].map(|c| wide / (0.5 * w / d[c] + 0.5 * w_next / diffusion[next][c]))
                };
                let to_x = if x + 1 < n { series(wy, wx, column + 1, lateral.width(x + 1)) } else { [0.0; 3] };
                let to_y = if y + 1 < n { series(wx, wy, column + n, lateral.width(y + 1)) } else { [0.0; 3] };
                let lit = lateral.pixel[x] == 0 && lateral.pixel[y] == 0;
                let medium = &media[column];
                for z in 0..=bottom {
                    let i = system.index(z, x, y);
                    let dz = depth.width(z);
                    for c in 0..3 {
                        system.g[0][i][c] =
                            if z < bottom { area * d[c] / (0.5 * (dz + depth.width(z + 1))) } else { 0.0 };
                        system.g[1][i][c] = to_x[c] * dz;
                        system.g[2][i][c] = to_y[c] * dz;
                        let faces = f64::from(u8::from(z == 0) + u8::from(z == bottom));
                        let escape = faces * area / (boundary + 0.5 * dz / d[c]);
                        system.loss[i][c] = medium.sigma_a[c] * area * dz + escape;
                        system.q[i][c] = if lit {
                            // ∫ σ_s' exp(−σ_t' z) dz over the cell, of a beam of one watt over the pixel.
                            let sigma_t = medium.sigma_s[c] + medium.sigma_a[c];
                            let beam = |z: usize| (-sigma_t * depth.edges[z]).exp();
                            medium.sigma_s[c] / sigma_t * (beam(z) - beam(z + 1)) * area / pixel_area
                        } else {
                            0.0
                        };
                    }
                }
            }
        }
    }

    /// Mean exitance φ/(2 A) over each pixel of the window; returns the window's share of all light that leaves.
    fn read_surface(
        &self,
        grid: &Grid,
        media: &[Medium],
        system: &System,
        from: [usize; 2],
        window: &mut [f32],
    ) -> f64 {
        let lateral = &grid.lateral;
        let n = lateral.cells();
        let radius = i32::try_from(self.radius).expect("a window radius is below 1,024");
        let d = 2 * self.radius + 1;
        let boundary = 2.0 * boundary_a(self.eta);
        let half_cell = 0.5 * grid.depth.width(0);
        let mut sums = vec![[0.0_f64; 3]; d * d];
        let mut outside = 0.0;
        for y in 0..n {
            for x in 0..n {
                let area = lateral.width(x) * lateral.width(y);
                let phi = system.phi[system.index(0, x, y)];
                let power = [0, 1, 2].map(|c| {
                    let diffusion = media[x + y * n].mean_free_path_mm(c) / 3.0;
                    phi[c] * area / (boundary + half_cell / diffusion)
                });
                let step = [lateral.pixel[x], lateral.pixel[y]];
                if step.iter().any(|step| step.abs() > radius) {
                    outside += power.iter().sum::<f64>();
                    continue;
                }
                let [dx, dy] = step.map(|step| usize::try_from(step + radius).expect("step ≥ −radius"));
                for c in 0..3 {
                    sums[dx + dy * d][c] += power[c];
                }
            }
        }
        let within: f64 = sums.iter().flatten().sum();
        let pixel_area = self.pitch_mm * self.pitch_mm;
        for (k, sum) in sums.iter().enumerate() {
            let step = [k % d, k / d].map(|k| i32::try_from(k).expect("k < D") - radius);
            let inside = crate::capture::neighbour(self.addressing, self.map.size, from, step).is_some();
            for c in 0..3 {
                #[allow(clippy::cast_possible_truncation, reason = "captures are f32")]
                let rd = (sum[c] / pixel_area) as f32;
                window[k * 3 + c] = if inside { rd } else { f32::NAN };
            }
        }
        within / (within + outside)
    }
}
