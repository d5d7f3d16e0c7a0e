//! Reads and checks a transfer file once; afterwards its tables are borrowed and nothing can fail.

use super::layout::{MAX_RANGE, TransferHeader};
use crate::container::Crc;
use crate::container::bytes::{F32Le, U16Le};
use crate::container::sections::{SectionBytes, Sections};
use crate::detect;
use crate::error::ReadError;
use crate::family::Family;
use crate::kernel::reader::{checked, tail};
use crate::section::Section;

/// How far the square of a direction's length may be from 1.
const UNIT_TOLERANCE: f32 = 1e-3;

/// Checked transfer file: what leaves a homogeneous material at every vertex of a mesh, for directional light.
///
/// For light j of irradiance 1 on a plane across it, the radiant exitance at a vertex of cluster m with coefficients a_k is
/// q_cj = s_c Σ_r x_cjr (μ_mr + Σ_k a_k b_mkr), with axes x that all clusters share (Hao and Varshney 2004; clustered principal components after Sloan et al. 2003).
#[derive(Clone, Copy, Debug)]
pub struct Transfer<'a> {
    header: TransferHeader,
    lights: F32Le<'a>,
    pub(super) axes: &'a [u8],
    pub(super) ranges: F32Le<'a>,
    pub(super) means: U16Le<'a>,
    pub(super) bases: &'a [u8],
    pub(super) codes: &'a [u8],
    tail: F32Le<'a>,
}

impl<'a> Transfer<'a> {
    /// Reads and checks a file: structure, sizes, every value and index, and all CRCs.
    ///
    /// # Errors
    /// The first thing that is wrong, with section, offset and numbers.
    pub fn parse(file: &'a [u8]) -> Result<Self, ReadError> {
        Self::parse_with(file, Crc::Check)
    }

    /// [`Transfer::parse`] with a choice about the sections' CRC-32.
    ///
    /// # Errors
    /// As [`Transfer::parse`].
    pub fn parse_with(file: &'a [u8], crc: Crc) -> Result<Self, ReadError> {
        Self::read(&Sections::parse(file, crc)?)
    }

    /// Reads and checks all sections.
    pub(crate) fn read(sections: &Sections<'a>) -> Result<Self, ReadError> {
        let header = TransferHeader::parse(detect::header(sections, Section::TransferHeader, Family::Transfer)?)?;
        let sized = |section| sections.sized(section, header.section_bytes(section));
        let lights = sized(Section::Lights)?;
        let ranges = sized(Section::ClusterRanges)?;
        let codes = sized(Section::VertexCodes)?;
        check_clusters(codes, &header)?;
        Ok(Self {
            header,
            lights: unit_vectors(lights)?,
            axes: sized(Section::LightAxes)?.bytes,
            ranges: checked_ranges(ranges)?,
            means: U16Le::new(sized(Section::ClusterMeans)?.bytes),
            bases: sized(Section::ClusterBases)?.bytes,
            codes: codes.bytes,
            tail: tail(sized(Section::KernelTail)?)?,
        })
    }

    /// Sizes, units, and the mesh that the file belongs to.
    #[must_use]
    pub fn header(&self) -> &TransferHeader {
        &self.header
    }

    /// Unit directions towards the lights, in the mesh's coordinates; shape `[light][xyz]`.
    #[must_use]
    pub fn lights(&self) -> F32Le<'a> {
        self.lights
    }

    /// Nodes of the tail T of the profile, as [`Kernel::tail`](crate::Kernel::tail) has them.
    #[must_use]
    pub fn tail(&self) -> F32Le<'a> {
        self.tail
    }

    /// Axes of light, signed bytes; shape `[channel][light][axis]`.
    #[must_use]
    pub fn axes(&self) -> &'a [u8] {
        self.axes
    }

    /// Offset and step of the mean of every cluster and of the coefficient of every component; shape `[cluster][1 + K][2]`.
    #[must_use]
    pub fn ranges(&self) -> F32Le<'a> {
        self.ranges
    }

    /// Means of the clusters as codes of their offset and step; shape `[cluster][axis]`.
    #[must_use]
    pub fn means(&self) -> U16Le<'a> {
        self.means
    }

    /// Components of the clusters, signed bytes; shape `[cluster][component][axis]`.
    #[must_use]
    pub fn bases(&self) -> &'a [u8] {
        self.bases
    }

    /// Cluster and coefficients of the vertices as they stand in the file, `record_bytes` each.
    #[must_use]
    pub fn vertex_codes(&self) -> &'a [u8] {
        self.codes
    }
}

/// Offsets of either sign and steps of none, one after the other.
pub(super) fn checked_ranges(section: SectionBytes<'_>) -> Result<F32Le<'_>, ReadError> {
    checked(section, &mut |k, _| [if k.is_multiple_of(2) { -MAX_RANGE } else { 0.0 }, MAX_RANGE])
}

/// Directions of length 1.
pub(super) fn unit_vectors(section: SectionBytes<'_>) -> Result<F32Le<'_>, ReadError> {
    let range = [1.0 - UNIT_TOLERANCE, 1.0 + UNIT_TOLERANCE];
    let [_, most] = range;
    let values = checked(section, &mut |_, _| [-most, most])?;
    for k in (0..values.len()).step_by(3) {
        let [x, y, z] = values.rgb_at(k);
        section.origin.at_item(k, size_of::<f32>()).number(0, x * x + y * y + z * z, range)?;
    }
    Ok(values)
}

/// Every vertex names a cluster that there is.
pub(super) fn check_clusters(section: SectionBytes<'_>, header: &TransferHeader) -> Result<(), ReadError> {
    let (record_bytes, clusters) = (header.record_bytes(), header.clusters);
    for (vertex, record) in section.bytes.chunks_exact(record_bytes).enumerate() {
        let cluster = record.first().copied().unwrap_or(0);
        if u16::from(cluster) >= clusters {
            return Err(section.origin.at_item(vertex, record_bytes).bad_index(cluster.into(), clusters.into()));
        }
    }
    Ok(())
}
