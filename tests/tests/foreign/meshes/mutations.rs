//! Broken meshes of every kind: each is read or refused, and nothing panics.

use std::path::Path;

use serde_json::json;
use subsurf_scene::{UpAxis, load_mesh};
use subsurf_tests::mutate::{Tally, assert_survives};

use super::gltf::DRACO;
use super::gltf_file::{CORNERS, Parts, U8, append, bytes, drawn, meshopt, square};

fn survive(name: &str, whole: &[Vec<u8>]) {
    let read = |path: &Path| load_mesh(path, 10.0, UpAxis::Y).map(drop);
    let Tally { read, refused } = assert_survives(name, whole, read);
    println!("{name}: {read} read, {refused} refused");
}

#[test]
fn broken_obj() {
    let plain = b"\xef\xbb\xbf# square\nmtllib a.mtl\no caf\xe9\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvn 0 0 1\n\
        usemtl\nf 1/1/1 2/2/1 \\\n 3/1/1 4/2/1\nl 1 2\n";
    let concave =
        b"v 0 0 0\r\nv 4 0 0 1.0\r\nv 4 1 0 # c\r\nv 1 1 0\r\nv 1 4 0 1 1 1\r\nv 0 4 0\r\nf -6 -5 -4 -3 -2 -1\r\n";
    survive("a.obj", &[plain.to_vec(), concave.to_vec()]);
}

#[test]
fn broken_ply() {
    let vertex = "property float x\nproperty float y\nproperty double z\nproperty float nx\nproperty float ny\nproperty float nz\n";
    let face = "element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n";
    let text = format!(
        "ply\nformat ascii 1.0\ncomment a\nelement vertex 4\n{vertex}{face}end_header\n0 0 0 0 0 1\n1 0 0 nan 0 1\n1 1 0 0 0 0\n\
         0 1 0 0 0 1\n3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 6 0 0 1 1 0 1\n"
    );
    let strips = "element tristrips 1\nproperty list int short vertex_indices\n";
    let mut binary = format!(
        "ply\nformat binary_big_endian 1.0\nelement vertex 4\nproperty float x\nproperty ushort y\nproperty char z\n{strips}end_header\n"
    )
    .into_bytes();
    for [x, y, _] in CORNERS {
        binary.extend(x.to_be_bytes());
        binary.extend([0, u8::from(y > 0.5), 0]);
    }
    binary.extend([0, 0, 0, 5, 0, 0, 0, 1, 0, 3, 0, 2, 0xff, 0xff]);
    survive("a.ply", &[text.into_bytes(), binary]);
}

#[test]
fn broken_stl() {
    let vertices = |corners: [usize; 3]| -> String {
        corners.iter().map(|&k| format!("vertex {} {} 0\n", CORNERS[k][0], CORNERS[k][1])).collect()
    };
    let [a, b] = [[0, 1, 2], [0, 2, 3]].map(vertices);
    let text = format!(
        "solid a\nfacet normal 0 0 1\nouter loop\n{a}endloop\nendfacet\nfacet\nouter loop\n{b}endloop\nendsolid\n"
    );
    let mut binary = vec![b' '; 80];
    binary.extend(2_u32.to_le_bytes());
    for corners in [[0, 1, 2], [0, 2, 3]] {
        let numbers = [[0.0; 3], CORNERS[corners[0]], CORNERS[corners[1]], CORNERS[corners[2]]];
        binary.extend(bytes(numbers.as_flattened(), f32::to_le_bytes));
        binary.extend([0, 0]);
    }
    survive("a.stl", &[text.into_bytes(), binary]);
}

#[test]
fn broken_off() {
    let text = "NCOFF # a\n4 2 0\n0 0 0 0 0 1 9 9 9 9\n1 0 0 0 0 1 9 9 9 9\n1 1 0 0 0 1 9 9 9 9\n0 1 0 0 0 1 9 9 9 9\n4 0 1 2 3\n3 0 1 2 9\n";
    survive("a.off", &[text.as_bytes().to_vec(), b"STOFF\n3 1 3\n0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n".to_vec()]);
}

/// A file of all that a reader does: nodes, instances, skins, targets, sparse and quantised accessors.
fn busy() -> (Parts, serde_json::Value) {
    let mut parts = square();
    let joints = parts.accessor(&[[0; 4], [0; 4], [1; 4], [1; 4]].concat(), U8, "VEC4", 4);
    let weights = parts.accessor(&[255, 0, 0, 0].repeat(4), U8, "VEC4", 4);
    parts.accessors[weights]["normalized"] = true.into();
    let steps = parts.floats(&[[0.0, 0.1, 0.2]; 4]);
    let numbers = parts.view(&[2]);
    let values = parts.view(&bytes(&[0.5, 0.5, 0.0], f32::to_le_bytes));
    parts.accessors[steps]["sparse"] = json!({ "count": 1,
        "indices": { "bufferView": numbers, "componentType": U8 }, "values": { "bufferView": values } });
    let primitive = json!({ "targets": [{ "POSITION": steps, "NORMAL": steps }], "mode": 4,
        "attributes": { "POSITION": 0, "NORMAL": 0, "JOINTS_0": joints, "WEIGHTS_0": weights } });
    let mut rest = drawn(&json!({ "skin": 0, "children": [1, 2], "weights": [0.5] }), &primitive);
    let instanced = json!({ "mesh": 0, "rotation": [0, 0, 1, 0], "scale": [-1, 2, 1], "extensions": {
        "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": 0, "SCALE": steps } } } });
    append(&mut rest["nodes"], instanced);
    append(&mut rest["nodes"], json!({ "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 5, 5, 1] }));
    rest["skins"] = json!([{ "joints": [1, 2] }]);
    (parts, rest)
}

/// A file whose views and primitive are compressed.
fn compressed() -> (Parts, serde_json::Value) {
    let mut parts = square();
    let positions = parts.view(&meshopt::attributes(&bytes(CORNERS.as_flattened(), f32::to_le_bytes), 12));
    let indices = parts.view(&meshopt::triangles(&[0, 1, 2, 0, 2, 3]));
    for (view, from, mode, count, stride) in [(0, positions, "ATTRIBUTES", 4, 12), (1, indices, "TRIANGLES", 6, 2)] {
        let compressed = parts.compressed(from, mode, count, stride);
        parts.views[view]["extensions"] = json!({ "EXT_meshopt_compression": compressed });
    }
    let stream = parts.view(&DRACO);
    let draco = json!({ "bufferView": stream, "attributes": { "POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2 } });
    let mut rest = drawn(&json!({}), &json!({}));
    let primitive = json!({ "attributes": { "POSITION": 0, "NORMAL": 0, "TEXCOORD_0": 0 },
        "extensions": { "KHR_draco_mesh_compression": draco } });
    append(&mut rest["meshes"][0]["primitives"], primitive);
    (parts, rest)
}

#[test]
fn broken_gltf() {
    let files = [busy(), compressed()].map(|(parts, rest)| parts.gltf(rest));
    survive("a.gltf", &files);
}

#[test]
fn broken_glb() {
    let files = [busy(), compressed()].map(|(parts, rest)| parts.glb(rest));
    survive("a.glb", &files);
}
