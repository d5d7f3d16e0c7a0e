//! Several materials in one file, at the quality they have apart.

use std::path::Path;

use serde::{Deserialize, Serialize};
use subsurf_cli::outln;
use subsurf_cli::program::failure::bad_request;
use subsurf_cli::program::progress::Bars;
use subsurf_encoder::btf::Method;
use subsurf_encoder::btf::nested::Extent;
use subsurf_encoder::capture::Images;
use subsurf_encoder::metrics::btf::judge;
use subsurf_encoder::simulate::relief::Sample;
use subsurf_encoder::write_bytes;

use super::codec::setup;
use super::svd::{SEED, svd_of};
use crate::cache;

/// A sample, and the seed that it is simulated with.
#[derive(Clone, Copy, Debug)]
pub(super) struct Member {
    pub(super) sample: Sample,
    pub(super) seed: u64,
}

impl Member {
    /// Name of its images and files.
    pub(super) fn name(self) -> String {
        let name = self.sample.name();
        if self.seed == SEED { name.to_owned() } else { format!("{name}-{}", self.seed) }
    }
}

/// Set of materials that may share a file.
pub(super) struct Set {
    /// Name in files.
    pub(super) label: String,
    pub(super) title: String,
    pub(super) members: Vec<Member>,
}

impl Set {
    /// All materials, which have little in common.
    pub(super) fn all(samples: &[Sample]) -> Self {
        let members: Vec<Member> = samples.iter().map(|sample| Member { sample: *sample, seed: SEED }).collect();
        Self { label: "all".to_owned(), title: format!("{} different materials", members.len()), members }
    }

    /// Pieces of one material, no two of which show the same.
    pub(super) fn family(sample: Sample, pieces: u64) -> Self {
        let members = (SEED..SEED + pieces).map(|seed| Member { sample, seed }).collect();
        Self { label: sample.name().to_owned(), title: format!("{pieces} pieces of {}", sample.name()), members }
    }
}

/// Record: what sharing a file saves.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub(super) struct Shared {
    request: String,
    pub(super) title: String,
    /// Sum of the files apart, and their mean structural similarity over a sample of pairs.
    pub(super) apart: (u64, f64),
    /// Bytes and mean structural similarity of the shared file.
    pub(super) together: (u64, f64),
    /// Entries of P4 in the shared file.
    pub(super) p4: usize,
}

/// Entries of P4 that are tried, in percent of what the files have apart.
const SHARES: [usize; 7] = [25, 30, 40, 50, 60, 75, 90];

/// The smallest shared file that bisection finds whose mean structural similarity is not below that of files apart, over a sample of pairs.
pub(super) fn shared(
    folder: &Path,
    set: &Set,
    side: u32,
    load: impl Fn(Member) -> anyhow::Result<Images>,
) -> anyhow::Result<Shared> {
    let names: Vec<String> = set.members.iter().map(|member| member.name()).collect();
    let request = format!("{} {} {:?}", env!("CARGO_PKG_VERSION"), names.join(" "), [side; 2]);
    let files = folder.join("files");
    let path = files.join(format!("shared-{}-{side}.json", set.label));
    if let Some(cached) = cache::read::<Shared>(&path).filter(|cached| cached.request == request) {
        return Ok(cached);
    }
    let images = set.members.iter().map(|member| load(*member)).collect::<anyhow::Result<Vec<_>>>()?;
    let mut apart = (0, 0.0);
    for (name, images) in names.iter().zip(&images) {
        let images = std::slice::from_ref(images);
        let path = files.join(format!("{name}-{side}-nested.subsurf"));
        let bytes = match std::fs::read(&path) {
            Ok(bytes) => bytes,
            Err(_) => {
                let (setup, svd) = (setup(Method::Nested, std::slice::from_ref(name), images)?, svd_of(images)?);
                setup.nested(images, &svd).encode(&Extent::USUAL.sizes(), &Bars::new())?.to_bytes()
            }
        };
        apart.0 += bytes.len() as u64;
        apart.1 += quality(images, &bytes)? / names.len() as f64;
    }
    let svd = svd_of(&images)?;
    let prepared = setup(Method::Nested, &names, &images)?.nested(&images, &svd);
    let of_share = |share: usize| {
        let p4 = share * Extent::USUAL.p4 * names.len() / 100;
        let bytes = prepared.encode(&Extent { p4, ..Extent::USUAL }.sizes(), &Bars::new())?.to_bytes();
        let together = (bytes.len() as u64, quality(&images, &bytes)?);
        outln!(
            "  {}, shared, P4 = {p4}: {} bytes, MSSIM {:.4}; apart {} bytes, {:.4}",
            set.title,
            together.0,
            together.1,
            apart.0,
            apart.1
        );
        anyhow::Ok((bytes, Shared { request: request.clone(), title: set.title.clone(), apart, together, p4 }))
    };
    // Quality is taken to rise with P4, so that three of the seven are tried; the largest is kept where none is good enough.
    let (mut found, mut first, mut end) = (None, 0, SHARES.len());
    while first < end {
        let middle = usize::midpoint(first, end);
        let (bytes, tried) = of_share(SHARES[middle])?;
        let is_enough = tried.together.1 >= apart.1;
        if is_enough || middle + 1 == SHARES.len() {
            found = Some((bytes, tried));
        }
        if is_enough {
            end = middle;
        } else {
            first = middle + 1;
        }
    }
    let (bytes, found) = found.ok_or_else(|| bad_request("no shared file was tried"))?;
    write_bytes(&files.join(format!("shared-{}-{side}.subsurf", set.label)), &bytes)?;
    cache::write(&path, &found)?;
    Ok(found)
}

/// Mean structural similarity; images of a study are large enough for it.
fn quality(images: &[Images], bytes: &[u8]) -> anyhow::Result<f64> {
    Ok(judge(images, bytes, &Bars::new())?.mean_mssim().unwrap_or(0.0))
}
