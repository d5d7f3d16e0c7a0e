//! Sizes that must not grow.

use subsurf_decoder::bssrdf::Addressing;
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
    assert_eq!(onyx.per_pixel().len(), 12 * 229 * 229 * 25 + 108, "12 N S and its header");
}
