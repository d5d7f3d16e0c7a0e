//! Accessors: numbers in views, of any type, strided, normalised or sparse.

use super::buffers::Buffers;
use super::document::{Accessor, Document, SparsePart, Whole, named};
use crate::read::raw::{Result, count};
use crate::read::text::quoted;

/// Type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn parse(code: usize) -> Result<Self> {
        Ok(match code {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return Err(format!("componentType {code}; expected 5120 to 5123, 5125 or 5126")),
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// A number as a share of the largest of its type (glTF 2.0, 3.6.2.2); floats are shares already.
    #[allow(clippy::cast_precision_loss, reason = "large integers are not drawn")]
    pub(super) fn share(self, number: f32) -> f32 {
        let most = match self {
            Self::I8 => f32::from(i8::MAX),
            Self::U8 => f32::from(u8::MAX),
            Self::I16 => f32::from(i16::MAX),
            Self::U16 => f32::from(u16::MAX),
            Self::U32 => u32::MAX as f32,
            Self::F32 => return number,
        };
        (number / most).max(-1.0)
    }

    /// Number in the first bytes; as a share if it is normalised.
    #[allow(clippy::cast_precision_loss, reason = "large integers are not drawn")]
    fn number(self, bytes: &[u8], is_normalised: bool) -> f32 {
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| bytes.get(k).copied().unwrap_or(0));
        let number = match self {
            Self::I8 => f32::from(i8::from_le_bytes([a])),
            Self::U8 => f32::from(a),
            Self::I16 => f32::from(i16::from_le_bytes([a, b])),
            Self::U16 => f32::from(u16::from_le_bytes([a, b])),
            Self::U32 => u32::from_le_bytes([a, b, c, d]) as f32,
            Self::F32 => f32::from_le_bytes([a, b, c, d]),
        };
        if is_normalised { self.share(number) } else { number }
    }

    /// Number of a vertex, a joint or the like.
    fn index(self, bytes: &[u8]) -> Result<u32> {
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| bytes.get(k).copied().unwrap_or(0));
        match self {
            Self::U8 => Ok(a.into()),
            Self::U16 => Ok(u16::from_le_bytes([a, b]).into()),
            Self::U32 => Ok(u32::from_le_bytes([a, b, c, d])),
            Self::I8 | Self::I16 | Self::F32 => {
                Err("numbers of type byte, short or float; expected unsigned byte, short or int".to_owned())
            }
        }
    }
}

/// Accessors of a document.
#[derive(Clone, Copy)]
pub(super) struct Accessors<'a> {
    pub(super) document: &'a Document,
    pub(super) buffers: &'a Buffers<'a>,
}

impl<'a> Accessors<'a> {
    fn get(&self, number: Whole) -> Result<&'a Accessor> {
        named(&self.document.accessors, "accessor", number)
    }

    /// Whether an accessor has no bytes, so that all its numbers are zero.
    pub(super) fn is_empty(&self, number: Whole) -> bool {
        self.get(number).is_ok_and(|accessor| accessor.buffer_view.is_none() && accessor.sparse.is_none())
    }

    /// Whether an accessor's numbers are floats; what is not there is no float.
    pub(super) fn is_float(&self, number: Whole) -> bool {
        self.get(number).is_ok_and(|accessor| Component::parse(accessor.component_type.0) == Ok(Component::F32))
    }

    /// Whether an accessor's integers are shares of the largest of their type.
    pub(super) fn is_normalised(&self, number: Whole) -> bool {
        self.get(number).is_ok_and(|accessor| accessor.normalized)
    }

    /// Vectors of N numbers, or matrices.
    pub(super) fn vectors<const N: usize>(&self, number: Whole) -> Result<Vec<[f32; N]>> {
        let accessor = self.get(number)?;
        self.elements(accessor, N, [0.0; N], |component, bytes| {
            Ok(std::array::from_fn(|k| component.number(&bytes[k * component.size()..], accessor.normalized)))
        })
        .map_err(|error| format!("accessor {}: {error}", number.0))
    }

    /// Vectors of N indices.
    pub(super) fn indices<const N: usize>(&self, number: Whole) -> Result<Vec<[u32; N]>> {
        let accessor = self.get(number)?;
        self.elements(accessor, N, [0; N], |component, bytes| {
            let mut out = [0; N];
            for (k, slot) in out.iter_mut().enumerate() {
                *slot = component.index(&bytes[k * component.size()..])?;
            }
            Ok(out)
        })
        .map_err(|error| format!("accessor {}: {error}", number.0))
    }

    fn elements<T: Copy>(
        &self,
        accessor: &Accessor,
        components: usize,
        zero: T,
        convert: impl Fn(Component, &[u8]) -> Result<T>,
    ) -> Result<Vec<T>> {
        let shape = match accessor.shape.as_str() {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            "MAT4" => 16,
            _ => 0,
        };
        if shape != components {
            return Err(format!("type {}; expected {components} numbers", quoted(accessor.shape.as_bytes())));
        }
        let component = Component::parse(accessor.component_type.0)?;
        let size = components * component.size();
        let count = count(accessor.count.0)? as usize;
        let convert = |bytes: &[u8]| convert(component, bytes);
        let mut out = match accessor.buffer_view {
            Some(view) => {
                let view = self.buffers.view(view)?;
                let stride = view.stride.unwrap_or(size);
                strided(view.bytes, accessor.byte_offset.0, count, stride, size)?
                    .map(convert)
                    .collect::<Result<Vec<_>>>()?
            }
            None => vec![zero; count],
        };
        if let Some(sparse) = &accessor.sparse {
            let number = Component::parse(sparse.indices.component_type.unwrap_or_default().0)?;
            let part = |part: &SparsePart, size: usize| {
                let view = self.buffers.view(part.buffer_view)?;
                strided(view.bytes, part.byte_offset.0, sparse.count.0, size, size)
            };
            let (numbers, values) = (part(&sparse.indices, number.size())?, part(&sparse.values, size)?);
            for (at, value) in numbers.zip(values) {
                let at = number.index(at)? as usize;
                *out.get_mut(at).ok_or_else(|| format!("sparse index {at} of {count} elements"))? = convert(value)?;
            }
        }
        Ok(out)
    }
}

/// Elements of `size` bytes, `stride` bytes apart.
fn strided(
    view: &[u8],
    offset: usize,
    count: usize,
    stride: usize,
    size: usize,
) -> Result<impl Iterator<Item = &[u8]>> {
    let bytes = view.get(offset..);
    let last = count.checked_sub(1).map_or(Some(0), |last| last.checked_mul(stride)?.checked_add(size));
    match (bytes, last) {
        (Some(bytes), Some(need)) if need <= bytes.len() => {
            Ok((0..count).map(move |k| &bytes[k * stride..k * stride + size]))
        }
        _ => Err(format!(
            "{count} elements of {size} bytes, {stride} apart, from byte {offset} on of a view of {} bytes",
            view.len()
        )),
    }
}
