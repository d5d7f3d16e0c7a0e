//! Reads the images of a BTF, one at a time.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::listing::Listing;
use crate::capture::directions::{Direction, image_name};
use crate::error::{Error, Result};
use crate::picture::{self, Picture, PixelFormat};

/// A folder with an image for every pair of a light and a view.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    lights: Vec<Direction>,
    views: Vec<Direction>,
    /// What the headers of all images say.
    header: picture::Header,
    /// Files by light and view.
    images: BTreeMap<[Direction; 2], PathBuf>,
    facts: Option<serde_json::Value>,
    /// Factor that brought values into the range that is displayed.
    exposure: f64,
    warnings: Vec<String>,
}

impl Folder {
    /// Looks through a folder, or those inside of it if it has no images itself: every light is there with every view, all
    /// images have one format and one size. What is in them is not read yet.
    ///
    /// # Errors
    /// [`Error::Input`] with what is missing, twice there, or of another size.
    pub fn open(path: &Path) -> Result<Self> {
        let Listing { images, left_out } = Listing::new(path)?;
        let of = |which: usize| images.keys().map(|pair| pair[which]).collect::<BTreeSet<_>>().into_iter().collect();
        let (lights, views): (Vec<Direction>, Vec<Direction>) = (of(0), of(1));
        let pairs = || lights.iter().flat_map(|light| views.iter().map(move |view| [*light, *view]));
        let missing: Vec<_> = pairs().filter(|pair| !images.contains_key(pair)).collect();
        if let Some([light, view]) = missing.first() {
            let found = format!(
                "{} of {} × {} images are missing, \"{}\" first",
                missing.len(),
                lights.len(),
                views.len(),
                image_name(*light, *view)
            );
            let left_out = left_out.first().map_or_else(String::new, |line| format!(" ({line})"));
            return Err(Error::input(path, format!("{found}{left_out}"), "every light with every view"));
        }
        let header = common_header(images.values())?;
        let facts = facts(path)?;
        let exposure = exposure(path, facts.as_ref())?;
        let warnings = left_out.iter().map(|line| format!("{}: {line}", path.display())).collect();
        Ok(Self { path: path.to_owned(), lights, views, header, images, facts, exposure, warnings })
    }

    /// The folder.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Directions of light, in order.
    #[must_use]
    pub fn lights(&self) -> &[Direction] {
        &self.lights
    }

    /// Directions of view, in order.
    #[must_use]
    pub fn views(&self) -> &[Direction] {
        &self.views
    }

    /// Pixels in x and in y.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.header.size
    }

    /// What pixels are.
    #[must_use]
    pub fn format(&self) -> PixelFormat {
        self.header.format
    }

    /// Bytes of all images, three channels of one byte, two or four.
    #[must_use]
    pub fn raw_bytes(&self) -> u64 {
        let [width, height] = self.header.size.map(u64::from);
        width * height * self.images.len() as u64 * 3 * self.format().bytes()
    }

    /// Where the images come from, as `btf.json` beside them says; `None` if there is none.
    #[must_use]
    pub fn facts(&self) -> Option<&serde_json::Value> {
        self.facts.as_ref()
    }

    /// The factor that brought values into the range that is displayed, as `btf.json` says; 1 if it does not.
    #[must_use]
    pub fn exposure(&self) -> f64 {
        self.exposure
    }

    /// What was left out of the folder, a line each.
    #[must_use]
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// One image, row by row: display values 0 to 1, or linear ones.
    ///
    /// # Errors
    /// [`Error::Input`] if it is broken, or not of those that were looked through.
    pub fn read(&self, light: Direction, view: Direction) -> Result<Vec<[f32; 3]>> {
        let Some(file) = self.images.get(&[light, view]) else {
            let found = format!("no image \"{}\"", image_name(light, view));
            return Err(Error::input(&self.path, found, "directions that the folder has"));
        };
        let picture = Picture::open(file)?;
        if picture.size() != self.size() {
            return Err(Error::input(
                file,
                "another size than before",
                "images that stay as they are while they are read",
            ));
        }
        Ok(picture.pixels().to_vec())
    }
}

/// What the headers of all images say alike.
fn common_header<'a>(files: impl Iterator<Item = &'a PathBuf>) -> Result<picture::Header> {
    let mut common = None;
    for file in files {
        let header = picture::Header::open(file)?;
        let first = *common.get_or_insert(header);
        if header != first {
            let told = |header: picture::Header| {
                let [width, height] = header.size;
                format!("{width} × {height} pixels, {}", header.format)
            };
            return Err(Error::input(file, told(header), format!("{}, as the images before it", told(first))));
        }
    }
    Ok(common.expect("a folder has an image"))
}

/// What `btf.json` says, if it is there.
fn facts(folder: &Path) -> Result<Option<serde_json::Value>> {
    let path = folder.join("btf.json");
    if !path.exists() {
        return Ok(None);
    }
    let wrong = |error: String| Error::input(&path, error, "JSON, or no such file");
    let bytes = std::fs::read(&path).map_err(|error| wrong(error.to_string()))?;
    serde_json::from_slice(&bytes).map(Some).map_err(|error| wrong(error.to_string()))
}

fn exposure(folder: &Path, facts: Option<&serde_json::Value>) -> Result<f64> {
    let Some(exposure) = facts.and_then(|facts| facts.pointer("/simulated/exposure")) else {
        return Ok(1.0);
    };
    // Ten stops more than any camera has.
    let number = exposure.as_f64().filter(|number| (1e-6..=1e6).contains(number));
    number.ok_or_else(|| Error::input(&folder.join("btf.json"), "an exposure that is none", "a number, 1e-6 to 1e6"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::capture::{FolderWriter, Pixels};

    const LIGHTS: [Direction; 2] = [Direction { theta_deg: 0, phi_deg: 0 }, Direction { theta_deg: 75, phi_deg: 90 }];
    const VIEWS: [Direction; 2] = [Direction { theta_deg: 15, phi_deg: 60 }, Direction { theta_deg: 30, phi_deg: 0 }];

    fn write(folder: &Path, pixels: Pixels) {
        let writer = FolderWriter::new(folder, 2, pixels).unwrap();
        for (light, view) in LIGHTS.iter().flat_map(|light| VIEWS.iter().map(move |view| (*light, *view))) {
            let value = f32::from(light.theta_deg) / 100.0;
            writer.write(light, view, &[[value, 0.5, 0.25], [0.0; 3], [1.0; 3], [1.5; 3]]).unwrap();
        }
        writer.finish(&serde_json::json!({ "simulated": {} })).unwrap();
    }

    #[test]
    fn folders_are_read_as_they_were_written() {
        let place = tempfile::tempdir().unwrap();
        for (name, pixels) in [("display", Pixels::Display { exposure: 1.0 }), ("linear", Pixels::Linear)] {
            write(&place.path().join(name), pixels);
            let folder = Folder::open(&place.path().join(name)).unwrap();
            assert_eq!((folder.lights(), folder.views(), folder.size()), (&LIGHTS[..], &VIEWS[..], [2, 2]));
            assert_eq!(folder.format().is_linear(), name == "linear");
            assert!(folder.facts().is_some());
            let image = folder.read(LIGHTS[1], VIEWS[0]).unwrap();
            let expected = if folder.format().is_linear() { [0.75, 0.5, 0.25] } else { [0.880_6, 0.735_4, 0.537_1] };
            let error = (0..3).map(|c| (image[0][c] - expected[c]).abs()).fold(0.0, f32::max);
            assert!(error < 2.0 / 255.0, "{name}: {:?}", image[0]);
            assert!(folder.read(VIEWS[0], LIGHTS[0]).is_err(), "no such pair");
        }
    }

    #[test]
    fn what_is_wrong_with_a_folder_is_said() {
        let place = tempfile::tempdir().unwrap();
        let open = |name: &str, change: &dyn Fn(&Path)| {
            let folder = place.path().join(name);
            write(&folder, Pixels::Display { exposure: 1.0 });
            change(&folder);
            Folder::open(&folder).unwrap_err().to_string()
        };
        let image = |folder: &Path, light: usize, view: usize| {
            folder.join(format!("{}.png", image_name(LIGHTS[light], VIEWS[view])))
        };
        let missing = open("missing", &|folder| std::fs::remove_file(image(folder, 1, 0)).unwrap());
        assert!(missing.contains("1 of 2 × 2 images are missing, \"tl075 pl090 tv015 pv060\""), "{missing}");
        let twice = open("twice", &|folder| {
            std::fs::copy(image(folder, 0, 0), folder.join("0001 tl0 pl0 tv15 pv60.png")).unwrap();
        });
        assert!(twice.contains("the same directions as"), "{twice}");
        let larger = open("larger", &|folder| {
            image::RgbImage::new(3, 2).save(image(folder, 1, 1)).unwrap();
        });
        assert!(larger.contains("tl075 pl090 tv030 pv000.png: 3 × 2 pixels, 8-bit sRGB; expected 2 × 2"), "{larger}");
        let broken = open("broken", &|folder| std::fs::write(image(folder, 0, 1), "no image").unwrap());
        assert!(broken.contains("tl000 pl000 tv030 pv000.png"), "{broken}");
        let mixed = open("mixed", &|folder| {
            std::fs::rename(image(folder, 0, 0), folder.join("tl000 pl000 tv015 pv060.jpg")).unwrap();
        });
        assert!(mixed.contains("another format"), "{mixed}");
        let empty = place.path().join("empty");
        std::fs::create_dir(&empty).unwrap();
        let empty = Folder::open(&empty).unwrap_err().to_string();
        assert!(empty.contains("no image that is named by its directions"), "{empty}");
        assert!(Folder::open(&place.path().join("nowhere")).is_err());
    }
}
