//! Captures of all kinds through the encoder.

use std::sync::atomic::{AtomicU64, Ordering};

use subsurf_decoder::bssrdf::{Addressing, Coding};
use subsurf_encoder::Progress;
use subsurf_encoder::bssrdf::{Method, Options, Problem, encode, file_bytes};
use subsurf_encoder::rate::Target;
use subsurf_encoder::rate::bssrdf::{Curve, Point, search};
use subsurf_tests::fits::{capture_of_bmpp, fit, kinds, quality, with_holes};
use subsurf_tests::{open, write_capture};

#[test]
fn bytes_do_not_depend_on_threads() {
    let folder = tempfile::tempdir().unwrap();
    let full = capture_of_bmpp(folder.path(), [20, 17], 3, Addressing::Clamp);
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
    let path = capture_of_bmpp(folder.path(), [26, 20], 3, Addressing::Clamp);
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
