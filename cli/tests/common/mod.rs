//! Runs the command in a folder of its own.

#![allow(dead_code, reason = "every test file takes what it needs")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

pub(crate) struct Run {
    pub(crate) code: i32,
    pub(crate) out: String,
    pub(crate) err: String,
}

/// The command, to be given arguments.
pub(crate) fn command(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_subsurf"));
    command.current_dir(folder);
    command
}

pub(crate) fn finish(command: &mut Command) -> Run {
    let Output { status, stdout, stderr } = command.output().expect("the command starts");
    let text = |bytes| String::from_utf8(bytes).expect("messages are UTF-8");
    Run { code: status.code().unwrap_or(-1), out: text(stdout), err: text(stderr) }
}

/// Runs with arguments separated by spaces.
pub(crate) fn run(folder: &Path, args: &str) -> Run {
    finish(command(folder).args(args.split_whitespace()))
}

/// Runs, and takes success for granted.
pub(crate) fn succeed(folder: &Path, args: &str) -> Run {
    let run = run(folder, args);
    assert_eq!(run.code, 0, "subsurf {args}: {}{}", run.out, run.err);
    run
}

/// Runs, and takes JSON on stdout for granted.
pub(crate) fn json(folder: &Path, args: &str) -> Value {
    let run = succeed(folder, args);
    serde_json::from_str(&run.out).unwrap_or_else(|error| panic!("subsurf {args}: {error} in {}", run.out))
}

/// Asserts that a run refuses its input: exit code 2, one line on stderr that has all of `words`.
pub(crate) fn assert_refused(run: &Run, words: &[&str]) {
    assert_eq!(run.code, 2, "{}{}", run.out, run.err);
    assert_eq!(run.err.lines().count(), 1, "one line: {}", run.err);
    for word in words {
        assert!(run.err.contains(word), "\"{word}\" is not in: {}", run.err);
    }
}

/// A tiny simulated capture, `NAME.npy`.
pub(crate) fn simulate(folder: &Path, name: &str) -> PathBuf {
    succeed(folder, &format!("simulate --scene chessboard --size 9x7 --window 5 --thickness 5 -o {name}.npy"));
    folder.join(format!("{name}.npy"))
}

/// Names of all files in a folder.
pub(crate) fn files(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("the folder is there");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}
