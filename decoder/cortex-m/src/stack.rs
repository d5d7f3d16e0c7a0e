//! How much of the stack was used: painted at first, and looked at in the end.

use core::ptr::addr_of_mut;

const PAINT: u32 = 0xA5A5_5A5A;

unsafe extern "C" {
    /// First word after all statics, and the end of RAM, by the linker.
    static mut __sheap: u32;
    static mut _stack_start: u32;
    static mut __sdata: u32;
}

/// Words between the statics and the end of RAM; the stack grows down into them.
fn words() -> (*mut u32, usize) {
    let (first, end) = (addr_of_mut!(__sheap), addr_of_mut!(_stack_start));
    (first, (end as usize - first as usize) / size_of::<u32>())
}

/// Paints what is free of the stack.
#[inline(never)]
pub(crate) fn paint() {
    let here = 0_u32;
    let (first, _) = words();
    // Frames of this function, and of what it calls, lie above.
    let free = (&raw const here as usize - first as usize) / size_of::<u32>() - 64;
    for word in 0..free {
        // SAFETY: words below the stack's end and above all statics are nobody's.
        unsafe { first.add(word).write_volatile(PAINT) };
    }
}

/// Bytes of RAM that statics and the stack have had at most.
pub(crate) fn used() -> usize {
    let (first, words) = words();
    // SAFETY: all of it is RAM, written once by `paint` or by whoever had a frame there.
    let free = (0..words).take_while(|word| unsafe { first.add(*word).read_volatile() } == PAINT).count();
    first as usize - addr_of_mut!(__sdata) as usize + (words - free) * size_of::<u32>()
}
