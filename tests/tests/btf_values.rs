//! Values of BTF files against eq. 4 of Havran et al. 2010, worked out in f64 from what the files were made of.

use subsurf_decoder::NestedBtf;
use subsurf_decoder::btf::{ColourEncoding, Grid};
use subsurf_encoder::btf::nested::Database;
use subsurf_encoder::synthetic::{NestedShape, unit};
use subsurf_tests::nested::{ODD_GRID, angles, direction, single, value};

/// Files of every kind.
fn databases() -> Vec<Database> {
    let small = NestedShape::small();
    let bright = ColourEncoding::LogLuv { toe: 0.01, peak: 9.0 };
    let shapes = [
        small.clone(),
        NestedShape { stages: 4, tints: 5, materials: vec![(5, 3, 3), (1, 7, 2)], ..small.clone() },
        NestedShape { is_relative: true, tints: 3, stages: 2, ..small.clone() },
        NestedShape { grid: ODD_GRID, tone: bright, ..small.clone() },
        NestedShape { chroma: [7, 1, 1, 1], grid: ODD_GRID, is_relative: true, ..small.clone() },
        // Codes of P2 of more than a byte.
        NestedShape { scale_bits: 10, ..small },
        NestedShape { materials: vec![(16, 16, 1)], ..NestedShape::typical() },
    ];
    (0..).zip(shapes).map(|(seed, shape)| shape.database(seed)).collect()
}

/// The largest error over random texels and directions, of values up to about 1.
fn largest_error(database: &Database, count: u32) -> f64 {
    let file = database.to_bytes();
    let btf = NestedBtf::parse(&file).unwrap();
    let errors = (0..count).map(|n| {
        let random = |k: u32| unit(8 * n + k);
        let (light, view) = (direction([random(0), random(1)]), direction([random(2), random(3)]));
        let material = &database.materials[0];
        #[allow(clippy::cast_possible_truncation, reason = "texels")]
        let [x, y] = [0, 1].map(|k| (random(4 + k) * f32::from([material.width, material.height][k as usize])) as i32);
        let texel = btf.texel(0, 0, [x, y]).unwrap();
        let number = usize::try_from(y * i32::from(material.width) + x).unwrap();
        let expected = value(database, number, light, view);
        let found = btf.eval(texel, single(light), single(view));
        let prepared = btf.eval_for(texel, single(light), &btf.grid().view(single(view)));
        let error =
            |found: [f32; 3]| found.iter().zip(expected).map(|(a, b)| (f64::from(*a) - b).abs()).fold(0.0, f64::max);
        let scale = expected.iter().fold(1.0_f64, |a, b| a.max(*b));
        error(found).max(error(prepared)) / scale
    });
    errors.fold(0.0, f64::max)
}

#[test]
fn values_are_those_of_equation_4() {
    for (k, database) in databases().iter().enumerate() {
        let error = largest_error(database, 3_000);
        // Directions are off by 1e-6 rad, nodes 0.3 rad apart.
        assert!(error < 1e-4, "file {k}: {error}");
    }
}

#[test]
fn values_are_not_all_the_same() {
    // What the comparison above would not see: black, or clamped.
    for (k, database) in databases().iter().enumerate() {
        let values =
            (0..200).map(|n| value(database, 0, direction([unit(n), unit(n + 999)]), angles(30.0, f64::from(n)))[1]);
        let values: Vec<f64> = values.collect();
        let mean = values.iter().sum::<f64>() / 200.0;
        let spread = values.iter().map(|value| (value - mean).abs()).sum::<f64>() / 200.0;
        assert!(mean > 0.02 && spread > 0.005, "file {k}: {mean} {spread}");
        assert!(values.iter().filter(|value| **value >= 1.0).count() < 100, "file {k}: clamped");
    }
}

#[test]
fn texels_of_all_materials_and_levels_are_found() {
    let shape = NestedShape { materials: vec![(5, 3, 3), (1, 7, 2)], ..NestedShape::small() };
    let database = shape.database(5);
    let file = database.to_bytes();
    let btf = NestedBtf::parse(&file).unwrap();
    let (light, view) = (angles(20.0, 40.0), angles(50.0, 200.0));
    // 5 × 3, 2 × 1 and 1 × 1 texels of the first material; 1 × 7 and 1 × 3 of the second.
    let first_texels = [(0, 0, 0), (0, 1, 15), (0, 2, 17), (1, 0, 18), (1, 1, 25)];
    for (material, level, first) in first_texels {
        let [width, height] = database.materials[material].size(level).map(u32::cast_signed);
        for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
            let number = first + usize::try_from(y * width + x).unwrap();
            let expected = value(&database, number, light, view);
            for repeated in [[x, y], [x - width, y + 4 * height]] {
                let texel = btf.texel(material, level, repeated).unwrap();
                let found = btf.eval(texel, single(light), single(view));
                let error = found.iter().zip(expected).map(|(a, b)| (f64::from(*a) - b).abs()).fold(0.0, f64::max);
                assert!(error < 1e-4, "material {material}, level {level}, ({x}, {y}): {found:?} {expected:?}");
            }
        }
    }
    assert!(btf.texel(2, 0, [0, 0]).is_none() && btf.texel(0, 3, [0, 0]).is_none(), "there is no such texel");
    assert_eq!(btf.texel(0, 0, [i32::MIN, i32::MAX]), btf.texel(0, 0, [2, 1]));
}

#[test]
fn lights_fade_out_at_the_horizon() {
    let grid = Grid { cos_light_min: 0.25, ..NestedShape::small().grid };
    let database = NestedShape { grid, ..NestedShape::small() }.database(3);
    let file = database.to_bytes();
    let btf = NestedBtf::parse(&file).unwrap();
    let texel = btf.texel(0, 0, [1, 1]).unwrap();
    let view = grid.view(single(angles(40.0, 10.0)));
    let cell = grid.coord_for(single(angles(60.0, 100.0)), &view);
    let full = btf.eval_at(texel, &cell);
    for (cos, expected) in [(0.5_f32, 1.0), (0.25, 1.0), (0.1, 0.4), (0.0, 0.0), (-0.5, 0.0)] {
        let light = [0.0, (1.0 - cos * cos).sqrt(), cos];
        let fade = grid.coord_for(light, &view).fade;
        assert!((fade - expected).abs() < 1e-6, "cos θ = {cos}: {fade}");
        let faded = btf.eval_at(texel, &subsurf_decoder::btf::GridCoord { fade, ..cell });
        for (faded, full) in faded.into_iter().zip(full) {
            assert!((faded - full * expected).abs() < 1e-6, "{faded} {full}");
        }
    }
}
