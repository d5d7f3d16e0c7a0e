//! Monte Carlo of layers against what others found, and against itself.

use subsurf_encoder::simulate::diffusion::Medium;
use subsurf_encoder::simulate::monte_carlo::profile::{Material, Settings};
use subsurf_encoder::simulate::monte_carlo::{
    Axes, Estimate, Grid, Layer, Outcome, Quantity, Request, Score, Source, Stack, mcml,
};

/// Standard errors that an estimate may lie from the truth: one run in sixteen thousand is farther by chance, and seeds are fixed.
const SIGMAS: f64 = 4.0;

const COARSE: Grid = Grid { dr_mm: 0.1, nr: 50, na: 30, dz_mm: 0.1, nz: 40, dt_ps: 0.1, nt: 30 };

fn request(stack: Stack, packets: u64) -> Request {
    let source = Source::Pencil { z_mm: 0.0 };
    Request { stack, source, grid: COARSE, scores: vec![], packets, threshold: 1e-4, seed: 1, ballistic_apart: false }
}

fn slab(eta: f64, [sigma_a, sigma_s, g, thickness_mm]: [f64; 4]) -> Stack {
    Stack { eta_above: 1.0, layers: vec![Layer { eta, sigma_a, sigma_s, g, thickness_mm }], eta_below: 1.0 }
}

#[track_caller]
fn agrees(name: &str, found: Estimate, truth: f64, error_of_truth: f64) {
    let sigma = found.standard_error.hypot(error_of_truth);
    let z = (found.mean - truth) / sigma;
    assert!(z.abs() < SIGMAS, "{name}: {:.6} ± {:.6}, {truth} in print: {z:.1} σ", found.mean, found.standard_error);
    assert!(found.standard_error < 0.01 * found.mean.max(0.1), "{name}: ± {} proves nothing", found.standard_error);
}

/// Energy: what was sent is mirrored, reflected, absorbed or transmitted. Roulette keeps that on average alone.
#[track_caller]
fn is_whole(outcome: &Outcome) {
    let parts = [
        outcome.reflected,
        outcome.transmitted,
        outcome.ballistic_reflected,
        outcome.ballistic_transmitted,
        outcome.absorbed,
    ];
    let sum = outcome.specular + parts.iter().map(|part| part.mean).sum::<f64>();
    assert!((sum - 1.0).abs() < 1e-3, "{sum} of the light was found again");
}

#[test]
fn a_slab_reflects_and_transmits_as_van_de_hulst_has_it() {
    // van de Hulst 1980, as in the manual of MCML, table 6.1: R 0.09739, T 0.66096 with exp(−2) of it unscattered.
    let mut request = request(slab(1.0, [1.0, 9.0, 0.75, 0.2]), 300_000);
    request.ballistic_apart = true;
    let outcome = request.run(&()).unwrap();
    is_whole(&outcome);
    agrees("R", outcome.reflected, 0.09739, 0.0);
    agrees("T", outcome.transmitted, 0.66096 - (-2.0_f64).exp(), 0.0);
    agrees("ballistic T", outcome.ballistic_transmitted, (-2.0_f64).exp(), 0.0);
}

#[test]
fn a_half_space_reflects_as_giovanelli_has_it() {
    // Giovanelli 1955, as in the manual of MCML, table 6.2: R 0.2600 with 0.04 mirrored.
    let outcome = request(Stack::half_space(1.5, 1.0, 9.0, 0.0), 200_000).run(&()).unwrap();
    assert!((outcome.specular - 0.04).abs() < 1e-12, "η = 1.5 mirrors {}", outcome.specular);
    agrees("R", outcome.reflected, 0.22, 5e-5);
}

#[test]
fn what_absorbs_nothing_gives_all_light_back() {
    let outcome = request(Stack::half_space(1.3, 0.0, 10.0, 0.0), 20_000).run(&()).unwrap();
    agrees("R of a half-space", outcome.reflected, 1.0 - outcome.specular, 0.0);
    // Glass: R + T T R + T T R³ .. of its two sides, R = 0.04.
    let outcome = request(slab(1.5, [0.0, 0.0, 0.0, 1.0]), 100_000).run(&()).unwrap();
    is_whole(&outcome);
    agrees("T of glass", outcome.transmitted, 0.96 / 1.04, 0.0);
}

#[test]
fn a_run_that_is_stopped_has_a_result() {
    struct Stopped;
    impl subsurf_encoder::Progress for Stopped {
        fn begin(&self, _: &str, _: u64) {}
        fn advance(&self, _: u64) {}
        fn stopped(&self) -> bool {
            true
        }
    }
    let skin = Medium::measured("skin1").unwrap();
    let settings = Settings { packets: 1_000_000, ..Settings::default() };
    let profiles = Material::half_space(skin, 1.3).simulate(&settings, &Stopped).unwrap();
    for channel in &profiles.channels {
        assert!((1..1_000_000).contains(&channel.packets), "{} packets", channel.packets);
    }
}

#[test]
fn totals_are_those_of_adding_and_doubling() {
    // iadpython 0.5.3 with 24 quadrature angles: albedo, optical thickness, g, η, R with what is mirrored, T with what is
    // unscattered, and the spread between 12 and 24 angles.
    const CASES: [[f64; 7]; 8] = [
        [0.5, 1.0, 0.0, 1.5, 0.08525, 0.37482, 9.2e-4],
        [0.9, 4.0, 0.75, 1.33, 0.11633, 0.30667, 8.3e-4],
        [0.99, 4.0, 0.0, 1.0, 0.64505, 0.27548, 1e-5],
        [0.9, 16.0, 0.0, 1.5, 0.26008, 0.00018, 6e-4],
        [0.99, 16.0, 0.9, 1.5, 0.26674, 0.29826, 6.8e-4],
        [0.5, f64::INFINITY, 0.75, 1.0, 0.01953, 0.0, 2.1e-5],
        [0.9, f64::INFINITY, 0.0, 1.33, 0.29497, 0.0, 4.9e-4],
        [0.99, f64::INFINITY, 0.9, 1.5, 0.26090, 0.0, 6e-4],
    ];
    for [albedo, thickness, g, eta, r, t, spread] in CASES {
        let layer = Layer { eta, sigma_a: 1.0 - albedo, sigma_s: albedo, g, thickness_mm: thickness };
        let eta_below = if thickness.is_finite() { 1.0 } else { eta };
        let outcome = request(Stack { eta_above: 1.0, layers: vec![layer], eta_below }, 40_000).run(&()).unwrap();
        for (name, found, printed) in [("R", outcome.reflected, r - outcome.specular), ("T", outcome.transmitted, t)] {
            // Digits in print end at 10⁻⁵.
            let sigma = found.standard_error.hypot(spread).hypot(1e-5);
            let z = (found.mean - printed) / sigma;
            assert!(z.abs() < SIGMAS, "{name} of {albedo}, {thickness}, {g}, {eta}: {found:?}, {printed} there");
        }
    }
}

#[test]
fn light_of_a_half_space_leaves_as_far_off_as_others_found() {
    // The Virtual Photonics Technology Initiative's R(ρ, t) with 10⁸ photons (μ_s' = 1 mm⁻¹, g = 0.8, n = 1.4), times
    // exp(−μ_a c t / n) for μ_a = 0.01 mm⁻¹ and summed over t and over two rings of 0.2 mm, here as shares of the light.
    const SHARES: [(usize, f64); 3] = [
        (4, 0.022_647_486 * 0.9 + 0.018_367_144 * 1.1),
        (14, 0.004_564_396 * 2.9 + 0.004_013_356 * 3.1),
        (49, 0.000_165_594 * 9.9 + 0.000_153_573 * 10.1),
    ];
    let mut request = request(Stack::half_space(1.4, 0.01, 5.0, 0.8), 30_000);
    request.grid = Grid { dr_mm: 0.2, nr: 200, ..COARSE };
    request.scores = vec![Score { quantity: Quantity::Reflected, axes: Axes { r: true, ..Axes::default() } }];
    let outcome = request.run(&()).unwrap();
    // Of all that leaves, as their table sums to; adding and doubling gives 0.60391.
    let Estimate { mean, standard_error } = outcome.reflected;
    assert!((mean - 0.60377).abs() < SIGMAS * standard_error, "{mean} ± {standard_error}");
    let shares = outcome.tallies[0].shares(outcome.packets);
    let errors = outcome.tallies[0].standard_errors(outcome.packets);
    for (ring, share) in SHARES {
        let share = share * std::f64::consts::TAU * 0.2;
        let (found, error) = (shares[ring] + shares[ring + 1], errors[ring].hypot(errors[ring + 1]));
        assert!((found - share).abs() < SIGMAS * error, "ring {ring}: {found} ± {error}, {share} in theirs");
        assert!(error < 0.15 * share, "± {error} proves nothing");
    }
}

const THREE_LAYERS: &str = "1.0 # version
    1 # runs
    layers.mco A
    150000
    0.01 0.01
    40 50 1

    3
    1.0   # above
    1.37 1 100 0.9 0.1
    1.37 1 10 0 0.1
    1.37 2 10 0.7 0.2
    1.0   # below
";

fn runs(text: &str) -> Result<Vec<mcml::Run>, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mci");
    std::fs::write(&path, text).unwrap();
    mcml::read(&path).map_err(|error| error.to_string().replace(&path.display().to_string(), "run.mci"))
}

/// Values of a block of an `.mco` file: what stands after its name, up to an empty line.
fn block(text: &str, name: &str) -> Vec<f64> {
    let begins = |line: &&str| line.split_once('#').is_some_and(|(before, _)| before.trim() == name);
    let lines = text.lines().skip_while(|line| !begins(line)).skip(1);
    let lines = lines.take_while(|line| !line.trim().is_empty());
    lines
        .flat_map(|line| line.split('#').next().unwrap_or("").split_whitespace())
        .map(|word| word.parse().unwrap())
        .collect()
}

#[test]
fn three_layers_are_as_mcml_has_them() {
    let runs = runs(THREE_LAYERS).unwrap();
    let outcome = runs[0].request.run(&()).unwrap();
    is_whole(&outcome);
    // MCML 2.0 with a million photons of its sample 2 and the standard errors that it states.
    agrees("R", outcome.reflected, 0.237859, 0.000312);
    agrees("A", outcome.absorbed, 0.641547, 0.000293);
    agrees("T", outcome.transmitted, 0.0962212, 0.000186);
    // Absorption by layer in MCML 1.2's sample, printed with four digits.
    for (layer, printed) in outcome.layers.iter().zip([0.2612, 0.1488, 0.2316]) {
        assert!((layer - printed).abs() < 0.003, "{:?}", outcome.layers);
    }

    let text = mcml::write(&runs[0], &outcome);
    let totals = block(&text, "RAT");
    assert!((totals[1] - outcome.reflected.mean).abs() < 1e-6, "{totals:?}");
    // R_d(r) of the same sample in cm⁻², rings 1 to 6; the last ring has what lies beyond.
    let rd = block(&text, "Rd_r");
    assert_eq!(rd.len(), 50, "one value for each ring");
    for (found, printed) in rd[1..7].iter().zip([10.071, 6.1187, 4.4015, 3.5138, 2.8528, 2.4344]) {
        assert!((found / printed - 1.0).abs() < 0.05, "{found} for {printed}");
    }
    let ring = |k: usize| std::f64::consts::TAU * (k as f64 + 0.5) * 1e-4;
    let sum: f64 = rd.iter().enumerate().map(|(k, rd)| rd * ring(k)).sum();
    assert!((sum - outcome.reflected.mean).abs() < 1e-4, "rings hold {sum}");
    assert_eq!(block(&text, "A_rz").len(), 40 * 50, "depths within rings");
}

#[test]
fn names_scores_and_sources_of_version_2_are_read() {
    let text = "mcmli2.0
        air 1.0 0 0 0
        fog 1.2 0.5 20 0.8
        end
        one.mco A
        air
        fog 1E8
        air
        end
        isotropic
        0.05
        0.01 0.02 0.5
        10 20 30 4
        Rd_rt A_z
        1000 10:00
        1E-3
        7
        end";
    let run = &runs(text).unwrap()[0];
    let Request { stack, source, grid, scores, packets, threshold, seed, .. } = &run.request;
    assert_eq!(
        (stack.layers.len(), stack.layers[0].sigma_s, stack.layers[0].thickness_mm),
        (1, 2.0, 1e9),
        "cm became mm"
    );
    assert_eq!((*source, grid.nt, grid.dr_mm), (Source::Isotropic { z_mm: 0.5 }, 30, 0.2), "source and grid");
    assert_eq!((scores.len(), *packets, *threshold, *seed), (3, 1000, 1e-3, 7), "A_z has first collisions beside it");
    let outcome = run.request.run(&()).unwrap();
    is_whole(&outcome);
    let written = mcml::write(run, &outcome);
    assert_eq!(block(&written, "Rd_rt").len(), 20 * 30, "{written}");
    assert_eq!((block(&written, "A_z").len(), block(&written, "Ab_z").len()), (10, 10), "{written}");
}

#[test]
fn mistakes_in_mci_files_are_named_with_their_lines() {
    let refused = |from: &str, to: &str| runs(&THREE_LAYERS.replace(from, to)).unwrap_err();
    assert_eq!(refused("1.0 # version", "2.5"), "run.mci: 2.5 in line 1; expected version 1.0 or mcmli2.0");
    assert_eq!(refused("150000", "many"), "run.mci: many in line 4; expected the number of photons");
    assert_eq!(refused("    1.0   # below\n", ""), "run.mci: its end; expected n of the medium below");
    assert_eq!(refused("1.37 1 10 0 0.1", "1.37 1 10"), "run.mci: the line's end in line 11; expected g of a layer");
    assert_eq!(
        refused("0.7 0.2", "1.5 0.2"),
        "run.mci: run 1: layer 3: mean cosine g is 1.5, allowed is −1 to 1, both excluded"
    );
}

#[test]
fn a_seed_gives_the_same_on_any_number_of_threads() {
    let mut request = request(Stack::half_space(1.3, 0.2, 1.0, 0.5), 20_000);
    let by = |r, a, z| Axes { r, a, z, t: false };
    request.scores = vec![
        Score { quantity: Quantity::Reflected, axes: by(true, true, false) },
        Score { quantity: Quantity::Absorbed, axes: by(true, false, true) },
    ];
    let on = |threads: usize, request: &Request| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| request.run(&()).unwrap())
    };
    let one = on(1, &request);
    assert!(one == on(2, &request) && one == on(8, &request), "sums hang on the number of threads");
    // Side by side, by turns and by jumps.
    for g in [0.5, 0.0] {
        let mut request = Request { stack: Stack::half_space(1.3, 0.2, 1.0, g), ..request.clone() };
        request.scores.truncate(1);
        let one = on(1, &request);
        assert!(one == on(2, &request) && one == on(8, &request), "g = {g}: sums hang on the number of threads");
    }
    request.seed = 2;
    assert!(one.reflected != on(1, &request).reflected, "another seed is another result");
}

#[test]
fn profiles_have_the_grid_of_the_paper_and_all_light() {
    let marble = Medium::measured("marble").unwrap();
    let settings = Settings { packets: 3_000, ..Settings::default() };
    let profiles = Material::half_space(marble, 1.5).simulate(&settings, &()).unwrap();
    // d_r = min MFP / 20 is blue's, and 32 max MFP red's.
    assert!((profiles.dr_mm - 1.0 / 3.0071 / 20.0).abs() < 1e-9, "rings are {} mm wide", profiles.dr_mm);
    assert_eq!(profiles.channels[0].rd.len() as f64, (32.0 / 2.1921 / profiles.dr_mm).ceil(), "rings");
    for channel in &profiles.channels {
        let ring = |k: usize| std::f64::consts::TAU * (k as f64 + 0.5) * profiles.dr_mm.powi(2);
        let sum: f64 = channel.rd.iter().enumerate().map(|(k, rd)| rd * ring(k)).sum::<f64>() + channel.beyond;
        assert!((sum - channel.reflected.mean).abs() < 1e-9, "rings hold {sum} of {}", channel.reflected.mean);
    }
    let csv = tempfile::NamedTempFile::new().unwrap();
    profiles.write_csv(csv.path()).unwrap();
    let text = std::fs::read_to_string(csv.path()).unwrap();
    assert_eq!(text.lines().filter(|line| !line.starts_with('#')).count(), 1 + profiles.channels[0].rd.len(), "lines");
}

#[test]
fn packets_side_by_side_do_what_single_ones_do() {
    for (stack, packets) in [
        (Stack::half_space(1.5, 0.1, 2.0, 0.0), 200_000),
        (Stack::half_space(1.3, 0.02, 10.0, 0.9), 60_000),
        (Stack::half_space(1.0, 1.0, 0.5, -0.5), 200_000),
    ] {
        let mut request = request(stack, packets);
        request.grid = Grid { dr_mm: 0.25, nr: 24, na: 6, ..COARSE };
        let leaves = |r, a| Score { quantity: Quantity::Reflected, axes: Axes { r, a, ..Axes::default() } };
        request.scores = vec![leaves(true, false), leaves(false, true)];
        let lanes = request.run(&()).unwrap();
        // What is absorbed is only counted packet by packet.
        request.scores.push(Score { quantity: Quantity::Absorbed, axes: Axes { z: true, ..Axes::default() } });
        (request.packets, request.seed) = (packets / 10, 2);
        let single = request.run(&()).unwrap();
        is_whole(&single);

        let sigma = lanes.reflected.standard_error.hypot(single.reflected.standard_error);
        let z = (lanes.reflected.mean - single.reflected.mean) / sigma;
        assert!(z.abs() < SIGMAS, "{:?} and {:?}: {z:.1} σ", lanes.reflected, single.reflected);
        for (a, b) in lanes.tallies.iter().zip(&single.tallies) {
            let cells = a.shares(lanes.packets).len();
            let [shares, others] = [a.shares(lanes.packets), b.shares(single.packets)];
            let [errors, more] = [a.standard_errors(lanes.packets), b.standard_errors(single.packets)];
            let z = (0..cells).map(|k| (shares[k] - others[k]) / errors[k].hypot(more[k]).max(1e-9));
            // χ² of as many degrees of freedom: mean n, standard deviation √(2 n).
            let (chi2, n) = (z.map(|z| z * z).sum::<f64>(), cells as f64);
            assert!(chi2 < n + SIGMAS * (2.0 * n).sqrt(), "{:?}: χ² is {chi2:.0} in {n} cells", a.score);
        }
    }
}
