//! Rasteriser, which the GPU has built in.

use std::ops::{Add, Mul};

use glam::{Mat4, Vec2, Vec3, Vec4, Vec4Swizzles};

/// Pixel and the triangle that is seen there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Covered {
    /// Numbers of the vertices of the triangle.
    corners: [usize; 3],
    /// Column and row of the pixel.
    pub(super) pixel: [u32; 2],
    /// Positions of the vertices in pixels, y down.
    screen: [Vec2; 3],
    /// w of the vertices in clip space.
    clip_w: [f32; 3],
    /// Weights of the values of the vertices, of sum 1.
    weights: [f32; 3],
}

/// Barycentric coordinates of a place on the screen, inside the triangle or beyond it.
fn shares([a, b, c]: [Vec2; 3], at: Vec2) -> [f32; 3] {
    let area = (b - a).perp_dot(c - a);
    [(c - b).perp_dot(at - b) / area, (a - c).perp_dot(at - c) / area, (b - a).perp_dot(at - a) / area]
}

/// Barycentric coordinates in space from those on the screen: values are linear on the screen after division by w.
fn in_space(shares: [f32; 3], clip_w: [f32; 3]) -> [f32; 3] {
    let perspective = [0, 1, 2].map(|k| shares[k] / clip_w[k]);
    let sum: f32 = perspective.iter().sum();
    perspective.map(|weight| weight / sum)
}

#[allow(clippy::cast_precision_loss, reason = "pictures are a few thousand pixels wide")]
fn centre([x, y]: [u32; 2]) -> Vec2 {
    Vec2::new(x as f32 + 0.5, y as f32 + 0.5)
}

impl Covered {
    /// Interpolated value at the pixel.
    pub(super) fn blend<T: Copy + Mul<f32, Output = T> + Add<Output = T>>(&self, values: &[T]) -> T {
        let [a, b, c] = [0, 1, 2].map(|k| values[self.corners[k]] * self.weights[k]);
        a + b + c
    }

    /// Interpolated values at the pixel, of each number of the arrays.
    pub(super) fn blend_all<const N: usize>(&self, values: &[[f32; N]]) -> [f32; N] {
        let [a, b, c] = self.corners.map(|corner| &values[corner]);
        std::array::from_fn(|k| a[k] * self.weights[0] + b[k] * self.weights[1] + c[k] * self.weights[2])
    }

    /// Screen-space derivatives of the interpolated value along rows and columns, within blocks of two by two pixels.
    pub(super) fn slopes<T>(&self, values: &[T]) -> [T; 2]
    where
        T: Copy + Mul<f32, Output = T> + Add<Output = T>,
    {
        let [x, y] = self.pixel;
        let at = |pixel| in_space(shares(self.screen, centre(pixel)), self.clip_w);
        let ends = [[[x & !1, y], [x | 1, y]], [[x, y & !1], [x, y | 1]]];
        ends.map(|[from, to]| {
            let (from, to) = (at(from), at(to));
            let [a, b, c] = [0, 1, 2].map(|k| values[self.corners[k]] * (to[k] - from[k]));
            a + b + c
        })
    }
}

/// Picture of triangles in display values, `size` pixels, row by row from the top, in front of a `background`; `colour` is called
/// for each pixel of a triangle that is nearer than all before it.
///
/// # Panics
/// If an index leads outside the vertices.
pub(super) fn rasterise(
    positions: &[Vec3],
    triangles: &[[u32; 3]],
    clip_from_world: &[[f32; 4]; 4],
    size: [u32; 2],
    background: [u8; 3],
    mut colour: impl FnMut(&Covered) -> [u8; 3],
) -> Vec<[u8; 3]> {
    let [width, height] = size.map(|n| n as usize);
    let mut picture = vec![background; width * height];
    let mut depth = vec![1.0_f32; width * height];
    let clip_from_world = Mat4::from_cols_array_2d(clip_from_world);
    let clip: Vec<Vec4> = positions.iter().map(|p| clip_from_world * p.extend(1.0)).collect();
    #[allow(clippy::cast_precision_loss, reason = "pictures are a few thousand pixels wide")]
    let half = Vec2::new(width as f32, height as f32) * 0.5;
    // Pixels, y down.
    let on_screen = |v: Vec4| (v.xy() / v.w * Vec2::new(1.0, -1.0) + 1.0) * half;

    for triangle in triangles {
        let corners = triangle.map(|k| k as usize);
        let clip = corners.map(|k| clip[k]);
        // Cameras stand outside what they look at: a triangle that reaches behind the eye is not drawn.
        if clip.iter().any(|v| v.w <= 0.0) {
            continue;
        }
        let screen = clip.map(on_screen);
        let [a, b, c] = screen;
        if (b - a).perp_dot(c - a) == 0.0 {
            continue;
        }
        let low = a.min(b).min(c).max(Vec2::ZERO);
        let high = a.max(b).max(c).min(2.0 * half - 1.0);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the picture")]
        let range = |low: f32, high: f32| low.floor() as u32..=high.ceil().max(0.0) as u32;
        for y in range(low.y, high.y) {
            for x in range(low.x, high.x) {
                if x >= size[0] || y >= size[1] {
                    continue;
                }
                let shares = shares(screen, centre([x, y]));
                if shares.iter().any(|share| *share < 0.0) {
                    continue;
                }
                // Depth is linear on the screen, everything else after division by w.
                let z: f32 = shares.iter().zip(clip).map(|(share, v)| share * v.z / v.w).sum();
                let at = y as usize * width + x as usize;
                if !(0.0..depth[at]).contains(&z) {
                    continue;
                }
                depth[at] = z;
                let clip_w = clip.map(|v| v.w);
                let weights = in_space(shares, clip_w);
                picture[at] = colour(&Covered { corners, pixel: [x, y], screen, clip_w, weights });
            }
        }
    }
    picture
}
