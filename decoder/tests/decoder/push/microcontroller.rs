//! The row that the example for microcontrollers draws, against the albedo that a whole file gives.

#[path = "../../../examples/microcontroller/row.rs"]
mod row;

use crate::common::container;
use row::{BUFFER, Painter, Problem};
use subsurf_decoder::bssrdf::layout::MODEL_2BMPP;
use subsurf_decoder::bssrdf::{Addressing, BssrdfHeader, Coding};
use subsurf_decoder::{Bssrdf, PushReader};

const WIDTH: u32 = 11;

/// A patch of three rows that are the same in all columns, of two base materials in a ratio.
fn patch(t: f32) -> Vec<u8> {
    let header = BssrdfHeader {
        model: MODEL_2BMPP,
        coding: Coding::Exact,
        addressing: Addressing::Clamp,
        width: WIDTH,
        height: 3,
        window_radius: 4,
        samples: 6,
        base_materials: 2,
        pitch_mm: 0.25,
        r_max_mm: 1.1,
        eta: 1.4,
    };
    let node = |h: u8, steep: f32, scale: f32| {
        [1.0, 2.0, 3.0].map(|c| scale - 0.2 * c - steep * f32::from(h)).into_iter().flat_map(f32::to_le_bytes)
    };
    let profiles = (0..6).flat_map(|h| node(h, 0.4, -0.8)).chain((0..6).flat_map(|h| node(h, 1.7, 0.4))).collect();
    let ratios = (0..3 * WIDTH).flat_map(|_| t.to_le_bytes()).collect();
    let indices = (0..3 * WIDTH).flat_map(|_| [0, 1]).collect();
    container(&[(b"BSSR", header.to_bytes().to_vec()), (b"PROF", profiles), (b"MIXR", ratios), (b"BIDX", indices)])
}

/// Pixels of a row, from chunks of 64 bytes.
fn draw(bytes: &[u8], y: u32) -> Result<Vec<[u8; 3]>, Problem> {
    let (mut reader, mut painter, mut pixels) = (PushReader::<BUFFER>::new(), Painter::new(y), vec![]);
    let mut drawn = Ok(());
    for chunk in bytes.chunks(64) {
        let pushed = reader.push(chunk, |piece| {
            let took = painter.take(piece, &mut |pixel| pixels.push(pixel));
            drawn = drawn.and(took);
        });
        pushed.map_err(Problem::File).and(drawn)?;
    }
    reader.finish().map_err(Problem::File)?;
    Ok(pixels)
}

/// As IEC 61966-2-1 has it, in f64.
fn srgb(linear: f32) -> f64 {
    let linear = f64::from(linear);
    255.0 * if linear > 0.003_130_8 { 1.055 * linear.powf(1.0 / 2.4) - 0.055 } else { 12.92 * linear }
}

#[test]
fn one_material_has_its_albedo_and_mixtures_are_not_darker() {
    for (t, brighter) in [(1.0, 0.0..0.0), (0.0, 0.0..0.0), (0.5, 1.0..20.0)] {
        let bytes = patch(t);
        let material = Bssrdf::parse(&bytes).unwrap();
        let row = draw(&bytes, 1).unwrap();
        assert_eq!(row.len(), WIDTH as usize);
        // Away from the border a window is the same as anywhere: clamped pixels are like others.
        let expected = material.albedo([5, 1]).map(srgb);
        assert!(expected.iter().all(|value| (20.0..235.0).contains(value)), "{expected:?} tells something");
        for pixel in &row {
            for (found, expected) in pixel.iter().zip(expected) {
                let more = f64::from(*found) - expected;
                assert!(more > brighter.start - 0.51 && more < brighter.end + 0.51, "t = {t}: {pixel:?}, {expected:?}");
            }
        }
    }
}

#[test]
fn what_it_does_not_draw_it_refuses() {
    let other = crate::common::btf::nested();
    assert_eq!(draw(&other, 0), Err(Problem::Unsupported));
    let cut = patch(1.0);
    assert!(matches!(draw(&cut[..cut.len() - 1], 0), Err(Problem::File(_))), "cut");
    assert_eq!(draw(&patch(1.0), 3), Ok(vec![]), "there is no such row");
}
