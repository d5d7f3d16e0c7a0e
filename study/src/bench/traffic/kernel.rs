//! Passes of a frame of a separable kernel: how often each runs, on how many texels, and what it reads and writes there.

use subsurf_shaders::passes::{Pass, kernel};

use super::count::Assumptions;
use super::row::{Common, Counted, Row};

/// Numbers of a frame by which its passes are counted.
pub(super) struct KernelFrame {
    pub(super) common: Common,
    /// Terms of the kernel.
    pub(super) terms: u32,
    /// Taps of one side with the centre.
    pub(super) side: u32,
    /// Whether a third of the taps are turned off the axes.
    pub(super) is_jittered: bool,
    /// Texels of the maps, columns and rows.
    pub(super) maps: [u32; 2],
}

/// Bytes of a texel of a texture that passes read, by its name in the shaders.
fn texel_bytes(texture: &str) -> Option<f64> {
    Some(match texture {
        // Four half floats.
        "light" | "sums" | "tsm_fluxes" | "reflections" => 8.0,
        "tail" => 16.0,
        "tsm_positions" => 2.0,
        _ => return None,
    })
}

impl KernelFrame {
    /// All passes in the order in which they begin, where objects cover the whole picture once.
    pub(super) fn rows(&self) -> anyhow::Result<Vec<Row>> {
        Ok(vec![
            // Depths of 2 bytes, fluxes of 8 and places of 4.
            self.common.tsm_render(14)?,
            self.row(&kernel::KERNEL_GBUFFER, self.maps, 1, 16)?,
            self.row(&kernel::BLUR_KERNEL, self.maps, self.terms, 8)?,
            self.row(&kernel::SUM_KERNEL, self.maps, self.terms, 8)?,
            // Colour of 4 bytes; depth stays on the chip, if the host does not want it.
            self.row(&kernel::SHADE_KERNEL, self.common.picture, 1, 4)?,
        ])
    }

    /// Runs of a pass.
    fn row(&self, pass: &'static Pass, size: [u32; 2], runs: u32, written: u64) -> anyhow::Result<Row> {
        let begun = Counted::new(pass.only(), pass.name(), size)?;
        Ok((0..runs).try_fold(begun, |counted, _| self.run(counted, written))?.row())
    }

    fn run(&self, counted: Counted, written: u64) -> anyhow::Result<Counted> {
        let Common { lights, facing, .. } = self.common;
        let taps = self.side - 1;
        // Taps number 1, 4, 7, ...
        let turned = if self.is_jittered { f64::from(taps.div_ceil(3)) / f64::from(taps) } else { 0.0 };
        let assumed = Assumptions {
            turns: &[
                ("blurred", "i", f64::from(taps)),
                ("kernel_gbuffer", "i", f64::from(lights)),
                ("shaded", "i", f64::from(lights)),
                // The four texels around a pixel; twelve more along edges.
                ("sums_at", "k", 4.0),
            ],
            shares: &[
                ("blurred", 0, turned),
                // Shadows are drawn, and none is the host's.
                ("visibility", 0, 0.0),
                ("visibility", 1, 0.0),
                ("transmitted", 0, 1.0),
                ("kernel_gbuffer", 0, facing),
                ("kernel_gbuffer", 1, 1.0 - facing),
                ("shaded", 0, facing),
            ],
        };
        counted.run(1.0, &assumed, written, &texel_bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reads of every pass counted by hand in the shaders' text.
    #[test]
    fn reads_are_those_of_the_shaders() {
        for (is_jittered, facing) in [(false, 0.0), (true, 0.5), (true, 1.0)] {
            let common = Common { lights: 1, light_size: [512; 2], picture: [20, 10], facing };
            let frame = KernelFrame { common, terms: 2, side: 9, is_jittered, maps: [10, 10] };
            let rows = frame.rows().unwrap();
            // The centre; of eight taps on each side three are turned, and the others read the texel after theirs, too.
            let blurred = if is_jittered { 1.0 + 3.0 * 2.0 + 5.0 * 4.0 } else { 1.0 + 8.0 * 4.0 };
            let expected = [
                ("tsm_render", 0.0, 0.0),
                // 4 × 4 depths of the shadow, or flux, depth and two nodes of the tail at 9 places.
                ("kernel_gbuffer", facing * 16.0 + (1.0 - facing) * 9.0 * 4.0, 100.0),
                ("blur_kernel", blurred, 200.0),
                ("sum_kernel", blurred + 1.0, 200.0),
                // Sums of four texels, reflections, shadow.
                ("shade_kernel", 4.0 + 1.0 + facing * 16.0, 200.0),
            ];
            assert_eq!(rows.len(), expected.len());
            for (row, (entry, reads, invocations)) in rows.iter().zip(expected) {
                assert_eq!(row.entry, entry);
                assert!((row.reads - reads).abs() < 1e-9, "facing {facing}: {row:?}, {reads}");
                assert!(entry == "tsm_render" || (row.invocations - invocations).abs() < 1e-9, "{row:?}");
            }
        }
    }
}
