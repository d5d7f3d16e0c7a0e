//! Reader of `.mco` files, as far as R_d(r).

use std::path::Path;

use super::MM;
use super::lines::Lines;
use crate::error::{Error, Result};
use crate::file::text::read_text;

/// MiB of an `.mco` file, at most.
const MAX_MIB: u64 = 256;
/// Rings, at most, as of a simulation.
const MAX_RINGS: usize = 1 << 20;
const EXPECTED: &str = "an .mco file of MCML";

/// Width of a ring in mm, R_d of each in mm⁻² per flux that was sent, and the share R_sp that the surface mirrored, of the `.mco`
/// file at `path`, version 1 or 2. What left beyond the last ring is in it, as MCML has it.
///
/// # Errors
///
/// [`Error::Input`] that names what stands there and what is expected.
pub fn read_rd(path: &Path) -> Result<(f64, Vec<f64>, f64)> {
    let refuse = |found: String| Error::input(path, found, EXPECTED);
    let text = read_text(path, MAX_MIB, EXPECTED)?;
    let mut lines = Lines::new(path, &text);
    let version = lines.next("version A1 or mcmloA2.0")?.word("version A1 or mcmloA2.0")?;
    let (dr_mm, rings) = match version {
        "A1" => {
            lines.skip_to("InParm", "input parameters, InParm")?;
            lines.next("the name of the output file")?;
            lines.next("the number of photons")?;
            let mut widths = lines.next("dz and dr")?;
            widths.number("dz in cm")?;
            let dr = widths.number("dr in cm")?;
            let mut cells = lines.next("numbers of dz, dr and da")?;
            cells.value::<usize>("nz")?;
            (dr * MM, cells.value("nr")?)
        }
        "mcmloA2.0" => {
            // Media, and layers of the run.
            lines.skip_to("end", "the end of media")?;
            lines.skip_to("end", "the end of layers")?;
            lines.next("the kind of source")?;
            lines.next("the source's position")?;
            let mut widths = lines.next("dz, dr and dt")?;
            widths.number("dz in cm")?;
            let dr = widths.number("dr in cm")?;
            let mut cells = lines.next("nz, nr, nt and na")?;
            cells.value::<usize>("nz")?;
            // What was scored stands in the next line, where it may look like the title of a block.
            let rings = cells.value("nr")?;
            lines.next("categories that were scored")?;
            (dr * MM, rings)
        }
        word => return Err(refuse(format!("version {word}"))),
    };
    if !(dr_mm > 0.0 && dr_mm.is_finite() && (1..=MAX_RINGS).contains(&rings)) {
        return Err(refuse(format!("{rings} rings of {dr_mm} mm")));
    }
    lines.skip_to("RAT", "totals: a block RAT")?;
    let mirrored = lines.next("specular reflectance")?.number("specular reflectance")?;
    if !(0.0..1.0).contains(&mirrored) {
        return Err(refuse(format!("a specular reflectance of {mirrored}")));
    }
    lines.skip_to("Rd_r", "R_d of rings: a block Rd_r")?;
    let ring = |_| {
        let value = lines.next("R_d of a ring")?.number("R_d of a ring in cm⁻²")?;
        if value.is_finite() { Ok(value / (MM * MM)) } else { Err(refuse(format!("R_d of {value}"))) }
    };
    let rd = (0..rings).map(ring).collect::<Result<_>>()?;
    Ok((dr_mm, rd, mirrored))
}
