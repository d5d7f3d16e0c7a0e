//! What files stand for, uncompressed: what an app without this project would load.

use std::f32::consts::TAU;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use glam::Vec3;
use subsurf_decoder::{Bssrdf, Content, File, NestedBtf};
use subsurf_runtime::{RawImages, Stored};

use crate::Failed;

/// Rings of directions of the BTF database of Bonn (Sattler et al. 2003): degrees from the normal, and how many; 81 in all.
const RINGS: [(f32, u8); 6] = [(0.0, 1), (15.0, 6), (30.0, 12), (45.0, 18), (60.0, 20), (75.0, 24)];

/// Array in a folder, which goes with its value.
pub(crate) struct RawFile {
    pub(crate) path: PathBuf,
    /// Name of what it is, and how it is loaded.
    pub(crate) stored: (&'static str, Stored),
}

impl RawFile {
    /// Writes the capture or the images that a file stands for; `None` where it has none. `path`: the file's, whose name it gets.
    pub(crate) fn write(path: &Path, file: &File<'_>, folder: &Path) -> Result<Option<Self>, Failed> {
        let stored = match file.content() {
            Content::Bssrdf(material) => ("capture", Stored::Capture(*material.header())),
            Content::NestedBtf(btf) => {
                let Some(material) = btf.materials().next() else { return Ok(None) };
                let size = [material.width.into(), material.height.into()];
                ("images", Stored::Images(RawImages { size, lights: directions(), views: directions() }))
            }
            _ => return Ok(None),
        };
        let name = path.file_stem().unwrap_or_default().display();
        let raw = Self { path: folder.join(format!("{name}-{}.raw", stored.0)), stored };
        let mut to = BufWriter::new(std::fs::File::create(&raw.path)?);
        match (file.content(), &raw.stored.1) {
            (Content::Bssrdf(material), _) => capture(&material, &mut to)?,
            (Content::NestedBtf(btf), Stored::Images(of)) => images(&btf, of, &mut to)?,
            _ => {}
        }
        to.flush()?;
        Ok(Some(raw))
    }
}

impl Drop for RawFile {
    fn drop(&mut self) {
        std::fs::remove_file(&self.path).ok();
    }
}

/// Rd of every pixel from every pixel of its window, `[y][x][dy][dx][rgb]`, little-endian.
fn capture(material: &Bssrdf<'_>, to: &mut impl Write) -> Result<(), Failed> {
    let (header, radius) = (material.header(), i32::from(material.header().window_radius));
    let side = |pixels: u32| 0..i32::try_from(pixels).unwrap_or(i32::MAX);
    for y in side(header.height) {
        for x in side(header.width) {
            for dy in -radius..=radius {
                for dx in -radius..=radius {
                    for rd in material.rd([x, y], [x + dx, y + dy]) {
                        to.write_all(&rd.to_le_bytes())?;
                    }
                }
            }
        }
    }
    Ok(())
}

/// Unit vectors on the rings.
fn directions() -> Vec<Vec3> {
    let ring = |(degrees, count): (f32, u8)| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        (0..count).map(move |k| {
            let phi = TAU * f32::from(k) / f32::from(count);
            Vec3::new(sin * phi.cos(), sin * phi.sin(), cos)
        })
    };
    RINGS.into_iter().flat_map(ring).collect()
}

/// Images of the first material, `[light][view][y][x][rgb]`, a byte each.
fn images(btf: &NestedBtf<'_>, of: &RawImages, to: &mut impl Write) -> Result<(), Failed> {
    let [width, height] = of.size.map(|side| i32::try_from(side).unwrap_or(i32::MAX));
    for light in &of.lights {
        for view in &of.views {
            for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
                let texel = btf.texel(0, 0, [x, y]).ok_or("the file has no such texel")?;
                let value = btf.eval(texel, light.to_array(), view.to_array());
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
                to.write_all(&value.map(|value| (255.0 * value.clamp(0.0, 1.0)).round() as u8))?;
            }
        }
    }
    Ok(())
}
