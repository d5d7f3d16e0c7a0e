//! Tells what a file holds: `cargo run --example family -- FILE`; without a file, that of the example in `FORMAT.md`.

use std::error::Error;
use subsurf_decoder::{Content, File};

const EXAMPLE: &[u8] = include_bytes!("../../tests/vectors/format_example.subsurf");

fn main() -> Result<(), Box<dyn Error>> {
    let bytes = match std::env::args_os().nth(1) {
        Some(path) => std::fs::read(path)?,
        None => EXAMPLE.to_vec(),
    };
    let file = File::parse(&bytes)?;
    match file.content() {
        Content::Bssrdf(material) => println!("BSSRDF, {:?}", material.header()),
        Content::NestedBtf(btf) => println!("nested BTF, {:?}", btf.header()),
        Content::FactoredBtf(btf) => println!("factored BTF, {:?}", btf.shape()),
        Content::Kernel(kernel) => println!("kernel, {:?}", kernel.header()),
        other => println!("{}", other.family()),
    }
    for entry in file.container().entries() {
        println!("{:<36} {:>10} bytes at {}", entry.section.to_string(), entry.length, entry.offset);
    }
    Ok(())
}
