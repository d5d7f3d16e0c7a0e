//! Copies the WGSL files without comments and indentation: every program that draws carries them and reads them when it starts.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=wgsl");
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    let copies = out.join("wgsl");
    // Files of an earlier run are not those of this one: what was deleted is not found any more.
    if copies.exists() {
        fs::remove_dir_all(&copies)?;
    }
    copy(Path::new("wgsl"), &copies)
}

/// Copies the WGSL files of a folder and of those in it; names that begin with a dot are those of editors.
fn copy(from: &Path, to: &Path) -> io::Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let path = entry?.path();
        let name = path.file_name().expect("entries have names");
        if name.as_encoded_bytes().starts_with(b".") {
            continue;
        }
        let copied = to.join(name);
        if path.is_dir() {
            copy(&path, &copied)?;
        } else if path.extension().is_some_and(|extension| extension == "wgsl") {
            fs::write(copied, bare(&fs::read_to_string(&path)?))?;
        }
    }
    Ok(())
}

/// What is left of each line, if anything. A test sees to it that no file has comments between `/*` and `*/`, or strings.
fn bare(text: &str) -> String {
    let code = text.lines().map(|line| line.split("//").next().unwrap_or_default().trim());
    code.filter(|line| !line.is_empty()).flat_map(|line| [line, "\n"]).collect()
}
