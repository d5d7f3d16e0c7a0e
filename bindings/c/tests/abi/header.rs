//! What `subsurf.h` declares.

use std::path::Path;

/// Names of the functions that the header declares, sorted: all, or with `SUBSURF_DECODER_ONLY`.
pub(crate) fn functions(header: &Path, decoder_only: bool) -> Vec<String> {
    let text = std::fs::read_to_string(header).expect("the header");
    let (files, renderer) = text.split_once("#ifndef SUBSURF_DECODER_ONLY").expect("a part for the renderer");
    let text = if decoder_only { files.to_owned() } else { [files, renderer].concat() };
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
