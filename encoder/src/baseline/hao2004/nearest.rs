//! Interpolation between the four nearest lights (section 3.2).

/// Smallest angle in rad by which a weight is divided.
const LEAST_ANGLE: f32 = 1e-6;

/// Weights of lights for a unit direction: of the four nearest the inverse of the angle, of all others 0; they add up to 1.
///
/// The paper says "linear interpolation" of four values, not by which weights; inverse angles are the closest reading that has
/// no triangles.
#[must_use]
pub fn four_nearest(lights: &[[f32; 3]], towards: [f32; 3]) -> Vec<f32> {
    // From the chord: cosines of small angles have no digits left.
    let angle = |light: &[f32; 3]| {
        let chord = (0..3).map(|k| (light[k] - towards[k]).powi(2)).sum::<f32>().sqrt();
        2.0 * (0.5 * chord).min(1.0).asin()
    };
    let mut order: Vec<(usize, f32)> = lights.iter().map(angle).enumerate().collect();
    order.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
    order.truncate(4);
    let inverse = |angle: f32| 1.0 / angle.max(LEAST_ANGLE);
    let total: f32 = order.iter().map(|(_, angle)| inverse(*angle)).sum();
    let mut weights = vec![0.0; lights.len()];
    for (light, angle) in order {
        weights[light] = inverse(angle) / total;
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transfer::fibonacci;

    #[test]
    fn a_light_is_itself_and_others_share() {
        let lights = fibonacci(50);
        let own = four_nearest(&lights, lights[7]);
        assert!(own[7] > 0.999, "{}", own[7]);
        let between = four_nearest(&lights, [0.6, 0.0, 0.8]);
        assert_eq!(between.iter().filter(|weight| **weight > 0.0).count(), 4);
        assert!((between.iter().sum::<f32>() - 1.0).abs() < 1e-5);
    }
}
