//! Polygons that are not convex, in all files that have polygons.

use super::{assert_area, assert_refused, load};

/// Outlines, counterclockwise, and their areas.
const OUTLINES: [(&str, &[[f32; 2]], f32); 3] = [
    ("an L", &[[0.0, 0.0], [1.0, 0.0], [1.0, 0.25], [0.25, 0.25], [0.25, 1.0], [0.0, 1.0]], 0.4375),
    ("an arrow", &[[0.5, 0.25], [1.0, 0.0], [0.5, 1.0], [0.0, 0.0]], 0.375),
    (
        "a comb",
        &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.8, 0.2], [0.6, 1.0], [0.5, 0.2], [0.4, 1.0], [0.2, 0.2], [0.0, 1.0]],
        0.6,
    ),
];

fn obj(outline: &[[f32; 2]]) -> String {
    let vertices: String = outline.iter().map(|[x, y]| format!("v {x} {y} 0\n")).collect();
    let corners: Vec<String> = (1..=outline.len()).map(|k| k.to_string()).collect();
    format!("{vertices}f {}\n", corners.join(" "))
}

fn ply(outline: &[[f32; 2]]) -> String {
    let n = outline.len();
    let vertices: String = outline.iter().map(|[x, y]| format!("{x} {y} 0\n")).collect();
    let corners: Vec<String> = (0..n).map(|k| k.to_string()).collect();
    format!(
        "ply\nformat ascii 1.0\nelement vertex {n}\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n\
         property list uchar int vertex_indices\nend_header\n{vertices}{n} {}\n",
        corners.join(" ")
    )
}

fn off(outline: &[[f32; 2]]) -> String {
    let n = outline.len();
    let vertices: String = outline.iter().map(|[x, y]| format!("{x} {y} 0\n")).collect();
    let corners: Vec<String> = (0..n).map(|k| k.to_string()).collect();
    format!("OFF\n{n} 1 0\n{vertices}{n} {}\n", corners.join(" "))
}

fn stl(outline: &[[f32; 2]]) -> String {
    let vertices: String = outline.iter().map(|[x, y]| format!("vertex {x} {y} 0\n")).collect();
    format!("solid\nfacet normal 0 0 1\nouter loop\n{vertices}endloop\nendfacet\nendsolid\n")
}

#[test]
fn concave_polygons_keep_their_shape() {
    for (what, outline, area) in OUTLINES {
        for first in 0..outline.len() {
            let mut outline = outline.to_vec();
            outline.rotate_left(first);
            for (name, text) in
                [("a.obj", obj(&outline)), ("a.ply", ply(&outline)), ("a.off", off(&outline)), ("a.stl", stl(&outline))]
            {
                let mesh = load(&[(name, text.into_bytes())]).unwrap().mesh;
                assert_area(&format!("{what}, {name}, from corner {first}"), &mesh, area);
            }
        }
    }
}

/// Ears of very many corners would take hours; a convex face of as many takes no time.
#[test]
fn very_many_corners_are_one_line_or_a_fan() {
    let ring = |count: u16, inner: f32| -> Vec<[f32; 2]> {
        let at = |k: u16| {
            let (radius, angle) = (if k.is_multiple_of(2) { 1.0 } else { inner }, std::f32::consts::TAU * f32::from(k));
            let (sin, cos) = (angle / f32::from(count)).sin_cos();
            [radius * cos, radius * sin]
        };
        (0..count).map(at).collect()
    };
    let star = ring(40_000, 0.8);
    for (name, text, place) in
        [("a.obj", obj(&star), "line 40001"), ("a.off", off(&star), "line 40003"), ("a.stl", stl(&star), "a concave")]
    {
        assert_refused(
            name,
            &[(name, text.into_bytes())],
            &[place, "a concave face of 40000 corners", "at most 32768"],
        );
    }
    let mesh = load(&[("a.obj", obj(&ring(40_000, 1.0)).into_bytes())]).unwrap().mesh;
    assert_area("a disc", &mesh, std::f32::consts::FRAC_PI_4);
}
