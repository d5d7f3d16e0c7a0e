//! BSSRDFs: Rd, profiles, mixtures and albedo of any file that is accepted.
#![no_main]

use libfuzzer_sys::{fuzz_mutator, fuzz_target};
use subsurf_decoder::bssrdf::BssrdfModel;
use subsurf_decoder::bssrdf::layout::{MAX_LOG, SUM_TOLERANCE};
use subsurf_decoder::container::Crc;
use subsurf_decoder::{Bssrdf, Section};
use subsurf_fuzz::{Arguments, check_error, mutate};

/// Largest window whose albedo is summed up.
const MOST_RADIUS: u16 = 3;
/// Largest magnitude of a profile: ratios add up to little more than 1.
const MOST_LOG: f32 = MAX_LOG * (1.0 + 2.0 * SUM_TOLERANCE);

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    mutate(data, size, max_size, seed, Section::BssrdfHeader)
});

fuzz_target!(|input: &[u8]| {
    match Bssrdf::parse_with(input, Crc::Skip) {
        Err(error) => check_error(error, input),
        Ok(material) => {
            let mut arguments = Arguments::behind_file(input);
            // Anywhere, then near each other and often in the patch.
            let anywhere = [arguments.integer(), arguments.integer(), arguments.integer(), arguments.integer()];
            let near = anywhere.map(|at| at % 8);
            for [x, y, other_x, other_y] in [anywhere, near] {
                reflectance(&material, [x, y], [other_x, other_y]);
            }
            knots(&material, arguments.number(), near);
        }
    }
});

/// Rd between two pixels, their mixtures, and the albedo of one.
fn reflectance(material: &Bssrdf<'_>, x_i: [i32; 2], x_o: [i32; 2]) {
    let header = material.header();
    let rd = material.rd(x_i, x_o);
    assert_eq!(rd, material.rd(x_o, x_i), "Rd is symmetric");
    let [dx, dy] = [0, 1].map(|axis| i64::from(x_i[axis]) - i64::from(x_o[axis]));
    let radius = i64::from(header.window_radius);
    let is_inside = dx.abs() <= radius && dy.abs() <= radius;
    let r_mm = if is_inside { ((dx * dx + dy * dy) as f32).sqrt() * header.pitch_mm } else { f32::INFINITY };
    if r_mm <= header.r_max_mm {
        assert!(rd.iter().all(|rd| rd.is_normal() && *rd > 0.0), "{rd:?} at {r_mm} mm");
    } else {
        assert_eq!(rd, [0.0; 3], "outside the window, or beyond r_max, at {r_mm} mm");
    }
    if header.window_radius <= MOST_RADIUS {
        let albedo = material.albedo(x_o);
        assert!(albedo.iter().all(|albedo| *albedo >= 0.0), "{albedo:?}");
    }
    let BssrdfModel::BaseMaterials(planes) = material.model() else { return };
    let [column, row] = [(x_i[0], header.width), (x_i[1], header.height)].map(|(x, n)| header.addressing.map(x, n));
    assert!(column < header.width && row < header.height, "{x_i:?} leads into the patch");
    let pixels = header.pixels() as usize;
    let mixture = planes.mixtures.at(row as usize * header.width as usize + column as usize, pixels);
    assert!(mixture.ratios.iter().all(|t| (0.0..=1.0).contains(t)), "{mixture:?}");
    assert!((mixture.ratios.iter().sum::<f32>() - 1.0).abs() <= SUM_TOLERANCE + 1e-6, "{mixture:?}");
    assert!(mixture.bases.iter().all(|base| u32::from(*base) < header.base_materials), "{mixture:?}");
}

/// Place of a distance on a profile, and the profile there.
fn knots(material: &Bssrdf<'_>, r_mm: f32, [x, y, ..]: [i32; 4]) {
    let header = material.header();
    let profile = material.profile([x, y]);
    let is_on = (0.0..=header.r_max_mm).contains(&r_mm);
    for r_mm in [r_mm, header.r_max_mm, 0.0] {
        let Some(knot) = material.knot(r_mm) else {
            assert!(!is_on, "{r_mm} mm is on the profile");
            continue;
        };
        assert!(knot.h + 2 <= header.samples.into() && (0.0..=1.0).contains(&knot.w), "{knot:?}");
        let value = profile.at(knot);
        assert!(value.iter().all(|value| value.abs() <= MOST_LOG), "{knot:?}: {value:?}");
    }
    assert_eq!(profile.node(header.samples.into()), [0.0; 3], "no node");
}
