//! Polygons that are not convex, in all files that have polygons.

use super::{assert_area, load};

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
