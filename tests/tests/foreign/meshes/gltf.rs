//! glTF files as all kinds of programs write them.

use glam::Vec2;
use serde_json::{Value, json};

use super::gltf_file::{CORNERS, Parts, U8, U16, append, bytes, drawn, meshopt, square};
use super::{assert_area, assert_refused, assert_square, load};

fn assert_quiet(what: &str, file: Vec<u8>) {
    assert_eq!(assert_square(what, &[("square.gltf", file)]), [""; 0], "{what}");
}

fn refused(what: &str, file: Vec<u8>, parts: &[&str]) {
    assert_refused(what, &[("broken.gltf", file)], parts);
}

fn plain() -> Value {
    drawn(&json!({}), &json!({}))
}

#[test]
fn bytes_are_where_the_file_says() {
    let parts = square();
    assert_quiet("a data URI", parts.gltf(plain()));
    assert_eq!(assert_square("glb", &[("square.glb", parts.glb(plain()))]), [""; 0]);
    assert_eq!(assert_square("glb by another name", &[("square.gltf", parts.glb(plain()))]), [""; 0]);
    for (uri, name) in [("square.bin", "square.bin"), ("a%20b%C3%A9.bin", "a bé.bin")] {
        let json = parts.json(plain(), Some(uri)).to_string().into_bytes();
        assert_eq!(assert_square(uri, &[("square.gltf", json), (name, parts.bytes.clone())]), [""; 0]);
    }
    // What no mesh needs is not looked for.
    let mut file = parts.json(plain(), Some("square.bin"));
    append(&mut file["buffers"], json!({ "uri": "animation.bin", "byteLength": 99 }));
    file["images"] = json!([{ "uri": "none.png" }, 7]);
    let files = [("square.gltf", file.to_string().into_bytes()), ("square.bin", parts.bytes.clone())];
    assert_eq!(assert_square("missing images", &files), [""; 0]);
    let marked = [b"\xef\xbb\xbf".to_vec(), parts.gltf(plain())].concat();
    assert_quiet("a byte-order mark", marked);
}

#[test]
fn accessors_are_strided_sparse_and_of_any_type() {
    // Positions between other numbers.
    let mut parts = Parts::default();
    let rows: Vec<[f32; 5]> = CORNERS.iter().map(|[x, y, z]| [9.0, *x, *y, *z, f32::NAN]).collect();
    parts.floats(&rows);
    parts.indices(&[0, 1, 2, 0, 2, 3]);
    parts.views[0]["byteStride"] = 20.into();
    parts.accessors[0] = json!({ "bufferView": 0, "byteOffset": 4, "componentType": 5126, "type": "VEC3", "count": 4 });
    assert_quiet("strided", parts.gltf(plain()));

    // Zeros, but for three corners.
    let mut parts = square();
    let numbers = parts.view(&[1, 2, 3]);
    let values = parts.view(&bytes(CORNERS[1..].as_flattened(), f32::to_le_bytes));
    parts.accessors[0] = json!({ "componentType": 5126, "type": "VEC3", "count": 4, "sparse": {
        "count": 3, "indices": { "bufferView": numbers, "componentType": 5121 }, "values": { "bufferView": values } } });
    assert_quiet("sparse", parts.gltf(plain()));
    parts.accessors[0]["sparse"]["count"] = 4.into();
    refused("a sparse accessor that is too long", parts.gltf(plain()), &["accessor 0", "4 elements"]);

    for (component, size) in [(U8, 1), (U16, 2), (5125, 4)] {
        let mut parts = square();
        let indices: Vec<u8> =
            [0_u32, 1, 2, 0, 2, 3].iter().flat_map(|index| index.to_le_bytes().into_iter().take(size)).collect();
        let number = parts.accessor(&indices, component, "SCALAR", 6);
        assert_quiet("indices", parts.gltf(drawn(&json!({}), &json!({ "indices": number }))));
    }
    let text = String::from_utf8(square().gltf(plain())).unwrap().replace("\"count\":4", "\"count\":4.0");
    assert_quiet("whole numbers with a point", text.into_bytes());
}

#[test]
fn quantised_positions_and_texture_coordinates() {
    let mut parts = square();
    let positions: Vec<u16> =
        CORNERS.iter().flat_map(|corner| corner.map(|x| if x > 0.5 { 65535 } else { 0 })).collect();
    let raw = parts.accessor(&bytes(&positions, u16::to_le_bytes), U16, "VEC3", 4);
    let shares = parts.accessor(&bytes(&positions, u16::to_le_bytes), U16, "VEC3", 4);
    parts.accessors[shares]["normalized"] = true.into();
    let small: Vec<i8> = CORNERS.iter().flat_map(|corner| corner.map(|x| if x > 0.5 { 127 } else { -127 })).collect();
    let signed = parts.accessor(&bytes(&small, i8::to_le_bytes), 5120, "VEC3", 4);
    let uv = parts.accessor(&[0, 10, 10, 10, 10, 0, 0, 0], U8, "VEC2", 4);
    for (number, node) in [
        (raw, json!({ "scale": [1e-4, 1e-4, 1e-4], "translation": [9, 9, 9] })),
        (shares, json!({})),
        (signed, json!({ "matrix": [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 5, 1] })),
    ] {
        let attributes = json!({ "POSITION": number, "TEXCOORD_0": uv });
        let mut rest = drawn(&node, &json!({ "attributes": attributes, "material": 0 }));
        rest["extensionsRequired"] = json!(["KHR_mesh_quantization", "KHR_texture_transform"]);
        rest["materials"] = json!([{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0, "extensions": {
            "KHR_texture_transform": { "scale": [0.1, 0.1] } } } } }]);
        let file = parts.gltf(rest);
        assert_quiet("quantised", file.clone());
        let mesh = load(&[("a.gltf", file.clone())]).unwrap().mesh;
        for (position, uv) in mesh.positions.iter().zip(mesh.uvs.unwrap()) {
            assert!((position.truncate() + 0.5).abs_diff_eq(uv, 1e-3), "{position} has {uv}");
        }
        // A quarter counter-clockwise where v counts downwards: (u, v) is at (v, -u), which is moved back.
        let mut turned: Value = serde_json::from_slice(&file).unwrap();
        let transform = json!({ "scale": [0.1, 0.1], "rotation": std::f32::consts::FRAC_PI_2, "offset": [0.0, 1.0] });
        turned["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"] =
            transform;
        let mesh = load(&[("a.gltf", turned.to_string().into_bytes())]).unwrap().mesh;
        for (position, uv) in mesh.positions.iter().zip(mesh.uvs.unwrap()) {
            let [x, y] = (position.truncate() + 0.5).to_array();
            assert!(uv.abs_diff_eq(Vec2::new(1.0 - y, x), 1e-3), "{position} has {uv}");
        }
    }
}

#[test]
fn strips_and_fans_are_triangles_and_the_rest_is_counted() {
    let mut parts = square();
    let strip = parts.indices(&[0, 1, 3, 2]);
    let joined = parts.indices(&[0, 1, 3, 3, 1, 1, 1, 2, 3]);
    let fan = parts.indices(&[0, 1, 2, 3]);
    for (what, mode, indices) in
        [("a strip", 5, strip), ("joined strips", 5, joined), ("a fan", 6, fan), ("a list", 4, 1)]
    {
        assert_quiet(what, parts.gltf(drawn(&json!({}), &json!({ "mode": mode, "indices": indices }))));
    }
    // Vertices without indices.
    let ordered: Vec<[f32; 3]> = [0, 1, 2, 0, 2, 3].map(|k: usize| CORNERS[k]).to_vec();
    let positions = parts.floats(&ordered);
    let rest = json!({ "nodes": [{ "mesh": 0 }], "meshes": [{ "primitives": [{ "attributes": { "POSITION": positions } }] }] });
    assert_quiet("no indices", parts.gltf(rest));
    let mut rest = plain();
    for mode in 0..4 {
        append(&mut rest["meshes"][0]["primitives"], json!({ "mode": mode, "attributes": { "POSITION": 0 } }));
    }
    append(&mut rest["meshes"][0]["primitives"], json!({ "attributes": {} }));
    let warnings = assert_square("points and lines", &[("a.gltf", parts.gltf(rest))]);
    assert_eq!(warnings, ["4 primitives of points or lines: left out", "1 primitives without positions: left out"]);
    let lines = drawn(&json!({}), &json!({ "mode": 1 }));
    refused("only lines", parts.gltf(lines), &["no triangles; 1 primitives of points or lines"]);
}

#[test]
fn mirrored_nodes_keep_the_outside_outside() {
    let mut parts = square();
    let normals = parts.floats(&[[0.0, 0.0, 1.0]; 4]);
    for (what, node) in [
        ("a scale", json!({ "scale": [-1, 1, 1] })),
        ("a matrix", json!({ "matrix": [1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0, 5, 5, 5, 1] })),
        ("two mirrors", json!({ "scale": [-1, -1, 1] })),
        ("a rotation and a mirror", json!({ "rotation": [0, 0, 1, 0], "scale": [1, -2, 1], "translation": [3, 0, 0] })),
    ] {
        for primitive in [json!({}), json!({ "attributes": { "POSITION": 0, "NORMAL": normals } })] {
            let file = parts.gltf(drawn(&node, &primitive));
            let mesh = load(&[("a.gltf", file)]).unwrap().mesh;
            let [low, high] = mesh.bounds();
            assert_area(what, &mesh, (high - low).x * (high - low).y);
            assert!(mesh.normals.iter().all(|normal| normal.z > 0.99), "{what}: {:?}", mesh.normals);
        }
    }
    // A node without thickness has no normals.
    let file = parts
        .gltf(drawn(&json!({ "scale": [1, 1, 0] }), &json!({ "attributes": { "POSITION": 0, "NORMAL": normals } })));
    let warnings = assert_square("a flat scale", &[("a.gltf", file)]);
    assert!(warnings.len() == 1 && warnings[0].contains("4 of 4 normals"), "{warnings:?}");
}

#[test]
fn what_is_not_drawn_does_not_matter() {
    let mut parts = square();
    let ids = parts.floats(&[[1.0]; 4]);
    for (what, key, value) in [
        ("a texture of an extension", "textures", json!([{ "extensions": { "KHR_texture_basisu": { "source": 0 } } }])),
        ("materials that are wrong", "materials", json!([{ "alphaMode": 7, "pbrMetallicRoughness": [] }, null, "x"])),
        ("animations that are wrong", "animations", json!([{ "channels": [{ "sampler": 9 }], "samplers": {} }])),
        ("cameras and extras", "cameras", json!([{ "type": "fish" }])),
        ("accessors that are wrong", "x", json!(null)),
        ("required materials", "extensionsRequired", json!(["KHR_materials_unlit", "KHR_materials_newest"])),
        ("required textures", "extensionsRequired", json!(["KHR_texture_basisu", "EXT_texture_webp"])),
        ("required lights", "extensionsRequired", json!(["KHR_lights_punctual"])),
    ] {
        let attributes = json!({ "POSITION": 0, "_BATCHID": ids, "COLOR_0": 99, "_x": 0, "TANGENT": ids });
        let mut rest = drawn(&json!({}), &json!({ "attributes": attributes, "material": 0 }));
        rest[key] = value;
        assert_quiet(what, parts.gltf(rest));
    }
    let mut rest = plain();
    rest["extensionsRequired"] = json!(["ACME_curves"]);
    let warnings = assert_square("an unknown extension", &[("a.gltf", parts.gltf(rest))]);
    assert!(warnings.len() == 1 && warnings[0].contains("ACME_curves"), "{warnings:?}");
    let named = drawn(&json!({ "name": "caf@" }), &json!({}));
    let latin = parts.gltf(named).into_iter().map(|byte| if byte == b'@' { 0xe9 } else { byte }).collect();
    assert_quiet("Latin-1", latin);
}

#[test]
fn scenes_and_nodes() {
    let parts = square();
    let mut rest = plain();
    rest["scenes"] = json!([]);
    assert_quiet("no scene", parts.gltf(rest.clone()));
    rest["scenes"] = json!([{ "nodes": [] }, { "nodes": [0] }]);
    rest["scene"] = 1.into();
    assert_quiet("the default scene", parts.gltf(rest.clone()));
    rest["nodes"] = json!([{ "children": [1, 2] }, { "mesh": 0, "translation": [0, 0, 7] },
        { "mesh": 0, "scale": [5, 5, 5], "extensions": { "KHR_node_visibility": { "visible": false } } }]);
    assert_quiet("a node that is hidden", parts.gltf(rest.clone()));
    rest["nodes"] = json!([{ "children": [1] }, { "children": [0], "mesh": 0 }]);
    refused("a circle", parts.gltf(rest.clone()), &["node 0", "nodes make a tree"]);
    rest["scene"] = 2.into();
    refused("no such scene", parts.gltf(rest), &["scene 2", "there are 2"]);
}

#[test]
fn instances_skins_and_morph_targets_are_applied() {
    // Four quarters of the square.
    let mut parts = square();
    let corners: Vec<[f32; 3]> = CORNERS.iter().map(|corner| corner.map(|x| 0.5 * x)).collect();
    let translations = parts.floats(&corners);
    let scales = parts.floats(&[[0.5; 3]; 4]);
    let rotations = parts.floats(&[[0.0, 0.0, 0.0, 1.0]; 4]);
    let attributes = json!({ "TRANSLATION": translations, "SCALE": scales, "ROTATION": rotations, "_ID": 99 });
    let node = json!({ "extensions": { "EXT_mesh_gpu_instancing": { "attributes": attributes } } });
    let file = parts.gltf(drawn(&node, &json!({})));
    assert_quiet("instances", file.clone());
    assert_eq!(load(&[("a.gltf", file)]).unwrap().mesh.triangles.len(), 8);

    // Accessors without bytes are zeros, as many as they say.
    let many = json!({ "componentType": 5126, "type": "VEC3", "count": 60_000_000 });
    parts.accessors.push(many);
    let attributes = json!({ "TRANSLATION": parts.accessors.len() - 1 });
    let node = json!({ "extensions": { "EXT_mesh_gpu_instancing": { "attributes": attributes } } });
    let very_many = parts.gltf(drawn(&node, &json!({})));
    refused("very many instances", very_many, &["240000000 vertices or triangles; a mesh has at most 67108864"]);

    // A line, of which a target makes the square.
    let mut parts = square();
    let line = parts.floats(&CORNERS.map(|[x, ..]| [x, 0.0, 0.0]));
    let target = parts.floats(&CORNERS.map(|[_, y, _]| [0.0, 2.0 * y, 0.0]));
    let primitive = json!({ "attributes": { "POSITION": line }, "targets": [{ "POSITION": target }, {}] });
    assert_quiet("weights of a node", parts.gltf(drawn(&json!({ "weights": [0.5, 1.0] }), &primitive)));
    let mut rest = drawn(&json!({}), &primitive);
    rest["meshes"][0]["weights"] = json!([0.5, 0.0]);
    assert_quiet("weights of a mesh", parts.gltf(rest.clone()));
    rest["meshes"][0]["weights"] = json!([0.0, 0.0]);
    refused("no weights", parts.gltf(rest), &["no area"]);

    // The upper corners follow another joint, which is a unit higher; so is what they were bound to.
    let mut parts = square();
    let joints = parts.accessor(&[[0, 9, 9, 9], [0; 4], [1; 4], [1, 0, 0, 0]].concat(), U8, "VEC4", 4);
    let weights = parts.floats(&[[1.0, 0.0, 0.0, 0.0]; 4]);
    let flat = parts.floats(&CORNERS.map(|[x, ..]| [x, 0.0, 0.0]));
    let attributes = json!({ "POSITION": flat, "JOINTS_0": joints, "WEIGHTS_0": weights });
    let mut rest = drawn(&json!({ "skin": 0, "translation": [70, 70, 70] }), &json!({ "attributes": attributes }));
    append(&mut rest["nodes"], json!({ "children": [2] }));
    append(&mut rest["nodes"], json!({ "translation": [0, 1, 0] }));
    rest["skins"] = json!([{ "joints": [1, 2] }]);
    assert_quiet("a skin", parts.gltf(rest.clone()));
    let identity = glam::Mat4::IDENTITY.to_cols_array();
    let bound =
        parts.floats(&[identity, glam::Mat4::from_translation(glam::Vec3::new(0.0, -1.0, 0.0)).to_cols_array()]);
    rest["skins"][0]["inverseBindMatrices"] = bound.into();
    refused("a skin as it was bound", parts.gltf(rest.clone()), &["no area"]);
    rest["skins"][0]["joints"] = json!([1]);
    refused("few joints", parts.gltf(rest), &["mesh 0, primitive 0", "joint 1 of 1"]);
}

#[test]
fn compressed_views_and_primitives() {
    let mut parts = square();
    let positions = parts.view(&meshopt::attributes(&bytes(CORNERS.as_flattened(), f32::to_le_bytes), 12));
    let indices = parts.view(&meshopt::triangles(&[0, 1, 2, 0, 2, 3]));
    for name in ["EXT_meshopt_compression", "KHR_meshopt_compression"] {
        let mut parts = parts.clone();
        for (view, from, mode, count, stride) in [(0, positions, "ATTRIBUTES", 4, 12), (1, indices, "TRIANGLES", 6, 2)]
        {
            let compressed = parts.compressed(from, mode, count, stride);
            // The bytes themselves are nowhere.
            parts.views[view] =
                json!({ "buffer": 1, "byteLength": count * stride, "extensions": { name: compressed } });
        }
        let mut rest = plain();
        rest["extensionsRequired"] = json!([name]);
        assert_quiet(name, parts.gltf(rest.clone()));
        parts.views[1]["extensions"][name]["count"] = 7.into();
        refused("seven indices", parts.gltf(rest), &["bufferView 1", "TRIANGLES", "7 elements"]);
    }

    let stream = parts.view(&DRACO);
    let draco = json!({ "bufferView": stream, "attributes": { "POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2 } });
    let mut rest = drawn(
        &json!({}),
        &json!({ "extensions": { "KHR_draco_mesh_compression": draco },
        "attributes": { "POSITION": 0, "NORMAL": 0, "TEXCOORD_0": 0 } }),
    );
    rest["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
    parts.accessors[0] = json!({ "componentType": 5126, "type": "VEC3", "count": 4 });
    let file = parts.gltf(rest.clone());
    assert_quiet("Draco", file.clone());
    assert!(load(&[("a.gltf", file)]).unwrap().mesh.uvs.is_some(), "Draco: texture coordinates");
    parts.views[stream]["byteLength"] = 40.into();
    refused("a Draco stream that is cut", parts.gltf(rest), &["mesh 0, primitive 0", "Draco"]);
}

/// The square in a Draco stream (edgebreaker; positions of 11 bits, normals of 8, texture coordinates of 10).
pub(super) const DRACO: [u8; 164] = [
    68, 82, 65, 67, 79, 2, 2, 1, 1, 0, 0, 0, 4, 2, 2, 2, 0, 0, 1, 31, 255, 1, 17, 255, 1, 17, 255, 1, 17, 3, 255, 0, 0,
    0, 0, 0, 1, 0, 0, 1, 0, 9, 3, 0, 0, 2, 1, 1, 9, 3, 0, 1, 3, 1, 3, 9, 2, 0, 2, 2, 1, 1, 1, 0, 3, 3, 1, 48, 1, 16, 3,
    0, 40, 130, 152, 0, 0, 0, 0, 0, 255, 7, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 128, 63, 11, 0, 3, 1, 1, 1,
    128, 1, 1, 56, 255, 247, 1, 8, 3, 0, 152, 132, 255, 0, 0, 0, 127, 0, 0, 0, 8, 1, 1, 1, 0, 3, 3, 1, 32, 1, 32, 3, 0,
    240, 131, 166, 0, 0, 0, 0, 0, 255, 3, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 128, 63, 10,
];

#[test]
fn errors_say_which_part_is_wrong() {
    let parts = square();
    for (what, pointer, value, expected) in [
        (
            "no accessor",
            "/meshes/0/primitives/0/attributes/POSITION",
            json!(9),
            &["POSITION", "accessor 9", "there are 2"][..],
        ),
        ("no indices", "/meshes/0/primitives/0/indices", json!(9), &["indices", "accessor 9"]),
        ("no mesh", "/nodes/0/mesh", json!(3), &["node 0", "mesh 3", "there are 1"]),
        ("no view", "/accessors/0/bufferView", json!(5), &["accessor 0", "bufferView 5"]),
        ("no buffer", "/bufferViews/0/buffer", json!(2), &["bufferView 0", "buffer 2"]),
        ("float indices", "/meshes/0/primitives/0/indices", json!(0), &["indices", "accessor 0", "VEC3"]),
        ("indices as floats", "/accessors/1/componentType", json!(5126), &["accessor 1", "6 elements of 4 bytes"]),
        ("signed indices", "/accessors/1/componentType", json!(5122), &["accessor 1", "expected unsigned"]),
        ("no such type", "/accessors/0/componentType", json!(5124), &["accessor 0", "5124"]),
        ("scalars", "/accessors/0/type", json!("SCALAR"), &["accessor 0", "SCALAR", "expected 3"]),
        ("too many", "/accessors/0/count", json!(5), &["accessor 0", "5 elements", "48 bytes"]),
        ("far too many", "/accessors/0/count", json!(4_000_000_000_000_u64), &["accessor 0", "4000000000000"]),
        ("an offset", "/accessors/0/byteOffset", json!(8), &["accessor 0", "byte 8"]),
        (
            "a view that is too long",
            "/bufferViews/0/byteLength",
            json!(999),
            &["bufferView 0", "999 bytes", "buffer 0"],
        ),
        ("a stride", "/bufferViews/0/byteStride", json!(16), &["accessor 0", "16 apart"]),
        ("a negative number", "/accessors/0/count", json!(-4), &["JSON", "-4", "line 1"]),
        ("a broken number", "/accessors/0/count", json!(4.5), &["JSON", "4.5"]),
        ("a mode", "/meshes/0/primitives/0/mode", json!(7), &["mode 7"]),
        ("a file that is not there", "/buffers/0/uri", json!("none.bin"), &["buffer 0", "none.bin"]),
        ("the net", "/buffers/0/uri", json!("https://example.org/a.bin"), &["buffer 0", "beside the .gltf"]),
        ("no base64", "/buffers/0/uri", json!("data:;base64,@"), &["buffer 0", "data URI"]),
        ("no bytes", "/buffers/0/uri", json!(null), &["buffer 0 has no uri"]),
        ("positions of nowhere", "/accessors/0/bufferView", json!(null), &["accessor 0 has no bufferView"]),
        ("version 1", "/asset/version", json!("1.0"), &["\"1.0\"", "expected 2.0"]),
        ("an infinite place", "/nodes/0/scale", json!([1e39, 1, 1]), &["expected"]),
    ] {
        let mut file: Value = serde_json::from_slice(&parts.gltf(plain())).unwrap();
        let (parent, key) = pointer.rsplit_once('/').unwrap();
        file.pointer_mut(parent).unwrap_or_else(|| panic!("{what}: no {parent}"))[key] = value;
        refused(what, file.to_string().into_bytes(), expected);
    }
    let mut parts = square();
    let floats = parts.floats(&[[0.0], [1.0], [2.0]]);
    let file = parts.gltf(drawn(&json!({}), &json!({ "indices": floats })));
    refused("indices of type float", file, &["indices", "float", "expected unsigned"]);
    let outside = parts.indices(&[0, 1, 4]);
    let file = parts.gltf(drawn(&json!({}), &json!({ "indices": outside })));
    refused("a vertex that is not there", file, &["mesh 0, primitive 0", "vertex 4", "there are 4"]);
    for (what, file, expected) in [
        ("nothing", &b""[..], &["expected JSON"][..]),
        ("text", b"solid a", &["\"solid a\"", "expected JSON"]),
        ("half a file", b"{\"asset\":", &["JSON", "line 1"]),
        ("a header", b"glTF\x02\0", &["6 bytes"]),
        ("binary version 1", b"glTF\x01\0\0\0\x0c\0\0\0", &["version 1"]),
        ("no chunk", b"glTF\x02\0\0\0\x0c\0\0\0", &["without a JSON chunk"]),
        ("a chunk that is cut", b"glTF\x02\0\0\0\x20\0\0\0\xff\0\0\0JSON{}", &["chunk of 255 bytes", "byte 20"]),
    ] {
        refused(what, file.to_vec(), expected);
    }
}
