//! Photon packets of the light on one pixel of a heterogeneous slab, many side by side.

use pulp::NullaryFnOnce;

use super::lanes::{LANES, Lanes, NEVER};
use super::roulette::{EVENTS, LATE, LIGHT};
use super::voxel_lanes::Columns;
use crate::simulate::diffusion::{Medium, Slab};
use crate::simulate::fresnel;

/// Weight below which a packet plays roulette, as in MCML.
const THRESHOLD: f64 = 1e-4;
/// Columns reach beyond the window by this many thicknesses; beyond that, the last ones go on.
const MARGIN: f64 = 1.5;
/// Depth below which packets play roulette, in decay lengths of diffuse light.
const DEEP: f64 = 2.0;
/// Groups of lanes that move in turns.
const GROUPS: usize = 4;

pub(super) fn signed(k: usize) -> i32 {
    i32::try_from(k).expect("windows are small")
}

/// Weight that left the upper face.
pub(super) struct Traced {
    /// By pixel of the window.
    pub(super) window: Vec<f64>,
    /// Beyond the window.
    pub(super) outside: f64,
}

/// Light on one pixel, in one channel.
pub(super) struct Beam {
    columns: Columns,
    radius: usize,
    eta: f64,
    /// Decay length of diffuse light in the medium where it is longest, in mean free paths.
    decay: f32,
    /// Seed of the packet 0.
    seed: u64,
    light: Light,
}

/// How light comes to a pixel.
#[derive(Clone, Copy)]
enum Light {
    /// Straight down, as much as enters.
    Beam,
    /// From all sides alike, refracted by Fresnel: what is exactly the same in both directions of a pair.
    #[cfg(test)]
    Diffuse,
}

impl Beam {
    pub(super) fn new(slab: &Slab<'_>, seed: u64, pixel: usize, c: usize) -> Self {
        let [width, height] = slab.map.size;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates, and is limited")]
        let margin = (MARGIN * slab.thickness_mm / slab.pitch_mm).ceil().min(512.0) as usize;
        let reach = slab.radius + margin;
        let at = |from: usize, step: usize, n: usize| {
            let n = u32::try_from(n).expect("a side is below 65,536");
            slab.addressing.map(signed(from) + signed(step) - signed(reach), n) as usize
        };
        let side = 2 * reach + 1;
        let xs: Vec<usize> = (0..side).map(|k| at(pixel % width, k, width)).collect();
        let ys: Vec<usize> = (0..side).map(|k| at(pixel / width, k, height)).collect();
        let around = || ys.iter().flat_map(|y| xs.iter().map(move |x| slab.map.media[y * width + x]));
        let sigma_t = |medium: &Medium| medium.sigma_s[c] + medium.sigma_a[c];
        let largest = around().map(|medium| sigma_t(&medium)).fold(f64::MIN_POSITIVE, f64::max);
        let decay_mm = around().map(|medium| medium.decay_length_mm(c)).fold(0.0, f64::max);
        #[allow(clippy::cast_possible_truncation, reason = "lanes are of single precision")]
        let single = |x: f64| x as f32;
        let media = around().map(|medium| {
            let sigma_t = sigma_t(&medium);
            let albedo = if sigma_t > 0.0 { medium.sigma_s[c] / sigma_t } else { 1.0 };
            [single(sigma_t / largest), single(albedo)]
        });
        #[allow(clippy::cast_precision_loss, reason = "columns are few")]
        let origin = reach as f32;
        let columns = Columns {
            media: media.collect(),
            side,
            columns_per_path: single(1.0 / (slab.pitch_mm * largest)),
            origin,
            thickness: single(slab.thickness_mm * largest),
            light: single(THRESHOLD),
        };
        // Seeds of packets follow each other; those of pixels and channels are far apart, by other multipliers than the mixers have.
        let seed = seed.wrapping_mul(0xd134_2543_de82_ef95).wrapping_add(((pixel * 3 + c) as u64) << 32);
        Self {
            columns,
            radius: slab.radius,
            eta: slab.eta,
            decay: single((decay_mm * largest).clamp(1.0, 1e6)),
            seed,
            light: Light::Beam,
        }
    }

    /// Traces the packets from `first` to before `end`.
    pub(super) fn trace(&self, first: u64, end: u64) -> Traced {
        let mut block = self.block(first, end);
        pulp::Arch::new().dispatch(Trace { beam: self, block: &mut block });
        block.traced
    }

    fn block(&self, first: u64, end: u64) -> Block {
        let d = 2 * self.radius + 1;
        let traced = Traced { window: vec![0.0; d * d], outside: 0.0 };
        let mut block = Block { groups: [Lanes::new(); GROUPS], alive: GROUPS * LANES, next: first, end, traced };
        for lane in (0..GROUPS * LANES).rev() {
            block.refill(self, lane / LANES, lane % LANES);
        }
        block
    }

    /// A packet that enters the slab and comes to its first collision, or beyond the lower face; whether it enters.
    fn start(&self, lanes: &mut Lanes, lane: usize, packet: u64) -> bool {
        lanes.start(lane, self.seed.wrapping_add(packet));
        for axis in 0..2 {
            lanes.position[axis][lane] = lanes.uniform(lane) / self.columns.columns_per_path;
        }
        #[allow(clippy::cast_possible_truncation, reason = "lanes are of single precision")]
        let deep = DEEP as f32;
        lanes.roulette_at[lane] = EVENTS;
        lanes.roulette_below[lane] = deep * self.decay;
        match self.light {
            Light::Beam => true,
            #[cfg(test)]
            Light::Diffuse => self.refract(lanes, lane),
        }
    }

    /// Turns a packet that enters straight down by a random angle; whether it is not mirrored.
    #[cfg(test)]
    fn refract(&self, lanes: &mut Lanes, lane: usize) -> bool {
        let sin2 = f64::from(lanes.uniform(lane));
        let (sine, cosine) = (sin2.sqrt() / self.eta, (1.0 - sin2 / self.eta.powi(2)).sqrt());
        let phi = std::f64::consts::TAU * f64::from(lanes.uniform(lane));
        let s = lanes.position[2][lane];
        for (axis, u) in [sine * phi.cos(), sine * phi.sin(), cosine].into_iter().enumerate() {
            #[allow(clippy::cast_possible_truncation, reason = "lanes are of single precision")]
            let u = u as f32;
            lanes.direction[axis][lane] = u;
            lanes.position[axis][lane] = s * u + if axis < 2 { lanes.position[axis][lane] } else { 0.0 };
        }
        f64::from(lanes.uniform(lane)) >= fresnel::reflectance(1.0 / self.eta, (1.0 - sin2).sqrt())
    }

    /// Takes a packet that hopped beyond a face back to it, until it is within or leaves. Whether it left.
    fn faces(&self, lanes: &mut Lanes, lane: usize, traced: &mut Traced) -> bool {
        loop {
            let [x, y, z] = [0, 1, 2].map(|axis| lanes.position[axis][lane]);
            let [ux, uy, uz] = [0, 1, 2].map(|axis| lanes.direction[axis][lane]);
            let thickness = self.columns.thickness;
            if (0.0..=thickness).contains(&z) {
                return false;
            }
            let face = if z < 0.0 { 0.0 } else { thickness };
            let cosine = f64::from(uz.abs()).min(1.0);
            let reflected = fresnel::reflectance(self.eta, cosine);
            let is_reflected = f64::from(lanes.uniform(lane)) < reflected;
            if reflected >= 1.0 {
                // Beyond the critical angle the rest of the hop goes to and fro at once: slabs may be much thinner than it.
                let unfolded = z.rem_euclid(2.0 * thickness);
                let is_back = unfolded > thickness;
                lanes.position[2][lane] = if is_back { 2.0 * thickness - unfolded } else { unfolded };
                lanes.direction[2][lane] = if is_back { -uz } else { uz };
                return false;
            }
            if is_reflected {
                // The rest of the hop, mirrored.
                lanes.position[2][lane] = 2.0 * face - z;
                lanes.direction[2][lane] = -uz;
                continue;
            }
            if z < 0.0 {
                // Back along the hop, by as much as it went too far.
                let back = z / uz;
                let pixel = [x - back * ux, y - back * uy].map(|x| (x * self.columns.columns_per_path).floor());
                traced.leave(self.radius, pixel, lanes.factor[lane].into());
            }
            return true;
        }
    }
}

impl Traced {
    /// Counts a packet that leaves at a pixel, by its steps from the lit one.
    fn leave(&mut self, radius: usize, steps: [f32; 2], weight: f64) {
        #[allow(clippy::cast_precision_loss, reason = "windows are small")]
        let places = steps.map(|step| step + radius as f32);
        let d = 2 * radius + 1;
        #[allow(clippy::cast_precision_loss, reason = "windows are small")]
        let within = places.iter().all(|place| (0.0..d as f32).contains(place));
        if within {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to D")]
            let [x, y] = places.map(|place| place as usize);
            self.window[x + y * d] += weight;
        } else {
            self.outside += weight;
        }
    }
}

/// Packets side by side, and those that wait for a lane.
struct Block {
    groups: [Lanes; GROUPS],
    /// Lanes with packets: the first ones.
    alive: usize,
    next: u64,
    end: u64,
    traced: Traced,
}

/// Traces the packets of a block until none is left: compiled for each set of vector instructions.
struct Trace<'a> {
    beam: &'a Beam,
    block: &'a mut Block,
}

impl NullaryFnOnce for Trace<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { beam, block } = self;
        while block.alive > 0 {
            // From the last: packets that move into emptied lanes have had their turn.
            for group in (0..block.alive.div_ceil(LANES)).rev() {
                if block.groups[group].collide_and_hop(&beam.columns) {
                    block.look_at(beam, group);
                }
            }
        }
    }
}

impl Block {
    /// The next packet that comes to a collision into a lane; if there is none, that of the last lane.
    fn refill(&mut self, beam: &Beam, group: usize, lane: usize) {
        while self.next < self.end {
            let lanes = &mut self.groups[group];
            let enters = beam.start(lanes, lane, self.next);
            self.next += 1;
            if enters && !beam.faces(lanes, lane, &mut self.traced) {
                return;
            }
        }
        self.alive -= 1;
        let last = self.groups[self.alive / LANES];
        self.groups[group].take(lane, &last, self.alive % LANES);
    }

    /// What happens to packets of a group that have come beyond a face or to roulette.
    #[inline(never)]
    fn look_at(&mut self, beam: &Beam, group: usize) {
        for lane in self.groups[group].flagged(self.alive - group * LANES) {
            let lanes = &mut self.groups[group];
            let mut ended = beam.faces(lanes, lane, &mut self.traced);
            if !ended && lanes.collisions[lane] >= lanes.roulette_at[lane] {
                lanes.roulette_at[lane] = lanes.roulette_at[lane].saturating_mul(2).min(NEVER);
                ended = lanes.play(lane, LATE);
            }
            if !ended && f64::from(lanes.factor[lane]) < THRESHOLD {
                ended = lanes.play(lane, LIGHT);
            }
            // One packet in two survives, each time that it is deeper by what halves diffuse light.
            while !ended && lanes.position[2][lane] > lanes.roulette_below[lane] {
                lanes.roulette_below[lane] += beam.decay * std::f32::consts::LN_2;
                ended = lanes.play(lane, 0.5);
            }
            if ended {
                self.refill(beam, group, lane);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use subsurf_decoder::bssrdf::Addressing;

    use super::*;
    use crate::simulate::diffusion::MediumMap;
    use crate::simulate::monte_carlo::{Axes, Grid, Quantity, Request, Score, Source, Stack};

    /// Runs with seeds of their own, of which means and standard errors are taken.
    const RUNS: u64 = 16;
    /// Standard errors, of 16 runs, that means may be apart: beyond this is one pair in three thousand by chance; seeds are fixed.
    const SIGMAS: f64 = 4.5;

    fn slab(map: &MediumMap, radius: usize) -> Slab<'_> {
        Slab { map, addressing: Addressing::Clamp, pitch_mm: 0.5, radius, thickness_mm: 30.0, eta: 1.4, refine: 1.0 }
    }

    /// Mean and standard error of a value over runs.
    fn estimate(values: &[f64]) -> [f64; 2] {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let square = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (n - 1.0);
        [mean, (square / n).sqrt()]
    }

    #[test]
    fn uniform_voxels_are_a_half_space() {
        let medium = Medium { sigma_s: [2.0, 1.0, 3.0], sigma_a: [0.1, 0.3, 0.03] };
        // Voxels of less extinction around, beyond what light of the middle reaches but by 10⁻⁴, so that most collisions are none.
        let rest = Medium { sigma_s: [8.0; 3], sigma_a: [0.0; 3] };
        const SIDE: usize = 41;
        let far = |k: usize| [k % SIDE, k / SIDE].iter().any(|at| !(1..SIDE - 1).contains(at));
        let media = (0..SIDE * SIDE).map(|k| if far(k) { rest } else { medium }).collect();
        let map = MediumMap { size: [SIDE, SIDE], media };
        let slab = slab(&map, 3);
        for c in 0..3 {
            let runs = (0..RUNS).map(|seed| Beam::new(&slab, seed, SIDE * SIDE / 2, c).trace(0, 3_000).window);
            let runs: Vec<Vec<f64>> = runs.map(|window| window.iter().map(|sum| sum / 3_000.0).collect()).collect();

            let stack = Stack::half_space(1.4, medium.sigma_a[c], medium.sigma_s[c], 0.0);
            let entering = 1.0 - stack.specular();
            let score = Score { quantity: Quantity::Reflected, axes: Axes { r: true, ..Axes::default() } };
            let grid = Grid { dr_mm: 0.02, nr: 200, na: 1, dz_mm: 1.0, nz: 1, dt_ps: 1.0, nt: 1 };
            let source = Source::Pencil { z_mm: 0.0 };
            let (scores, packets) = (vec![score], 400_000);
            let request =
                Request { stack, source, grid, scores, packets, threshold: 1e-4, seed: 7, ballistic_apart: false };
            let rd = request.run(&()).unwrap().tallies[0].densities(packets);
            // Mean over all ways from the lit pixel to one dx, dy pixels away.
            let of_pixels = |dx: f64, dy: f64| {
                let mut sum = 0.0;
                for k in 0..4_096_u32 {
                    let at = |digit: u32| 0.5 * (f64::from(k / 8_u32.pow(digit) % 8) + 0.5) / 8.0;
                    let r = (0.5 * dx + at(0) - at(1)).hypot(0.5 * dy + at(2) - at(3));
                    #[allow(clippy::cast_possible_truncation, reason = "rings are few")]
                    let ring = (r / 0.02) as usize;
                    sum += rd[ring] / entering;
                }
                0.25 * sum / 4_096.0
            };
            for (dx, dy) in [(1_usize, 0_usize), (1, 1), (2, 0), (3, 1), (3, 3)] {
                let symmetric = [(dx, dy), (dy, dx)].into_iter().flat_map(|(x, y)| {
                    [(3 + x, 3 + y), (3 - x, 3 + y), (3 + x, 3 - y), (3 - x, 3 - y)].map(|(x, y)| x + 7 * y)
                });
                let places: Vec<usize> = symmetric.collect();
                let mean = |window: &Vec<f64>| places.iter().map(|at| window[*at]).sum::<f64>() / 8.0;
                let [found, error] = estimate(&runs.iter().map(mean).collect::<Vec<f64>>());
                let truth = of_pixels(dx as f64, dy as f64);
                // The half-space's own error, and the rule's: below half a percent.
                let z = (found - truth) / error.hypot(0.005 * truth);
                assert!(z.abs() < SIGMAS, "channel {c}, {dx}, {dy}: {found} ± {error}, a half-space has {truth}");
                assert!(error < 0.1 * truth, "± {error} of {truth} proves nothing");
            }
        }
    }

    #[test]
    fn diffuse_light_takes_as_much_one_way_as_the_other() {
        let dark = Medium { sigma_s: [1.0; 3], sigma_a: [0.5; 3] };
        let bright = Medium { sigma_s: [4.0; 3], sigma_a: [0.01; 3] };
        let map = MediumMap { size: [4, 1], media: vec![dark, dark, bright, bright] };
        let slab = slab(&map, 3);
        let runs = |from: usize, light: Light| {
            let window = move |seed| Beam { light, ..Beam::new(&slab, seed, from, 0) }.trace(0, 6_000).window;
            (0..RUNS).map(window).collect::<Vec<Vec<f64>>>()
        };
        let z = |light: Light, a: usize, b: usize| {
            let at = |from: usize, to: usize| 3 * 7 + 3 + to - from;
            let way = |from: usize, to: usize| {
                estimate(&runs(from, light).iter().map(|window| window[at(from, to)]).collect::<Vec<f64>>())
            };
            let ([there, there_error], [back, back_error]) = (way(a, b), way(b, a));
            (there - back) / there_error.hypot(back_error)
        };
        for (a, b) in [(1, 2), (0, 2), (0, 3)] {
            let z = z(Light::Diffuse, a, b);
            assert!(z.abs() < SIGMAS, "pixels {a} and {b}: {z:.1} σ apart");
        }
        // A beam is not: the test can tell.
        let z = z(Light::Beam, 1, 2);
        assert!(z.abs() > SIGMAS, "a beam goes both ways alike: {z:.1} σ");
    }

    #[test]
    fn instructions_change_nothing() {
        let media = ["skin1", "marble"].map(|name| Medium::measured(name).unwrap());
        let map = MediumMap { size: [2, 1], media: media.into() };
        let slab = Slab { thickness_mm: 1.0, ..slab(&map, 2) };
        let beam = Beam::new(&slab, 1, 0, 0);
        let mut block = beam.block(0, 2_000);
        Trace { beam: &beam, block: &mut block }.call();
        assert!(beam.trace(0, 2_000).window == block.traced.window, "captures hang on vector instructions");
    }
}
