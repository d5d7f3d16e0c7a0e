//! The window, on a display that nobody sees.

#![cfg(target_os = "linux")]

mod common;

use std::path::Path;
use std::process::Command;

use common::{assert_refused, command, finish, run, simulate, succeed};

fn material(folder: &Path) {
    simulate(folder, "a");
    succeed(folder, "encode a.npy -M 4 --method clusters -o a.subsurf");
}

/// Where there is no display, whatever the machine has that tests on it.
fn without_display(mut command: Command) -> Command {
    for key in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        command.env_remove(key);
    }
    command
}

#[test]
fn without_a_display_it_says_so() {
    let folder = tempfile::tempdir().unwrap();
    material(folder.path());
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
fn a_window_draws_and_survives_the_loss_of_its_device() {
    if Command::new("xvfb-run").arg("--help").output().is_err() {
        println!("skipped: there is no xvfb-run; apt-get install xvfb");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    material(folder);
    succeed(folder, "simulate btf wood --size 16 -o wood");
    succeed(folder, "encode btf wood --p4 64 -o wood.subsurf");
    for (file, backend) in
        ["a.subsurf", "wood.subsurf"].into_iter().flat_map(|file| ["vulkan", "gl"].map(|on| (file, on)))
    {
        let picture = format!("{file}-{backend}.png");
        let mut xvfb = without_display(Command::new("xvfb-run"));
        xvfb.current_dir(folder).args(["-a", env!("CARGO_BIN_EXE_subsurf"), "view", file, "--mesh", "torus"]);
        // Small, for a processor may have to draw it.
        xvfb.args(["--size", "560x240", "--budget", "12MB", "--lose-device-after", "3"]);
        xvfb.args(["--backend", backend, "--screenshot", &picture]);
        let run = finish(&mut xvfb);
        if run.code == 3 {
            println!("{file} {backend} skipped: {}", run.err);
            continue;
        }
        assert_eq!(run.code, 0, "{file} {backend}: {}{}", run.out, run.err);
        assert!(run.err.contains("the device was lost and opened anew"), "{file} {backend}: {}", run.err);
        let picture = image::open(folder.join(picture)).unwrap().into_rgb8();
        assert_eq!(picture.dimensions(), (560, 240));
        // Right of the panel: the torus before a dark background.
        let bright = picture.enumerate_pixels().filter(|(x, _, pixel)| *x > 330 && pixel.0.iter().all(|c| *c > 90));
        assert!(bright.count() > 500, "{file} {backend}: the torus is not seen");
    }
}
