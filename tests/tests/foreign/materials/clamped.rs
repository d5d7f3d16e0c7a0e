//! Values below zero, which fits of others leave behind: counted, and 0 from then on.

use glam::Vec3;
use subsurf_encoder::capture::{Images, Rgl, check_images, open_btf};

use super::Warnings;
use super::broken::btf;
use super::bsdf::BSDF;

#[test]
fn values_below_zero_are_counted() {
    let place = tempfile::tempdir().unwrap();
    let mut ubo = btf();
    // The second pixel's row of S V, the last float.
    let at = ubo.len() - 4;
    ubo[at..].copy_from_slice(&(-0.5_f32).to_le_bytes());
    let all = open_lights(&BSDF.negative());
    for (name, file, count) in [
        ("whole.btf", btf(), 0),
        ("negative.btf", ubo, 2),
        ("whole.bsdf", BSDF.file(), 0),
        ("negative.bsdf", BSDF.negative(), all),
    ] {
        let path = place.path().join(name);
        std::fs::write(&path, file).unwrap();
        let source = open_btf(&path).unwrap();
        let (checked, loaded) = (Warnings::default(), Warnings::default());
        check_images(source.as_ref(), &checked).unwrap();
        let images = Images::load(source.as_ref(), &loaded).unwrap();
        let lines = checked.into_lines();
        assert_eq!(lines, loaded.into_lines(), "{name}: both say the same");
        match count {
            0 => assert_eq!(lines, [""; 0], "{name}"),
            _ => assert!(
                lines.len() == 1 && lines[0].contains(&format!("{name}: {count} of ")),
                "{name}: {count} are in {lines:?}"
            ),
        }
        let values = (0..images.pairs()).flat_map(|pair| images.image(pair));
        assert!(values.flatten().all(|value| value >= 0.0), "{name}");
    }
}

/// Pairs of a light and a view of a file all of whose values are below zero; `eval` makes 0 of them.
fn open_lights(file: &[u8]) -> usize {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("negative.bsdf");
    std::fs::write(&path, file).unwrap();
    let rgl = Rgl::open(&path).unwrap();
    assert_eq!(rgl.eval(Vec3::new(0.6, 0.0, 0.8), Vec3::Z), [0.0; 3], "nothing is negative");
    let source = open_btf(&path).unwrap();
    source.lights().len() * source.views().len()
}
