//! Meshes that need no file.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::{Vec2, Vec3};

use super::Mesh;

/// Quads around a rounded edge.
const EDGE: u16 = 8;

/// A sphere of `radius_mm`, with `rings` rings of twice as many quads; u goes around, v from pole to pole.
///
/// # Panics
/// If `rings` is less than 2 or the radius not positive.
#[must_use]
pub fn sphere(radius_mm: f32, rings: u16) -> Mesh {
    assert!(rings >= 2 && radius_mm > 0.0, "{rings} rings of radius {radius_mm}");
    grid([2 * rings, rings], |uv| (direction(uv) * radius_mm, direction(uv)))
}

/// A torus around the y axis: a tube of radius `tube_mm` whose middle runs `radius_mm` from the axis, with `rings`
/// quads around the tube and three times as many along it.
///
/// # Panics
/// If `rings` is less than 3 or a radius not positive.
#[must_use]
pub fn torus(radius_mm: f32, tube_mm: f32, rings: u16) -> Mesh {
    assert!(rings >= 3 && radius_mm > 0.0 && tube_mm > 0.0, "{rings} rings of radii {radius_mm}, {tube_mm}");
    grid([3 * rings, rings], |uv| {
        let (along, around) = (TAU * uv.x, TAU * uv.y);
        let outwards = Vec3::new(along.sin(), 0.0, along.cos());
        let normal = outwards * around.cos() + Vec3::Y * around.sin();
        (outwards * radius_mm + normal * tube_mm, normal)
    })
}

/// A tube of radius `tube_mm` around a trefoil, the (2, 3) knot on a torus around the y axis whose middle runs
/// `radius_mm` from the axis; with `rings` quads around the tube and eight times as many along it. Spans 1.45 ·
/// `radius_mm` + `tube_mm` to either side; u goes along the knot, within 9 % in its length, v around the tube.
///
/// # Panics
/// If `rings` is less than 3, a radius not positive, or the tube so thick that it touches itself: `tube_mm` of 0.44 ·
/// `radius_mm` or more.
#[must_use]
pub fn knot(radius_mm: f32, tube_mm: f32, rings: u16) -> Mesh {
    assert!(rings >= 3 && radius_mm > 0.0 && tube_mm > 0.0, "{rings} rings of radii {radius_mm}, {tube_mm}");
    assert!(tube_mm < 0.44 * radius_mm, "a tube of {tube_mm} mm touches itself in a knot of {radius_mm} mm");
    let depth = 0.45;
    grid([8 * rings, rings], |uv| {
        // Slower where the knot runs far from the axis, so that u follows its length.
        let t = TAU * uv.x - 0.1 * (3.0 * TAU * uv.x).sin();
        let (sin_2, cos_2) = (2.0 * t).sin_cos();
        let (sin_3, cos_3) = (3.0 * t).sin_cos();
        let (outwards, along) = (Vec3::new(sin_2, 0.0, cos_2), Vec3::new(cos_2, 0.0, -sin_2));
        // c = (1 + d cos 3t) outwards + d sin 3t y, and dc/dt.
        let on_torus = outwards * cos_3 + Vec3::Y * sin_3;
        let middle = outwards + on_torus * depth;
        let speed = along * (2.0 + 2.0 * depth * cos_3) + (Vec3::Y * cos_3 - outwards * sin_3) * (3.0 * depth);
        // The normal of the torus turns around the knot 2.6 times; three turns back leave the least twist that closes.
        let around = TAU * uv.y - 3.0 * t;
        let normal = on_torus * around.cos() + on_torus.cross(speed.normalize()) * around.sin();
        (middle * radius_mm + normal * tube_mm, normal)
    })
}

/// A bowl around the y axis, open upwards: a wall of `thickness_mm` from a half sphere of `radius_mm` around the origin
/// inwards, with a round rim; `rings` rings of quads outside and as many inside, each of four times as many quads. The
/// wall is closed: it has an inside. u goes around, v from the lowest point outside over the rim to that inside.
///
/// # Panics
/// If `rings` is less than 2, or the thickness not positive or not less than the radius.
#[must_use]
pub fn bowl(radius_mm: f32, thickness_mm: f32, rings: u16) -> Mesh {
    assert!(rings >= 2 && thickness_mm > 0.0, "{rings} rings of thickness {thickness_mm}");
    assert!(thickness_mm < radius_mm, "a wall of {thickness_mm} mm in a bowl of {radius_mm} mm");
    let (half_mm, inner_mm) = (0.5 * thickness_mm, radius_mm - thickness_mm);
    let [outside, rim, inside] = [FRAC_PI_2 * radius_mm, PI * half_mm, FRAC_PI_2 * inner_mm];
    let length = outside + rim + inside;
    lattice(&spans(&[(1.0, 4 * rings)]), &spans(&[(outside, rings), (rim, EDGE), (inside, rings)]), |uv| {
        // An arc around a middle, both as (outwards, up), at a distance along the profile.
        let at = uv.y * length;
        let (middle, arc_mm, angle) = if at < outside {
            (Vec2::ZERO, radius_mm, at / radius_mm - FRAC_PI_2)
        } else if at < outside + rim {
            (Vec2::X * (radius_mm - half_mm), half_mm, (at - outside) / half_mm)
        } else {
            (Vec2::ZERO, -inner_mm, FRAC_PI_2 + (length - at) / inner_mm)
        };
        let outwards = Vec3::new((TAU * uv.x).sin(), 0.0, (TAU * uv.x).cos());
        let turned = |at: Vec2| outwards * at.x + Vec3::Y * at.y;
        let normal = Vec2::from_angle(angle);
        (turned(middle + normal * arc_mm), turned(normal))
    })
}

/// A round cloth of `thickness_mm` that hangs over the y axis like a bell, 1.3 · `radius_mm` high from its hem at y = 0,
/// in about `folds` folds that deepen from the top to the hem, where it is `radius_mm` wide on average; the hem is round.
/// `rings` rings of quads outside and as many inside, each of six times as many quads. The cloth is closed: it has an
/// inside. u goes around, v from the top of the inside over the hem to the top outside.
///
/// # Panics
/// If `rings` is less than 2, `folds` is 0, the thickness not positive, or the thickness times (`folds` + 2) more than
/// 0.6 · `radius_mm`: the cloth would be thicker than its folds are round.
#[must_use]
pub fn drapery(radius_mm: f32, thickness_mm: f32, folds: u16, rings: u16) -> Mesh {
    assert!(rings >= 2 && folds >= 1, "{rings} rings, {folds} folds");
    assert!(thickness_mm > 0.0, "a cloth of {thickness_mm} mm");
    let folds = f32::from(folds);
    assert!(
        thickness_mm * (folds + 2.0) <= 0.6 * radius_mm,
        "{folds} folds of {thickness_mm} mm in a cloth of {radius_mm} mm"
    );
    let half_mm = 0.5 * thickness_mm;
    // A quarter of an ellipse, nearly, and a half turn around its hem.
    let (side, hem) = (FRAC_PI_2 * 1.15 * radius_mm, PI * half_mm);
    let length = side + hem + side;
    lattice(&spans(&[(1.0, 6 * rings)]), &spans(&[(side, rings), (hem, EDGE), (side, rings)]), |uv| {
        // chi from the top to the hem of the middle of the cloth, beta from its inside around its hem to its outside.
        let at = uv.y * length;
        let chi = FRAC_PI_2 * (at.min(length - at) / side).clamp(0.0, 1.0);
        let beta = PI * ((at - side) / hem).clamp(0.0, 1.0);
        let [middle, outside, down] = cloth(chi, TAU * uv.x, folds);
        let normal = down * beta.sin() - outside * beta.cos();
        (middle * radius_mm + normal * half_mm, normal)
    })
}

/// A sphere of `radius_mm` on average with smooth bumps and hollows, about `bumps` of each around it, less than 2.1 /
/// (1 + 1.25 · `bumps`) of the radius high; `rings` rings of twice as many quads. u goes around, v from pole to pole.
///
/// # Panics
/// If `rings` is less than 2, `bumps` is 0 or the radius not positive.
#[must_use]
pub fn relief(radius_mm: f32, bumps: u16, rings: u16) -> Mesh {
    assert!(rings >= 2 && bumps >= 1 && radius_mm > 0.0, "{rings} rings of radius {radius_mm}, {bumps} bumps");
    let frequency = 1.25 * f32::from(bumps);
    let size = 0.35 / (1.0 + frequency);
    grid([2 * rings, rings], |uv| {
        let direction = direction(uv);
        // r = R (1 + h), h = Σ a sin(k · d + phase), and its gradient in d.
        let (mut height, mut gradient) = (0.0, Vec3::ZERO);
        for (wave, phase) in WAVES {
            let (sin, cos) = (frequency * wave.dot(direction) + phase).sin_cos();
            height += size * sin;
            gradient += size * frequency * cos * wave;
        }
        // n ~ (1 + h) d − the part of the gradient along the sphere.
        let along = gradient - direction * gradient.dot(direction);
        (direction * (1.0 + height) * radius_mm, (direction * (1.0 + height) - along).normalize())
    })
}

/// Directions and phases of the waves of [`relief`]: the six axes of an icosahedron, so that no side has more bumps.
const WAVES: [(Vec3, f32); 6] = [
    (Vec3::new(0.0, SHORT, LONG), 0.4),
    (Vec3::new(0.0, SHORT, -LONG), 2.9),
    (Vec3::new(SHORT, LONG, 0.0), 1.9),
    (Vec3::new(SHORT, -LONG, 0.0), 5.3),
    (Vec3::new(LONG, 0.0, SHORT), 4.1),
    (Vec3::new(-LONG, 0.0, SHORT), 0.9),
];

/// Sides of the corners of an icosahedron: 1 and the golden section, over the length of both.
const SHORT: f32 = 0.525_731_1;
const LONG: f32 = 0.850_650_8;

/// The direction from the middle of a sphere that texture coordinates name.
fn direction(uv: Vec2) -> Vec3 {
    let (theta, phi) = (PI * (1.0 - uv.y), TAU * uv.x);
    Vec3::new(theta.sin() * phi.sin(), theta.cos(), theta.sin() * phi.cos())
}

/// The middle of the cloth of [`drapery`], of radius 1, its unit normal outwards, and along it and away from its hem.
fn cloth(chi: f32, phi: f32, folds: f32) -> [Vec3; 3] {
    let (sin_chi, cos_chi) = chi.sin_cos();
    let (sin_phi, cos_phi) = phi.sin_cos();
    // Folds w(φ), of which no two are alike, and how deep they are, a(χ); with slopes.
    let waves = [(folds, 0.0, 1.2), (folds + 1.0, 1.0, 0.4), (2.0, 2.0, 0.2)];
    let (mut w, mut w_phi) = (0.0, 0.0);
    for (k, phase, size) in waves {
        let (sin, cos) = (k * phi + phase).sin_cos();
        w += size / (folds + 2.0) * cos;
        w_phi -= size / (folds + 2.0) * k * sin;
    }
    let (a, a_chi) = (sin_chi.powi(2), 2.0 * sin_chi * cos_chi);
    // m = (1 + a w) sin χ outwards + 1.3 cos χ y; dm/dχ, and dm/dφ / sin χ, which does not vanish at the top.
    let (outwards, along) = (Vec3::new(sin_phi, 0.0, cos_phi), Vec3::new(cos_phi, 0.0, -sin_phi));
    let wide = 1.0 + a * w;
    let middle = outwards * (wide * sin_chi) + Vec3::Y * (1.3 * cos_chi);
    let by_chi = outwards * (wide * cos_chi + a_chi * w * sin_chi) - Vec3::Y * (1.3 * sin_chi);
    let by_phi = (outwards * (a * w_phi) + along * wide).normalize();
    let normal = by_chi.cross(by_phi).normalize();
    [middle, normal, by_phi.cross(normal)]
}

/// A rectangle of quads in u and v, placed by `place`.
fn grid([columns, rows]: [u16; 2], place: impl Fn(Vec2) -> (Vec3, Vec3)) -> Mesh {
    lattice(&spans(&[(1.0, columns)]), &spans(&[(1.0, rows)]), place)
}

/// Where in 0 to 1 the borders of steps lie: of each span its length in any unit, and its number of steps.
fn spans(spans: &[(f32, u16)]) -> Vec<f32> {
    let length: f32 = spans.iter().map(|(length, _)| length).sum();
    let mut borders = vec![0.0];
    let mut start = 0.0;
    for &(span, steps) in spans {
        borders.extend((1..=steps).map(|k| (start + span * f32::from(k) / f32::from(steps)) / length));
        start += span;
    }
    borders
}

/// Quads between all given u and v, each of them growing, placed by `place`.
fn lattice(us: &[f32], vs: &[f32], place: impl Fn(Vec2) -> (Vec3, Vec3)) -> Mesh {
    let uvs: Vec<Vec2> = vs.iter().flat_map(|v| us.iter().map(|u| Vec2::new(*u, *v))).collect();
    let (positions, normals) = uvs.iter().map(|uv| place(*uv)).unzip();
    let index = |k: usize| u32::try_from(k).expect("sides of fewer than 2¹⁶ quads");
    let (stride, rows) = (index(us.len()), index(vs.len()));
    let quads = (0..rows - 1).flat_map(|y| (0..stride - 1).map(move |x| y * stride + x));
    let triangles = quads.flat_map(|a| [[a, a + 1, a + stride], [a + 1, a + stride + 1, a + stride]]).collect();
    Mesh { positions, normals, uvs: Some(uvs), triangles }
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::*;

    fn all() -> [(&'static str, Mesh); 10] {
        [
            ("sphere", sphere(10.0, 12)),
            ("torus", torus(10.0, 4.0, 10)),
            ("knot", knot(10.0, 3.0, 12)),
            ("bowl", bowl(10.0, 1.0, 10)),
            ("thick bowl", bowl(10.0, 9.0, 10)),
            ("drapery", drapery(10.0, 0.5, 6, 24)),
            ("thick drapery", drapery(10.0, 0.66, 7, 24)),
            ("one thin fold", drapery(10.0, 0.1, 1, 12)),
            ("relief", relief(10.0, 5, 30)),
            ("one bump", relief(10.0, 1, 12)),
        ]
    }

    /// Vertices nearer than this are at the same place, but for rounding.
    const SAME_MM: f32 = 2e-5;

    /// For each vertex the first at the same place.
    fn merged(mesh: &Mesh) -> Vec<u32> {
        let same = |a: Vec3| (0..).zip(&mesh.positions).find(|(_, b)| a.distance(**b) < SAME_MM);
        mesh.positions.iter().map(|a| same(*a).expect("a vertex is where it is").0).collect()
    }

    fn corners(mesh: &Mesh, triangle: [u32; 3]) -> [Vec3; 3] {
        triangle.map(|k| mesh.positions[k as usize])
    }

    /// Enclosed by triangles that are wound counter-clockwise as seen from outside, in mm³.
    fn volume(mesh: &Mesh) -> f32 {
        let under = |[a, b, c]: [Vec3; 3]| a.dot(b.cross(c)) / 6.0;
        mesh.triangles.iter().map(|triangle| under(corners(mesh, *triangle))).sum()
    }

    #[test]
    fn every_edge_has_two_triangles_of_opposite_ways() {
        for (name, mesh) in all() {
            let merged = merged(&mesh);
            let mut ways: HashMap<[u32; 2], usize> = HashMap::new();
            for triangle in &mesh.triangles {
                let [a, b, c] = triangle.map(|k| merged[k as usize]);
                // At a pole, one side of a quad is a point.
                if a != b && b != c && c != a {
                    for way in [[a, b], [b, c], [c, a]] {
                        *ways.entry(way).or_default() += 1;
                    }
                }
            }
            for ([a, b], count) in &ways {
                assert_eq!(*count, 1, "{name}: from {a} to {b}");
                assert!(ways.contains_key(&[*b, *a]), "{name}: nothing beyond {a} to {b}");
            }
        }
    }

    #[test]
    fn normals_are_of_unit_length_and_on_the_side_of_the_winding() {
        for (name, mesh) in all() {
            assert!(mesh.positions.iter().all(|position| position.is_finite()), "{name}");
            for normal in &mesh.normals {
                assert!((normal.length() - 1.0).abs() < 1e-5, "{name}: {normal}");
            }
            for triangle in &mesh.triangles {
                let [a, b, c] = corners(&mesh, *triangle);
                // At a pole, one side of a quad is a point.
                if [a.distance(b), b.distance(c), c.distance(a)].iter().any(|side| *side < SAME_MM) {
                    continue;
                }
                let wound = (b - a).cross(c - a).normalize();
                for k in triangle {
                    let cos = wound.dot(mesh.normals[*k as usize]);
                    assert!(cos > 0.5, "{name}: {triangle:?} is wound at a cosine of {cos} to a normal");
                }
            }
            assert!(volume(&mesh) > 0.0, "{name} is inside out");
        }
    }

    #[test]
    fn normals_are_upright_to_the_surface() {
        // The finer the mesh, the nearer its triangles are to the normals.
        let fine = [
            ("sphere", sphere(10.0, 200)),
            ("torus", torus(10.0, 4.0, 150)),
            ("knot", knot(10.0, 3.0, 100)),
            ("drapery", drapery(10.0, 0.5, 6, 150)),
            ("thick drapery", drapery(10.0, 0.66, 7, 150)),
            ("relief", relief(10.0, 5, 300)),
        ];
        for (name, mesh) in fine {
            let off = |triangle: &[u32; 3]| {
                let [a, b, c] = corners(&mesh, *triangle);
                let wound = (b - a).cross(c - a);
                let normal = triangle.iter().map(|k| mesh.normals[*k as usize]).sum::<Vec3>();
                (wound.length() - wound.dot(normal.normalize())).max(0.0)
            };
            let (off, area) = mesh.triangles.iter().fold((0.0, 0.0), |(sum, area), triangle| {
                let [a, b, c] = corners(&mesh, *triangle);
                (sum + off(triangle), area + (b - a).cross(c - a).length())
            });
            assert!(off < 1e-3 * area, "{name}: {}", off / area);
        }
    }

    #[test]
    fn volumes_are_those_of_the_formulas() {
        let near = |mesh: Mesh, mm3: f32| {
            let ratio = volume(&mesh) / mm3;
            assert!((ratio - 1.0).abs() < 0.01, "{ratio} of {mm3} mm³");
        };
        near(sphere(10.0, 100), 4.0 / 3.0 * PI * 1000.0);
        near(torus(10.0, 4.0, 80), TAU * 10.0 * PI * 16.0);
        // A tube has the length of its middle times its section; the knot's is 15.34 R.
        near(knot(10.0, 3.0, 80), 153.37 * PI * 9.0);
        // Half a hollow sphere, and half a torus for the rim.
        near(bowl(10.0, 2.0, 80), 2.0 / 3.0 * PI * (1000.0 - 512.0) + TAU * 9.0 * FRAC_PI_2);
    }

    #[test]
    fn texture_runs_along_the_knot_and_does_not_jump_at_the_join() {
        let rings = 24;
        let mesh = knot(10.0, 1.0, rings);
        let columns = usize::from(8 * rings);
        let steps: Vec<f32> = mesh.positions[..=columns].windows(2).map(|pair| pair[0].distance(pair[1])).collect();
        let mean = steps.iter().sum::<f32>() / columns as f32;
        for step in steps {
            assert!((step / mean - 1.0).abs() < 0.25, "a step of {step} mm where the mean is {mean} mm");
        }
        for row in mesh.normals.chunks_exact(columns + 1) {
            assert!(row[0].distance(row[columns]) < 1e-4, "{} goes on as {}", row[columns], row[0]);
        }
    }

    #[test]
    fn shapes_keep_to_their_sizes() {
        let [low, high] = drapery(10.0, 0.5, 6, 40).bounds();
        assert!((low.y + 0.25).abs() < 1e-2 && (high.y - 13.25).abs() < 1e-3, "{low}, {high}");
        assert!((high - low).max_element() < 26.0, "{low}, {high}");
        let [low, high] = bowl(10.0, 2.0, 40).bounds();
        assert!(
            (low.y + 10.0).abs() < 1e-3 && (high.y - 1.0).abs() < 1e-3 && (high.x - 10.0).abs() < 0.1,
            "{low}, {high}"
        );
        for position in relief(10.0, 5, 60).positions {
            assert!((position.length() - 10.0).abs() < 2.1 / 7.25 * 10.0, "{position}");
        }
    }

    #[test]
    #[should_panic(expected = "touches itself")]
    fn a_knot_does_not_touch_itself() {
        let _ = knot(10.0, 5.0, 12);
    }
}
