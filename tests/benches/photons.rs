//! Photon packets a second on one core, of profiles by Monte Carlo: `cargo bench -p subsurf-tests --bench photons`.
//!
//! The three channels of eight measured materials as half-spaces, R_d(r) alone: packets side by side, and one by one as layers
//! are traced. Pairs of runs of one kind are comparable, since machines are not.

use divan::Bencher;
use divan::counter::ItemsCount;
use subsurf_encoder::simulate::diffusion::Medium;
use subsurf_encoder::simulate::monte_carlo::{Axes, Grid, Quantity, Request, Score, Source, Stack};

fn main() {
    divan::main();
}

const MATERIALS: [&str; 8] = ["apple", "chicken1", "cream", "ketchup", "marble", "skin1", "skin2", "wholemilk"];

fn requests(g: f64, packets: u64, scores: &[Score]) -> Vec<Request> {
    let of_channel = |name: &'static str, c: usize| {
        let medium = Medium::measured(name).expect("a name of the list");
        let [absorption, scattering] = [medium.sigma_a[c], medium.sigma_s[c] / (1.0 - g)];
        let stack = Stack::half_space(Medium::measured_eta(name), absorption, scattering, g);
        let dr_mm = medium.mean_free_path_mm(c) / 20.0;
        Request {
            stack,
            source: Source::Pencil { z_mm: 0.0 },
            grid: Grid { dr_mm, nr: 640, na: 1, dz_mm: 1.0, nz: 1, dt_ps: 1.0, nt: 1 },
            scores: scores.to_vec(),
            packets,
            threshold: 1e-4,
            seed: 1,
            ballistic_apart: false,
        }
    };
    MATERIALS.iter().flat_map(|name| (0..3).map(move |c| of_channel(name, c))).collect()
}

fn trace(bencher: Bencher, requests: &[Request]) {
    let one_core = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let packets: u64 = requests.iter().map(|request| request.packets).sum();
    bencher.counter(ItemsCount::new(packets)).bench_local(|| {
        one_core.install(|| requests.iter().map(|request| request.run(&()).expect("a run").reflected.mean).sum::<f64>())
    });
}

const RADII: Score = Score { quantity: Quantity::Reflected, axes: Axes { r: true, a: false, z: false, t: false } };
const DEPTHS: Score = Score { quantity: Quantity::Absorbed, axes: Axes { r: false, a: false, z: true, t: false } };

/// By jumps where g is 0, by turns where it is not.
#[divan::bench(args = [0.0, 1e-6, 0.9], sample_count = 5, sample_size = 1)]
fn side_by_side(bencher: Bencher, g: f64) {
    trace(
        bencher,
        &requests(
            g,
            if g == 0.0 {
                200_000
            } else if g < 0.9 {
                20_000
            } else {
                4_000
            },
            &[RADII],
        ),
    );
}

/// What is absorbed by depth is counted one by one.
#[divan::bench(args = [0.0, 0.9], sample_count = 5, sample_size = 1)]
fn one_by_one(bencher: Bencher, g: f64) {
    trace(bencher, &requests(g, if g == 0.0 { 1_000 } else { 200 }, &[RADII, DEPTHS]));
}
