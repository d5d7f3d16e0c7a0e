//! What the materials of one file have in common, and what the file says of each.

use subsurf_decoder::btf::NAME_BYTES;
use subsurf_decoder::btf::{ColourEncoding, Material};

use crate::capture::Images;
use crate::error::{Error, Result};

/// Tone that fits all materials.
///
/// # Errors
/// [`Error::Request`] if there is none, if it has one pair of directions only, or if directions or kinds of values differ.
pub(crate) fn common_tone(materials: &[Images]) -> Result<ColourEncoding> {
    let Some((first, others)) = materials.split_first() else {
        return Err(Error::Request("no material".to_owned()));
    };
    if first.pairs() < 2 {
        let label = first.label();
        return Err(Error::Request(format!("{label}: {} image; a BTF has two or more directions", first.pairs())));
    }
    let mut tone = first.tone();
    for other in others {
        tone = match (tone, other.tone()) {
            _ if other.lights() != first.lights() || other.views() != first.views() => None,
            (ColourEncoding::Display { white }, ColourEncoding::Display { white: same })
                if white.to_bits() == same.to_bits() =>
            {
                Some(tone)
            }
            (ColourEncoding::LogLuv { toe, peak }, ColourEncoding::LogLuv { toe: other_toe, peak: other_peak }) => {
                Some(ColourEncoding::LogLuv { toe: toe.min(other_toe), peak: peak.max(other_peak) })
            }
            _ => None,
        }
        .ok_or_else(|| {
            Error::Request(format!(
                "{} and {}: materials of one file have the same directions, and all display values of one exposure or \
                 all linear ones",
                first.label(),
                other.label()
            ))
        })?;
    }
    Ok(tone)
}

/// Records of materials of these sizes and names, and their number.
///
/// # Errors
/// [`Error::Request`] for no material or more than 255, and for sides of more than 65,535 texels.
pub(crate) fn materials(sizes: &[[u32; 2]], names: &[String], has_mipmaps: bool) -> Result<(u8, Vec<Material>)> {
    let count = u8::try_from(sizes.len()).ok().filter(|count| *count > 0);
    let count = count.ok_or_else(|| Error::Request(format!("{} materials in one file", sizes.len())))?;
    let all = sizes.iter().zip(names).map(|(size, name)| material(*size, name, has_mipmaps));
    Ok((count, all.collect::<Result<_>>()?))
}

fn material([width, height]: [u32; 2], name: &str, has_mipmaps: bool) -> Result<Material> {
    let side =
        |side: u32| u16::try_from(side).map_err(|_| Error::Request(format!("{name}: {side} texels wide or high")));
    let levels = if has_mipmaps { 1 + width.max(height).ilog2() } else { 1 };
    let mut bytes = [0; NAME_BYTES];
    // Cut between characters.
    let end = (0..=name.len().min(NAME_BYTES)).rev().find(|end| name.is_char_boundary(*end)).unwrap_or(0);
    bytes[..end].copy_from_slice(&name.as_bytes()[..end]);
    Ok(Material {
        name: bytes,
        width: side(width)?,
        height: side(height)?,
        levels: u8::try_from(levels).expect("at most 16"),
    })
}
