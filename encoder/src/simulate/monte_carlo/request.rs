//! One run: what is traced, and how much of it.

use super::score::{Grid, Score};
use super::stack::{Source, Stack};
use crate::error::{Error, Result};

/// Packets of a run, at most: sums of their weights fit into the integers that they are kept in.
const MAX_PACKETS: u64 = 1 << 40;

/// Cells of all scores of a run, at most; each takes up to 32 bytes on every thread.
const MAX_CELLS: usize = 1 << 22;

/// A run of the simulation.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// Layers.
    pub stack: Stack,
    /// Where packets start.
    pub source: Source,
    /// Cells of the scores.
    pub grid: Grid,
    /// What is resolved; totals are always counted.
    pub scores: Vec<Score>,
    /// Packets that are traced.
    pub packets: u64,
    /// Weight below which a packet plays roulette; MCML has 1e-4.
    pub threshold: f64,
    /// Seed of the random numbers: the same seed gives the same result, to the last bit, on any number of threads.
    pub seed: u64,
    /// Whether light that was never scattered is kept out of the scores, and its absorption apart, as MCML 2 does; MCML 1
    /// counts it among the rest.
    pub ballistic_apart: bool,
}

impl Request {
    /// Whether the run can be made.
    ///
    /// # Errors
    ///
    /// [`Error::Request`] that names the value and what is allowed.
    pub fn check(&self) -> Result<()> {
        self.stack.check()?;
        let refuse = |what: String| Err(Error::Request(what));
        let bottom = self.stack.planes_mm()[self.stack.layers.len()];
        let z = self.source.z_mm();
        if !(z >= 0.0 && z < bottom) {
            return refuse(format!(
                "the source lies {z} mm deep, allowed is 0 to below the stack's bottom at {bottom} mm"
            ));
        }
        if !(1..=MAX_PACKETS).contains(&self.packets) {
            return refuse(format!("{} photon packets, allowed are 1 to {MAX_PACKETS}", self.packets));
        }
        if !(0.0..1.0).contains(&self.threshold) {
            return refuse(format!("roulette below a weight of {}, allowed is 0 to 1", self.threshold));
        }
        let Grid { dr_mm, nr, na, dz_mm, nz, dt_ps, nt } = self.grid;
        for (name, width, cells) in [("r", dr_mm, nr), ("alpha", 1.0, na), ("z", dz_mm, nz), ("t", dt_ps, nt)] {
            if !(width > 0.0 && width.is_finite() && (1..=MAX_CELLS).contains(&cells)) {
                return refuse(format!(
                    "grid along {name}: {cells} cells of width {width}, allowed are 1 to {MAX_CELLS} above 0"
                ));
            }
        }
        let axes = self.scores.iter().map(|score| score.axes);
        let cells = axes.map(|axes| {
            let along = [(axes.r, nr), (axes.a, na), (axes.z, nz), (axes.t, nt)];
            along
                .into_iter()
                .filter(|(resolved, _)| *resolved)
                .fold(1_usize, |cells, (_, n)| cells.saturating_mul(n + 1))
        });
        let cells = cells.fold(0, usize::saturating_add);
        if cells > MAX_CELLS {
            return refuse(format!(
                "{cells} cells in all scores, allowed are {MAX_CELLS}: take a coarser grid or fewer scores"
            ));
        }
        Ok(())
    }

    /// Seed of a packet: those of neighbours are mixed by whoever takes them, those of neighbouring runs are far apart (by another
    /// odd multiplier than the mixers have, of Steele and Vigna 2021).
    pub(super) fn seed_of(&self, packet: u64) -> u64 {
        self.seed.wrapping_mul(0xd134_2543_de82_ef95).wrapping_add(packet)
    }
}
