//! The largest of many values, several at a time: one at a time, each comparison would wait for the one before.

/// Values that are compared side by side.
const WIDTH: usize = 8;

/// Index of the largest `size` of two numbers at the same place in `a` and in `b`, as long as each other; of equal ones the first. 0 if
/// none is above −∞.
#[inline]
pub(crate) fn argmax<T: Copy + PartialOrd + From<f32>>(a: &[T], b: &[T], size: impl Fn(T, T) -> T) -> usize {
    debug_assert_eq!(a.len(), b.len(), "a number of each to a value");
    let lowest = T::from(f32::NEG_INFINITY);
    let mut best = [lowest; WIDTH];
    let mut at = [0_u32; WIDTH];
    let ((many_a, rest_a), (many_b, rest_b)) = (a.as_chunks::<WIDTH>(), b.as_chunks::<WIDTH>());
    for (number, (a, b)) in (0_u32..).zip(many_a.iter().zip(many_b)) {
        for lane in 0..WIDTH {
            let found = size(a[lane], b[lane]);
            let is_better = found > best[lane];
            best[lane] = if is_better { found } else { best[lane] };
            at[lane] = if is_better { number } else { at[lane] };
        }
    }
    let of_lane = |lane: usize| (at[lane] as usize * WIDTH + lane, best[lane]);
    let rest = rest_a.iter().zip(rest_b).map(|(a, b)| size(*a, *b));
    let candidates = (0..WIDTH).map(of_lane).chain((many_a.len() * WIDTH..).zip(rest));
    candidates
        .fold((0, lowest), |best, next| {
            let is_better = next.1 > best.1 || next.1 == best.1 && next.1 > lowest && next.0 < best.0;
            if is_better { next } else { best }
        })
        .0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_first_of_the_largest() {
        let largest = |values: &[f32]| {
            let mut best = (0, f32::NEG_INFINITY);
            for (index, value) in values.iter().enumerate() {
                if *value > best.1 {
                    best = (index, *value);
                }
            }
            best.0
        };
        for count in 0..40_u16 {
            // Values that come again and again, NaN among them, and none above −∞.
            for step in [1, 3, 5, 7, 11_u16] {
                let values: Vec<f32> = (0..count).map(|k| f32::from(k * step % 13)).collect();
                let with_nan: Vec<f32> = values.iter().map(|v| if *v == 6.0 { f32::NAN } else { *v }).collect();
                let none = vec![f32::NEG_INFINITY; values.len()];
                for values in [&values, &with_nan, &none] {
                    assert_eq!(argmax(values, &none, |a, _| a), largest(values), "{values:?}");
                }
                let negative: Vec<f32> = values.iter().map(|value| -value).collect();
                let least = largest(&negative);
                assert_eq!(argmax(&none, &values, |_, b| -b), least, "{values:?}");
                let [a, b] =
                    [&values, &with_nan].map(|of| of.iter().map(|value| f64::from(*value)).collect::<Vec<_>>());
                let both: Vec<f32> = values.iter().zip(&with_nan).map(|(a, b)| a - 2.0 * b).collect();
                assert_eq!(argmax(&a, &b, |a, b| a - 2.0 * b), largest(&both), "{values:?}");
            }
        }
    }
}
