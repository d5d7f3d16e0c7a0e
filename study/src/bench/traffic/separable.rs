//! Passes of a separable frame: how often each runs, on how many texels, and what it reads and writes there.

use subsurf_shaders::passes::{Choice, Pass, table};

use super::count::Assumptions;
use super::row::{Common, Counted, Row};

/// Numbers of a frame by which its passes are counted.
pub(super) struct SeparableFrame {
    pub(super) common: Common,
    /// L.
    pub(super) terms: usize,
    /// Taps to each side of every stage of the cascade; A of them.
    pub(super) taps: Vec<u32>,
    /// Texels of the maps, columns and rows.
    pub(super) maps: [u32; 2],
}

/// Bytes of a texel of a texture that passes read, by its name in the shaders.
fn texel_bytes(texture: &str) -> Option<f64> {
    Some(match texture {
        // Four half floats.
        "maps" | "sums" | "layers" | "tsm_fluxes" | "reflections" => 8.0,
        "tsm_positions" => 2.0,
        "tsm_uvs" => 4.0,
        _ => return None,
    })
}

impl SeparableFrame {
    /// All passes in the order in which they begin, where objects cover the whole picture once.
    pub(super) fn rows(&self) -> anyhow::Result<Vec<Row>> {
        let maps_bytes = 8 * self.terms as u64;
        let (last, stages) = (self.taps.len() - 1, &self.taps[..]);
        // Rows of all stages, columns of all but the last.
        let along: Vec<u32> = stages.iter().chain(&stages[..last]).copied().collect();
        let rows = [
            // Depths of 2 bytes, fluxes of 8 and places of 4.
            self.common.tsm_render(14)?,
            self.row(&table::SEPARABLE_GBUFFER, self.maps, &[0], 2 * maps_bytes)?,
            self.row(&table::BLUR_SCREEN, self.maps, &along, maps_bytes)?,
            self.row(&table::SUM_SCREEN, self.maps, &vec![0; last], maps_bytes)?,
            self.row(&table::BLUR_SCREEN_LAST, self.maps, &stages[last..], maps_bytes)?,
            // Colour of 4 bytes; depth stays on the chip, if the host does not want it.
            self.row(&table::SHADE_SEPARABLE, self.common.picture, &[0], 4)?,
        ];
        Ok(rows.into_iter().filter(|row| row.invocations > 0.0).collect())
    }

    /// Runs of a pass, of which blurs have so many taps to each side.
    fn row(&self, pass: &'static Pass, size: [u32; 2], taps: &[u32], written: u64) -> anyhow::Result<Row> {
        let begun = Counted::new(pass.with(Choice::Terms(self.terms)), pass.name(), size)?;
        let counted = taps.iter().try_fold(begun, |counted, taps| self.run(counted, *taps, written))?;
        Ok(counted.row())
    }

    /// Adds a run on an object that is mapped by texture coordinates.
    fn run(&self, counted: Counted, taps: u32, written: u64) -> anyhow::Result<Counted> {
        let Common { lights, facing, .. } = self.common;
        let assumed = Assumptions {
            turns: &[
                ("blurred", "k", f64::from(2 * taps + 1)),
                ("separable_gbuffer", "i", f64::from(lights)),
                ("shaded", "i", f64::from(lights)),
                // The four texels around a pixel; twelve more along edges.
                ("sums_at", "k", 4.0),
            ],
            shares: &[
                // Nothing but background.
                ("blurred", 0, 0.0),
                // By texture coordinates.
                ("layer_at", 0, 1.0),
                // Shadows are drawn, and none is the host's.
                ("visibility", 0, 0.0),
                ("visibility", 1, 0.0),
                ("transmitted", 0, 1.0),
                ("separable_gbuffer", 0, facing),
                ("separable_gbuffer", 1, 1.0 - facing),
                // Nothing spreads in a light volume, so that all is on the screen.
                ("separable_gbuffer", 2, 0.0),
                ("shaded", 0, facing),
            ],
        };
        counted.run(1.0, &assumed, written, &texel_bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(terms: usize, facing: f64) -> SeparableFrame {
        SeparableFrame {
            common: Common { lights: 1, light_size: [512; 2], picture: [20, 10], facing },
            terms,
            taps: vec![2, 4, 16],
            maps: [10, 10],
        }
    }

    /// Reads of every pass counted by hand in the shaders' text: whoever changes one, looks at the table of the documentation.
    #[test]
    fn reads_are_those_of_the_shaders() {
        for terms in [1, 2] {
            let l = terms as f64;
            for facing in [0.0, 0.5, 1.0] {
                let rows = frame(terms, facing).rows().unwrap();
                let found: Vec<(&str, f64)> = rows.iter().map(|row| (row.entry, row.reads)).collect();
                let taps = |taps: f64| l * (1.0 + 1.0 + 2.0 * taps + 1.0) + 1.0;
                let expected = [
                    ("tsm_render", 0.0),
                    // c_l and the albedo; 4 × 4 depths of the shadow, or depth, flux, place and c_l at 9 places.
                    ("separable_gbuffer", l + 1.0 + facing * 16.0 + (1.0 - facing) * 9.0 * (3.0 + l)),
                    // All maps at the texel, at the taps and at the one after them; depth at the one before.
                    ("blur_screen", (taps(2.0) + taps(4.0) + taps(16.0) + taps(2.0) + taps(4.0)) / 5.0),
                    ("sum_screen", 2.0 * l),
                    ("blur_screen_last", taps(16.0) + l),
                    // c_l and the albedo, sums of four texels, reflections, shadow.
                    ("shade_separable", l + 1.0 + 4.0 * l + 1.0 + facing * 16.0),
                ];
                for (found, expected) in found.iter().zip(expected) {
                    assert_eq!(found.0, expected.0);
                    assert!(
                        (found.1 - expected.1).abs() < 1e-9,
                        "L = {terms}, facing {facing}: {found:?} {expected:?}"
                    );
                }
                assert_eq!(found.len(), expected.len());
            }
        }
    }
}
