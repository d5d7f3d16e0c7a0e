//! What the three channels of a matrix are, and how they become linear RGB again.

use glam::{Mat3, Vec3};

/// Added before logarithms were taken. It is not in the files; public readers agree on it.
const EPSILON: f32 = 1e-5;

/// RGB from luma and two differences, columns Y, U and V (BT.470).
const RGB_FROM_YUV: Mat3 =
    Mat3::from_cols(Vec3::ONE, Vec3::new(0.0, -0.394_65, 2.032_11), Vec3::new(1.139_83, -0.580_6, 0.0));
/// RGB from Y, Co and Cg, in columns.
const RGB_FROM_YCOCG: Mat3 = Mat3::from_cols(Vec3::ONE, Vec3::new(1.0, 0.0, -1.0), Vec3::new(-1.0, 1.0, -1.0));

/// Colour model of a file, by its number there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Colour {
    /// 0: linear RGB.
    Rgb,
    /// 1: Y, U, V.
    Yuv,
    /// 3: principal axes of the material's own colours, and their mean.
    Axes(Mat3, Vec3),
    /// 4: Y, Co, Cg.
    YCoCg,
    /// 9: log Y, U, V.
    LogLuma,
    /// 10: log of all three, of U and V with the sign that they had.
    LogYuv,
    /// 11: log Y, U / Y, V / Y. That of the database.
    LogLumaRatios,
    /// 12; also what "dynamic range reduction" of plain RGB is.
    LogRgb,
}

impl Colour {
    /// By the file's number; the mean and the axes, row by row, are of number 3 alone. Says what it is if it is not
    /// read.
    pub(super) fn from_code(code: u32, mean: [f32; 3], axes: [f32; 9]) -> Result<Self, &'static str> {
        match code {
            0 => Ok(Self::Rgb),
            1 => Ok(Self::Yuv),
            2 => Err("CIE Lab of a white point that is not told"),
            // Channel i goes along row i.
            3 => Ok(Self::Axes(Mat3::from_cols_array(&axes), Vec3::from_array(mean))),
            4 => Ok(Self::YCoCg),
            5 | 6 => Err("a spectral one"),
            9 => Ok(Self::LogLuma),
            10 => Ok(Self::LogYuv),
            11 => Ok(Self::LogLumaRatios),
            12 => Ok(Self::LogRgb),
            _ => Err("not a known one"),
        }
    }

    /// Linear RGB of three channels.
    pub(super) fn decode(self, channels: [f32; 3]) -> Vec3 {
        let [a, b, c] = channels;
        match self {
            Self::Rgb => Vec3::from_array(channels),
            Self::Yuv => RGB_FROM_YUV * Vec3::from_array(channels),
            Self::Axes(axes, mean) => axes * Vec3::from_array(channels) + mean,
            Self::YCoCg => RGB_FROM_YCOCG * Vec3::from_array(channels),
            Self::LogLuma => RGB_FROM_YUV * Vec3::new(a.exp() - EPSILON, b, c),
            Self::LogYuv => {
                let signed = |log: f32| (log.abs().exp() * EPSILON).copysign(log);
                RGB_FROM_YUV * Vec3::new(a.exp() - EPSILON, signed(b), signed(c))
            }
            Self::LogLumaRatios => RGB_FROM_YUV * Vec3::new(a.exp() - EPSILON, b * a.exp(), c * a.exp()),
            Self::LogRgb => Vec3::from_array(channels.map(f32::exp)) - EPSILON,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// From linear RGB, as an encoder would make them.
    fn encode(colour: Colour, rgb: Vec3) -> [f32; 3] {
        let Vec3 { x: y, y: u, z: v } = RGB_FROM_YUV.inverse() * rgb;
        let log = |value: f32| (value + EPSILON).ln();
        match colour {
            Colour::Rgb => rgb.to_array(),
            Colour::Yuv => [y, u, v],
            Colour::Axes(axes, mean) => (axes.inverse() * (rgb - mean)).to_array(),
            Colour::YCoCg => {
                let [r, g, b] = rgb.to_array();
                [(r + 2.0 * g + b) / 4.0, (r - b) / 2.0, (2.0 * g - r - b) / 4.0]
            }
            Colour::LogLuma => [log(y), u, v],
            Colour::LogYuv => {
                let signed = |value: f32| (value.abs() / EPSILON).ln().copysign(value);
                [log(y), signed(u), signed(v)]
            }
            Colour::LogLumaRatios => [log(y), u / (y + EPSILON), v / (y + EPSILON)],
            Colour::LogRgb => rgb.to_array().map(log),
        }
    }

    #[test]
    fn colours_come_back() {
        let axes = [0.6, 0.7, 0.3, -0.7, 0.6, 0.1, 0.2, -0.3, 0.9];
        for code in [0, 1, 3, 4, 9, 10, 11, 12] {
            let colour = Colour::from_code(code, [0.3, 0.2, 0.1], axes).unwrap();
            for rgb in [Vec3::new(0.8, 0.3, 0.1), Vec3::new(0.01, 0.02, 0.04), Vec3::new(3.0, 2.0, 7.0)] {
                let back = colour.decode(encode(colour, rgb));
                assert!(
                    (back - rgb).abs().max_element() < 2e-5 * rgb.max_element().max(0.5),
                    "{code}: {back} for {rgb}"
                );
            }
        }
        // Luma of the three primaries: BT.601.
        let luma = RGB_FROM_YUV.inverse().row(0);
        assert!((luma - Vec3::new(0.299, 0.587, 0.114)).abs().max_element() < 1e-3, "{luma}");
    }

    #[test]
    fn rows_are_axes() {
        let axes = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0];
        let colour = Colour::from_code(3, [0.5; 3], axes).unwrap();
        assert_eq!(colour.decode([0.0, 1.0, 0.0]), Vec3::new(4.5, 5.5, 6.5));
    }

    #[test]
    fn other_models_are_refused() {
        for (code, reason) in
            [(2, "Lab"), (5, "spectral"), (6, "spectral"), (7, "not a known"), (u32::MAX, "not a known")]
        {
            assert!(Colour::from_code(code, [0.0; 3], [0.0; 9]).unwrap_err().contains(reason), "{code}");
        }
    }
}
