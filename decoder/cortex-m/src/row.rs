//! Draws a row of `patch.subsurf`, a file of the host that comes 64 bytes at a time as from flash, prints its pixels, and the RAM that it took.
#![no_std]
#![no_main]

mod file;
mod host;
#[path = "../../examples/microcontroller/row.rs"]
mod row;
mod stack;

// Its critical sections, which printing asks for.
use cortex_m as _;
use cortex_m_rt::entry;
use cortex_m_semihosting::hprintln;
use file::File;
use row::{BUFFER, Painter, Problem};
use subsurf_decoder::PushReader;

/// Row that is drawn.
const Y: u32 = 100;

#[entry]
fn main() -> ! {
    // In static memory, so that they are built where they stay.
    static mut READER: PushReader<BUFFER> = PushReader::new();
    static mut PAINTER: Painter = Painter::new(Y);
    stack::paint();
    let drawn = draw(READER, PAINTER);
    if let Err(problem) = drawn {
        hprintln!("{}", problem);
    }
    let used = stack::used();
    let [reader, painter] = [size_of::<PushReader<BUFFER>>(), size_of::<Painter>()];
    hprintln!("RAM: {} bytes of 8192; the reader is {} of them, what is kept for the row {}", used, reader, painter);
    host::exit(drawn.is_ok() && used < 8192)
}

#[inline(never)]
fn draw(reader: &mut PushReader<BUFFER>, painter: &mut Painter) -> Result<(), Problem> {
    let mut file = File::open(c"patch.subsurf");
    let (mut chunk, mut drawn) = ([0; 64], Ok(()));
    while !reader.is_complete() {
        let bytes = file.read(&mut chunk);
        if bytes.is_empty() {
            break;
        }
        let pushed = reader.push(bytes, |piece| {
            let took = painter.take(piece, &mut |[r, g, b]| hprintln!("{:02x}{:02x}{:02x}", r, g, b));
            drawn = drawn.and(took);
        });
        pushed.map_err(Problem::File).and(drawn)?;
    }
    reader.finish().map_err(Problem::File)
}
