//! Radiance pictures (`.hdr`, `.pic`), in any order of scanlines.
//!
//! Ward, "Real Pixels", Graphics Gems II, 1991; and the description of the format in the Radiance reference manual.

use std::io::{self, BufRead, Read};

use image::Rgb32FImage;
use image::metadata::Orientation;

/// The longest header that is read.
const MAX_HEADER: u64 = 65_536;
/// Widths of scanlines that may be run-length coded by component.
const CODED: std::ops::Range<usize> = 8..32_768;

/// Where the scanlines of a file lie in its picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Layout {
    /// Pixels of a scanline, and number of scanlines.
    pub(super) scanlines: [u32; 2],
    /// How to turn scanlines, taken as rows from the top, to get the picture.
    pub(super) orientation: Orientation,
}

/// Why a file is refused: what was found.
type Found = String;

/// Reads up to the first scanline.
pub(super) fn read_header(file: &mut impl BufRead) -> Result<Layout, Found> {
    let mut text = file.take(MAX_HEADER);
    loop {
        let line = read_line(&mut text)?;
        if line.is_empty() {
            break;
        }
        if let Some(format) = line.strip_prefix("FORMAT=")
            && format.trim() != "32-bit_rle_rgbe"
        {
            return Err(format!("pixels as {:?} rather than 32-bit_rle_rgbe", format.trim()));
        }
    }
    let line = read_line(&mut text)?;
    let words: Vec<&str> = line.split_whitespace().collect();
    let wrong = || format!("the size {:?}, not -Y 480 +X 640 for example", line.trim());
    let &[major, count, minor, length] = &words[..] else {
        return Err(wrong());
    };
    let orientation = match (major, minor) {
        ("-Y", "+X") => Orientation::NoTransforms,
        ("-Y", "-X") => Orientation::FlipHorizontal,
        ("+Y", "+X") => Orientation::FlipVertical,
        ("+Y", "-X") => Orientation::Rotate180,
        // Scanlines are columns.
        ("+X", "-Y") => Orientation::Rotate90FlipH,
        ("-X", "-Y") => Orientation::Rotate90,
        ("+X", "+Y") => Orientation::Rotate270,
        ("-X", "+Y") => Orientation::Rotate270FlipH,
        _ => return Err(wrong()),
    };
    let side = |word: &str| word.parse::<u32>().ok().filter(|side| *side > 0).ok_or_else(wrong);
    Ok(Layout { scanlines: [side(length)?, side(count)?], orientation })
}

fn read_line(text: &mut impl BufRead) -> Result<String, Found> {
    let mut line = Vec::new();
    text.read_until(b'\n', &mut line).map_err(|error| error.to_string())?;
    match line.pop() {
        Some(b'\n') => Ok(String::from_utf8_lossy(&line).trim_end_matches('\r').to_owned()),
        _ => Err("a header without an end".to_owned()),
    }
}

/// Reads all scanlines, as rows.
pub(super) fn read_scanlines(file: &mut impl BufRead, [length, count]: [u32; 2]) -> Result<Rgb32FImage, Found> {
    let mut scanline = vec![[0_u8; 4]; length as usize];
    let mut values = Vec::with_capacity(3 * length as usize * count as usize);
    for number in 0..count {
        let cut = |error: io::Error| match error.kind() {
            io::ErrorKind::UnexpectedEof => format!("the file is cut: scanline {number} of {count} is missing"),
            io::ErrorKind::InvalidData => format!("scanline {number} of {count}: {error}"),
            _ => error.to_string(),
        };
        read_scanline(file, &mut scanline).map_err(cut)?;
        values.extend(scanline.iter().flat_map(|pixel| linear(*pixel)));
    }
    Ok(Rgb32FImage::from_raw(length, count, values).expect("three values for every pixel"))
}

/// The values of a pixel: mantissas of 8 bits with a common exponent.
fn linear([r, g, b, exponent]: [u8; 4]) -> [f32; 3] {
    if exponent == 0 {
        return [0.0; 3];
    }
    let unit = 2.0_f64.powi(i32::from(exponent) - 136);
    #[allow(clippy::cast_possible_truncation, reason = "8 bits, times a power of two that single precision has")]
    [r, g, b].map(|mantissa| (f64::from(mantissa) * unit) as f32)
}

fn read_scanline(file: &mut impl Read, scanline: &mut [[u8; 4]]) -> io::Result<()> {
    let first = read::<4>(file)?;
    let [2, 2, high, low] = first else {
        return read_pixels(file, first, scanline);
    };
    let length = usize::from(u16::from_be_bytes([high, low]));
    if high >= 128 || !CODED.contains(&scanline.len()) {
        return read_pixels(file, first, scanline);
    }
    if length != scanline.len() {
        return Err(invalid("another length than the header says"));
    }
    (0..4).try_for_each(|component| read_component(file, component, scanline))
}

/// One component of a scanline, in runs of a value and in runs of values.
fn read_component(file: &mut impl Read, component: usize, scanline: &mut [[u8; 4]]) -> io::Result<()> {
    let mut rest = scanline;
    while !rest.is_empty() {
        let [code] = read::<1>(file)?;
        let (run, is_same) = if code > 128 { (code - 128, true) } else { (code, false) };
        let Some((pixels, after)) = rest.split_at_mut_checked(run.into()) else {
            return Err(invalid("a run that goes beyond its end"));
        };
        if run == 0 {
            return Err(invalid("a run of no length"));
        }
        if is_same {
            let [value] = read::<1>(file)?;
            pixels.iter_mut().for_each(|pixel| pixel[component] = value);
        } else {
            for pixel in pixels {
                [pixel[component]] = read::<1>(file)?;
            }
        }
        rest = after;
    }
    Ok(())
}

/// A scanline of whole pixels, in which (1, 1, 1, n) repeats the one before; the next such one 256 times as often.
fn read_pixels(file: &mut impl Read, first: [u8; 4], scanline: &mut [[u8; 4]]) -> io::Result<()> {
    let mut next = Some(first);
    let mut before = None;
    let (mut at, mut shift) = (0, 0_u32);
    while at < scanline.len() {
        let pixel = match next.take() {
            Some(pixel) => pixel,
            None => read::<4>(file)?,
        };
        if let [1, 1, 1, times] = pixel
            && let Some(before) = before
        {
            let run = usize::from(times).checked_shl(shift).filter(|run| run >> shift == usize::from(times));
            let end = run.and_then(|run| at.checked_add(run)).filter(|end| *end <= scanline.len());
            let end = end.ok_or_else(|| invalid("a run that goes beyond its end"))?;
            scanline[at..end].fill(before);
            at = end;
            shift += 8;
        } else {
            scanline[at] = pixel;
            before = Some(pixel);
            at += 1;
            shift = 0;
        }
    }
    Ok(())
}

fn read<const N: usize>(file: &mut impl Read) -> io::Result<[u8; N]> {
    let mut bytes = [0; N];
    file.read_exact(&mut bytes)?;
    Ok(bytes)
}

fn invalid(what: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, what)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pixels(header: &str, scanlines: &[u8]) -> Result<Vec<[u8; 4]>, Found> {
        let file = [header.as_bytes(), scanlines].concat();
        let mut file = &file[..];
        let layout = read_header(&mut file)?;
        let mut all = Vec::new();
        for _ in 0..layout.scanlines[1] {
            let mut scanline = vec![[0; 4]; layout.scanlines[0] as usize];
            read_scanline(&mut file, &mut scanline).map_err(|error| error.to_string())?;
            all.extend(scanline);
        }
        Ok(all)
    }

    #[test]
    fn values_have_a_common_exponent() {
        assert_eq!(linear([128, 64, 0, 129]), [1.0, 0.5, 0.0]);
        assert_eq!(linear([255, 255, 255, 0]), [0.0; 3]);
        assert!(linear([1, 1, 1, 1])[0] > 0.0, "the smallest value");
    }

    #[test]
    fn runs_are_spread() {
        // Eight pixels by component: a run of one value, then eight values, and two runs; then pixels with run marks.
        let coded = [2, 2, 0, 8, 136, 7, 8, 1, 2, 3, 4, 5, 6, 7, 8, 132, 9, 132, 10, 136, 129];
        let found = pixels("#?RADIANCE\n\n-Y 1 +X 8\n", &coded).unwrap();
        assert_eq!((found[0], found[3], found[7]), ([7, 1, 9, 129], [7, 4, 9, 129], [7, 8, 10, 129]));
        let marked = [5, 6, 7, 8, 1, 1, 1, 2, 9, 9, 9, 9];
        let found = pixels("#?RGBE\nEXPOSURE=1\n\n-Y 1 +X 4\n", &marked).unwrap();
        assert_eq!(found, [[5, 6, 7, 8], [5, 6, 7, 8], [5, 6, 7, 8], [9; 4]]);
        // 2 + 1 · 256 pixels.
        let long = [[5, 6, 7, 8], [1, 1, 1, 1], [1, 1, 1, 1]].concat();
        assert_eq!(pixels("#?RGBE\n\n-Y 1 +X 258\n", &long).unwrap(), [[5, 6, 7, 8]; 258]);
    }

    #[test]
    fn what_is_wrong_is_said() {
        let one = [5, 6, 7, 8];
        for (header, scanlines, found) in [
            ("#?RADIANCE\n", &one[..], "without an end"),
            ("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n", &one, "32-bit_rle_xyze"),
            ("#?RADIANCE\n\n-Z 1 +X 1\n", &one, "-Z 1 +X 1"),
            ("#?RADIANCE\n\n-Y 0 +X 1\n", &one, "-Y 0 +X 1"),
            ("#?RADIANCE\n\n-Y 1\n", &one, "not -Y 480 +X 640"),
            ("#?RADIANCE\n\n-Y 2 +X 1\n", &one, "failed to fill"),
            ("#?RADIANCE\n\n-Y 1 +X 8\n", &[2, 2, 0, 9], "another length"),
            ("#?RADIANCE\n\n-Y 1 +X 8\n", &[2, 2, 0, 8, 255, 0], "beyond its end"),
            ("#?RADIANCE\n\n-Y 1 +X 8\n", &[2, 2, 0, 8, 0, 0], "no length"),
            ("#?RADIANCE\n\n-Y 1 +X 2\n", &[5, 6, 7, 8, 1, 1, 1, 9], "beyond its end"),
        ] {
            let error = pixels(header, scanlines).unwrap_err();
            assert!(error.contains(found), "{header:?}: {error}");
        }
        // Run marks without end shift all bits out.
        let endless = [vec![5, 6, 7, 8], [1, 1, 1, 0].repeat(9), vec![1, 1, 1, 1]].concat();
        assert!(pixels("#?RADIANCE\n\n-Y 1 +X 2\n", &endless).is_err(), "a run of 2 to the 72nd");
    }
}
