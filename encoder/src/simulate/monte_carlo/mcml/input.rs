//! Reader of `.mci` files.

use std::path::Path;

use super::lines::Lines;
use super::{MM, Run, Version, scores};
use crate::error::{Error, Result};
use crate::file::text::read_text;
use crate::simulate::monte_carlo::{Axes, Grid, Layer, Quantity, Request, Score, Source, Stack};

/// MiB of an `.mci` file, at most.
const MAX_MIB: u64 = 1;

/// Runs of the `.mci` file at `path`, version 1 or 2.
///
/// # Errors
///
/// [`Error::Input`] that names the line, what stands there and what is expected; [`Error::Request`] for a run that cannot be
/// made.
pub fn read(path: &Path) -> Result<Vec<Run>> {
    let text = read_text(path, MAX_MIB, "an .mci file of at most 1 MiB")?;
    let mut lines = Lines::new(path, &text);
    let mut first = lines.next("version 1.0 or mcmli2.0")?;
    let runs = match first.word("version 1.0 or mcmli2.0")? {
        "mcmli2.0" => version_2(&mut lines)?,
        word if word.parse() == Ok(1.0) => version_1(&mut lines)?,
        word => return Err(first.refuse(word, "version 1.0 or mcmli2.0")),
    };
    for (run, number) in runs.iter().zip(1..) {
        let place = |error| Error::Request(format!("{}: run {number}: {error}", path.display()));
        run.request.check().map_err(place)?;
    }
    Ok(runs)
}

fn version_1(lines: &mut Lines) -> Result<Vec<Run>> {
    let mut runs = Vec::new();
    let count: u32 = lines.next("the number of runs")?.value("the number of runs")?;
    for _ in 0..count {
        let output = lines.next("the name of the output file")?.word("the name of the output file")?.to_owned();
        let packets = lines.next("the number of photons")?.value("the number of photons")?;
        let mut widths = lines.next("dz and dr")?;
        let [dz, dr] = [widths.number("dz in cm")?, widths.number("dr in cm")?];
        let mut cells = lines.next("numbers of dz, dr and da")?;
        let [nz, nr, na] = [cells.value("nz")?, cells.value("nr")?, cells.value("na")?];
        let layers: u32 = lines.next("the number of layers")?.value("the number of layers")?;
        let eta_above = lines.next("n of the medium above")?.number("n of the medium above")?;
        let mut stack = Stack { eta_above, layers: Vec::new(), eta_below: 1.0 };
        for _ in 0..layers {
            let mut line = lines.next("n, mua, mus, g and d of a layer")?;
            stack.layers.push(Layer {
                eta: line.number("n of a layer")?,
                sigma_a: line.number("mua of a layer")? / MM,
                sigma_s: line.number("mus of a layer")? / MM,
                g: line.number("g of a layer")?,
                thickness_mm: line.number("d of a layer")? * MM,
            });
        }
        stack.eta_below = lines.next("n of the medium below")?.number("n of the medium below")?;
        let request = Request {
            stack,
            source: Source::Pencil { z_mm: 0.0 },
            grid: Grid { dr_mm: dr * MM, nr, na, dz_mm: dz * MM, nz, dt_ps: 1.0, nt: 1 },
            scores: scores::V1.iter().filter_map(|name| scores::parse(name)).collect(),
            packets,
            threshold: 1e-4,
            seed: 1,
            ballistic_apart: false,
        };
        runs.push(Run { version: Version::V1, output, media: Vec::new(), request });
    }
    Ok(runs)
}

fn version_2(lines: &mut Lines) -> Result<Vec<Run>> {
    let mut media = Vec::new();
    while !lines.end() {
        let mut line = lines.next("a medium, or end")?;
        let name = line.word("the name of a medium")?;
        let [eta, sigma_a] = [line.number("n of the medium")?, line.number("mua of the medium")? / MM];
        let [sigma_s, g] = [line.number("mus of the medium")? / MM, line.number("g of the medium")?];
        media.push((name.to_owned(), Layer { eta, sigma_a, sigma_s, g, thickness_mm: 0.0 }));
    }
    let mut runs = Vec::new();
    while !lines.end() {
        runs.push(run_of_version_2(lines, &media)?);
    }
    Ok(runs)
}

fn run_of_version_2(lines: &mut Lines, media: &[(String, Layer)]) -> Result<Run> {
    let output = lines.next("the name of the output file")?.word("the name of the output file")?.to_owned();
    let (mut names, mut layers) = (Vec::new(), Vec::new());
    while !lines.end() {
        let mut line = lines.next("a medium and its thickness, or end")?;
        let name = line.word("the name of a medium")?;
        let medium = media.iter().find(|(known, _)| known == name);
        let (_, layer) = medium.ok_or_else(|| line.refuse(name, "the name of a medium from the list above"))?;
        // Those above and below have no thickness.
        let thickness_mm = line.number("the thickness of a layer in cm").map(|cm| cm * MM);
        layers.push((*layer, thickness_mm));
        names.push(name.to_owned());
    }
    let [(above, _), _, .., (below, _)] = &layers[..] else {
        let found = format!("{} media in the geometry of {output}", layers.len());
        return Err(lines.refuse(found, "one above, layers, one below"));
    };
    let ([eta_above, eta_below], count) = ([above.eta, below.eta], layers.len() - 2);
    let inside = layers.into_iter().skip(1).take(count);
    let inside: Result<Vec<Layer>> =
        inside.map(|(layer, thickness)| Ok(Layer { thickness_mm: thickness?, ..layer })).collect();
    let stack = Stack { eta_above, layers: inside?, eta_below };

    let mut line = lines.next("the source: pencil or isotropic")?;
    let kind = line.word("the source: pencil or isotropic")?;
    let source: fn(f64) -> Source = match kind {
        "pencil" => |z_mm| Source::Pencil { z_mm },
        "isotropic" => |z_mm| Source::Isotropic { z_mm },
        _ => return Err(line.refuse(kind, "the source: pencil or isotropic")),
    };
    let source = source(lines.next("z of the source in cm")?.number("z of the source in cm")? * MM);
    let mut widths = lines.next("dz, dr and dt")?;
    let [dz, dr, dt_ps] = [widths.number("dz in cm")?, widths.number("dr in cm")?, widths.number("dt in ps")?];
    let mut cells = lines.next("nz, nr, nt and na")?;
    let [nz, nr, nt, na] = [cells.value("nz")?, cells.value("nr")?, cells.value("nt")?, cells.value("na")?];
    let mut requested = Vec::new();
    let line = lines.next("scores such as Rd_r and A_z")?;
    let number = line.number;
    for name in line.rest() {
        let score = scores::parse(name);
        requested.push(
            score.ok_or_else(|| lines.refuse(format!("{name} in line {number}"), "a score such as Rd_r or A_z"))?,
        );
    }
    // Absorption at first collisions lies on the axis: by depth and time alone.
    if let Some(absorbed) = requested.iter().find(|score| score.quantity == Quantity::Absorbed) {
        let axes = Axes { r: false, ..absorbed.axes };
        requested.push(Score { quantity: Quantity::BallisticAbsorbed, axes });
    }
    let mut control = lines.next("the number of photons")?;
    let packets =
        control.value("the number of photons (a time limit is not enough: results would differ from run to run)")?;
    let threshold = lines.next("the threshold weight")?.number("the threshold weight")?;
    let seed = lines.next("the random number seed")?.value("the random number seed")?;
    let grid = Grid { dr_mm: dr * MM, nr, na, dz_mm: dz * MM, nz, dt_ps, nt };
    let request = Request { stack, source, grid, scores: requested, packets, threshold, seed, ballistic_apart: true };
    Ok(Run { version: Version::V2, output, media: names, request })
}
