//! Descriptions of files: family, sizes, units.

use core::ffi::c_char;
use core::mem::offset_of;

use subsurf_decoder::bssrdf::{Addressing, Coding};
use subsurf_decoder::btf::ColourEncoding;
use subsurf_decoder::{Content, Family};

use crate::border::{self, Versioned};
use crate::failure::{Failure, SubsurfStatus, status_of};
use crate::file::SubsurfFile;
use crate::plane;

/// What a file holds, which says what functions take it.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SubsurfFamily {
    /// Of a kind that this header does not know.
    Other = 0,
    /// Diffuse BSSRDF of a patch: `subsurf_bssrdf_*`.
    Bssrdf = 1,
    /// Bidirectional texture functions in nested codebooks: `subsurf_btf_*`.
    NestedBtf = 2,
    /// Bidirectional texture functions as factors: `subsurf_btf_*`, after `subsurf_btf_expand`.
    FactoredBtf = 3,
    /// Separable kernel of a homogeneous material.
    Kernel = 4,
}

/// What lies beyond the border of a patch.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SubsurfAddressing {
    /// The border pixel goes on: GL_CLAMP_TO_EDGE.
    Clamp = 0,
    /// The patch repeats: GL_REPEAT.
    Repeat = 1,
    /// The patch repeats, every other copy reflected: GL_MIRRORED_REPEAT.
    Mirror = 2,
}

/// Encoding of the mixtures of a patch.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SubsurfCoding {
    /// Single-precision ratios, and an index for each base material of a pixel.
    Exact = 0,
    /// Two base materials, the ratio in 8 bits: 24 bits per pixel.
    SmallRatios = 1,
    /// Two base materials by a palette of pairs, the ratio in 5 bits: 16 bits per pixel.
    Palette = 2,
}

/// Description of a file of any family. Set `struct_size` to `sizeof(SubsurfFileInfo)` before it is filled.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SubsurfFileInfo {
    /// Bytes of the caller's struct.
    pub struct_size: u32,
    /// What the file holds.
    pub family: SubsurfFamily,
    /// Bytes of the file.
    pub file_bytes: u64,
}

/// Description of a BSSRDF. Set `struct_size` to `sizeof(SubsurfBssrdfInfo)` before it is filled.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SubsurfBssrdfInfo {
    /// Bytes of the caller's struct.
    pub struct_size: u32,
    /// K, the number of base materials of a pixel: 1, 2, 3 or 5; 0 where each pixel has a profile of its own.
    pub bases_per_pixel: u32,
    /// Encoding of mixtures; `EXACT` but for K = 2.
    pub coding: SubsurfCoding,
    /// What lies beyond the border.
    pub addressing: SubsurfAddressing,
    /// Pixels in x, 1 to 65,535.
    pub width: u32,
    /// Pixels in y, 1 to 65,535.
    pub height: u32,
    /// R in pixels: Rd is 0 between pixels further apart in x or in y; at most 1,023.
    pub window_radius: u32,
    /// S, the nodes of a profile, 2 to 4,096; node h is at r = h * r_max_mm / (S - 1).
    pub samples: u32,
    /// M, the number of base materials, 1 to 65,536; 0 where each pixel has a profile of its own.
    pub base_materials: u32,
    /// Bits that a pixel takes, 16 to 200; 96 S where it has a profile of its own.
    pub bits_per_pixel: u32,
    /// Number of planes that `subsurf_bssrdf_plane` gives.
    pub planes: u32,
    /// Distance of neighbouring pixels in mm.
    pub pitch_mm: f32,
    /// Radius of the last node in mm; Rd is 0 beyond it.
    pub r_max_mm: f32,
    /// Refractive index of the material against air, 1 to 4.
    pub eta: f32,
}

/// Description of a BTF. Set `struct_size` to `sizeof(SubsurfBtfInfo)` before it is filled.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SubsurfBtfInfo {
    /// Bytes of the caller's struct.
    pub struct_size: u32,
    /// Number of materials, 1 to 255.
    pub materials: u32,
    /// Number of texels of all levels of all materials.
    pub texels: u32,
    /// Whether values are display values of sRGB, 0 to 1; else they are linear.
    pub is_display: u32,
    /// Nodes of alpha, 2 to 64, from -alpha_max to alpha_max.
    pub n_alpha: u32,
    /// Nodes of sin beta, 2 to 64, from -sin_beta_max to sin_beta_max.
    pub n_beta: u32,
    /// Nodes of the view's angle from the normal, 2 to 64, from 0 to theta_max.
    pub n_theta: u32,
    /// Nodes of the view's azimuth, 1 to 64, once around.
    pub n_phi: u32,
    /// Largest alpha in rad, to pi / 2.
    pub alpha_max: f32,
    /// Largest sin beta, to 1.
    pub sin_beta_max: f32,
    /// Largest angle of the view from the normal in rad, to pi / 2.
    pub theta_max: f32,
    /// Cosine of the angle between the normal and the lowest light that was measured; lower ones fade to black.
    pub cos_light_min: f32,
    /// Bytes that `subsurf_btf_expand` takes from the heap; 0 where it takes none.
    pub expansion_bytes: u64,
}

/// One material of a BTF. Set `struct_size` to `sizeof(SubsurfBtfMaterial)` before it is filled.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SubsurfBtfMaterial {
    /// Bytes of the caller's struct.
    pub struct_size: u32,
    /// Texels in x of level 0, 1 to 65,535.
    pub width: u32,
    /// Texels in y of level 0, 1 to 65,535.
    pub height: u32,
    /// Mipmap levels, 1 to 16; each is half as large as the one before it, rounded down, and at least one texel.
    pub levels: u32,
    /// Name in UTF-8, zero-terminated; at most 24 bytes.
    pub name: [c_char; 32],
}

// SAFETY: `repr(C)`, and the size is first.
unsafe impl Versioned for SubsurfFileInfo {
    const NAME: &'static str = "SubsurfFileInfo";
    const FIRST_BYTES: usize = offset_of!(Self, file_bytes).wrapping_add(size_of::<u64>());
}

// SAFETY: `repr(C)`, and the size is first.
unsafe impl Versioned for SubsurfBssrdfInfo {
    const NAME: &'static str = "SubsurfBssrdfInfo";
    const FIRST_BYTES: usize = offset_of!(Self, eta).wrapping_add(size_of::<f32>());
}

// SAFETY: `repr(C)`, and the size is first.
unsafe impl Versioned for SubsurfBtfInfo {
    const NAME: &'static str = "SubsurfBtfInfo";
    const FIRST_BYTES: usize = offset_of!(Self, expansion_bytes).wrapping_add(size_of::<u64>());
}

// SAFETY: `repr(C)`, and the size is first.
unsafe impl Versioned for SubsurfBtfMaterial {
    const NAME: &'static str = "SubsurfBtfMaterial";
    const FIRST_BYTES: usize = offset_of!(Self, name).wrapping_add(size_of::<[c_char; 32]>());
}

/// Family and size of a file.
///
/// `info`: filled as far as its `struct_size` reaches.
/// Errors: `INVALID_ARGUMENT`.
/// Ownership: the struct is the caller's.
/// Threads: any.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_file_info(file: *const SubsurfFile, info: *mut SubsurfFileInfo) -> SubsurfStatus {
    let fill = || {
        // SAFETY: the caller's handle.
        let file = unsafe { SubsurfFile::of(file) }?;
        let family = match file.content().family() {
            Family::Bssrdf => SubsurfFamily::Bssrdf,
            Family::NestedBtf => SubsurfFamily::NestedBtf,
            Family::FactoredBtf => SubsurfFamily::FactoredBtf,
            Family::Kernel => SubsurfFamily::Kernel,
            _ => SubsurfFamily::Other,
        };
        let file_bytes = file.file().container().file().len() as u64;
        // SAFETY: the caller's struct.
        unsafe { border::fill("info", info, SubsurfFileInfo { struct_size: 0, family, file_bytes }) }
    };
    status_of(fill())
}

/// Size, units and model of a BSSRDF.
///
/// `info`: filled as far as its `struct_size` reaches.
/// Errors: `INVALID_ARGUMENT`, `WRONG_FAMILY`.
/// Ownership: the struct is the caller's.
/// Threads: any.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_bssrdf_info(file: *const SubsurfFile, info: *mut SubsurfBssrdfInfo) -> SubsurfStatus {
    let fill = || {
        // SAFETY: the caller's handle.
        let material = unsafe { SubsurfFile::of(file) }?.bssrdf()?;
        let header = material.header();
        let planes = plane::planes(&material);
        let value = SubsurfBssrdfInfo {
            struct_size: 0,
            bases_per_pixel: header.model.into(),
            coding: match header.coding {
                Coding::Exact => SubsurfCoding::Exact,
                Coding::SmallRatios => SubsurfCoding::SmallRatios,
                Coding::Palette => SubsurfCoding::Palette,
            },
            addressing: match header.addressing {
                Addressing::Clamp => SubsurfAddressing::Clamp,
                Addressing::Repeat => SubsurfAddressing::Repeat,
                Addressing::Mirror => SubsurfAddressing::Mirror,
            },
            width: header.width,
            height: header.height,
            window_radius: header.window_radius.into(),
            samples: header.samples.into(),
            base_materials: header.base_materials,
            bits_per_pixel: planes.iter().flatten().fold(0, |bits, plane| bits.wrapping_add(plane.bits_per_pixel())),
            planes: planes.iter().flatten().fold(0, |count, _| count.wrapping_add(1)),
            pitch_mm: header.pitch_mm,
            r_max_mm: header.r_max_mm,
            eta: header.eta,
        };
        // SAFETY: the caller's struct.
        unsafe { border::fill("info", info, value) }
    };
    status_of(fill())
}

/// Materials, directions and values of a BTF.
///
/// `info`: filled as far as its `struct_size` reaches.
/// Errors: `INVALID_ARGUMENT`, `WRONG_FAMILY`.
/// Ownership: the struct is the caller's.
/// Threads: any.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_btf_info(file: *const SubsurfFile, info: *mut SubsurfBtfInfo) -> SubsurfStatus {
    let fill = || {
        // SAFETY: the caller's handle.
        let file = unsafe { SubsurfFile::of(file) }?;
        let catalog = file.catalog()?;
        let (header, grid) = (catalog.header(), catalog.grid());
        let expansion_bytes = match file.content() {
            Content::FactoredBtf(btf) => expansion_bytes(btf.table_len(), btf.words_len(), btf.scratch_len()),
            _ => 0,
        };
        let value = SubsurfBtfInfo {
            struct_size: 0,
            materials: header.materials.into(),
            texels: file.texels(),
            is_display: u32::from(matches!(header.encoding, ColourEncoding::Display { .. })),
            n_alpha: grid.n_alpha.into(),
            n_beta: grid.n_beta.into(),
            n_theta: grid.n_theta.into(),
            n_phi: grid.n_phi.into(),
            alpha_max: grid.alpha_max,
            sin_beta_max: grid.sin_beta_max,
            theta_max: grid.theta_max,
            cos_light_min: grid.cos_light_min,
            expansion_bytes,
        };
        // SAFETY: the caller's struct.
        unsafe { border::fill("info", info, value) }
    };
    status_of(fill())
}

/// Bytes of the buffers of an expansion.
pub(crate) fn expansion_bytes(table: usize, words: usize, scratch: usize) -> u64 {
    let bytes = |count: usize, each: usize| count.saturating_mul(each) as u64;
    let words = bytes(words, size_of::<i16>());
    bytes(table, size_of::<i8>()).saturating_add(words).saturating_add(bytes(scratch, size_of::<f32>()))
}

/// Name and size of a material of a BTF.
///
/// `number`: from 0, below `SubsurfBtfInfo::materials`. `material`: filled as far as its `struct_size` reaches.
/// Errors: `INVALID_ARGUMENT`, `WRONG_FAMILY`.
/// Ownership: the struct is the caller's.
/// Threads: any.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_btf_material(
    file: *const SubsurfFile,
    number: u32,
    material: *mut SubsurfBtfMaterial,
) -> SubsurfStatus {
    let fill = || {
        // SAFETY: the caller's handle.
        let catalog = unsafe { SubsurfFile::of(file) }?.catalog()?;
        let len = catalog.header().materials.into();
        let out_of_range = Failure::OutOfRange { what: "number", value: number.into(), len };
        let found = catalog.materials().nth(number as usize).ok_or(out_of_range)?;
        let mut name = [0; 32];
        for (place, byte) in name.iter_mut().zip(found.name().bytes()) {
            *place = c_char::from_ne_bytes([byte]);
        }
        let value = SubsurfBtfMaterial {
            struct_size: 0,
            width: found.width.into(),
            height: found.height.into(),
            levels: found.levels.into(),
            name,
        };
        // SAFETY: the caller's struct.
        unsafe { border::fill("material", material, value) }
    };
    status_of(fill())
}
