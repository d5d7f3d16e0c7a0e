//! Pictures of translucent materials, on all there is to draw with.

use crate::common::{assert_refused, command, finish, json, run, simulate, succeed};

/// A driver that does not draw to half floats: the techniques that can do without draw the same, the other says why not.
#[test]
fn draws_without_half_floats_to_draw_to() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    simulate(folder, "a");
    succeed(folder, "encode a.npy -M 4");
    let draw = |technique: &str, output: &str, has_halves: bool| {
        let args = format!(
            "render a.subsurf --mesh torus --extent 8 --size 60x50 --exposure 1 --backend gl --technique {technique} -o {output}"
        );
        let mut command = command(folder);
        if !has_halves {
            command.env("MESA_EXTENSION_OVERRIDE", "-GL_EXT_color_buffer_half_float -GL_EXT_color_buffer_float");
        }
        finish(command.args(args.split_whitespace()))
    };
    for technique in ["gather", "separable"] {
        for (output, has_halves) in [("halves.png", true), ("packed.png", false)] {
            let run = draw(technique, output, has_halves);
            assert_eq!(run.code, 0, "{technique}: {}", run.err);
        }
        let [a, b] = ["halves.png", "packed.png"].map(|file| image::open(folder.join(file)).unwrap().into_rgb8());
        let worst = a.iter().zip(b.iter()).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(worst <= Some(2), "{technique}: {worst:?} of 255");
    }
    let run = draw("splat", "splat.png", false);
    assert!(run.code != 0 && run.err.contains("GL_EXT_color_buffer_half_float"), "{} {}", run.code, run.err);
}

#[test]
fn draws_on_everything_there_is() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    simulate(folder, "a");
    succeed(folder, "encode a.npy -M 4");
    // A tetrahedron without normals or texture coordinates.
    std::fs::write(folder.join("t.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
        .unwrap();
    std::fs::write(
        folder.join("t.ply"),
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float s\n\
         property float t\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n",
    )
    .unwrap();

    for backend in ["vulkan", "gl", "cpu"] {
        let flat =
            json(folder, &format!("render a.subsurf --light line --size 90x90 --backend {backend} -o f.png --json"));
        assert_eq!(flat["size"], serde_json::json!([90, 70]), "the patch keeps its shape");
        let picture = image::open(folder.join("f.png")).unwrap().into_rgb8();
        assert_eq!(picture.dimensions(), (90, 70));
        assert!(picture.get_pixel(45, 35)[0] > 100, "{backend}: lit in the middle");

        for mesh in ["t.obj", "t.ply"] {
            let args = format!(
                "render a.subsurf --mesh {mesh} --extent 4 --light 0,0,1 --view 0,0 --size 60x50 --backend {backend}"
            );
            let report = json(folder, &format!("{args} -o m.png --json"));
            let picture = image::open(folder.join("m.png")).unwrap().into_rgb8();
            assert_eq!(picture.dimensions(), (60, 50));
            let lit = picture.pixels().filter(|pixel| pixel[0] > 100).count();
            assert!(lit > 100, "{backend}, {mesh}: {lit} lit pixels, {report}");
        }
    }
    assert_refused(
        &run(folder, "render a.subsurf --mesh t.obj --mapping uv -o x.png"),
        &["no texture coordinates", "unwrap"],
    );
    assert_refused(&run(folder, "render a.subsurf --mesh a.npy -o x.png"), &["a.npy", ".obj"]);
    assert_refused(&run(folder, "render a.subsurf --light 0,0,1 -o x.png"), &["for meshes"]);
    assert_refused(&run(folder, "render a.subsurf --mesh t.obj --light disc -o x.png"), &["direction"]);
    assert_refused(&run(folder, "render a.npy -o x.png"), &["a.npy", "not a .subsurf file"]);
    let mut damaged = std::fs::read(folder.join("a.subsurf")).unwrap();
    damaged[200] ^= 1;
    std::fs::write(folder.join("damaged.subsurf"), damaged).unwrap();
    assert_refused(&run(folder, "render damaged.subsurf -o x.png"), &["damaged.subsurf", "PROF", "CRC-32"]);
    assert!(!folder.join("x.png").exists(), "nothing is drawn");
}

/// A mesh stands on the ground of its set; techniques stand side by side at one exposure.
#[test]
fn sets_have_ground_and_techniques_stand_side_by_side() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    simulate(folder, "a");
    succeed(folder, "encode a.npy -M 4");
    // A tetrahedron that stands on a corner.
    std::fs::write(folder.join("t.obj"), "v 0 0 0\nv 1 1 0\nv -1 1 0\nv 0 1 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
        .unwrap();
    let command = "render a.subsurf --mesh t.obj --extent 6 --size 60x50 --backend vulkan --json";
    let report = json(folder, &format!("{command} --scene hero --technique separable,opaque -o both.png"));
    let alone = json(folder, &format!("{command} --technique separable -o alone.png"));
    assert!(report["triangles"].as_u64() > alone["triangles"].as_u64(), "a mesh with its ground: {report}");
    let both = image::open(folder.join("both.png")).unwrap().into_rgb8();
    assert_eq!(both.dimensions(), (2 * 60 + 3 * 6, 50 + 2 * 6), "two pictures with a border");
    // Below the mesh, in the middle of each picture.
    for left in [6, 72] {
        let ground = both.get_pixel(left + 30, 6 + 46).0;
        assert!(ground.iter().any(|value| value.abs_diff(46) > 4), "{ground:?} is the background");
    }
    let differ = (0..60).filter(|x| both.get_pixel(6 + x, 31) != both.get_pixel(72 + x, 31)).count();
    assert!(differ > 5, "{differ} pixels of a row differ: one of them scatters no light");
    assert_refused(&run(folder, "render a.subsurf --roughness 0.1 -o x.png"), &["--mesh", "--scene"]);
}

#[test]
fn without_a_driver_the_exit_code_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    simulate(folder, "a");
    succeed(folder, "encode a.npy -M 4");
    let mut no_vulkan = command(folder);
    no_vulkan.env("VK_DRIVER_FILES", "/nowhere").env("VK_ICD_FILENAMES", "/nowhere");
    let refused = finish(no_vulkan.args(["render", "a.subsurf", "--backend", "vulkan", "-o", "x.png"]));
    assert_eq!(refused.code, 3, "{}", refused.err);
    assert!(refused.err.contains("no Vulkan device"), "{}", refused.err);
}

/// A kernel says what it is, and is drawn by its own technique alone, the same on both APIs.
#[test]
fn kernels_are_told_and_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    std::fs::write(folder.join("skin.subsurf"), subsurf_tests::kernels::skin(17).to_bytes().unwrap()).unwrap();
    let info = json(folder, "info skin.subsurf --json");
    assert_eq!((&info["method"], &info["terms"], &info["taps"]), (&"two-gaussians".into(), &1.into(), &17.into()));
    assert!(succeed(folder, "info skin.subsurf").out.contains("reflectance 0.800, 0.600, 0.500"));
    let pictures = ["vulkan", "gl"].map(|backend| {
        let output = format!("{backend}.png");
        let args = format!(
            "render skin.subsurf --mesh torus --extent 20 --size 60x50 --exposure 1 --backend {backend} -o {output}"
        );
        succeed(folder, &args);
        image::open(folder.join(output)).unwrap().into_rgb8()
    });
    let far = pictures[0].iter().zip(pictures[1].iter()).filter(|(a, b)| a.abs_diff(**b) > 2).count();
    assert!(far * 100 <= pictures[0].len(), "{far} values differ");
    let brightest = pictures[0].pixels().map(|pixel| pixel.0).max_by_key(|[red, ..]| *red).unwrap();
    assert!(brightest[0] > brightest[2], "skin is red: {brightest:?}");

    assert_refused(&run(folder, "render skin.subsurf --technique gather -o a.png"), &["--technique kernel"]);
    simulate(folder, "a");
    succeed(folder, "encode a.npy -M 4");
    assert_refused(&run(folder, "render a.subsurf --technique kernel -o a.png"), &["kernel files"]);
}
