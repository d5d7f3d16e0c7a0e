//! Fits of captures whose borders are clamped, repeat, or are mirrored.

use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::Addressing;
use subsurf_encoder::bssrdf::Method;
use subsurf_tests::fits::{capture_of_bmpp, fit, kinds, quality, with_holes};
use subsurf_tests::write_capture;

/// One way to address, and the others in the stage `slow`.
const ADDRESSINGS: &[Addressing] =
    if cfg!(feature = "slow") { &[Addressing::Clamp, Addressing::Repeat] } else { &[Addressing::Mirror] };

#[test]
fn finds_a_model_that_is_there() {
    // Seven base materials mixed at random pixel by pixel: nothing to lean on but the entries themselves.
    let folder = tempfile::tempdir().unwrap();
    for addressing in ADDRESSINGS.iter().copied() {
        let path = capture_of_bmpp(folder.path(), [26, 20], 4, addressing);
        let [song, clusters, _, _, direct, ..] = kinds();
        let (song, _) = quality(&path, &fit(&path, song, 1).bytes);
        let (clusters, _) = quality(&path, &fit(&path, clusters, 24).bytes);
        let (direct, psnr) = quality(&path, &fit(&path, direct, 24).bytes);
        println!("{addressing:?}: LSP {song:.5}, clusters {clusters:.5}, direct {direct:.5} and {psnr:.1} dB");
        assert!(song < 0.01, "{addressing:?}: per-pixel profiles can hold it: {song}");
        assert!(direct < 0.25 * clusters, "{addressing:?}: {direct} against {clusters}");
        assert!(psnr > 40.0, "{addressing:?}: {psnr} dB");
    }
}

#[test]
fn missing_entries_weigh_nothing() {
    for addressing in ADDRESSINGS {
        missing_entries_weigh_nothing_with(*addressing);
    }
}

fn missing_entries_weigh_nothing_with(addressing: Addressing) {
    let folder = tempfile::tempdir().unwrap();
    let full = capture_of_bmpp(folder.path(), [26, 20], 4, addressing);
    // The paper's fit ends where chance takes it, with holes or without.
    for kind in kinds().into_iter().filter(|kind| kind.method != Method::Yatagawa2020) {
        // However a hole is written, it is the same hole.
        let by_hole = [0.0, -1.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY].map(|hole| {
            let holes = with_holes(folder.path(), &full, |_| hole);
            fit(&holes, kind, 24)
        });
        for other in &by_hole[1..] {
            assert_eq!(by_hole[0].bytes, other.bytes, "{kind:?}");
        }
        let missing = 1.0 - by_hole[0].measured as f64 / by_hole[0].entries as f64;
        assert!((0.15..0.3).contains(&missing), "{missing}");
        // And what is left is enough: judged by the whole capture, the fit is hardly worse.
        let (whole, _) = quality(&full, &fit(&full, kind, 24).bytes);
        let (holes, _) = quality(&full, &by_hole[0].bytes);
        println!(
            "{addressing:?}, {kind:?}: relative error {whole:.5}, with {:.0} % missing {holes:.5}",
            100.0 * missing
        );
        assert!(holes < 1.3 * whole + 0.002, "{addressing:?}, {kind:?}: {holes} against {whole}");
    }
}

#[test]
fn odd_captures_give_sound_files() {
    let folder = tempfile::tempdir().unwrap();
    let falling = |place: usize, d: usize| {
        let (dx, dy) = ((place % d).abs_diff(d / 2), (place / d).abs_diff(d / 2));
        0.2 * (-((dx * dx + dy * dy) as f32).sqrt()).exp()
    };
    for addressing in ADDRESSINGS.iter().copied() {
        for (name, size, radius) in [
            ("one pixel, no window", [1, 1], 0),
            ("one pixel", [1, 1], 2),
            ("one row, smaller than the window", [5, 1], 4),
            ("constant", [9, 8], 2),
        ] {
            let path = write_capture(folder.path(), "odd.npy", size, radius, addressing, |_, place, c| {
                // One colour channel measured nothing at all.
                if c == 1 { f32::NAN } else { falling(place, 2 * radius + 1) }
            });
            for kind in kinds() {
                // More base materials than there are distinct profiles.
                let encoded = fit(&path, kind, 40);
                let material = Bssrdf::parse(&encoded.bytes).unwrap();
                let rd = material.rd([0, 0], [0, 0]);
                assert!((rd[0] - 0.2).abs() < 0.01 && (rd[2] - 0.2).abs() < 0.01, "{name}, {addressing:?}: {rd:?}");
                // Those that no pixel has are left out.
                let distinct = if (name, addressing) == ("constant", Addressing::Repeat) { 5 } else { 40 };
                let bases = material.header().base_materials;
                assert!(bases <= distinct, "{name}, {addressing:?}, {kind:?}: {bases} base materials");
            }
        }
    }
}
