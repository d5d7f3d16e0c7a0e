//! Scattering precomputed for the vertices of a mesh, on the device.

use std::sync::OnceLock;

use subsurf_decoder::Transfer;
use subsurf_decoder::container::bytes::F32Le;
use subsurf_decoder::transfer::{LightWeights, TransferHeader};
use subsurf_shaders::{TransferLight, transfer_tint, uniform};
use wgpu::{BindingResource, Buffer, TextureFormat};

use super::mesh::GpuMesh;
use crate::error::{Error, Result};
use crate::gpu::{Fill, Gpu, Purpose, Surface2d, TextureSpec, Tracked};

/// Bytes of a texel of codes.
const TEXEL: usize = 8;

/// Homogeneous material with the scattering that is precomputed for one mesh: codes of the vertices on the device, axes and clusters on the CPU, which
/// makes a small table of them for each frame's light.
#[derive(Debug)]
pub struct TransferMaterial {
    header: TransferHeader,
    tint: [f32; 3],
    block: Tracked<Buffer>,
    codes: Surface2d,
    /// Tables of the file, as they stand there.
    lights: Vec<u8>,
    axes: Vec<i8>,
    ranges: Vec<f32>,
    means: Vec<u16>,
    bases: Vec<i8>,
    /// Whether only its coat is drawn.
    #[cfg(feature = "reference")]
    pub(crate) is_bare: bool,
    /// What weights between the lights are made of; none until it is prepared.
    between: OnceLock<Vec<f32>>,
}

impl TransferMaterial {
    /// Makes room for the codes of a file, which have to be filled in; [`Self::prepare`] does the rest.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if the device takes no texture of that size.
    pub(crate) fn begin(gpu: &Gpu, transfer: &Transfer<'_>) -> Result<(Self, Vec<Fill<'static>>)> {
        let header = *transfer.header();
        let bytes = header.record_bytes();
        let texels = bytes.div_ceil(TEXEL);
        let count = header.vertices as usize * texels;
        let codes = gpu.texture(&TextureSpec::array("codes of vertices", count, TextureFormat::Rgba16Uint))?;
        let mut padded = Vec::with_capacity(count * TEXEL);
        for record in transfer.vertex_codes().chunks_exact(bytes) {
            padded.extend_from_slice(record);
            padded.resize(padded.len().next_multiple_of(texels * TEXEL), 0);
        }
        let fills = Fill::pieces(&codes.texture, 0, &padded).map(Fill::into_owned).collect();
        #[allow(clippy::cast_possible_truncation, reason = "1 or 2")]
        let block = uniform::Transfer::new(&header.bits, texels as u32);
        let signed = |values: &[u8]| values.iter().map(|value| value.cast_signed()).collect();
        let material = Self {
            header,
            tint: transfer_tint(transfer),
            block: gpu.uniform(Purpose::Material, "codes of components", &block),
            codes,
            lights: transfer.lights().as_bytes().to_vec(),
            axes: signed(transfer.axes()),
            ranges: transfer.ranges().iter().collect(),
            means: transfer.means().iter().collect(),
            bases: signed(transfer.bases()),
            #[cfg(feature = "reference")]
            is_bare: false,
            between: OnceLock::new(),
        };
        Ok((material, fills))
    }

    /// Prepares weights between the lights of the file, once: O(n³).
    ///
    /// # Errors
    /// [`Error::Usage`] if two of the lights are too close to each other.
    pub(crate) fn prepare(&self) -> Result<()> {
        let mut buffer = vec![0.0; LightWeights::buffer_len(self.header.lights.into())];
        if LightWeights::new(self.lights(), &mut buffer).is_none() {
            return Err(Error::Usage(
                "two lights of the transfer file are too close to each other: precompute it with fewer".to_owned(),
            ));
        }
        self.between.get_or_init(|| buffer);
        Ok(())
    }

    /// The same without its scattered light, which it is timed against.
    #[cfg(feature = "reference")]
    #[must_use]
    pub fn bare(self) -> Self {
        Self { is_bare: true, ..self }
    }

    /// Header of the file: sizes, units, and the mesh that it belongs to.
    #[must_use]
    pub fn header(&self) -> &TransferHeader {
        &self.header
    }

    /// Bytes of codes and block on the device.
    #[must_use]
    pub fn gpu_bytes(&self) -> u64 {
        self.block.bytes() + self.codes.texture.bytes()
    }

    /// Directions towards the lights of the file, `[light][xyz]`.
    pub(crate) fn lights(&self) -> F32Le<'_> {
        F32Le::new(&self.lights)
    }

    /// Block and codes, to be bound.
    pub(crate) fn resources(&self) -> [BindingResource<'_>; 2] {
        [self.block.as_entire_binding(), BindingResource::TextureView(&self.codes.view)]
    }

    /// Width and height of the table of a light: a constant and the components, by cluster.
    pub(crate) fn table_size(&self) -> [u32; 2] {
        let entries = self.header.components() + 1;
        [u32::try_from(entries).unwrap_or(u32::MAX), self.header.clusters.into()]
    }

    /// Refuses a mesh that the file is not of.
    ///
    /// # Errors
    /// [`Error::Mesh`] with the CRC-32 of both.
    pub(crate) fn expect(&self, mesh: &GpuMesh) -> Result<()> {
        let (of, found) = ([self.header.positions_crc, self.header.triangles_crc], mesh.geometry_crc);
        if of == found {
            return Ok(());
        }
        let what = if of[1] == found[1] {
            "these triangles in another size or place: give the mesh the extent and the upward axis of then"
        } else {
            "another mesh: draw that one, alone"
        };
        Err(Error::Mesh(format!(
            "the transfer file was precomputed for {what}; CRC-32 of positions {:08x}, of triangles {:08x}; of this mesh {:08x}, {:08x}",
            of[0], of[1], found[0], found[1]
        )))
    }

    /// Table of some light: exitance of every cluster and channel, a constant and what a step of the code of each component adds,
    /// `[cluster][1 + K]`, linear Rec. 709; the fourth place is 0.
    pub(crate) fn table(&self, light: &TransferLight) -> Vec<[f32; 4]> {
        let buffer = self.between.get().map_or(&[][..], |buffer| buffer);
        let Some(between) = LightWeights::prepared(self.lights(), buffer) else { return Vec::new() };
        let weights = light.weights(&between);
        let header = &self.header;
        let (channels, lights) = (usize::from(header.channels), usize::from(header.lights));
        let (rows, axes) = (header.components() + 1, usize::from(header.axes));
        let mut table = vec![[0.0; 4]; usize::from(header.clusters) * rows];
        for c in 0..3 {
            let from = c.min(channels - 1);
            let scale = self.tint[c] * header.scale[from];
            // What the light has along each axis.
            let mut along = vec![0.0; axes];
            for (rgb, row) in weights.iter().zip(self.axes[from * lights * axes..].chunks_exact(axes)) {
                for (along, axis) in along.iter_mut().zip(row) {
                    *along += scale * rgb[c] * f32::from(*axis);
                }
            }
            let total: f32 = along.iter().sum();
            for (cluster, table) in table.chunks_exact_mut(rows).enumerate() {
                let range = |row: usize| [0, 1].map(|k| self.ranges[2 * (cluster * rows + row) + k]);
                let [offset, step] = range(0);
                table[0][c] = offset * total + step * dot(&self.means[cluster * axes..][..axes], &along);
                for row in 1..rows {
                    let basis = dot(&self.bases[(cluster * (rows - 1) + row - 1) * axes..][..axes], &along);
                    let [offset, step] = range(row);
                    table[0][c] += offset * basis;
                    table[row][c] = step * basis;
                }
            }
        }
        table
    }
}

/// Sum of products, in as many sums at once as vector units take.
fn dot<T: Copy + Into<f32>>(values: &[T], along: &[f32]) -> f32 {
    const LANES: usize = 8;
    let ((values, values_left), (along, along_left)) = (values.as_chunks::<LANES>(), along.as_chunks::<LANES>());
    let mut sums = [0.0; LANES];
    for (values, along) in values.iter().zip(along) {
        for ((sum, value), along) in sums.iter_mut().zip(values).zip(along) {
            *sum += (*value).into() * along;
        }
    }
    let left = values_left.iter().zip(along_left).map(|(value, along)| (*value).into() * along);
    sums.into_iter().chain(left).sum()
}
