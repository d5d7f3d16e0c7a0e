//! Sizes that must not grow.

use subsurf_decoder::bssrdf::{Addressing, Coding};
use subsurf_encoder::synthetic::Shape;

/// Container and header of a file, at most.
const HEADER_BUDGET: usize = 256;

#[test]
fn two_bmpp_takes_48_bits_per_pixel() {
    // The paper's onyx: 229 × 229 pixels, M = 128, S = 25.
    let onyx = Shape { size: [229, 229], radius: 19, samples: 25, base_materials: 128, addressing: Addressing::Clamp };
    let file = onyx.bmpp();
    let planes = 12 * 128 * 25 + 6 * 229 * 229;
    assert_eq!(planes, 353_046);
    assert_eq!(file.len(), planes + 156, "12 M S + 6 N and the header that FORMAT.md states");
    assert!(file.len() <= planes + HEADER_BUDGET, "{} bytes", file.len());
    // 8 bits, 40 K bits; and the smaller kinds of 2-BMPP.
    let (profiles, n) = (12 * 128 * 25, 229 * 229);
    assert_eq!(onyx.k_bmpp(1, Coding::Exact, false).len(), profiles + n + 132, "K = 1");
    let many = Shape { base_materials: 1_221, ..onyx };
    assert_eq!(many.k_bmpp(1, Coding::Exact, false).len(), 12 * 1_221 * 25 + 2 * n + 132, "K = 1, M > 256");
    assert_eq!(onyx.k_bmpp(3, Coding::Exact, false).len(), profiles + 15 * n + 156, "K = 3");
    assert_eq!(onyx.k_bmpp(5, Coding::Exact, false).len(), profiles + 25 * n + 156, "K = 5");
    // N is odd: fill keeps the next section at a multiple of 4.
    assert_eq!(onyx.k_bmpp(2, Coding::SmallRatios, false).len(), profiles + 3 * n + 3 + 156, "24 bits per pixel");
    let few = Shape { base_materials: 40, ..onyx };
    let palette = few.k_bmpp(2, Coding::Palette, true);
    let pairs = 2 * 40 * 40;
    assert!(palette.len() <= 6 * 40 * 25 + 2 * n + pairs + 2 + 156, "16 bits per pixel: {}", palette.len());
    assert_eq!(onyx.per_pixel().len(), 12 * 229 * 229 * 25 + 108, "12 N S and its header");
}
