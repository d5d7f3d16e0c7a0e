//! What a run found.

use super::request::Request;
use super::score::{Event, Quantity, Score, Tally, standard_error, units, weight};

/// A mean over packets.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// Share of the light that was sent, 0 to 1.
    pub mean: f64,
    /// Standard error of the mean.
    pub standard_error: f64,
}

/// Sum and sum of squares of what each packet adds, as integers.
#[derive(Clone, Copy, Default)]
pub(super) struct Sum {
    sum: u128,
    square: u128,
}

impl Sum {
    pub(super) fn add(&mut self, weight: f64) {
        self.sum += units(weight);
        self.square += units(weight * weight);
    }

    pub(super) fn merge(&mut self, other: Self) {
        self.sum += other.sum;
        self.square += other.square;
    }

    fn estimate(self, packets: u64) -> Estimate {
        #[allow(clippy::cast_precision_loss, reason = "53 bits are enough for a result")]
        let mean = weight(self.sum) / packets as f64;
        Estimate { mean, standard_error: standard_error(self.sum, self.square, packets) }
    }
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

    pub(super) fn merged(mut self, other: Self) -> Self {
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

/// Totals and scores of a run, as shares of the light that was sent.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// Packets traced: all that were asked for, or those until it was stopped.
    pub packets: u64,
    /// Share mirrored before it entered.
    pub specular: f64,
    /// Share that left upwards.
    pub reflected: Estimate,
    /// Share that left downwards.
    pub transmitted: Estimate,
    /// Share that left upwards unscattered, without [`Self::specular`]; 0 where it is counted among the rest.
    pub ballistic_reflected: Estimate,
    /// Share that left downwards unscattered; 0 where it is counted among the rest.
    pub ballistic_transmitted: Estimate,
    /// Share absorbed.
    pub absorbed: Estimate,
    /// Shares absorbed in each layer.
    pub layers: Vec<f64>,
    /// What was resolved, in the order of the request's scores.
    pub tallies: Vec<Tally>,
}

impl Outcome {
    /// Of sums over packets; `rest_is_absorbed` if what does not leave was not counted.
    pub(super) fn new(request: &Request, sums: Sums, rest_is_absorbed: bool) -> Self {
        let packets = sums.packets;
        #[allow(clippy::cast_precision_loss, reason = "53 bits are enough for a result")]
        let share = |sum: &u128| weight(*sum) / packets as f64;
        let entered_from_above = request.source == super::Source::Pencil { z_mm: 0.0 };
        let specular = if entered_from_above { request.stack.specular() } else { 0.0 };
        let reflected = sums.reflected.estimate(packets);
        let mut absorbed = sums.absorbed.estimate(packets);
        let mut layers: Vec<f64> = sums.layers.iter().map(share).collect();
        if rest_is_absorbed {
            absorbed = Estimate { mean: 1.0 - specular - reflected.mean, ..reflected };
            layers = vec![absorbed.mean];
        }
        Self {
            packets,
            specular,
            reflected,
            transmitted: sums.transmitted.estimate(packets),
            ballistic_reflected: sums.ballistic_reflected.estimate(packets),
            ballistic_transmitted: sums.ballistic_transmitted.estimate(packets),
            absorbed,
            layers,
            tallies: sums.tallies,
        }
    }

    /// The tally of a score; `None` if it was not asked for.
    #[must_use]
    pub fn tally(&self, score: Score) -> Option<&Tally> {
        self.tallies.iter().find(|tally| tally.score == score)
    }
}
