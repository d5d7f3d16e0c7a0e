//! OBJ files as all kinds of programs write them.

use super::{assert_refused, assert_square, load};

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
const CORNERS: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

fn square(what: &str, text: impl AsRef<[u8]>) -> Vec<String> {
    assert_square(what, &[("square.obj", text.as_ref().to_vec())])
}

fn refused(what: &str, text: &str, parts: &[&str]) {
    assert_refused(what, &[("broken.obj", text.as_bytes().to_vec())], parts);
}

/// The same text in UTF-16, with its byte-order mark.
fn utf_16(text: &str, bytes: fn(u16) -> [u8; 2]) -> Vec<u8> {
    std::iter::once(0xfeff).chain(text.encode_utf16()).flat_map(bytes).collect()
}

#[test]
fn encodings_and_lines_of_any_system() {
    let last = SQUARE.replace("f 1 2 3 4\n", "");
    for (what, text) in [
        ("plain", SQUARE.to_owned()),
        ("a byte-order mark", format!("\u{feff}{SQUARE}")),
        ("a byte-order mark before a comment", format!("\u{feff}# square\n{SQUARE}")),
        ("lines of DOS", SQUARE.replace('\n', "\r\n")),
        ("lines of old Macs", SQUARE.replace('\n', "\r")),
        ("no line end at the end", SQUARE.trim_end().to_owned()),
        ("a line that goes on", format!("{last}f 1 2 \\\n3 4\n")),
        ("lines that go on", format!("{last}f 1 \\\r\n2 \\\r\n3 4\r\n").replace("v 1 1", "v 1 \\\n1")),
        (
            "comments that end as lines that go on",
            format!("# of C:\\meshes\\\n{}", SQUARE.replace('\n', " # in C:\\\n")),
        ),
        ("a line that goes on at the end", format!("{last}f 1 2 3 4 \\")),
        ("tabs and spaces", SQUARE.replace(' ', " \t ")),
    ] {
        assert_eq!(square(what, text), [""; 0], "{what}");
    }
    for bytes in [u16::to_le_bytes, u16::to_be_bytes] {
        square("UTF-16", utf_16(SQUARE, bytes));
    }
    for line in [&b"o caf\xe9\n"[..], b"# \xa9 1998\n", b"mtllib \xff\xfe.mtl\n", b"g \xe4\xf6 \xfc\n"] {
        square("Latin-1", [line, SQUARE.as_bytes()].concat());
    }
}

#[test]
fn comments_after_data_and_numbers_that_are_not_drawn() {
    for (what, text) in [
        ("comments", SQUARE.replace('\n', " # first\n")),
        ("comments without a space", SQUARE.replace('\n', " #first\n")),
        ("colours", SQUARE.replace(" 0\n", " 0 0.5 0.5 0.5\n")),
        ("colours of some", SQUARE.replacen(" 0\n", " 0 0.5 0.5 0.5\n", 2)),
        ("weights", SQUARE.replace(" 0\n", " 0 1.0\n")),
        ("a weight of zero", SQUARE.replace("v 0 0 0\n", "v 0 0 0 0\n")),
        ("from the end", SQUARE.replace("f 1 2 3 4", "f -4 -3 -2 -1")),
        ("numbers with signs and points", SQUARE.replace("v 1 1 0", "v +1. 1e0 -.0")),
        ("unknown lines", format!("cstype bezier\ndeg 3\nshadow_obj a\n{SQUARE}s off\nlod 3\nparm u 0 1\nend\n")),
        ("faces before vertices", format!("f 1 2 3 4\n{CORNERS}")),
        ("groups", format!("g a\n{CORNERS}g b\nf 1 2 3\ng c d\ng\nf 1 3 4\n")),
    ] {
        assert_eq!(square(what, text), [""; 0], "{what}");
    }
}

#[test]
fn materials_are_not_drawn() {
    for (what, before) in [
        ("no name", "usemtl\n"),
        ("an empty name", "usemtl \nusemtl  \t\n"),
        ("an unknown one", "mtllib none.mtl\nusemtl a b c\n"),
        ("no library", "mtllib\nusemtl a\n"),
    ] {
        assert_eq!(square(what, format!("{before}{SQUARE}")), [""; 0], "{what}");
    }
    let text = format!("mtllib square.mtl\nusemtl a\n{SQUARE}");
    for (what, material) in [
        ("one number", &b"newmtl a\nKd 0.8\n"[..]),
        ("no numbers", b"newmtl\nKa\nKd\nNs\nd\nillum\nmap_Kd\n"),
        ("spectra, and bytes of no encoding", b"newmtl \xe9\nKd spectral a.rfl 1\nKs xyz 1 1\nNs \xff\n"),
        ("no material", b""),
    ] {
        let files = [("square.obj", text.clone().into_bytes()), ("square.mtl", material.to_vec())];
        assert_eq!(assert_square(what, &files), [""; 0], "{what}");
    }
}

#[test]
fn normals_that_are_none_are_made_anew() {
    for (what, normal) in [("zero", "0 0 0"), ("not a number", "nan NaN -nan"), ("of Windows", "1.#QNAN 0 -1.#IND")] {
        let text = format!("{CORNERS}vn {normal}\nf 1//1 2//1 3//1 4//1\n");
        let warnings = square(what, text);
        assert!(warnings.len() == 1 && warnings[0].contains("4 of 4 normals"), "{what}: {warnings:?}");
    }
    // Those of the other vertices are kept.
    let text = format!("{CORNERS}vn 0 0.1 1\nvn 0 0 0\nf 1//1 2//1 3//1 4//2\n");
    let warnings = square("one", &text);
    assert!(warnings.len() == 1 && warnings[0].contains("1 of 4 normals"), "{warnings:?}");
    let mesh = load(&[("square.obj", text.into_bytes())]).unwrap().mesh;
    assert_eq!(mesh.normals.iter().filter(|normal| normal.y > 0.05).count(), 3, "{:?}", mesh.normals);
}

#[test]
fn texture_coordinates_and_normals_are_used_if_they_are_there() {
    let faces = "f 1/1/1 2/2/1 3/3/1 4/4/1\n";
    for (what, before, has_uvs) in [
        ("both", "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n", true),
        ("of three numbers, and of one", "vt 0 0 0\nvt 1 0 0\nvt 1\nvt 0 1\nvn 0 0 1\n", true),
        ("named, but not there", "", false),
    ] {
        let text = format!("{CORNERS}{before}{faces}");
        assert_eq!(square(what, &text), [""; 0], "{what}");
        let mesh = load(&[("square.obj", text.into_bytes())]).unwrap().mesh;
        assert_eq!((mesh.uvs.is_some(), mesh.positions.len()), (has_uvs, 4), "{what}");
    }
    let text = format!("{CORNERS}vt 0 0\nvt nan 1\nvt 1 1\nvt 0 1\nf 1/1 2/2 3 4/4\n");
    let warnings = square("some without", &text);
    assert!(warnings.len() == 1 && warnings[0].contains("2 of 4 vertices"), "{warnings:?}");
}

#[test]
fn what_is_left_out_is_counted() {
    for (more, part) in [
        ("l 1 2\nl 1 2 3\np 4\n", "3 lines and points"),
        ("f 1 2\nf\n", "2 faces of fewer"),
        ("curv 0 1 1 2\nsurf 0 1 0 1 1 2 3 4\n", "2 free-form"),
    ] {
        let warnings = square(part, format!("{SQUARE}{more}"));
        assert!(warnings.len() == 1 && warnings[0].contains(part), "{part}: {warnings:?}");
    }
    // Vertices that no face has neither count nor make the mesh small.
    assert_eq!(square("a point far away", format!("{CORNERS}v 9e9 0 0\nv nan nan nan\nf 1 2 3 4\n")), [""; 0]);
}

#[test]
fn maps_far_from_the_origin_keep_their_digits() {
    let far = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[x, y]| format!("{}.25 {}.5 0.125\n", 4_000_000 + x, 500_000 + y));
    let corners = far.concat();
    let obj: String = far.iter().map(|corner| format!("v {corner}")).collect();
    square("OBJ", format!("{obj}f 1 2 3 4\n"));
    let header = "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n\
        element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    assert_square("PLY", &[("far.ply", format!("{header}{corners}4 0 1 2 3\n").into_bytes())]);
    assert_square("OFF", &[("far.off", format!("OFF\n4 1 4\n{corners}4 0 1 2 3\n").into_bytes())]);
}

#[test]
fn errors_carry_the_line() {
    for (text, parts) in [
        ("v 0 0\n", &["line 1", "fewer than three numbers", "v X Y Z"][..]),
        ("\n# a\nv 0 zero 0\n", &["line 3", "\"zero\" is not a number"]),
        ("v 0 0,5 0\n", &["line 1", "\"0,5\" is not a number"]),
        ("v 0 0 0\nvn 1 1\n", &["line 2", "vn X Y Z"]),
        ("v 0 0 0\nvt\n", &["line 2", "vt U V"]),
        (&format!("{CORNERS}f 1 2 9\n"), &["line 5", "vertex 9", "4 lines of v"]),
        (&format!("{CORNERS}f 1 2 \\\n\\\n0\n"), &["line 5", "vertex 0", "counted from 1"]),
        (&format!("{CORNERS}f -1 -2 -5\n"), &["line 5", "vertex -5"]),
        (&format!("{CORNERS}vt 0 0\nf 1/1 2/2 3/1\n"), &["line 6", "texture coordinate 2", "1 lines of vt"]),
        (&format!("{CORNERS}f 1 2 x\n"), &["line 5", "\"x\"", "V//VN"]),
        (&format!("{CORNERS}f 1/1/1/1 2 3\n"), &["line 5", "\"1/1/1/1\""]),
        (&format!("{CORNERS}f 1 2 99999999999999999999\n"), &["line 5", "99999999999999999999"]),
        ("v 0 0 0\nv 1 0 0\nv 1 1e39 0\nf 1 2 3\n", &["vertex 2", "inf"]),
    ] {
        refused(text, text, parts);
    }
}

#[test]
fn meshes_without_area_are_refused() {
    for (what, text, part) in [
        ("a line", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "no area"),
        ("a slanted line", "v 0 0 0\nv 0.1 0.3 0.7\nv 0.3 0.9 2.1\nf 1 2 3\n", "no area"),
        ("the same corner", "v 0 0 0\nv 1 0 0\nf 1 2 2\nf 1 1 2\n", "no area"),
        ("a point", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n", "longest side is 0"),
        ("a size without end", "v -3e38 0 0\nv 3e38 0 0\nv 0 3e38 0\nf 1 2 3\n", "longest side is inf"),
        ("points and lines", "v 0 0 0\nv 1 0 0\nl 1 2\np 1\n", "no triangles; 2 lines and points"),
        ("nothing", "", "no triangles"),
    ] {
        refused(what, text, &[part, "broken.obj"]);
    }
}
