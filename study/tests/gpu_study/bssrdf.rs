//! The study of translucent materials, at the size of a stamp.

use crate::common::{assert_refused, files, run, succeed};

#[test]
fn a_study_is_one_page_and_goes_on_where_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let command = "bssrdf out --size 12x9 --window 5 --materials jade --paper 1";
    let first = succeed(folder, command);
    assert!(first.out.contains("simulating jade") && !first.out.contains("kept"), "{}", first.out);
    assert_eq!(files(&folder.join("out")), ["captures", "fits", "pictures", "study.csv", "study.html"]);

    let page = std::fs::read_to_string(folder.join("out/study.html")).unwrap();
    for section in ["table 2", "table 5", "table 6", "figure 4", "figures 5 and 9", "figure 10", "16 bits per pixel"] {
        assert!(page.contains(section), "{section}");
    }
    for outside in ["http:", "https:", "src=", "url("] {
        assert!(!page.contains(outside), "the page needs {outside}");
    }
    // The paper's jade: its K = 2 in table 2 and table 5.
    for number in ["433 kB", "22 m 56 s", "0.0753", "20.9"] {
        assert!(page.contains(&format!("<span class=\"other\">{number}</span>")), "published: {number}");
    }

    let csv = std::fs::read_to_string(folder.join("out/study.csv")).unwrap();
    let columns = csv.lines().next().unwrap().split(',').count();
    assert!(csv.lines().all(|line| line.split(',').count() == columns), "{csv}");
    assert_eq!(csv.lines().count(), 1 + 2 * 13, "with and without noise:\n{csv}");

    let second = succeed(folder, command);
    assert_eq!(second.out.matches("kept").count(), 2 * 13, "{}", second.out);
    let other =
        succeed(folder, "bssrdf out --size 12x9 --window 5 --materials jade --paper 1 --photons 1e5 --clean-only");
    assert_eq!(other.out.matches("kept").count(), 13, "fits without noise are the same: {}", other.out);
    assert_refused(&run(folder, "bssrdf out --size 12x9 --window 4"), &["--window", "odd"]);
    assert_refused(&run(folder, "bssrdf out --photons 0"), &["--noise", "positive"]);
    let rival = succeed(folder, "linsss out --materials jade --gaussians 2");
    assert!(
        rival.out.contains("| jade | 2-BMPP, L = ") && rival.out.contains("LinSSS, 2 Gaussians | 5.25 kB"),
        "{}",
        rival.out
    );
    let again = succeed(folder, "linsss out --materials jade --gaussians 2");
    assert_eq!((rival.out, again.err.contains("fitted")), (again.out, false), "the fit is kept");
    let larger = succeed(folder, "bssrdf out --size 13x9 --window 5 --materials jade --no-paper --clean-only");
    assert!(!larger.out.contains("kept"), "another patch, other fits: {}", larger.out);
}
