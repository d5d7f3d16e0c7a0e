//! Polygons as triangles.

use earcut::Earcut;
use glam::{DVec2, DVec3};

use super::raw::{Raw, Result};

/// A corner turns the wrong way if the sine of its angle is below this: less is the rounding of flat ones.
const CONCAVE: f64 = -1e-5;
/// Corners of a concave polygon, at most: the time that ears take grows with the square of their number.
const MOST_CORNERS: usize = 1 << 15;

impl Raw {
    /// Adds the triangles of a polygon of vertices that are there; none if it has fewer than three corners.
    pub(super) fn add_polygon(&mut self, corners: &[u32]) -> Result<()> {
        let positions: Vec<DVec3> = corners.iter().map(|&k| self.positions[k as usize]).collect();
        triangulate(&positions, |ear| self.triangles.push(ear.map(|k| corners[k])))
    }
}

/// Calls `triangle` with the three corners of each triangle of a polygon, as numbers into `corners`, its positions in
/// order. Convex polygons, and those that cross themselves, are fans around their first corner; concave ones are cut into
/// ears, in the plane that their area is largest in, unless they have too many corners.
fn triangulate(corners: &[DVec3], mut triangle: impl FnMut([usize; 3])) -> Result<()> {
    let fan = (2..corners.len()).map(|k| [0, k - 1, k]);
    match if corners.len() > 3 { ears(corners)? } else { None } {
        Some(ears) => ears.as_chunks().0.iter().for_each(|&ear| triangle(ear)),
        None => fan.for_each(triangle),
    }
    Ok(())
}

/// Three numbers for each ear of a polygon that is concave and does not cross itself.
fn ears(corners: &[DVec3]) -> Result<Option<Vec<usize>>> {
    let first = corners[0];
    let points: Vec<DVec3> = corners.iter().map(|corner| corner - first).collect();
    let next = |k: usize| (k + 1) % points.len();
    // Twice the area, along the normal (Newell).
    let area = (0..points.len()).map(|k| points[k].cross(points[next(k)])).sum::<DVec3>();
    let Some(normal) = area.try_normalize() else {
        return Ok(None);
    };
    let is_concave = (0..points.len()).any(|k| {
        let [a, b, c] = [k, next(k), next(next(k))].map(|k| points[k]);
        let (before, after) = (b - a, c - b);
        before.cross(after).dot(normal) < CONCAVE * before.length() * after.length()
    });
    if !is_concave {
        return Ok(None);
    }
    if corners.len() > MOST_CORNERS {
        // That of a disc is concave by the rounding of its corners alone.
        let of_fan: f64 = (2..points.len()).map(|k| points[k - 1].cross(points[k]).length()).sum();
        if is_same(of_fan, area.length()) {
            return Ok(None);
        }
        return Err(format!("a concave face of {} corners; expected at most {MOST_CORNERS}", corners.len()));
    }
    let [right, up] = <[DVec3; 2]>::from(normal.any_orthonormal_pair());
    let flat: Vec<DVec2> = points.iter().map(|point| DVec2::new(point.dot(right), point.dot(up))).collect();
    let mut ears: Vec<usize> = Vec::new();
    Earcut::new().earcut(flat.iter().map(|point| point.to_array()), &[], &mut ears);
    let mut total = 0.0;
    for ear in ears.as_chunks_mut::<3>().0 {
        let [a, b, c] = ear.map(|k| flat[k]);
        let area = (b - a).perp_dot(c - a);
        total += area.abs();
        if area < 0.0 {
            ear.swap(1, 2);
        }
    }
    Ok(is_same(total, area.length()).then_some(ears))
}

/// Whether triangles cover a polygon once: their area, without regard to their side, and its own.
fn is_same(of_triangles: f64, area: f64) -> bool {
    (of_triangles - area).abs() <= 1e-3 * area
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(corners: &[DVec3]) -> (usize, f64, DVec3) {
        let (mut count, mut sizes, mut sum) = (0, 0.0, DVec3::ZERO);
        triangulate(corners, |ear| {
            let [a, b, c] = ear.map(|k| corners[k]);
            let area = 0.5 * (b - a).cross(c - a);
            count += 1;
            sizes += area.length();
            sum += area;
        })
        .unwrap();
        (count, sizes, sum)
    }

    #[test]
    fn concave_polygons_keep_their_area_and_side() {
        let flat = |points: &[[f64; 2]]| points.iter().map(|&[x, y]| DVec3::new(x, y, 3.0)).collect::<Vec<_>>();
        let arrow = flat(&[[0.0, 0.0], [2.0, -1.0], [0.0, 3.0], [-2.0, -1.0]]);
        let l = flat(&[[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [1.0, 1.0], [1.0, 4.0], [0.0, 4.0]]);
        let comb: Vec<[f64; 2]> = (0..40u8)
            .map(|k| [f64::from(k), if k % 2 == 0 { 1.0 } else { 9.0 }])
            .chain([[39.0, 0.0], [0.0, 0.0]])
            .collect();
        let comb: Vec<[f64; 2]> = comb.into_iter().rev().collect();
        for (corners, size) in [(arrow, 6.0), (l, 7.0), (flat(&comb), 39.0 * 5.0)] {
            for shift in 0..corners.len() {
                let mut corners = corners.clone();
                corners.rotate_left(shift);
                let (count, sizes, sum) = area(&corners);
                assert_eq!(count, corners.len() - 2);
                assert!((sizes - size).abs() < 1e-3 && (sum.z - size).abs() < 1e-3, "{sizes}, {sum} for {size}");
                corners.reverse();
                let (_, sizes, sum) = area(&corners);
                assert!((sizes - size).abs() < 1e-3 && (sum.z + size).abs() < 1e-3, "{sizes}, {sum} for {size}");
            }
        }
    }

    #[test]
    fn what_has_no_inside_is_a_fan() {
        let line = [0.0, 1.0, 2.0, 3.0].map(|x| DVec3::new(x, 0.0, 0.0));
        assert_eq!(area(&line).0, 2);
        let bow = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
        assert_eq!(area(&bow).0, 2);
        let broken = [DVec3::NAN, DVec3::X, DVec3::Y, DVec3::Z, DVec3::INFINITY];
        assert_eq!(area(&broken).0, 3);
        assert_eq!(area(&line[..2]).0, 0);
    }
}
