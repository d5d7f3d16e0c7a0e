//! Step B: base materials and ratios of every pixel, profiles fixed.

use std::borrow::Cow;

use subsurf_decoder::bssrdf::Mixture;

use super::albedo::Albedo;
use super::mix::{Curvatures, Tilt, product};
use crate::bssrdf::field::Field;
use crate::bssrdf::model::Model;
use crate::bssrdf::normal::Normal;
use crate::math::parallel;

/// Pixels this far apart in x and in y change together: φ is small between them, and threads have work.
const COLOURS: usize = 4;
/// A matrix that this many pixels share is worth a table of its own.
const SHARED: u32 = 4;

/// Improves every pixel once, Gauss-Seidel fashion: each sees the latest profiles of all but its own colour. With
/// `albedo` the error of the pixel's albedo counts too.
pub(super) fn search(normal: &Normal, model: &mut Model, field: &mut Field, mut albedo: Option<&mut Albedo>) {
    let deltas = normal.deltas(field);
    let users = normal.matrix_users();
    let tables: Vec<Option<Curvatures>> = parallel::map(users.len(), |k| {
        (users[k] >= SHARED).then(|| Curvatures::new(&normal.matrices[k].curvature(), model))
    });

    let [width, height] = normal.geometry.size;
    for colour in 0..COLOURS * COLOURS {
        let (x0, y0) = (colour % COLOURS, colour / COLOURS);
        let pixels: Vec<usize> = (y0..height)
            .step_by(COLOURS)
            .flat_map(|y| (x0..width).step_by(COLOURS).map(move |x| x + y * width))
            .collect();
        let best = |pixel: usize| {
            let matrix = normal.matrix_of[pixel] as usize;
            let curvatures = match &tables[matrix] {
                Some(table) => Cow::Borrowed(table),
                None => Cow::Owned(Curvatures::new(&normal.matrices[matrix].curvature(), model)),
            };
            let u = slopes(normal, model, field, &deltas, pixel);
            let tilt = albedo.as_deref().map(|albedo| {
                let constraint = albedo.constraint(normal, field.at(pixel), pixel);
                Tilt::new(&constraint, model)
            });
            curvatures.best(&u, tilt.as_ref(), model, &model.mixtures[pixel])
        };
        let best: Vec<Mixture> = parallel::map(pixels.len(), |k| best(pixels[k]));
        for (&pixel, &mixture) in pixels.iter().zip(&best) {
            model.mixtures[pixel] = mixture;
            let profile = model.profile(pixel);
            field.set(pixel, &profile);
            if let Some(albedo) = &mut albedo {
                albedo.set(normal, pixel, &profile);
            }
        }
        field.fill_border();
        if let Some(albedo) = &mut albedo {
            albedo.fill_border();
        }
    }
}

/// u_b = Σ_c P̂_bᵀ d of every base: half the slope of the pixel's cost along P̂_b.
fn slopes(normal: &Normal, model: &Model, field: &Field, deltas: &[isize], pixel: usize) -> Vec<f32> {
    let d = normal.pull(field, deltas, pixel);
    model.bases.chunks(model.nodes).map(|base| product(base, &d)).collect()
}
