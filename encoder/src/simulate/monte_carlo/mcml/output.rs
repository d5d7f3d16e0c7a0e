//! Writer of `.mco` files.

use std::fmt::Write as _;

use super::{MM, Run, Version, scores};
use crate::simulate::monte_carlo::{Axes, Estimate, Grid, Outcome, Quantity, Source, Tally};

/// The text of a run's `.mco` file, of the version of its `.mci` file.
#[must_use]
pub fn write(run: &Run, outcome: &Outcome) -> String {
    let mut text = String::new();
    match run.version {
        Version::V1 => version_1(&mut text, run, outcome),
        Version::V2 => version_2(&mut text, run, outcome),
    }
    .expect("a string takes everything");
    text
}

fn version_1(text: &mut String, run: &Run, outcome: &Outcome) -> std::fmt::Result {
    let Grid { dr_mm, nr, na, dz_mm, nz, .. } = run.request.grid;
    let stack = &run.request.stack;
    writeln!(text, "A1 \t# Version number of the file format.\n")?;
    writeln!(text, "InParm \t\t\t# Input parameters. cm is used.")?;
    writeln!(text, "{} \tA\t\t# output file name, ASCII.", run.output)?;
    writeln!(text, "{} \t\t\t# No. of photons", outcome.packets)?;
    writeln!(text, "{}\t{}\t\t# dz, dr [cm]", short(dz_mm / MM), short(dr_mm / MM))?;
    writeln!(text, "{nz}\t{nr}\t{na}\t\t# No. of dz, dr, da.\n")?;
    writeln!(text, "{}\t\t\t\t\t# Number of layers", stack.layers.len())?;
    writeln!(text, "#n\tmua\tmus\tg\td\t# One line for each layer")?;
    writeln!(text, "{}\t\t\t\t\t# n for medium above", stack.eta_above)?;
    for (k, layer) in stack.layers.iter().enumerate() {
        let numbers = [layer.eta, layer.sigma_a * MM, layer.sigma_s * MM, layer.g, layer.thickness_mm / MM].map(short);
        writeln!(text, "{}\t# layer {}", numbers.join("\t"), k + 1)?;
    }
    writeln!(text, "{}\t\t\t\t\t# n for medium below\n", stack.eta_below)?;
    writeln!(text, "RAT #Reflectance, absorption, transmission.")?;
    let totals = [
        (outcome.specular, "Specular reflectance"),
        (outcome.reflected.mean, "Diffuse reflectance"),
        (outcome.absorbed.mean, "Absorbed fraction"),
        (outcome.transmitted.mean, "Transmittance"),
    ];
    for (value, name) in totals {
        writeln!(text, "{:<14} \t#{name} [-]", short(value))?;
    }
    writeln!(text, "\nA_l #Absorption as a function of layer. [-]")?;
    for share in &outcome.layers {
        writeln!(text, "{:12}", short(*share))?;
    }
    outcome.tallies.iter().try_for_each(|tally| block(text, run.version, outcome.packets, tally))
}

fn version_2(text: &mut String, run: &Run, outcome: &Outcome) -> std::fmt::Result {
    let request = &run.request;
    let Grid { dr_mm, nr, na, dz_mm, nz, dt_ps, nt } = request.grid;
    writeln!(text, "mcmloA2.0 \t# Version number of the file format.\n\nmcmli2.0 \t\t\t# file version\n")?;
    writeln!(text, "# Specify media\n#\tname\t\tn\tmua\tmus\tg")?;
    let stack = &request.stack;
    let clear = |eta| [eta, 0.0, 0.0, 0.0];
    let inside = stack.layers.iter().map(|layer| [layer.eta, layer.sigma_a * MM, layer.sigma_s * MM, layer.g]);
    let all = std::iter::once(clear(stack.eta_above)).chain(inside).chain([clear(stack.eta_below)]);
    let mut seen: Vec<&str> = Vec::new();
    for (name, numbers) in run.media.iter().zip(all) {
        if !seen.contains(&name.as_str()) {
            seen.push(name);
            writeln!(text, "\t{name} \t\t{}", numbers.map(short).join("\t"))?;
        }
    }
    writeln!(text, "end #of media\n\n# Specify data for run 1\n{} \tA\t\t\t# output file name, format.\n", run.output)?;
    writeln!(text, "# \tmedium \t\tthickness")?;
    for (k, name) in run.media.iter().enumerate() {
        let layer = k.checked_sub(1).and_then(|k| stack.layers.get(k));
        let thickness = layer.map(|layer| short(layer.thickness_mm / MM)).unwrap_or_default();
        writeln!(text, "\t{name} \t{thickness}")?;
    }
    let (kind, z_mm) = match request.source {
        Source::Pencil { z_mm } => ("pencil", z_mm),
        Source::Isotropic { z_mm } => ("isotropic", z_mm),
    };
    writeln!(text, "end #of layers\n\n{kind} \t\t\t\t\t# src type: pencil/isotropic.")?;
    writeln!(text, "{}\t\t\t\t\t# starting position of source.\n", short(z_mm / MM))?;
    writeln!(text, "{}\t{}\t{dt_ps}\t\t\t# dz, dr, dt.", short(dz_mm / MM), short(dr_mm / MM))?;
    writeln!(text, "{nz}\t{nr}\t{nt}\t{na}\t\t# nz, nr, nt, na.\n")?;
    let asked = request.scores.iter().filter(|score| score.quantity != Quantity::BallisticAbsorbed);
    let names: Vec<String> = asked.map(|score| scores::name(*score, run.version)).collect();
    writeln!(text, "# This simulation will score the following categories:\n{}\n", names.join(" \t"))?;
    writeln!(text, "{} \t\t\t\t# no. of photons", outcome.packets)?;
    writeln!(text, "{}\t\t\t\t\t# threshold weight.", request.threshold)?;
    writeln!(text, "{}\t\t\t\t\t# random number seed.\nend #of runs\n", request.seed)?;
    writeln!(text, "RAT #Reflectance, absorption, transmittance.\n# Average \tStandard Err \tRel Err")?;
    writeln!(text, "{:<14} \t\t\t\t#Rsp: Specular reflectance.", short(outcome.specular))?;
    // MCML counts what is mirrored at the top with what comes back unscattered.
    let mirrored = outcome.ballistic_reflected.mean + outcome.specular;
    let totals = [
        (Estimate { mean: mirrored, ..outcome.ballistic_reflected }, "Rb: Ballistic reflectance"),
        (outcome.reflected, "Rd: Diffuse reflectance"),
        (outcome.absorbed, "A:  Absorbed fraction"),
        (outcome.ballistic_transmitted, "Tb: Ballistic transmittance"),
        (outcome.transmitted, "Td: Diffuse transmittance"),
    ];
    for (Estimate { mean, standard_error }, name) in totals {
        let relative = if mean > 0.0 { 100.0 * standard_error / mean } else { 0.0 };
        writeln!(text, "{:<14} \t{:<14} {relative:6.2}%\t#{name}.", short(mean), short(standard_error))?;
    }
    outcome.tallies.iter().try_for_each(|tally| block(text, run.version, outcome.packets, tally))
}

/// A score's densities in cm, its name before them: one to a line where it has one axis, five where it has several, the last
/// axis the fastest. What lies beyond the grid is in the last cells, as MCML has it.
fn block(text: &mut String, version: Version, packets: u64, tally: &Tally) -> std::fmt::Result {
    let Axes { r, a, z, t } = tally.score.axes;
    let axes = u32::from(r) + u32::from(a) + u32::from(z) + u32::from(t);
    let name = scores::name(tally.score, version);
    writeln!(text, "\n{name} #{}", scores::unit(tally.score))?;
    let to_cm = MM.powi(2 * i32::from(r) + i32::from(z));
    for (k, density) in folded(tally, packets).into_iter().enumerate() {
        let value = scientific(density * to_cm);
        match axes {
            1 => writeln!(text, "{value:>12}")?,
            _ => write!(text, "{value:>12}{}", if k % 5 == 4 { " \n" } else { " " })?,
        }
    }
    writeln!(text)
}

/// Densities in the grid's cells, with what lies beyond in the last of them.
fn folded(tally: &Tally, packets: u64) -> Vec<f64> {
    let Axes { r, z, t, .. } = tally.score.axes;
    let shape = tally.shape();
    let inside = [shape[0] - usize::from(r), shape[1], shape[2] - usize::from(z), shape[3] - usize::from(t)];
    let mut densities = vec![0.0; inside.iter().product()];
    for (cell, share) in tally.shares(packets).into_iter().enumerate() {
        let (mut left, mut at, mut own, mut stride, mut own_stride) = (cell, 0, 0, 1, 1);
        for axis in (0..4).rev() {
            let index = (left % shape[axis]).min(inside[axis] - 1);
            left /= shape[axis];
            at += index * stride;
            own += index * own_stride;
            stride *= inside[axis];
            own_stride *= shape[axis];
        }
        densities[at] += share / tally.extent(own);
    }
    densities
}

/// A number with six digits.
fn short(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    if rounded != 0.0 && !(1e-5..1e7).contains(&rounded.abs()) { format!("{rounded:E}") } else { rounded.to_string() }
}

/// A number as C's `%.4E` writes it.
fn scientific(value: f64) -> String {
    let text = format!("{value:.4E}");
    let (digits, exponent) = text.split_once('E').unwrap_or((&text, "0"));
    let (sign, exponent) = exponent.strip_prefix('-').map_or(('+', exponent), |exponent| ('-', exponent));
    format!("{digits}E{sign}{exponent:0>2}")
}
