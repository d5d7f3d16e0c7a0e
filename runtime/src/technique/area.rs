//! Area of the picture that maps lie over.

use glam::Vec2;
use subsurf_scene::{BoundingSphere, View};
use subsurf_shaders::uniform::Upsampling;

use super::mesh_pass::Viewport;

/// Area that maps lie over: a rectangle of the texels that the whole picture would have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct MapArea {
    /// Texels of the whole picture, columns and rows.
    pub(crate) whole: [u32; 2],
    /// Column and row of the first texel of the rectangle.
    pub(crate) first: [u32; 2],
    /// Columns and rows of the rectangle, from the upper left corner of the maps on.
    pub(crate) size: [u32; 2],
}

/// Texels around what is seen: blurred maps are looked up between texels.
const MARGIN: f32 = 1.0;

#[allow(clippy::cast_precision_loss, reason = "pictures are a few thousand pixels wide")]
fn float(side: u32) -> f32 {
    side as f32
}

/// Pixels of the picture to a side of a texel of the maps: whole, as many as are `wanted`, 1 to `most`.
pub(crate) fn divisor_of(wanted: f32, most: f32) -> f32 {
    // Of what is no number nothing is left.
    wanted.floor().clamp(1.0, most).max(1.0)
}

impl MapArea {
    /// Area over all of the picture.
    pub(crate) fn whole(maps: [u32; 2]) -> Self {
        Self { whole: maps, first: [0; 2], size: maps }
    }

    /// Area over what is seen of a sphere in a picture of `picture` pixels: as fine as maps of `maps` texels can hold it, and no finer
    /// than a texel to `divisor` pixels.
    pub(crate) fn over(view: &View, bounds: &BoundingSphere, picture: [u32; 2], maps: [u32; 2], divisor: f32) -> Self {
        let [low, high] = view.rectangle(bounds);
        // In shares of the picture, from the left and from the top.
        let [x, y] = [[low.x, high.x], [-high.y, -low.y]].map(|range| range.map(|side| 0.5 + 0.5 * side));
        let axes = [(x, picture[0], maps[0]), (y, picture[1], maps[1])];
        // Texels of the whole picture, with which the maps hold the rectangle; they always hold as many as they have themselves.
        let wanted = axes.iter().map(|([from, to], picture, maps)| {
            let held = (float(*maps) - 2.0 * MARGIN - 2.0) / (to - from).max(1e-6);
            float(*picture) / held.max(float(*maps)).max(1.0)
        });
        let divisor = wanted.fold(divisor, f32::max);
        let of_axis = |([from, to], picture, maps): ([f32; 2], u32, u32)| {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "texels of a picture")]
            let texel = |at: f32, whole: u32| (at.max(0.0) as u32).min(whole);
            // Rounded as it is written: where maps cover all, one texel more would not be there.
            let whole = texel((float(picture) / divisor - 1e-3).ceil(), picture).max(1);
            let first = texel((from * float(whole)).floor() - MARGIN, whole.saturating_sub(1));
            let last = texel((to * float(whole)).ceil() + MARGIN, whole).max(first + 1);
            (whole, first, (last - first).min(maps))
        };
        let [(width, left, columns), (height, top, rows)] = axes.map(of_axis);
        Self { whole: [width, height], first: [left, top], size: [columns, rows] }
    }

    /// Width and height of maps for areas that cover `covered` of a picture along rows and columns: no finer than a texel to
    /// `divisor` pixels, and no more texels than the whole picture has with one to `least` pixels.
    pub(crate) fn shape(picture: [u32; 2], divisor: f32, least: f32, covered: Vec2) -> [u32; 2] {
        let size = Vec2::new(float(picture[0]), float(picture[1]));
        let (whole, fewest) = ((size / divisor.max(1.0)).max(Vec2::ONE), size / divisor.max(least).max(1.0));
        let texels = (fewest.x * fewest.y).max(1.0);
        let aspect = (covered.x * size.x).max(1.0) / (covered.y * size.y).max(1.0);
        // What does not fit into one side goes to the other.
        let width = (texels * aspect).sqrt().clamp(1.0, whole.x);
        let height = (texels / width).clamp(1.0, whole.y);
        let width = (texels / height).clamp(1.0, whole.x);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "texels of a picture")]
        [width, height].map(|side| (side - 1e-3).ceil() as u32)
    }

    /// Where a picture is drawn that the maps lie over a part of.
    pub(crate) fn viewport(&self) -> Viewport {
        Viewport { origin: self.first.map(|texel| -i64::from(texel)), size: self.whole, scissor: [[0; 2], self.size] }
    }

    /// Texels that a length spans which is as long as it is far from the eye, along rows and columns.
    pub(crate) fn texels_per_tangent(&self, view: &View) -> [f32; 2] {
        let focal = view.focal();
        [0.5 * float(self.whole[0]) * focal.x, 0.5 * float(self.whole[1]) * focal.y]
    }

    /// Block of how pixels of a target lie on the maps: a picture of `picture` pixels from `origin` on, whose objects are `middle_mm`
    /// away.
    pub(crate) fn upsampling(&self, view: &View, picture: [u32; 2], origin: [u32; 2], middle_mm: f32) -> Upsampling {
        let texels_per_pixel = [0, 1].map(|k| float(self.whole[k]) / float(picture[k]));
        // Surfaces that are not seen at too flat an angle are the same two texels away.
        let [along_rows, along_columns] = self.texels_per_tangent(view);
        let near_mm = 2.0 * middle_mm.max(1e-3) / along_rows.min(along_columns);
        Upsampling {
            texels_per_pixel,
            origin: [0, 1].map(|k| float(origin[k]) + float(self.first[k]) / texels_per_pixel[k]),
            near_mm,
            pad: 0,
            last: self.size.map(|side| i32::try_from(side).unwrap_or(i32::MAX) - 1),
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use subsurf_scene::Camera;

    use super::*;

    #[test]
    fn maps_have_the_shape_of_what_is_covered() {
        let shape = |divisor, least, x, y| MapArea::shape([1280, 720], divisor, least, Vec2::new(x, y));
        assert_eq!(shape(1.0, 0.5, 1.0, 1.0), [1280, 720], "everything, and room for it");
        assert_eq!(shape(1.0, 2.0, 1.0, 1.0), [640, 360], "everything");
        assert_eq!(shape(1.0, 2.0, 0.5625, 1.0), [480, 480], "a square");
        assert_eq!(shape(1.0, 2.0, 0.1, 1.0), [320, 720], "a column: no higher than the picture");
        assert_eq!(shape(1.0, 2.0, 1.0, 0.01), [1280, 180], "a row");
        assert_eq!(shape(3.0, 2.0, 0.5625, 1.0), [427, 240], "coarse enough as it is");
        assert_eq!(shape(4.0, 2.0, 0.0, 0.0), [320, 180], "nothing");
        assert_eq!(MapArea::shape([1, 1], 4.0, 2.0, Vec2::ONE), [1, 1], "a pixel");
    }

    #[test]
    fn areas_are_as_fine_as_maps_can_hold_them() {
        let bounds = BoundingSphere { centre_mm: Vec3::ZERO, radius_mm: 1.0 };
        let (picture, maps) = ([1280, 720], [640, 360]);
        for (distance_mm, divisor) in [(2.0, 1.0), (5.0, 1.0), (20.0, 1.0), (500.0, 1.0), (2.0, 3.0), (500.0, 3.0)] {
            let eye_mm = Vec3::new(0.0, 0.0, distance_mm);
            let camera = Camera { eye_mm, target_mm: Vec3::new(0.2, 0.1, 0.0), fov_y_rad: 0.7, exposure: 1.0 };
            let view = View::new(&camera, &bounds, 1280.0 / 720.0);
            let area = MapArea::over(&view, &bounds, picture, maps, divisor);
            let [low, high] = view.rectangle(&bounds);
            let sides = [[low.x, high.x], [-high.y, -low.y]];
            for k in 0..2 {
                assert!(area.size[k] >= 1 && area.size[k] <= maps[k], "{distance_mm} mm: {area:?}");
                let [from, to] = sides[k].map(|side| (0.5 + 0.5 * side) * float(area.whole[k]));
                let (first, last) = (float(area.first[k]), float(area.first[k] + area.size[k]));
                assert!(first <= from && to <= last, "{distance_mm} mm: {from} to {to}, {area:?}");
                assert!(float(area.whole[k]) <= (float(picture[k]) / divisor).ceil(), "no finer: {area:?}");
            }
            // What is small is as fine as it may be; what covers all of the picture as the maps allow.
            let fine = [0, 1].map(|k| (float(picture[k]) / divisor).ceil());
            if distance_mm > 10.0 || divisor > 2.0 {
                assert_eq!(area.whole.map(float), fine, "{distance_mm} mm");
            }
            if distance_mm < 3.0 && divisor < 2.0 {
                assert_eq!(area.whole, maps, "{distance_mm} mm");
            }
        }
    }
}
