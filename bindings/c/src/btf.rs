//! Values, lights to look for, and albedo of the texels of a BTF.

use subsurf_decoder::btf::factored::ExpansionBuffers;
use subsurf_decoder::btf::{Evaluate, Texel};
use subsurf_decoder::{Content, NestedBtf};

use crate::border;
use crate::failure::{Failure, SubsurfStatus, status_of};
use crate::file::{Expansion, OpenFile, SubsurfFile};
use crate::info::expansion_bytes;
use crate::memory::Numbers;

/// Texel of a number that the file has.
fn texel(file: &OpenFile, number: u32) -> Result<Texel, Failure<'static>> {
    file.catalog()?;
    let len = file.texels().into();
    let out_of_range = Failure::OutOfRange { what: "texel", value: number.into(), len };
    if number < file.texels() { Ok(Texel::from_number(number)) } else { Err(out_of_range) }
}

/// Codebooks, of which lights are drawn.
fn nested(file: &OpenFile) -> Result<NestedBtf<'static>, Failure<'static>> {
    match file.content() {
        Content::NestedBtf(btf) => Ok(btf),
        other => Err(Failure::Family { found: other.family(), expected: "nested BTF" }),
    }
}

/// Undoes the compression of a factored BTF, into memory of `SubsurfBtfInfo::expansion_bytes`, so that it can be evaluated. Takes some
/// 10 ms. What is expanded, or a nested BTF, stays as it is.
///
/// Errors: `INVALID_ARGUMENT`, `WRONG_FAMILY`, `OUT_OF_MEMORY`. A hostile file may ask for gigabytes: look at `expansion_bytes` first.
/// Ownership: the memory is the file's.
/// Threads: the only one that uses the file.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_btf_expand(file: *mut SubsurfFile) -> SubsurfStatus {
    let expand = || {
        // SAFETY: the caller's handle.
        let open = unsafe { SubsurfFile::of(file) }?;
        open.catalog()?;
        let Content::FactoredBtf(btf) = open.content() else { return Ok(()) };
        if open.expansion().is_some() {
            return Ok(());
        }
        let [table, words, scratch] = [btf.table_len(), btf.words_len(), btf.scratch_len()];
        let memory = Failure::Memory { need_bytes: expansion_bytes(table, words, scratch) };
        let mut table = Numbers::zeros(table).ok_or(memory)?;
        let mut words = Numbers::zeros(words).ok_or(memory)?;
        let mut scratch = Numbers::zeros(scratch).ok_or(memory)?;
        // SAFETY: table and words are kept as long as what borrows them, and their numbers do not move with them; scratch is used
        // up by the call.
        let buffers =
            unsafe { ExpansionBuffers { table: table.slice(), words: words.slice(), scratch: scratch.slice() } };
        let btf = btf.expand(buffers).ok_or(memory)?;
        // SAFETY: the caller's handle, which nothing else uses.
        unsafe { SubsurfFile::expand(file, Expansion { btf, _table: table, _words: words }) }
    };
    status_of(expand())
}

/// Number of a texel, for the functions that take one.
///
/// `material`: from 0, below `SubsurfBtfInfo::materials`; `level`: mipmap level, below `SubsurfBtfMaterial::levels`; `x`, `y`: column and row,
/// which repeat. `*texel_out`: below `SubsurfBtfInfo::texels`; texels of a level follow each other row by row.
/// Errors: `INVALID_ARGUMENT`, `WRONG_FAMILY`.
/// Ownership: `texel_out` is the caller's.
/// Threads: any.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_btf_texel(
    file: *const SubsurfFile,
    material: u32,
    level: u32,
    x: i32,
    y: i32,
    texel_out: *mut u32,
) -> SubsurfStatus {
    let find = || {
        // SAFETY: the caller's handle.
        let catalog = unsafe { SubsurfFile::of(file) }?.catalog()?;
        let found = u8::try_from(level).ok().and_then(|level| catalog.texel(material as usize, level, [x, y]));
        let found = found.ok_or(Failure::NoTexel { material, level })?;
        // SAFETY: the caller's number.
        unsafe { border::write("texel_out", texel_out, found.number()) }
    };
    status_of(find())
}

/// Value of a texel as images have it: pi times the radiance under light of unit irradiance on a plane that faces it, so that white
/// paper has the cosine of the light's angle. For display values (`SubsurfBtfInfo::is_display`) `subsurf_btf_linear` makes it linear.
///
/// `light`, `view`: three numbers, unit vectors towards light and eye: x along the rows, y down the columns, z the normal.
/// `value`: three numbers, R, G, B, not negative; 0 under lights below the horizon.
/// Errors: `INVALID_ARGUMENT`, `WRONG_FAMILY`, `NOT_EXPANDED`.
/// Ownership: `value` is the caller's.
/// Threads: any.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_btf_eval(
    file: *const SubsurfFile,
    texel: u32,
    light: *const f32,
    view: *const f32,
    value: *mut f32,
) -> SubsurfStatus {
    let evaluate = || {
        // SAFETY: the caller's handle.
        let file = unsafe { SubsurfFile::of(file) }?;
        let texel = self::texel(file, texel)?;
        // SAFETY: three numbers each, the caller's.
        let (light, view) = unsafe { (border::read3("light", light)?, border::read3("view", view)?) };
        let found = match (file.content(), file.expansion()) {
            (Content::NestedBtf(btf), _) => btf.eval(texel, light, view),
            (_, Some(btf)) => btf.eval(texel, light, view),
            _ => return Err(Failure::NotExpanded),
        };
        // SAFETY: the caller's three numbers.
        unsafe { border::write("value", value.cast(), found) }
    };
    status_of(evaluate())
}

/// Linear Rec. 709 of a value that `subsurf_btf_eval` gave: `value` and `rgb` are three numbers each, and may be the same.
///
/// Errors: `INVALID_ARGUMENT`, `WRONG_FAMILY`.
/// Ownership: both are the caller's.
/// Threads: any.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_btf_linear(
    file: *const SubsurfFile,
    value: *const f32,
    rgb: *mut f32,
) -> SubsurfStatus {
    let convert = || {
        // SAFETY: the caller's handle.
        let catalog = unsafe { SubsurfFile::of(file) }?.catalog()?;
        // SAFETY: the caller's three numbers.
        let value = unsafe { border::read3("value", value) }?;
        // SAFETY: the caller's three numbers.
        unsafe { border::write("rgb", rgb.cast(), catalog.header().encoding.linear(value)) }
    };
    status_of(convert())
}

/// Light to look for next, for two random numbers: nested BTFs draw lights in proportion to the luma of the texel
/// (Havran et al. 2010, section 5.2).
///
/// `view`: three numbers, a unit vector towards the eye. `random`: two numbers, 0 to 1; the light moves on without jumps as they grow.
/// `light`: three numbers, a unit vector with z >= 0. `*pdf`: density there, per steradian, above 0.
/// Errors: `INVALID_ARGUMENT`, `WRONG_FAMILY` (also of factored BTFs).
/// Ownership: `light` and `pdf` are the caller's.
/// Threads: any.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_btf_sample(
    file: *const SubsurfFile,
    texel: u32,
    view: *const f32,
    random: *const f32,
    light: *mut f32,
    pdf: *mut f32,
) -> SubsurfStatus {
    let draw = || {
        // SAFETY: the caller's handle.
        let file = unsafe { SubsurfFile::of(file) }?;
        let (btf, texel) = (nested(file)?, self::texel(file, texel)?);
        // SAFETY: three numbers and two, the caller's.
        let (view, random) = unsafe { (border::read3("view", view)?, border::read("random", random.cast())?) };
        let sample = btf.sample(texel, view, random);
        border::not_null("pdf", pdf)?;
        // SAFETY: the caller's three numbers and one.
        unsafe {
            border::write("light", light.cast(), sample.light)?;
            border::write("pdf", pdf, sample.pdf)
        }
    };
    status_of(draw())
}

/// Density with which `subsurf_btf_sample` draws a light, per steradian; 0 below the horizon.
///
/// `light`, `view`: three numbers, unit vectors.
/// Errors: `INVALID_ARGUMENT`, `WRONG_FAMILY` (also of factored BTFs).
/// Ownership: `pdf` is the caller's.
/// Threads: any.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_btf_pdf(
    file: *const SubsurfFile,
    texel: u32,
    light: *const f32,
    view: *const f32,
    pdf: *mut f32,
) -> SubsurfStatus {
    let evaluate = || {
        // SAFETY: the caller's handle.
        let file = unsafe { SubsurfFile::of(file) }?;
        let (btf, texel) = (nested(file)?, self::texel(file, texel)?);
        // SAFETY: three numbers each, the caller's.
        let (light, view) = unsafe { (border::read3("light", light)?, border::read3("view", view)?) };
        // SAFETY: the caller's number.
        unsafe { border::write("pdf", pdf, btf.pdf(texel, light, view)) }
    };
    status_of(evaluate())
}

/// Albedo of a texel towards the eye, linear Rec. 709: the radiance that it has under light of radiance 1 from all sides, by some
/// 900 evaluations.
///
/// `view`: three numbers, a unit vector. `albedo`: three numbers, R, G, B, not negative.
/// Errors: `INVALID_ARGUMENT`, `WRONG_FAMILY` (also of factored BTFs).
/// Ownership: `albedo` is the caller's.
/// Threads: any.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_btf_albedo(
    file: *const SubsurfFile,
    texel: u32,
    view: *const f32,
    albedo: *mut f32,
) -> SubsurfStatus {
    let evaluate = || {
        // SAFETY: the caller's handle.
        let file = unsafe { SubsurfFile::of(file) }?;
        let (btf, texel) = (nested(file)?, self::texel(file, texel)?);
        // SAFETY: the caller's three numbers.
        let view = unsafe { border::read3("view", view) }?;
        border::not_null("albedo", albedo)?;
        // SAFETY: the caller's three numbers.
        unsafe { border::write("albedo", albedo.cast(), btf.albedo(texel, view)) }
    };
    status_of(evaluate())
}
