//! The binary container of glTF: its buffer, the views and accessors of it, and the file around both.

use crate::error::AppError;
use serde_json::{Value, json};

/// What a part of the buffer is for, by OpenGL's numbers.
#[derive(Clone, Copy)]
pub enum Target {
    Vertices = 34962,
    Indices = 34963,
}

/// OpenGL's numbers of the types of numbers.
const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;

/// A buffer that grows, and what is said of its parts. All numbers take four bytes, so that everything is aligned.
#[derive(Default)]
pub struct Container {
    buffer: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Container {
    /// Points or directions; gives the number of the accessor.
    pub fn vectors(&mut self, vectors: &[[f32; 3]], target: Target) -> usize {
        let (least, most) = range(vectors);
        let view = self.view(vectors.as_flattened().iter().flat_map(|x| x.to_le_bytes()), Some(target));
        self.accessor(json!({
            "bufferView": view, "componentType": FLOAT, "type": "VEC3", "count": vectors.len(), "min": least, "max": most,
        }))
    }

    /// Triangles as indices of vertices.
    pub fn indices(&mut self, faces: &[[u32; 3]]) -> usize {
        let view = self.view(faces.as_flattened().iter().flat_map(|i| i.to_le_bytes()), Some(Target::Indices));
        let count = 3 * faces.len();
        self.accessor(json!({ "bufferView": view, "componentType": UNSIGNED_INT, "type": "SCALAR", "count": count }))
    }

    /// The times of keys, ascending; there is at least one.
    pub fn times(&mut self, times: &[f32]) -> usize {
        let view = self.view(times.iter().flat_map(|t| t.to_le_bytes()), None);
        self.accessor(json!({
            "bufferView": view, "componentType": FLOAT, "type": "SCALAR", "count": times.len(),
            "min": [times[0]], "max": [times[times.len() - 1]],
        }))
    }

    /// The values of keys, of so many numbers each.
    pub fn values<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        let view = self.view(values.as_flattened().iter().flat_map(|x| x.to_le_bytes()), None);
        let kind = format!("VEC{N}");
        self.accessor(json!({ "bufferView": view, "componentType": FLOAT, "type": kind, "count": values.len() }))
    }

    fn view(&mut self, bytes: impl Iterator<Item = u8>, target: Option<Target>) -> usize {
        let start = self.buffer.len();
        self.buffer.extend(bytes);
        let mut view = json!({ "buffer": 0, "byteOffset": start, "byteLength": self.buffer.len() - start });
        if let Some(target) = target {
            view["target"] = json!(target as u32);
        }
        self.views.push(view);
        self.views.len() - 1
    }

    fn accessor(&mut self, accessor: Value) -> usize {
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// The file of `document` and the buffer.
    pub fn finish(self, mut document: Value) -> Result<Vec<u8>, AppError> {
        document["buffers"] = json!([{ "byteLength": self.buffer.len() }]);
        document["bufferViews"] = json!(self.views);
        document["accessors"] = json!(self.accessors);
        let mut text = document.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let length = 12 + 8 + text.len() + 8 + self.buffer.len();
        let size = |n: usize| {
            u32::try_from(n).map(u32::to_le_bytes).map_err(|_| {
                let message = "the model is larger than the 4 GB that the format allows; take fewer balls or keys";
                AppError::Usage(message.to_owned())
            })
        };
        let mut file = Vec::with_capacity(length);
        file.extend(b"glTF");
        file.extend(2_u32.to_le_bytes());
        file.extend(size(length)?);
        for (kind, chunk) in [(b"JSON", &text), (b"BIN\0", &self.buffer)] {
            file.extend(size(chunk.len())?);
            file.extend(kind);
            file.extend(chunk);
        }
        Ok(file)
    }
}

/// The least and the greatest along each axis.
fn range(vectors: &[[f32; 3]]) -> ([f32; 3], [f32; 3]) {
    let fold = |axis: usize, pick: fn(f32, f32) -> f32, start: f32| vectors.iter().map(|v| v[axis]).fold(start, pick);
    (
        std::array::from_fn(|axis| fold(axis, f32::min, f32::INFINITY)),
        std::array::from_fn(|axis| fold(axis, f32::max, f32::NEG_INFINITY)),
    )
}
