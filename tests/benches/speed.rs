//! How long fits take, and how fast files are parsed and evaluated: `cargo bench -p subsurf-tests`.
//!
//! Captures are synthetic: a random 2-BMPP material of 96 × 96 pixels and one of the size of the paper's onyx.

use std::sync::LazyLock;

use divan::Bencher;
use divan::counter::{BytesCount, ItemsCount};
use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::{Addressing, Coding};
use subsurf_encoder::bssrdf::{Method, Options, encode};
use subsurf_encoder::capture::{Capture, CaptureWriter, Scalar, Sidecar};
use subsurf_encoder::synthetic::{Shape, capture_row, unit};
use subsurf_tests::open;

fn main() {
    divan::main();
}

/// Nearly as large as the paper's stone: 96 × 96 pixels, window 25.
const STONE: Shape =
    Shape { size: [96; 2], radius: 12, samples: 13, base_materials: 128, addressing: Addressing::Clamp };
/// Its onyx: 229 × 229 pixels, window 39.
const ONYX: Shape =
    Shape { size: [229; 2], radius: 19, samples: 25, base_materials: 128, addressing: Addressing::Clamp };

static STONE_CAPTURE: LazyLock<Capture> = LazyLock::new(|| capture(&STONE));
static ONYX_CAPTURE: LazyLock<Capture> = LazyLock::new(|| capture(&ONYX));

/// A mapped capture without a name: statics are never dropped, and would leave a gigabyte behind.
fn capture(shape: &Shape) -> Capture {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("capture.npy");
    let file = shape.bmpp();
    let material = Bssrdf::parse(&file).expect("a file of our own");
    let sidecar = Sidecar { pitch_mm: 0.5, addressing: shape.addressing, eta: 1.4, simulated: None };
    let writer = CaptureWriter {
        path: &path,
        size: shape.size.map(|side| side as usize),
        radius: shape.radius.into(),
        scalar: Scalar::F32,
        sidecar: &sidecar,
    };
    let rows = writer.write(|sink| (0..shape.size[1]).try_for_each(|y| sink(&capture_row(&material, y))));
    rows.expect("a temporary folder can be written to");
    open(&path)
}

/// What is fitted.
const MODELS: [&str; 8] =
    ["Song", "LSP clusters", "K = 1", "K = 2", "K = 3", "K = 5", "K = 2, 24 bits", "K = 2, 16 bits"];

/// A model by its name.
fn options(model: &str) -> Options {
    let direct = Options::default();
    let k = |per_pixel| Options { per_pixel, ..direct };
    match model {
        "Song" => Options { method: Method::Song2009, ..direct },
        "LSP clusters" => Options { method: Method::Clusters, ..direct },
        "K = 1" => k(1),
        "K = 3" => k(3),
        "K = 5" => k(5),
        "K = 2, 24 bits" => Options { coding: Coding::SmallRatios, ..direct },
        "K = 2, 16 bits" => Options { coding: Coding::Palette, ..direct },
        "K = 2, paper's fit" => Options { method: Method::Yatagawa2020, ..direct },
        "K = 2" => direct,
        other => unreachable!("no model is called {other}"),
    }
}

fn fit(bencher: Bencher<'_, '_>, capture: &Capture, samples: u16, model: &str) {
    let options = options(model);
    bencher.counter(BytesCount::new(capture.file_bytes())).bench_local(|| {
        encode(capture, Some(samples.into()), &options, &()).expect("a capture of our own").bytes.len()
    });
}

#[divan::bench(sample_count = 3, sample_size = 1, args = MODELS)]
fn encode_96(bencher: Bencher<'_, '_>, model: &str) {
    fit(bencher, &STONE_CAPTURE, STONE.samples, model);
}

#[divan::bench(sample_count = 1, sample_size = 1, args = ["K = 2, paper's fit"])]
fn encode_96_baseline(bencher: Bencher<'_, '_>, model: &str) {
    fit(bencher, &STONE_CAPTURE, STONE.samples, model);
}

#[divan::bench(sample_count = 1, sample_size = 1, args = MODELS)]
fn encode_onyx(bencher: Bencher<'_, '_>, model: &str) {
    fit(bencher, &ONYX_CAPTURE, ONYX.samples, model);
}

/// Files of the onyx's size.
fn file(model: &str) -> Vec<u8> {
    match model {
        "per-pixel profiles" => ONYX.per_pixel(),
        "K = 1" => ONYX.k_bmpp(1, Coding::Exact, false),
        "K = 3" => ONYX.k_bmpp(3, Coding::Exact, false),
        "K = 5" => ONYX.k_bmpp(5, Coding::Exact, false),
        "K = 2, 24 bits" => ONYX.k_bmpp(2, Coding::SmallRatios, false),
        // Random pairs of more base materials are more than a palette holds.
        "K = 2, 16 bits" => Shape { base_materials: 45, ..ONYX }.k_bmpp(2, Coding::Palette, false),
        "K = 2, f16 profiles" => ONYX.k_bmpp(2, Coding::Exact, true),
        "K = 2" => ONYX.bmpp(),
        other => unreachable!("no model is called {other}"),
    }
}

const FILES: [&str; 8] = [
    "per-pixel profiles",
    "K = 1",
    "K = 2",
    "K = 3",
    "K = 5",
    "K = 2, 24 bits",
    "K = 2, 16 bits",
    "K = 2, f16 profiles",
];

/// `Bssrdf::rd` between random neighbours, as a gather that knows nothing would call it.
#[divan::bench(args = FILES)]
fn rd(bencher: Bencher<'_, '_>, model: &str) {
    const PAIRS: u32 = 10_000;
    let file = file(model);
    let material = Bssrdf::parse(&file).expect("a file of our own");
    #[allow(clippy::cast_possible_truncation, reason = "positions in the patch")]
    let at = |n: u32, range: f32| (unit(n) * range) as i32;
    let pairs: Vec<[[i32; 2]; 2]> = (0..PAIRS)
        .map(|n| {
            let from = [at(4 * n, 229.0), at(4 * n + 1, 229.0)];
            [from, [from[0] + at(4 * n + 2, 39.0) - 19, from[1] + at(4 * n + 3, 39.0) - 19]]
        })
        .collect();
    bencher.counter(ItemsCount::new(PAIRS)).bench_local(|| {
        let sums = pairs.iter().map(|&[from, to]| material.rd(from, to));
        sums.fold([0.0; 3], |sum, rd| [sum[0] + rd[0], sum[1] + rd[1], sum[2] + rd[2]])
    });
}

/// All checks of a file.
#[divan::bench(args = FILES)]
fn parse(bencher: Bencher<'_, '_>, model: &str) {
    let file = file(model);
    bencher
        .counter(BytesCount::of_slice(&file))
        .bench_local(|| Bssrdf::parse(divan::black_box(&file)).map(|material| material.header().width));
}
