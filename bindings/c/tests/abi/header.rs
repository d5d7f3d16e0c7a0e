//! What `subsurf.h` declares.

use std::path::Path;

/// Names of the functions that the header declares.
pub(crate) fn functions(header: &Path) -> Vec<String> {
    let text = std::fs::read_to_string(header).expect("the header");
    let is_name = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    let declared = text.lines().filter(|line| !line.starts_with([' ', '/', '#', '}']));
    let mut names: Vec<String> = declared
        .filter_map(|line| line.split_once('('))
        .filter_map(|(before, _)| before.rsplit(|c| !is_name(c)).next())
        .filter(|name| name.starts_with("subsurf_"))
        .map(str::to_owned)
        .collect();
    names.sort();
    names
}
