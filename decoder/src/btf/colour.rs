//! From luma and chroma to colours, and back.

/// Meaning of the three channels of a file, luma and two of chroma.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ColourEncoding {
    /// 8-bit images: Y, Cr and Cb of sRGB values (Rec. 601), 1 standing for `white` in linear units.
    Display {
        /// Linear value of display white.
        white: f32,
    },
    /// Linear images: l = log2(1 + Y / toe) / log2(1 + peak / toe), and CIE 1976 u' and v' (Larson 1998, with a toe).
    LogLuv {
        /// Luminance below which l is nearly linear, above 0.
        toe: f32,
        /// Luminance at l = 1, at least `toe`.
        peak: f32,
    },
}

/// Factors of chroma: Cr = 0.713 (R − Y), Cb = 0.564 (B − Y).
pub const CHROMA: [f32; 2] = [0.713, 0.564];
/// Weights of R, G and B in Y (Rec. 601).
pub const LUMA: [f32; 3] = [0.299, 0.587, 0.114];
/// Linear Rec. 709 from XYZ.
const RGB_FROM_XYZ: [[f32; 3]; 3] =
    [[3.240_97, -1.537_383, -0.498_611], [-0.969_244, 1.875_968, 0.041_555], [0.055_63, -0.203_977, 1.056_972]];
/// XYZ from linear Rec. 709.
const XYZ_FROM_RGB: [[f32; 3]; 3] =
    [[0.412_391, 0.357_584, 0.180_481], [0.212_639, 0.715_169, 0.072_192], [0.019_331, 0.119_195, 0.950_532]];
/// u' and v' of the white D65, for black.
const WHITE_UV: [f32; 2] = [0.197_83, 0.468_32];

fn product(matrix: &[[f32; 3]; 3], [x, y, z]: [f32; 3]) -> [f32; 3] {
    matrix.map(|[a, b, c]| a * x + b * y + c * z)
}

impl ColourEncoding {
    /// Luma and two chroma channels of a pixel as images have it: sRGB values 0 to 1, or linear ones.
    #[must_use]
    pub fn encode(self, rgb: [f32; 3]) -> [f32; 3] {
        match self {
            Self::Display { .. } => {
                let [r, g, b] = rgb;
                let [wr, wg, wb] = LUMA;
                let y = wr * r + wg * g + wb * b;
                let [kr, kb] = CHROMA;
                [y, kr * (r - y), kb * (b - y)]
            }
            Self::LogLuv { toe, .. } => {
                let [x, y, z] = product(&XYZ_FROM_RGB, rgb.map(|value| value.max(0.0)));
                let sum = x + 15.0 * y + 3.0 * z;
                let [u, v] = if sum > 0.0 { [4.0 * x / sum, 9.0 * y / sum] } else { WHITE_UV };
                [libm::log2f(1.0 + y / toe) / self.octaves(), u, v]
            }
        }
    }

    /// log2(1 + peak / toe), which is worth keeping for many pixels; 0 of displays.
    #[must_use]
    pub(in crate::btf) fn octaves(self) -> f32 {
        match self {
            Self::Display { .. } => 0.0,
            Self::LogLuv { toe, peak } => libm::log2f(1.0 + peak / toe),
        }
    }

    /// Pixel as images have it: sRGB values 0 to 1, or linear ones from 0.
    #[must_use]
    pub fn decode(self, channels: [f32; 3]) -> [f32; 3] {
        self.decode_in(self.octaves(), channels)
    }

    /// [`Self::decode`] with [`Self::octaves`].
    #[inline]
    pub(in crate::btf) fn decode_in(self, octaves: f32, [y, a, b]: [f32; 3]) -> [f32; 3] {
        match self {
            Self::Display { .. } => {
                const PER_CHROMA: [f32; 2] = [1.0 / CHROMA[0], 1.0 / CHROMA[1]];
                const PER_GREEN: f32 = 1.0 / LUMA[1];
                let ([wr, _, wb], [per_a, per_b]) = (LUMA, PER_CHROMA);
                let (red, blue) = (y + a * per_a, y + b * per_b);
                [red, (y - wr * red - wb * blue) * PER_GREEN, blue].map(|value| value.clamp(0.0, 1.0))
            }
            Self::LogLuv { toe, .. } => {
                let luminance = toe * (libm::exp2f(y.clamp(0.0, 2.0) * octaves) - 1.0);
                // Of colours, u' and v' are less than 0.63, and v' is above 0.
                let (u, v) = (a.clamp(0.0, 1.0), b.clamp(0.01, 1.0));
                let (x, z) = (2.25 * u / v, (3.0 - 0.75 * u) / v - 5.0);
                product(&RGB_FROM_XYZ, [x * luminance, luminance, z * luminance]).map(|value| value.max(0.0))
            }
        }
    }

    /// Linear values of a pixel that [`Self::decode`] gave.
    #[must_use]
    pub fn linear(self, rgb: [f32; 3]) -> [f32; 3] {
        match self {
            Self::Display { white } => rgb.map(|value| white * srgb_to_linear(value)),
            Self::LogLuv { .. } => rgb,
        }
    }
}

/// IEC 61966-2-1, from display to linear; 1 is white in both.
fn srgb_to_linear(value: f32) -> f32 {
    if value <= 0.040_45 { value / 12.92 } else { libm::powf((value + 0.055) / 1.055, 2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_come_back() {
        let encodings = [ColourEncoding::Display { white: 1.0 }, ColourEncoding::LogLuv { toe: 0.01, peak: 50.0 }];
        for encoding in encodings {
            for rgb in [[0.2, 0.5, 0.9], [1.0; 3], [0.01, 0.02, 0.005], [0.9, 0.05, 0.1], [0.0; 3]] {
                let back = encoding.decode(encoding.encode(rgb));
                let error = rgb.iter().zip(back).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
                assert!(error < 2e-4, "{encoding:?}: {rgb:?} {back:?}");
            }
        }
        let bright = ColourEncoding::LogLuv { toe: 0.01, peak: 50.0 };
        let [l, ..] = bright.encode([50.0; 3]);
        assert!((l - 1.0).abs() < 1e-3, "{l}: the peak");
        let [l, u, v] = bright.encode([0.0; 3]);
        assert_eq!(([l.to_bits()], [u, v]), ([0], WHITE_UV), "black has the chroma of white");
        let octaves = ColourEncoding::LogLuv { toe: 1.0, peak: 3.0 }.octaves();
        assert!((octaves - 2.0).abs() < 1e-6, "{octaves}: log2(1 + 3)");
    }

    #[test]
    fn display_values_become_linear() {
        let [mid, ..] = ColourEncoding::Display { white: 2.0 }.linear([0.5; 3]);
        assert!((mid - 2.0 * 0.214_041).abs() < 1e-5, "{mid}");
        // The straight part ends at 0.04045.
        let low = ColourEncoding::Display { white: 1.0 }.linear([0.02, 0.040_45, 0.0405]);
        for (found, due) in low.into_iter().zip([0.001_547_988, 0.003_130_805, 0.003_134_745]) {
            assert!((found - due).abs() < 1e-8, "{low:?}");
        }
    }
}
