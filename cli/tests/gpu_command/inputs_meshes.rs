//! Meshes of others: exit codes, and what is said on stderr.

use crate::common::{assert_refused, run, simulate, succeed};

#[test]
fn meshes_are_drawn_with_a_warning_or_refused_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    simulate(folder, "a");
    succeed(folder, "encode a.npy -M 4");
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
    let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).unwrap();
    write("square.obj", &format!("mtllib square.mtl\nusemtl a\n{square}l 1 2\n"));
    write("square.mtl", "newmtl a\nKd 0.8\n");
    write("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    write("far.obj", &format!("{square}f 1 2 9\n"));
    write(
        "none.gltf",
        r#"{"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":7}}]}]}"#,
    );
    let draw = |mesh: &str| format!("render a.subsurf --mesh {mesh} --extent 4 --size 60x50 --backend cpu -o m.png");
    let drawn = succeed(folder, &draw("square.obj"));
    assert!(drawn.err.contains("warning: square.obj: 1 lines and points: left out"), "{}", drawn.err);
    assert_refused(&run(folder, &draw("line.obj")), &["line.obj", "no area"]);
    assert_refused(&run(folder, &draw("far.obj")), &["far.obj", "line 6", "vertex 9"]);
    assert_refused(&run(folder, &draw("none.gltf")), &["none.gltf", "accessor 7"]);
}
