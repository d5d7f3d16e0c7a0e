//! One run: what is traced, and how much of it.

use std::sync::atomic::{AtomicU64, Ordering};

use rand::SeedableRng;
use rand_pcg::Pcg64;

use super::half_space::HalfSpace;
use super::outcome::{Outcome, Sum};
use super::packet::trace;
use super::score::{Event, Grid, Quantity, Score, Tally, units};
use super::stack::{Source, Stack};
use crate::error::{Error, Result};
use crate::math::parallel;
use crate::progress::Progress;

/// Packets that a thread traces at a time, at least and at most. Each has random numbers of its own, so results do not hang on
/// this; the last packets of a batch leave vector units idle.
const BATCH: std::ops::RangeInclusive<u64> = 1 << 12..=1 << 16;

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

/// Sums over packets.
#[derive(Clone)]
pub(super) struct Sums {
    pub(super) packets: u64,
    pub(super) reflected: Sum,
    pub(super) transmitted: Sum,
    pub(super) ballistic_reflected: Sum,
    pub(super) ballistic_transmitted: Sum,
    pub(super) absorbed: Sum,
    pub(super) layers: Vec<u128>,
    pub(super) tallies: Vec<Tally>,
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

    /// Traces the packets on all threads. Where `progress` says stop, the packets traced so far are the result, a batch for each
    /// thread at least.
    ///
    /// # Errors
    ///
    /// Those of [`Self::check`].
    pub fn run(&self, progress: &dyn Progress) -> Result<Outcome> {
        self.check()?;
        progress.begin("tracing photons", self.packets);
        let planes = self.stack.planes_mm();
        let half_space = HalfSpace::of(self);
        let threads = rayon::current_num_threads();
        let size = (self.packets / (8 * threads as u64)).clamp(*BATCH.start(), *BATCH.end());
        let next = AtomicU64::new(0);
        // Sums of integers are the same whichever thread takes a batch.
        let of_thread = |_| {
            let mut sums = Sums::new(self);
            loop {
                let first = next.fetch_add(size, Ordering::Relaxed);
                let end = (first + size).min(self.packets);
                if first >= end {
                    break;
                }
                match &half_space {
                    Some(half_space) => half_space.trace(first, end, &mut sums),
                    None => (first..end).for_each(|packet| {
                        trace(self, &planes, &mut Pcg64::seed_from_u64(self.seed_of(packet)), &mut sums);
                    }),
                }
                sums.packets += end - first;
                progress.advance(end - first);
                // After a batch: a run that is stopped at once has a result, too.
                if progress.stopped() {
                    break;
                }
            }
            sums
        };
        let sums = parallel::map(threads, of_thread).into_iter().fold(Sums::new(self), Sums::merged);
        Ok(Outcome::new(self, sums, half_space.is_some()))
    }

    /// Seed of a packet: those of neighbours are mixed by whoever takes them, those of neighbouring runs are far apart (by another
    /// odd multiplier than the mixers have, of Steele and Vigna 2021).
    pub(super) fn seed_of(&self, packet: u64) -> u64 {
        self.seed.wrapping_mul(0xd134_2543_de82_ef95).wrapping_add(packet)
    }
}

impl Sums {
    pub(super) fn new(request: &Request) -> Self {
        Self {
            packets: 0,
            reflected: Sum::default(),
            transmitted: Sum::default(),
            ballistic_reflected: Sum::default(),
            ballistic_transmitted: Sum::default(),
            absorbed: Sum::default(),
            layers: vec![0; request.stack.layers.len()],
            tallies: request.scores.iter().map(|score| Tally::new(*score, request.grid)).collect(),
        }
    }

    fn merged(mut self, other: Self) -> Self {
        self.packets += other.packets;
        self.reflected.merge(other.reflected);
        self.transmitted.merge(other.transmitted);
        self.ballistic_reflected.merge(other.ballistic_reflected);
        self.ballistic_transmitted.merge(other.ballistic_transmitted);
        self.absorbed.merge(other.absorbed);
        for (sum, more) in self.layers.iter_mut().zip(&other.layers) {
            *sum += more;
        }
        for (tally, more) in self.tallies.iter_mut().zip(&other.tallies) {
            tally.merge(more);
        }
        self
    }

    /// A packet of `weight` leaves the stack.
    pub(super) fn leave(&mut self, quantity: Quantity, ballistic: bool, event: &Event, weight: f64) {
        let up = quantity == Quantity::Reflected;
        match (up, ballistic) {
            (true, false) => self.reflected.add(weight),
            (false, false) => self.transmitted.add(weight),
            (true, true) => self.ballistic_reflected.add(weight),
            (false, true) => self.ballistic_transmitted.add(weight),
        }
        if !ballistic {
            self.score(quantity, event, weight);
        }
    }

    /// A packet loses `weight` to a layer.
    pub(super) fn absorb(&mut self, layer: usize, ballistic: bool, event: &Event, weight: f64) {
        self.layers[layer] += units(weight);
        self.score(if ballistic { Quantity::BallisticAbsorbed } else { Quantity::Absorbed }, event, weight);
    }

    fn score(&mut self, quantity: Quantity, event: &Event, weight: f64) {
        for tally in self.tallies.iter_mut().filter(|tally| tally.score.quantity == quantity) {
            tally.add(event, weight);
        }
    }
}
