//! The `XFER` header and the sizes of the sections that follow from it.

use crate::container::record::{Field, record};
use crate::container::sections::SectionBytes;
use crate::error::ReadError;
use crate::kernel::layout::{LINEAR_REC709, MAX_ETA, RADII_MM, TAIL_NODE_BYTES, TAIL_NODES};
use crate::section::Section;
use core::mem::offset_of;
use core::num::Saturating;

/// Bytes of the `XFER` section.
pub const HEADER_BYTES: usize = size_of::<TransferRecord>();
/// Smallest and largest number of lights.
pub const LIGHTS: [u16; 2] = [4, 1_024];
/// Largest number of components of a cluster.
pub const MAX_COMPONENTS: usize = 16;
/// Largest number of axes.
pub const MAX_AXES: u16 = 256;
/// Largest number of clusters.
pub const MAX_CLUSTERS: u16 = 256;
/// Largest number of vertices.
pub const MAX_VERTICES: u32 = 1 << 26;
/// Largest number of bits of a coefficient.
pub const MAX_BITS: u8 = 12;
/// Largest number of bits of a vertex: those of its cluster and of all its coefficients.
pub const MAX_RECORD_BITS: u32 = 128;
/// Largest offset and step of a coefficient.
pub const MAX_RANGE: f32 = 1e3;
/// Smallest and largest scale of a channel.
pub const SCALES: [f32; 2] = [1e-12, 1e6];

record! {
    /// The `XFER` section (`FORMAT.md`, section 7.1).
    TransferRecord {
        colour_space: u8,
        channels: u8,
        lights: u16,
        clusters: u16,
        tail_nodes: u16,
        vertices: u32,
        positions_crc: u32,
        triangles_crc: u32,
        radius_mm: f32,
        eta: f32,
        scale_red: f32,
        scale_green: f32,
        scale_blue: f32,
        bits: [u8; MAX_COMPONENTS],
        axes: u16,
    }
}

/// Header of a transfer file: sizes, units, and the mesh that it belongs to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransferHeader {
    /// Colour channels, 1 or 3.
    pub channels: u8,
    /// Directions of light, 4 to 1,024.
    pub lights: u16,
    /// Clusters, 1 to 256.
    pub clusters: u16,
    /// Nodes of the tail, 2 to 1,024.
    pub tail_nodes: u16,
    /// Vertices of the mesh, 1 to 2²⁶.
    pub vertices: u32,
    /// CRC-32 of the mesh's positions in mm, as `[vertex][xyz]` of little-endian `f32`.
    pub positions_crc: u32,
    /// CRC-32 of the mesh's triangles, as `[triangle][corner]` of little-endian `u32`.
    pub triangles_crc: u32,
    /// Distance in mm beyond which the profile is 0; 10⁻⁶ to 10⁶.
    pub radius_mm: f32,
    /// Refractive index of the material against air, 1 to 4.
    pub eta: f32,
    /// What values of each channel are multiplied by, 10⁻¹² to 10⁶. Of one channel the first counts.
    pub scale: [f32; 3],
    /// Bits of the coefficient of each component, 1 to 12, then zeros; 1 to 16 components.
    pub bits: [u8; MAX_COMPONENTS],
    /// Axes of light that means and components have numbers along, 1 to 256.
    pub axes: u16,
}

impl TransferHeader {
    /// The section as it stands in the file.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; HEADER_BYTES] {
        let [scale_red, scale_green, scale_blue] = self.scale;
        TransferRecord {
            colour_space: LINEAR_REC709,
            channels: self.channels,
            lights: self.lights,
            clusters: self.clusters,
            tail_nodes: self.tail_nodes,
            vertices: self.vertices,
            positions_crc: self.positions_crc,
            triangles_crc: self.triangles_crc,
            radius_mm: self.radius_mm,
            eta: self.eta,
            scale_red,
            scale_green,
            scale_blue,
            bits: self.bits,
            axes: self.axes,
        }
        .to_bytes()
    }

    /// Reads and checks the section.
    pub(crate) fn parse(section: SectionBytes<'_>) -> Result<Self, ReadError> {
        use TransferRecord as R;
        let record = R::from_bytes(section.at_least(HEADER_BYTES as u64)?.bytes);
        let origin = section.origin;
        let R { colour_space, channels, lights, clusters, tail_nodes, vertices, bits, axes, .. } = record;
        let rec709 = LINEAR_REC709.into();
        origin.integer(offset_of!(R, colour_space), colour_space, rec709..=rec709)?;
        if !matches!(channels, 1 | 3) {
            return Err(origin.bad_field(offset_of!(R, channels), channels));
        }
        let [fewest, most] = LIGHTS.map(u32::from);
        let lights = origin.integer(offset_of!(R, lights), lights, fewest..=most)?;
        let clusters = origin.integer(offset_of!(R, clusters), clusters, 1..=MAX_CLUSTERS.into())?;
        let [fewest, most] = TAIL_NODES.map(u32::from);
        let tail_nodes = origin.integer(offset_of!(R, tail_nodes), tail_nodes, fewest..=most)?;
        let vertices = origin.integer(offset_of!(R, vertices), vertices, 1..=MAX_VERTICES)?;
        // The first component has bits; none has after one without.
        let [mut least, mut most] = [1, u32::from(MAX_BITS)];
        let mut all = u8::BITS;
        for (k, &bits) in bits.iter().enumerate() {
            let at = offset_of!(R, bits).saturating_add(k);
            origin.integer(at, bits, least..=most)?;
            all = all.saturating_add(bits.into());
            if bits == 0 {
                most = 0;
            }
            least = 0;
            if all > MAX_RECORD_BITS {
                return Err(origin.bad_field(at, bits));
            }
        }
        let axes = origin.integer(offset_of!(R, axes), axes, 1..=MAX_AXES.into())?;
        let number = |at, value, range| origin.number(at, value, range);
        Ok(Self {
            channels,
            lights,
            clusters,
            tail_nodes,
            vertices,
            positions_crc: record.positions_crc,
            triangles_crc: record.triangles_crc,
            radius_mm: number(offset_of!(R, radius_mm), record.radius_mm, RADII_MM)?,
            eta: number(offset_of!(R, eta), record.eta, [1.0, MAX_ETA])?,
            scale: [
                number(offset_of!(R, scale_red), record.scale_red, SCALES)?,
                number(offset_of!(R, scale_green), record.scale_green, SCALES)?,
                number(offset_of!(R, scale_blue), record.scale_blue, SCALES)?,
            ],
            bits,
            axes,
        })
    }

    /// Components K of a cluster, 1 to 16.
    #[must_use]
    pub fn components(&self) -> usize {
        self.bits.iter().take_while(|bits| **bits > 0).count()
    }

    /// Bytes of a vertex: its cluster and the bits of its coefficients, rounded up; 2 to 16.
    #[must_use]
    #[inline]
    pub fn record_bytes(&self) -> usize {
        let bits = self.bits.iter().fold(u8::BITS, |sum, bits| sum.wrapping_add(u32::from(*bits)));
        // At least one, as the compiler is to see: slices cannot be cut into chunks of none.
        (bits.div_ceil(u8::BITS) as usize).max(1)
    }

    /// Numbers of a light table, as [`Transfer::light_table`](super::Transfer::light_table) fills it: `[cluster][channel][1 + K]`.
    #[must_use]
    pub fn table_len(&self) -> usize {
        let rows = self.components().wrapping_add(1);
        rows.wrapping_mul(self.channels.into()).wrapping_mul(self.clusters.into())
    }

    /// Bytes that a section must have, as `FORMAT.md` says.
    #[must_use]
    pub fn section_bytes(&self, section: Section) -> u64 {
        const F32: Saturating<u64> = Saturating(4);
        let of = |count: u64| Saturating(count);
        let [clusters, components] = [self.clusters.into(), self.components() as u64].map(of);
        let [axes, lights] = [self.axes.into(), self.lights.into()].map(of);
        let bytes = match section {
            Section::TransferHeader => of(HEADER_BYTES as u64),
            Section::Lights => of(3) * lights * F32,
            Section::LightAxes => of(self.channels.into()) * lights * axes,
            Section::ClusterRanges => clusters * (components + of(1)) * of(2) * F32,
            Section::ClusterMeans => clusters * axes * of(2),
            Section::ClusterBases => clusters * components * axes,
            Section::VertexCodes => of(self.vertices.into()) * of(self.record_bytes() as u64),
            Section::KernelTail => of(self.tail_nodes.into()) * of(TAIL_NODE_BYTES),
            _ => of(0),
        };
        bytes.0
    }
}
