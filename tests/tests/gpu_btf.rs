//! BTFs on Vulkan and on OpenGL ES 3.0 against the decoder.

use glam::Vec3;
use subsurf_decoder::NestedBtf;
use subsurf_decoder::btf::{ColourEncoding, Grid, Texel};
use subsurf_decoder::container::Crc;
use subsurf_encoder::capture::bonn;
use subsurf_encoder::synthetic::{NestedShape, unit};
use subsurf_runtime::{Backend, BtfAnswer, BtfImages, BtfLayout, BtfMaterial, BtfQueries, BtfQuery, Gpu};
use subsurf_tests::frames::device;
use subsurf_tests::nested::{ODD_GRID, direction, single};

/// Of the larger of a value and a hundredth of the material's brightest. Directions are off by 1e-6 rad, nodes 0.3 rad
/// apart; logarithmic tones turn 1e-6 of a step into some 1e-5, and so do powers in display tones.
const VALUE_TOLERANCE: f32 = 3e-4;
/// Of unit vectors, and of densities as shares of themselves: a sum of ten to a hundred f32 is divided by one of 1/32 of it.
const SAMPLE_TOLERANCE: f32 = 1e-3;

/// The kinds of files that the benchmark of the decoder uses, and odd ones.
fn files() -> Vec<(&'static str, Vec<u8>)> {
    let typical = NestedShape { materials: vec![(32, 32, 1)], ..NestedShape::typical() };
    let small = NestedShape::small();
    let large = Grid { n_alpha: 64, n_beta: 63, n_theta: 5, n_phi: 64, ..Grid::PAPER };
    let bright = ColourEncoding::LogLuv { toe: 0.01, peak: 20.0 };
    let shapes = [
        ("display", typical.clone()),
        ("one colour", NestedShape { chroma: [4096, 1, 1, 1], ..typical.clone() }),
        ("relative and tints", NestedShape { is_relative: true, tints: 64, ..typical.clone() }),
        ("LogLuv", NestedShape { tone: bright, ..typical.clone() }),
        ("three stages", NestedShape { stages: 3, luma: [512, 1024, 1024, 512], ..typical.clone() }),
        ("four stages", NestedShape { stages: 4, tints: 5, materials: vec![(5, 3, 3), (1, 7, 2)], ..small.clone() }),
        ("odd grid", NestedShape { grid: ODD_GRID, tone: bright, is_relative: true, tints: 1, ..small.clone() }),
        ("wide codes", NestedShape { scale_bits: 10, ..small.clone() }),
        ("large grid", NestedShape { grid: large, ..small }),
    ];
    (0..).zip(shapes).map(|(seed, (name, shape))| (name, shape.database(seed).to_bytes())).collect()
}

/// Random texels of all materials and levels, lights and views, some of them below the horizon or straight above.
fn queries(btf: &NestedBtf<'_>, count: u32) -> (Vec<Texel>, Vec<BtfQuery>) {
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
        let texel = btf.texel(material, level, at).unwrap();
        let query = BtfQuery {
            texel: texel.number(),
            light: towards(0),
            view: if n % 16 == 2 { single(direction([random(2), random(3)])) } else { towards(2) },
            random: [random(6), random(7)],
        };
        (texel, query)
    };
    (0..count).map(query).unzip()
}

/// What the decoder says.
fn expected(btf: &NestedBtf<'_>, texel: Texel, query: &BtfQuery) -> BtfAnswer {
    let BtfQuery { light, view, random, .. } = *query;
    BtfAnswer {
        value: btf.header().encoding.linear(btf.eval(texel, light, view)),
        pdf: btf.pdf(texel, light, view),
        sample: btf.sample(texel, view, random),
    }
}

/// Largest errors of values, densities and samples, in tolerances.
fn errors(btf: &NestedBtf<'_>, (texels, queries): &(Vec<Texel>, Vec<BtfQuery>), found: &[BtfAnswer]) -> [f32; 3] {
    assert_eq!(queries.len(), found.len(), "every query is answered");
    let wanted = texels.iter().zip(queries).map(|(texel, query)| expected(btf, *texel, query));
    let wanted: Vec<BtfAnswer> = wanted.collect();
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
    let answers = BtfQueries::new(&gpu, BtfLayout::Nested).unwrap();
    for (name, file) in files() {
        let btf = NestedBtf::parse(&file).unwrap();
        let before = gpu.ledger().bytes();
        let material = BtfMaterial::upload(&gpu, &btf).unwrap();
        assert_eq!(gpu.ledger().bytes() - before, material.gpu_bytes(), "{name}: counted");
        assert!(material.gpu_bytes() < file.len() as u64 + (10 << 10), "{name}: as large as the file, but for a row");
        let queries = queries(&btf, 6_000);
        let found = answers.answer(&gpu, &material, &queries.1).unwrap();
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
    let answers = BtfQueries::new(&gpu, BtfLayout::Nested).unwrap();
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
        let btf = NestedBtf::parse_with(&file, Crc::Skip).unwrap();
        let material = BtfMaterial::upload(&gpu, &btf).unwrap();
        let queries = queries(&btf, 3_000);
        let found = answers.answer(&gpu, &material, &queries.1).unwrap();
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

/// A pixel of an image that nothing else looks like.
fn pixel(light: usize, view: usize, texel: usize) -> [u8; 3] {
    let number = u32::try_from((light * 81 + view) * 12 + texel).unwrap();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a byte")]
    [0, 1, 2].map(|c| (255.0 * unit(3 * number + c)) as u8)
}

/// At measured directions, images are what they are; between two of them, halfway between.
fn images(backend: Backend) {
    let gpu = gles(backend);
    let answers = BtfQueries::new(&gpu, BtfLayout::Images).unwrap();
    let directions: Vec<Vec3> = bonn().iter().map(|direction| direction.unit()).collect();
    let images = BtfImages { size: [4, 3], lights: &directions, views: &directions, white: 2.0 };
    let before = gpu.ledger().bytes();
    let image = |light, view| (0..12).map(|texel| pixel(light, view, texel)).collect();
    let material = BtfMaterial::upload_images(&gpu, &images, image).unwrap();
    assert_eq!(gpu.ledger().bytes() - before, material.gpu_bytes(), "counted");
    assert!((81 * 81 * 12 * 4..81 * 81 * 12 * 4 + 2_000).contains(&material.gpu_bytes()), "four bytes a pixel");

    let tone = ColourEncoding::Display { white: 2.0 };
    let query = |texel: usize, light: Vec3, view: Vec3| BtfQuery {
        texel: u32::try_from(texel).unwrap(),
        light: light.to_array(),
        view: view.to_array(),
        random: [0.25, 0.5],
    };
    let display = |light, view, texel| pixel(light, view, texel).map(|byte| f32::from(byte) / 255.0);
    let (mut queries, mut expected) = (Vec::new(), Vec::new());
    for (light, view) in (0..81).flat_map(|light| (0..81).map(move |view| (light, view))) {
        let texel = (light * 5 + view) % 12;
        queries.push(query(texel, directions[light], directions[view]));
        expected.push(tone.linear(display(light, view, texel)));
    }
    // Around the ring at 75°, which has 24 directions from number 57 on; the last and the first are neighbours.
    for k in 0..24 {
        let (one, next) = (57 + k, 57 + (k + 1) % 24);
        let phi = (k as f32 + 0.5) * 15_f32.to_radians();
        let (sin, cos) = 75_f32.to_radians().sin_cos();
        queries.push(query(k % 12, directions[20], Vec3::new(sin * phi.cos(), sin * phi.sin(), cos)));
        let (a, b) = (display(20, one, k % 12), display(20, next, k % 12));
        expected.push(tone.linear([0, 1, 2].map(|c| 0.5 * (a[c] + b[c]))));
    }
    let found = answers.answer(&gpu, &material, &queries).unwrap();
    let errors = found.iter().zip(&expected).flat_map(|(a, b)| (0..3).map(move |c| (a.value[c] - b[c]).abs()));
    let worst = errors.fold(0.0, f32::max);
    println!("{backend}: images are off by {worst:.1e} of 2");
    assert!(worst <= VALUE_TOLERANCE, "{backend}: {worst}");
    for answer in &found {
        let [x, y, z] = answer.sample.light;
        assert!((x * x + y * y + z * z - 1.0).abs() < 1e-3 && z > 0.0, "a direction above: {answer:?}");
        assert!((answer.sample.pdf - z / std::f32::consts::PI).abs() < 1e-3, "by its cosine: {answer:?}");
    }
}

#[test]
fn images_on_vulkan() {
    images(Backend::Vulkan);
}

#[test]
fn images_on_gles_3_0() {
    images(Backend::Gl);
}
