//! PLY, STL and OFF files as all kinds of programs write them.

use super::gltf_file::CORNERS;
use super::{assert_refused, assert_square};

fn square(name: &str, what: &str, bytes: impl AsRef<[u8]>) -> Vec<String> {
    assert_square(what, &[(name, bytes.as_ref().to_vec())])
}

fn header(format: &str, vertex: &str, elements: &str) -> String {
    let vertex: String = vertex.lines().map(|line| format!("property {line}\n")).collect();
    format!("ply\nformat {format} 1.0\nelement vertex 4\n{vertex}{elements}end_header\n")
}

const FLOATS: &str = "float x\nfloat y\nfloat z";
const FACE: &str = "element face 1\nproperty list uchar int vertex_indices\n";

/// Square in text; `more` follows each vertex.
fn ply(vertex: &str, more: &str) -> String {
    let rows: String = CORNERS.iter().map(|[x, y, z]| format!("{x} {y} {z} {more}\n")).collect();
    format!("{}{rows}4 0 1 2 3\n", header("ascii", vertex, FACE))
}

#[test]
fn ply_of_any_types() {
    for kind in
        ["char", "uchar", "short", "ushort", "int", "uint", "float", "double", "int16", "uint8", "float32", "float64"]
    {
        let vertex = format!("{kind} x\n{kind} y\n{kind} z");
        assert_eq!(square("a.ply", kind, ply(&vertex, "")), [""; 0]);
    }
    for list in [
        "list uchar uint vertex_index",
        "list int short vertex_indices",
        "list ushort uchar vertex_index",
        "list uint ushort vertex_indices",
    ] {
        let text = ply(FLOATS, "").replace("list uchar int vertex_indices", list);
        assert_eq!(square("a.ply", list, text), [""; 0]);
    }
    let plain = ply(FLOATS, "");
    for (what, text) in [
        ("a byte-order mark", format!("\u{feff}{plain}")),
        ("lines of DOS", plain.replace('\n', "\r\n")),
        ("comments", plain.replace("element v", "comment \u{e9}\nobj_info num_cols 4\nelement v")),
        ("elements that are not drawn", plain.replace("element f", "element camera 0\nproperty float f\nelement f")),
        ("colours", ply(&format!("{FLOATS}\nuchar red\nuchar green\nuchar blue\nfloat quality"), "255 0 9 nan")),
        ("texture coordinates", ply(&format!("{FLOATS}\nfloat s\nfloat t"), "0 1")),
        ("values over several lines", plain.replace("4 0 1", "4\n0\n1")),
    ] {
        assert_eq!(square("a.ply", what, text), [""; 0], "{what}");
    }
    let latin = [&b"ply\ncomment \xa9 caf\xe9\n"[..], plain.strip_prefix("ply\n").unwrap().as_bytes()].concat();
    square("a.ply", "Latin-1", latin);
}

#[test]
fn ply_in_binary() {
    for (format, float, int) in [
        ("binary_little_endian", f32::to_le_bytes as fn(f32) -> [u8; 4], u32::to_le_bytes as fn(u32) -> [u8; 4]),
        ("binary_big_endian", f32::to_be_bytes, u32::to_be_bytes),
    ] {
        let vertices: Vec<u8> = CORNERS.as_flattened().iter().flat_map(|value| float(*value)).collect();
        let face: Vec<u8> = [4].into_iter().chain([0, 1, 2, 3].into_iter().flat_map(int)).collect();
        let file = [header(format, FLOATS, FACE).into_bytes(), vertices.clone(), face].concat();
        assert_eq!(square("a.ply", format, &file), [""; 0]);
        for (cut, place) in [(1, "\"face\" 0 of 1"), (17, "\"face\" 0 of 1"), (18, "\"vertex\" 3 of 4")] {
            let file = file[..file.len() - cut].to_vec();
            assert_refused(format, &[("a.ply", file)], &["byte ", "the file ends", place]);
        }
        // Strips; -1 ends one.
        let strips = "element tristrips 1\nproperty list int int vertex_indices\n";
        for strip in [&[0, 1, 3, 2][..], &[0, 1, 3, u32::MAX, 3, 1, 2], &[0, 1, 3, 3, 2, 2, u32::MAX, 3, 1, 2]] {
            let list: Vec<u8> =
                [u32::try_from(strip.len()).unwrap()].iter().chain(strip).flat_map(|value| int(*value)).collect();
            let file = [header(format, FLOATS, strips).into_bytes(), vertices.clone(), list].concat();
            assert_eq!(square("a.ply", "strips", &file), [""; 0], "{strip:?}");
        }
    }
}

#[test]
fn ply_normals_that_are_none_are_made_anew() {
    let vertex = format!("{FLOATS}\nfloat nx\nfloat ny\nfloat nz");
    assert_eq!(square("a.ply", "normals", ply(&vertex, "0 0.01 1")), [""; 0]);
    for normal in ["nan nan nan", "0 0 0", "inf 0 0", "-nan(ind) -1.#IND 0"] {
        let warnings = square("a.ply", normal, ply(&vertex, normal));
        assert!(warnings.len() == 1 && warnings[0].contains("4 of 4 normals"), "{normal}: {warnings:?}");
    }
}

#[test]
fn ply_faces_have_texture_coordinates_of_their_own() {
    let text = ply(FLOATS, "").replace("indices\n", "indices\nproperty list uchar float texcoord\n");
    let text = text.replace("4 0 1 2 3", "4 0 1 2 3 8 0 0 1 0 1 1 0 1");
    square("a.ply", "corners", &text);
    let mesh = super::load(&[("a.ply", text.into_bytes())]).unwrap().mesh;
    let uvs = mesh.uvs.expect("texture coordinates");
    for (position, uv) in mesh.positions.iter().zip(uvs) {
        assert!((position.truncate() + 0.5).abs_diff_eq(uv, 1e-6), "{position} has {uv}");
    }
    let long = ply(FLOATS, "").replace("4 0 1 2 3", "4 0 1 2 3 8 0.5 0.5");
    let warnings = square("a.ply", "more than the header says", long);
    assert!(warnings.len() == 1 && warnings[0].contains("1 lines longer"), "{warnings:?}");
}

#[test]
fn ply_errors_carry_line_or_offset() {
    let plain = ply(FLOATS, "");
    for (from, to, parts) in [
        ("float x", "flaot x", &["line 4", "\"flaot\"", "uchar"][..]),
        ("float x", "float", &["line 4", "property TYPE NAME"]),
        ("ascii", "asci", &["line 2", "\"asci\"", "binary_big_endian"]),
        ("vertex 4", "vertex four", &["line 3", "\"four\""]),
        ("float z", "float w", &["without x, y and z", "\"vertex\" 0 of 4"]),
        ("1 1 0", "1 one 0", &["line 12", "\"one\" is not a number", "\"vertex\" 2 of 4"]),
        ("4 0 1 2 3", "4 0 1 2", &["the file ends", "\"face\" 0 of 1"]),
        ("4 0 1 2 3", "-4 0 1 2 3", &["line 14", "length -4"]),
        ("4 0 1 2 3", "4 0 1 2 4", &["vertex 4", "there are 4"]),
        ("4 0 1 2 3", "4 0 1 2 -3", &["line 14", "number -3"]),
        ("vertex_indices", "corners", &["vertex_indices or vertex_index"]),
        ("end_header", "end", &["end_header"]),
        ("ply\n", "plum\n", &["\"ply\""]),
        ("face 1", "face 0", &["4 vertex, 0 face", "tristrips"]),
        ("vertex 4", "vertex 18446744073709551615", &["vertex"]),
    ] {
        assert_refused(to, &[("a.ply", plain.replace(from, to).into_bytes())], parts);
    }
}

fn stl_text(keyword: fn(&str) -> String) -> String {
    let facet = |corners: [usize; 3]| {
        let vertices: String = corners
            .iter()
            .map(|&k| format!("vertex {} {} {}\n", CORNERS[k][0], CORNERS[k][1], CORNERS[k][2]))
            .collect();
        format!("facet normal 0 0 0\n outer loop\n{vertices} endloop\nendfacet\n")
    };
    keyword(&format!("solid vertex 1 caf\u{e9}\n{}{}endsolid vertex 1\n", facet([0, 1, 2]), facet([0, 2, 3])))
}

/// Square in binary, after a header of 80 bytes that begins with `word`.
fn stl_binary(word: &str) -> Vec<u8> {
    let mut file = format!("{word:80}").into_bytes();
    file.extend(2_u32.to_le_bytes());
    for corners in [[0, 1, 2], [0, 2, 3]] {
        let numbers = [[0.0, 0.0, 1.0], CORNERS[corners[0]], CORNERS[corners[1]], CORNERS[corners[2]]];
        file.extend(numbers.as_flattened().iter().flat_map(|value| value.to_le_bytes()));
        file.extend([0xff, 0xff]);
    }
    file
}

#[test]
fn stl_in_text_and_binary() {
    let text = stl_text(str::to_owned);
    let latin = text.chars().map(|letter| u8::try_from(u32::from(letter)).unwrap()).collect::<Vec<u8>>();
    let more = [stl_binary(""), b"colours".to_vec()].concat();
    for (what, file) in [
        ("text", text.clone().into_bytes()),
        ("Latin-1", latin),
        ("capitals", stl_text(str::to_uppercase).into_bytes()),
        ("a byte-order mark", format!("\u{feff}{text}").into_bytes()),
        ("lines of DOS", text.replace('\n', "\r\n").into_bytes()),
        ("one line a facet", text.replace("\nvertex", " vertex").replace("\n endloop", " endloop").into_bytes()),
        ("two solids", text.replacen("endfacet\n", "endfacet\nendsolid\nsolid b\n", 1).into_bytes()),
        ("binary", stl_binary("made by hand")),
        ("binary that begins as text does", stl_binary("solid square")),
        ("bytes after the last", more),
    ] {
        assert_eq!(square("a.stl", what, &file), [""; 0], "{what}");
        let mesh = super::load(&[("a.stl", file)]).unwrap().mesh;
        assert_eq!((mesh.positions.len(), mesh.triangles.len()), (4, 2), "{what}: corners at one place are one vertex");
    }
    let mut few = [stl_binary(""), stl_binary("")[84..].to_vec()].concat();
    let warnings = square("a.stl", "more facets than the header counts", &few);
    assert!(
        warnings.len() == 1 && warnings[0].contains("2 facets behind those that the header counts"),
        "{warnings:?}"
    );
    few[80..84].fill(0);
    assert_refused("no facets in the header", &[("a.stl", few)], &["no triangles; 4 facets behind"]);
    let cut = stl_binary("")[..150].to_vec();
    for (what, file, parts) in [
        ("cut", cut, &["2 triangles of 50 bytes", "66 bytes"][..]),
        ("short", b"stl".to_vec(), &["3 bytes", "84"]),
        ("a word", text.replace("vertex 1 1 0", "vertex 1 one 0").into_bytes(), &["line 6", "\"one\""]),
        ("few", text.replace("vertex 1 1 0", "vertex 1").into_bytes(), &["line 6", "fewer than three"]),
        ("no loop", text.replace("outer loop", "").into_bytes(), &["line 4", "outer loop"]),
        ("no end", text[..65].into(), &["endloop"]),
        ("no facets", b"solid a\nendsolid a\n".to_vec(), &["no triangles"]),
    ] {
        assert_refused(what, &[("a.stl", file)], parts);
    }
}

#[test]
fn off_with_and_without_more() {
    let off = |key: &str, more: &str| {
        let rows: String = CORNERS.iter().map(|[x, y, z]| format!("{x} {y} {z} {more}\n")).collect();
        format!("{key}4 1 4\n{rows}4 0 1 2 3\n")
    };
    for (what, text) in [
        ("plain", off("OFF\n", "")),
        ("counts on the first line", off("OFF ", "")),
        ("no keyword", off("", "")),
        ("a byte-order mark", off("\u{feff}OFF\n", "")),
        ("comments and empty lines", off("# a\n\nOFF # b\n\n# c\n", "# d\n")),
        ("lines of DOS", off("OFF\n", "").replace('\n', "\r\n")),
        ("faces that go on", off("OFF\n", "").replace("4 0 1 2 3\n", "4 0\n1 \n2 3 \n\n")),
        ("colours", off("COFF\n", "255 0 0 255").replace("0 1 2 3\n", "0 1 2 3 0.5 0.5 0.5\n")),
        ("colours without a letter", off("OFF\n", "0.1 0.2 0.3")),
        ("normals", off("NOFF\n", "0 0 1")),
        ("texture coordinates", off("STOFF\n", "0 1")),
        ("all", off("STCNOFF\n", "0 0 1 9 9 9 255 0 1")),
        ("four coordinates", off("4OFF\n", "1")),
    ] {
        assert_eq!(square("a.off", what, text), [""; 0], "{what}");
    }
    let warnings = square("a.off", "zero normals", off("NOFF\n", "0 0 0"));
    assert!(warnings.len() == 1 && warnings[0].contains("4 of 4 normals"), "{warnings:?}");
    let plain = off("OFF\n", "");
    for (from, to, parts) in [
        ("OFF\n", "OFF BINARY\n", &["binary OFF"][..]),
        ("OFF\n", "nOFF\n5\n", &["line 1", "\"nOFF\"", "three dimensions"]),
        ("OFF\n4 1 4", "OFF\nfour 1 4", &["line 2", "\"four\""]),
        ("4 1 4", "4", &["line 2", "vertices, faces and edges"]),
        ("1 1 0", "1 1", &["line 5", "too few"]),
        ("1 1 0", "1 one 0", &["line 5", "\"one\""]),
        ("4 0 1 2 3", "4 0 1 2 4", &["line 7", "vertex \"4\"", "there are 4"]),
        ("4 0 1 2 3", "5 0 1 2 3", &["line 7", "5 corners", "names 4"]),
        ("4 0 1 2 3\n", "", &["ends after face 0 of 1"]),
        // The face is taken for a vertex, then the file ends.
        ("4 1 4", "99999999999 1 4", &["ends after vertex 5 of 99999999999"]),
    ] {
        assert_refused(to, &[("a.off", plain.replacen(from, to, 1).into_bytes())], parts);
    }
}
