//! Vertices a second that transfer is decoded for, on one core, and what a light takes: `cargo bench -p subsurf-tests --bench transfer`.

use std::sync::LazyLock;

use divan::Bencher;
use divan::counter::ItemsCount;
use subsurf_decoder::Transfer;
use subsurf_decoder::transfer::LightWeights;
use subsurf_encoder::kernel::profile::shipped;
use subsurf_encoder::transfer::{Options, RdTable, Size, encode, fibonacci, precompute};
use subsurf_scene::knot;

fn main() {
    divan::main();
}

/// A knot of some 40,000 vertices under 200 lights, of one channel and of three.
static FILES: LazyLock<[Vec<u8>; 2]> = LazyLock::new(|| {
    let mesh = knot(10.0, 3.0, 70).fitted(40.0).expect("a mesh of some size");
    let table = RdTable::of(&shipped::profile("marble").expect("a name of the list")).expect("a profile of our own");
    [1, 3].map(|channels| {
        let of = precompute(&mesh, &table, &fibonacci(200), &Options { channels, eta: 1.5 }, &()).expect("some lights");
        let size = Size { clusters: 256, components: 8, bits: 40 };
        encode(&mesh, &table, &of, 1.5, &size, &()).expect("a size that files have")
    })
});

fn file(channels: usize) -> Transfer<'static> {
    Transfer::parse(&FILES[usize::from(channels == 3)]).expect("a file of our own")
}

#[divan::bench(args = [1, 3])]
fn parse(bencher: Bencher, channels: usize) {
    let bytes = &FILES[usize::from(channels == 3)];
    bencher.counter(divan::counter::BytesCount::of_slice(bytes)).bench(|| Transfer::parse(bytes));
}

/// Once for a file.
#[divan::bench]
fn prepare_weights(bencher: Bencher) {
    let file = file(1);
    let mut buffer = vec![0.0; LightWeights::buffer_len(200)];
    bencher.bench_local(|| LightWeights::new(file.lights(), &mut buffer).is_some());
}

/// Once for a light.
#[divan::bench(args = [1, 3])]
fn light(bencher: Bencher, channels: usize) {
    let file = file(channels);
    let mut buffer = vec![0.0; LightWeights::buffer_len(200)];
    let between = LightWeights::new(file.lights(), &mut buffer).expect("lights that differ");
    let (mut weights, mut table) = (vec![0.0; 200], vec![0.0; file.header().table_len()]);
    bencher.bench_local(|| {
        between.at([0.6, 0.0, 0.8], &mut weights);
        file.light_table(&weights, &mut table);
    });
}

/// For every vertex and light.
#[divan::bench(args = [1, 3])]
fn vertices(bencher: Bencher, channels: usize) {
    let file = file(channels);
    let mut table = vec![0.0; file.header().table_len()];
    file.light_table(&[0.005; 200], &mut table);
    let count = file.header().vertices as usize;
    let mut out = vec![0.0; count * channels];
    bencher.counter(ItemsCount::new(count)).bench_local(|| file.exitance(&table, 0, &mut out));
}
