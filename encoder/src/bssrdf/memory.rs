//! How much memory a fit takes.

use crate::bssrdf::field::Field;
use crate::math::lanes::Lanes;
use crate::bssrdf::normal::{BLOCK_ROWS, BLOCKS_AT_ONCE};
use crate::bssrdf::options::{Method, Options, geometry};
use crate::bssrdf::window::{Geometry, rings};
use crate::capture::Capture;
use crate::error::Result;

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
    let paper = if options.method == Method::Paper { 30 * 8 * parameters + 2 * field + 2 * profiles } else { 0 };
    // What stays: b, which directions were measured, and a matrix for every pixel whose neighbours were not all.
    let places = capture.window_len() / 3;
    let kept = profiles + geometry.pixels() * (2 * places + 6 * geometry.nodes * lanes);
    Ok((kept + reading.max(song).max(direct).max(paper)) as u64)
}
