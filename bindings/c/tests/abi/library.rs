//! The library as apps link it, and programs that do.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// Folder of the bindings.
pub(crate) fn bindings() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Runs a command, and takes success for granted; what it printed.
pub(crate) fn run(command: &mut Command) -> String {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let [out, err] = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    assert!(output.status.success(), "{command:?}: {}\n{out}{err}", output.status);
    out
}

/// Folder of `libsubsurf_decoder`, which is built once, in the profile that apps get.
pub(crate) fn folder() -> &'static Path {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| {
        let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().expect("a folder in the target's");
        let mut build = Command::new(env!("CARGO"));
        build.args(["build", "--quiet", "--locked", "--profile", "bindings", "-p", "subsurf-c-decoder"]);
        run(build.arg("--target-dir").arg(target).current_dir(bindings()));
        target.join("bindings")
    })
}

/// The library's file.
pub(crate) fn library() -> PathBuf {
    folder().join(format!("{}subsurf_decoder{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX))
}

/// Languages of programs, with their compilers.
#[derive(Clone, Copy)]
pub(crate) enum Language {
    C,
    Cpp,
}

impl Language {
    /// The compiler, as make names it; standard and warnings.
    fn compiler(self) -> Command {
        let (variable, usual, standard) = match self {
            Self::C => ("CC", "cc", "-std=c99"),
            Self::Cpp => ("CXX", "c++", "-std=c++11"),
        };
        let mut command = Command::new(std::env::var_os(variable).unwrap_or_else(|| usual.into()));
        command.args([standard, "-g", "-O1", "-Wall", "-Wextra", "-Werror", "-pedantic"]);
        command
    }

    /// Whether it compiles, with these options too; says so if not.
    pub(crate) fn is_here(self, folder: &Path, options: &[&str]) -> bool {
        let (source, program) = (folder.join("probe.c"), folder.join("probe"));
        std::fs::write(&source, "int main(void) { return 0; }\n").expect("a temporary folder can be written to");
        let mut compile = self.compiler();
        compile.args(options).arg(source).arg("-o").arg(&program);
        let is_here = compile.output().is_ok_and(|output| output.status.success())
            && Command::new(&program).output().is_ok_and(|output| output.status.success());
        if !is_here {
            eprintln!("skipped: {compile:?} makes no program that runs");
        }
        is_here
    }
}

/// Compiles a program against header and library.
pub(crate) fn compile(language: Language, source: &Path, options: &[&str], folder: &Path) -> PathBuf {
    let program = folder.join(source.file_name().expect("a file")).with_extension("program");
    let mut command = language.compiler();
    command.args(options).arg("-I").arg(bindings().join("include")).arg(source).arg("-o").arg(&program);
    let path = self::folder().display();
    run(command.arg(format!("-L{path}")).arg("-lsubsurf_decoder").arg(format!("-Wl,-rpath,{path}")));
    program
}
