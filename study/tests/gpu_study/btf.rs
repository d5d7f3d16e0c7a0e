//! The study of BTFs, at the size of a stamp.

use crate::common::{assert_refused, files, run, succeed};

#[test]
fn a_study_of_btfs_is_one_page_too() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let command = "btf out --size 16 --every 400 --materials leather,foil --pieces 1";
    let first = succeed(folder, command);
    assert!(first.out.contains("simulating leather") && first.out.contains("shared, P4"), "{}", first.out);
    assert_eq!(files(&folder.join("out")), ["btf.csv", "btf.html", "files", "images", "pictures"]);
    let page = std::fs::read_to_string(folder.join("out/btf.html")).unwrap();
    for section in ["table 2", "table 3", "C.R.", "simulated", "1:1244", "Evaluations in a second"] {
        assert!(page.contains(section), "{section}");
    }
    for outside in ["http:", "https:", "url(", "src=\"/", "src=\"."] {
        assert!(!page.contains(outside), "the page needs {outside}");
    }
    let csv = std::fs::read_to_string(folder.join("out/btf.csv")).unwrap();
    let columns = csv.lines().next().unwrap().split(',').count();
    assert!(csv.lines().all(|line| line.split(',').count() == columns), "{csv}");
    for codec in ["nested", "paper", "factored"] {
        assert_eq!(csv.matches(&format!(",{codec},")).count(), 2, "{csv}");
    }
    // Images and files are kept.
    let second = succeed(folder, command);
    assert!(!second.out.contains("simulating") && !second.out.contains("shared, P4"), "{}", second.out);
    assert_eq!(std::fs::read_to_string(folder.join("out/btf.csv")).unwrap(), csv);
    assert_refused(&run(folder, "btf out --size 4"), &["--size", "16"]);
}
