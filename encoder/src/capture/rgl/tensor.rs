//! Named arrays in one file ("tensor_file", version 1.0), as the RGL database stores its measurements.
//!
//! All is little-endian, and headers are not aligned:
//!
//! | field | type | |
//! |---|---|---|
//! | signature | 12 bytes | `tensor_file` and a zero |
//! | version | 2 u8 | 1, 0 |
//! | arrays | u32 count | |
//! | each array | u16 length, name; u16 dimensions; u8 type; u64 offset; u64 for each dimension | |
//!
//! Values stand at the offset, counted from the beginning of the file, the last dimension fastest.

use std::path::Path;

use crate::capture::bytes::Bytes;
use crate::error::{Error, Result};

const SIGNATURE: &[u8] = b"tensor_file\0";
/// Types by their numbers: name, and bytes of a value. Number 0 is none.
const TYPES: [(&str, u64); 12] = [
    ("none", 0),
    ("u8", 1),
    ("i8", 1),
    ("u16", 2),
    ("i16", 2),
    ("u32", 4),
    ("i32", 4),
    ("u64", 8),
    ("i64", 8),
    ("f16", 2),
    ("f32", 4),
    ("f64", 8),
];
const U8: u8 = 1;
const F32: u8 = 10;

/// One array of a file.
struct Tensor<'a> {
    name: &'a [u8],
    kind: u8,
    shape: Vec<u64>,
    values: &'a [u8],
}

/// All arrays of a file, each of them inside of it.
pub(super) struct Tensors<'a> {
    path: &'a Path,
    tensors: Vec<Tensor<'a>>,
}

impl<'a> Tensors<'a> {
    pub(super) fn parse(path: &'a Path, file: &'a [u8]) -> Result<Self> {
        let mut bytes = Bytes::new(path, file);
        if !file.starts_with(SIGNATURE) {
            return Err(bytes.wrong("no signature of a measured BRDF", "a .bsdf file that begins with tensor_file"));
        }
        bytes.take(SIGNATURE.len() as u64, "signature")?;
        let version = [bytes.u8("version")?, bytes.u8("version")?];
        if version[0] != 1 {
            return Err(bytes.wrong(format!("version {}.{}", version[0], version[1]), "1.0"));
        }
        // The number of arrays is nobody's word for how many there are: each one takes bytes of the file.
        let tensors = (0..bytes.u32("number of arrays")?).map(|_| Tensor::parse(&mut bytes, file));
        Ok(Self { path, tensors: tensors.collect::<Result<_>>()? })
    }

    pub(super) fn has(&self, name: &str) -> bool {
        self.tensors.iter().any(|tensor| tensor.name == name.as_bytes())
    }

    /// An array of some type and number of dimensions.
    fn find<const N: usize>(&self, name: &str, kind: u8) -> Result<(&Tensor<'a>, [usize; N])> {
        let expected = || format!("\"{name}\" in {} with {N} dimensions", TYPES[usize::from(kind)].0);
        let Some(tensor) = self.tensors.iter().find(|tensor| tensor.name == name.as_bytes()) else {
            return Err(Error::input(self.path, format!("no array \"{name}\""), expected()));
        };
        // What lies in the file has sizes that fit.
        let shape: Option<Vec<usize>> = tensor.shape.iter().map(|count| usize::try_from(*count).ok()).collect();
        match shape.and_then(|shape| <[usize; N]>::try_from(shape).ok()) {
            Some(shape) if tensor.kind == kind => Ok((tensor, shape)),
            _ => Err(Error::input(self.path, tensor, expected())),
        }
    }

    /// Finite floats, the last dimension fastest, and the shape.
    pub(super) fn floats<const N: usize>(&self, name: &str) -> Result<([usize; N], Vec<f32>)> {
        let (tensor, shape) = self.find(name, F32)?;
        let values: Vec<f32> = tensor.values.as_chunks().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
        match values.iter().position(|value| !value.is_finite()) {
            Some(at) => Err(Error::input(self.path, format!("{} as value {at} of \"{name}\"", values[at]), "numbers")),
            None => Ok((shape, values)),
        }
    }

    /// A single byte.
    pub(super) fn byte(&self, name: &str) -> Result<u8> {
        let (tensor, [_]) = self.find(name, U8)?;
        match tensor.values {
            [byte] => Ok(*byte),
            _ => Err(Error::input(self.path, tensor, "one value")),
        }
    }
}

impl<'a> Tensor<'a> {
    fn parse(bytes: &mut Bytes<'a>, file: &'a [u8]) -> Result<Self> {
        let len = bytes.u16("length of a name")?;
        let name = bytes.take(len.into(), "a name")?;
        let dimensions = bytes.u16("number of dimensions")?;
        let (kind, offset) = (bytes.u8("type")?, bytes.u64("offset")?);
        let shape = (0..dimensions).map(|_| bytes.u64("a dimension")).collect::<Result<Vec<u64>>>()?;
        let tensor = Self { name, kind, shape, values: &[] };
        let Some((_, value_bytes)) = TYPES.get(usize::from(kind)).filter(|_| kind > 0) else {
            return Err(bytes.wrong(&tensor, "type 1 to 11"));
        };
        let len = tensor.shape.iter().try_fold(*value_bytes, |len, count| len.checked_mul(*count));
        let end = len.and_then(|len| offset.checked_add(len)).and_then(|end| usize::try_from(end).ok());
        let start = usize::try_from(offset).ok();
        match start.zip(end).and_then(|(start, end)| file.get(start..end)) {
            Some(values) => Ok(Self { values, ..tensor }),
            None => {
                let found = format!("{tensor} from byte {offset} on, and {} bytes of file", file.len());
                Err(bytes.wrong(found, "arrays that lie in the file"))
            }
        }
    }
}

/// Name, type and shape, for errors.
impl std::fmt::Display for Tensor<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        const SHOWN: usize = 8;
        let kind = TYPES.get(usize::from(self.kind)).map_or("no known type", |(name, _)| name);
        let shown = &self.shape[..self.shape.len().min(SHOWN)];
        let name = self.name[..self.name.len().min(32)].escape_ascii();
        write!(f, "\"{name}\" in {kind} with {} dimensions {shown:?}", self.shape.len())
    }
}
