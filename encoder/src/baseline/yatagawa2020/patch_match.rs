//! Step 2 of Algorithm 1: indices and ratios taken over from other pixels, after PatchMatch.

use rand::RngExt;
use rand_pcg::Pcg64;

use crate::bssrdf::field::Field;
use crate::bssrdf::model::Model;
use crate::bssrdf::normal::Normal;
use crate::math::lanes::{self, Lanes, ZERO};

/// One pass over all pixels in order: candidates are two neighbours, left and upper ones in `odd` rounds and right and
/// lower ones in even ones, and a random pixel; each is tried with the probability `acceptance`.
pub(super) fn search(normal: &Normal, model: &mut Model, odd: bool, acceptance: f64, rng: &mut Pcg64) {
    let mut field = model.field(normal);
    let deltas = normal.deltas(&field);
    let [width, height] = normal.geometry.size;
    for y in 0..height {
        for x in 0..width {
            let pixel = y * width + x;
            let neighbours = if odd {
                [x.checked_sub(1).map(|x| [x, y]), y.checked_sub(1).map(|y| [x, y])]
            } else {
                [(x + 1 < width).then_some([x + 1, y]), (y + 1 < height).then_some([x, y + 1])]
            };
            let neighbours = neighbours.map(|position| position.map(|[x, y]| y * width + x));
            let anywhere = Some(rng.random_range(0..normal.geometry.pixels()));
            let tried: Vec<usize> = neighbours
                .into_iter()
                .chain([anywhere])
                .filter(|_| rng.random_range(0.0..1.0) < acceptance)
                .flatten()
                .collect();
            if !tried.is_empty() {
                update(normal, model, &mut field, &deltas, pixel, &tried);
            }
        }
        // Where the patch goes on beyond its border, a row sees the row that it continues in one row late.
        field.fill_border();
    }
}

/// Algorithm 2 for all candidates of one pixel: what involves the pixel costs pᵀ A p − 2 pᵀ d, whatever its profile p,
/// and the rest of eq. 5 stays.
fn update(normal: &Normal, model: &mut Model, field: &mut Field, deltas: &[isize], pixel: usize, tried: &[usize]) {
    let nodes = model.nodes;
    let d = normal.pull(field, deltas, pixel);
    let curvature = normal.matrix(pixel).curvature();
    let cost = |p: &[Lanes]| {
        let mut image = vec![ZERO; nodes];
        curvature.multiply_add(p, &mut image);
        lanes::dot(p, &image).iter().sum::<f64>() - 2.0 * lanes::dot(p, &d).iter().sum::<f64>()
    };
    let mut lowest = cost(field.at(pixel));
    for &other in tried {
        let profile = field.at(other).to_vec();
        let cost = cost(&profile);
        if cost < lowest {
            lowest = cost;
            model.mixtures[pixel] = model.mixtures[other];
            field.set(pixel, &profile);
        }
    }
}
