//! Pixels of a patch as its addressing mode continues it.

use subsurf_decoder::bssrdf::Addressing;

/// Number of the pixel at `from` + `step` in a patch of `size`; `None` beyond the border of a patch that clamps.
#[must_use]
pub fn neighbour(addressing: Addressing, size: [usize; 2], from: [usize; 2], step: [i32; 2]) -> Option<usize> {
    let coordinate = |axis: usize| {
        let n = u32::try_from(size[axis]).ok()?;
        let x = i32::try_from(from[axis]).ok()? + step[axis];
        let inside = addressing.map(x, n);
        let same = i32::try_from(inside) == Ok(x);
        (same || addressing != Addressing::Clamp).then_some(inside as usize)
    };
    Some(coordinate(1)? * size[0] + coordinate(0)?)
}

/// The step that leads back: from the pixel that [`neighbour`] gives for `from` and `step`, to `from`.
///
/// The opposite step, but for mirrored patches: beyond an odd number of reflections an axis runs the other way, and the
/// way back has the sign of the way there.
#[must_use]
pub fn way_back(addressing: Addressing, size: [usize; 2], from: [usize; 2], step: [i32; 2]) -> [i32; 2] {
    [0, 1].map(|axis| {
        let n = i64::try_from(size[axis]).unwrap_or(i64::MAX);
        let x = i64::try_from(from[axis]).unwrap_or(i64::MAX).saturating_add(step[axis].into());
        let reflected = addressing == Addressing::Mirror && x.div_euclid(n) % 2 != 0;
        if reflected { step[axis] } else { -step[axis] }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_back_lead_back() {
        let size = [3, 4];
        for addressing in [Addressing::Clamp, Addressing::Repeat, Addressing::Mirror] {
            for (x, y) in (0..4).flat_map(|y| (0..3).map(move |x| (x, y))) {
                for step in (-9..=9).flat_map(|dy| (-9..=9).map(move |dx| [dx, dy])) {
                    let Some(other) = neighbour(addressing, size, [x, y], step) else {
                        continue;
                    };
                    let back = way_back(addressing, size, [x, y], step);
                    let there = [other % size[0], other / size[0]];
                    let case = format!("{addressing:?}, {step:?} from {x}, {y}");
                    assert_eq!(neighbour(addressing, size, there, back), Some(y * size[0] + x), "{case}");
                    assert_eq!(way_back(addressing, size, there, back), step, "{case}");
                }
            }
        }
    }
}
