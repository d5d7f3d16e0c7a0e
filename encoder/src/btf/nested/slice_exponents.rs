//! Exponents of slices: in a file P2 has the means of slices, and an exponent beside every slice says how much higher its
//! values are.
//!
//! So a sampler knows the integral of luma over a slice without looking at it.

use subsurf_decoder::btf::nested::layout::{MAX_OCTAVES, SLICE_STEPS_PER_OCTAVE, STEPS_PER_OCTAVE, Scales};
use subsurf_decoder::container::bits::index_bits;

use super::database::{Chain, Item};

/// The same chain with scales of means in P2, and exponents after the rows of P1. Not one value changes: exponents are whole
/// steps of the scales of P2. They end where codes would take more than a byte, or more than they took before. Signed
/// stages are not sampled from; their exponents are 0.
pub(super) fn by_means(chain: &Chain, n_beta: usize) -> Chain {
    let mut of_file = chain.clone();
    let rows = || chain.p1.chunks_exact(n_beta + 1);
    // All in 1/64 octaves; exponents are multiples of `unit`.
    let step = 1_i32 << chain.scales[3].step;
    let exponent_step = STEPS_PER_OCTAVE / SLICE_STEPS_PER_OCTAVE;
    let unit = step.max(exponent_step);
    let depth = |row: &[u8]| i32::from(u8::MAX - row[n_beta]) * exponent_step;
    let depths = rows().map(|row| if chain.is_signed { 0 } else { (depth(row) + unit / 2) / unit });
    let depths: Vec<i32> = depths.map(|depth| depth.min(i32::from(u8::MAX) * exponent_step / unit)).collect();
    let deepest = depths.iter().copied().max().unwrap_or(0);
    for most in (0..=deepest).rev() {
        let exponents: Vec<i32> = depths.iter().map(|depth| depth.min(&most) * unit).collect();
        if let Some((p2, scales)) = lowered(chain, &exponents) {
            (of_file.p2, of_file.scales[3]) = (p2, scales);
            for (row, exponent) in of_file.p1.chunks_exact_mut(n_beta + 1).zip(exponents) {
                row[n_beta] = u8::try_from(exponent / exponent_step).expect("at most 255");
            }
            break;
        }
    }
    of_file
}

/// P2 and its scales, less the exponents of slices; `None` if the codes become too many, or scales too small or large.
fn lowered(chain: &Chain, exponents: &[i32]) -> Option<(Vec<Item>, Scales)> {
    let scales = chain.scales[3];
    if exponents.iter().all(|exponent| *exponent == 0) {
        return Some((chain.p2.clone(), scales));
    }
    let step = 1_i64 << scales.step;
    let lower = |item: &Item| i64::from(item.code) - i64::from(exponents[item.index as usize]) / step;
    let codes = || chain.p2.iter().map(lower);
    let (lowest, highest) = (codes().min()?, codes().max()?);
    let bits = u8::try_from(index_bits(u32::try_from(highest - lowest + 1).ok()?)).ok()?;
    let offset = i64::from(scales.offset) + lowest * step;
    let last = offset + ((1 << bits) - 1) * step;
    let limit = i64::from(MAX_OCTAVES * STEPS_PER_OCTAVE);
    if bits > scales.bits.max(8) || offset < -limit || last > limit {
        return None;
    }
    let item = |item: &Item| Some(Item { index: item.index, code: u32::try_from(lower(item) - lowest).ok()? });
    let items = chain.p2.iter().map(item).collect::<Option<_>>()?;
    Some((items, Scales { bits, offset: i16::try_from(offset).ok()?, ..scales }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::btf::nested::slice_mean;

    #[test]
    fn values_stay_what_they_are() {
        let slices: [[u8; 3]; 4] = [[255, 255, 255], [0, 255, 0], [3, 0, 255], [0, 9, 0]];
        let p1: Vec<u8> = slices.iter().flat_map(|row| [&row[..], &[slice_mean(row)]].concat()).collect();
        let item = |k: u32| Item { index: k % 4, code: (7 * k) % 32 };
        // The last has 5.8 octaves, where there is room for them: codes have a byte, and reach from 2^−24 to 2^24.
        let cases = [(0, -40, 114), (1, 100, 186), (3, -200, 188), (6, -1536, 32), (6, -480, 64)];
        for (step, offset, deepest) in cases {
            let scales = Scales { bits: 5, step, offset };
            let p2: Vec<Item> = (0..24).map(item).collect();
            let chain = Chain { p2, p1: p1.clone(), scales: [scales; 4], ..Chain::default() };
            let of_file = by_means(&chain, 3);
            let found = of_file.scales[3];
            for (before, after) in chain.p2.iter().zip(&of_file.p2) {
                let exponent =
                    |scales: Scales, item: &Item| i32::from(scales.offset) + (item.code.cast_signed() << scales.step);
                let of_slice = i32::from(of_file.p1[4 * after.index as usize + 3]);
                assert_eq!(exponent(found, after) + 2 * of_slice, exponent(scales, before), "step {step}: {before:?}");
                assert!(after.code < 1 << found.bits && before.index == after.index, "{after:?}");
            }
            let exponents: Vec<u8> = of_file.p1.chunks(4).map(|row| row[3]).collect();
            assert_eq!(exponents.iter().max(), Some(&deepest), "step {step}: {found:?}");
            if step == 1 {
                // Means of 1, 1/2, 64.5/255 and 4.5/255.
                assert_eq!(exponents, [0, 32, 63, 186]);
            }
        }
    }

    #[test]
    fn signs_have_no_exponents() {
        let chain = Chain { p1: vec![1, 2, 3, 4, 5, 6], is_signed: true, ..Chain::default() };
        assert_eq!(by_means(&chain, 2).p1, [1, 2, 0, 4, 5, 0]);
    }
}
