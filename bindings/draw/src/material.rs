//! Materials on a device.

use std::mem::offset_of;
use std::sync::Arc;
use std::time::Duration;

use subsurf_c::shared::{Failure, Handle, Kind, Versioned, fill, not_null, write};
use subsurf_c::{SubsurfFile, SubsurfStatus};
use subsurf_decoder::{Content, File};
use subsurf_runtime::{Load, LoadTimes, Material, Technique};

use crate::fault::{Fault, Result, call};
use crate::gpu::{OpenGpu, SubsurfGpu, close};
use crate::input::{fillable, one_of, take};

/// Technique by which a material is drawn.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SubsurfTechnique {
    /// The fastest that the file offers: separable blurs where it has a basis for them, else splats; BTFs and kernels as they are.
    Automatic = 0,
    /// Multiresolution splats, of BSSRDFs: closer to the reference in most scenes, and slower.
    Splat = 1,
    /// Separable blurs on the screen, of BSSRDFs whose file has a basis for them.
    Separable = 2,
    /// BTFs.
    Btf = 3,
    /// Separable kernels of homogeneous materials.
    Kernel = 4,
}

/// Material on a device: what was uploaded of a file.
///
/// Ownership: `subsurf_material_load` gives one, `subsurf_material_close` takes it back; it keeps its device, not its file.
/// Threads: any number at once, but for `subsurf_material_close`, which needs the handle for itself.
pub struct SubsurfMaterial {
    /// What is there is a [`Handle`] of [`OpenMaterial`].
    _opaque: [u8; 0],
}

/// How a material is loaded. Set `struct_size` to `sizeof(SubsurfMaterialOptions)`; zeros are the usual choice.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SubsurfMaterialOptions {
    /// Bytes of the caller's struct.
    pub struct_size: u32,
    /// A `SubsurfTechnique`.
    pub technique: u32,
}

/// What a load took. Set `struct_size` to `sizeof(SubsurfLoadReport)` before it is filled. Reading and checking of the file are done
/// when it is opened.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SubsurfLoadReport {
    /// Bytes of the caller's struct.
    pub struct_size: u32,
    /// Bytes of the file.
    pub file_bytes: u64,
    /// Bytes of the material on the device.
    pub gpu_bytes: u64,
    /// Nanoseconds of the upload, until the device has everything.
    pub upload_ns: u64,
    /// Nanoseconds of pipelines that the load compiled: none but at the first load of a kind.
    pub pipelines_ns: u64,
    /// Nanoseconds of the processor for what is drawn at load: coefficients and albedo, from the planes of the file.
    pub recording_ns: u64,
    /// Nanoseconds of the same until the device has done it, with those of the processor.
    pub projection_ns: u64,
}

/// Description of a material. Set `struct_size` to `sizeof(SubsurfMaterialInfo)` before it is filled.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SubsurfMaterialInfo {
    /// Bytes of the caller's struct.
    pub struct_size: u32,
    /// Technique that draws it, never `AUTOMATIC`.
    pub technique: SubsurfTechnique,
    /// Number of materials of a BTF; 1 for others.
    pub materials: u32,
    /// Bytes on the device.
    pub gpu_bytes: u64,
}

// SAFETY: `repr(C)`, and the size is first.
unsafe impl Versioned for SubsurfMaterialOptions {
    const NAME: &'static str = "SubsurfMaterialOptions";
    const FIRST_BYTES: usize = offset_of!(Self, technique) + size_of::<u32>();
}

// SAFETY: `repr(C)`, and the size is first.
unsafe impl Versioned for SubsurfLoadReport {
    const NAME: &'static str = "SubsurfLoadReport";
    const FIRST_BYTES: usize = offset_of!(Self, projection_ns) + size_of::<u64>();
}

// SAFETY: `repr(C)`, and the size is first.
unsafe impl Versioned for SubsurfMaterialInfo {
    const NAME: &'static str = "SubsurfMaterialInfo";
    const FIRST_BYTES: usize = offset_of!(Self, gpu_bytes) + size_of::<u64>();
}

/// What is behind a handle.
pub(crate) struct OpenMaterial {
    pub(crate) gpu: OpenGpu,
    material: Material,
    materials: u32,
    /// Shared with nobody: who remembers it weakly learns that the handle was closed.
    pub(crate) alive: Arc<()>,
}

impl Kind for OpenMaterial {
    const NAME: &'static str = "SubsurfMaterial";
    const WORD: u64 = 0x5ab5_0f11_e0be_0004;
}

impl OpenMaterial {
    /// The material behind a handle.
    ///
    /// # Safety
    /// As [`Handle::of`] says.
    pub(crate) unsafe fn of<'m>(material: *const SubsurfMaterial) -> Result<&'m Self> {
        // SAFETY: the caller's word; what is there is such a handle.
        Ok(unsafe { Handle::<Self>::of("material", material.cast()) }?)
    }

    /// Material of a number, from 0: of a BTF there may be several.
    pub(crate) fn number(&self, number: u32) -> Result<Material> {
        if number >= self.materials {
            let len = self.materials.into();
            return Err(Failure::OutOfRange { what: "number", value: number.into(), len }.into());
        }
        Ok(match &self.material {
            Material::Btf(material, _) => Material::Btf(material.clone(), number as usize),
            other => other.clone(),
        })
    }
}

/// Begins to load a file for a technique.
fn begin<'a>(gpu: &'a OpenGpu, file: &File<'a>, technique: SubsurfTechnique) -> Result<Load<'a>> {
    let wrong = |expected| Fault::from(Failure::Family { found: file.content().family(), expected });
    let load = match (technique, file.content()) {
        // What this library knows, whatever the renderer of the build does.
        (_, content) if !matches!(content, Content::Bssrdf(_) | Content::NestedBtf(_) | Content::Kernel(_)) => {
            return Err(wrong("BSSRDF, nested BTF or kernel"));
        }
        (SubsurfTechnique::Kernel, Content::Bssrdf(_) | Content::NestedBtf(_)) => return Err(wrong("kernel")),
        (SubsurfTechnique::Btf, Content::Bssrdf(_) | Content::Kernel(_)) => return Err(wrong("nested BTF")),
        (SubsurfTechnique::Splat | SubsurfTechnique::Separable, Content::NestedBtf(_) | Content::Kernel(_)) => {
            return Err(wrong("BSSRDF"));
        }
        (SubsurfTechnique::Splat, Content::Bssrdf(material)) => {
            Load::splat(&gpu.gpu, &material).map(|load| load.map(Material::Splat))
        }
        (SubsurfTechnique::Separable, Content::Bssrdf(material)) if material.basis().is_none() => {
            let text = "the file has no basis for separable blurs: subsurf encode --add-basis".to_owned();
            return Err(Fault::Told(SubsurfStatus::WrongFamily, text));
        }
        _ => Load::new(&gpu.gpu, file),
    };
    gpu.told(load)
}

/// Loads an open file onto a device: hands its bytes over where they are, without a copy, and draws from them what the technique needs.
///
/// `options`: null for the usual choice. `report`: filled as far as its `struct_size` reaches; with one the load waits for the device after
/// every phase, with null for nothing. `*material_out`: the handle; only written on success.
/// Errors: `INVALID_ARGUMENT`, `WRONG_FAMILY` (factored BTFs are not drawn; a technique for other files), `UNSUPPORTED`, `DEVICE_LOST`,
/// `DEVICE_FAILED`, `OUT_OF_MEMORY`.
/// Ownership: the file stays the caller's, and may be closed at once; so are the structs.
/// Threads: any, also while another draws.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_material_load(
    gpu: *const SubsurfGpu,
    file: *const SubsurfFile,
    options: *const SubsurfMaterialOptions,
    report: *mut SubsurfLoadReport,
    material_out: *mut *mut SubsurfMaterial,
) -> SubsurfStatus {
    call(|| {
        // SAFETY: the caller's handles.
        let (gpu, file) = unsafe { (OpenGpu::of(gpu)?, SubsurfFile::of(file)?.file()) };
        not_null("material_out", material_out)?;
        // SAFETY: the caller's struct.
        unsafe { fillable("report", report.cast_const()) }?;
        let usual = SubsurfMaterialOptions { struct_size: 0, technique: 0 };
        // SAFETY: the caller's struct, of numbers.
        let options = if options.is_null() { usual } else { unsafe { take("options", options, usual) }? };
        let techniques = [
            SubsurfTechnique::Automatic,
            SubsurfTechnique::Splat,
            SubsurfTechnique::Separable,
            SubsurfTechnique::Btf,
            SubsurfTechnique::Kernel,
        ];
        let load = begin(gpu, file, one_of("technique", options.technique, &techniques)?)?;
        let materials = match file.content() {
            Content::NestedBtf(btf) => btf.catalog().header().materials.into(),
            _ => 1,
        };
        let material = if report.is_null() {
            gpu.told(load.finish())?
        } else {
            let mut times = LoadTimes::default();
            let material = gpu.told(load.finish_timed(&mut times))?;
            let value = SubsurfLoadReport {
                struct_size: 0,
                file_bytes: file.container().file().len() as u64,
                gpu_bytes: material.gpu_bytes(),
                upload_ns: nanoseconds(times.upload),
                pipelines_ns: nanoseconds(times.pipelines),
                recording_ns: nanoseconds(times.recording),
                projection_ns: nanoseconds(times.projection),
            };
            // SAFETY: the caller's struct.
            unsafe { fill("report", report, value) }?;
            material
        };
        let open = OpenMaterial { gpu: gpu.clone(), material, materials, alive: Arc::new(()) };
        let handle = Handle::create(open)?.as_ptr().cast();
        // SAFETY: the caller's pointer, which is not null.
        Ok(unsafe { write("material_out", material_out, handle) }?)
    })
}

/// A duration as the header has it.
pub(crate) fn nanoseconds(time: Duration) -> u64 {
    u64::try_from(time.as_nanos()).unwrap_or(u64::MAX)
}

/// What a material is.
///
/// `info`: filled as far as its `struct_size` reaches.
/// Errors: `INVALID_ARGUMENT`.
/// Ownership: the struct is the caller's.
/// Threads: any.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_material_info(
    material: *const SubsurfMaterial,
    info: *mut SubsurfMaterialInfo,
) -> SubsurfStatus {
    call(|| {
        // SAFETY: the caller's handle.
        let open = unsafe { OpenMaterial::of(material) }?;
        let technique = match open.material.technique() {
            Technique::Splat(_) => SubsurfTechnique::Splat,
            Technique::Separable(_) => SubsurfTechnique::Separable,
            Technique::Btf(_) => SubsurfTechnique::Btf,
            Technique::Kernel => SubsurfTechnique::Kernel,
            // The gather, which no call loads; and LinSSS, which the runtime has where a crate of the build asks for its feature
            // `reference`, so that no arm can name it here. A technique that is new says so before anyone takes it for another.
            other => {
                let text = format!("a material drawn by {other:?}, which has no SubsurfTechnique");
                return Err(Fault::Told(SubsurfStatus::Unsupported, text));
            }
        };
        let (materials, gpu_bytes) = (open.materials, open.material.gpu_bytes());
        // SAFETY: the caller's struct.
        Ok(unsafe { fill("info", info, SubsurfMaterialInfo { struct_size: 0, technique, materials, gpu_bytes }) }?)
    })
}

/// Closes a material. Null is ignored, and so is what is no handle.
///
/// Ownership: the handle is gone; what is on the device goes with the next frame of the renderers that drew it.
/// Threads: any, once no other uses the handle.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_material_close(material: *mut SubsurfMaterial) {
    close::<OpenMaterial, _>(material);
}
