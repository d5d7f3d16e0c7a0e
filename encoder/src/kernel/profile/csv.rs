//! Profiles in tables of numbers: measured ones, and those that are simulated here.

use std::fmt::Write as _;
use std::path::Path;

use super::{Profile, Radial, entered, points, rings};
use crate::error::{Error, Result};
use crate::file::text::read_text;
use crate::simulate::monte_carlo::profile::mirrored;

/// MiB of a table, at most.
const MAX_MIB: u64 = 64;
/// Titles of the columns of radii where rows are rings.
const FROM_TO: [&str; 2] = ["r_from_mm", "r_to_mm"];
/// Share by which middles of equal rings may be off: they are written with seven digits.
const EQUAL: f64 = 1e-4;
const COLUMNS: &str = "r in mm, then R_d in mm⁻² of red, green and blue, or of all";

/// A row: its line in the file and its numbers.
type Row = (usize, Vec<f64>);

/// The profile of a table; see [`Profile::read`].
pub(super) fn read(path: &Path) -> Result<Profile> {
    let profile = parse(path, &read_text(path, MAX_MIB, "a table of r and R_d (.csv)")?)?;
    let condensed = profile.condensed();
    for (c, name) in ["red", "green", "blue"].into_iter().enumerate() {
        let energy = profile.channels[c].energy();
        // Profiles without light are refused by who asks for them.
        if energy > 0.0 && energy.is_finite() {
            let refuse =
                |(found, expected): (String, String)| Error::input(path, format!("{found} in {name}"), expected);
            condensed.channels[c].limited().map_err(refuse)?;
        }
    }
    Ok(profile)
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
        // Where a ring begins may be off by rounding, so that it could end where it begins.
        let end = pair[1].1[radii - 1];
        if end <= before {
            return Err(place(&pair[1], format!("r = {end} mm after {before} mm"), "radii that ascend"));
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
    let mut titles: Option<Vec<String>> = None;
    let mut rows: Vec<Row> = Vec::new();
    for (line, number) in text.trim_start_matches('\u{feff}').lines().zip(1..) {
        let line = line.split_once('#').map_or(line, |(before, _)| before.trim_end());
        if line.trim().is_empty() {
            continue;
        }
        let fields = fields(line);
        let values = fields.iter().map(|field| field.parse().ok().filter(|value: &f64| value.is_finite()));
        if let Some(values) = values.collect() {
            rows.push((number, values));
        } else if rows.is_empty() && titles.is_none() && is_title(&fields[0]) {
            titles = Some(fields);
        } else {
            let found = if fields.iter().any(String::is_empty) { "an empty field" } else { line };
            let expected = format!("finite numbers, below one title at most: {COLUMNS}");
            return Err(Error::input(path, format!("{found} in line {number}"), expected));
        }
    }
    Ok((titles.is_some_and(|titles| titles.iter().take(2).eq(&FROM_TO)), rows))
}

/// Fields of a line between the first of `;`, tab and `,` that it has, or else between blanks. Where columns are parted by
/// semicolons or tabs, commas are decimal points.
fn fields(line: &str) -> Vec<String> {
    let separator = [';', '\t', ','].into_iter().find(|separator| line.contains(*separator));
    match separator {
        Some(',') => line.split(',').map(|field| unquoted(field).to_owned()).collect(),
        Some(separator) => line.split(separator).map(|field| unquoted(field).replace(',', ".")).collect(),
        None => line.split_whitespace().map(|field| unquoted(field).to_owned()).collect(),
    }
}

/// A field without blanks around it, and without the quotes in which some programs write titles or all fields.
fn unquoted(field: &str) -> &str {
    let field = field.trim();
    field.strip_prefix('"').and_then(|field| field.strip_suffix('"')).map_or(field, str::trim)
}

/// Whether a line that begins with this field is a title, rather than numbers with a slip.
fn is_title(field: &str) -> bool {
    field.parse::<f64>().is_err() && field.starts_with(|c: char| !c.is_numeric() && !"+-−.".contains(c))
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
