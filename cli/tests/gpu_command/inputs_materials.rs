//! BTFs and BRDFs of others, as the command takes them: what it says, and with which exit code.

use std::path::Path;

use crate::common::{assert_refused, json, run, succeed};

/// Writes images of two lights and two views.
fn images(folder: &Path) {
    std::fs::create_dir(folder).unwrap();
    for (light, view) in [(0, 0), (0, 60), (30, 0), (30, 60)] {
        let value = u8::try_from(200 - 2 * light - view).unwrap();
        let image = image::RgbImage::from_fn(8, 8, |x, y| image::Rgb([value, u8::try_from(20 * x + y).unwrap(), 9]));
        image.save(folder.join(format!("tl{light:03} pl000 tv{view:03} pv000.png"))).unwrap();
    }
}

#[test]
fn one_image_is_refused_by_every_method() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    images(&folder.join("one"));
    for name in ["tl000 pl000 tv060 pv000", "tl030 pl000 tv000 pv000", "tl030 pl000 tv060 pv000"] {
        std::fs::remove_file(folder.join("one").join(name).with_extension("png")).unwrap();
    }
    for method in ["nested", "factored", "havran2010"] {
        assert_refused(&run(folder, &format!("encode btf one --method {method}")), &["one: 1 image", "two or more"]);
    }
}

#[test]
fn info_reads_all_of_what_others_made() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    images(&folder.join("btf"));
    let broken = folder.join("btf/tl030 pl000 tv060 pv000.png");
    std::fs::copy(&broken, folder.join("btf/tl095 pl000 tv060 pv000.png")).unwrap();
    let told = succeed(folder, "info btf");
    assert!(told.out.contains("2 lights × 2 views, 8 × 8 pixels, 8-bit sRGB"), "{}", told.out);
    let warning = "btf: 1 images are left out, as θ is not from 0° to 90°";
    assert!(told.err.contains(warning) && told.err.lines().count() == 1, "{}", told.err);
    let whole = std::fs::read(&broken).unwrap();
    std::fs::write(&broken, &whole[..whole.len() - 20]).unwrap();
    assert_refused(&run(folder, "info btf"), &["tl030 pl000 tv060 pv000.png"]);

    let mut file: Vec<u8> = [90_i32, 90, 180].iter().flat_map(|count| count.to_le_bytes()).collect();
    file.extend((-1.0_f64).to_le_bytes().repeat(3 * 90 * 90 * 180));
    std::fs::write(folder.join("nothing.binary"), file).unwrap();
    let told = succeed(folder, "info nothing.binary");
    assert!(told.out.contains("isotropic BRDF of MERL") && told.err.contains("no sample was measured"), "{}", told.err);
    assert_eq!(json(folder, "info nothing.binary --json")["views"], 18);
    for (name, expected) in [("a.btf", "no signature of a BTF"), ("a.binary", "bytes"), ("a.bsdf", "no signature")] {
        std::fs::write(folder.join(name), "not one").unwrap();
        assert_refused(&run(folder, &format!("info {name}")), &[name, expected]);
        assert_refused(&run(folder, &format!("encode btf {name}")), &[name, expected]);
    }
}
