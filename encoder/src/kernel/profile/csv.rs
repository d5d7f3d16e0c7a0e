//! Profiles in tables of numbers: measured ones, and those that are simulated here.

use std::fmt::Write as _;
use std::io::Read as _;
use std::path::Path;

use super::{Profile, Radial, entered, points, rings};
use crate::error::{Error, Result};
use crate::simulate::monte_carlo::profile::mirrored;

/// Bytes of a table, at most.
const MAX_BYTES: u64 = 64 << 20;
/// Titles of the columns of radii where rows are rings.
const FROM_TO: [&str; 2] = ["r_from_mm", "r_to_mm"];
/// Share by which middles of equal rings may be off: they are written with seven digits.
const EQUAL: f64 = 1e-4;
const COLUMNS: &str = "r in mm, then R_d in mm⁻² of red, green and blue, or of all";

/// A row: its line in the file and its numbers.
type Row = (usize, Vec<f64>);

/// The profile of a table; see [`Profile::read`].
pub(super) fn read(path: &Path) -> Result<Profile> {
    let refuse = |found: String| Error::input(path, found, "a table of r and R_d (.csv)");
    let file = std::fs::File::open(path).map_err(|error| refuse(error.to_string()))?;
    let mut bytes = Vec::new();
    file.take(MAX_BYTES + 1).read_to_end(&mut bytes).map_err(|error| refuse(error.to_string()))?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(refuse(format!("more than {} MiB", MAX_BYTES >> 20)));
    }
    // Comments may be in any encoding.
    parse(path, &String::from_utf8_lossy(&bytes))
}

/// The profile of a table's text; `path` is what errors name.
pub(super) fn parse(path: &Path, text: &str) -> Result<Profile> {
    let (has_rings, rows) = rows(path, text)?;
    let place =
        |row: &Row, found: String, expected: &str| Error::input(path, format!("{found} in line {}", row.0), expected);
    let radii = if has_rings { 2 } else { 1 };
    let Some(first) = rows.first() else {
        return Err(Error::input(path, "no row of numbers", COLUMNS));
    };
    // Two columns: one value for all channels.
    let step = match first.1.len() - radii.min(first.1.len()) {
        0 => return Err(place(first, format!("{} columns", first.1.len()), COLUMNS)),
        1 | 2 => 0,
        _ => 1,
    };
    for row in &rows {
        if row.1.len() <= radii + 2 * step {
            return Err(place(row, format!("{} columns", row.1.len()), "as many as in the first row"));
        }
        let [from, to] = [row.1[0], row.1[radii - 1]];
        if from < 0.0 || (has_rings && to <= from) {
            return Err(place(row, format!("a radius of {to} mm"), "radii from 0 upwards"));
        }
    }
    for pair in rows.windows(2) {
        let [before, r_mm] = [pair[0].1[radii - 1], pair[1].1[0]];
        if has_rings && (r_mm - before).abs() > EQUAL * before {
            return Err(place(&pair[1], format!("a ring from {r_mm} mm"), "one from where the last ended"));
        }
        if !has_rings && r_mm <= before {
            return Err(place(&pair[1], format!("r = {r_mm} mm after {before} mm"), "radii that ascend"));
        }
    }
    if rows.len() < 2 {
        return Err(Error::input(path, "one row of numbers", "two or more"));
    }
    let column = |k: usize| rows.iter().map(|row| row.1[k].max(0.0)).collect::<Vec<f64>>();
    let r_mm = column(radii - 1);
    let channel = |c: usize| {
        let rd = column(radii + c * step);
        if has_rings {
            return Radial::new(std::iter::once(0.0).chain(r_mm.iter().copied()).collect(), rd);
        }
        match equal_rings(&r_mm) {
            Some(dr_mm) => rings(dr_mm, &rd),
            None => points::rings(&r_mm.iter().copied().zip(rd).collect::<Vec<_>>()),
        }
    };
    if has_rings && rows[0].1[0] != 0.0 {
        return Err(place(&rows[0], format!("a first ring from {} mm", rows[0].1[0]), "one from 0"));
    }
    let mirrored = mirrored(text);
    Ok(Profile { channels: std::array::from_fn(|c| channel(c).scaled(entered(mirrored[c]))) })
}

/// Whether rows are of rings by their titles, and the rows of numbers.
fn rows(path: &Path, text: &str) -> Result<(bool, Vec<Row>)> {
    let mut has_rings = false;
    let mut rows: Vec<Row> = Vec::new();
    for (number, line) in text.trim_start_matches('\u{feff}').lines().enumerate() {
        let line = line.split('#').next().unwrap_or("").trim();
        if line.is_empty() {
            continue;
        }
        // Where columns are parted by semicolons, commas are decimal points.
        let (line, separators): (String, &[char]) =
            if line.contains(';') { (line.replace(',', "."), &[';']) } else { (line.to_owned(), &[',', '\t', ' ']) };
        let words: Vec<&str> = line.split(separators).map(str::trim).collect();
        let words = words.into_iter().filter(|word| !word.is_empty());
        let values: Option<Vec<f64>> =
            words.clone().map(|word| word.parse().ok().filter(|value: &f64| value.is_finite())).collect();
        match values {
            Some(values) if !values.is_empty() => rows.push((number + 1, values)),
            // A title, once.
            _ if rows.is_empty() && !has_rings => has_rings = words.clone().take(2).eq(FROM_TO),
            _ => {
                let found = format!("{line} in line {}", number + 1);
                return Err(Error::input(path, found, format!("finite numbers: {COLUMNS}")));
            }
        }
    }
    Ok((has_rings, rows))
}

/// Width of rings whose middles these are, if they are.
fn equal_rings(r_mm: &[f64]) -> Option<f64> {
    let dr_mm = 2.0 * r_mm[0];
    #[allow(clippy::cast_precision_loss, reason = "rows fit into a file of 64 MiB")]
    let is_middle = |(k, r): (usize, &f64)| (r - (k as f64 + 0.5) * dr_mm).abs() <= EQUAL * r;
    (dr_mm > 0.0 && r_mm.iter().enumerate().all(is_middle)).then_some(dr_mm)
}

/// The table of a profile whose channels have the same rings, `comment` above it.
pub(super) fn write(profile: &Profile, comment: &str) -> String {
    let mut text = String::new();
    for line in comment.lines() {
        let _ = writeln!(text, "# {line}");
    }
    let _ = writeln!(text, "{},rd_red,rd_green,rd_blue", FROM_TO.join(","));
    let edges = profile.channels[0].edges_mm();
    for (ring, edges) in edges.windows(2).enumerate() {
        let _ = write!(text, "{},{}", short(edges[0]), short(edges[1]));
        for channel in &profile.channels {
            let _ = write!(text, ",{}", short(channel.rd()[ring]));
        }
        text.push('\n');
    }
    text
}

/// A number with five digits.
fn short(value: f64) -> String {
    if value == 0.0 { "0".into() } else { format!("{value:.4e}") }
}
