//! Profiles of base materials of BSSRDF files.

use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::BssrdfModel;

use super::{Profile, points};
use crate::error::{Error, Result};

/// Profile of the base material of that number: R_d(r) = exp P̂_b(r), what light does that enters and leaves there (Yatagawa et al.
/// 2020, eq. 2).
///
/// # Errors
///
/// [`Error::Request`] for a file without base materials, or with fewer.
pub fn of_base(file: &Bssrdf<'_>, number: u16) -> Result<Profile> {
    let header = file.header();
    let BssrdfModel::BaseMaterials(planes) = *file.model() else {
        return Err(Error::Request(
            "a file of a profile for every pixel has no base materials: encode the capture by 2-bmpp".into(),
        ));
    };
    let count = header.base_materials;
    if u32::from(number) >= count {
        return Err(Error::Request(format!("there is no base material {number}: the file has {count}, from 0")));
    }
    let [samples, start] = [usize::from(header.samples), usize::from(number)];
    let node = |h: usize| planes.profiles.rgb_at((start * samples + h) * 3).map(|p| f64::from(p).exp());
    #[allow(clippy::cast_precision_loss, reason = "nodes are at most 4,096")]
    let r_mm = |h: usize| h as f64 * f64::from(header.r_max_mm) / (samples - 1) as f64;
    let channel = |c: usize| points::rings(&(0..samples).map(|h| (r_mm(h), node(h)[c])).collect::<Vec<_>>());
    Profile { channels: std::array::from_fn(channel) }.checked(&|found, _| Error::Request(found))
}
