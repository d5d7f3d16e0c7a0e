//! Compilers of C and C++, and programs that they make; the tests of all shared libraries have this file.

use std::path::{Path, PathBuf};
use std::process::Command;

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

/// Shared library that programs link.
pub(crate) struct Library {
    /// Where it is.
    pub(crate) folder: PathBuf,
    /// Its name, without what systems put around it.
    pub(crate) name: &'static str,
}

impl Library {
    /// Its file.
    pub(crate) fn file(&self) -> PathBuf {
        let Self { folder, name } = self;
        folder.join(format!("{}{name}{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX))
    }

    /// Names of the functions that it exports, sorted; `None` where there is no `nm`, which is said.
    pub(crate) fn exports(&self) -> Option<Vec<String>> {
        let symbols = self.tool("nm", &["-D", "--defined-only"])?;
        let names = symbols.lines().filter_map(|line| line.split_whitespace().last());
        let mut names: Vec<String> = names.map(str::to_owned).collect();
        names.sort_unstable();
        Some(names)
    }

    /// Lines of a tool of binutils or LLVM about it; `None` where there is none, which is said.
    pub(crate) fn tool(&self, name: &str, args: &[&str]) -> Option<String> {
        if Command::new(name).arg("--version").output().is_err() {
            eprintln!("skipped: there is no {name}");
            return None;
        }
        Some(run(Command::new(name).args(args).arg(self.file())))
    }

    /// Compiles a program against header and library.
    pub(crate) fn compile(&self, language: Language, source: &Path, options: &[&str], folder: &Path) -> PathBuf {
        let program = folder.join(source.file_name().expect("a file")).with_extension("program");
        let mut command = language.compiler();
        command.args(options).arg("-I").arg(bindings().join("include")).args(language.source()).arg(source);
        let path = self.folder.display();
        command.args(["-x", "none", "-o"]).arg(&program).arg(format!("-L{path}"));
        run(command.arg(format!("-l{}", self.name)).arg(format!("-Wl,-rpath,{path}")));
        program
    }
}

/// Languages of programs, with their compilers and standards.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Language {
    C(&'static str),
    Cpp(&'static str),
}

impl Language {
    /// The compiler, as make names it; standard and warnings.
    fn compiler(self) -> Command {
        let (variable, usual, standard) = match self {
            Self::C(standard) => ("CC", "cc", standard),
            Self::Cpp(standard) => ("CXX", "c++", standard),
        };
        let mut command = Command::new(std::env::var_os(variable).unwrap_or_else(|| usual.into()));
        command.arg(format!("-std={standard}")).args(["-g", "-O1", "-Wall", "-Wextra", "-Werror", "-pedantic"]);
        command
    }

    /// Says to the compiler what a source is, whatever its name.
    fn source(self) -> [&'static str; 2] {
        match self {
            Self::C(_) => ["-x", "c"],
            Self::Cpp(_) => ["-x", "c++"],
        }
    }

    /// Whether it compiles, with these options too; says so if not.
    pub(crate) fn is_here(self, folder: &Path, options: &[&str]) -> bool {
        let (source, program) = (folder.join("probe.c"), folder.join("probe"));
        std::fs::write(&source, "int main(void) { return 0; }\n").expect("a temporary folder can be written to");
        let mut compile = self.compiler();
        compile.args(options).args(self.source()).arg(source).arg("-o").arg(&program);
        let is_here = compile.output().is_ok_and(|output| output.status.success())
            && Command::new(&program).output().is_ok_and(|output| output.status.success());
        if !is_here {
            eprintln!("skipped: {compile:?} makes no program that runs");
        }
        is_here
    }
}
