//! Instructions of Rd between two pixels, by `exp` and by a table: emulated with a clock that ticks once for every 40 instructions.
#![no_std]
#![no_main]

mod host;

use core::hint::black_box;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m::peripheral::{Peripherals, SYST};
use cortex_m_rt::entry;
use cortex_m_semihosting::hprintln;
use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::{BssrdfModel, ProfileTable};

/// 7 × 5 pixels of seven base materials, R = 3.
const PATCH: &[u8] = include_bytes!("../../../tests/vectors/bmpp_clamp.subsurf");
/// Seven materials at ten distances.
static mut TABLE: ProfileTable<70> = ProfileTable::new();
/// Instructions of a tick: emulated ones take a nanosecond, the board's clock has 25 MHz.
const TICK: u32 = 40;

#[entry]
fn main() -> ! {
    let Some(mut peripherals) = Peripherals::take() else { host::exit(false) };
    let clock = &mut peripherals.SYST;
    clock.set_clock_source(SystClkSource::Core);
    clock.set_reload(0x00FF_FFFF);
    clock.clear_current();
    clock.enable_counter();
    // SAFETY: nobody else has it.
    let table = unsafe { &mut *(&raw mut TABLE) };
    host::exit(measure(table).is_some())
}

fn measure(table: &mut ProfileTable<70>) -> Option<()> {
    let material = Bssrdf::parse(PATCH).ok()?;
    let BssrdfModel::BaseMaterials(planes) = material.model() else { return None };
    let start = SYST::get_current();
    let has_room = table.expand(&material);
    hprintln!("expansion: {} instructions", start.wrapping_sub(SYST::get_current()) * TICK);
    let by_exp = per_call(|x_i, x_o| material.rd(x_i, x_o));
    let pixel = |[x, y]: [i32; 2]| planes.mixtures.at((y * 7 + x) as usize, 35);
    let by_table = per_call(|x_i, x_o| table.rd(&pixel(x_i), &pixel(x_o), x_i[0] - x_o[0], x_i[1] - x_o[1]));
    let rest = per_call(|x_i, x_o| [pixel(x_i).ratios[0], pixel(x_o).ratios[0], 0.0]);
    hprintln!("Rd: {} instructions by exp, {} by a table of {} bytes", by_exp, by_table, size_of::<ProfileTable<70>>());
    hprintln!("of which {} are loops and mixtures of the pixels", rest);
    has_room.then_some(())
}

/// Mean number of instructions of a call, over all pairs of pixels.
fn per_call(rd: impl Fn([i32; 2], [i32; 2]) -> [f32; 3]) -> u32 {
    let start = SYST::get_current();
    let mut calls = 0;
    for (a, b) in (0..35).flat_map(|a| (0..35).map(move |b| (a, b))) {
        black_box(rd([a % 7, a / 7], black_box([b % 7, b / 7])));
        calls += 1;
    }
    (start.wrapping_sub(SYST::get_current()) & 0x00FF_FFFF) * TICK / calls
}
