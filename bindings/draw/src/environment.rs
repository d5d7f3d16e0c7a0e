//! Light from all around.

use subsurf_c::SubsurfStatus;
use subsurf_c::shared::{Handle, Kind, not_null, read3, write};
use subsurf_scene::Environment;

use crate::fault::{Fault, Result, call};
use crate::gpu::close;
use crate::input::{array, within};

/// Light from all around, far away; on no device.
///
/// Ownership: `subsurf_environment_*` give one, `subsurf_environment_close` takes it back.
/// Threads: any number at once, but for `subsurf_environment_close`, which needs the handle for itself.
pub struct SubsurfEnvironment {
    /// What is there is a [`Handle`] of [`OpenEnvironment`].
    _opaque: [u8; 0],
}

/// What is behind a handle.
pub(crate) struct OpenEnvironment(pub(crate) Environment);

impl Kind for OpenEnvironment {
    const NAME: &'static str = "SubsurfEnvironment";
    const WORD: u64 = 0x5ab5_0f11_e0be_0003;
}

impl OpenEnvironment {
    /// The environment behind a handle.
    ///
    /// # Safety
    /// As [`Handle::of`] says.
    pub(crate) unsafe fn of<'e>(environment: *const SubsurfEnvironment) -> Result<&'e Self> {
        // SAFETY: the caller's word; what is there is such a handle.
        Ok(unsafe { Handle::<Self>::of("environment", environment.cast()) }?)
    }
}

/// Makes a handle of what `make` gives.
fn create(environment_out: *mut *mut SubsurfEnvironment, make: impl FnOnce() -> Result<Environment>) -> SubsurfStatus {
    call(|| {
        not_null("environment_out", environment_out)?;
        let handle = Handle::create(OpenEnvironment(make()?))?.as_ptr().cast();
        // SAFETY: the caller's pointer, which is not null.
        Ok(unsafe { write("environment_out", environment_out, handle) }?)
    })
}

/// Makes the same light from everywhere.
///
/// `irradiance`: three numbers, R, G, B of linear Rec. 709, 0 to 1e30: what any surface gets. `*environment_out`: the handle; only
/// written on success.
/// Errors: `INVALID_ARGUMENT`, `OUT_OF_MEMORY`.
/// Ownership: the numbers are not needed afterwards.
/// Threads: any.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_environment_uniform(
    irradiance: *const f32,
    environment_out: *mut *mut SubsurfEnvironment,
) -> SubsurfStatus {
    create(environment_out, || {
        // SAFETY: the caller's three numbers.
        let irradiance = unsafe { read3("irradiance", irradiance) }?;
        for channel in irradiance {
            within("irradiance", channel, 0.0..=Environment::BRIGHTEST)?;
        }
        Ok(Environment::uniform(irradiance))
    })
}

/// Makes a photographer's studio without its key light: a large softbox overhead, a strip on the left, a dim floor.
///
/// `*environment_out`: the handle; only written on success.
/// Errors: `INVALID_ARGUMENT`, `OUT_OF_MEMORY`.
/// Threads: any. It takes some milliseconds.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_environment_studio(environment_out: *mut *mut SubsurfEnvironment) -> SubsurfStatus {
    create(environment_out, || Ok(Environment::studio()))
}

/// Makes light of a picture in equirectangular projection: a direction (x, y, z), y up, is seen at u = 1/2 + atan2(x, z) / 2 pi from
/// the left and v = acos(y) / pi from the top.
///
/// `width`, `height`: pixels, 1 to 16,384 each. `radiance`: three numbers for each pixel, R, G, B of linear Rec. 709, 0 to 1e30, row by row
/// from the top. `*environment_out`: the handle; only written on success.
/// Errors: `INVALID_ARGUMENT`, `OUT_OF_MEMORY`.
/// Ownership: the picture is not needed afterwards.
/// Threads: any. It takes milliseconds to seconds, as the picture is large.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_environment_picture(
    width: u32,
    height: u32,
    radiance: *const f32,
    environment_out: *mut *mut SubsurfEnvironment,
) -> SubsurfStatus {
    create(environment_out, || {
        let sides = 1..=16_384;
        if !sides.contains(&width) || !sides.contains(&height) {
            return Err(Fault::invalid(format!("{width} x {height} pixels, expected are 1 to 16384 each")));
        }
        // SAFETY: the caller's numbers.
        let pixels = unsafe { array::<[f32; 3]>("radiance", radiance.cast(), width as usize * height as usize) }?;
        Environment::equirectangular([width, height], &pixels).map_err(|error| Fault::invalid(error.to_string()))
    })
}

/// Closes an environment. Null is ignored, and so is what is no handle.
///
/// Ownership: the handle is gone.
/// Threads: any, once no other uses it.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_environment_close(environment: *mut SubsurfEnvironment) {
    close::<OpenEnvironment, _>(environment);
}
