//! Powers of two in steps of 1/64 octaves.

/// Steps of an octave, a power of two.
pub(crate) const STEPS: usize = 64;

/// Bits of the f32 values 2^(k / 64). Added to a whole exponent in its place they are those of any 2^(n / 64).
pub(crate) static POWERS: [u32; STEPS] = powers();

#[allow(
    clippy::arithmetic_side_effects,
    clippy::indexing_slicing,
    clippy::cast_possible_truncation,
    reason = "runs at compile time, where a panic is a build error"
)]
const fn powers() -> [u32; STEPS] {
    /// 2^(1 / 64).
    const ROOT: f64 = 1.010_889_286_051_700_5;
    let (mut powers, mut power, mut k) = ([0; STEPS], 1.0, 0);
    while k < STEPS {
        powers[k] = (power as f32).to_bits();
        power *= ROOT;
        k += 1;
    }
    powers
}
