//! Passes of a frame of splats: how often each runs, on how many texels, and what it reads and writes there.

use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::{BssrdfModel, Mixtures, Profiles};
use subsurf_runtime::{SplatLevels, layout_of};
use subsurf_shaders::MaterialLayout;
use subsurf_shaders::passes::{Choice, Variant, table};

use super::count::Assumptions;
use super::row::{Common, Counted, Row};

/// Numbers of a frame by which its passes are counted.
pub(super) struct SplatFrame {
    pub(super) common: Common,
    pub(super) material: Planes,
    /// Texels of the G-buffer and of the finest ring, columns and rows.
    pub(super) maps: [u32; 2],
    pub(super) levels: SplatLevels,
    /// Radius of scattering, in edges of samples of the first ring.
    pub(super) reach: f64,
}

/// Planes of a material on the device.
#[derive(Clone, Copy)]
pub(super) struct Planes {
    pub(super) layout: MaterialLayout,
    /// Bytes of a texel of the profiles, of mixture ratios, and of indices or codes of pairs.
    pub(super) bytes: [f64; 3],
}

/// Bytes of four half floats.
const WHOLE: u64 = 8;

impl Planes {
    /// Planes of a file.
    pub(super) fn of(material: &Bssrdf<'_>) -> Self {
        let bytes = match material.model() {
            BssrdfModel::PerPixel(_) => [4.0, 0.0, 0.0],
            BssrdfModel::BaseMaterials(planes) => {
                let profiles = if matches!(planes.profiles, Profiles::F32(_)) { 16.0 } else { 8.0 };
                let [ratios, indices] = match planes.mixtures {
                    Mixtures::One(_) => [0.0, 1.0],
                    Mixtures::OneOfMany(_) | Mixtures::Palette { .. } => [0.0, 2.0],
                    Mixtures::Two { .. } => [4.0, 2.0],
                    Mixtures::TwoSmall { .. } => [1.0, 2.0],
                    Mixtures::Several { .. } => [4.0, 1.0],
                };
                [profiles, ratios, indices]
            }
        };
        Self { layout: layout_of(material), bytes }
    }
}

impl SplatFrame {
    /// All passes in the order in which they begin, where objects cover the whole picture and the views of all lights once, as a
    /// surface that is smooth to them and faces them and the eye.
    pub(super) fn rows(&self) -> anyhow::Result<Vec<Row>> {
        let Common { light_size, picture, .. } = self.common;
        let plain = |variant: Variant, size, written| self.row(variant, variant.pass.name(), size, 1.0, written);
        let splat = table::SPLAT.with(Choice::Material(self.material.layout));
        let at = |level: u32| light_size.map(|side| (side >> level).max(1));
        let mut rows = vec![self.common.tsm_render(3 * WHOLE)?];
        for level in 1..self.levels.count() {
            rows.push(plain(table::TSM_REDUCE.only(), at(level), 3 * WHOLE)?);
        }
        rows.push(plain(table::SURFACE_GBUFFER.only(), self.maps, 3 * WHOLE)?);
        for ring in 0..self.levels.rings {
            // Four corners of every sample, and of those of the level before, by which this ring is refined: four times as many.
            rows.push(self.row(splat, "splat_quad", at(self.levels.first + ring), 4.0 + 16.0, 0)?);
            // Squares of all samples are added up, on the chip.
            let target = SplatLevels::ring_size(self.maps, ring);
            rows.push(self.ring(splat, ring, target)?);
        }
        rows.push(plain(table::SPLAT_RESOLVE.only(), self.maps, WHOLE)?);
        rows.push(plain(table::SHADE_SPLAT.only(), picture, 4)?);
        Ok(rows)
    }

    /// Edges of the samples of a ring from its middle to its inner and to its outer end.
    fn ends(&self, ring: u32) -> [f64; 2] {
        let [[inner, _], [_, outer]] = self.levels.fades(ring).map(|fade| fade.map(f64::from));
        [inner, outer.min(self.reach)].map(|edges| edges / f64::from(1_u32 << ring))
    }

    /// Squares of one ring: those of all samples that reach a texel.
    fn ring(&self, splat: Variant, ring: u32, target: [u32; 2]) -> anyhow::Result<Row> {
        let [inner, outer] = self.ends(ring);
        let squares = self.common.facing * (2.0 * outer).powi(2);
        // Of a square, the ring.
        let beyond = 1.0 - std::f64::consts::PI * (outer * outer - inner * inner) / (2.0 * outer).powi(2);
        let assumed = Assumptions { turns: &self.turns(), shares: &[("splat", 0, beyond), ("splat", 1, 0.0)] };
        Ok(Counted::new(splat, "splat", target)?.run(squares, &assumed, WHOLE, &|name| self.texel_bytes(name))?.row())
    }

    fn row(
        &self,
        variant: Variant,
        entry: &'static str,
        size: [u32; 2],
        for_each: f64,
        written: u64,
    ) -> anyhow::Result<Row> {
        let assumed = Assumptions {
            turns: &self.turns(),
            shares: &[
                // There is a surface in every texel of a light's view.
                ("tsm_reduce", 0, 1.0),
                ("tsm_reduce", 1, 0.0),
                // By texture coordinates.
                ("layer_at", 0, 1.0),
                // Of five samples four are of the level before, which are only taken where this one is not smooth.
                ("splat_quad", 0, 0.8),
                ("splat_quad", 1, 1.0),
                ("splat_quad", 2, 1.0),
                ("splat_quad", 3, 0.8),
                // Nothing but background.
                ("splat_resolve", 0, 1.0),
                // Shadows are drawn, and none is the host's.
                ("unspread_light", 0, 0.0),
                ("visibility", 0, 0.0),
                ("visibility", 1, 0.0),
                ("shaded", 0, self.common.facing),
            ],
        };
        Ok(Counted::new(variant, entry, size)?.run(for_each, &assumed, written, &|name| self.texel_bytes(name))?.row())
    }

    /// Turns of loops. Of the texels around a place only the first four are looked at, and twelve more along edges.
    fn turns(&self) -> [(&'static str, &'static str, f64); 5] {
        let lights = f64::from(self.common.lights);
        [
            ("splat_resolve", "number", f64::from(self.levels.rings)),
            ("ring_at", "k", 4.0),
            ("exitance", "k", 4.0),
            ("unspread_light", "i", lights),
            ("shaded", "i", lights),
        ]
    }

    /// Bytes of a texel of a texture that passes read, by its name in the shaders.
    fn texel_bytes(&self, texture: &str) -> Option<f64> {
        let [profiles, ratios, indices] = self.material.bytes;
        Some(match texture {
            "profiles" => profiles,
            "ratios" => ratios,
            "indices" | "codes" | "pairs" => indices,
            // Four half floats each.
            "tsm_positions" | "tsm_fluxes" | "tsm_uvs" | "positions" | "fluxes" | "uvs" | "albedos" | "ring_0"
            | "ring_1" | "ring_2" | "ring_3" | "ring_4" | "resolved" | "layers" | "reflections" => 8.0,
            _ => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reads of every pass counted by hand in the shaders' text: whoever changes one, looks at the table of the documentation.
    #[test]
    fn reads_are_those_of_the_shaders() {
        for facing in [0.0, 0.5, 1.0] {
            let frame = SplatFrame {
                common: Common { lights: 1, light_size: [512; 2], picture: [20, 10], facing },
                material: Planes { layout: MaterialLayout::Bmpp2, bytes: [16.0, 4.0, 2.0] },
                maps: [16, 8],
                levels: SplatLevels { first: 2, rings: 2 },
                reach: 5.0,
            };
            let rows = frame.rows().unwrap();
            // Two rings: the first ends 3.2 edges of its samples away; the second begins at 1 edge and ends at 2.5 edges of its
            // own, where scattering does.
            let circle = std::f64::consts::FRAC_PI_4;
            let second = circle * (1.0 - (1.0_f64 / 2.5).powi(2));
            // Place of the texel; there coordinates, both planes of the pixel, two nodes of two base materials of both pixels.
            let square = |share: f64| 1.0 + share * (1.0 + 2.0 + 8.0);
            // Flux and position; flux and range of the texel or its parent; of what is left coordinates and the pixel.
            let corner = 2.0 + 2.0 + 0.2 * (1.0 + 2.0);
            let expected = [
                ("tsm_render", 1.0, 0.0),
                // Flux, coordinates and position of four texels.
                ("tsm_reduce", 1.0, 12.0),
                ("tsm_reduce", 1.0, 12.0),
                ("tsm_reduce", 1.0, 12.0),
                ("surface_gbuffer", 1.0, 1.0),
                ("splat_quad", 20.0, corner),
                ("splat", facing * 6.4 * 6.4, square(circle)),
                ("splat_quad", 20.0, corner),
                ("splat", facing * 5.0 * 5.0, square(second)),
                // Depth; of two rings depth, light and albedo of four texels.
                ("splat_resolve", 1.0, 1.0 + 2.0 * 4.0 * 3.0),
                // Albedo, four texels, reflections, shadow.
                ("shade_splat", 1.0, 1.0 + 4.0 + 1.0 + facing * 16.0),
            ];
            assert_eq!(rows.len(), expected.len());
            for (row, (entry, for_each, reads)) in rows.iter().zip(expected) {
                assert_eq!(row.entry, entry);
                let texels = f64::from(row.size[0]) * f64::from(row.size[1]);
                assert!((row.invocations / texels - for_each).abs() < 1e-5, "facing {facing}: {row:?} {for_each}");
                let reads = if for_each > 0.0 { reads } else { 0.0 };
                assert!((row.reads - reads).abs() < 1e-6, "facing {facing}: {row:?} {reads}");
            }
        }
    }
}
