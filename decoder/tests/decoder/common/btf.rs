//! Small BTF files of both models, packed bit by bit here: nothing of it is the crate's own code but the headers.

use subsurf_decoder::btf::factored::layout::{CodewordStage, MAX_STAGES, TuckerShape};
use subsurf_decoder::btf::nested::layout::{ChromaSizes, CodebookSize, Scales, StageSizes};
use subsurf_decoder::btf::{BtfHeader, BtfModel, ColourEncoding, Grid, Material};

use super::container;

/// Draws of a generator (xorshift64).
struct Draw(u64);

impl Draw {
    fn below(&mut self, n: u32) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        u32::try_from((self.0 >> 33) % u64::from(n)).unwrap()
    }

    fn bytes(&mut self, count: usize) -> Vec<u8> {
        (0..count).map(|_| u8::try_from(self.below(256)).unwrap()).collect()
    }
}

const GRID: Grid = Grid {
    n_alpha: 3,
    n_beta: 2,
    n_theta: 2,
    n_phi: 3,
    alpha_max: 1.4,
    sin_beta_max: 0.9,
    theta_max: 1.3,
    cos_light_min: 0.1,
};

/// Two materials of 15 × 9 texels in two levels and of 2 × 1: 165 texels.
const TEXELS: u32 = 15 * 9 + 7 * 4 + 2;

fn begin(model: BtfModel) -> Vec<(&'static [u8; 4], Vec<u8>)> {
    let encoding = ColourEncoding::LogLuv { toe: 0.01, peak: 50.0 };
    let header = BtfHeader { model, encoding, materials: 2, grid: GRID, texel_mm: None };
    let material = |name: u8, width, height, levels| {
        let mut bytes = [0; 24];
        bytes[0] = name;
        Material { name: bytes, width, height, levels }.to_bytes()
    };
    let materials = [material(b'a', 15, 9, 2), material(b'b', 2, 1, 1)].concat();
    vec![(b"BTFH", header.to_bytes().to_vec()), (b"MATS", materials)]
}

/// Bits that `count` things take.
fn bits(count: u32) -> u32 {
    u32::BITS - (count - 1).leading_zeros()
}

/// Items one after the other from the lowest bit on, each of fields of a value and a number of bits; then eight bytes.
pub(crate) fn pack(items: impl IntoIterator<Item = Vec<(u32, u32)>>) -> Vec<u8> {
    let bits: Vec<u8> = items
        .into_iter()
        .flatten()
        .flat_map(|(value, bits)| (0..bits).map(move |bit| u8::from(value >> bit & 1 == 1)))
        .collect();
    let bytes = bits.chunks(8).map(|bits| bits.iter().rev().fold(0, |byte, bit| byte << 1 | bit));
    bytes.chain([0; 8]).collect()
}

/// Nested codebooks in two stages, with tints; tables of more and of fewer than 64 items.
pub(crate) fn nested() -> Vec<u8> {
    let mut draw = Draw(0x9E37_79B9_7F4A_7C15);
    let mut file = begin(BtfModel::Nested);
    let chroma = ChromaSizes {
        merged: 5,
        i2: 3,
        i1: 70,
        colours: 67,
        tints: 3,
        first: [0.1, 0.2],
        step: [0.001; 2],
        is_relative: false,
    };
    let scales = Scales { bits: 10, step: 1, offset: -600 };
    let size = |entries| CodebookSize { entries, scales };
    let stage = |p4, p3, p2, slices, is_signed| StageSizes {
        codebooks: [size(TEXELS), size(p4), size(p3), size(p2)],
        slices,
        is_signed,
    };
    let stages = [stage(5, 3, 66, 7, false), stage(3, 9, 2, 1, true)];
    let book = [&[chroma.to_bytes()][..], &stages.map(|stage| stage.to_bytes())].concat().concat();
    file.push((b"BOOK", book));
    let names: [[&[u8; 4]; 5]; 2] =
        [[b"P6S0", b"P4S0", b"P3S0", b"P2S0", b"P1S0"], [b"P6S1", b"P4S1", b"P3S1", b"P2S1", b"P1S1"]];
    for (number, (names, sizes)) in names.into_iter().zip(stages).enumerate() {
        let [_, p4, p3, p2] = sizes.codebooks.map(|codebook| codebook.entries);
        let below_p3 = if number == 0 { chroma.merged } else { p2 };
        let tints = if number == 0 { chroma.tints } else { 1 };
        let mut index = |len: u32| (draw.below(len), bits(len));
        let p6: Vec<_> = (0..TEXELS).map(|_| vec![index(p4), index(1024), index(tints)]).collect();
        let p4: Vec<_> = (0..p4 * 3).map(|_| vec![index(p3), index(1024)]).collect();
        let p3: Vec<_> = (0..p3 * 2).map(|_| vec![index(below_p3), index(1024)]).collect();
        let above: Vec<_> = (0..p2 * 3).map(|_| vec![index(sizes.slices), index(4)]).collect();
        let codes = draw.bytes(p2 as usize * 3);
        let slices = [draw.bytes(sizes.slices as usize * 3), vec![0; 8]].concat();
        let sections = [pack(p6), pack(p4), pack(p3), [codes, pack(above)].concat(), slices];
        file.extend(names.into_iter().zip(sections));
    }
    let mut index = |len: u32| (draw.below(len), bits(len));
    let merged: Vec<_> =
        (0..chroma.merged).map(|_| vec![index(stages[0].codebooks[3].entries), index(chroma.i2)]).collect();
    let i2: Vec<_> = (0..chroma.i2 * 3).map(|_| vec![index(chroma.i1)]).collect();
    let i1: Vec<_> = (0..chroma.i1 * 2).map(|_| vec![index(chroma.colours)]).collect();
    file.extend([(b"MERG", pack(merged)), (b"CHR2", pack(i2)), (b"CHR1", pack(i1))]);
    file.extend([(b"CHRC", draw.bytes(2 * 67)), (b"TINT", draw.bytes(2 * 3))]);
    container(&file)
}

/// A Tucker decomposition of two stages, with codes of any bits.
pub(crate) fn factored() -> Vec<u8> {
    let mut draw = Draw(0x5851_F42D_4C95_7F2D);
    let mut file = begin(BtfModel::Factored);
    let mut stages = [CodewordStage::default(); MAX_STAGES];
    stages[0] = CodewordStage { words: 9, first: 0, count: 4 };
    stages[1] = CodewordStage { words: 256, first: 2, count: 4 };
    let shape = TuckerShape { luma: 3, chroma: 1, view_axes: 2, light_axes: 3, stages, count: 2 };
    let numbers = 2 + 2 * 5 + 2 + 3;
    let steps = (1..=numbers).flat_map(|k: u8| (f32::from(k) / 16.0).to_le_bytes());
    let indices = (0..TEXELS).flat_map(|_| [9, 256].map(|words| u8::try_from(draw.below(words)).unwrap()));
    let indices = indices.collect();
    file.push((b"FACT", shape.to_bytes().chain(steps).collect()));
    file.extend([
        (b"AXES", draw.bytes(2 * 6 + 3 * 6)),
        (b"CORE", draw.bytes(300)),
        (b"WORD", draw.bytes(70)),
        (b"INDX", indices),
    ]);
    container(&file)
}
