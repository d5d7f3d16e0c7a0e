//! The study of scattering precomputed for meshes, at the size of a stamp.

use subsurf_scene::knot;
use subsurf_tests::meshes::write_obj;

use crate::common::{assert_refused, files, run, succeed};

/// Rows of a CSV file with their titles' numbers after a name, which may have commas.
fn numbers(csv: &str, name: &str) -> Vec<f64> {
    let row = csv.lines().find(|row| row.contains(name)).unwrap_or_else(|| panic!("{name}: {csv}"));
    let (_, rest) = row.split_once(name).unwrap();
    rest.trim_start_matches(['"', ',']).split(',').map(|number| number.parse().unwrap()).collect()
}

#[test]
fn a_study_of_meshes_is_one_page_too() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write_obj(&folder.join("small.obj"), &knot(10.0, 3.0, 10));

    let command = "meshes small.obj --extent 20 --lights 26 -o out";
    let told = succeed(folder, command).out;
    assert!(told.contains("small, ") && told.contains("dB"), "{told}");
    assert_eq!(files(&folder.join("out")), ["lights.csv", "meshes.csv", "meshes.html", "records"]);
    let page = std::fs::read_to_string(folder.join("out/meshes.html")).unwrap();
    for section in ["Figure 5", "Table I", "error by reference points", "one PCA, 8 components", "Buddha"] {
        assert!(page.contains(section), "{section}");
    }
    for outside in ["http:", "https:", "url(", "src=\"/", "src=\"."] {
        assert!(!page.contains(outside), "the page needs {outside}");
    }

    let lights = std::fs::read_to_string(folder.join("out/lights.csv")).unwrap();
    for count in [13, 26, 52] {
        let [.., four, _, radial] = numbers(&lights, &format!(",{count},"))[..] else { panic!("{lights}") };
        assert!(radial < 0.9 * four, "{count} lights: {lights}");
    }
    let csv = std::fs::read_to_string(folder.join("out/meshes.csv")).unwrap();
    let of = |name: &str| {
        let [bytes, worst, all, ..] = numbers(&csv, name)[..] else { panic!("{csv}") };
        assert!(all > 0.0 && worst >= all && worst < 0.5, "{csv}");
        [bytes, worst]
    };
    let [bytes, worst] = of("4 clusters, 8 components, 40 bits");
    let harmonics = of("spherical harmonics, n = 3");
    assert!(bytes < harmonics[0] && worst < harmonics[1], "{csv}");
    assert!(of("a byte for each light (Lloyd)")[1] < 0.1 * worst, "{csv}");
    assert_eq!(csv.matches(" functions").count(), 8, "{csv}");

    // What was measured is kept.
    std::fs::write(folder.join("out/records/small.json"), {
        let record = std::fs::read_to_string(folder.join("out/records/small.json")).unwrap();
        let mut record: serde_json::Value = serde_json::from_str(&record).unwrap();
        record["lloyd_snr_db"] = 12.5.into();
        record.to_string()
    })
    .unwrap();
    assert!(succeed(folder, command).out.contains("12.5 dB"), "the kept record is shown");

    assert_refused(&run(folder, "meshes small.obj small.obj --extent 20 --lights 26 -o out"), &["called small"]);
    assert_refused(&run(folder, "meshes none.ply -o out"), &["none.ply"]);
    assert_refused(&run(folder, "meshes knot --lights 4 -o out"), &["--lights", "16"]);
    assert_refused(&run(folder, "meshes knot --material cheese -o out"), &["cheese", "marble"]);
}
