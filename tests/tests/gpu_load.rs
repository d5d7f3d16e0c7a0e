//! Load size and latency of every storage and technique, from bytes to the first frame, against the uncompressed baseline.
//!
//! Bytes are asserted as they are, latencies at a tenth of what they were measured by: loading that begins to do work fails,
//! a busy machine does not.

use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::Addressing;
use subsurf_encoder::synthetic::{NestedShape, capture_row};
use subsurf_runtime::{Backend, Gpu, layout_of};
use subsurf_tests::frames::device;
use subsurf_tests::{drawable, shape};
use subsurf_viewer::{Loader, Loading, Stored};

/// Runs of each, in turns.
const RUNS: usize = 5;

/// Way to store a material.
struct Case<'a> {
    name: &'static str,
    bytes: &'a [u8],
    loader: Loader<'a>,
}

/// Median of one of the steps, or of several, in µs.
fn median_us(runs: &[Loading], step: impl Fn(&Loading) -> std::time::Duration) -> f64 {
    let mut times: Vec<f64> = runs.iter().map(|run| 1e6 * step(run).as_secs_f64()).collect();
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// Microseconds until the material can be drawn, and until it is drawn.
fn measured(cases: &[Case<'_>]) -> Vec<[f64; 2]> {
    let mut runs: Vec<Vec<Loading>> = cases.iter().map(|_| Vec::new()).collect();
    for number in 0..=RUNS {
        for (case, runs) in cases.iter().zip(&mut runs) {
            let loading = case.loader.load(case.bytes).unwrap();
            // The first warms up caches and drivers.
            if number > 0 {
                runs.push(loading);
            }
        }
    }
    println!("| storage | bytes | on the device | parse (µs) | upload (µs) | first frame (µs) |");
    println!("|---|---:|---:|---:|---:|---:|");
    let row = |(case, runs): (&Case<'_>, &Vec<Loading>)| {
        let [parse, upload, first] = [
            median_us(runs, |run| run.parse),
            median_us(runs, |run| run.upload),
            median_us(runs, |run| run.first_frame),
        ];
        let (name, bytes, on_device) = (case.name, case.bytes.len(), runs[0].gpu_bytes);
        println!("| {name} | {bytes} | {on_device} | {parse:.0} | {upload:.0} | {first:.0} |");
        let load = median_us(runs, |run| run.parse + run.upload);
        [load, median_us(runs, |run| run.parse + run.upload + run.first_frame)]
    };
    cases.iter().zip(&runs).map(row).collect()
}

/// Asserts that `baseline` takes at least `least` times as long as `ours`, until it can be drawn.
fn assert_faster(what: &str, baseline: [f64; 2], ours: [f64; 2], least: f64) {
    let [load, total] = [0, 1].map(|k| baseline[k] / ours[k]);
    println!("{what}: {load:.1} × until it can be drawn, {total:.1} × until it is");
    assert!(load >= least, "{what}: {load}");
}

fn translucent(gpu: &Gpu) {
    let shape = shape([64, 64], 12, Addressing::Clamp);
    let (bmpp, profiles) = (shape.bmpp(), shape.per_pixel());
    let with_basis = drawable([64, 64], 12, Addressing::Clamp);
    let material = Bssrdf::parse(&bmpp).unwrap();
    let rows = (0..64).flat_map(|y| capture_row(&material, y));
    let capture: Vec<u8> = rows.flat_map(f32::to_le_bytes).collect();
    let terms = Bssrdf::parse(&with_basis).unwrap().basis().map_or(0, |basis| basis.size().terms);
    let case = |name, bytes, stored| Case { name, bytes, loader: Loader::new(gpu, stored).unwrap() };
    let cases = [
        case("capture, gather", &capture[..], Stored::Capture(*material.header())),
        case("profiles, gather", &profiles, Stored::Planes(layout_of(&Bssrdf::parse(&profiles).unwrap()))),
        case("2-BMPP, gather", &bmpp, Stored::Planes(layout_of(&material))),
        case("2-BMPP, separable", &with_basis, Stored::Separable(terms)),
    ];
    let [capture, profiles, planes, separable] = measured(&cases)[..] else { panic!("four cases") };
    assert_eq!(cases.each_ref().map(|case| case.bytes.len()), [30_720_000, 688_236, 25_908, 26_432], "bytes");
    assert_faster("capture by 2-BMPP", capture, planes, 5.8);
    assert_faster("profiles by 2-BMPP", profiles, planes, 0.4);
    assert_faster("capture by separable", capture, separable, 0.6);
}

fn textured(gpu: &Gpu) {
    let shape = NestedShape { materials: vec![(32, 32, 1)], ..NestedShape::typical() };
    let btf = shape.database(1).to_bytes();
    // Rings of directions around the normal.
    let ring = |theta: f32, count: u16| {
        (0..count).map(move |k| {
            let phi = f32::from(k) / f32::from(count) * std::f32::consts::TAU;
            glam::Vec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
        })
    };
    let directions: Vec<_> = ring(0.0, 1).chain(ring(0.5, 12)).chain(ring(1.1, 24)).collect();
    let images: Vec<u8> =
        (0..37 * 37 * 32 * 32 * 3_u32).map(|k| k.wrapping_mul(2_654_435_761).to_le_bytes()[3]).collect();
    let stored = Stored::Images { size: [32; 2], lights: directions.clone(), views: directions };
    let case = |name, bytes, stored| Case { name, bytes, loader: Loader::new(gpu, stored).unwrap() };
    let cases = [case("images", &images[..], stored), case("nested codebooks", &btf, Stored::Btf)];
    let [images, nested] = measured(&cases)[..] else { panic!("two cases") };
    assert_eq!(cases.each_ref().map(|case| case.bytes.len()), [4_205_568, 197_676], "bytes");
    assert_faster("images by nested codebooks", images, nested, 4.9);
}

#[test]
fn loading_on_vulkan() {
    let gpu = device(Backend::Vulkan);
    translucent(&gpu);
    textured(&gpu);
}
