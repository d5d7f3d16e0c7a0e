//! Values of a BSSRDF.

use crate::border;
use crate::failure::{SubsurfStatus, status_of};
use crate::file::SubsurfFile;

/// Diffuse reflectance Rd in mm^-2, linear Rec. 709, of light that enters at one pixel and leaves at another
/// (Yatagawa et al. 2020, eq. 1).
///
/// `x_i`, `y_i`: column and row where light enters; `x_o`, `y_o`: where it leaves. Pixels may lie outside the patch: the addressing
/// mode says what is there. `rd`: three numbers, R, G, B: finite, not negative, 0 outside the window and beyond r_max_mm.
/// Errors: `INVALID_ARGUMENT`, `WRONG_FAMILY`.
/// Ownership: `rd` is the caller's.
/// Threads: any.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_bssrdf_rd(
    file: *const SubsurfFile,
    x_i: i32,
    y_i: i32,
    x_o: i32,
    y_o: i32,
    rd: *mut f32,
) -> SubsurfStatus {
    let evaluate = || {
        // SAFETY: the caller's handle.
        let material = unsafe { SubsurfFile::of(file) }?.bssrdf()?;
        // SAFETY: the caller's three numbers.
        unsafe { border::write("rd", rd.cast(), material.rd([x_i, y_i], [x_o, y_o])) }
    };
    status_of(evaluate())
}

/// Diffuse albedo of a pixel, dimensionless, linear Rec. 709: the sum of Rd * pitch_mm^2 over its window, which takes (2 R + 1)^2
/// evaluations.
///
/// `x`, `y`: column and row, which may lie outside the patch. `albedo`: three numbers, R, G, B, not negative.
/// Errors: `INVALID_ARGUMENT`, `WRONG_FAMILY`.
/// Ownership: `albedo` is the caller's.
/// Threads: any.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_bssrdf_albedo(
    file: *const SubsurfFile,
    x: i32,
    y: i32,
    albedo: *mut f32,
) -> SubsurfStatus {
    let evaluate = || {
        // SAFETY: the caller's handle.
        let material = unsafe { SubsurfFile::of(file) }?.bssrdf()?;
        border::not_null("albedo", albedo)?;
        // SAFETY: the caller's three numbers.
        unsafe { border::write("albedo", albedo.cast(), material.albedo([x, y])) }
    };
    status_of(evaluate())
}
