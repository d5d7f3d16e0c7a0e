//! Runs a program in a folder of its own.

use std::path::Path;
use std::process::{Command, Output};

/// Outcome of a run.
pub struct Run {
    /// Exit code; −1 if a signal ended it.
    pub code: i32,
    /// Standard output.
    pub out: String,
    /// Standard error.
    pub err: String,
}

/// Program under test, by the path of its executable.
pub struct Program(pub &'static str);

impl Program {
    /// The program in a folder, to be given arguments.
    #[must_use]
    pub fn command(&self, folder: &Path) -> Command {
        let mut command = Command::new(self.0);
        command.current_dir(folder);
        command
    }

    /// Runs it with arguments separated by spaces.
    #[must_use]
    pub fn run(&self, folder: &Path, args: &str) -> Run {
        finish(self.command(folder).args(args.split_whitespace()))
    }

    /// Runs it, and takes success for granted.
    ///
    /// # Panics
    /// If it fails.
    pub fn succeed(&self, folder: &Path, args: &str) -> Run {
        let run = self.run(folder, args);
        assert_eq!(run.code, 0, "{args}: {}{}", run.out, run.err);
        run
    }

    /// Runs it, and takes JSON on stdout for granted.
    ///
    /// # Panics
    /// If it fails, or prints anything else.
    #[must_use]
    pub fn json(&self, folder: &Path, args: &str) -> serde_json::Value {
        let run = self.succeed(folder, args);
        serde_json::from_str(&run.out).unwrap_or_else(|error| panic!("{args}: {error} in {}", run.out))
    }
}

/// Runs a command to its end.
///
/// # Panics
/// If it does not start, or what it prints is not UTF-8.
pub fn finish(command: &mut Command) -> Run {
    let Output { status, stdout, stderr } = command.output().expect("the command starts");
    let text = |bytes| String::from_utf8(bytes).expect("messages are UTF-8");
    Run { code: status.code().unwrap_or(-1), out: text(stdout), err: text(stderr) }
}

/// Asserts that a run refuses its input: exit code 2, one line on stderr that has all of `words`.
///
/// # Panics
/// If it does not.
pub fn assert_refused(run: &Run, words: &[&str]) {
    assert_eq!(run.code, 2, "{}{}", run.out, run.err);
    assert_eq!(run.err.lines().count(), 1, "one line: {}", run.err);
    for word in words {
        assert!(run.err.contains(word), "\"{word}\" is not in: {}", run.err);
    }
}

/// Names of all files in a folder, sorted.
///
/// # Panics
/// If it is not there.
#[must_use]
pub fn files(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("the folder is there");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// Runs a command under a display that nobody sees, whatever the machine has; `None` where that is not installed.
///
/// # Panics
/// As [`finish`].
pub fn under_display(program: &str, prepare: impl FnOnce(&mut Command)) -> Option<Run> {
    if Command::new("xvfb-run").arg("--help").output().is_err() {
        return None;
    }
    let mut xvfb = without_display(Command::new("xvfb-run"));
    xvfb.args(["-a", program]);
    prepare(&mut xvfb);
    Some(finish(&mut xvfb))
}

/// A command where there is no display, whatever the machine has that tests on it.
#[must_use]
pub fn without_display(mut command: Command) -> Command {
    for key in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        command.env_remove(key);
    }
    command
}
