//! Built-in materials by name.

use subsurf_decoder::bssrdf::Addressing;

use super::patterns::{Pattern, blue_wax, chessboard, jade, marble, onyx, stone, yellow_wax};
use super::slab::MediumMap;
use crate::simulate::noise::Noise;

/// A built-in, synthetic material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BuiltinMaterial {
    /// Folded layers, each a mixture of its own.
    Onyx,
    /// Squares of two stones with a fine grain.
    Chessboard,
    /// Three media that blend into each other everywhere.
    Jade,
    /// White marble with clouds and dark veins.
    Marble,
    /// Grains of several stones in a matrix, as in artificial stone.
    Stone,
    /// Dyed wax that ran down in drops.
    BlueWax,
    /// Wax pressed from flakes.
    YellowWax,
}

impl BuiltinMaterial {
    /// All materials, in the order of the command's help.
    pub const ALL: [Self; 7] =
        [Self::Onyx, Self::Chessboard, Self::Jade, Self::Marble, Self::Stone, Self::BlueWax, Self::YellowWax];

    /// Name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Onyx => "onyx",
            Self::Chessboard => "chessboard",
            Self::Jade => "jade",
            Self::Marble => "marble",
            Self::Stone => "stone",
            Self::BlueWax => "blue-wax",
            Self::YellowWax => "yellow-wax",
        }
    }

    /// Appearance in a few words.
    #[must_use]
    pub fn description(self) -> &'static str {
        match self {
            Self::Onyx => "folded, cloudy layers of marble, apple, wholemilk and skin2, some stained with ketchup",
            Self::Chessboard => "squares of marble, half of them dyed with ketchup, with a grain of apple",
            Self::Jade => "continuous blends of apple, marble and skin2",
            Self::Marble => "marble with clouds of wholemilk and veins of skin2 and ketchup",
            Self::Stone => "grains of marble, spectralon, skin2 and apple in a matrix of marble and chicken2",
            Self::BlueWax => "runs and drops of skimmilk and wholemilk with an invented blue pigment",
            Self::YellowWax => "flakes of potato, cream and apple, some with a little ketchup",
        }
    }

    /// The media of a patch of `size` pixels. Patterns keep their size in pixels; a patch that repeats is tileable.
    #[must_use]
    pub fn map(self, size: [usize; 2], addressing: Addressing, seed: u64) -> MediumMap {
        let noise = Noise::new(seed);
        let pattern = Pattern::new(size, addressing);
        let recipe = match self {
            Self::Onyx => onyx,
            Self::Chessboard => chessboard,
            Self::Jade => jade,
            Self::Marble => marble,
            Self::Stone => stone,
            Self::BlueWax => blue_wax,
            Self::YellowWax => yellow_wax,
        };
        let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
        let media = pixels.map(|(x, y)| recipe(&noise, &pattern, pattern.uv(x, y))).collect();
        MediumMap { size, media }
    }
}
