//! Blurs of planes by stages of the cascade.

use super::cascade::{CascadeStage, MAX_TAPS};
use crate::bssrdf::addressing::Addressing;

impl CascadeStage {
    /// Blurs one plane, row by row, along rows and along columns; what lies beyond its border is addressed as said.
    /// `between` is room for as many numbers, whose values do not matter.
    ///
    /// Planes that are shorter than their size stay as they are.
    pub fn blur(&self, plane: &mut [f32], between: &mut [f32], [width, height]: [u32; 2], addressing: Addressing) {
        let pixels = (width as usize).saturating_mul(height as usize);
        let (Some(plane), Some(between)) = (plane.get_mut(..pixels), between.get_mut(..pixels)) else { return };
        if pixels == 0 {
            return;
        }
        let kernel = Kernel { weights: self.weights(), stride: self.stride, taps: self.taps };
        for (row, out) in plane.chunks_exact(width as usize).zip(between.chunks_exact_mut(width as usize)) {
            kernel.along_row(row, out, addressing);
        }
        kernel.along_columns(between, plane, [width, height], addressing);
    }
}

/// Taps of a stage.
struct Kernel {
    /// Weights at 0, 1, 2 ... strides to either side.
    weights: [f32; MAX_TAPS + 1],
    stride: i32,
    taps: i32,
}

impl Kernel {
    /// Offsets in pixels and weights of the taps to one side.
    fn side(&self) -> impl Iterator<Item = (i32, f32)> {
        self.weights.iter().zip(0_i32..=self.taps).map(|(weight, k)| (k.saturating_mul(self.stride), *weight))
    }

    fn along_row(&self, row: &[f32], out: &mut [f32], addressing: Addressing) {
        let width = row.len();
        let wide = u32::try_from(width).unwrap_or(u32::MAX);
        let beyond = |x: usize, offset: i32| {
            let x = i32::try_from(x).unwrap_or(i32::MAX).saturating_add(offset);
            row.get(addressing.map(x, wide) as usize).copied().unwrap_or(0.0)
        };
        out.fill(0.0);
        for (offset, weight) in self.side() {
            if offset == 0 {
                add(out, weight, row);
                continue;
            }
            let near = usize::try_from(offset).unwrap_or(usize::MAX).min(width);
            // To the left of every pixel, then to the right of it: what lies in the row, then what lies beyond.
            let (border, inside) = out.split_at_mut_checked(near).unwrap_or((&mut [], &mut []));
            add(inside, weight, row);
            for (x, out) in border.iter_mut().enumerate() {
                *out += weight * beyond(x, offset.saturating_neg());
            }
            let rest = width.saturating_sub(near);
            let (inside, border) = out.split_at_mut_checked(rest).unwrap_or((&mut [], &mut []));
            add(inside, weight, row.get(near..).unwrap_or(&[]));
            for (x, out) in border.iter_mut().enumerate() {
                *out += weight * beyond(rest.saturating_add(x), offset);
            }
        }
    }

    fn along_columns(&self, from: &[f32], to: &mut [f32], [width, height]: [u32; 2], addressing: Addressing) {
        let width = width as usize;
        let row = |y: i32| {
            let start = (addressing.map(y, height) as usize).saturating_mul(width);
            from.get(start..).unwrap_or(&[])
        };
        for (out, y) in to.chunks_exact_mut(width).zip(0_i32..) {
            out.fill(0.0);
            for (offset, weight) in self.side() {
                add(out, weight, row(y.saturating_add(offset)));
                if offset != 0 {
                    add(out, weight, row(y.saturating_sub(offset)));
                }
            }
        }
    }
}

/// Adds weight · from to as many numbers as both have.
fn add(to: &mut [f32], weight: f32, from: &[f32]) {
    for (to, from) in to.iter_mut().zip(from) {
        *to += weight * from;
    }
}
