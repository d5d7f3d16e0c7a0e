//! The order in which texels are looked at: all over the material at once, however few of them.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// Points per texel after which the texels that are left come one after the other.
const POINTS: usize = 64;

/// Digits of a number in some base, mirrored at the point: 0 to 1.
fn radical_inverse(mut number: u32, base: u32) -> f64 {
    let (mut inverse, mut digit) = (0.0, 1.0);
    while number > 0 {
        digit /= f64::from(base);
        inverse += digit * f64::from(number % base);
        number /= base;
    }
    inverse
}

/// All texels, each once, in the order in which the points of a Halton pattern of bases 2 and 3 fall on them. The seed
/// shifts the pattern.
pub(super) fn order([width, height]: [u32; 2], seed: u64) -> Vec<u32> {
    let mut rng = Pcg64::seed_from_u64(seed);
    let shift = [rng.random::<f64>(), rng.random::<f64>()];
    let count = width as usize * height as usize;
    let mut is_taken = vec![false; count];
    let mut order = Vec::with_capacity(count);
    let mut take = |texel: u32| {
        if !std::mem::replace(&mut is_taken[texel as usize], true) {
            order.push(texel);
        }
    };
    let points = u32::try_from(POINTS * count).unwrap_or(u32::MAX);
    for number in 0..points {
        let place = |base: u32, shift: f64, side: u32| {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to below side")]
            let place = ((radical_inverse(number, base) + shift).fract() * f64::from(side)) as u32;
            place.min(side - 1)
        };
        take(place(3, shift[1], height) * width + place(2, shift[0], width));
    }
    for texel in 0..width * height {
        take(texel);
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_texels_lie_everywhere() {
        let order = order([32, 24], 5);
        let mut all = order.clone();
        all.sort_unstable();
        assert!(all.iter().copied().eq(0..32 * 24), "each once");
        // One in every cell of 8 × 8 among the first sixth.
        let mut cells = [0; 12];
        for texel in &order[..128] {
            cells[(texel / 32 / 8 * 4 + texel % 32 / 8) as usize] += 1;
        }
        assert!(cells.iter().all(|count| (5..20).contains(count)), "{cells:?}");
        assert_ne!(order, super::order([32, 24], 6), "seeds shift the pattern");
    }

    #[test]
    fn digits_are_mirrored() {
        let inverses = [1, 2, 3, 6].map(|number| radical_inverse(number, 2));
        assert_eq!(inverses, [0.5, 0.25, 0.75, 0.375]);
        assert!((radical_inverse(5, 3) - 7.0 / 9.0).abs() < 1e-12, "12 in base 3 is 0.21");
    }
}
