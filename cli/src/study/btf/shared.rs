//! Several materials in one file, at the quality they have apart.

use std::path::Path;

use serde::{Deserialize, Serialize};
use subsurf_encoder::btf::nested::Sizes;
use subsurf_encoder::btf::rate::judge;
use subsurf_encoder::btf::{Images, Survey};
use subsurf_encoder::simulate::btf::Sample;
use subsurf_encoder::write_bytes;

use super::SEED;
use crate::encode::btf::{Common, MethodArg, detail, grid, usual_nodes};
use crate::progress::Bars;
use crate::say::say;

/// What sharing saves.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub(super) struct Shared {
    request: String,
    /// Sum of the files apart, and their mean structural similarity over a sample of pairs.
    pub(super) apart: (u64, f64),
    /// The shared file, likewise.
    pub(super) together: (u64, f64),
    /// Entries of P4 in it.
    pub(super) p4: usize,
}

/// Entries of P4 of a file for one material.
const APART: usize = 512;
/// Entries of P4 that are tried, in percent of what the files have apart.
const SHARES: [usize; 6] = [30, 40, 50, 60, 75, 90];

/// The smallest shared file whose mean structural similarity is not below that of files apart, over a sample of pairs.
pub(super) fn shared(
    folder: &Path,
    samples: &[Sample],
    side: u32,
    load: impl Fn(Sample) -> anyhow::Result<Images>,
) -> anyhow::Result<Shared> {
    let names: Vec<String> = samples.iter().map(|sample| sample.name().to_owned()).collect();
    let request = format!("{} {} {:?}", env!("CARGO_PKG_VERSION"), names.join(" "), [side; 2]);
    let path = folder.join("files").join("shared.json");
    let kept = std::fs::read(&path).ok().and_then(|bytes| serde_json::from_slice::<Shared>(&bytes).ok());
    if let Some(kept) = kept.filter(|kept| kept.request == request) {
        return Ok(kept);
    }
    let images = samples.iter().map(|sample| load(*sample)).collect::<anyhow::Result<Vec<_>>>()?;
    let mut apart = (0, 0.0);
    for (name, images) in names.iter().zip(&images) {
        let bytes = std::fs::read(folder.join("files").join(format!("{name}-{side}-nested.subsurf")))?;
        apart.0 += bytes.len() as u64;
        let images = std::slice::from_ref(images);
        apart.1 += judge(images, &bytes, &Bars::new())?.mean_mssim() / names.len() as f64;
    }
    let survey = Survey::new(&images, detail(images.len()), SEED, &Bars::new())?;
    let grid = grid(&images[0], &usual_nodes(MethodArg::Nested, &images[0]))?;
    let prepared = Common { grid, names, has_mipmaps: false, seed: SEED }.nested(&images, &survey);
    let mut found = None;
    for share in SHARES {
        let p4 = share * APART * samples.len() / 100;
        let bytes = prepared.encode(&Sizes::stages(p4, 1), &Bars::new())?.to_bytes();
        let together = (bytes.len() as u64, judge(&images, &bytes, &Bars::new())?.mean_mssim());
        say!(
            "  shared, P4 = {p4}: {} bytes, MSSIM {:.4}; apart {} bytes, {:.4}",
            together.0,
            together.1,
            apart.0,
            apart.1
        );
        write_bytes(&folder.join("files").join("shared.subsurf"), &bytes)?;
        found = Some(Shared { request: request.clone(), apart, together, p4 });
        if together.1 >= apart.1 {
            break;
        }
    }
    let found = found.ok_or_else(|| crate::failure::bad_request("no shared file was tried"))?;
    write_bytes(&path, format!("{:#}\n", serde_json::to_value(&found)?).as_bytes())?;
    Ok(found)
}
