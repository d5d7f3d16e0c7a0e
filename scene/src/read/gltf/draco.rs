//! Primitives compressed by KHR_draco_mesh_compression.

use draco_core::{DataType, DecodeLimits, DecoderBuffer, Mesh, MeshDecoder};

use super::accessor::Component;
use super::document::Whole;
use crate::read::raw::{MAX, Result};
use crate::read::text::shortened;

/// Decoded stream of a primitive.
pub(super) struct Stream(Mesh);

impl Stream {
    pub(super) fn decode(bytes: &[u8]) -> Result<Self> {
        let most = MAX as u64;
        let limits = DecodeLimits::default().with_max_points(most).with_max_faces(most);
        let mut mesh = Mesh::new();
        let decoded = MeshDecoder::new().decode(&mut DecoderBuffer::new(bytes).with_limits(limits), &mut mesh);
        decoded.map_err(|error| format!("Draco: {}", shortened(&error.to_string(), 160)))?;
        Ok(Self(mesh))
    }

    pub(super) fn triangles(&self) -> Vec<[u32; 3]> {
        self.0.faces().iter().map(|face| face.map(|point| point.0)).collect()
    }

    /// Vectors of N numbers of an attribute; as shares of the largest of their type if they are normalised.
    pub(super) fn vectors<const N: usize>(&self, number: Whole, is_normalised: bool) -> Result<Vec<[f32; N]>> {
        let number = number.0;
        let attribute = u32::try_from(number).ok().and_then(|number| self.0.attribute_by_unique_id(number));
        let attribute = attribute.ok_or_else(|| format!("Draco: there is no attribute {number}"))?;
        if usize::from(attribute.num_components()) < N {
            return Err(format!("Draco: attribute {number} has {} numbers; expected {N}", attribute.num_components()));
        }
        let mut vectors = attribute.read_f32s(self.0.num_points(), N).as_chunks().0.to_vec();
        let component = match attribute.data_type() {
            DataType::Int8 => Component::I8,
            DataType::Uint8 => Component::U8,
            DataType::Int16 => Component::I16,
            DataType::Uint16 => Component::U16,
            DataType::Uint32 => Component::U32,
            _ => Component::F32,
        };
        if is_normalised {
            vectors.as_flattened_mut().iter_mut().for_each(|value| *value = component.share(*value));
        }
        Ok(vectors)
    }
}
