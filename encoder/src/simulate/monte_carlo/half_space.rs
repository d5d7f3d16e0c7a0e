//! Runs in a homogeneous half-space, many packets at once.

use pulp::NullaryFnOnce;

use super::jumps::Jumps;
use super::lanes::{LANES, Lanes, NEVER, Phase};
use super::outcome::Sums;
use super::request::Request;
use super::roulette::{EVENTS, LATE, LIGHT};
use super::score::{Event, Quantity};
use super::stack::Source;
use crate::simulate::fresnel;

/// Depth below which packets play roulette, in decay lengths of diffuse light: of what is deeper, little comes back.
const DEEP: f32 = 2.0;

/// Groups of lanes that move in turns: one waits for its results while another is computed.
const GROUPS: usize = 4;

/// What of a run all its packets share.
pub(super) struct HalfSpace<'a> {
    request: &'a Request,
    /// η of the medium by that above.
    eta: f64,
    /// Mean free path in mm.
    path_mm: f64,
    /// ln a = ln(σ_s / σ_t) of collisions that are counted and not weighed: 0 of jumps.
    ln_albedo: f64,
    /// Weight with which packets enter.
    entering: f64,
    roulette: Roulette,
    /// Decay length of diffuse light L = 1 / √(3 σ_a σ_t') in mean free paths, at least 1.
    decay: f32,
    phase: Phase,
    /// Where scattering is isotropic.
    jumps: Option<Jumps>,
}

impl<'a> HalfSpace<'a> {
    /// Of a run of that kind whose scores are of what leaves; `None` for all others.
    pub(super) fn of(request: &'a Request) -> Option<Self> {
        let [layer] = request.stack.layers[..] else { return None };
        let leaves = |quantity| matches!(quantity, Quantity::Reflected | Quantity::Transmitted);
        let suits = layer.thickness_mm.is_infinite()
            && layer.sigma_s > 0.0
            && request.source == (Source::Pencil { z_mm: 0.0 })
            && request.scores.iter().all(|score| leaves(score.quantity) && !score.axes.t);
        suits.then(|| Self::new(request, layer.g == 0.0))
    }

    /// With or without jumps: they are for isotropic scattering.
    fn new(request: &'a Request, with_jumps: bool) -> Self {
        let layer = request.stack.layers[0];
        let albedo = layer.sigma_s / layer.sigma_t();
        let eta = layer.eta / request.stack.eta_above;
        let jumps = with_jumps.then(|| Jumps::new(albedo, eta, request.threshold));
        let ln_albedo = if jumps.is_some() { 0.0 } else { albedo.ln() };
        // In mean free paths, σ_a = 1 − a and σ_t' = 1 − a g.
        let decay = (3.0 * (1.0 - albedo) * (1.0 - albedo * layer.g)).sqrt().recip();
        Self {
            request,
            eta,
            path_mm: 1.0 / layer.sigma_t(),
            ln_albedo,
            entering: 1.0 - request.stack.specular(),
            roulette: Roulette::new(ln_albedo, request.threshold),
            #[allow(clippy::cast_possible_truncation, reason = "lanes are of single precision")]
            decay: decay.clamp(1.0, 1e6) as f32,
            #[allow(clippy::cast_possible_truncation, reason = "lanes are of single precision")]
            phase: Phase { g: layer.g as f32 },
            jumps,
        }
    }

    /// Traces the packets from `first` to before `end`.
    pub(super) fn trace(&self, first: u64, end: u64, sums: &mut Sums) {
        let mut block = Block::new(self, first, end);
        pulp::Arch::new().dispatch(Trace { of: self, block: &mut block, sums });
    }

    /// Takes a packet that hopped above the surface back to it: it is reflected and goes on with the rest of its hop, or leaves.
    /// Whether it left.
    fn surface(&self, lanes: &mut Lanes, lane: usize, sums: &mut Sums) -> bool {
        let [x, y, z] = [0, 1, 2].map(|axis| lanes.position[axis][lane]);
        let [ux, uy, uz] = [0, 1, 2].map(|axis| lanes.direction[axis][lane]);
        let cosine = f64::from(-uz).min(1.0);
        // Jumps have their reflections behind them.
        if self.jumps.is_none() && f64::from(lanes.uniform(lane)) < fresnel::reflectance(self.eta, cosine) {
            // The rest of the hop, mirrored.
            lanes.position[2][lane] = -z;
            lanes.direction[2][lane] = -uz;
            return false;
        }
        // Back along the hop, by as much as it went too far.
        let back = z / uz;
        let [x, y] = [x - back * ux, y - back * uy].map(f64::from);
        let weight =
            self.entering * (self.ln_albedo * f64::from(lanes.collisions[lane])).exp() * f64::from(lanes.factor[lane]);
        let refracted = (1.0 - self.eta * self.eta * (1.0 - cosine * cosine)).max(0.0).sqrt();
        let event = Event { r_mm: (x * x + y * y).sqrt() * self.path_mm, z_mm: 0.0, cosine: refracted, t_ps: 0.0 };
        sums.leave(Quantity::Reflected, false, &event, weight);
        true
    }
}

/// Roulette by the number of collisions.
#[derive(Clone, Copy)]
struct Roulette {
    /// Collisions before a packet plays first.
    first: u32,
    /// Collisions from one time to the next; `None`: as many as there were.
    step: Option<u32>,
    /// Chance to survive.
    survival: f64,
}

impl Roulette {
    /// Where a^n falls below the threshold, and below a tenth of that each time that a packet survived; where so little is absorbed
    /// that this is late, whenever the collisions have doubled.
    fn new(ln_albedo: f64, threshold: f64) -> Self {
        if threshold.ln() <= ln_albedo * f64::from(EVENTS) {
            return Self { first: EVENTS, step: None, survival: LATE };
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to EVENTS")]
        let collisions = |ln_weight: f64| (ln_weight / ln_albedo).clamp(1.0, f64::from(EVENTS)).ceil() as u32;
        Self { first: collisions(threshold.ln()), step: Some(collisions(LIGHT.ln())), survival: LIGHT }
    }
}

/// Packets side by side, and those that wait for a lane.
struct Block {
    groups: [Lanes; GROUPS],
    /// Lanes with packets: the first ones.
    alive: usize,
    next: u64,
    end: u64,
}

/// Traces the packets of a block until none is left: compiled for each set of vector instructions.
struct Trace<'a> {
    of: &'a HalfSpace<'a>,
    block: &'a mut Block,
    sums: &'a mut Sums,
}

impl NullaryFnOnce for Trace<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { of, block, sums } = self;
        while block.alive > 0 {
            // From the last: packets that move into emptied lanes have had their turn.
            for group in (0..block.alive.div_ceil(LANES)).rev() {
                let any = match &of.jumps {
                    Some(jumps) => block.groups[group].jump_and_hop(jumps),
                    // Without a branch in its loop, which few compilers make vectors of.
                    None if of.phase.is_isotropic() => block.groups[group].turn_and_hop::<true>(of.phase),
                    None => block.groups[group].turn_and_hop::<false>(of.phase),
                };
                if any {
                    block.look_at(of, group, sums);
                }
            }
        }
    }
}

impl Block {
    fn new(of: &HalfSpace, first: u64, end: u64) -> Self {
        let mut block = Self { groups: [Lanes::new(); GROUPS], alive: GROUPS * LANES, next: first, end };
        for lane in (0..GROUPS * LANES).rev() {
            block.refill(of, lane / LANES, lane % LANES);
        }
        block
    }

    /// The next packet into a lane; if there is none, that of the last lane.
    fn refill(&mut self, of: &HalfSpace, group: usize, lane: usize) {
        if self.next < self.end {
            self.groups[group].start(lane, of.request.seed_of(self.next));
            self.groups[group].roulette_at[lane] = of.roulette.first;
            self.groups[group].roulette_below[lane] = DEEP * of.decay;
            self.next += 1;
            return;
        }
        self.alive -= 1;
        let last = self.groups[self.alive / LANES];
        self.groups[group].take(lane, &last, self.alive % LANES);
    }

    /// What happens to packets of a group, that have come to the surface or to roulette.
    #[inline(never)]
    fn look_at(&mut self, of: &HalfSpace, group: usize, sums: &mut Sums) {
        for lane in self.groups[group].flagged(self.alive - group * LANES) {
            let lanes = &mut self.groups[group];
            let mut ended = lanes.position[2][lane] < 0.0 && of.surface(lanes, lane, sums);
            if !ended && lanes.collisions[lane] >= lanes.roulette_at[lane] {
                let Roulette { step, survival, .. } = of.roulette;
                let limit = lanes.roulette_at[lane];
                lanes.roulette_at[lane] = limit.saturating_add(step.unwrap_or(limit)).min(NEVER);
                ended = lanes.play(lane, survival);
            }
            // Jumps weigh what they skip; else weights are those of the number of collisions.
            if !ended && f64::from(lanes.factor[lane]) < of.request.threshold {
                ended = lanes.play(lane, LIGHT);
            }
            // One packet in two survives, each time that it is deeper by what halves diffuse light.
            while !ended && lanes.position[2][lane] > lanes.roulette_below[lane] {
                lanes.roulette_below[lane] += of.decay * std::f32::consts::LN_2;
                ended = lanes.play(lane, 0.5);
            }
            if ended {
                self.refill(of, group, lane);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::monte_carlo::{Axes, Grid, Outcome, Score, Stack, Tally};

    fn request(stack: Stack, packets: u64, seed: u64) -> Request {
        let grid = Grid { dr_mm: 0.25, nr: 24, na: 6, dz_mm: 1.0, nz: 1, dt_ps: 1.0, nt: 1 };
        let leaves = |r, a| Score { quantity: Quantity::Reflected, axes: Axes { r, a, z: false, t: false } };
        let scores = vec![leaves(true, false), leaves(false, true)];
        let source = Source::Pencil { z_mm: 0.0 };
        Request { stack, source, grid, scores, packets, threshold: 1e-4, seed, ballistic_apart: false }
    }

    fn outcome(request: &Request, trace: &dyn Fn(&mut Sums)) -> Outcome {
        let mut sums = Sums::new(request);
        trace(&mut sums);
        sums.packets = request.packets;
        Outcome::new(request, sums, true)
    }

    #[test]
    fn instructions_of_the_processor_change_nothing() {
        for g in [0.0, 0.6] {
            let request = request(Stack::half_space(1.4, 0.3, 3.0, g), 5_000, 1);
            let of = HalfSpace::of(&request).unwrap();
            let end = request.packets;
            let dispatched = outcome(&request, &|sums| of.trace(0, end, sums));
            let baseline =
                outcome(&request, &|sums| Trace { of: &of, block: &mut Block::new(&of, 0, end), sums }.call());
            let halves = outcome(&request, &|sums| {
                [0..1_777, 1_777..end].into_iter().for_each(|part| of.trace(part.start, part.end, sums));
            });
            assert!(dispatched == baseline, "g = {g}: {dispatched:?}, without vectors {baseline:?}");
            assert!(dispatched == halves, "g = {g}: {dispatched:?}, in two batches {halves:?}");
        }
    }

    #[test]
    fn jumps_are_walks_in_one_step() {
        // Albedos 0.5, 0.95, 0.999 and 1, of which the last wander far.
        for (eta, sigma_a, sigma_s, packets) in
            [(1.0, 1.0, 1.0, 400_000), (1.5, 0.1, 1.9, 200_000), (1.3, 0.002, 2.0, 40_000), (1.3, 0.0, 2.0, 4_000)]
        {
            let stack = Stack::half_space(eta, sigma_a, sigma_s, 0.0);
            let (walks, jumps) = (request(stack.clone(), packets, 1), request(stack, 5 * packets, 2));
            let traced = |request, with_jumps| {
                let of = HalfSpace::new(request, with_jumps);
                outcome(request, &|sums| of.trace(0, request.packets, sums))
            };
            let (a, b) = (traced(&walks, false), traced(&jumps, true));
            let z = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]) / a[1].hypot(b[1]).max(1e-9);
            let of_all = [&a, &b].map(|outcome| [outcome.reflected.mean, outcome.reflected.standard_error]);
            let z_of_all = z(of_all[0], of_all[1]);
            assert!(z_of_all.abs() < 4.0, "σ_a = {sigma_a}: {of_all:?}, {z_of_all:.1} σ apart");
            for (walked, jumped) in a.tallies.iter().zip(&b.tallies) {
                let cells =
                    |tally: &Tally, packets| tally.shares(packets).into_iter().zip(tally.standard_errors(packets));
                let pairs = cells(walked, a.packets).zip(cells(jumped, b.packets));
                // χ² of as many degrees of freedom: mean n, standard deviation √(2 n).
                let z2: Vec<f64> = pairs.map(|(a, b)| z([a.0, a.1], [b.0, b.1]).powi(2)).collect();
                let (chi2, n) = (z2.iter().sum::<f64>(), z2.len() as f64);
                assert!(chi2 < n + 4.0 * (2.0 * n).sqrt(), "σ_a = {sigma_a}: χ² is {chi2:.0} in {n} cells");
            }
        }
    }
}
