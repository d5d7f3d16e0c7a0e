//! What all `.btf` files begin with.

use std::f32::consts::FRAC_PI_2;

use glam::Vec3;

use crate::capture::bytes::Bytes;
use crate::error::Result;

/// How the matrix is factorised.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Three matrices of decorrelated channels, DFMF.
    Decorrelated,
    /// One matrix, FMF, with three rows of RGB where DFMF has one.
    Full {
        /// Whether a header of its own comes first.
        extended: bool,
    },
}

/// Signatures, those that begin like another before it. The R says that rotations follow the size.
const KINDS: [(&[u8], Kind); 4] = [
    (b"!DFMF08FCR", Kind::Decorrelated),
    (b"!FMF12FCER", Kind::Full { extended: true }),
    (b"!FMF06FCR", Kind::Full { extended: false }),
    (b"!FMF06FC", Kind::Full { extended: false }),
];

/// A file's kind, size and directions.
#[derive(Debug)]
pub(super) struct Header {
    pub(super) kind: Kind,
    /// Whether values have the cosine of the light's angle in them.
    pub(super) cosine: bool,
    pub(super) lights: Vec<Vec3>,
    pub(super) views: Vec<Vec3>,
    pub(super) size: [u32; 2],
}

/// How far the lights of a view may lie from those of the first, in radians: they are one set.
const SAME_LIGHT: f32 = 0.01;

impl Header {
    pub(super) fn parse(bytes: &mut Bytes<'_>) -> Result<Self> {
        let (kind, rotated) = signature(bytes)?;
        let cosine = facts(bytes)?;
        let (lights, views) = directions(bytes)?;
        let size = [bytes.u32("width")?, bytes.u32("height")?];
        if size.contains(&0) {
            return Err(bytes.wrong(format!("{} × {} pixels", size[0], size[1]), "at least one"));
        }
        if rotated {
            let count = bytes.u32("number of rotations")?;
            if count != 0 {
                return Err(bytes.wrong(format!("{count} rotated frames"), "directions in one frame for all pixels"));
            }
        }
        Ok(Self { kind, cosine, lights, views, size })
    }
}

/// Kind of the file, and whether a number of rotations follows the size.
fn signature(bytes: &mut Bytes<'_>) -> Result<(Kind, bool)> {
    let file = bytes.rest();
    if let Some((signature, kind)) = KINDS.iter().find(|(signature, _)| file.starts_with(signature)) {
        bytes.take(signature.len() as u64, "signature")?;
        return Ok((*kind, signature.ends_with(b"R")));
    }
    let found = match file {
        [b'!', b'P', b'V', b'F', ..] => "a BTF factorised per view (PVF)",
        [b'!', b'B', b'D', b'I', b'F', ..] => "a BTF that is not compressed (BDI)",
        _ => "no signature of a BTF",
    };
    Err(bytes.wrong(found, "a .btf file that begins with !DFMF08FCR, !FMF12FCER, !FMF06FCR or !FMF06FC"))
}

/// Where the data come from, of which only the cosine flag is kept.
fn facts(bytes: &mut Bytes<'_>) -> Result<bool> {
    let start = bytes.at();
    let size = bytes.u32("header size")?;
    let version = bytes.u32("header version")?;
    if !(1..=4).contains(&version) {
        return Err(bytes.wrong(format!("header version {version}"), "1 to 4"));
    }
    // Set-up, image sensor and light source; pixels per mm, and three scale factors that no public reader applies.
    bytes.take(3 * 80 + 4 + 3 * 4, "header")?;
    let cosine = version > 1 && bytes.u32("cosine flag")? != 0;
    if version > 2 {
        let len = bytes.u32("length of the XML")?;
        bytes.take(len.into(), "XML")?;
    }
    if version > 3 {
        let channels = bytes.u32("number of channels")?;
        if channels != 3 {
            return Err(bytes.wrong(format!("{channels} channels"), "3"));
        }
        for _ in 0..channels {
            let len = bytes.u32("length of a channel's name")?;
            bytes.take(len.into(), "a channel's name")?;
        }
    }
    let read = bytes.at() - start;
    if read as u64 != u64::from(size) {
        return Err(bytes.wrong(format!("a header of {size} bytes"), format!("{read} bytes, which its fields take")));
    }
    Ok(cosine)
}

/// Lights and views. Each view has a list of lights; all are the same.
fn directions(bytes: &mut Bytes<'_>) -> Result<(Vec<Vec3>, Vec<Vec3>)> {
    let (mut lights, mut views) = (Vec::new(), Vec::new());
    for view in 0..bytes.u32("number of views")? {
        views.push(direction(bytes, "a view")?);
        let count = bytes.u32("number of lights")?;
        if view > 0 && count as usize != lights.len() {
            let found = format!("{count} lights with view {view}");
            return Err(bytes.wrong(found, format!("{}, as with the one before", lights.len())));
        }
        for light in 0..count as usize {
            let towards = direction(bytes, "a light")?;
            match lights.get(light) {
                Some(first) if towards.distance(*first) > SAME_LIGHT => {
                    let found = format!("light {light} has another direction with view {view} than with the first");
                    return Err(bytes.wrong(found, "the same lights with all views"));
                }
                Some(_) => {}
                None => lights.push(towards),
            }
        }
    }
    if lights.is_empty() {
        return Err(bytes.wrong(format!("{} views, and no light", views.len()), "at least one of both"));
    }
    Ok((lights, views))
}

/// From the angle to the normal and the azimuth, in radians. The file's y goes up the image, ours down.
fn direction(bytes: &mut Bytes<'_>, what: &str) -> Result<Vec3> {
    let [theta, phi] = bytes.f32s(what)?;
    if !(0.0..FRAC_PI_2).contains(&theta) || !phi.is_finite() {
        let found = format!("{what} at {theta} rad from the normal, azimuth {phi} rad");
        return Err(bytes.wrong(found, "a direction above the sample"));
    }
    let (sin, cos) = theta.sin_cos();
    let (sin_phi, cos_phi) = phi.sin_cos();
    Ok(Vec3::new(sin * cos_phi, -sin * sin_phi, cos))
}
