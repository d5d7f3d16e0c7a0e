//! The third step: every texel by the nearest entry of finished codebooks, and its gain.

use super::codebooks::{Codebooks, Scaled};
use super::functions::Function;
use super::insert::gain;
use super::measure::{Measure, Part, Piece, Tally};

/// Mean luma and chroma of 2-D slices, `[entry][φ_v][θ_v]`, by which those entries are found that are worth a closer look.
pub(super) struct Index<'a> {
    codebooks: &'a Codebooks,
    measure: &'a Measure,
    outlines: Vec<[f32; 3]>,
}

impl<'a> Index<'a> {
    pub(super) fn new(codebooks: &'a Codebooks, measure: &'a Measure) -> Self {
        let outline = |piece: &Piece| {
            let (p2, i2) = (piece.p2 as usize, piece.i2 as usize);
            let [a, b] = [0, 1].map(|c: usize| codebooks.decoded.chroma[c].mean(i2..i2 + 1));
            [piece.gain * codebooks.of_p2[p2], a, b]
        };
        let outlines = codebooks.of_p4.0.iter().map(outline).collect();
        Self { codebooks, measure, outlines }
    }

    /// The entry of P4 that is least far away, and its gain.
    pub(super) fn find(&self, function: &Function) -> Scaled {
        let count = self.codebooks.n_phi() * self.codebooks.n_theta();
        let (pieces, means) = &self.codebooks.of_p4;
        let part = Part::new(function, 0, count);
        let mean = part.mean();
        let outline = |slice: usize| {
            let rows = || slice..slice + 1;
            [function.luma.mean(rows()), function.chroma[0].mean(rows()), function.chroma[1].mean(rows())]
        };
        let outline: Vec<[f32; 3]> = (0..count).map(outline).collect();
        let distance = |entry: usize| -> f32 {
            let scale = gain(mean, means[entry]);
            let squares = |([y, a, b], [of_y, of_a, of_b]): (&[f32; 3], &[f32; 3])| {
                let (y, a, b) = (y - scale * of_y, a - of_a, b - of_b);
                y * y + a * a + b * b
            };
            outline.iter().zip(&self.outlines[entry * count..]).map(squares).sum()
        };
        // Near ones first: what is known of the best makes comparisons with the others short.
        let mut order: Vec<(f32, usize)> = (0..means.len()).map(|entry| (distance(entry), entry)).collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let (mut best, mut tally) = ((f32::INFINITY, order[0].1), Tally::default());
        for (_, entry) in order {
            let scale = gain(mean, means[entry]);
            let pieces = &pieces[entry * count..][..count];
            let found = self.measure.whole(&part, pieces, &self.codebooks.decoded, scale, best.0, &mut tally);
            if let Some(found) = found {
                best = (found, entry);
            }
        }
        (u32::try_from(best.1).expect("fewer than 2³² entries"), gain(mean, means[best.1]))
    }
}
