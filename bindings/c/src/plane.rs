//! Planes of a BSSRDF: where they are in the file, and what textures they are.

use core::ffi::c_void;
use core::mem::offset_of;

use subsurf_decoder::bssrdf::{BaseMaterials, Bssrdf, BssrdfModel, Mixtures, Profiles};

use crate::border::{self, Versioned};
use crate::failure::{Failure, SubsurfStatus, status_of};
use crate::file::SubsurfFile;

/// What the numbers of a plane are.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SubsurfPlaneKind {
    /// Log-scale base scattering profiles: a row for each base material, a column for each node; natural log of mm^-2 in R, G, B,
    /// linear Rec. 709, within -87 to 87.
    BaseProfiles = 0,
    /// Log-scale local scattering profiles: layer 3 h + c has node h of channel c for each pixel; natural log of mm^-2.
    LocalProfiles = 1,
    /// Mixture ratios t, 0 to 1. For K = 2, t of the first base material, 1 - t of the second; for K = 3 and 5, layer k has t_k.
    MixtureRatios = 2,
    /// Base-material indices. For K = 2 both in R and G; for K = 1, 3 and 5, layer k has b_k.
    BaseIndices = 3,
    /// Palette of pairs: the two base materials in R and G, a column for each pair, at most 2,048.
    Pairs = 4,
    /// Palette codes: the number of the pair in the lower 11 bits, 31 t of its first base material in the upper 5.
    Codes = 5,
}

/// Format of the texels of a plane. Numbers are little-endian.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SubsurfFormat {
    /// GL_R32F, VK_FORMAT_R32_SFLOAT.
    R32Float = 0,
    /// GL_RGB32F, VK_FORMAT_R32G32B32_SFLOAT; three texels of GL_R32F each, where a device has no such textures.
    Rgb32Float = 1,
    /// GL_RGB16F, VK_FORMAT_R16G16B16_SFLOAT; three texels of GL_R16F each, where a device has no such textures.
    Rgb16Float = 2,
    /// GL_R8, VK_FORMAT_R8_UNORM.
    R8Unorm = 3,
    /// GL_R8UI, VK_FORMAT_R8_UINT.
    R8Uint = 4,
    /// GL_RG8UI, VK_FORMAT_R8G8_UINT.
    Rg8Uint = 5,
    /// GL_R16UI, VK_FORMAT_R16_UINT.
    R16Uint = 6,
}

/// Numbers that APIs have for a format.
struct ApiFormat {
    bytes: u32,
    /// Internal format, format and type of glTexSubImage2D.
    gl: [u32; 3],
    vk: u32,
}

impl SubsurfFormat {
    /// OpenGL ES 3.0, table 3.2; VkFormat.
    fn api(self) -> ApiFormat {
        let [red, rgb, red_integer, rg_integer] = [0x1903, 0x1907, 0x8D94, 0x8228];
        let [float, half_float, unsigned_byte, unsigned_short] = [0x1406, 0x140B, 0x1401, 0x1403];
        match self {
            Self::R32Float => ApiFormat { bytes: 4, gl: [0x822E, red, float], vk: 100 },
            Self::Rgb32Float => ApiFormat { bytes: 12, gl: [0x8815, rgb, float], vk: 106 },
            Self::Rgb16Float => ApiFormat { bytes: 6, gl: [0x881B, rgb, half_float], vk: 90 },
            Self::R8Unorm => ApiFormat { bytes: 1, gl: [0x8229, red, unsigned_byte], vk: 9 },
            Self::R8Uint => ApiFormat { bytes: 1, gl: [0x8232, red_integer, unsigned_byte], vk: 13 },
            Self::Rg8Uint => ApiFormat { bytes: 2, gl: [0x8238, rg_integer, unsigned_byte], vk: 20 },
            Self::R16Uint => ApiFormat { bytes: 2, gl: [0x8234, red_integer, unsigned_short], vk: 74 },
        }
    }
}

/// One plane of a BSSRDF, ready for glTexSubImage2D or 3D, or for a buffer that vkCmdCopyBufferToImage reads.
///
/// Rows follow each other without gaps, and so do layers: set GL_UNPACK_ALIGNMENT to 1, bufferRowLength and bufferImageHeight
/// to 0. Set `struct_size` to `sizeof(SubsurfPlane)` before it is filled.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SubsurfPlane {
    /// Bytes of the caller's struct.
    pub struct_size: u32,
    /// What the numbers are.
    pub kind: SubsurfPlaneKind,
    /// Format of a texel.
    pub format: SubsurfFormat,
    /// Texels in x.
    pub width: u32,
    /// Texels in y.
    pub height: u32,
    /// Layers of an array; 1 where it is a single picture.
    pub layers: u32,
    /// Bytes of a row.
    pub row_bytes: u32,
    /// Internal format for glTexStorage2D.
    pub gl_internal_format: u32,
    /// Format for glTexSubImage2D.
    pub gl_format: u32,
    /// Type for glTexSubImage2D.
    pub gl_type: u32,
    /// VkFormat.
    pub vk_format: u32,
    /// Bytes of a layer.
    pub layer_bytes: u64,
    /// Bytes of all layers.
    pub bytes: u64,
    /// First byte, of any alignment.
    pub data: *const c_void,
}

// SAFETY: `repr(C)`, and the size is first.
unsafe impl Versioned for SubsurfPlane {
    const NAME: &'static str = "SubsurfPlane";
    const FIRST_BYTES: usize = offset_of!(Self, data).wrapping_add(size_of::<*const c_void>());
}

/// Most planes that a model has.
const MOST_PLANES: usize = 3;

/// Bytes of a plane, and what texture they are.
#[derive(Clone, Copy)]
pub(crate) struct Plane<'a> {
    kind: SubsurfPlaneKind,
    format: SubsurfFormat,
    size: [u32; 2],
    layers: u32,
    bytes: &'a [u8],
}

impl Plane<'_> {
    /// Bits of a pixel of the patch; none of tables that all pixels share.
    pub(crate) fn bits_per_pixel(&self) -> u32 {
        match self.kind {
            SubsurfPlaneKind::BaseProfiles | SubsurfPlaneKind::Pairs => 0,
            _ => self.format.api().bytes.wrapping_mul(8).wrapping_mul(self.layers),
        }
    }

    fn described(&self) -> SubsurfPlane {
        let ApiFormat { bytes, gl: [gl_internal_format, gl_format, gl_type], vk: vk_format } = self.format.api();
        let [width, height] = self.size;
        // At most 65,536 texels of 12 bytes.
        let row_bytes = width.wrapping_mul(bytes);
        SubsurfPlane {
            struct_size: 0,
            kind: self.kind,
            format: self.format,
            width,
            height,
            layers: self.layers,
            row_bytes,
            gl_internal_format,
            gl_format,
            gl_type,
            vk_format,
            layer_bytes: u64::from(row_bytes).wrapping_mul(height.into()),
            bytes: self.bytes.len() as u64,
            data: self.bytes.as_ptr().cast(),
        }
    }
}

/// Planes of a material, in the order of the file format.
pub(crate) fn planes<'a>(material: &Bssrdf<'a>) -> [Option<Plane<'a>>; MOST_PLANES] {
    use SubsurfFormat as Format;
    use SubsurfPlaneKind as Kind;
    let header = material.header();
    let per_pixel =
        |kind, format, layers, bytes| Some(Plane { kind, format, size: [header.width, header.height], layers, bytes });
    let BaseMaterials { profiles, mixtures } = match material.model() {
        BssrdfModel::BaseMaterials(planes) => *planes,
        BssrdfModel::PerPixel(planes) => {
            let layers = u32::from(header.samples).wrapping_mul(3);
            return [per_pixel(Kind::LocalProfiles, Format::R32Float, layers, planes.profiles.as_bytes()), None, None];
        }
    };
    let (format, bytes) = match profiles {
        Profiles::F32(values) => (Format::Rgb32Float, values.as_bytes()),
        Profiles::F16(values) => (Format::Rgb16Float, values.as_bytes()),
    };
    let size = [header.samples.into(), header.base_materials];
    let profiles = Some(Plane { kind: Kind::BaseProfiles, format, size, layers: 1, bytes });
    let [second, third] = match mixtures {
        Mixtures::One(indices) => [per_pixel(Kind::BaseIndices, Format::R8Uint, 1, indices), None],
        Mixtures::OneOfMany(indices) => [per_pixel(Kind::BaseIndices, Format::R16Uint, 1, indices.as_bytes()), None],
        Mixtures::Two { ratios, indices } => [
            per_pixel(Kind::MixtureRatios, Format::R32Float, 1, ratios.as_bytes()),
            per_pixel(Kind::BaseIndices, Format::Rg8Uint, 1, indices.as_flattened()),
        ],
        Mixtures::TwoSmall { ratios, indices } => [
            per_pixel(Kind::MixtureRatios, Format::R8Unorm, 1, ratios),
            per_pixel(Kind::BaseIndices, Format::Rg8Uint, 1, indices.as_flattened()),
        ],
        Mixtures::Palette { pairs, codes } => {
            let size = [u32::try_from(pairs.len()).unwrap_or(0), 1];
            let bytes = pairs.as_flattened();
            [
                Some(Plane { kind: Kind::Pairs, format: Format::Rg8Uint, size, layers: 1, bytes }),
                per_pixel(Kind::Codes, Format::R16Uint, 1, codes.as_bytes()),
            ]
        }
        Mixtures::Several { ratios, indices, count } => {
            let layers = u32::try_from(count).unwrap_or(0);
            [
                per_pixel(Kind::MixtureRatios, Format::R32Float, layers, ratios.as_bytes()),
                per_pixel(Kind::BaseIndices, Format::R8Uint, layers, indices),
            ]
        }
    };
    [profiles, second, third]
}

/// Plane of a BSSRDF: its bytes as they stand in the file, and the texture that they are.
///
/// `number`: from 0, below `SubsurfBssrdfInfo::planes`. `plane`: filled as far as its `struct_size` reaches.
/// Errors: `INVALID_ARGUMENT`, `WRONG_FAMILY`.
/// Ownership: the struct is the caller's; what `data` points to is as the bytes of `subsurf_file_bytes`.
/// Threads: any.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_bssrdf_plane(
    file: *const SubsurfFile,
    number: u32,
    plane: *mut SubsurfPlane,
) -> SubsurfStatus {
    let fill = || {
        // SAFETY: the caller's handle.
        let planes = planes(&unsafe { SubsurfFile::of(file) }?.bssrdf()?);
        let len = planes.iter().flatten().fold(0_u64, |count, _| count.wrapping_add(1));
        let out_of_range = Failure::OutOfRange { what: "number", value: number.into(), len };
        let found = planes.into_iter().flatten().nth(number as usize).ok_or(out_of_range)?;
        // SAFETY: the caller's struct.
        unsafe { border::fill("plane", plane, found.described()) }
    };
    status_of(fill())
}
