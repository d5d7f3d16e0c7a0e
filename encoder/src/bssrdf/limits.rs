//! Bytes that a file and its fit take, before anything is fitted.

use crate::bssrdf::field::Field;
use crate::bssrdf::normal::{BLOCK_ROWS, BLOCKS_AT_ONCE};
use crate::bssrdf::options::{self, Method, Options, geometry};
use crate::bssrdf::window::{Geometry, rings};
use crate::bssrdf::write;
use crate::capture::Capture;
use crate::error::Result;
use crate::math::lanes::Lanes;

/// Bytes of the file of a K-BMPP fit; an upper bound for palettes, and where base materials turn out to be unused.
///
/// # Errors
/// [`Error::Request`](crate::Error::Request) for S or options out of range.
pub fn file_bytes(capture: &Capture, samples: Option<usize>, options: &Options) -> Result<u64> {
    options.check()?;
    let geometry = options::geometry(capture, samples)?;
    Ok(write::file_bytes(&options.header(capture, &geometry), options.half_profiles))
}

/// The largest M with which the file of a K-BMPP fit takes at most `limit` bytes, by [`file_bytes`]; 0 if none does.
///
/// # Errors
/// As [`file_bytes`].
pub fn base_materials_within(
    capture: &Capture,
    samples: Option<usize>,
    options: &Options,
    limit: u64,
) -> Result<usize> {
    // Every base material takes bytes: all up to `fits` do, and none from `too_many` on.
    let (mut fits, mut too_many) = (0, options.most_base_materials() + 1);
    while fits + 1 < too_many {
        let base_materials = fits.midpoint(too_many);
        if file_bytes(capture, samples, &Options { base_materials, ..*options })? <= limit {
            fits = base_materials;
        } else {
            too_many = base_materials;
        }
    }
    Ok(fits)
}

/// Bytes of memory that [`Problem`](super::Problem) and its largest fit take besides the mapped capture: an upper
/// estimate, from the sizes of its tables.
///
/// # Errors
/// As [`Problem::new`](super::Problem::new), for S out of range.
pub fn fit_bytes(capture: &Capture, samples: Option<usize>, options: &Options) -> Result<u64> {
    options.check()?;
    let geometry = geometry(capture, samples)?;
    let lanes = size_of::<Lanes>();
    let profiles = geometry.pixels() * geometry.nodes * lanes;
    let field = Field::bytes(&geometry);
    // Sums in double precision, of the patch and of what the windows of the blocks at hand reach; then b beside them.
    let reach = (BLOCK_ROWS + 2 * geometry.radius) * (geometry.size[0] + 2 * geometry.radius);
    let reading = (BLOCKS_AT_ONCE * reach * geometry.nodes + geometry.pixels() * geometry.nodes) * 24 + profiles;
    // Solution, direction, residual, its preconditioned self twice, and image.
    let song = 2 * field + 5 * profiles;
    // A field, a copy while it is written, and √Rd at every ring with a copy.
    let rings = rings(&geometry).len();
    let roots = Field::bytes(&Geometry { nodes: rings, ..geometry }) + geometry.pixels() * rings * lanes;
    let bases = options.base_materials * geometry.nodes * lanes;
    // Costs of all pairs for every border shape that some pixels share.
    let several = matches!(options.method, Method::Direct) && options.per_pixel > 1;
    let tables = if several { (4 * geometry.radius + 2) * options.base_materials.pow(2) * 2 } else { 0 };
    let direct = 2 * field + profiles + roots + (BLOCKS_AT_ONCE + 8) * bases + tables;
    // Some thirty vectors of all parameters, in double precision, and a field for every evaluation.
    let parameters = 3 * options.base_materials * geometry.nodes + geometry.pixels() * options.per_pixel;
    let paper = if options.method == Method::Yatagawa2020 { 30 * 8 * parameters + 2 * field + 2 * profiles } else { 0 };
    // What stays: b, which directions were measured, and a matrix for every pixel whose neighbours were not all.
    let places = capture.window_len() / 3;
    let kept = profiles + geometry.pixels() * (2 * places + 6 * geometry.nodes * lanes);
    Ok((kept + reading.max(song).max(direct).max(paper)) as u64)
}
