//! What is counted: weight that leaves or is absorbed, by radius, angle, depth and time.

use std::f64::consts::{FRAC_PI_2, TAU};

/// Cells that weight is sorted into. What lies beyond the last radius, depth or time is counted apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Width of a ring in mm.
    pub dr_mm: f64,
    /// Rings.
    pub nr: usize,
    /// Angles between 0 and π/2 from the surface's normal.
    pub na: usize,
    /// Height of a cell in mm.
    pub dz_mm: f64,
    /// Cells from the surface downwards.
    pub nz: usize,
    /// Length of a time cell in ps.
    pub dt_ps: f64,
    /// Time cells.
    pub nt: usize,
}

/// Where weight went.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// R: it left upwards.
    Reflected,
    /// T: it left downwards.
    Transmitted,
    /// A: it was absorbed.
    Absorbed,
    /// A_b: it was absorbed where the packet collided first. Counted as [`Self::Absorbed`] unless it is asked for apart.
    BallisticAbsorbed,
}

/// Coordinates that a quantity is resolved by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Axes {
    /// Radius from the source's axis.
    pub r: bool,
    /// Angle from the normal at which it left.
    pub a: bool,
    /// Depth.
    pub z: bool,
    /// Time since the packet started.
    pub t: bool,
}

/// A quantity and how it is resolved, such as R_d(r).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Score {
    /// Where weight went.
    pub quantity: Quantity,
    /// What it is resolved by.
    pub axes: Axes,
}

/// A place, an angle and a time at which weight is counted.
#[derive(Clone, Copy)]
pub(super) struct Event {
    pub(super) r_mm: f64,
    pub(super) z_mm: f64,
    /// Cosine of the angle from the normal.
    pub(super) cosine: f64,
    pub(super) t_ps: f64,
}

/// Units of weight in one: sums of integers are the same in any order, on any number of threads.
const UNITS: f64 = (1_u64 << 48) as f64;

/// Weight as an integer.
pub(super) fn units(weight: f64) -> u128 {
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "casts saturate, and weights are positive and far below 2^16"
    )]
    let units = (weight * UNITS + 0.5) as u64;
    units.into()
}

/// Weight of an integer.
pub(super) fn weight(units: u128) -> f64 {
    #[allow(clippy::cast_precision_loss, reason = "53 bits are enough for a result")]
    let units = units as f64;
    units / UNITS
}

/// Sums of weight in the cells of one score: radius before angle, depth and time, the last of these the fastest; one more
/// radius, depth and time than the grid has, for what lies beyond.
#[derive(Clone, Debug, PartialEq)]
pub struct Tally {
    /// What is counted.
    pub score: Score,
    grid: Grid,
    sums: Vec<u128>,
    /// Sums of squares, of what leaves alone: that happens to a packet once.
    squares: Vec<u128>,
}

impl Tally {
    pub(super) fn new(score: Score, grid: Grid) -> Self {
        let mut tally = Self { score, grid, sums: Vec::new(), squares: Vec::new() };
        let cells = tally.shape().into_iter().product();
        tally.sums = vec![0; cells];
        if matches!(score.quantity, Quantity::Reflected | Quantity::Transmitted) {
            tally.squares = vec![0; cells];
        }
        tally
    }

    /// Cells along r, α, z and t; 1 where it is not resolved.
    #[must_use]
    pub fn shape(&self) -> [usize; 4] {
        let Axes { r, a, z, t } = self.score.axes;
        let Grid { nr, na, nz, nt, .. } = self.grid;
        [if r { nr + 1 } else { 1 }, if a { na } else { 1 }, if z { nz + 1 } else { 1 }, if t { nt + 1 } else { 1 }]
    }

    pub(super) fn add(&mut self, event: &Event, weight: f64) {
        let Axes { r, a, z, t } = self.score.axes;
        let Grid { dr_mm, nr, na, dz_mm, nz, dt_ps, nt } = self.grid;
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "casts saturate, and cells are limited"
        )]
        let cell = |value: f64, width: f64, last: usize| ((value / width) as usize).min(last);
        #[allow(clippy::cast_precision_loss, reason = "angles are few")]
        let angle = || cell(event.cosine.min(1.0).acos(), FRAC_PI_2 / na as f64, na - 1);
        let [_, along_a, along_z, along_t] = self.shape();
        let mut at = if r { cell(event.r_mm, dr_mm, nr) } else { 0 };
        at = at * along_a + if a { angle() } else { 0 };
        at = at * along_z + if z { cell(event.z_mm, dz_mm, nz) } else { 0 };
        at = at * along_t + if t { cell(event.t_ps, dt_ps, nt) } else { 0 };
        self.sums[at] += units(weight);
        if let Some(square) = self.squares.get_mut(at) {
            *square += units(weight * weight);
        }
    }

    pub(super) fn merge(&mut self, other: &Self) {
        for (sum, more) in self.sums.iter_mut().zip(&other.sums) {
            *sum += more;
        }
        for (sum, more) in self.squares.iter_mut().zip(&other.squares) {
            *sum += more;
        }
    }

    /// Shares of `packets` packets' weight in the cells, of shape [`Self::shape`].
    #[must_use]
    pub fn shares(&self, packets: u64) -> Vec<f64> {
        #[allow(clippy::cast_precision_loss, reason = "53 bits are enough for a result")]
        let packets = packets as f64;
        self.sums.iter().map(|sum| weight(*sum) / packets).collect()
    }

    /// Standard errors of [`Self::shares`]; empty for what is absorbed.
    #[must_use]
    pub fn standard_errors(&self, packets: u64) -> Vec<f64> {
        let pairs = self.sums.iter().zip(&self.squares);
        pairs.map(|(sum, square)| standard_error(*sum, *square, packets)).collect()
    }

    /// Area, solid angle, height and time that the share of a cell is divided by to become a density: mm² times sr times mm
    /// times ps, as far as it is resolved. Where radius and angle both are, areas are those seen at that angle, cos α times
    /// as large, as MCML has it. 0 for cells beyond the grid.
    #[must_use]
    pub fn extent(&self, cell: usize) -> f64 {
        let Axes { r, a, z, t } = self.score.axes;
        let Grid { dr_mm, nr, na, dz_mm, nz, dt_ps, nt } = self.grid;
        let [_, along_a, along_z, along_t] = self.shape();
        let [it, iz] = [cell % along_t, cell / along_t % along_z];
        let [ia, ir] = [cell / along_t / along_z % along_a, cell / along_t / along_z / along_a];
        if (r && ir == nr) || (z && iz == nz) || (t && it == nt) {
            return 0.0;
        }
        #[allow(clippy::cast_precision_loss, reason = "cells are few")]
        let [ir, ia, na] = [ir as f64, ia as f64, na as f64];
        let mut extent = 1.0;
        if r {
            // 2π r dr at the middle of the ring.
            extent *= TAU * (ir + 0.5) * dr_mm * dr_mm;
        }
        if a {
            // 2π (cos α₀ − cos α₁) = 4π sin α sin(dα / 2).
            let (middle, width) = ((ia + 0.5) * FRAC_PI_2 / na, FRAC_PI_2 / na);
            extent *= 2.0 * TAU * middle.sin() * (0.5 * width).sin();
            if r {
                extent *= middle.cos();
            }
        }
        if z {
            extent *= dz_mm;
        }
        if t {
            extent *= dt_ps;
        }
        extent
    }

    /// Densities: shares by [`Self::extent`], in mm⁻² for R_d(r); 0 beyond the grid.
    #[must_use]
    pub fn densities(&self, packets: u64) -> Vec<f64> {
        let density = |(cell, share): (usize, f64)| {
            let extent = self.extent(cell);
            if extent > 0.0 { share / extent } else { 0.0 }
        };
        self.shares(packets).into_iter().enumerate().map(density).collect()
    }
}

/// Standard error of the mean of `packets` values with that sum and sum of squares.
pub(super) fn standard_error(sum: u128, square: u128, packets: u64) -> f64 {
    #[allow(clippy::cast_precision_loss, reason = "53 bits are enough for a result")]
    let packets = packets as f64;
    let (mean, mean_square) = (weight(sum) / packets, weight(square) / packets);
    ((mean_square - mean * mean).max(0.0) / (packets - 1.0).max(1.0)).sqrt()
}
