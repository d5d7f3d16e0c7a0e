//! The simulator against closed forms, against Monte Carlo, and against itself on finer grids.

use subsurf_decoder::bssrdf::Addressing;
use subsurf_encoder::Progress;
use subsurf_encoder::capture::{Capture, CaptureWriter, Overrides, Scalar, Sidecar};
use subsurf_encoder::simulate::diffusion::analytic::HalfSpace;
use subsurf_encoder::simulate::diffusion::medium::reduced_albedo_to_diffuse;
use subsurf_encoder::simulate::diffusion::{
    BuiltinMaterial, Finish, Medium, MediumMap, Method, Request, Sensor, Slab, Summary, simulate,
};

fn homogeneous(medium: Medium) -> MediumMap {
    MediumMap { size: [1, 1], media: vec![medium] }
}

fn slab(map: &MediumMap, radius: usize, refine: f64) -> Slab<'_> {
    Slab { map, addressing: Addressing::Repeat, pitch_mm: 0.5, radius, thickness_mm: 40.0, eta: 1.4, refine }
}

fn measure(slab: &Slab<'_>) -> (Vec<f32>, f64) {
    let mut out = Vec::new();
    let share = slab.measure::<std::convert::Infallible>(&(), |rows| {
        out.extend_from_slice(rows);
        Ok(())
    });
    let Ok(share) = share;
    (out, share)
}

/// Places of one octant of a window, from its middle: the others are its reflections.
fn octant(radius: usize) -> impl Iterator<Item = [usize; 2]> {
    (0..=radius).flat_map(|dx| (0..=dx).map(move |dy| [dx, dy]))
}

/// Rd of the closed form at every place of an octant.
fn closed_form(medium: Medium, radius: usize, c: usize) -> Vec<f64> {
    let half_space = HalfSpace { sigma_s: medium.sigma_s[c], sigma_a: medium.sigma_a[c], eta: 1.4 };
    octant(radius).map(|[dx, dy]| half_space.pixel_rd(dx as f64, dy as f64, 0.5)).collect()
}

/// Relative error of a homogeneous window at every place of an octant, in channel `c`.
fn errors(window: &[f32], exact: &[f64], radius: usize, c: usize) -> Vec<f64> {
    let d = 2 * radius + 1;
    let found = octant(radius).map(|[dx, dy]| f64::from(window[((dy + radius) * d + dx + radius) * 3 + c]));
    found.zip(exact).map(|(found, exact)| found / exact - 1.0).collect()
}

fn root_mean_square(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

#[test]
fn converges_to_the_closed_form() {
    // Usual grid: no entry off by more than 4 %; twice as fine: half the error at most.
    let marble = Medium::measured("marble").unwrap();
    let map = homogeneous(marble);
    let windows = [1.0, 2.0].map(|refine| measure(&slab(&map, 6, refine)).0);
    for c in [0, 2] {
        let exact = closed_form(marble, 6, c);
        let [usual, fine] = windows.each_ref().map(|window| errors(window, &exact, 6, c));
        let largest = usual.iter().fold(0.0_f64, |largest, error| largest.max(error.abs()));
        assert!(largest < 0.04, "channel {c}: {usual:.3?}");
        let (usual, fine) = (root_mean_square(&usual), root_mean_square(&fine));
        println!("marble, channel {c}: RMS error {:.2} %, twice as fine {:.2} %", 100.0 * usual, 100.0 * fine);
        assert!(fine < 0.5 * usual, "channel {c}: {usual} -> {fine}");
    }
}

#[test]
fn converges_where_media_meet() {
    // A pixel of each of two neighbouring squares of the chessboard, in turns; no closed form: the usual grid against twice and four
    // times as fine.
    let board = BuiltinMaterial::Chessboard.map([64, 64], Addressing::Repeat, 1);
    let cut = |x: usize| board.media[8 * 64 + x];
    let map = MediumMap { size: [2, 1], media: (10..12).map(cut).collect() };
    assert!(map.media[1].sigma_a[2] > 5.0 * map.media[0].sigma_a[2], "a white square and a dark one: {:?}", map.media);
    let at = |refine| measure(&slab(&map, 4, refine)).0;
    let finest = at(4.0);
    let error = |coarse: &[f32]| {
        let logs = coarse.iter().zip(&finest).map(|(a, b)| f64::from((a / b).ln()));
        root_mean_square(&logs.collect::<Vec<f64>>())
    };
    let (usual, fine) = (error(&at(1.0)), error(&at(2.0)));
    println!("chessboard: RMS log error {usual:.4}, twice as fine {fine:.4}");
    assert!(usual < 0.02, "{usual}");
    assert!(fine < 0.6 * usual, "{usual} -> {fine}");
}

/// Rd(r) of the closed form by Hankel transform, (2π)⁻¹ ∫ Rd(k) J₀(k r) k dk, tapered beyond 25 rad/mm.
fn point_rd(medium: &HalfSpace, r_mm: f64) -> f64 {
    let step = 1e-3;
    let terms = (0..60_000).map(|n| {
        let k = (f64::from(n) + 0.5) * step;
        medium.spectrum(k) * libm::j0(k * r_mm) * k * (-(k / 25.0).powi(2)).exp()
    });
    terms.sum::<f64>() * step / std::f64::consts::TAU
}

#[test]
fn closed_form_is_near_monte_carlo() {
    // Virtual Tissue Simulator (VirtualPhotonics/VTS), ROfRhoAndTime: 10⁸ photons, σ_s' = 1/mm, g = 0.8, n = 1.4, no
    // absorption; weighted by exp(−σ_a c t / n) with σ_a = 0.01/mm and summed over time. r in mm, Rd in mm⁻².
    let medium = HalfSpace { sigma_s: 1.0, sigma_a: 0.01, eta: 1.4 };
    for (r_mm, monte_carlo, tolerance) in [
        // Within about a mean free path (1 mm) diffusion is known to be too high.
        (0.5, 0.038_807_3, 0.26),
        (1.1, 0.018_367_1, 0.15),
        (2.1, 0.007_956_73, 0.02),
        (3.1, 0.004_013_36, 0.05),
        (5.1, 0.001_295_93, 0.06),
        (10.1, 0.000_153_573, 0.04),
    ] {
        let error = point_rd(&medium, r_mm) / monte_carlo - 1.0;
        println!("r = {r_mm} mm: {:+.1} % from Monte Carlo", 100.0 * error);
        assert!(error.abs() < tolerance, "r = {r_mm} mm: {error:+.3}");
    }
    // All of it: 0.603 775 by the same data.
    let albedo = reduced_albedo_to_diffuse(1.0 / 1.01, 1.4);
    assert!((albedo / 0.603_775 - 1.0).abs() < 0.025, "total {albedo}");
}

#[test]
fn closed_form_is_near_other_diffusion_solutions() {
    // VTS, ValidateDiffusionReflectanceModelsTests: distributed source, σ_a = 0.01, σ_s' = 1/mm, n = 1.4. It uses an
    // extrapolated boundary and another internal-reflection fit; ours is the partial-current boundary itself.
    let medium = HalfSpace { sigma_s: 1.0, sigma_a: 0.01, eta: 1.4 };
    for (r_mm, vts, tolerance) in [(1.0, 0.020_915_5, 0.13), (3.0, 0.004_056_28, 0.03), (10.0, 0.000_161_842, 0.05)] {
        let error = point_rd(&medium, r_mm) / vts - 1.0;
        println!("r = {r_mm} mm: {:+.1} % from VTS's distributed source", 100.0 * error);
        assert!(error.abs() < tolerance, "r = {r_mm} mm: {error:+.3}");
    }
    // The dipole puts all light at one depth: off by some 20 % at a few mean free paths, right far away.
    for (r_mm, tolerance) in [(3.0, 0.2), (10.0, 0.05), (20.0, 0.05)] {
        let error = medium.dipole_rd(r_mm) / point_rd(&medium, r_mm) - 1.0;
        println!("r = {r_mm} mm: dipole {:+.1} % from the closed form", 100.0 * error);
        assert!(error.abs() < tolerance, "r = {r_mm} mm: {error:+.3}");
    }
}

#[test]
fn inverted_albedos_come_back_from_the_simulation() {
    let albedo = [0.8, 0.5, 0.2];
    let medium = Medium::from_albedo(albedo, [2.0, 1.5, 1.0], 1.4);
    let map = homogeneous(medium);
    let (window, share) = measure(&slab(&map, 8, 1.0));
    for c in 0..3 {
        assert!((medium.decay_length_mm(c) - [2.0, 1.5, 1.0][c]).abs() < 1e-9, "{medium:?}");
    }
    // The window holds `share` of all light; put the rest back.
    let total: f64 = window.iter().map(|&rd| f64::from(rd) * 0.25).sum::<f64>() / share;
    let expected: f64 = albedo.iter().sum();
    println!("albedos {expected} came back as {total:.4}, window share {share:.3}");
    assert!((total / expected - 1.0).abs() < 0.02, "{total} is not {expected}");
}

#[test]
fn albedo_stays_physical() {
    // No absorption: what is not reflected leaves through the bottom or beyond the window.
    let spectralon = Medium::measured("spectralon").unwrap();
    let map = homogeneous(spectralon);
    let (window, share) = measure(&slab(&map, 8, 1.0));
    for c in 0..3 {
        let albedo: f64 = window.iter().skip(c).step_by(3).map(|&rd| f64::from(rd) * 0.25).sum();
        assert!((0.9..=1.0).contains(&albedo), "channel {c}: {albedo}");
    }
    assert!((0.9..=1.0).contains(&share), "{share}");
}

#[test]
fn a_patch_that_clamps_ends_at_its_border() {
    let map = BuiltinMaterial::Jade.map([3, 2], Addressing::Clamp, 1);
    let slab = Slab { addressing: Addressing::Clamp, ..slab(&map, 2, 1.0) };
    let (entries, _) = measure(&slab);
    for (k, entry) in entries.chunks(3).enumerate() {
        let (pixel, place) = (k / 25, k % 25);
        let target = [pixel % 3 + place % 5, pixel / 3 + place / 5];
        let inside = (2..5).contains(&target[0]) && (2..4).contains(&target[1]);
        assert_eq!(entry.iter().all(|rd| rd.is_finite() && *rd > 0.0), inside, "{pixel} {place}");
    }
}

/// Simulates into a file and reads all windows back; what was not measured is 0.
fn simulated(slab: &Slab<'_>, finish: &Finish) -> (Vec<f32>, Summary) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("capture.npy");
    let sidecar = Sidecar { pitch_mm: 0.5, addressing: slab.addressing, eta: 1.4, simulated: None };
    let (size, radius) = (slab.map.size, slab.radius);
    let writer = CaptureWriter { path: &path, size, radius, scalar: Scalar::F32, sidecar: &sidecar };
    let summary = simulate(slab, finish, &writer, &()).unwrap();
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2, "array and sidecar, nothing else");
    let capture = Capture::open(&path, &Overrides::default()).unwrap();
    let mut entries = vec![0.0; capture.pixels() * capture.window_len()];
    for (pixel, window) in entries.chunks_mut(capture.window_len()).enumerate() {
        capture.read_window(pixel, window);
    }
    (entries, summary)
}

/// Rd of a homogeneous medium by distance from the lit pixel in pixels, and what the sidecar says.
fn by_distance(method: Method, progress: &dyn Progress) -> (Vec<f64>, serde_json::Value) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("capture.npy");
    let map = homogeneous(Medium::measured("marble").unwrap());
    let request = Request {
        method,
        map: &map,
        source: serde_json::json!({}),
        addressing: Addressing::Repeat,
        pitch_mm: 0.5,
        window: 13,
        thickness_mm: 20.0,
        eta: 1.5,
        refine: 1.0,
        finish: Finish::default(),
        seed: 1,
        scalar: Scalar::F32,
    };
    request.write(&path, progress).unwrap();
    let capture = Capture::open(&path, &Overrides::default()).unwrap();
    let mut window = vec![0.0; capture.window_len()];
    capture.read_window(0, &mut window);
    let mut rd = vec![0.0; 7];
    for (place, rgb) in window.chunks(3).enumerate() {
        #[allow(clippy::cast_possible_truncation, reason = "distances are small")]
        let distance = (place as f64 % 13.0 - 6.0).hypot((place / 13) as f64 - 6.0).round() as usize;
        if let Some(sum) = rd.get_mut(distance) {
            *sum += f64::from(rgb[1]);
        }
    }
    (rd, capture.simulated().unwrap().clone())
}

#[test]
fn photons_and_diffusion_agree_far_from_the_beam() {
    let (photons, sidecar) = by_distance(Method::MonteCarlo { packets: 300_000 }, &());
    assert_eq!((&sidecar["method"], &sidecar["packets"]), (&"monte-carlo".into(), &300_000.into()), "{sidecar}");
    let (diffusion, sidecar) = by_distance(Method::Diffusion, &());
    assert!(sidecar.get("method").is_none(), "{sidecar}");
    // Pixels are 1.3 mean free paths wide. Diffusion knows no light that turns back at once: it has less on the lit pixel, and more
    // around it.
    for (k, (photons, diffusion)) in photons.iter().zip(&diffusion).enumerate() {
        let error = diffusion / photons - 1.0;
        println!("{k} pixels away: {:+.1} %", 100.0 * error);
        let range = [-0.5..-0.2, 0.0..0.2, 0.0..0.2, 0.0..0.2, -0.08..0.08, -0.08..0.08, -0.08..0.08];
        assert!(range[k].contains(&error), "{k} pixels away: {diffusion}, {photons} by photons");
    }
}

#[test]
fn photons_that_are_stopped_leave_a_capture() {
    struct Stopped;
    impl Progress for Stopped {
        fn begin(&self, _: &str, _: u64) {}
        fn advance(&self, _: u64) {}
        fn stopped(&self) -> bool {
            true
        }
    }
    let (rd, sidecar) = by_distance(Method::MonteCarlo { packets: 80_000 }, &Stopped);
    assert_eq!(sidecar["packets"], 10_000, "{sidecar}");
    let (whole, _) = by_distance(Method::MonteCarlo { packets: 80_000 }, &());
    // Shares of the light that was traced.
    assert!((rd[0] / whole[0] - 1.0).abs() < 0.1, "{rd:?}, all of it {whole:?}");
}

#[test]
fn noise_is_seeded_unbiased_and_has_a_floor() {
    let map = homogeneous(Medium::measured("marble").unwrap());
    let slab = slab(&map, 6, 1.0);
    let (clean, _) = measure(&slab);
    let noisy = |sensor| simulated(&slab, &Finish { one_way: true, sensor: Some(sensor) }).0;
    let bright = Sensor { photons: 1e6, seed: 3 };
    let exposed = noisy(bright);
    assert_eq!(exposed, noisy(bright));
    assert_ne!(exposed, noisy(Sensor { seed: 4, ..bright }));
    let (clean_sum, noisy_sum): (f32, f32) = (clean.iter().sum(), exposed.iter().sum());
    // Three channels of some 800,000 photons: one part in 1,500 is one deviation.
    assert!((noisy_sum / clean_sum - 1.0).abs() < 3e-3, "{noisy_sum} from {clean_sum}");

    let exposed = noisy(Sensor { photons: 1e4, seed: 3 });
    // Six photons are the floor: 6 / (10⁴ · 0.25) mm⁻².
    let floor = 6.0 / (1e4 * 0.25);
    assert!(exposed.iter().all(|&rd| rd == 0.0 || rd >= floor * 0.999), "nothing below the floor");
    let lost: Vec<f32> =
        exposed.iter().zip(&clean).filter(|(noisy, _)| **noisy == 0.0).map(|(_, clean)| *clean).collect();
    assert!(!lost.is_empty(), "the far corners drown");
    assert!(lost.iter().all(|clean| *clean < 5.0 * floor), "bright entries do not");
}

#[test]
fn pairs_get_the_mean_of_both_directions() {
    let board = BuiltinMaterial::Chessboard.map([64, 64], Addressing::Clamp, 1);
    let media = (0..4).flat_map(|y| (6..11).map(move |x| (x, y))).map(|(x, y)| board.media[(8 + y) * 64 + x]);
    let map = MediumMap { size: [5, 4], media: media.collect() };
    let slab = Slab { addressing: Addressing::Clamp, ..slab(&map, 2, 1.0) };
    let (one_way, summary) = simulated(&slab, &Finish { one_way: true, sensor: None });
    let (both, _) = simulated(&slab, &Finish::default());
    assert!((0.005..0.2).contains(&summary.asymmetry), "dyed against plain marble: {summary:?}");
    let mut pairs = 0;
    for (pixel, place) in (0..20).flat_map(|pixel| (0..25).map(move |place| (pixel, place))) {
        let (x, y) = (pixel % 5 + place % 5, pixel / 5 + place / 5);
        if !(2..7).contains(&x) || !(2..6).contains(&y) {
            continue;
        }
        let there = (pixel * 25 + place) * 3;
        let back = (((y - 2) * 5 + x - 2) * 25 + 24 - place) * 3;
        assert_eq!(both[there], both[back], "{pixel}, {place}");
        assert_eq!(both[there], 0.5 * (one_way[there] + one_way[back]), "{pixel}, {place}");
        pairs += 1;
    }
    assert_eq!(pairs, (3 + 4 + 5 + 4 + 3) * (3 + 4 + 4 + 3), "all pairs inside");
}

#[test]
fn scenes_that_repeat_have_no_seam() {
    for scene in BuiltinMaterial::ALL {
        let map = scene.map([40, 40], Addressing::Repeat, 1);
        let at = |x: usize, y: usize| map.media[(y % 40) * 40 + x % 40].sigma_a[2];
        let mean_step = |column: usize| (0..40).map(|y| (at(column, y) - at(column + 1, y)).abs()).sum::<f64>();
        let seam = mean_step(39);
        let largest = (0..39).map(mean_step).fold(0.0, f64::max);
        assert!(seam <= 1.5 * largest, "{scene:?}: {seam} against {largest}");
    }
}
