//! Plan: the fits of every capture.

use subsurf_decoder::bssrdf::Coding;
use subsurf_encoder::bssrdf::{Method, Options};

/// Base materials throughout, as in the paper.
pub(super) const BASE_MATERIALS: usize = 128;

/// Fit that every capture goes through.
#[derive(Clone, Debug)]
pub(super) struct Fit {
    /// Name in files and tables.
    pub(super) label: String,
    /// Name for people.
    pub(super) title: String,
    pub(super) options: Options,
    /// Whether M is whatever fits into the bytes of K = 2, M = 128.
    pub(super) equal_bytes: bool,
}

fn fit(label: &str, title: &str, options: Options) -> Fit {
    Fit { label: label.to_owned(), title: title.to_owned(), options, equal_bytes: false }
}

/// All fits: ours and the baselines first, those of the paper's own method, which take long, last.
pub(super) fn fits(papers: &[String], seed: u64) -> Vec<Fit> {
    let direct = Options { base_materials: BASE_MATERIALS, seed, ..Options::default() };
    let k = |per_pixel| Options { per_pixel, ..direct };
    let with_m = |base_materials| Options { base_materials, ..direct };
    let equal = |fit: Fit| Fit { equal_bytes: true, ..fit };
    let mut fits = vec![
        fit("song", "Song et al.", Options { method: Method::Song2009, ..direct }),
        fit("k1", "K = 1", k(1)),
        fit("k2", "K = 2", direct),
        fit("k3", "K = 3", k(3)),
        fit("k5", "K = 5", k(5)),
        equal(fit("clusters-equal", "LSP clusters", Options { method: Method::Clusters, ..direct })),
        equal(fit("k1-equal", "K = 1, equal bytes", k(1))),
        fit("k2-small", "K = 2, 24 bits", Options { coding: Coding::SmallRatios, ..direct }),
        fit("k2-palette", "K = 2, 16 bits", Options { coding: Coding::Palette, ..direct }),
        fit("k2-half", "K = 2, f16 profiles", Options { half_profiles: true, ..direct }),
        fit("k2-m8", "K = 2, M = 8", with_m(8)),
        fit("k2-m32", "K = 2, M = 32", with_m(32)),
    ];
    for k in ["1", "2", "3", "5"].iter().filter(|k| papers.iter().any(|paper| paper == *k)) {
        let per_pixel = k.parse().expect("a digit");
        let options = Options { method: Method::Yatagawa2020, per_pixel, ..direct };
        fits.push(fit(&format!("paper-k{k}"), &format!("K = {k}, paper's fit"), options));
    }
    fits
}
