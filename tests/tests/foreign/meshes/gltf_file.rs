//! glTF files, made piece by piece.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};

/// File so far: its bytes, and the views and accessors of them.
#[derive(Clone, Default)]
pub(super) struct Parts {
    pub(super) bytes: Vec<u8>,
    pub(super) views: Vec<Value>,
    pub(super) accessors: Vec<Value>,
}

pub(super) const U8: u32 = 5121;
pub(super) const U16: u32 = 5123;
pub(super) const F32: u32 = 5126;

impl Parts {
    /// Adds a view, and returns its number.
    pub(super) fn view(&mut self, bytes: &[u8]) -> usize {
        self.views.push(json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() }));
        self.bytes.extend(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.len() - 1
    }

    /// Adds an accessor of a view of its own, and returns its number.
    pub(super) fn accessor(&mut self, bytes: &[u8], component: u32, shape: &str, count: usize) -> usize {
        let view = self.view(bytes);
        self.accessors.push(json!({ "bufferView": view, "componentType": component, "type": shape, "count": count }));
        self.accessors.len() - 1
    }

    /// What an extension says of a view that stands, compressed, in the view `from`.
    pub(super) fn compressed(&self, from: usize, mode: &str, count: usize, stride: usize) -> Value {
        let mut compressed = self.views[from].clone();
        compressed["mode"] = mode.into();
        compressed["count"] = count.into();
        compressed["byteStride"] = stride.into();
        compressed
    }

    /// Adds vectors of N floats.
    pub(super) fn floats<const N: usize>(&mut self, vectors: &[[f32; N]]) -> usize {
        let shape = ["SCALAR", "VEC2", "VEC3", "VEC4"].get(N - 1).copied().unwrap_or("MAT4");
        self.accessor(&bytes(vectors.as_flattened(), f32::to_le_bytes), F32, shape, vectors.len())
    }

    /// Adds indices of 16 bits.
    pub(super) fn indices(&mut self, indices: &[u16]) -> usize {
        self.accessor(&bytes(indices, u16::to_le_bytes), U16, "SCALAR", indices.len())
    }

    /// The JSON of a file, whose buffer has `uri` if there is one.
    pub(super) fn json(&self, rest: Value, uri: Option<&str>) -> Value {
        let mut buffer = json!({ "byteLength": self.bytes.len() });
        if let Some(uri) = uri {
            buffer["uri"] = uri.into();
        }
        let mut file = json!({
            "asset": { "version": "2.0" },
            "scenes": [{ "nodes": [0] }],
            "buffers": [buffer],
            "bufferViews": self.views,
            "accessors": self.accessors,
        });
        if let (Some(file), Value::Object(rest)) = (file.as_object_mut(), rest) {
            file.extend(rest);
        }
        file
    }

    /// A .gltf file with its bytes in a data URI.
    pub(super) fn gltf(&self, rest: Value) -> Vec<u8> {
        let uri = format!("data:application/octet-stream;base64,{}", STANDARD.encode(&self.bytes));
        self.json(rest, Some(&uri)).to_string().into_bytes()
    }

    /// A .glb file.
    pub(super) fn glb(&self, rest: Value) -> Vec<u8> {
        let mut json = self.json(rest, None).to_string().into_bytes();
        json.resize(json.len().next_multiple_of(4), b' ');
        let mut file = b"glTF".to_vec();
        let length = 12 + 8 + json.len() + 8 + self.bytes.len();
        file.extend([2, length].iter().flat_map(|number| u32::try_from(*number).unwrap().to_le_bytes()));
        for (kind, chunk) in [(b"JSON", &json), (b"BIN\0", &self.bytes)] {
            file.extend(u32::try_from(chunk.len()).unwrap().to_le_bytes());
            file.extend(kind);
            file.extend(chunk);
        }
        file
    }
}

/// Adds to a list.
pub(super) fn append(list: &mut Value, item: Value) {
    list.as_array_mut().expect("a list").push(item);
}

/// Little-endian bytes of numbers.
pub(super) fn bytes<T: Copy, const N: usize>(numbers: &[T], to_bytes: fn(T) -> [u8; N]) -> Vec<u8> {
    numbers.iter().flat_map(|number| to_bytes(*number)).collect()
}

/// Corners of the unit square.
pub(super) const CORNERS: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

/// Unit square: accessor 0 has its corners, accessor 1 the indices of two triangles.
pub(super) fn square() -> Parts {
    let mut parts = Parts::default();
    parts.floats(&CORNERS);
    parts.indices(&[0, 1, 2, 0, 2, 3]);
    parts
}

/// Mesh of the square, drawn by one node that has `more`; `primitive` is added to its primitive.
pub(super) fn drawn(more: &Value, primitive: &Value) -> Value {
    let merge = |mut base: Value, more: &Value| {
        if let (Some(base), Value::Object(more)) = (base.as_object_mut(), more) {
            base.extend(more.clone());
        }
        base
    };
    let primitive = merge(json!({ "attributes": { "POSITION": 0 }, "indices": 1 }), primitive);
    json!({ "nodes": [merge(json!({ "mesh": 0 }), more)], "meshes": [{ "primitives": [primitive] }] })
}

/// Streams of EXT_meshopt_compression, without any compression.
pub(super) mod meshopt {
    /// Attributes in version 0: all differences as they are.
    pub(in super::super) fn attributes(elements: &[u8], stride: usize) -> Vec<u8> {
        let count = elements.len() / stride;
        assert!(count <= 16, "one group");
        let mut out = vec![0xa0];
        for k in 0..stride {
            out.push(3);
            let mut last = 0_u8;
            for element in 0..16 {
                let value = if element < count { elements[element * stride + k] } else { last };
                let step = value.wrapping_sub(last);
                last = value;
                out.push(if step & 0x80 == 0 { step << 1 } else { !(step << 1) });
            }
        }
        // The element before the first is zero.
        out.resize(out.len() + stride.max(32), 0);
        out
    }

    /// Triangles of explicit indices up to 63.
    pub(in super::super) fn triangles(indices: &[u16]) -> Vec<u8> {
        let mut out = vec![0xe1];
        out.extend(vec![0xff; indices.len() / 3]);
        let mut last = 0;
        for triangle in indices.as_chunks::<3>().0 {
            out.push(0xff);
            for &index in triangle {
                let step = i8::try_from(i32::from(index) - last).unwrap();
                last = i32::from(index);
                out.push(((step << 1) ^ (step >> 7)).cast_unsigned());
            }
        }
        out.resize(out.len() + 16, 0);
        out
    }
}
