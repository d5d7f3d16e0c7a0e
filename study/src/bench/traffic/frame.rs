//! Passes of a separable frame: how often each runs, on how many texels, and what it reads and writes there.

use anyhow::Context;
use naga::Module;
use subsurf_shaders::TargetFormat;
use subsurf_shaders::passes::{Choice, Pass, table};

use super::count::{Assumptions, Reads, reads};

/// Numbers of a frame by which its passes are counted.
pub(super) struct FrameNumbers {
    /// L.
    pub(super) terms: usize,
    /// Taps to each side of every stage of the cascade; A of them.
    pub(super) taps: Vec<u32>,
    /// Number of lights.
    pub(super) lights: u32,
    /// Texels to a side of each light's view.
    pub(super) light_texels: u32,
    /// Texels of the maps, columns and rows.
    pub(super) maps: [u32; 2],
    /// Pixels of the picture.
    pub(super) picture: [u32; 2],
    /// Share of the pixels that face a light.
    pub(super) facing: f64,
}

/// Runs of one pass in a frame.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Row {
    /// Name of the pass.
    pub(super) pass: &'static str,
    /// Columns and rows that are drawn.
    pub(super) size: [u32; 2],
    /// Invocations of all runs.
    pub(super) invocations: u64,
    /// Reads of textures by an invocation, the mean over the runs.
    pub(super) reads: f64,
    /// Bytes that all runs read.
    pub(super) bytes_read: f64,
    /// Bytes that all runs write.
    pub(super) bytes_written: u64,
}

/// Bytes of a texel of a texture that passes read, by its name in the shaders.
fn texel_bytes(texture: &str) -> anyhow::Result<f64> {
    Ok(match texture {
        // Four half floats.
        "maps" | "sums" | "layers" | "tsm_fluxes" | "reflections" => 8.0,
        "tsm_positions" => 2.0,
        "tsm_uvs" => 4.0,
        _ => anyhow::bail!("bytes of a texel of {texture}"),
    })
}

impl FrameNumbers {
    /// All passes in the order in which they begin, where objects cover the whole picture once.
    pub(super) fn rows(&self) -> anyhow::Result<Vec<Row>> {
        let maps_bytes = 8 * self.terms as u64;
        let tiles = [self.light_texels * self.lights, self.light_texels];
        let (last, stages) = (self.taps.len() - 1, &self.taps[..]);
        // Rows of all stages, columns of all but the last.
        let along: Vec<u32> = stages.iter().chain(&stages[..last]).copied().collect();
        let rows = [
            // Depths of 2 bytes, fluxes of 8 and places of 4.
            self.row(&table::TSM_RENDER, Choice::None, tiles, &[0], 14)?,
            self.row(&table::SEPARABLE_GBUFFER, Choice::Terms(self.terms), self.maps, &[0], 2 * maps_bytes)?,
            self.row(&table::BLUR_SCREEN, Choice::Terms(self.terms), self.maps, &along, maps_bytes)?,
            self.row(&table::SUM_SCREEN, Choice::Terms(self.terms), self.maps, &vec![0; last], maps_bytes)?,
            self.row(&table::BLUR_SCREEN_LAST, Choice::Terms(self.terms), self.maps, &stages[last..], maps_bytes)?,
            // Colour of 4 bytes; depth stays on the chip, if the host does not want it.
            self.row(&table::SHADE_SEPARABLE, Choice::Terms(self.terms), self.picture, &[0], 4)?,
        ];
        Ok(rows.into_iter().filter(|row| row.invocations > 0).collect())
    }

    /// Runs of a pass, of which blurs have so many taps to each side.
    fn row(
        &self,
        pass: &'static Pass,
        choice: Choice,
        size: [u32; 2],
        taps: &[u32],
        texel_bytes_written: u64,
    ) -> anyhow::Result<Row> {
        let texels = u64::from(size[0]) * u64::from(size[1]);
        let module = naga::front::wgsl::parse_str(&pass.with(choice).wgsl(TargetFormat::Half))?;
        let (mut count, mut bytes) = (0.0, 0.0);
        for taps in taps {
            for (texture, reads) in self.reads(&module, pass.name(), *taps)? {
                count += reads;
                bytes += reads * texel_bytes(&texture)?;
            }
        }
        #[allow(clippy::cast_precision_loss, reason = "texels of a picture")]
        Ok(Row {
            pass: pass.name(),
            size,
            invocations: texels * taps.len() as u64,
            reads: count / taps.len().max(1) as f64,
            bytes_read: bytes * texels as f64,
            bytes_written: texels * taps.len() as u64 * texel_bytes_written,
        })
    }

    /// Reads of one invocation on an object, mapped by texture coordinates.
    fn reads(&self, module: &Module, pass: &str, taps: u32) -> anyhow::Result<Reads> {
        let lights = f64::from(self.lights);
        let assumed = Assumptions {
            turns: &[
                ("blurred", "k", f64::from(2 * taps + 1)),
                ("separable_gbuffer", "i", lights),
                ("shaded", "i", lights),
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
                ("separable_gbuffer", 0, self.facing),
                ("separable_gbuffer", 1, 1.0 - self.facing),
                ("shaded", 0, self.facing),
            ],
        };
        reads(module, pass, &assumed).with_context(|| pass.to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(terms: usize, facing: f64) -> FrameNumbers {
        FrameNumbers {
            terms,
            taps: vec![2, 4, 16],
            lights: 1,
            light_texels: 512,
            maps: [10, 10],
            picture: [20, 10],
            facing,
        }
    }

    /// Reads of every pass counted by hand in the shaders' text: whoever changes one, looks at the table of the documentation.
    #[test]
    fn reads_are_those_of_the_shaders() {
        for terms in [1, 2] {
            let l = terms as f64;
            for facing in [0.0, 0.5, 1.0] {
                let rows = numbers(terms, facing).rows().unwrap();
                let found: Vec<(&str, f64)> = rows.iter().map(|row| (row.pass, row.reads)).collect();
                let taps = |taps: f64| l * (1.0 + 2.0 * taps + 1.0);
                let expected = [
                    ("tsm_render", 0.0),
                    // c_l and the albedo; 4 × 4 depths of the shadow, or depth, flux, place and c_l at 9 places.
                    ("separable_gbuffer", l + 1.0 + facing * 16.0 + (1.0 - facing) * 9.0 * (3.0 + l)),
                    // All maps at the texel and at the taps.
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

    #[test]
    fn loops_and_branches_that_nobody_knows_are_named() {
        let module = |text: &str| naga::front::wgsl::parse_str(text).unwrap();
        let text = |body: &str| {
            format!(
                "@group(0) @binding(0) var t: texture_2d<f32>; @group(0) @binding(1) var<uniform> n: u32;
                 @fragment fn f() -> @location(0) vec4<f32> {{ var s = vec4<f32>(0.0); {body} return s; }}"
            )
        };
        let load = "s += textureLoad(t, vec2<u32>(0u), 0);";
        let none = Assumptions { turns: &[], shares: &[] };
        let of = |body: String, assumed: &Assumptions<'_>| reads(&module(&text(&body)), "f", assumed);
        assert_eq!(of(format!("for (var k = -1; k <= 2; k++) {{ {load} }}"), &none).unwrap()["t"], 4.0);
        let open = format!("for (var k = 0u; k < n; k++) {{ {load} }}");
        assert_eq!(of(open.clone(), &Assumptions { turns: &[("f", "k", 7.0)], shares: &[] }).unwrap()["t"], 7.0);
        assert!(of(open, &none).unwrap_err().to_string().contains("the loop over k in f"));
        let branch = format!("if n > 3u {{ {load} return s; }} {load} {load}");
        assert_eq!(of(branch.clone(), &Assumptions { turns: &[], shares: &[("f", 0, 0.25)] }).unwrap()["t"], 1.75);
        assert!(of(branch, &none).unwrap_err().to_string().contains("branch 0 of f"));
    }
}
