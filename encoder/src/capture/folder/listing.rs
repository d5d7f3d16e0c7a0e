//! Images in a folder by the directions that their names tell.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::path::{Path, PathBuf};

use crate::capture::directions::{Direction, Named, directions_of};
use crate::error::{Error, Result};
use crate::picture::EXTENSIONS;

/// Folders below that are looked through: databases come with one for each view, inside of one for each material.
const DEPTH: usize = 3;
const EXPECTED: &str = "images named \"tl000 pl000 tv000 pv000.png\": light and view in degrees";

/// All images of a folder that are of one format.
pub(super) struct Listing {
    /// Files by light and view.
    pub(super) images: BTreeMap<[Direction; 2], PathBuf>,
    /// What was left out, a line for each reason.
    pub(super) left_out: Vec<String>,
}

impl Listing {
    /// Images of a folder, or of those below if it has none itself.
    pub(super) fn new(folder: &Path) -> Result<Self> {
        let mut files = named_files(folder, 0)?;
        if files.is_empty() {
            files = named_files(folder, DEPTH)?;
        }
        let mut images: BTreeMap<[Direction; 2], Candidate> = BTreeMap::new();
        let mut left_out = LeftOut::default();
        for Candidate { file, named } in files {
            let Named { directions, is_wrapped } = match named {
                Ok(named) => named,
                Err(reason) => {
                    left_out.add(reason, &file);
                    continue;
                }
            };
            match images.entry(directions) {
                Entry::Vacant(entry) => drop(entry.insert(Candidate { file, named })),
                Entry::Occupied(mut entry) => {
                    let other = entry.get_mut();
                    if other.is_wrapped() == is_wrapped {
                        let found = format!("the same directions as {}", other.file.display());
                        return Err(Error::input(&file, found, "one image for every pair of directions"));
                    }
                    // The name that needs no change counts: rings are often closed by an azimuth of 360°.
                    let mut second = Candidate { file, named };
                    if other.is_wrapped() {
                        std::mem::swap(other, &mut second);
                    }
                    left_out.add("360° later they are there as well", &second.file);
                }
            }
        }
        let left_out = left_out.lines();
        if images.is_empty() {
            let found =
                left_out.first().cloned().unwrap_or_else(|| "no image that is named by its directions".to_owned());
            return Err(Error::input(folder, found, EXPECTED));
        }
        let images: BTreeMap<_, _> = images.into_iter().map(|(pair, candidate)| (pair, candidate.file)).collect();
        one_format(images.values())?;
        Ok(Self { images, left_out })
    }
}

struct Candidate {
    file: PathBuf,
    named: std::result::Result<Named, &'static str>,
}

impl Candidate {
    fn is_wrapped(&self) -> bool {
        self.named.is_ok_and(|named| named.is_wrapped)
    }
}

/// Images whose names tell directions, in the order of their paths, in a folder and so many levels below.
fn named_files(folder: &Path, depth: usize) -> Result<Vec<Candidate>> {
    let mut found = Vec::new();
    // A folder, the names of it and of those around it, and levels that are left.
    let mut folders = vec![(folder.to_owned(), Vec::<String>::new(), depth)];
    while let Some((folder, names, depth)) = folders.pop() {
        let unreadable = |error| Error::input(&folder, error, format!("a folder of {EXPECTED}"));
        for entry in std::fs::read_dir(&folder).map_err(unreadable)? {
            let path = entry.map_err(unreadable)?.path();
            let lower =
                |text: Option<&std::ffi::OsStr>| text.unwrap_or_default().to_string_lossy().to_ascii_lowercase();
            let (stem, extension) = (lower(path.file_stem()), lower(path.extension()));
            // Hidden files are the system's: archives of macOS have one beside every image.
            if stem.starts_with('.') {
                continue;
            }
            if depth > 0 && path.is_dir() {
                let around = std::iter::once(lower(path.file_name())).chain(names.iter().cloned()).collect();
                folders.push((path, around, depth - 1));
                continue;
            }
            let all: Vec<&str> = std::iter::once(&stem).chain(&names).map(String::as_str).collect();
            if EXTENSIONS.contains(&extension.as_str())
                && let Some(named) = directions_of(&all)
            {
                found.push(Candidate { file: path, named });
            }
        }
    }
    found.sort_by(|a, b| a.file.cmp(&b.file));
    Ok(found)
}

/// Refuses images of different formats.
fn one_format<'a>(mut files: impl Iterator<Item = &'a PathBuf>) -> Result<()> {
    let format = |file: &Path| {
        let extension = file.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        match extension.as_str() {
            "jpeg" => "jpg".to_owned(),
            "tiff" => "tif".to_owned(),
            _ => extension,
        }
    };
    let first = files.next().map(|file| format(file)).unwrap_or_default();
    match files.find(|file| format(file) != first) {
        Some(other) => Err(Error::input(other, "one image in another format", format!("all of them in .{first}"))),
        None => Ok(()),
    }
}

/// Images that are left out: for each reason the first, and how many.
#[derive(Default)]
struct LeftOut(BTreeMap<&'static str, (String, usize)>);

impl LeftOut {
    fn add(&mut self, reason: &'static str, file: &Path) {
        let name = || file.file_name().unwrap_or_default().to_string_lossy().into_owned();
        self.0.entry(reason).or_insert_with(|| (name(), 0)).1 += 1;
    }

    fn lines(&self) -> Vec<String> {
        let line = |(reason, (first, count)): (&&str, &(String, usize))| {
            format!("{count} images are left out, as {reason}; \"{first}\" first")
        };
        self.0.iter().map(line).collect()
    }
}
