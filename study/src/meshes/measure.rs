//! Every scheme on one mesh.

use std::time::Instant;

use subsurf_decoder::Transfer;
use subsurf_encoder::Progress;
use subsurf_encoder::baseline::hao2004::{Harmonics, LLOYD_ROUNDS, Lloyd, ReferencePoints, Tiling, four_nearest};
use subsurf_encoder::metrics::transfer::{
    FileChannel, Reference, Views, between, precompute_with_between, radial_weights,
};
use subsurf_encoder::transfer::{Options, Precomputed, RdTable, Scheme, Size, encode, fibonacci};
use subsurf_scene::Mesh;

use super::published::reference_points;
use super::record::{Interpolation, Key, Kind, Measured, Record};

/// Orders of spherical harmonics that the paper has.
const ORDERS: std::ops::RangeInclusive<usize> = 1..=7;
/// Orders of those of differences to reference points: 9 and 36 functions.
const DIFFERENCES: [usize; 2] = [3, 6];
/// Numbers of reference points, as parts of the paper's for such a mesh.
const PARTS: [usize; 4] = [8, 4, 2, 1];
/// Components and bits beside the default's.
const COMPONENTS: [[usize; 2]; 4] = [[4, 20], [6, 30], [12, 56], [16, 80]];
/// Components and bits of one cluster.
const ONE: [[usize; 2]; 2] = [[8, 40], [16, 80]];
/// Bytes of a light's direction, which all that interpolate need.
const DIRECTION: u64 = 12;

/// A material and a mesh of it.
pub(super) struct MeshCase<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) table: &'a RdTable,
    pub(super) eta: f32,
}

impl MeshCase<'_> {
    /// Measures light interpolation for half the lights of `key`, as many, and twice as many, and every scheme for as many.
    pub(super) fn measure(&self, key: Key, progress: &dyn Progress) -> anyhow::Result<Record> {
        let views = Views::of(self.mesh);
        let count = key.lights;
        let mut record = Record {
            key,
            vertices: self.mesh.positions.len(),
            interpolations: Vec::new(),
            lloyd_snr_db: f64::NAN,
            compress_seconds: f64::NAN,
            schemes: Vec::new(),
        };
        for lights in [count / 2, count, 2 * count] {
            let directions = fibonacci(lights);
            let began = Instant::now();
            let options = Options { channels: 1, eta: self.eta };
            let all = precompute_with_between(self.mesh, self.table, &directions, &options, progress)?;
            let seconds = began.elapsed().as_secs_f64();
            let reference = Reference::new(self.mesh, &views, &all, 0);
            let four = between().iter().map(|towards| four_nearest(&directions, *towards)).collect();
            let judge = Judge { reference: &reference, radial: radial_weights(&directions, &between())?, four };
            record.interpolations.push(Interpolation {
                lights,
                seconds,
                four_nearest: reference.total(reference.q(), &judge.four),
                radial: reference.total(reference.q(), &judge.radial),
            });
            if lights == count {
                self.schemes(&judge, &all, &directions, &mut record, progress)?;
            }
        }
        Ok(record)
    }

    fn schemes(
        &self,
        judge: &Judge<'_>,
        all: &Precomputed,
        lights: &[[f32; 3]],
        record: &mut Record,
        progress: &dyn Progress,
    ) -> anyhow::Result<()> {
        let (q, vertices) = (judge.reference.q(), self.mesh.positions.len());
        let sizes = sizes(vertices);
        let orders: Vec<usize> = ORDERS.filter(|order| order * order <= lights.len()).collect();
        let steps = 1 + orders.len() + PARTS.len() * DIFFERENCES.len() + sizes.len();
        progress.begin("schemes", steps as u64);
        let per_vertex = |bytes: u64| bytes as f64 / vertices as f64;
        let directions = DIRECTION * lights.len() as u64;
        let mut add = |kind: Kind, scheme: &dyn Scheme, bytes: u64, without_indices: Option<u64>| {
            record.schemes.push(judge.of(kind, scheme, per_vertex(bytes), without_indices.map(per_vertex)));
            progress.advance(1);
        };
        let lloyd = Lloyd::new(q.as_slice(), LLOYD_ROUNDS);
        add(Kind::Lloyd, &lloyd, lloyd.bytes() + directions, None);
        for order in orders {
            let harmonics = Harmonics::new(q, lights, order, 2);
            add(Kind::Harmonics { order }, &harmonics, harmonics.bytes(), None);
        }
        for part in PARTS {
            let tiling = Tiling::new(self.mesh, &all.place_of, reference_points(vertices) / part);
            for order in DIFFERENCES {
                let stored = ReferencePoints::new(q, lights, &tiling, order);
                let kind = Kind::ReferencePoints { points: tiling.count(), order };
                add(kind, &stored, stored.bytes() + directions, Some(stored.bytes_without_indices()));
            }
        }
        let stored = all.select(&(0..lights.len()).collect::<Vec<usize>>());
        let mut compress_seconds = f64::NAN;
        for size in sizes {
            let began = Instant::now();
            let bytes = encode(self.mesh, self.table, &stored, self.eta, &size, &())?;
            if size == Size::of_vertices(vertices) {
                compress_seconds = began.elapsed().as_secs_f64();
            }
            let file = Transfer::parse(&bytes)?;
            let channel = FileChannel { file: &file, channel: 0, largest: judge.reference.largest() };
            add(Kind::of_size(size), &channel, bytes.len() as u64, None);
        }
        record.lloyd_snr_db = lloyd.snr_db(q.as_slice());
        record.compress_seconds = compress_seconds;
        Ok(())
    }
}

/// Sizes of our files: the default with fewer and more clusters, with other components, and one cluster.
pub(super) fn sizes(vertices: usize) -> Vec<Size> {
    let default = Size::of_vertices(vertices);
    let Size { clusters, .. } = default;
    let mut all: Vec<Size> = [clusters / 4, clusters / 2, clusters, 2 * clusters, 4 * clusters]
        .map(|clusters| Size { clusters: clusters.clamp(2, 256), ..default })
        .into();
    all.dedup();
    all.extend(COMPONENTS.map(|[components, bits]| Size { clusters, components, bits }));
    all.extend(ONE.map(|[components, bits]| Size { clusters: 1, components, bits }));
    all
}

/// What schemes are compared with, and weights of lights for the directions in between, in both ways.
struct Judge<'a> {
    reference: &'a Reference<'a>,
    radial: Vec<Vec<f32>>,
    four: Vec<Vec<f32>>,
}

impl Judge<'_> {
    fn of(&self, kind: Kind, scheme: &dyn Scheme, bytes: f64, bytes_without_indices: Option<f64>) -> Measured {
        let own = if kind.is_theirs() { &self.four } else { &self.radial };
        Measured {
            kind,
            bytes,
            bytes_without_indices,
            compression: self.reference.compression(scheme, &self.radial),
            compression_by_four: self.reference.compression(scheme, &self.four),
            total: self.reference.total(scheme, own),
        }
    }
}
