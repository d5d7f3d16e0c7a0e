use super::*;
use crate::math::svd::LowRank;
use crate::synthetic::unit;

const PAIRS: usize = 16;
const TEXELS: usize = 60;

fn orthonormal(rows: usize, columns: usize, seed: u32) -> DMatrix<f32> {
    DMatrix::from_fn(rows, columns, |row, column| unit(seed + (row * columns + column) as u32) - 0.5).qr().q()
}

/// Two components of luma and one of chroma, in three groups of texels.
fn svd() -> TruncatedSvd {
    let luma = DMatrix::from_fn(2, TEXELS, |row, texel| {
        [[3.0, 0.5], [1.0, -2.0], [5.0, 1.0]][texel % 3][row] + 0.01 * unit(texel as u32)
    });
    let chroma = DMatrix::from_fn(1, TEXELS, |_, texel| [0.2, -0.4, 0.0][texel % 3]);
    TruncatedSvd {
        tone: ColourEncoding::Display { white: 1.0 },
        sizes: vec![[10, 6]],
        weights: (0..PAIRS).map(|pair| 0.5 + unit(pair as u32)).collect(),
        luma: LowRank { texels: luma, basis: orthonormal(PAIRS, 2, 100) },
        ratios: (0..TEXELS).map(|texel| [[0.1, -0.05], [0.0, 0.0], [-0.1, 0.2]][texel % 3]).collect(),
        chroma: LowRank { texels: chroma, basis: orthonormal(2 * PAIRS, 1, 500) },
        raw_bytes: 0,
    }
}

/// Y, Cr and Cb by the decomposition's own formula.
fn exact(svd: &TruncatedSvd, texel: usize, pair: usize) -> [f32; 3] {
    let weight = svd.weights[pair];
    let dot =
        |factors: &LowRank, row: usize| factors.texels.column(texel).dot(&factors.basis.row(row).transpose()) / weight;
    let y = dot(&svd.luma, pair);
    [
        y,
        svd.ratios[texel][0] * y + dot(&svd.chroma, 2 * pair),
        svd.ratios[texel][1] * y + dot(&svd.chroma, 2 * pair + 1),
    ]
}

fn largest_error(svd: &TruncatedSvd, found: &Baseline) -> f32 {
    let mut largest = 0.0_f32;
    for pair in 0..PAIRS {
        for (texel, rgb) in found.image(pair).iter().enumerate() {
            let expected = svd.tone.decode(exact(svd, texel, pair));
            largest = rgb.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(largest, f32::max);
        }
    }
    largest
}

#[test]
fn enough_components_give_everything_back() {
    let svd = svd();
    let found = pca(&svd, 7);
    assert_eq!(found.bytes, 7 * (3 * 16 + 60 + 8), "functions, coefficients and two steps");
    let error = largest_error(&svd, &found);
    assert!(error < 0.15, "8 bits of numbers to 20: {error}");
    assert!(largest_error(&svd, &pca(&svd, 1)) > 3.0 * error, "one component is not enough");
}

#[test]
fn clusters_have_components_of_their_own() {
    let svd = svd();
    let error = largest_error(&svd, &local_pca(&svd, 3, 1, 1));
    assert!(error < 0.15, "three groups, three clusters: {error}");
    assert!(largest_error(&svd, &local_pca(&svd, 1, 0, 1)) > 3.0 * error, "a mean of all is not enough");
    assert_eq!(local_pca_bytes(3, 1, 60, 16), 3 * (2 * 52 + 4) + 60 + 15, "two bits tell three apart");
}

/// Three codewords over the grid for three groups of texels: what is left is the grid's own error.
#[test]
fn codewords_are_whole_apparent_brdfs() {
    let svd = svd();
    let whole = Whole::new(&svd);
    let (means, part_of) = pca::k_means(&whole.texels, 3, 1);
    for texel in 0..TEXELS {
        assert_eq!(part_of[texel], part_of[texel % 3], "groups stay together");
        let distance = (whole.texels.column(texel) - means.column(part_of[texel].into())).norm();
        assert!(distance < 0.05, "{distance}");
    }
    let functions = whole.functions(&means);
    for (pair, texel) in (0..PAIRS).flat_map(|pair| (0..3).map(move |texel| (pair, texel))) {
        let expected = exact(&svd, texel, pair);
        for (channel, expected) in expected.into_iter().enumerate() {
            let found = functions[(3 * pair + channel, part_of[texel].into())];
            assert!((found - expected).abs() < 0.05, "{found} {expected}");
        }
    }
    assert_eq!(one_level_bytes(3, 60, &Grid::PAPER), 3 * (3 * 121 * 112 + 24) + 15, "8 bits a node and channel");
}
