//! Names of scores: `Rd_ra`, `A_rz`.

use super::Version;
use crate::simulate::monte_carlo::{Axes, Quantity, Score};

/// Scores of version 1, in the order of its files.
pub(super) const V1: [&str; 8] = ["A_z", "Rd_r", "Rd_a", "Tt_r", "Tt_a", "A_rz", "Rd_ra", "Tt_ra"];

/// The score of that name; `None` if there is none.
pub(super) fn parse(name: &str) -> Option<Score> {
    let (quantity, letters) = name.split_once('_')?;
    let quantity = match quantity {
        "Rd" => Quantity::Reflected,
        "Td" | "Tt" => Quantity::Transmitted,
        "A" => Quantity::Absorbed,
        _ => return None,
    };
    let has = |axis: char| letters.contains(axis);
    let axes = Axes { r: has('r'), a: has('a'), z: has('z'), t: has('t') };
    let score = Score { quantity, axes };
    let allowed = if quantity == Quantity::Absorbed { !axes.a && (axes.z || axes.t) } else { !axes.z };
    (allowed && letters == self::letters(score)).then_some(score)
}

/// Name of a score in files of that version.
pub(super) fn name(score: Score, version: Version) -> String {
    let quantity = match (score.quantity, version) {
        (Quantity::Reflected, _) => "Rd",
        (Quantity::Transmitted, Version::V1) => "Tt",
        (Quantity::Transmitted, Version::V2) => "Td",
        (Quantity::Absorbed, _) => "A",
        (Quantity::BallisticAbsorbed, _) => "Ab",
    };
    format!("{quantity}_{}", letters(score))
}

fn letters(score: Score) -> String {
    let Axes { r, a, z, t } = score.axes;
    [(r, 'r'), (a, 'a'), (z, 'z'), (t, 't')].into_iter().filter_map(|(has, letter)| has.then_some(letter)).collect()
}

/// The unit of a score's densities.
pub(super) fn unit(score: Score) -> &'static str {
    let Axes { r, a, z, t } = score.axes;
    match (r, a, z, t) {
        (true, true, _, true) => "[1/(cm2 sr ps)]",
        (true, true, _, false) => "[1/(cm2 sr)]",
        (true, false, true, true) => "[1/(cm3 ps)]",
        (true, false, true, false) => "[1/cm3]",
        (true, false, false, true) => "[1/(cm2 ps)]",
        (true, false, false, false) => "[1/cm2]",
        (false, true, _, true) => "[1/(sr ps)]",
        (false, true, _, false) => "[1/sr]",
        (false, false, true, true) => "[1/(cm ps)]",
        (false, false, true, false) => "[1/cm]",
        (false, false, false, true) => "[1/ps]",
        (false, false, false, false) => "[-]",
    }
}
