//! Scalar quantisation (Havran et al. 2010, section 4.5), once all codebooks are there.

use subsurf_decoder::btf::ColourEncoding;
use subsurf_decoder::btf::nested::layout::Scales;

use super::codebooks::{Codebooks, Scaled};
use super::functions::centre;
use crate::btf::nested::scales::{self, Fineness};
use crate::btf::nested::slices::to_bytes;
use crate::btf::nested::{Chain, Chroma, Item};

/// Bits of scales.
const BITS: u8 = 8;
/// Most bits of scales of P2 where images are linear: with one more, the finest steps reach farther than scales may. The
/// paper has 16, of steps that it does not tell.
const LINEAR_BITS: u8 = 11;

/// Scales and codes of gains, in the finest steps that leave the least error: finer ones do not reach small gains.
pub(super) fn quantised(items: &[Scaled], most_bits: u8) -> (Scales, Vec<Item>) {
    let with = |fineness: Fineness| {
        let scales = scales::scales(items.iter().map(|item| item.1), fineness, false);
        let code = |&(index, gain): &Scaled| Item { index, code: scales::code(scales, gain, false) };
        (scales, items.iter().map(code).collect::<Vec<Item>>())
    };
    let error = |(scales, codes): &(Scales, Vec<Item>)| -> f64 {
        let errors = items.iter().zip(codes).map(|((_, gain), item)| gain - scales::gain(*scales, item.code, false));
        errors.map(|error| f64::from(error * error)).sum()
    };
    let coarser = (1..=3).map(|step| Fineness { bits: BITS, step });
    let finer = (BITS..=most_bits).map(|bits| Fineness { bits, step: 0 });
    let tried = finer.chain(coarser).map(|fineness| {
        let codes = with(fineness);
        (error(&codes), codes)
    });
    // The first of equals, which has fewest bits.
    let best = tried.min_by(|a, b| a.0.total_cmp(&b.0)).expect("some were tried");
    best.1
}

/// Codebooks as a file has them, all but P6, and what they decode to.
pub(super) struct Quantised {
    pub(super) codebooks: Codebooks,
    pub(super) chain: Chain,
    pub(super) chroma: Chroma,
}

fn scaled(scales: Scales, items: &[Item]) -> Vec<Scaled> {
    items.iter().map(|item| (item.index, scales::gain(scales, item.code, false))).collect()
}

impl Quantised {
    pub(super) fn new(found: &Codebooks, tone: ColourEncoding) -> Self {
        let n_beta = found.n_beta();
        let mut codebooks = Codebooks::new(found.grid);
        let p1 = to_bytes(found.p1.values(), n_beta, false);
        let mut row = vec![0.0; n_beta];
        for bytes in p1.chunks_exact(n_beta + 1) {
            row.iter_mut().zip(bytes).for_each(|(value, byte)| *value = f32::from(*byte) / 255.0);
            codebooks.push_p1(&row);
        }
        let bits = if matches!(tone, ColourEncoding::LogLuv { .. }) { LINEAR_BITS } else { BITS };
        let (scales2, p2) = quantised(&found.p2, bits);
        let (scales3, p3) = quantised(&found.p3, BITS);
        let (scales4, p4) = quantised(&found.p4, BITS);
        scaled(scales2, &p2).chunks_exact(found.n_alpha()).for_each(|items| _ = codebooks.push_p2(items));
        let (first, step, colours) = codes(&found.colours);
        for colour in &colours {
            codebooks.push_colour([0, 1].map(|c: usize| first[c] + step[c] * f32::from(colour[c])));
        }
        found.i1.chunks_exact(n_beta).for_each(|row| _ = codebooks.push_i1(row));
        found.i2.chunks_exact(found.n_alpha()).for_each(|row| _ = codebooks.push_i2(row));
        found.merged.iter().for_each(|pair| _ = codebooks.merge(*pair));
        scaled(scales3, &p3).chunks_exact(found.n_theta()).for_each(|items| _ = codebooks.push_p3(items));
        scaled(scales4, &p4).chunks_exact(found.n_phi()).for_each(|items| _ = codebooks.push_p4(items));
        let centre = centre(tone);
        let chroma = Chroma {
            merged: codebooks.merged.clone(),
            i2: codebooks.i2.clone(),
            i1: codebooks.i1.clone(),
            colours,
            tints: Vec::new(),
            texel_tints: Vec::new(),
            first: first.map(|first| first - centre),
            step,
            is_relative: false,
        };
        let scales = [Scales::default(), scales4, scales3, scales2];
        let chain = Chain { texels: Vec::new(), p4, p3, p2, p1, scales, is_signed: false };
        Self { codebooks, chain, chroma }
    }
}

/// Chroma of code 0 and of a step, and codes.
fn codes(colours: &[[f32; 2]]) -> ([f32; 2], [f32; 2], Vec<[u8; 2]>) {
    let of = |c: usize| colours.iter().map(move |colour| colour[c]);
    let first = [0, 1].map(|c| of(c).fold(f32::INFINITY, f32::min));
    // Of a single colour as well.
    let step = [0, 1].map(|c: usize| ((of(c).fold(first[c], f32::max) - first[c]) / 255.0).max(1e-5));
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
    let code = |colour: &[f32; 2]| [0, 1].map(|c: usize| ((colour[c] - first[c]) / step[c]).round() as u8);
    (first, step, colours.iter().map(code).collect())
}
