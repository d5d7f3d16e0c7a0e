//! Filters of elements after mode 0: what their numbers stand for.

/// Unit vector in eight bits each: x and y of an octahedron, and what one is.
pub(super) fn octahedral_8(element: &mut [u8; 4]) {
    let [x, y, one, _] = element.map(|byte| f32::from(byte.cast_signed()));
    for (k, value) in octahedral(x, y, one).into_iter().enumerate() {
        #[allow(clippy::cast_possible_truncation, reason = "at most 127")]
        let value = (value * 127.0).round() as i8;
        element[k] = value.cast_unsigned();
    }
}

/// The same in sixteen bits.
pub(super) fn octahedral_16(element: &mut [u8; 8]) {
    let [x, y, one, _] = halves(element).map(f32::from);
    for (k, value) in octahedral(x, y, one).into_iter().enumerate() {
        set(element, k, value);
    }
}

fn octahedral(x: f32, y: f32, one: f32) -> [f32; 3] {
    let (x, y) = (x / one, y / one);
    let z = 1.0 - x.abs() - y.abs();
    // The lower half is folded outwards.
    let fold = z.min(0.0);
    let (x, y) = (x - fold.copysign(x), y - fold.copysign(y));
    let length = (x * x + y * y + z * z).sqrt();
    [x, y, z].map(|value| value / length)
}

/// Unit quaternion without its largest component, which is named by the lowest two bits of what one is.
pub(super) fn quaternion(element: &mut [u8; 8]) {
    let [x, y, z, one] = halves(element);
    let largest = usize::from(one.cast_unsigned() & 3);
    let scale = std::f32::consts::FRAC_1_SQRT_2 / f32::from(one | 3);
    let [x, y, z] = [x, y, z].map(|value| f32::from(value) * scale);
    let w = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
    for (k, value) in [w, x, y, z].into_iter().enumerate() {
        set(element, (largest + k) % 4, value);
    }
}

/// Float with an exponent of eight bits and a mantissa of 24.
pub(super) fn exponential(element: &mut [u8; 4]) {
    let value = i32::from_le_bytes(*element);
    let mantissa = f64::from((value << 8) >> 8);
    #[allow(clippy::cast_possible_truncation, reason = "a float of single precision is meant")]
    let value = (mantissa * f64::from(value >> 24).exp2()) as f32;
    *element = value.to_le_bytes();
}

fn halves(element: &[u8; 8]) -> [i16; 4] {
    [0, 2, 4, 6].map(|k| i16::from_le_bytes([element[k], element[k + 1]]))
}

#[allow(clippy::cast_possible_truncation, reason = "at most 32767")]
fn set(element: &mut [u8; 8], k: usize, value: f32) {
    let bytes = ((value * 32767.0).round() as i16).to_le_bytes();
    element[2 * k..2 * k + 2].copy_from_slice(&bytes);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_and_rotations_have_unit_length() {
        // The pole; a point of the equator; one of the lower half.
        for (element, expected) in [([0, 0, 127, 9], [0, 0, 127, 9]), ([127, 0, 127, 0], [127, 0, 0, 0])] {
            let mut element = element;
            octahedral_8(&mut element);
            assert_eq!(element, expected);
        }
        let pack = |values: [i16; 4]| {
            let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
            <[u8; 8]>::try_from(bytes).unwrap()
        };
        let mut element = pack([511, -511, 511, 5]);
        octahedral_16(&mut element);
        assert_eq!(halves(&element), [0, 0, -32767, 5], "(1, -1) is the lower pole");
        // The largest is y; the others are x = 0, z = 1/2, w = 1/2 of the order that follows it: z, w, x.
        let half = 1447;
        let mut element = pack([half, half, 0, 2047 & !3 | 1]);
        quaternion(&mut element);
        let [x, y, z, w] = halves(&element).map(|value| f32::from(value) / 32767.0);
        assert!(x.abs() < 1e-3 && (y - 0.5_f32.sqrt()).abs() < 1e-3, "{x} {y}");
        assert!((z - 0.5).abs() < 1e-3 && (w - 0.5).abs() < 1e-3, "{z} {w}");
    }

    #[test]
    fn floats_have_an_exponent_and_a_mantissa() {
        for (exponent, mantissa, value) in [(0, 3, 3.0_f32), (-1, -3, -1.5), (4, 1, 16.0), (-100, 0, 0.0)] {
            let packed: i32 = (exponent << 24) | (mantissa & 0xff_ffff);
            let mut element = packed.to_le_bytes();
            exponential(&mut element);
            assert_eq!(f32::from_le_bytes(element), value);
        }
    }
}
