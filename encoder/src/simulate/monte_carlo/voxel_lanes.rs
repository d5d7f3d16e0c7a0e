//! Many packets side by side in a slab of many media.
//!
//! Woodcock, Murphy, Hemmings and Longworth 1965: all packets hop as if the extinction were the largest of the slab everywhere, and
//! where less is, some collisions are none. Lengths are in mean free paths of that.

use std::array;

use super::lanes::{LANES, Lanes, isotropic, ln, next, open_unit, unit};

/// Media around a lit pixel, in columns: squares of `side` to a side.
pub(super) struct Columns {
    /// Chance that a collision is one, and albedo, of each column, row by row.
    pub(super) media: Vec<[f32; 2]>,
    pub(super) side: usize,
    /// Columns in a mean free path.
    pub(super) columns_per_path: f32,
    /// Column that coordinate 0 is the lower end of.
    pub(super) origin: f32,
    /// Thickness of the slab.
    pub(super) thickness: f32,
    /// Weight below which a packet plays roulette.
    pub(super) light: f32,
}

/// What makes integers of floats: the lower bits of 2²³ + n are n.
const MAGIC: f32 = 8_388_608.0;

impl Columns {
    /// Number of the column at a coordinate; the last one goes on beyond.
    #[inline(always)]
    fn column(&self, coordinate: f32, last: f32) -> u32 {
        // Less a half: the sum is rounded to the nearest.
        let at = coordinate * self.columns_per_path + (self.origin - 0.5);
        let at = if at > 0.0 { at } else { 0.0 };
        let at = if at < last { at } else { last };
        (at + MAGIC).to_bits() & 0x007f_ffff
    }
}

impl Lanes {
    /// Collisions of all packets where they are, if they are ones, and hops to the next. Positions beyond both faces are for the caller
    /// to mend. Whether any packet came beyond them, or to roulette: `signs` say which.
    #[inline(always)]
    pub(super) fn collide_and_hop(&mut self, columns: &Columns) -> bool {
        let mut places = [0_u32; LANES];
        let (mut chances, mut albedos) = ([0.0_f32; LANES], [0.0_f32; LANES]);
        #[allow(clippy::cast_possible_truncation, clippy::cast_precision_loss, reason = "columns are few")]
        let (side, last) = (columns.side as u32, (columns.side - 1) as f32);
        for lane in 0..LANES {
            let [x, y] = [0, 1].map(|axis| columns.column(self.position[axis][lane], last));
            places[lane] = x + y * side;
        }
        for lane in 0..LANES {
            [chances[lane], albedos[lane]] = columns.media[places[lane] as usize];
        }
        let mut any = 0;
        for lane in 0..LANES {
            let mut state = array::from_fn(|k| self.state[k][lane]);
            let [first, second, third, fourth] = array::from_fn(|_| next(&mut state));
            for k in 0..4 {
                self.state[k][lane] = state[k];
            }
            let collides = unit(first) < chances[lane];
            let turned = isotropic(unit(second), unit(third));
            let s = -ln(open_unit(fourth));
            let weight = self.factor[lane] * if collides { albedos[lane] } else { 1.0 };
            self.factor[lane] = weight;
            for axis in 0..3 {
                let straight = self.direction[axis][lane];
                let u = if collides { turned[axis] } else { straight };
                self.direction[axis][lane] = u;
                self.position[axis][lane] += s * u;
            }
            self.collisions[lane] += 1;
            let left = self.roulette_at[lane].wrapping_sub(1).wrapping_sub(self.collisions[lane]);
            let z = self.position[2][lane];
            let signs = z.to_bits()
                | (columns.thickness - z).to_bits()
                | (self.roulette_below[lane] - z).to_bits()
                | (weight - columns.light).to_bits()
                | left;
            self.signs[lane] = signs;
            any |= signs;
        }
        any >> 31 != 0
    }
}
