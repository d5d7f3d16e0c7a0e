//! The window, on a display that nobody sees.

use std::path::Path;

use crate::common::{SUBSURF, assert_refused, command, finish, run, under_display, without_display};
use subsurf_decoder::bssrdf::Addressing;
use subsurf_encoder::synthetic::{NestedShape, Shape};
use subsurf_scene::torus;
use subsurf_tests::meshes::write_obj;

/// A translucent material and a BTF.
fn materials(folder: &Path) {
    let shape = Shape { size: [9, 7], radius: 2, samples: 4, base_materials: 4, addressing: Addressing::Clamp };
    std::fs::write(folder.join("a.subsurf"), shape.bmpp()).unwrap();
    std::fs::write(folder.join("b.subsurf"), NestedShape::small().database(2).to_bytes()).unwrap();
}

#[test]
fn without_a_display_it_says_so() {
    let folder = tempfile::tempdir().unwrap();
    materials(folder.path());
    let run = finish(without_display(command(folder.path())).args(["view", "a.subsurf"]));
    assert_eq!(run.code, 3, "{}", run.err);
    assert_eq!(run.err.lines().count(), 1, "one line: {}", run.err);
    for word in ["no display", "DISPLAY is set", "subsurf render"] {
        assert!(run.err.contains(word), "\"{word}\" is not in: {}", run.err);
    }
}

#[test]
fn wrong_files_are_refused_before_a_window_opens() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("b.subsurf"), "no material").unwrap();
    assert_refused(&run(folder.path(), "view missing.subsurf"), &["missing.subsurf", "expected a .subsurf file"]);
    assert_refused(&run(folder.path(), "view b.subsurf"), &["b.subsurf"]);
}

#[test]
fn a_window_draws() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    materials(folder);
    write_obj(&folder.join("torus.obj"), &torus(9.0, 4.0, 12));
    for (file, backend) in ["a.subsurf", "b.subsurf"].into_iter().flat_map(|file| ["vulkan", "gl"].map(|on| (file, on)))
    {
        let picture = format!("{file}-{backend}.png");
        let run = under_display(SUBSURF.0, |view| {
            view.current_dir(folder).args(["view", file, "--mesh", "torus.obj"]);
            // Small, for a processor may have to draw it.
            view.args(["--size", "560x240", "--budget", "12MB", "--backend", backend, "--screenshot", &picture]);
            if file == "b.subsurf" {
                view.args(["--samples", "1", "--scene", "studio"]);
            }
        });
        let Some(run) = run else {
            println!("skipped: there is no xvfb-run; apt-get install xvfb");
            return;
        };
        if run.code == 3 {
            println!("{file} {backend} skipped: {}", run.err);
            continue;
        }
        assert_eq!(run.code, 0, "{file} {backend}: {}{}", run.out, run.err);
        assert!(run.out.contains("560 x 240 pixels"), "{file} {backend}: {}", run.out);
        let picture = image::open(folder.join(picture)).unwrap().into_rgb8();
        assert_eq!(picture.dimensions(), (560, 240));
        // Right of the panel: the torus before a dark background.
        let bright = picture.enumerate_pixels().filter(|(x, _, pixel)| *x > 330 && pixel.0.iter().all(|c| *c > 90));
        assert!(bright.count() > 500, "{file} {backend}: the torus is not seen");
    }
}
