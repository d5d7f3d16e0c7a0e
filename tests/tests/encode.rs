//! Captures of all kinds through the encoder.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::{Addressing, Coding};
use subsurf_encoder::Progress;
use subsurf_encoder::bssrdf::{Encoded, Method, Options, Problem, encode, file_bytes};
use subsurf_encoder::capture::{CaptureWriter, Scalar, Sidecar};
use subsurf_encoder::metrics::bssrdf::compare;
use subsurf_encoder::metrics::psnr_db;
use subsurf_encoder::rate::Target;
use subsurf_encoder::rate::bssrdf::{Curve, Point, search};
use subsurf_encoder::synthetic::{capture_row, unit};
use subsurf_tests::{open, shape, write_capture};

/// Every method, K and coding.
fn kinds() -> [Options; 10] {
    let direct = Options::default();
    let [song, clusters] = [Method::Song2009, Method::Clusters].map(|method| Options { method, ..direct });
    let [one, three, five] = [1, 3, 5].map(|per_pixel| Options { per_pixel, ..direct });
    let [small, palette] = [Coding::SmallRatios, Coding::Palette].map(|coding| Options { coding, ..direct });
    let paper = Options { method: Method::Yatagawa2020, ..direct };
    [song, clusters, paper, one, direct, three, five, small, palette, Options { half_profiles: true, ..direct }]
}

/// A capture of what a synthetic 2-BMPP file stands for.
fn capture_of_bmpp(folder: &Path, size: [u32; 2], radius: u16, addressing: Addressing) -> PathBuf {
    let file = shape(size, radius, addressing).bmpp();
    let material = Bssrdf::parse(&file).unwrap();
    let path = folder.join("bmpp.npy");
    let sidecar = Sidecar { pitch_mm: 0.5, addressing, eta: 1.4, simulated: None };
    let writer = CaptureWriter {
        path: &path,
        size: size.map(|side| side as usize),
        radius: radius.into(),
        scalar: Scalar::F32,
        sidecar: &sidecar,
    };
    writer.write(|sink| (0..size[1]).try_for_each(|y| sink(&capture_row(&material, y)))).unwrap();
    path
}

fn fit(path: &Path, kind: Options, base_materials: usize) -> Encoded {
    encode(&open(path), None, &Options { base_materials, ..kind }, &()).unwrap()
}

/// Mean relative albedo error, and PSNR under uniform light in dB.
fn quality(path: &Path, file: &[u8]) -> (f64, f64) {
    let material = Bssrdf::parse(file).unwrap();
    let comparison = compare(&open(path), &material, &()).unwrap();
    let uniform = comparison.lit[0].normalised().unwrap();
    (comparison.albedo.mean_relative_error(), psnr_db(&uniform.reference, &uniform.image))
}

#[test]
fn finds_a_model_that_is_there() {
    // Seven base materials mixed at random pixel by pixel: nothing to lean on but the entries themselves.
    let folder = tempfile::tempdir().unwrap();
    for addressing in [Addressing::Clamp, Addressing::Repeat, Addressing::Mirror] {
        let path = capture_of_bmpp(folder.path(), [26, 20], 4, addressing);
        let [song, clusters, _, _, direct, ..] = kinds();
        let (song, _) = quality(&path, &fit(&path, song, 1).bytes);
        let (clusters, _) = quality(&path, &fit(&path, clusters, 24).bytes);
        let (direct, psnr) = quality(&path, &fit(&path, direct, 24).bytes);
        println!("{addressing:?}: LSP {song:.5}, clusters {clusters:.5}, direct {direct:.5} and {psnr:.1} dB");
        assert!(song < 0.01, "{addressing:?}: per-pixel profiles can hold it: {song}");
        assert!(direct < 0.25 * clusters, "{addressing:?}: {direct} against {clusters}");
        assert!(psnr > 40.0, "{addressing:?}: {psnr} dB");
    }
}

#[test]
fn bytes_do_not_depend_on_threads() {
    let folder = tempfile::tempdir().unwrap();
    let full = capture_of_bmpp(folder.path(), [30, 27], 3, Addressing::Clamp);
    let holes = with_holes(folder.path(), &full, |_| 0.0);
    for path in [&full, &holes] {
        for kind in kinds() {
            let with = |threads| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                pool.install(|| fit(path, kind, 12).bytes)
            };
            let one = with(1);
            assert_eq!(one, with(2), "{kind:?}");
            assert_eq!(one, with(8), "{kind:?}");
        }
    }
}

/// A copy of a capture in which some entries, and some single channels, are replaced by no measurement.
fn with_holes(folder: &Path, path: &Path, hole: impl Fn(u32) -> f32) -> PathBuf {
    let capture = open(path);
    let mut windows = vec![0.0; capture.pixels() * capture.window_len()];
    for (pixel, window) in windows.chunks_mut(capture.window_len()).enumerate() {
        capture.read_window(pixel, window);
    }
    let size = [capture.width(), capture.height()];
    let len = capture.window_len();
    write_capture(folder, "holes.npy", size, capture.radius(), capture.addressing(), |pixel, place, c| {
        let n = u32::try_from(pixel * len + place * 3).unwrap();
        let (entry, channel) = (unit(n) < 0.2, unit(0x5000_0000 + n) < 0.1 && c == 2);
        // A pixel needs something: its own exitance stays.
        if (entry || channel) && place != len / 6 { hole(n) } else { windows[pixel * len + place * 3 + c] }
    })
}

#[test]
fn more_base_materials_per_pixel_never_fit_worse() {
    let folder = tempfile::tempdir().unwrap();
    for base_materials in [3, 8] {
        let path = capture_of_bmpp(folder.path(), [26, 20], 4, Addressing::Repeat);
        let fits = [1, 2, 3, 5].map(|per_pixel| {
            let encoded = fit(&path, Options { per_pixel, ..Options::default() }, base_materials);
            (encoded.cost, quality(&path, &encoded.bytes).0)
        });
        println!("M = {base_materials}: cost and relative error for K = 1, 2, 3, 5: {fits:.5?}");
        for pair in fits.windows(2) {
            assert!(pair[1].1 <= pair[0].1 * 1.001, "relative error of more materials per pixel: {fits:?}");
        }
    }
}

#[test]
fn smaller_codings_cost_little() {
    let folder = tempfile::tempdir().unwrap();
    let path = capture_of_bmpp(folder.path(), [26, 20], 4, Addressing::Repeat);
    let psnr = |kind| quality(&path, &fit(&path, kind, 24).bytes).1;
    let [.., exact, _, _, small, palette, half] = kinds().map(psnr);
    println!("PSNR: exact {exact:.2} dB, 8-bit ratios {small:.2}, palette {palette:.2}, half profiles {half:.2}");
    // The capture is a 2-BMPP model itself: what is left is hardly more than the codings' own errors.
    assert!(exact > 65.0 && small > 65.0 && half > 65.0, "{exact} {small} {half}");
    assert!(palette > 55.0, "{palette}");
}

#[test]
fn missing_entries_weigh_nothing() {
    for addressing in [Addressing::Clamp, Addressing::Repeat, Addressing::Mirror] {
        missing_entries_weigh_nothing_with(addressing);
    }
}

fn missing_entries_weigh_nothing_with(addressing: Addressing) {
    let folder = tempfile::tempdir().unwrap();
    let full = capture_of_bmpp(folder.path(), [26, 20], 4, addressing);
    // The paper's fit ends where chance takes it, with holes or without.
    for kind in kinds().into_iter().filter(|kind| kind.method != Method::Yatagawa2020) {
        // However a hole is written, it is the same hole.
        let by_hole = [0.0, -1.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY].map(|hole| {
            let holes = with_holes(folder.path(), &full, |_| hole);
            fit(&holes, kind, 24)
        });
        for other in &by_hole[1..] {
            assert_eq!(by_hole[0].bytes, other.bytes, "{kind:?}");
        }
        let missing = 1.0 - by_hole[0].measured as f64 / by_hole[0].entries as f64;
        assert!((0.15..0.3).contains(&missing), "{missing}");
        // And what is left is enough: judged by the whole capture, the fit is hardly worse.
        let (whole, _) = quality(&full, &fit(&full, kind, 24).bytes);
        let (holes, _) = quality(&full, &by_hole[0].bytes);
        println!(
            "{addressing:?}, {kind:?}: relative error {whole:.5}, with {:.0} % missing {holes:.5}",
            100.0 * missing
        );
        assert!(holes < 1.3 * whole + 0.002, "{addressing:?}, {kind:?}: {holes} against {whole}");
    }
}

#[test]
fn odd_captures_give_sound_files() {
    let folder = tempfile::tempdir().unwrap();
    let falling = |place: usize, d: usize| {
        let (dx, dy) = ((place % d).abs_diff(d / 2), (place / d).abs_diff(d / 2));
        0.2 * (-((dx * dx + dy * dy) as f32).sqrt()).exp()
    };
    for addressing in [Addressing::Clamp, Addressing::Repeat, Addressing::Mirror] {
        for (name, size, radius) in [
            ("one pixel, no window", [1, 1], 0),
            ("one pixel", [1, 1], 2),
            ("one row, smaller than the window", [5, 1], 4),
            ("constant", [9, 8], 2),
        ] {
            let path = write_capture(folder.path(), "odd.npy", size, radius, addressing, |_, place, c| {
                // One colour channel measured nothing at all.
                if c == 1 { f32::NAN } else { falling(place, 2 * radius + 1) }
            });
            for kind in kinds() {
                // More base materials than there are distinct profiles.
                let encoded = fit(&path, kind, 40);
                let material = Bssrdf::parse(&encoded.bytes).unwrap();
                let rd = material.rd([0, 0], [0, 0]);
                assert!((rd[0] - 0.2).abs() < 0.01 && (rd[2] - 0.2).abs() < 0.01, "{name}, {addressing:?}: {rd:?}");
                // Those that no pixel has are left out.
                let distinct = if (name, addressing) == ("constant", Addressing::Repeat) { 5 } else { 40 };
                let bases = material.header().base_materials;
                assert!(bases <= distinct, "{name}, {addressing:?}, {kind:?}: {bases} base materials");
            }
        }
    }
}

#[test]
fn a_capture_without_measurements_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = write_capture(folder.path(), "empty.npy", [3, 3], 1, Addressing::Clamp, |pixel, place, _| {
        // Only an entry that leads out of the material is positive.
        if pixel == 0 && place == 0 { 1.0 } else { -1.0 }
    });
    let error = encode(&open(&path), None, &Options::default(), &()).unwrap_err().to_string();
    assert!(error.contains("empty.npy") && error.contains("nothing measured"), "{error}");
}

/// Ends a fit after so many steps of progress.
struct Impatient {
    left: AtomicU64,
}

impl Progress for Impatient {
    fn begin(&self, _: &str, _: u64) {}

    fn advance(&self, steps: u64) {
        let less = |left: u64| Some(left.saturating_sub(steps));
        // The closure always gives something.
        self.left.fetch_update(Ordering::Relaxed, Ordering::Relaxed, less).ok();
    }

    fn stopped(&self) -> bool {
        self.left.load(Ordering::Relaxed) == 0
    }
}

#[test]
fn a_fit_that_is_cut_short_is_a_fit() {
    let folder = tempfile::tempdir().unwrap();
    let path = capture_of_bmpp(folder.path(), [26, 20], 4, Addressing::Clamp);
    for kind in kinds() {
        let (whole, _) = quality(&path, &fit(&path, kind, 24).bytes);
        for patience in [1, 600, 750] {
            let progress = Impatient { left: AtomicU64::new(patience) };
            let encoded = encode(&open(&path), None, &Options { base_materials: 24, ..kind }, &progress).unwrap();
            let (error, _) = quality(&path, &encoded.bytes);
            println!("{kind:?}, {patience} steps: stopped {}, {error:.4} against {whole:.4}", encoded.stopped);
            assert!(encoded.stopped || error == whole, "{kind:?}: {error} and {whole}");
            assert!(error.is_finite(), "{kind:?}: {error}");
        }
    }
}

#[test]
fn sizes_are_known_beforehand() {
    let folder = tempfile::tempdir().unwrap();
    let path = capture_of_bmpp(folder.path(), [26, 20], 4, Addressing::Clamp);
    let capture = open(&path);
    let mut problem = Problem::new(&capture, None, &()).unwrap();
    for kind in kinds().into_iter().filter(|kind| kind.method != Method::Song2009) {
        let options = Options { base_materials: 12, ..kind };
        let bytes = problem.fit(&options, &()).unwrap().bytes.len() as u64;
        let foreseen = file_bytes(&capture, None, &options).unwrap();
        let exact = kind.coding != Coding::Palette;
        assert!(if exact { bytes == foreseen } else { bytes <= foreseen }, "{kind:?}: {bytes} and {foreseen}");
    }
}

#[test]
fn targets_are_met() {
    let folder = tempfile::tempdir().unwrap();
    let path = capture_of_bmpp(folder.path(), [26, 20], 4, Addressing::Clamp);
    let capture = open(&path);
    let mut shown = 0;
    let mut search = |target| search(&capture, None, 1, target, &(), &mut |_| shown += 1);
    let uniform = |point: &Point| point.distortion.psnr_db[0].unwrap();

    let Curve { points, best, .. } = search(Target::Bytes(15_000)).unwrap();
    assert!(points.len() > 3, "{} models were tried", points.len());
    assert!(points.iter().all(|point| point.bytes() <= 15_000), "all fit");
    assert!(points.iter().all(|point| uniform(point) <= uniform(&points[best])), "none is better");
    let error = search(Target::Bytes(300)).unwrap_err().to_string();
    assert!(error.contains("300 bytes") && error.contains("the smallest takes"), "{error}");

    let Curve { points, best, .. } = search(Target::Quality(35.0)).unwrap();
    let chosen = &points[best];
    assert!(uniform(chosen) >= 35.0, "{}", uniform(chosen));
    let as_good = points.iter().filter(|point| uniform(point) >= 35.0);
    assert!(as_good.map(|point| point.bytes()).min() == Some(chosen.bytes()), "the smallest");
    assert!(search(Target::Quality(f64::NAN)).is_err(), "no number");
    let error = search(Target::Quality(200.0)).unwrap_err().to_string();
    assert!(error.contains("200 dB") && error.contains("the best has"), "{error}");
    assert!(shown > 10, "every model is shown as it comes: {shown}");
}

#[test]
fn options_out_of_range_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = capture_of_bmpp(folder.path(), [6, 6], 1, Addressing::Clamp);
    for options in [
        Options { base_materials: 0, ..Options::default() },
        Options { base_materials: 257, ..Options::default() },
        Options { per_pixel: 4, ..Options::default() },
        Options { per_pixel: 1, base_materials: 65_537, ..Options::default() },
        Options { per_pixel: 3, coding: Coding::Palette, ..Options::default() },
    ] {
        assert!(encode(&open(&path), None, &options, &()).is_err(), "{options:?}");
    }
    for samples in [1, 5_000] {
        assert!(encode(&open(&path), Some(samples), &Options::default(), &()).is_err(), "{samples} samples");
    }
}
