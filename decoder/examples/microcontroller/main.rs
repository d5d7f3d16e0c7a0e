//! What a microcontroller does with a file in flash, on this machine: it draws one row of a patch from bytes that come 64 at a time.
//!
//! `cargo run --example microcontroller -- [ROW [FILE]]` prints the row's pixels, rrggbb. `row.rs` is the program; `decoder/cortex-m` runs it on a Cortex-M4 within 8 kB
//! of RAM, stack included. Without a file, a patch of 7 × 5 pixels.

mod row;

use row::{BUFFER, Painter, Problem};
use std::error::Error;
use std::io::Read;
use subsurf_decoder::PushReader;

const PATCH: &[u8] = include_bytes!("../../../tests/vectors/bmpp_clamp.subsurf");

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let y = arguments.next().map_or(Ok(0), |row| row.parse())?;
    let mut file: Box<dyn Read> = match arguments.next() {
        Some(path) => Box::new(std::fs::File::open(path)?),
        None => Box::new(PATCH),
    };
    let (mut reader, mut painter) = (PushReader::<BUFFER>::new(), Painter::new(y));
    let mut drawn = Ok(());
    let mut chunk = [0; 64];
    while !reader.is_complete() {
        let count = file.read(&mut chunk)?;
        if count == 0 {
            break;
        }
        let pushed = reader.push(&chunk[..count], |piece| {
            let took = painter.take(piece, &mut |[r, g, b]| println!("{r:02x}{g:02x}{b:02x}"));
            drawn = drawn.and(took);
        });
        pushed.map_err(Problem::File).and(drawn).map_err(|problem| problem.to_string())?;
    }
    Ok(reader.finish()?)
}
