//! Errors of transfer files and of other schemes, of q and in images of the mesh (Hao and Varshney 2004, section 3.3).

mod reference;
mod views;

use subsurf_decoder::Transfer;
use subsurf_decoder::container::bytes::F32Le;
use subsurf_scene::Mesh;

pub use reference::{Reference, between, precompute_with_between, radial_weights};
pub use views::{ImageError, Views};

use crate::baseline::hao2004::{LLOYD_ROUNDS, Lloyd, four_nearest};
use crate::error::{Error, Result};
use crate::progress::Progress;
use crate::transfer::{Options, RdTable, Scheme};

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

/// One channel of a file.
pub struct FileChannel<'a> {
    /// The file.
    pub file: &'a Transfer<'a>,
    /// Number of the channel.
    pub channel: usize,
    /// What q is divided by: [`Reference::largest`].
    pub largest: f32,
}

impl Scheme for FileChannel<'_> {
    fn exitance(&self, weights: &[f32]) -> Vec<f32> {
        let channels = usize::from(self.file.header().channels);
        decode(self.file, weights)[self.channel..].iter().step_by(channels).map(|value| value / self.largest).collect()
    }
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
    let rows = |of: F32Le<'_>| {
        let values: Vec<f32> = of.iter().collect();
        values.as_chunks::<3>().0.to_vec()
    };
    let table = RdTable::of_tail(header.radius_mm, rows(file.tail()));
    let lights: Vec<[f32; 3]> = rows(file.lights());
    let radial = radial_weights(&lights, &between())?;
    let four: Vec<Vec<f32>> = between().iter().map(|towards| four_nearest(&lights, *towards)).collect();
    let options = Options { channels: header.channels.into(), eta: header.eta };
    let all = precompute_with_between(mesh, &table, &lights, &options, progress)?;
    progress.begin("images", header.channels.into());
    let views = Views::of(mesh);
    let errors = (0..options.channels).map(|channel| {
        let reference = Reference::new(mesh, &views, &all, channel);
        let own = FileChannel { file, channel, largest: reference.largest() };
        let lloyd = Lloyd::new(reference.q().as_slice(), LLOYD_ROUNDS);
        let error = TransferError {
            q: reference.q_error(&own),
            compression: reference.compression(&own, &radial),
            lloyd: reference.compression(&lloyd, &radial),
            total: reference.total(&own, &radial),
            four_nearest: reference.total(&own, &four),
        };
        progress.advance(1);
        error
    });
    Ok(errors.reduce(TransferError::worse).expect("at least one channel"))
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
    use crate::transfer::{Size, encode, fibonacci, precompute};

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
        // Of three channels, which share axes: a third more bytes than one.
        let three = precompute(&mesh, &table, &lights, &Options { channels: 3, ..options }, &()).unwrap();
        let coloured = encode(&mesh, &table, &three, 1.5, &size, &()).unwrap();
        let of_three = judge(&mesh, &Transfer::parse(&coloured).unwrap(), &()).unwrap();
        println!("three channels, {} bytes: {of_three:?}", coloured.len());
        assert!(3 * coloured.len() < 4 * file.len(), "{} and {} bytes", coloured.len(), file.len());
        assert!(of_three.q < 0.025 && of_three.compression.max < 0.017, "{of_three:?}");
        let other = knot(10.0, 3.1, 24).fitted(20.0).unwrap();
        assert!(judge(&other, &transfer, &()).is_err(), "a file for another mesh");
        let rough = Size { clusters: 8, components: 3, bits: 9 };
        let rough = encode(&mesh, &table, &of, 1.5, &rough, &()).unwrap();
        let worse = judge(&mesh, &Transfer::parse(&rough).unwrap(), &()).unwrap();
        assert!(worse.q > error.q && rough.len() < file.len() / 2, "{worse:?}, {} bytes", rough.len());
    }
}
