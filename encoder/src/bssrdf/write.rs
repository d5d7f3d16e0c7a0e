//! Fitted models to `.subsurf` files, through the decoder's own layout.

use half::f16;
use subsurf_decoder::Section;
use subsurf_decoder::bssrdf::layout::{HEADER_BYTES, MAX_CODED_RATIO, MAX_LOG, MAX_PAIRS, MODEL_2BMPP};
use subsurf_decoder::bssrdf::{BssrdfHeader, Coding, Mixture};

use crate::file::container;

/// A file of one material: container, header, and the sections of its model in file order.
///
/// # Panics
/// Never for the handful of sections that there are.
#[must_use]
pub fn write_file(header: &BssrdfHeader, sections: &[(Section, Vec<u8>)]) -> Vec<u8> {
    let header = header.to_bytes();
    let sections = sections.iter().map(|(section, bytes)| (*section, &bytes[..]));
    container::write(std::iter::once((Section::BssrdfHeader, &header[..])).chain(sections))
}

/// Length of a K-BMPP file, with the largest palette there can be.
pub(crate) fn file_bytes(header: &BssrdfHeader, half_profiles: bool) -> u64 {
    let profiles = if half_profiles { Section::HalfProfiles } else { Section::BaseProfiles };
    let of_pixels: &[Section] = match (header.coding, header.model) {
        (Coding::Palette, _) => &[Section::Codes],
        (Coding::SmallRatios, _) => &[Section::SmallRatios, Section::BaseIndices],
        (Coding::Exact, 1) => &[Section::BaseIndices],
        (Coding::Exact, _) => &[Section::MixtureRatios, Section::BaseIndices],
    };
    let mut lengths = vec![HEADER_BYTES as u64, header.section_bytes(profiles)];
    if header.coding == Coding::Palette {
        let pairs = u64::from(header.base_materials) * u64::from(header.base_materials + 1) / 2;
        lengths.push(2 * pairs.min(MAX_PAIRS.into()).min(header.pixels()));
    }
    lengths.extend(of_pixels.iter().map(|section| header.section_bytes(*section)));
    container::file_bytes(&lengths)
}

/// Little-endian bytes of log-scale profile values, clamped to what the format allows.
pub(crate) fn logs(values: impl Iterator<Item = f32>) -> Vec<u8> {
    values.flat_map(|value| value.clamp(-MAX_LOG, MAX_LOG).to_le_bytes()).collect()
}

/// Base profiles in one of the two precisions.
pub fn profiles(values: impl Iterator<Item = f32>, half: bool) -> (Section, Vec<u8>) {
    if half {
        let values = values.map(|value| f16::from_f32(value.clamp(-MAX_LOG, MAX_LOG)));
        (Section::HalfProfiles, values.flat_map(f16::to_le_bytes).collect())
    } else {
        (Section::BaseProfiles, logs(values))
    }
}

/// The sections of all pixels' mixtures, as the header says: model and coding.
///
/// # Panics
/// If indices do not fit the header's M, or a palette has more than 2,048 pairs.
#[must_use]
pub fn mixtures(header: &BssrdfHeader, mixtures: &[Mixture]) -> Vec<(Section, Vec<u8>)> {
    let byte = |base: u16| u8::try_from(base).expect("at most 256 base materials");
    let pairs = || mixtures.iter().map(|mixture| [byte(mixture.bases[0]), byte(mixture.bases[1])]);
    let pair_bytes = || pairs().flatten().collect();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
    let level = |t: f32, levels: u16| (t * f32::from(levels)).round() as u16;
    let k = usize::from(header.model);
    match (header.coding, header.model) {
        (Coding::Palette, _) => {
            let mut palette: Vec<[u8; 2]> = pairs().collect();
            palette.sort_unstable();
            palette.dedup();
            let codes = mixtures.iter().zip(pairs()).flat_map(|(mixture, pair)| {
                let number = palette.binary_search(&pair).expect("every pair is in the palette");
                palette_code(number, level(mixture.ratios[0], MAX_CODED_RATIO)).to_le_bytes()
            });
            let codes = codes.collect();
            vec![(Section::Pairs, palette.into_flattened()), (Section::Codes, codes)]
        }
        (Coding::SmallRatios, _) => {
            let ratios = mixtures.iter().map(|mixture| level(mixture.ratios[0], u8::MAX.into()).to_le_bytes()[0]);
            vec![(Section::SmallRatios, ratios.collect()), (Section::BaseIndices, pair_bytes())]
        }
        (Coding::Exact, MODEL_2BMPP) => {
            let ratios = mixtures.iter().flat_map(|mixture| mixture.ratios[0].to_le_bytes());
            vec![(Section::MixtureRatios, ratios.collect()), (Section::BaseIndices, pair_bytes())]
        }
        (Coding::Exact, 1) if header.index_bytes() == 2 => {
            let indices = mixtures.iter().flat_map(|mixture| mixture.bases[0].to_le_bytes());
            vec![(Section::BaseIndices, indices.collect())]
        }
        (Coding::Exact, 1) => {
            vec![(Section::BaseIndices, mixtures.iter().map(|mixture| byte(mixture.bases[0])).collect())]
        }
        (Coding::Exact, _) => {
            let planes =
                || (0..k).flat_map(|k| mixtures.iter().map(move |mixture| (mixture.bases[k], mixture.ratios[k])));
            let ratios = planes().flat_map(|(_, t)| t.to_le_bytes()).collect();
            vec![
                (Section::MixtureRatios, ratios),
                (Section::BaseIndices, planes().map(|(base, _)| byte(base)).collect()),
            ]
        }
    }
}

/// A pair's number and a 5-bit ratio in one code.
fn palette_code(number: usize, t: u16) -> u16 {
    let number = u16::try_from(number).expect("at most 2,048 pairs");
    assert!(number < MAX_PAIRS, "a palette of more than 2,048 pairs");
    t * MAX_PAIRS + number
}
