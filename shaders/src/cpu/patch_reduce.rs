//! Twin of `patch_reduce.wgsl`.

use crate::rgb::Rgb;

/// Next mipmap level of a layer over a patch: means over the texels, and parts of texels, that each of its texels covers; and its
/// size.
///
/// # Panics
/// If there are fewer texels than `size` says.
#[must_use]
pub fn patch_reduce(pixels: &[Rgb], size: [u32; 2]) -> (Vec<Rgb>, [u32; 2]) {
    let half = size.map(|side| (side / 2).max(1));
    let column = |image: &[Rgb], width: u32, x: u32, y: u32| image[(y * width + x) as usize];
    let across = spans(size[0], half[0]);
    let down = spans(size[1], half[1]);
    let rows: Vec<Rgb> = (0..size[1])
        .flat_map(|y| across.iter().map(move |span| (y, span)))
        .map(|(y, span)| mean(span, |x| column(pixels, size[0], x, y)))
        .collect();
    let all = down.iter().flat_map(|span| (0..half[0]).map(move |x| (x, span)));
    (all.map(|(x, span)| mean(span, |y| column(&rows, half[0], x, y))).collect(), half)
}

/// For each of `to` pixels of a line, which of `from` pixels it covers, and which share of it each covers.
#[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, reason = "sides are below 65,536")]
#[allow(clippy::cast_sign_loss, reason = "positions are not negative")]
fn spans(from: u32, to: u32) -> Vec<Vec<(u32, f32)>> {
    let step = from as f32 / to as f32;
    let span = |k: u32| {
        let (low, high) = (k as f32 * step, (k + 1) as f32 * step);
        let covered = low as u32..(high.ceil() as u32).min(from);
        let part = |x: u32| (high.min((x + 1) as f32) - low.max(x as f32)).max(0.0) / step;
        covered.map(|x| (x, part(x))).collect()
    };
    (0..to).map(span).collect()
}

/// Mean over a span, with its shares as weights.
fn mean(span: &[(u32, f32)], at: impl Fn(u32) -> Rgb) -> Rgb {
    span.iter().fold([0.0; 3], |sum, &(x, part)| {
        let value = at(x);
        [0, 1, 2].map(|c| sum[c] + part * value[c])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_keep_the_mean() {
        let size = [7, 5];
        let pixels: Vec<Rgb> = (0..35_u8).map(|k| [f32::from(k), f32::from(k % 3), 1.0]).collect();
        let mean = |pixels: &[Rgb], c: usize| pixels.iter().map(|rgb| rgb[c]).sum::<f32>() / pixels.len() as f32;
        let (mut level, mut side) = patch_reduce(&pixels, size);
        assert_eq!(side, [3, 2]);
        while side != [1, 1] {
            for c in 0..3 {
                assert!((mean(&level, c) - mean(&pixels, c)).abs() < 1e-4, "{side:?}, channel {c}");
            }
            (level, side) = patch_reduce(&level, side);
        }
    }
}
