//! Nested BTFs: values, samples, densities and albedo of any file that is accepted.
#![no_main]

use libfuzzer_sys::{fuzz_mutator, fuzz_target};
use subsurf_decoder::btf::{CodebookOffsets, PackedTable, Texel};
use subsurf_decoder::container::Crc;
use subsurf_decoder::{Evaluate, NestedBtf, Section};
use subsurf_fuzz::{Arguments, check_error, mutate};

/// Most nodes of light for which albedos are integrated.
const MOST_NODES: usize = 12;

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    mutate(data, size, max_size, seed, Section::BtfHeader)
});

fuzz_target!(|input: &[u8]| {
    match NestedBtf::parse_with(input, Crc::Skip) {
        Err(error) => check_error(error, input),
        Ok(btf) => look_at(&btf, &mut Arguments::behind_file(input)),
    }
});

fn look_at(btf: &NestedBtf<'_>, arguments: &mut Arguments<'_>) {
    let texel = texel(btf, arguments);
    let view = arguments.direction();
    let prepared = btf.grid().view(view);
    for light in [arguments.direction(), arguments.vector()] {
        let [value, for_view] = [btf.eval(texel, light, view), btf.eval_for(texel, light, &prepared)];
        for value in [value, for_view, btf.header().encoding.linear(value)] {
            assert!(value.iter().all(|value| value.is_finite() && *value >= 0.0), "{light:?} {view:?}: {value:?}");
        }
        let is_below = light[2] <= 0.0 || light[2].is_nan();
        assert!(!is_below || value == [0.0; 3], "below the horizon, {light:?}: {value:?}");
        let pdf = btf.pdf(texel, light, view);
        assert!(pdf.is_finite() && pdf >= 0.0, "{light:?} {view:?}: {pdf}");
    }
    let coord = btf.grid().coord(arguments.direction(), view);
    let mut values = [[f32::NAN; 3]; 2];
    btf.eval_texels(texel, &coord, &mut values);
    assert_eq!(values[0], btf.eval_at(texel, &coord), "the first of several");

    let sampler = btf.sampler(texel, &prepared);
    for random in [[arguments.number(), arguments.number()], [arguments.number().fract(), arguments.number().fract()]] {
        let sample = sampler.sample(random);
        let [x, y, z] = sample.light;
        assert!(sample.pdf.is_finite() && sample.pdf > 0.0, "{view:?} {random:?}: {sample:?}");
        assert!((x * x + y * y + z * z - 1.0).abs() < 1e-3 && z >= 0.0, "{view:?} {random:?}: {sample:?}");
        let pdf = sampler.pdf(sample.light);
        assert!(pdf.is_finite() && pdf >= 0.0, "{view:?} {random:?}: {sample:?}, {pdf}");
    }
    if btf.grid().light_nodes() <= MOST_NODES {
        let albedo = btf.albedo(texel, view);
        assert!(albedo.iter().all(|albedo| albedo.is_finite() && *albedo >= 0.0), "{albedo:?}");
    }
    offsets(btf);
}

/// Texel of any material and level.
fn texel(btf: &NestedBtf<'_>, arguments: &mut Arguments<'_>) -> Texel {
    let count = btf.materials().count();
    assert_eq!(count, btf.header().materials.into(), "as many materials as the header says");
    let number = arguments.below(count);
    let material = btf.materials().nth(number).expect("a material");
    assert!(material.name().len() <= material.name.len(), "a name is a part of a material");
    let level = arguments.below(material.levels.into()) as u8;
    let at = [arguments.integer(), arguments.integer()];
    let texel = btf.texel(number, level, at).expect("coordinates repeat");
    assert!(texel.number() < btf.catalog().texels(), "{at:?}");
    assert!(btf.texel(number, material.levels, at).is_none() && btf.texel(count, 0, at).is_none(), "no more of them");
    texel
}

/// Places of tables, which shaders read without checks.
fn offsets(btf: &NestedBtf<'_>) {
    let (offsets, length) = (CodebookOffsets::of(btf), btf.file().len() as u64);
    let chroma = &offsets.sizes.chroma;
    let check = |table: &PackedTable, rows: u32| {
        let bits = u64::from(rows) * u64::from(table.nodes) * u64::from(table.width);
        assert!(table.start > 0 && table.start + bits.div_ceil(8) <= length, "{table:?}");
    };
    for (stage, sizes) in offsets.stages.iter().zip(&offsets.sizes.stages).take(offsets.sizes.count) {
        for (table, size) in stage.tables.iter().zip(sizes.codebooks) {
            check(table, size.entries);
        }
        let slice = u64::from(btf.grid().n_beta) + 1;
        assert!(stage.p1 + u64::from(sizes.slices) * slice <= length, "{stage:?}");
        assert!(stage.p2_bytes < stage.tables[3].start, "{stage:?}");
    }
    check(&offsets.merged, chroma.merged);
    check(&offsets.i2, chroma.i2);
    check(&offsets.i1, chroma.i1);
    for (start, count) in [(offsets.colours, chroma.colours), (offsets.tints, chroma.tints)] {
        assert!(start + 2 * u64::from(count) <= length, "{start}");
    }
}
