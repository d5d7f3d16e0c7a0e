//! Per-pixel profiles as Song et al. 2009 store them: a profile for every pixel, some thirty times as large as K-BMPP.
//!
//! The fit itself is where the direct method starts, and stands with it.

use subsurf_decoder::bssrdf::layout::MODEL_PER_PIXEL;
use subsurf_decoder::bssrdf::{BssrdfHeader, Coding, LocalProfile};
use subsurf_decoder::{Bssrdf, Section};

use crate::bssrdf::field::Field;
use crate::bssrdf::normal::Normal;
use crate::bssrdf::write::{logs, write_file};

/// Section `LSPP` of profiles that are relative to the mean profile: planes `[node][channel][pixel]`, natural log of
/// mm⁻².
pub(crate) fn section(normal: &Normal, profiles: &Field) -> (Section, Vec<u8>) {
    let planes = (0..normal.geometry.nodes).flat_map(|h| (0..3).map(move |c| (h, c)));
    let values = planes.flat_map(|(h, c)| {
        let mean = normal.mean[h][c];
        (0..normal.geometry.pixels()).map(move |pixel| profiles.at(pixel)[h][c] + mean)
    });
    (Section::LocalProfiles, logs(values))
}

/// A file of per-pixel profiles with the profiles that a material's pixels have: as large as what Song et al. 2009 store.
#[must_use]
pub fn per_pixel_of(material: &Bssrdf<'_>) -> Vec<u8> {
    let header =
        BssrdfHeader { model: MODEL_PER_PIXEL, coding: Coding::Exact, base_materials: 0, ..*material.header() };
    let pixels = (0..header.height).flat_map(|y| (0..header.width).map(move |x| [x, y].map(u32::cast_signed)));
    let profiles: Vec<_> = pixels.map(|pixel| material.profile(pixel)).collect();
    let mut values = Vec::new();
    for h in 0..header.samples {
        // Nodes are at equal distances up to r_max.
        let r_mm = header.r_max_mm * f32::from(h) / f32::from(header.samples - 1);
        let knot = material.knot(r_mm.min(header.r_max_mm));
        for c in 0..3 {
            let node = |profile: &LocalProfile<'_>| knot.map_or(f32::MIN, |knot| profile.at(knot)[c]);
            values.extend(profiles.iter().flat_map(|profile| node(profile).to_le_bytes()));
        }
    }
    write_file(&header, &[(Section::LocalProfiles, values)])
}
