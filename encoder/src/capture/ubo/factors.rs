//! The factors of the matrix: where they lie, and products of their rows.

use super::colour::Colour;
use super::header::{Header, Kind};
use crate::capture::bytes::Bytes;
use crate::error::Result;

/// Type of a matrix's elements.
#[derive(Clone, Copy, Debug)]
enum Scalar {
    F16,
    F32,
    F64,
}

impl Scalar {
    fn bytes(self) -> usize {
        match self {
            Self::F16 => 2,
            Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// Values one after another.
    fn values(self, bytes: &[u8]) -> Vec<f32> {
        match self {
            Self::F16 => bytes.as_chunks().0.iter().copied().map(from_f16).collect(),
            Self::F32 => bytes.as_chunks().0.iter().copied().map(f32::from_le_bytes).collect(),
            Self::F64 => bytes.as_chunks().0.iter().copied().map(from_f64).collect(),
        }
    }

    /// Scalar product of values with as many weights.
    fn dot(self, bytes: &[u8], weights: &[f32]) -> f32 {
        match self {
            Self::F16 => dot(bytes.as_chunks().0, weights, from_f16),
            Self::F32 => dot(bytes.as_chunks().0, weights, f32::from_le_bytes),
            Self::F64 => dot(bytes.as_chunks().0, weights, from_f64),
        }
    }
}

/// Exactly as a float, in steps that compilers make vectors of: files have billions of these.
fn from_f16(bytes: [u8; 2]) -> f32 {
    let bits = u32::from(u16::from_le_bytes(bytes));
    // Exponents differ by 127 − 15 = 112. The largest stands for infinity, the least for values without a leading one.
    const LEAST: u32 = 113 << 23;
    let magnitude = (bits & 0x7FFF) << 13;
    let magnitude = match bits & 0x7C00 {
        0 => (f32::from_bits(magnitude + LEAST) - f32::from_bits(LEAST)).to_bits(),
        0x7C00 => magnitude | 0x7F80_0000,
        _ => magnitude + (112 << 23),
    };
    f32::from_bits(magnitude | (bits & 0x8000) << 16)
}

#[allow(clippy::cast_possible_truncation, reason = "values are wanted as floats")]
fn from_f64(bytes: [u8; 8]) -> f32 {
    f64::from_le_bytes(bytes) as f32
}

fn dot<const N: usize>(values: &[[u8; N]], weights: &[f32], read: impl Fn([u8; N]) -> f32) -> f32 {
    const LANES: usize = 8;
    let mut sums = [0.0; LANES];
    let ((values, last_values), (weights, last_weights)) = (values.as_chunks(), weights.as_chunks());
    for (values, weights) in values.iter().zip(weights) {
        let values: &[[u8; N]; LANES] = values;
        let weights: &[f32; LANES] = weights;
        for lane in 0..LANES {
            sums[lane] += read(values[lane]) * weights[lane];
        }
    }
    let last = last_values.iter().zip(last_weights).map(|(value, weight)| read(*value) * weight);
    sums.iter().sum::<f32>() + last.sum::<f32>()
}

/// Rows of a factor that belong to one channel.
#[derive(Clone, Copy, Debug)]
struct Rows {
    /// Offset of the first row in bytes.
    start: usize,
    /// Bytes from one row to the next.
    step_bytes: usize,
}

/// One channel: the product of a factor with a row for each pair of a light and a view, and one with a row for each
/// texel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Channel {
    scalar: Scalar,
    /// Length of a row.
    components: usize,
    pairs: Rows,
    texels: Rows,
}

impl Channel {
    fn row<'a>(&self, file: &'a [u8], rows: Rows, number: usize) -> &'a [u8] {
        &file[rows.start + number * rows.step_bytes..][..self.components * self.scalar.bytes()]
    }

    /// The row of a pair.
    pub(super) fn pair(&self, file: &[u8], pair: usize) -> Vec<f32> {
        self.scalar.values(self.row(file, self.pairs, pair))
    }

    /// Value of a texel: the product of its row with that of a pair.
    pub(super) fn value(&self, file: &[u8], texel: usize, pair: &[f32]) -> f32 {
        self.scalar.dot(self.row(file, self.texels, texel), pair)
    }
}

/// Reads what follows the header, to the end of the file: channels, and what they mean.
pub(super) fn parse(bytes: &mut Bytes<'_>, header: &Header) -> Result<([Channel; 3], Colour)> {
    let factors = match header.kind {
        Kind::Decorrelated => {
            bytes.u32("number of components")?;
            let code = bytes.u32("colour model")?;
            let (mean, axes) = (bytes.f32s("mean colour")?, bytes.f32s("colour axes")?);
            let colour = Colour::from_code(code, mean, axes)
                .map_err(|reason| bytes.wrong(format!("colour model {code}, {reason}"), "0, 1, 3, 4 or 9 to 12"))?;
            let mut channel = || {
                let scalar = scalar(bytes)?;
                matrices(bytes, header, scalar).map(|[channel]| channel)
            };
            ([channel()?, channel()?, channel()?], colour)
        }
        Kind::Full { extended } => {
            let colour = if extended { extension(bytes)? } else { Colour::Rgb };
            bytes.u32("number of components")?;
            let scalar = scalar(bytes)?;
            (matrices(bytes, header, scalar)?, colour)
        }
    };
    match bytes.rest().len() {
        0 => Ok(factors),
        more => Err(bytes.wrong(format!("{more} bytes after the last matrix"), "the end of the file")),
    }
}

/// The header of FMF's own: whether values are logarithms, and relief that is skipped.
fn extension(bytes: &mut Bytes<'_>) -> Result<Colour> {
    let version = bytes.u8("version of the FMF header")?;
    if version > 2 {
        return Err(bytes.wrong(format!("version {version} of the FMF header"), "0 to 2"));
    }
    let logarithms = version > 0 && bytes.u32("dynamic range reduction")? != 0;
    if version > 1 {
        let texels = u64::from(bytes.u32("width of the height map")?) * u64::from(bytes.u32("height of it")?);
        bytes.take(texels.saturating_mul(2), "height map")?;
    }
    Ok(if logarithms { Colour::LogRgb } else { Colour::Rgb })
}

fn scalar(bytes: &mut Bytes<'_>) -> Result<Scalar> {
    match bytes.u8("bytes of a number")? {
        2 => Ok(Scalar::F16),
        4 => Ok(Scalar::F32),
        8 => Ok(Scalar::F64),
        other => Err(bytes.wrong(format!("numbers of {other} bytes"), "2, 4 or 8")),
    }
}

/// U and S Vᵀ, the latter transposed, of `N` channels that alternate in the rows of U.
fn matrices<const N: usize>(bytes: &mut Bytes<'_>, header: &Header, scalar: Scalar) -> Result<[Channel; N]> {
    let [components, u_rows, v_rows] =
        [bytes.u32("number of components")?, bytes.u32("rows of U")?, bytes.u32("rows of S V")?];
    if components == 0 {
        return Err(bytes.wrong("no component", "at least one"));
    }
    let pairs = header.lights.len() as u64 * header.views.len() as u64;
    let texels = u64::from(header.size[0]) * u64::from(header.size[1]);
    let is = |u: u64, v: u64| u.checked_mul(N as u64) == Some(u_rows.into()) && v == u64::from(v_rows);
    // If both ways fit, U is that of pairs, as in the database.
    let by_pair = is(pairs, texels);
    if !by_pair && !is(texels, pairs) {
        let expected = format!("{pairs} pairs of directions, {texels} pixels and {N} channels");
        return Err(bytes.wrong(format!("matrices of {u_rows} and {v_rows} rows"), expected));
    }
    let row_bytes = u64::from(components) * scalar.bytes() as u64;
    bytes.take(row_bytes, "singular values")?;
    let u_start = bytes.at();
    bytes.take(row_bytes.saturating_mul(u_rows.into()), "U")?;
    let v_start = bytes.at();
    bytes.take(row_bytes.saturating_mul(v_rows.into()), "S V")?;

    // Both are in the file.
    let components = components as usize;
    let row_bytes = components * scalar.bytes();
    Ok(std::array::from_fn(|channel| {
        let of_u = Rows { start: u_start + channel * row_bytes, step_bytes: N * row_bytes };
        let of_v = Rows { start: v_start, step_bytes: row_bytes };
        let (pairs, texels) = if by_pair { (of_u, of_v) } else { (of_v, of_u) };
        Channel { scalar, components, pairs, texels }
    }))
}

#[cfg(test)]
mod tests {
    use half::f16;

    use super::*;

    #[test]
    fn halves_are_exact() {
        for bits in 0..=u16::MAX {
            let (found, expected) = (from_f16(bits.to_le_bytes()), f16::from_bits(bits).to_f32());
            assert!(found == expected || found.is_nan() && expected.is_nan(), "{bits:#06x}: {found} for {expected}");
            assert_eq!(found.is_sign_negative(), bits >= 0x8000, "{bits:#06x}");
        }
    }

    #[test]
    fn products_take_all_values() {
        let numbers: Vec<f32> = (0..19_u8).map(f32::from).collect();
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        for len in 0..=numbers.len() {
            let expected: f32 = numbers[..len].iter().map(|number| number * number).sum();
            assert_eq!(Scalar::F32.dot(&bytes[..4 * len], &numbers[..len]), expected);
        }
    }
}
