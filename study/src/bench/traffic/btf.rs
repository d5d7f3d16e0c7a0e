//! Passes of a frame of a BTF: how often each runs, on how many texels, and what it reads and writes there.

use subsurf_runtime::{BtfLayout, BtfOptions};
use subsurf_shaders::passes::{Choice, table};
use subsurf_shaders::uniform::{BtfCodebooks, BtfFiltering};

use super::count::Assumptions;
use super::row::{Common, Counted, Row};

/// Numbers of a frame by which its passes are counted.
pub(super) struct BtfFrame {
    pub(super) common: Common,
    pub(super) options: BtfOptions,
    /// Additive stages.
    pub(super) stages: u32,
    /// Whether texels have tints.
    pub(super) has_tints: bool,
    /// Nodes n_alpha and n_beta of the grid of lights.
    pub(super) nodes: [u32; 2],
}

impl BtfFrame {
    /// Frame of nested codebooks.
    pub(super) fn new(common: Common, codebooks: &BtfCodebooks) -> Self {
        let [alpha, beta, ..] = codebooks.nodes;
        let (stages, has_tints) = (codebooks.stages, codebooks.tint_count > 0);
        Self { common, options: BtfOptions::default(), stages, has_tints, nodes: [alpha, beta] }
    }

    /// All passes in the order in which they begin, where objects cover the whole picture once, between two mipmap levels, and the
    /// nodes of view around a direction have chroma of their own.
    pub(super) fn rows(&self) -> anyhow::Result<Vec<Row>> {
        let Common { lights, picture, facing, .. } = self.common;
        let taps = match self.options.filtering {
            BtfFiltering::Nearest => 1.0,
            BtfFiltering::Bilinear => 4.0,
            BtfFiltering::Trilinear => 8.0,
        };
        let [alpha, beta] = self.nodes.map(|nodes| nodes.min(64));
        let assumed = Assumptions {
            turns: &[
                ("ambient_light", "k", self.options.samples.into()),
                ("shade_btf", "i", lights.into()),
                ("filtered_btf", "k", taps),
                // Two nodes of alpha at a time, and four of beta.
                ("light_sampler", "node", alpha.div_ceil(2).into()),
                ("add_slice", "k", beta.div_ceil(4).into()),
                ("luma_chroma", "stage", (self.stages - 1).into()),
            ],
            shares: &[
                // Nothing is read after these: either way.
                ("two_at", 0, 0.5),
                ("slice_values", 0, 0.5),
                ("shares_of", 0, 0.5),
                ("apparent_brdf", 0, if self.has_tints { 1.0 } else { 0.0 }),
                // A chroma for each node of view, not one for all.
                ("luma_chroma", 0, 1.0),
                ("luma_chroma", 1, 0.0),
                ("luma_chroma", 2, 0.5),
                // Lights are above the horizon, texels have a weight.
                ("btf_value", 0, 0.0),
                ("filtered_btf", 0, 1.0),
                ("shade_btf", 0, facing),
                // Shadows are drawn, and none is the host's.
                ("visibility", 0, 0.0),
                ("visibility", 1, 0.0),
            ],
        };
        let choice = Choice::LitBtf(BtfLayout::Nested, self.options.samples > 0);
        let shade = Counted::new(table::SHADE_BTF.with(choice), "shade_btf", picture)?;
        // Depths of 2 bytes, fluxes of 8 and places of 4; colour of 4 bytes.
        Ok(vec![self.common.tsm_render(14)?, shade.run(1.0, &assumed, 4, &texel_bytes)?.row()])
    }
}

/// Bytes of a texel of a texture that passes read, by its name in the shaders.
fn texel_bytes(texture: &str) -> Option<f64> {
    match texture {
        "words" => Some(4.0),
        "reflections" => Some(8.0),
        "tsm_positions" => Some(2.0),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reads counted by hand in the shaders' text: whoever changes one, looks at the table of the documentation.
    #[test]
    fn reads_are_those_of_the_shaders() {
        // Words for 32 bits at any place, and for two items that follow each other.
        let (bits, two) = (2.0, 3.0);
        for (stages, has_tints, samples, filtering, taps) in [
            (1, false, 0, BtfFiltering::Nearest, 1.0),
            (1, true, 8, BtfFiltering::Bilinear, 4.0),
            (3, true, 8, BtfFiltering::Trilinear, 8.0),
        ] {
            for facing in [0.0, 0.5, 1.0] {
                let frame = BtfFrame {
                    common: Common { lights: 2, light_size: [1024, 512], picture: [20, 10], facing },
                    options: BtfOptions { filtering, samples },
                    stages,
                    has_tints,
                    nodes: [11, 7],
                };
                let rows = frame.rows().unwrap();
                let tint = if has_tints { bits } else { 0.0 };
                // P4 at two nodes of phi, P3 at two of theta each.
                let corners = 2.0 * (bits + two);
                // P6, the corners, M at four nodes, the tint.
                let brdf = bits + corners + 4.0 * bits + tint;
                // P2 and the low bytes of its codes.
                let slices = two + bits;
                // With it exponents and values of two slices.
                let lumas = slices + 2.0 * (1.0 + bits);
                // I2 at two nodes of alpha, I1 at two of beta each, four colours.
                let chroma = two + 2.0 * two + 4.0 * bits;
                let later = bits + corners + 4.0 * lumas;
                let value = 4.0 * (lumas + chroma) + f64::from(stages - 1) * later;
                // P2 at six pairs of nodes of alpha for four nodes of view; for each sample slices of two nodes of alpha, in
                // words of four nodes of beta and one before them.
                let beta = 4.0 * (slices + 2.0 * (1.0 + 1.0 + 2.0));
                let ambient = match samples {
                    0 => 0.0,
                    count => brdf + 6.0 * 4.0 * slices + f64::from(count) * (beta + value + 1.0),
                };
                // Shadow of each light, and all texels.
                let direct = 2.0 * facing * (16.0 + taps * (brdf + value));
                let found: Vec<(&str, f64)> = rows.iter().map(|row| (row.entry, row.reads)).collect();
                let expected = [("tsm_render", 0.0), ("shade_btf", ambient + direct)];
                for (found, expected) in found.iter().zip(expected) {
                    assert_eq!(found.0, expected.0);
                    assert!((found.1 - expected.1).abs() < 1e-6, "{stages} stages, {facing}: {found:?} {expected:?}");
                }
                assert_eq!(found.len(), expected.len());
            }
        }
    }
}
