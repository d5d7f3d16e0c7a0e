//! Images of a relief from all sides, under light from all sides.

use glam::Vec3;

use super::camera::Camera;
use super::height_field::{DIRECTIONS, Relief};
use super::light::LightOn;
use super::reflectance::Finish;
use super::samples::Sample;
use crate::capture::{Direction, bonn};
use crate::error::Result;
use crate::math::parallel;
use crate::progress::Progress;

/// Rays to a pixel in x and in y.
const RAYS: usize = 2;

/// Bytes of memory for a pixel while all is simulated: of each texel the surface, which texels it sees, and the light on it
/// from all directions.
pub(super) fn bytes_of_pixel() -> usize {
    let surface = size_of::<f32>() + size_of::<Finish>() + size_of::<Vec3>();
    let light = size_of::<f32>() + size_of::<Vec3>();
    RAYS * RAYS * (surface + DIRECTIONS * size_of::<u32>() + bonn().len() * light)
}

/// Simulates the images of a material in all pairs of [`bonn`] directions, `side` pixels wide and high, and hands each to
/// `sink`: light, view, and π L for light of unit irradiance on a plane that faces it, linear Rec. 709, row by row.
/// The surface repeats at its borders. Of white paper all pixels are cos θ of the light.
///
/// Primary rays find what is seen of the relief; shadows and two bounces of diffuse light are known for every texel of
/// it, four to a pixel. The camera's point spread function has a standard deviation of half a pixel, and of 1 / cos θ_v of
/// that along the view's azimuth, as with photographs that were laid on the surface.
///
/// # Errors
/// What `sink` fails with.
pub fn simulate(
    sample: Sample,
    side: usize,
    seed: u64,
    sink: impl FnMut(Direction, Direction, &[[f32; 3]]) -> Result<()>,
    progress: &dyn Progress,
) -> Result<()> {
    draw(&sample.relief(RAYS * side, seed), &bonn(), side, Camera::LENS, sink, progress)
}

fn draw(
    relief: &Relief,
    directions: &[Direction],
    side: usize,
    camera: Camera,
    mut sink: impl FnMut(Direction, Direction, &[[f32; 3]]) -> Result<()>,
    progress: &dyn Progress,
) -> Result<()> {
    progress.begin("light", directions.len() as u64);
    let exchange = relief.exchange();
    let lights = parallel::map(directions.len(), |k| {
        let on = LightOn::new(relief, &exchange, directions[k].unit());
        progress.advance(1);
        on
    });
    progress.begin("images", (directions.len() * directions.len()) as u64);
    for view in directions {
        let towards_eye = view.unit();
        let hits = relief.seen_from(towards_eye);
        let footprint = camera.footprint(towards_eye);
        let image = |light: &LightOn| footprint.blur(&picture(relief, &hits, light, towards_eye, side), side);
        let images: Vec<Vec<[f32; 3]>> = parallel::map(lights.len(), |k| image(&lights[k]));
        for (light, image) in directions.iter().zip(&images) {
            sink(*light, *view, image)?;
            progress.advance(1);
        }
    }
    Ok(())
}

/// Means over the rays of every pixel.
fn picture(relief: &Relief, hits: &[u32], light: &LightOn, towards_eye: Vec3, side: usize) -> Vec<Vec3> {
    let row = RAYS * side;
    let share = 1.0 / (RAYS * RAYS) as f32;
    let pixel = |k: usize| {
        let (x, y) = (RAYS * (k % side), RAYS * (k / side));
        let rays = (0..RAYS * RAYS).map(|n| hits[(y + n / RAYS) * row + x + n % RAYS]);
        let sum: Vec3 = rays.map(|hit| light.radiance(relief, hit, towards_eye)).sum();
        sum * share
    };
    (0..side * side).map(pixel).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::relief::reflectance::Finish;

    const SIDE: usize = 12;

    /// All images of a relief of `RAYS` · [`SIDE`] texels, by light and view.
    fn images(heights: impl Fn(usize, usize) -> f32, albedo: impl Fn(usize, usize) -> f32) -> Vec<Vec<Vec<[f32; 3]>>> {
        let side = RAYS * SIDE;
        let places = || (0..side * side).map(|k| (k % side, k / side));
        let finishes = places().map(|(x, y)| Finish::matte(Vec3::splat(albedo(x, y)))).collect();
        let relief = Relief::new(side, places().map(|(x, y)| heights(x, y)).collect(), finishes);
        let directions = bonn();
        let mut all = vec![vec![Vec::new(); directions.len()]; directions.len()];
        let place = |direction| directions.iter().position(|known| *known == direction).unwrap();
        let sink = |light, view, image: &[[f32; 3]]| {
            all[place(light)][place(view)] = image.to_vec();
            Ok(())
        };
        draw(&relief, &directions, SIDE, Camera { spread_px: 0.0 }, sink, &()).unwrap();
        all
    }

    fn mean(image: &[[f32; 3]]) -> f32 {
        image.iter().map(|rgb| rgb[1]).sum::<f32>() / image.len() as f32
    }

    /// White paper has the cosine of the light from all sides, and a pattern on it stays where it is.
    #[test]
    fn flat_paper_is_the_cosine_of_the_light_everywhere() {
        let all = images(|_, _| 0.0, |x, _| if x < SIDE { 1.0 } else { 0.25 });
        for (light, views) in bonn().iter().zip(&all) {
            let cosine = light.unit().z;
            for image in views {
                for (k, rgb) in image.iter().enumerate() {
                    let expected = cosine * if k % SIDE < SIDE / 2 { 1.0 } else { 0.25 };
                    assert!((rgb[0] - expected).abs() < 1e-5, "{light:?}, pixel {k}: {rgb:?}, not {expected}");
                }
            }
        }
    }

    /// Between walls it is dark under low light across them and not along them; one looks at walls and not between them.
    #[test]
    fn walls_cast_shadows_and_hide_what_lies_between() {
        let is_wall = |x: usize| x % 8 < 3;
        let all = images(|x, _| if is_wall(x) { 6.0 } else { 0.0 }, |x, _| if is_wall(x) { 0.2 } else { 0.9 });
        let at =
            |theta_deg, phi_deg| bonn().iter().position(|known| *known == Direction { theta_deg, phi_deg }).unwrap();
        let (across, along, above) = (at(60, 0), at(60, 90), at(0, 0));
        assert!(mean(&all[across][above]) < 0.6 * mean(&all[along][above]), "shadows");
        // From the side only walls are seen, which are dark.
        assert!(mean(&all[along][across]) < 0.6 * mean(&all[along][along]), "masking");
    }

    /// Light that bounces reaches what the light itself does not, and none is made of nothing.
    #[test]
    fn grooves_are_lit_by_each_other() {
        let depth = |x: usize| -6.0 * (1.0 - ((x % 12) as f32 - 5.5).abs() / 5.5);
        let [white, grey] = [1.0, 0.4].map(|albedo| images(|x, _| depth(x), |_, _| albedo));
        let above = 0;
        let [white, grey] = [white, grey].map(|all| mean(&all[above][above]));
        // Without light between slopes the two would be as far apart as their albedos.
        assert!(white > 1.1 * grey / 0.4, "{white} {grey}");
        assert!(white <= 1.02, "{white}: two of all bounces, of light that enters through the opening");
    }

    #[test]
    fn samples_are_the_same_for_the_same_seed_and_repeat() {
        let sum = |sample, seed| {
            let mut sum = 0.0;
            let sink = |_, _, image: &[[f32; 3]]| {
                sum += f64::from(mean(image));
                Ok(())
            };
            simulate(sample, 8, seed, sink, &()).unwrap();
            sum
        };
        for sample in Sample::ALL {
            let first = sum(sample, 1);
            assert!((first - sum(sample, 1)).abs() < 1e-9 && first > 20.0, "{sample:?}: {first}");
            assert!((first - sum(sample, 2)).abs() > 1e-6, "{sample:?}: another seed, another pattern");
        }
    }
}
