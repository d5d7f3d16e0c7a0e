//! BTFs: values by the tables beside the vectors, and densities that are those of the samples drawn.
#![allow(clippy::cast_possible_truncation, reason = "numbers of tests are small")]

use std::f64::consts::{FRAC_PI_2, PI};
use std::path::Path;
use subsurf_decoder::btf::factored::{ExpansionBuffers, ExpansionMemory};
use subsurf_decoder::btf::{Texel, View};
use subsurf_decoder::{Evaluate, FactoredBtf, NestedBtf};

const NESTED: [&str; 5] =
    ["nested_display", "nested_log_luv_stages", "nested_materials", "nested_texel_size", "nested_tints"];
const FACTORED: [&str; 2] = ["factored", "factored_stages"];

fn read(name: &str) -> Vec<u8> {
    std::fs::read(Path::new("../tests/vectors").join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Lines of a table: word, arguments, values and tolerance.
fn table(name: &str) -> Vec<(String, Vec<f32>, Vec<f32>, f32)> {
    let text = String::from_utf8(read(&format!("{name}.csv"))).unwrap();
    let numbers = |list: &str| list.split(' ').map(|number| number.parse().unwrap()).collect::<Vec<f32>>();
    let line = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        (fields[0].to_owned(), numbers(fields[1]), numbers(fields[2]), numbers(fields[3])[0])
    };
    text.lines().skip(1).map(line).collect()
}

fn assert_close(found: [f32; 3], due: &[f32], tolerance: f32, what: &str) {
    let is_close = found.iter().zip(due).all(|(found, due)| (found - due).abs() <= tolerance);
    assert!(is_close, "{what}: {found:?} is not {due:?}");
}

/// Values of `btf` as its table has them, by every way to ask for them.
fn assert_values(name: &str, btf: &impl Evaluate) {
    for (word, arguments, values, tolerance) in table(name) {
        if word != "eval" {
            continue;
        }
        let what = format!("{name}: {arguments:?}");
        let texel = texel(btf, &arguments);
        let [light, view] = [4, 7].map(|at| [arguments[at], arguments[at + 1], arguments[at + 2]]);
        assert_close(btf.eval(texel, light, view), &values, tolerance, &what);
        let prepared = btf.catalog().grid().view(view);
        assert_close(btf.eval_for(texel, light, &prepared), &values, tolerance, &what);
        let mut several = [[f32::NAN; 3]; 2];
        let coord = btf.catalog().grid().coord(light, view);
        btf.eval_texels(texel, &coord, &mut several);
        assert_close(several[0], &values, tolerance, &what);
        let next = Texel::from_number(texel.number() + 1);
        assert_eq!(several[1], btf.eval_at(next, &coord), "{what}: the next texel");
    }
}

fn texel(btf: &impl Evaluate, arguments: &[f32]) -> Texel {
    let [material, level, x, y] = [0, 1, 2, 3].map(|at| arguments[at] as i32);
    btf.catalog().texel(material as usize, level as u8, [x, y]).expect("a texel")
}

#[test]
fn nested_values_and_albedos() {
    for name in NESTED {
        let bytes = read(&format!("{name}.subsurf"));
        let btf = NestedBtf::parse(&bytes).unwrap();
        assert_values(name, &btf);
        for (word, arguments, values, tolerance) in table(name) {
            if word == "albedo" {
                let view = [arguments[4], arguments[5], arguments[6]];
                assert_close(btf.albedo(texel(&btf, &arguments), view), &values, tolerance, name);
            }
        }
    }
}

#[test]
fn texels_are_numbered_by_material_level_and_row() {
    // Sizes and levels of three materials.
    let bytes = read("nested_materials.subsurf");
    let btf = NestedBtf::parse(&bytes).unwrap();
    let mut number = 0;
    for (at, material) in btf.materials().enumerate() {
        for level in 0..material.levels {
            let [width, height] = [material.width, material.height].map(|side| (i32::from(side) >> level).max(1));
            assert_eq!(material.size(level).map(u32::cast_signed), [width, height], "level {level}");
            for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
                for [x, y] in [[x, y], [x - width, y + 5 * height]] {
                    let texel = btf.texel(at, level, [x, y]).expect("a texel");
                    assert_eq!(texel.number(), number, "material {at}, level {level}, {x}, {y}");
                }
                number += 1;
            }
        }
        assert_eq!(btf.texel(at, material.levels, [0, 0]), None, "no level");
    }
    assert_eq!(number, btf.catalog().texels());
    assert_eq!(btf.texel(btf.materials().count(), 0, [0, 0]), None, "no material");
}

#[test]
fn factored_values() {
    for name in FACTORED {
        let bytes = read(&format!("{name}.subsurf"));
        let btf = FactoredBtf::parse(&bytes).unwrap();
        let mut memory = ExpansionMemory::default();
        let expanded = btf.expand_in(&mut memory).unwrap();
        assert_values(name, &expanded);
        // Values are those of the channels: of coefficients and columns.
        assert!(expanded.table().iter().all(|step| *step > -128), "steps are −127 to 127");

        // Buffers of the lengths that are asked for, and of one number less.
        let lengths = [btf.table_len(), btf.words_len(), btf.scratch_len()];
        for (lack, is_enough) in [([0, 0, 0], true), ([1, 0, 0], false), ([0, 1, 0], false), ([0, 0, 1], false)] {
            let (mut table, mut words) = (vec![0; lengths[0] - lack[0]], vec![0; lengths[1] - lack[1]]);
            let mut scratch = vec![f32::NAN; lengths[2] - lack[2]];
            let buffers = ExpansionBuffers { table: &mut table, words: &mut words, scratch: &mut scratch };
            let again = btf.expand(buffers);
            assert_eq!(again.is_some(), is_enough, "{lack:?}");
            if let Some(again) = again {
                assert_eq!(again.table(), expanded.table());
            }
        }
    }
}

/// Frame of a view: cosine and sine of its azimuth.
fn azimuth([x, y, _]: [f32; 3]) -> [f64; 2] {
    let length = f64::from(x).hypot(f64::from(y));
    if length > 1e-6 { [f64::from(x) / length, f64::from(y) / length] } else { [1.0, 0.0] }
}

/// Light at α and sin β in the frame of a view.
fn light(alpha: f64, sin_beta: f64, [cos_phi, sin_phi]: [f64; 2]) -> [f32; 3] {
    let cos_beta = (1.0 - sin_beta * sin_beta).max(0.0).sqrt();
    let forward = cos_beta * alpha.sin();
    [forward * cos_phi - sin_beta * sin_phi, forward * sin_phi + sin_beta * cos_phi, cos_beta * alpha.cos()]
        .map(|x| x as f32)
}

/// Middles of `COUNT` equal pieces of a line from −`half` to `half`.
const COUNT: usize = 96;

fn middles(half: f64) -> impl Iterator<Item = f64> {
    (0..COUNT).map(move |k| half * ((2 * k + 1) as f64 / COUNT as f64 - 1.0))
}

#[test]
fn densities_are_those_of_samples() {
    let views = [[0.0, 0.0, 1.0], [0.6, 0.0, 0.8], [-0.48, 0.64, 0.6]];
    for (name, view) in NESTED.into_iter().flat_map(|name| views.map(|view| (name, view))) {
        let bytes = read(&format!("{name}.subsurf"));
        let btf = NestedBtf::parse(&bytes).unwrap();
        let texel = btf.texel(0, 0, [1, 0]).unwrap();
        let (frame, prepared): (_, View) = (azimuth(view), btf.grid().view(view));
        let sampler = btf.sampler(texel, &prepared);
        let pdf = |alpha: f64, sin_beta: f64| f64::from(sampler.pdf(light(alpha, sin_beta, frame)));
        // dω = dα d(sin β).
        let (of_alpha, of_beta) = (PI / COUNT as f64, 2.0 / COUNT as f64);
        let slice = |alpha: f64| middles(1.0).map(|sin_beta| pdf(alpha, sin_beta) * of_beta).sum::<f64>();
        let slices: Vec<(f64, f64)> = middles(FRAC_PI_2).map(|alpha| (alpha, slice(alpha) * of_alpha)).collect();
        let all: f64 = slices.iter().map(|(_, part)| part).sum();
        assert!((all - 1.0).abs() < 0.01, "{name}: densities add up to {all}");

        for random in [[0.02, 0.5], [0.3, 0.1], [0.5, 0.9], [0.77, 0.33], [0.98, 0.6]] {
            let sample = sampler.sample(random);
            assert_eq!(sample, btf.sample(texel, view, random), "{name}: by both ways");
            let [x, y, z] = sample.light.map(f64::from);
            assert!((x.hypot(y).hypot(z) - 1.0).abs() < 1e-5 && z >= 0.0, "{name}: {sample:?}");
            let alpha = (x * frame[0] + y * frame[1]).atan2(z);
            let sin_beta = y * frame[0] - x * frame[1];
            let density = pdf(alpha, sin_beta);
            assert!((density / f64::from(sample.pdf) - 1.0).abs() < 0.01, "{name}: {sample:?}, {density}");
            assert_eq!(btf.pdf(texel, sample.light, view), sampler.pdf(sample.light), "{name}: by both ways");
            // The share of densities before a sample is the random number.
            let before: f64 = slices.iter().filter(|(at, _)| *at < alpha).map(|(_, part)| part).sum();
            assert!((before - f64::from(random[0])).abs() < 0.02, "{name}: {before} of α, not {random:?}");
            let of_slice = slice(alpha);
            let below = middles(1.0).filter(|at| *at < sin_beta).map(|at| pdf(alpha, at) * of_beta).sum::<f64>();
            assert!((below / of_slice - f64::from(random[1])).abs() < 0.02, "{name}: {below} of β, not {random:?}");
        }
        assert_eq!(sampler.pdf([0.6, 0.0, -0.8]), 0.0, "below the horizon");
        // What is no random number is the nearest one.
        assert_eq!(sampler.sample([-3.0, f32::NAN]), sampler.sample([0.0, 0.0]));
        assert_eq!(sampler.sample([7.0, 1.5]), sampler.sample([1.0, 1.0]));
    }
}
