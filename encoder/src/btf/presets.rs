//! What BTF files usually are: numbers that were found on simulated materials of 128 × 128 texels, unless said otherwise.

use glam::Vec3;
use subsurf_decoder::btf::Grid;

use crate::btf::nested::{ChromaSizes, Extent};
use crate::btf::size::{Method, Size};
use crate::btf::truncated_svd::Ranks;
use crate::capture::Images;
use crate::error::{Error, Result};
use crate::rate::Target;

/// Weight of errors of chroma beside those of luma, in factors.
pub const CHROMA_WEIGHT: f32 = 1.5;
/// Bytes of images to a byte of factors.
pub const USUAL_RATIO: u64 = 1000;
/// Bytes of factors, at least: what their angular side takes where few texels share it.
pub const LEAST_FACTORED_BYTES: u64 = 150_000;
/// Bytes of images to a byte of factors, along the ladder of a search.
const RATIOS: [u64; 8] = [4000, 2800, 2000, 1400, 1000, 700, 500, 350];
/// Factors of the usual thresholds of pruning, along the ladder of a search.
const LOOSENESS: [f32; 8] = [4.0, 2.8, 2.0, 1.4, 1.0, 0.7, 0.5, 0.35];

/// Components of luma and chroma that files of some materials are made from: as many as factors can have, and more than
/// codebooks can hold.
#[must_use]
pub fn ranks(materials: usize) -> Ranks {
    Ranks { luma: 128 + 32 * (materials - 1), chroma: 32 }
}

/// Most entries of the chroma codebooks that some materials share.
#[must_use]
pub fn chroma_sizes(materials: usize) -> ChromaSizes {
    let each = 64 * materials;
    ChromaSizes { i2: each, i1: each, colours: each.min(256), tints: each.min(256) }
}

/// Nodes of α, sin β, θ_v and φ_v: those of Havran et al. 2010 for nested codebooks, more azimuths for factors, and one
/// azimuth but many more of the others where all views lie in one plane, as those of an isotropic BRDF do.
#[must_use]
pub fn nodes(method: Method, images: &Images) -> [u8; 4] {
    let is_isotropic = images.views().iter().all(|view| view.y == 0.0);
    match method {
        _ if is_isotropic => [45, 45, 18, 1],
        Method::Factored => [11, 11, 6, 24],
        Method::Nested | Method::Havran2010 => [11, 11, 6, 16],
    }
}

/// Grid of so many nodes of α, sin β, θ_v and φ_v that reaches as far as what was measured, and no farther.
///
/// # Errors
/// [`Error::Request`] for other than 2 to 64 nodes, or 1 to 64 of φ_v.
pub fn grid(images: &Images, nodes: [u8; 4]) -> Result<Grid> {
    let [n_alpha, n_beta, n_theta, n_phi] = nodes;
    if nodes.iter().any(|nodes| !(1..=64).contains(nodes)) || [n_alpha, n_beta, n_theta].contains(&1) {
        return Err(Error::Request("--nodes are from 2 to 64 each, those of φ_v from 1".to_owned()));
    }
    let lowest = |directions: &[Vec3]| directions.iter().map(|direction| direction.z).fold(1.0, f32::min);
    // A degree at least: a single direction has no reach.
    let light_max = lowest(images.lights()).clamp(0.0, 0.999_8).acos();
    let theta_max = lowest(images.views()).clamp(0.0, 0.999_8).acos();
    Ok(Grid {
        n_alpha,
        n_beta,
        n_theta,
        n_phi,
        alpha_max: light_max,
        sin_beta_max: light_max.sin(),
        theta_max,
        cos_light_min: light_max.cos().clamp(0.0, 0.999),
    })
}

/// Bytes of factors for images of so many bytes.
#[must_use]
pub fn factored_bytes(raw_bytes: u64) -> u64 {
    (raw_bytes / USUAL_RATIO).max(LEAST_FACTORED_BYTES)
}

/// Size of a file for images of so many bytes.
#[must_use]
pub fn size(method: Method, raw_bytes: u64) -> Size {
    match method {
        Method::Nested => Size::Nested(Extent::USUAL),
        Method::Factored => Size::Factored { most_bytes: factored_bytes(raw_bytes) },
        Method::Havran2010 => Size::Havran2010 { looseness: 1.0 },
    }
}

/// Sizes that a search for a target climbs, for images of so many bytes: files grow from one to the next.
#[must_use]
pub fn ladder(method: Method, target: Target, raw_bytes: u64) -> Vec<Size> {
    match (method, target) {
        (Method::Nested, _) => Extent::LADDER.map(Size::Nested).to_vec(),
        // One file of that size; no other can be better.
        (Method::Factored, Target::Bytes(most_bytes)) => vec![Size::Factored { most_bytes }],
        (Method::Factored, Target::Quality(_)) => {
            RATIOS.map(|ratio| Size::Factored { most_bytes: raw_bytes / ratio }).to_vec()
        }
        (Method::Havran2010, _) => LOOSENESS.map(|looseness| Size::Havran2010 { looseness }).to_vec(),
    }
}
