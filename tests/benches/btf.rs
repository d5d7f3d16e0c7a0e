//! How fast BTFs of about 200 kB are evaluated and sampled, one core: `cargo bench -p subsurf-tests --bench btf`.
//!
//! Codebooks, texels, lights and views are random: nothing that was looked up helps the next query, but for caches.

use divan::Bencher;
use divan::counter::{BytesCount, ItemsCount};
use subsurf_decoder::NestedBtf;
use subsurf_decoder::btf::{ColourEncoding, Texel, View};
use subsurf_encoder::synthetic::{NestedShape, unit};
use subsurf_tests::nested::{direction, single};

fn main() {
    divan::main();
}

/// Few enough that what else the machine does falls between samples.
const QUERIES: u32 = 2_000;
const KINDS: [&str; 5] = ["display", "one colour", "relative and tints", "LogLuv", "three stages"];

fn file(kind: &str) -> Vec<u8> {
    let typical = NestedShape::typical();
    let shape = match kind {
        "display" => typical,
        "one colour" => NestedShape { chroma: [4096, 1, 1, 1], ..typical },
        "relative and tints" => NestedShape { is_relative: true, tints: 64, ..typical },
        "LogLuv" => NestedShape { tone: ColourEncoding::LogLuv { toe: 0.01, peak: 20.0 }, ..typical },
        // As large as the others.
        "three stages" => NestedShape { stages: 3, luma: [512, 1024, 1024, 512], ..typical },
        other => unreachable!("no file is called {other}"),
    };
    shape.database(1).to_bytes()
}

/// A texel, a light, a view and two random numbers.
type Query = (Texel, [f32; 3], [f32; 3], [f32; 2]);

fn queries(btf: &NestedBtf<'_>) -> Vec<Query> {
    let query = |n: u32| {
        let random = |k: u32| unit(8 * n + k);
        // Most views are from 88° or less: random textures do not fold over.
        let towards = |k: u32| single(direction([random(k).max(0.035), random(k + 1)]));
        #[allow(clippy::cast_possible_truncation, reason = "0 to 127")]
        let texel = [4, 5].map(|k| (128.0 * random(k)) as i32);
        let texel = btf.texel(0, 0, texel).expect("the first level of the first material");
        (texel, towards(0), towards(2), [random(6), random(7)])
    };
    (0..QUERIES).map(query).collect()
}

/// Runs all queries, and adds up what comes out of them so that none is left out.
fn run<T>(bencher: Bencher<'_, '_>, items: &[T], one: impl Fn(&T) -> f32) {
    bencher.counter(ItemsCount::new(items.len())).bench_local(|| items.iter().map(&one).sum::<f32>());
}

#[divan::bench(args = KINDS, sample_count = 400)]
fn eval(bencher: Bencher<'_, '_>, kind: &str) {
    let file = file(kind);
    let btf = NestedBtf::parse(&file).expect("a file of our own");
    run(bencher, &queries(&btf), |(texel, light, view, _)| btf.eval(*texel, *light, *view).iter().sum());
}

/// With a view that was prepared.
#[divan::bench(args = KINDS, sample_count = 400)]
fn eval_for(bencher: Bencher<'_, '_>, kind: &str) {
    let file = file(kind);
    let btf = NestedBtf::parse(&file).expect("a file of our own");
    let queries = queries(&btf);
    let prepared: Vec<(Query, View)> = queries.iter().map(|query| (*query, btf.grid().view(query.2))).collect();
    run(bencher, &prepared, |((texel, light, ..), view)| btf.eval_for(*texel, *light, view).iter().sum());
}

#[divan::bench(args = KINDS, sample_count = 400)]
fn sample(bencher: Bencher<'_, '_>, kind: &str) {
    let file = file(kind);
    let btf = NestedBtf::parse(&file).expect("a file of our own");
    run(bencher, &queries(&btf), |(texel, _, view, random)| {
        let sample = btf.sample(*texel, *view, *random);
        sample.light.iter().sum::<f32>() + sample.pdf
    });
}

/// From a sampler that was prepared, each of them once.
#[divan::bench(args = ["display"], sample_count = 400)]
fn sample_prepared(bencher: Bencher<'_, '_>, kind: &str) {
    let file = file(kind);
    let btf = NestedBtf::parse(&file).expect("a file of our own");
    let queries = queries(&btf);
    let samplers: Vec<_> = queries
        .iter()
        .map(|(texel, _, view, random)| (btf.sampler(*texel, &btf.grid().view(*view)), *random))
        .collect();
    run(bencher, &samplers, |(sampler, random)| {
        let sample = sampler.sample(*random);
        sample.light.iter().sum::<f32>() + sample.pdf
    });
}

#[divan::bench(args = ["display"], sample_count = 400)]
fn pdf(bencher: Bencher<'_, '_>, kind: &str) {
    let file = file(kind);
    let btf = NestedBtf::parse(&file).expect("a file of our own");
    run(bencher, &queries(&btf), |(texel, light, view, _)| btf.pdf(*texel, *light, *view));
}

#[divan::bench(args = ["display", "LogLuv"])]
fn albedo(bencher: Bencher<'_, '_>, kind: &str) {
    let file = file(kind);
    let btf = NestedBtf::parse(&file).expect("a file of our own");
    run(bencher, &queries(&btf)[..20], |(texel, _, view, _)| btf.albedo(*texel, *view).iter().sum());
}

/// All checks of a file.
#[divan::bench(args = KINDS)]
fn parse(bencher: Bencher<'_, '_>, kind: &str) {
    let file = file(kind);
    bencher
        .counter(BytesCount::of_slice(&file))
        .bench_local(|| NestedBtf::parse(divan::black_box(&file)).map(|btf| btf.header().materials));
}
