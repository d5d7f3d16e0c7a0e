//! Reads a BSSRDF and evaluates it: how light spreads from one pixel to another.
//!
//! The file is the example of `FORMAT.md`, section 3: two pixels of two base materials, 0.5 mm apart.

use subsurf_decoder::{Bssrdf, ReadError};

const FILE: &[u8] = include_bytes!("../../tests/vectors/format_example.subsurf");

fn main() -> Result<(), ReadError> {
    let material = Bssrdf::parse(FILE)?;
    let header = material.header();
    println!("{} × {} pixels of {} mm", header.width, header.height, header.pitch_mm);
    let [r, g, b] = material.rd([0, 0], [1, 0]);
    println!("Rd between them: {r:.4} {g:.4} {b:.4} mm⁻²");
    let [r, g, b] = material.albedo([0, 0]);
    println!("albedo of the first: {r:.4} {g:.4} {b:.4}");
    Ok(())
}
