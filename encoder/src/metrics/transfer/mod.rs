//! Errors of transfer files, of q and in images of the mesh (Hao and Varshney 2004, section 3.3).

mod between;
mod views;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use subsurf_decoder::Transfer;
use subsurf_scene::Mesh;

pub use between::Between;
pub use views::{ImageError, Views};

use crate::baseline::hao2004::{Lloyd, four_nearest};
use crate::error::{Error, Result};
use crate::progress::Progress;
use crate::transfer::{Options, Precomputed, RdTable, precompute};
use between::{SIDE, VIEWS, directions, weights};

/// Rounds of the paper's quantiser.
const LLOYD_ROUNDS: usize = 20;

/// How far a file is off. Each channel is divided by its largest q, and the errors are those of the worst channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransferError {
    /// Root-mean-square error of q, over vertices and lights: what compression does.
    pub q: f64,
    /// The same in images, between the lights: the file against what it was made from, with the same weights.
    pub compression: ImageError,
    /// A byte for each q in place of the file, by the paper's quantiser.
    pub lloyd: ImageError,
    /// The file by its radial basis functions against exact sums, in images between the lights: compression and interpolation.
    pub total: ImageError,
    /// The same with the paper's four nearest lights.
    pub four_nearest: ImageError,
}

/// Weights of a file's lights for a direction.
///
/// # Errors
/// [`Error::Request`] if two lights of the file are one.
pub fn weights_of(file: &Transfer<'_>, directions: &[[f32; 3]]) -> Result<Vec<Vec<f32>>> {
    weights(file.lights(), directions)
}

/// Exitance of all vertices under light of given weights, `[vertex][channel]`.
#[must_use]
pub fn decode(file: &Transfer<'_>, weights: &[f32]) -> Vec<f32> {
    let header = file.header();
    let mut table = vec![0.0; header.table_len()];
    file.light_table(weights, &mut table);
    let mut out = vec![0.0; header.vertices as usize * usize::from(header.channels)];
    file.exitance(&table, 0, &mut out);
    out
}

/// Errors of a file on its mesh. What it was made from is summed up again from mesh and file, which takes as long as the first time.
///
/// # Errors
/// [`Error::Request`] if the file is for another mesh, two of its lights are one, or memory does not suffice.
pub fn judge(mesh: &Mesh, file: &Transfer<'_>, progress: &dyn Progress) -> Result<TransferError> {
    let header = file.header();
    if mesh.positions.len() as u64 != u64::from(header.vertices)
        || mesh.geometry_crc() != [header.positions_crc, header.triangles_crc]
    {
        return Err(Error::Request(format!(
            "the file is for another mesh, of {} vertices; this one has {}, or another shape or size in mm",
            header.vertices,
            mesh.positions.len()
        )));
    }
    let rows = |of: subsurf_decoder::container::bytes::F32Le<'_>| {
        let values: Vec<f32> = of.iter().collect();
        values.as_chunks::<3>().0.to_vec()
    };
    let table = RdTable::of_tail(header.radius_mm, rows(file.tail()));
    let lights: Vec<[f32; 3]> = rows(file.lights());
    let between = directions();
    let smooth = weights_of(file, &between)?;
    let all = [&lights[..], &between].concat();
    let options = Options { channels: header.channels.into(), eta: header.eta };
    let exact = precompute(mesh, &table, &all, &options, progress)?;
    let stored = exact.select(&(0..lights.len()).collect::<Vec<usize>>());
    progress.begin("images", header.channels.into());
    let views = Views::new(mesh, VIEWS, SIDE);
    let channels = (0..stored.channels).map(|c| {
        let error = of_channel(mesh, file, [&exact, &stored], (&between, &smooth), &views, c);
        progress.advance(1);
        error
    });
    Ok(channels.reduce(TransferError::worse).expect("at least one channel"))
}

fn of_channel(
    mesh: &Mesh,
    file: &Transfer<'_>,
    [exact, stored]: [&Precomputed; 2],
    (between, smooth): (&[[f32; 3]], &[Vec<f32>]),
    views: &Views,
    c: usize,
) -> TransferError {
    let lights = stored.light_count();
    let q = stored.q.rows(c * lights, lights).into_owned();
    let scale = 1.0 / q.amax().max(f32::MIN_POSITIVE);
    let of_places = |values: &[f32]| stored.place_of.iter().map(|place| scale * values[*place as usize]).collect();
    let decoded = |weights: &[f32]| -> Vec<f32> {
        decode(file, weights).iter().skip(c).step_by(stored.channels).map(|value| scale * value.max(0.0)).collect()
    };
    let square = |light: usize| {
        let mut weights = vec![0.0; lights];
        weights[light] = 1.0;
        let own: Vec<f32> = of_places(q.row(light).transpose().as_slice());
        decoded(&weights).iter().zip(&own).map(|(a, b)| f64::from(a - b).powi(2)).sum::<f64>()
    };
    let squares: Vec<f64> = (0..lights).into_par_iter().map(square).collect();
    let four: Vec<Vec<f32>> = between.iter().map(|towards| four_nearest(&stored.lights, *towards)).collect();
    let truth =
        |k: usize| -> Vec<f32> { of_places(exact.q.row(c * exact.light_count() + lights + k).transpose().as_slice()) };
    let rounded = DMatrix::from_iterator(lights, q.ncols(), Lloyd::new(q.as_slice(), LLOYD_ROUNDS).values());
    let interpolated = |of: &DMatrix<f32>, k: usize| -> Vec<f32> {
        let value = of.tr_mul(&DVector::from_column_slice(&smooth[k]));
        of_places(value.map(|value| value.max(0.0)).as_slice())
    };
    let errors =
        |pairs: &(dyn Fn(usize) -> [Vec<f32>; 2] + Sync)| views.errors(|view| pairs(view % between.len()), mesh);
    TransferError {
        q: (squares.iter().sum::<f64>() / (lights * stored.place_of.len()) as f64).sqrt(),
        compression: errors(&|k| [decoded(&smooth[k]), interpolated(&q, k)]),
        lloyd: errors(&|k| [interpolated(&rounded, k), interpolated(&q, k)]),
        total: errors(&|k| [decoded(&smooth[k]), truth(k)]),
        four_nearest: errors(&|k| [decoded(&four[k]), truth(k)]),
    }
}

impl TransferError {
    /// The larger of each error.
    fn worse(self, other: Self) -> Self {
        let larger = ImageError::larger;
        Self {
            q: self.q.max(other.q),
            compression: larger(self.compression, other.compression),
            lloyd: larger(self.lloyd, other.lloyd),
            total: larger(self.total, other.total),
            four_nearest: larger(self.four_nearest, other.four_nearest),
        }
    }
}

#[cfg(test)]
mod tests {
    use subsurf_scene::knot;

    use super::*;
    use crate::kernel::Profile;
    use crate::simulate::diffusion::Medium;
    use crate::transfer::{Size, encode, fibonacci};

    /// Bounds a little above what was found, on a knot of few vertices, which shades itself everywhere; larger and smoother meshes
    /// have a fraction of it.
    #[test]
    fn files_are_as_good_as_is_said() {
        let mesh = knot(10.0, 3.0, 24).fitted(20.0).unwrap();
        let profile = Profile::dipole(&Medium::measured("marble").unwrap(), 1.5).unwrap();
        let (table, lights) = (RdTable::of(&profile).unwrap(), fibonacci(100));
        let options = Options { channels: 1, eta: 1.5 };
        let of = precompute(&mesh, &table, &lights, &options, &()).unwrap();
        let size = Size { clusters: 32, components: 8, bits: 40 };
        let file = encode(&mesh, &table, &of, 1.5, &size, &()).unwrap();
        let transfer = Transfer::parse(&file).unwrap();
        let error = judge(&mesh, &transfer, &()).unwrap();
        println!("{} vertices, {} bytes: {error:?}", mesh.positions.len(), file.len());
        assert_eq!(transfer.header().record_bytes(), 6, "a cluster and 40 bits");
        assert!(error.q < 0.023, "{error:?}");
        assert!(error.compression.max < 0.015, "{error:?}");
        assert!(error.lloyd.max < 0.0006, "a byte for each light: {error:?}");
        // Between the lights, radial basis functions are closer than the paper's four, compression included.
        assert!(error.total.rms < 0.75 * error.four_nearest.rms, "{error:?}");
        let other = knot(10.0, 3.1, 24).fitted(20.0).unwrap();
        assert!(judge(&other, &transfer, &()).is_err(), "a file for another mesh");
        let rough = Size { clusters: 8, components: 3, bits: 9 };
        let rough = encode(&mesh, &table, &of, 1.5, &rough, &()).unwrap();
        let worse = judge(&mesh, &Transfer::parse(&rough).unwrap(), &()).unwrap();
        assert!(worse.q > error.q && rough.len() < file.len() / 2, "{worse:?}, {} bytes", rough.len());
    }
}
