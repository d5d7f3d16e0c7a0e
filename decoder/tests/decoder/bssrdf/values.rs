//! Values of BSSRDFs of every model and coding: profiles, mixtures and Rd, worked out by hand.

use crate::common::{HEADER, bssrdf, floats};
use subsurf_decoder::bssrdf::{Addressing, BssrdfHeader, BssrdfModel, Coding, Knot, Mixture};
use subsurf_decoder::{Bssrdf, Section};

/// Two nodes of rgb for each of three materials, all different.
const PROFILES: [f32; 18] = [
    -1.0, -2.0, -3.0, -4.0, -5.0, -6.0, // material 0
    -1.5, -2.5, -3.5, -4.5, -5.5, -6.5, // material 1
    -7.0, -8.0, -9.0, -10.0, -11.0, -12.0, // material 2
];

fn assert_close(found: [f32; 3], expected: [f64; 3]) {
    for (found, expected) in found.into_iter().zip(expected) {
        assert!((f64::from(found) - expected).abs() <= 2e-6 * expected.abs(), "{found} is not {expected}");
    }
}

/// Base materials and ratios of a pixel of a file; `None` where there is no pixel.
fn mixture(file: &[u8], pixel: usize) -> Mixture {
    let material = Bssrdf::parse(file).unwrap();
    let BssrdfModel::BaseMaterials(planes) = *material.model() else { panic!("base materials") };
    planes.mixtures.at(pixel, 2)
}

/// Σ t P̂_b of a node.
fn blended(parts: &[(usize, f32)], node: usize) -> [f64; 3] {
    [0, 1, 2].map(|c| parts.iter().map(|(b, t)| f64::from(t * PROFILES[6 * b + 3 * node + c])).sum())
}

#[test]
fn every_coding_of_mixtures() {
    let half: Vec<u8> = PROFILES.iter().flat_map(|value| half_bits(*value).to_le_bytes()).collect();
    let (single, header) = (floats(&PROFILES), BssrdfHeader { base_materials: 3, ..HEADER });
    // Files of two pixels, and the parts of both.
    let two = floats(&[1.0, 0.25]);
    let three = floats(&[0.5, 0.0, 0.25, 1.0, 0.25, 0.0]);
    let five = floats(&[0.5, 0.125, 0.25, 0.125, 0.125, 0.25, 0.0625, 0.5, 0.0625, 0.0]);
    let of_model = |model| BssrdfHeader { model, ..header };
    let of_coding = |coding| BssrdfHeader { coding, ..header };
    // Pair 2 with 31/31, pair 1 with 7/31.
    let codes: Vec<u8> = [2 + 31 * 2_048_u16, 1 + 7 * 2_048].iter().flat_map(|code| code.to_le_bytes()).collect();
    type Parts = &'static [(usize, f32)];
    let cases: [(Vec<u8>, [Parts; 2]); 6] = [
        (bssrdf(of_model(1), &[(b"PROF", &single), (b"BIDX", &[2, 1])]), [&[(2, 1.0)], &[(1, 1.0)]]),
        (
            bssrdf(header, &[(b"PRFH", &half), (b"MIXR", &two), (b"BIDX", &[0, 1, 2, 0])]),
            [&[(0, 1.0), (1, 0.0)], &[(2, 0.25), (0, 0.75)]],
        ),
        (
            bssrdf(
                of_coding(Coding::SmallRatios),
                &[(b"PROF", &single), (b"MIX8", &[255, 51]), (b"BIDX", &[0, 1, 2, 0])],
            ),
            [&[(0, 1.0), (1, 0.0)], &[(2, 0.2), (0, 0.8)]],
        ),
        (
            bssrdf(
                of_coding(Coding::Palette),
                &[(b"PROF", &single), (b"CODE", &codes), (b"PAIR", &[0, 0, 2, 1, 1, 2])],
            ),
            [&[(1, 1.0), (2, 0.0)], &[(2, 7.0 / 31.0), (1, 24.0 / 31.0)]],
        ),
        (
            bssrdf(of_model(3), &[(b"PROF", &single), (b"MIXR", &three), (b"BIDX", &[0, 1, 1, 2, 2, 0])]),
            [&[(0, 0.5), (1, 0.25), (2, 0.25)], &[(1, 0.0), (2, 1.0), (0, 0.0)]],
        ),
        (
            bssrdf(of_model(5), &[(b"PROF", &single), (b"MIXR", &five), (b"BIDX", &[0, 1, 1, 2, 2, 0, 0, 1, 1, 2])]),
            [
                &[(0, 0.5), (1, 0.25), (2, 0.125), (0, 0.0625), (1, 0.0625)],
                &[(1, 0.125), (2, 0.125), (0, 0.25), (1, 0.5), (2, 0.0)],
            ],
        ),
    ];
    for (file, pixels) in cases {
        let material = Bssrdf::parse(&file).unwrap();
        for ((x, parts), pixel) in (0_i32..).zip(pixels).zip(0..) {
            let found = mixture(&file, pixel);
            for (k, (base, ratio)) in found.bases.into_iter().zip(found.ratios).enumerate() {
                let (due_base, due_ratio) = parts.get(k).copied().unwrap_or((0, 0.0));
                assert_eq!((usize::from(base), ratio), (due_base, due_ratio), "part {k} of pixel {pixel}");
            }
            let profile = material.profile([x, 0]);
            for node in [0, 1] {
                assert_close(profile.node(node), blended(parts, node));
            }
            assert_close(
                profile.at(Knot { h: 0, w: 0.25 }),
                [0, 1, 2].map(|c| 0.75 * blended(parts, 0)[c] + 0.25 * blended(parts, 1)[c]),
            );
            assert_eq!(profile.node(2), [0.0; 3], "no node");
        }
        let [a, b] = pixels.map(|parts| blended(parts, 0));
        assert_close(material.rd([0, 0], [0, 0]), a.map(f64::exp));
        let knot = material.knot(0.0).unwrap();
        let rd = material.rd_at(&material.profile([0, 0]), &material.profile([1, 0]), knot);
        assert_close(rd, [0, 1, 2].map(|c| (0.5 * (a[c] + b[c])).exp()));
    }
}

/// Bits of a half float of a number that is one.
fn half_bits(value: f32) -> u16 {
    let bits = value.to_bits();
    let (sign, exponent, fraction) = (bits >> 31, bits >> 23 & 0xFF, bits >> 13 & 0x3FF);
    u16::try_from(sign << 15 | (exponent - 112) << 10 | fraction).unwrap()
}

#[test]
fn no_pixel_has_no_part() {
    let (profiles, ratios) = (floats(&PROFILES[..12]), floats(&[1.0, 0.25]));
    let file = bssrdf(HEADER, &[(b"PROF", &profiles), (b"MIXR", &ratios), (b"BIDX", &[0, 1, 1, 0])]);
    assert_eq!(mixture(&file, 2), Mixture::default());
}

#[test]
fn indices_of_two_bytes() {
    let header = BssrdfHeader { model: 1, base_materials: 300, ..HEADER };
    // Node h of material m is −m / 4 for red, h for green, 0 for blue.
    let values = (0..300_u16).flat_map(|m| [-0.25 * f32::from(m), 0.0, 0.0, -0.25 * f32::from(m), 1.0, 0.0]);
    let profiles = floats(&values.collect::<Vec<f32>>());
    let indices = [299_u16, 7].map(u16::to_le_bytes).concat();
    let file = bssrdf(header, &[(b"PROF", &profiles), (b"BIDX", &indices)]);
    let material = Bssrdf::parse(&file).unwrap();
    assert_eq!(material.profile([0, 0]).node(1), [-74.75, 1.0, 0.0]);
    assert_eq!(material.profile([1, 0]).node(0), [-1.75, 0.0, 0.0]);
    assert_eq!(mixture(&file, 0).bases[0], 299);
    assert_eq!(mixture(&file, 2), Mixture::default(), "no pixel");
}

#[test]
fn per_pixel_profiles() {
    let header = BssrdfHeader { model: 0, base_materials: 0, width: 3, height: 2, ..HEADER };
    // Shape [S][rgb][height][width]: the number of the value.
    let values: Vec<f32> = (0..36_u8).map(|k| -f32::from(k)).collect();
    let file = bssrdf(header, &[(b"LSPP", &floats(&values))]);
    let material = Bssrdf::parse(&file).unwrap();
    for (x, y) in (0..3_i32).flat_map(|x| (0..2_i32).map(move |y| (x, y))) {
        for h in [0, 1] {
            let due = [0, 1, 2].map(|c| values[6 * (3 * h + c) + (3 * y + x) as usize]);
            assert_eq!(material.profile([x, y]).node(h), due, "pixel {x}, {y}, node {h}");
        }
    }
    assert_eq!(material.profile([0, 0]).node(2), [0.0; 3]);
}

#[test]
fn windows_knots_and_distances() {
    let header = BssrdfHeader {
        width: 4,
        height: 3,
        window_radius: 2,
        samples: 5,
        base_materials: 1,
        model: 1,
        addressing: Addressing::Repeat,
        r_max_mm: 2.0,
        ..HEADER
    };
    let profiles: Vec<f32> = (0..15_u8).map(|k| -0.5 * f32::from(k)).collect();
    let file = bssrdf(header, &[(b"PROF", &floats(&profiles)), (b"BIDX", &[0; 12])]);
    let material = Bssrdf::parse(&file).unwrap();
    assert_eq!(material.header(), &header);
    assert_eq!(header.pixels(), 12);
    // The window is a square of 5 × 5 pixels: its sides and corners belong to it.
    for (dx, dy, r_mm) in [
        (0, 0, Some(0.0)),
        (2, 0, Some(1.0)),
        (0, -2, Some(1.0)),
        (-2, 1, Some(1.25_f32.sqrt())),
        (2, 2, Some(2.0_f32.sqrt())),
        (3, 0, None),
        (0, -3, None),
        (i32::MIN, 0, None),
    ] {
        assert_eq!(material.distance_mm(dx, dy), r_mm, "{dx}, {dy}");
    }
    // Nodes at 0, ½, 1, 1½ and 2 mm.
    for (r_mm, h, w) in [(0.0, 0, 0.0), (0.25, 0, 0.5), (0.5, 1, 0.0), (1.875, 3, 0.75), (2.0, 3, 1.0)] {
        assert_eq!(material.knot(r_mm), Some(Knot { h, w }), "{r_mm} mm");
    }
    for r_mm in [2.0_f32.next_up(), -f32::MIN_POSITIVE, f32::NAN, f32::INFINITY] {
        assert_eq!(material.knot(r_mm), None, "{r_mm} mm");
    }
    // All pixels are alike: the albedo is the sum over the window, of area ¼ mm² each.
    let rd = |dx: f64, dy: f64, c: f64| (-0.5 * (c + 3.0 * (dx * dx + dy * dy).sqrt())).exp();
    let sum = |c: f64| {
        let offsets = [-2.0, -1.0, 0.0, 1.0, 2.0];
        offsets.iter().flat_map(|dx| offsets.map(|dy| rd(*dx, dy, c))).sum::<f64>() * 0.25
    };
    assert_close(material.albedo([1, 1]), [0.0, 1.0, 2.0].map(sum));
    assert_close(material.rd([1, 1], [3, 0]), [0.0, 1.0, 2.0].map(|c| rd(2.0, 1.0, c)));
    assert_eq!(material.rd([0, 0], [3, 0]), [0.0; 3], "outside the window");
}

#[test]
fn addressing_has_three_modes() {
    for (code, mode) in [(0, Addressing::Clamp), (1, Addressing::Repeat), (2, Addressing::Mirror)] {
        assert_eq!((mode.code(), Addressing::from_code(code)), (code, Some(mode)));
    }
    assert_eq!(Addressing::from_code(3), None);
    for (code, coding) in [(0, Coding::Exact), (1, Coding::SmallRatios), (2, Coding::Palette)] {
        assert_eq!(coding.code(), code);
    }
    // Profiles in half precision are read where both are there.
    let (single, half) = (floats(&[-1.0; 12]), [0_u8; 24]);
    let sections: [(&[u8; 4], &[u8]); 4] =
        [(b"PROF", &single), (b"PRFH", &half), (b"MIXR", &floats(&[1.0, 0.25])), (b"BIDX", &[0, 1, 1, 0])];
    let file = bssrdf(HEADER, &sections);
    let material = Bssrdf::parse(&file).unwrap();
    assert_eq!(material.profile([0, 0]).node(0), [0.0; 3], "{}", Section::HalfProfiles);
    assert!(material.basis().is_none(), "no basis");
}
