//! Scattering precomputed for a mesh: made, shown and judged.

use subsurf_scene::torus;
use subsurf_tests::meshes::write_obj;

use crate::common::{assert_refused, json, run, succeed};

#[test]
fn a_transfer_is_made_shown_and_judged() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let made = "transfer sphere --extent 12 --material skin1 --lights 60 --grey --clusters 16 -o ball.subsurf";
    let made = succeed(folder, made);
    assert!(made.out.contains("60 lights, 1 channels") && made.out.contains("6 bytes for each vertex"), "{}", made.out);
    let info = json(folder, "info ball.subsurf --json");
    assert_eq!(
        (info["model"].as_str(), info["lights"].as_u64(), info["clusters"].as_u64(), info["axes"].as_u64()),
        (Some("transfer"), Some(60), Some(16), Some(43))
    );
    let text = succeed(folder, "info ball.subsurf").out;
    assert!(
        text.contains("for the mesh of CRC-32")
            && text.contains("along 43 axes")
            && text.contains("XVTX (codes of vertices)"),
        "{text}"
    );

    let judged = json(folder, "compare sphere ball.subsurf --extent 12 --json");
    let number = |of: &str, what: &str| judged[of][what].as_f64().unwrap();
    assert!(judged["rms_q"].as_f64().unwrap() < 0.01, "{judged}");
    assert!(number("compression", "max") < 0.01, "{judged}");
    assert!(number("total", "rms") < 0.6 * number("four_nearest", "rms"), "{judged}");

    let drawn = json(folder, "render ball.subsurf --mesh sphere --extent 12 --size 64x48 -o ball.png --json");
    assert!(drawn["gpu_bytes"].as_u64().is_some_and(|bytes| bytes > 0), "{drawn}");
    let picture = image::open(folder.join("ball.png")).unwrap().into_rgb8();
    assert_ne!(picture.get_pixel(32, 24), picture.get_pixel(0, 0), "a ball before its background");
    for (options, reasons) in [
        ("--mesh sphere --extent 13", ["precomputed for these triangles in another size", "extent"]),
        ("--mesh knot", ["precomputed for another mesh", "CRC-32"]),
        ("--mesh sphere --extent 12 --scene hero", ["--scene hero", "mesh alone"]),
        ("--mesh sphere --extent 12 --technique splat", ["--technique transfer", "only"]),
        ("", ["--mesh", "mesh"]),
    ] {
        let refused = run(folder, &format!("render ball.subsurf {options} --size 64x48 -o none.png"));
        assert_refused(&refused, &reasons);
    }

    write_obj(&folder.join("torus.obj"), &torus(4.0, 1.5, 10));
    let chosen = "transfer torus.obj --extent 11 --material marble --grey --target-error 0.12 -o chosen.subsurf";
    let chosen = succeed(folder, chosen).out;
    assert!(chosen.contains("e_rms of the worst view") && chosen.contains("50 lights, 1 channels"), "{chosen}");
    let judged = json(folder, "compare torus.obj chosen.subsurf --extent 11 --json");
    assert!(judged["total"]["max"].as_f64().unwrap() <= 0.12, "{judged}");
    let vertices = torus(4.0, 1.5, 10).positions.len() as u64;
    let sized = "transfer torus.obj --extent 11 --material marble --grey --target-bytes-per-vertex 40 -o sized.subsurf";
    succeed(folder, sized);
    let bytes = std::fs::metadata(folder.join("sized.subsurf")).unwrap().len();
    assert!(bytes <= 40 * vertices && bytes > 20 * vertices, "{bytes} bytes for {vertices} vertices");
    for (options, reason) in [
        ("--target-error 0", "above 0"),
        ("--target-error 0.1 --lights 20", "cannot be used with"),
        ("--target-bytes-per-vertex nan", "above 0"),
        ("--target-bytes-per-vertex 0.5", "bytes per vertex, and one channel takes less"),
        ("--target-bytes-per-vertex 9 --bits 20", "cannot be used with"),
    ] {
        let refused = run(folder, &format!("transfer torus.obj --material skin1 {options} -o none.subsurf"));
        assert_refused(&refused, &[reason]);
    }

    let other = run(folder, "compare sphere ball.subsurf --extent 13");
    assert_refused(&other, &["the file is for another mesh"]);
    let coarse = run(folder, "transfer sphere --extent 5000 --material ketchup --lights 4 --grey -o coarse.subsurf");
    assert!(coarse.err.contains("too coarse for the material"), "{}", coarse.err);
    let none = run(folder, "transfer sphere --material skin1 --components 17 -o none.subsurf");
    assert_refused(&none, &["17 components", "expected 1 to 256, 1 to 16"]);
}
