//! BTFs on Vulkan and on OpenGL ES 3.0 against the decoder.

use subsurf_decoder::Btf;
use subsurf_decoder::btf::{Grid, Tone};
use subsurf_decoder::container::Crc;
use subsurf_encoder::synthetic::{NestedShape, unit};
use subsurf_runtime::{Backend, BtfAnswer, BtfMaterial, BtfQueries, BtfQuery, Gpu};
use subsurf_tests::frames::device;
use subsurf_tests::nested::{direction, single};

/// Of the larger of a value and a hundredth of the material's brightest. Directions are off by 1e-6 rad, nodes 0.3 rad
/// apart; logarithmic tones turn 1e-6 of a step into some 1e-5, and so do powers in display tones.
const VALUE_TOLERANCE: f32 = 3e-4;
/// Of unit vectors, and of densities as shares of themselves: a sum of ten to a hundred f32 is divided by one of 1/32 of it.
const SAMPLE_TOLERANCE: f32 = 1e-3;

/// The kinds of files that the benchmark of the decoder uses, and odd ones.
fn files() -> Vec<(&'static str, Vec<u8>)> {
    let typical = NestedShape { materials: vec![(32, 32, 1)], ..NestedShape::typical() };
    let small = NestedShape::small();
    let odd = Grid {
        n_alpha: 7,
        n_beta: 9,
        n_theta: 2,
        n_phi: 1,
        alpha_max: 1.3,
        sin_beta_max: 0.9,
        theta_max: 1.2,
        cos_light_min: 0.2,
    };
    let large = Grid { n_alpha: 64, n_beta: 63, n_theta: 5, n_phi: 64, ..Grid::PAPER };
    let bright = Tone::LogLuv { toe: 0.01, peak: 20.0 };
    let shapes = [
        ("display", typical.clone()),
        ("one colour", NestedShape { chroma: [4096, 1, 1, 1], ..typical.clone() }),
        ("relative and tints", NestedShape { is_relative: true, tints: 64, ..typical.clone() }),
        ("LogLuv", NestedShape { tone: bright, ..typical.clone() }),
        ("three stages", NestedShape { stages: 3, luma: [512, 1024, 1024, 512], ..typical.clone() }),
        ("four stages", NestedShape { stages: 4, tints: 5, materials: vec![(5, 3, 3), (1, 7, 2)], ..small.clone() }),
        ("odd grid", NestedShape { grid: odd, tone: bright, is_relative: true, tints: 1, ..small.clone() }),
        ("wide codes", NestedShape { scale_bits: 10, ..small.clone() }),
        ("large grid", NestedShape { grid: large, ..small }),
    ];
    (0..).zip(shapes).map(|(seed, (name, shape))| (name, shape.database(seed).to_bytes())).collect()
}

/// Random texels of all materials and levels, lights and views, some of them below the horizon or straight above.
fn queries(btf: &Btf<'_>, count: u32) -> Vec<BtfQuery> {
    let query = |n: u32| {
        let random = |k: u32| unit(16 * n + k);
        let towards = |k: u32| match n % 16 {
            0 => [0.0, 0.0, 1.0],
            1 => single(direction([0.0, random(k)])),
            2 => single(direction([random(k), random(k + 1)])).map(|x| -x),
            _ => single(direction([random(k), random(k + 1)])),
        };
        let material = n as usize % usize::from(btf.header().materials);
        let of = btf.materials().nth(material).unwrap();
        let level = u8::try_from(n % u32::from(of.levels)).unwrap();
        #[allow(clippy::cast_possible_truncation, reason = "texels")]
        let at = [4, 5].map(|k| (1000.0 * random(k)) as i32);
        BtfQuery {
            texel: btf.texel(material, level, at).unwrap(),
            light: towards(0),
            view: if n % 16 == 2 { single(direction([random(2), random(3)])) } else { towards(2) },
            random: [random(6), random(7)],
        }
    };
    (0..count).map(query).collect()
}

/// What the decoder says.
fn expected(btf: &Btf<'_>, query: &BtfQuery) -> BtfAnswer {
    let BtfQuery { texel, light, view, random } = *query;
    BtfAnswer {
        value: btf.header().tone.linear(btf.eval(texel, light, view)),
        pdf: btf.pdf(texel, light, view),
        sample: btf.sample(texel, view, random),
    }
}

/// Largest errors of values, densities and samples, in tolerances.
fn errors(btf: &Btf<'_>, queries: &[BtfQuery], found: &[BtfAnswer]) -> [f32; 3] {
    assert_eq!(queries.len(), found.len(), "every query is answered");
    let wanted: Vec<BtfAnswer> = queries.iter().map(|query| expected(btf, query)).collect();
    let brightest = wanted.iter().flat_map(|answer| answer.value).fold(0.0, f32::max);
    let mut worst = [0.0_f32; 3];
    for (found, wanted) in found.iter().zip(&wanted) {
        for (a, b) in found.value.into_iter().zip(wanted.value) {
            worst[0] = worst[0].max((a - b).abs() / b.max(0.01 * brightest));
        }
        let share = |a: f32, b: f32| if b > 0.0 { (a / b - 1.0).abs() } else { a.abs() };
        worst[1] = worst[1].max(share(found.pdf, wanted.pdf));
        for (a, b) in found.sample.light.into_iter().zip(wanted.sample.light) {
            worst[2] = worst[2].max((a - b).abs());
        }
        worst[2] = worst[2].max(share(found.sample.pdf, wanted.sample.pdf));
        assert!(found.value.iter().all(|value| value.is_finite()), "{found:?}");
    }
    worst
}

fn gles(backend: Backend) -> Gpu {
    let gpu = device(backend);
    let driver = &gpu.info().driver_info;
    let forced = !driver.contains("Mesa") || driver.starts_with("OpenGL ES 3.0");
    assert!(backend == Backend::Vulkan || driver.starts_with("OpenGL ES") && forced, "not GLES 3.0: {driver}");
    gpu
}

fn values_and_samples(backend: Backend) {
    let gpu = gles(backend);
    let answers = BtfQueries::new(&gpu).unwrap();
    for (name, file) in files() {
        let btf = Btf::parse(&file).unwrap();
        let before = gpu.ledger().bytes();
        let material = BtfMaterial::upload(&gpu, &btf).unwrap();
        assert_eq!(gpu.ledger().bytes() - before, material.gpu_bytes(), "{name}: counted");
        assert!(material.gpu_bytes() < file.len() as u64 + (10 << 10), "{name}: as large as the file, but for a row");
        let queries = queries(&btf, 6_000);
        let found = answers.answer(&gpu, &material, &queries).unwrap();
        let [value, pdf, sample] = errors(&btf, &queries, &found);
        println!("{backend}, {name}: values {value:.1e}, densities {pdf:.1e}, samples {sample:.1e}");
        assert!(value <= VALUE_TOLERANCE, "{backend}, {name}: values are off by {value}");
        assert!(pdf.max(sample) <= SAMPLE_TOLERANCE, "{backend}, {name}: samples are off by {pdf}, {sample}");
    }
}

#[test]
fn values_and_samples_on_vulkan() {
    values_and_samples(Backend::Vulkan);
}

#[test]
fn values_and_samples_on_gles_3_0() {
    values_and_samples(Backend::Gl);
}

/// Any bits in codebooks whose sizes are powers of two: the reader takes them, and the device says the same of them.
fn hostile(backend: Backend) {
    let gpu = gles(backend);
    let answers = BtfQueries::new(&gpu).unwrap();
    let shape =
        NestedShape { materials: vec![(32, 32, 1)], stages: 3, luma: [64, 128, 256, 128], ..NestedShape::typical() };
    let clean = shape.database(7).to_bytes();
    let first = subsurf_decoder::container::Container::parse(&clean).unwrap();
    let tables = first.entries().skip(3).map(|entry| usize::try_from(entry.offset).unwrap()).min().unwrap();
    for seed in 0..3_u32 {
        let mut file = clean.clone();
        for (byte, n) in file[tables..].iter_mut().zip(0..) {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a byte")]
            let random = (256.0 * unit(n ^ (seed << 24))) as u8;
            *byte = random;
        }
        let btf = Btf::parse_with(&file, Crc::Skip).unwrap();
        let material = BtfMaterial::upload(&gpu, &btf).unwrap();
        let queries = queries(&btf, 3_000);
        let found = answers.answer(&gpu, &material, &queries).unwrap();
        let [value, pdf, sample] = errors(&btf, &queries, &found);
        println!("{backend}, seed {seed}: values {value:.1e}, densities {pdf:.1e}, samples {sample:.1e}");
        assert!(value <= 10.0 * VALUE_TOLERANCE, "{backend}, seed {seed}: {value}");
        assert!(pdf.max(sample) <= 10.0 * SAMPLE_TOLERANCE, "{backend}, seed {seed}: {pdf}, {sample}");
    }
}

#[test]
fn random_bits_on_vulkan() {
    hostile(Backend::Vulkan);
}

#[test]
fn random_bits_on_gles_3_0() {
    hostile(Backend::Gl);
}
