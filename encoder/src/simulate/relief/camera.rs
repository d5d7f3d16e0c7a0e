//! The camera of a virtual gonioreflectometer: what it resolves when it looks along the surface.

use glam::Vec3;

/// A distant camera whose pixels are as large as those of the images when it looks straight down.
#[derive(Clone, Copy, Debug)]
pub(super) struct Camera {
    /// Standard deviation of its point spread function, in its own pixels.
    pub(super) spread_px: f32,
}

impl Camera {
    /// Lens and pixel of a sharp camera.
    pub(super) const LENS: Self = Self { spread_px: 0.5 };

    /// What it spreads a point of the surface over. A point spread function that is round in the camera's picture is
    /// stretched by 1 / cos θ_v along the view's azimuth, once the picture is laid on the surface.
    #[allow(clippy::cast_possible_truncation, reason = "a few pixels")]
    pub(super) fn footprint(self, towards_eye: Vec3) -> Footprint {
        let cos = towards_eye.z;
        let along = towards_eye.truncate().normalize_or(glam::Vec2::X);
        let radius = (3.0 * self.spread_px / cos).ceil() as isize;
        let offsets = (-radius..=radius).flat_map(|dy| (-radius..=radius).map(move |dx| [dx, dy]));
        let weigh = |[dx, dy]: [isize; 2]| {
            let offset = glam::Vec2::new(dx as f32, dy as f32);
            let [a, c] = [offset.dot(along) * cos, offset.perp_dot(along)].map(|px| px / self.spread_px);
            (a * a + c * c <= 9.0).then(|| ([dx, dy], (-0.5 * (a * a + c * c)).exp()))
        };
        let mut taps: Vec<_> = if radius == 0 { vec![([0, 0], 1.0)] } else { offsets.filter_map(weigh).collect() };
        let sum: f32 = taps.iter().map(|(_, weight)| weight).sum();
        taps.iter_mut().for_each(|(_, weight)| *weight /= sum);
        Footprint(taps)
    }
}

/// Pixels around one, x and y, and their weights, which add up to 1.
pub(super) struct Footprint(Vec<([isize; 2], f32)>);

impl Footprint {
    /// The mean over the footprint at every pixel of an image that repeats.
    pub(super) fn blur(&self, image: &[Vec3], side: usize) -> Vec<[f32; 3]> {
        #[allow(clippy::cast_possible_wrap, clippy::cast_sign_loss, reason = "images are below 65,536 pixels wide")]
        let at = |x: isize, y: isize| {
            let [x, y] = [x, y].map(|place| place.rem_euclid(side as isize) as usize);
            image[y * side + x]
        };
        #[allow(clippy::cast_possible_wrap, reason = "images are below 65,536 pixels wide")]
        let pixel = |k: usize| {
            let (x, y) = ((k % side) as isize, (k / side) as isize);
            self.0.iter().map(|([dx, dy], weight)| at(x + dx, y + dy) * *weight).sum::<Vec3>().to_array()
        };
        (0..side * side).map(pixel).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_is_stretched_along_the_view() {
        let side = 31;
        let mut point = vec![Vec3::ZERO; side * side];
        point[15 * side + 15] = Vec3::ONE;
        let (sin, cos) = 60.0_f32.to_radians().sin_cos();
        let seen = Camera { spread_px: 1.0 }.footprint(Vec3::new(0.0, sin, cos)).blur(&point, side);
        let moment = |of: &dyn Fn(usize) -> usize| -> f32 {
            let square = |k: usize| (of(k) as f32 - 15.0).powi(2);
            (0..side * side).map(|k| seen[k][1] * square(k)).sum()
        };
        let (rows, columns) = (moment(&|k| k % side), moment(&|k| k / side));
        // A Gaussian that is cut off at r = 3 deviations has the variance 1 − ½ r² e^(−½ r²) / (1 − e^(−½ r²)).
        let variance = 0.9495;
        assert!((rows / variance - 1.0).abs() < 0.02, "{rows}: 1 across the view");
        assert!((columns / variance - 4.0).abs() < 0.08, "{columns}: 1 / cos² 60° along it");
        let sum: f32 = seen.iter().map(|rgb| rgb[0]).sum();
        assert!((sum - 1.0).abs() < 1e-5, "{sum}: no light is lost");
    }
}
