//! Interruptions leave no half files, and a fit writes what it has.

use std::process::Stdio;
use std::time::Duration;

use crate::common::{command, files, simulate, succeed};

#[test]
fn an_interrupted_run_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let mut long = command(folder.path());
    long.args(["simulate", "--material", "onyx", "--size", "200", "-o", "a.npy"]).stderr(Stdio::null());
    let mut child = long.spawn().unwrap();
    std::thread::sleep(Duration::from_millis(1_500));
    let kill = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(kill.success(), "the run was still going");
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(files(folder.path()), [""; 0], "no file, no half file");
}

#[test]
fn an_interrupted_fit_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    simulate(folder, "a");
    let mut long = command(folder);
    long.args(["encode", "a.npy", "--method", "yatagawa2020", "-K", "5", "-M", "200"]);
    let mut child = long.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
    std::thread::sleep(Duration::from_millis(1_000));
    let kill = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(kill.success(), "the run was still going");
    let mut out = String::new();
    std::io::Read::read_to_string(&mut child.stdout.take().unwrap(), &mut out).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(130), "{out}");
    assert!(out.contains("interrupted: this is the best model so far"), "{out}");
    succeed(folder, "compare a.npy a.subsurf");
}
