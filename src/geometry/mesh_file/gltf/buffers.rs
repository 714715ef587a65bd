//! The numbers behind glTF's accessors: which bytes of which buffer, read with every bound checked.

use std::borrow::Cow;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::{Accessor, MeshFileError, Root, entry};
use crate::geometry::Vec3;

/// Component types (3.6.2.2).
const U8: u32 = 5121;
const U16: u32 = 5123;
const U32: u32 = 5125;
const F32: u32 = 5126;

/// The buffers of a file, opened.
pub(super) struct Buffers<'a> {
    root: &'a Root,
    bytes: Vec<Cow<'a, [u8]>>,
}

impl<'a> Buffers<'a> {
    pub fn open(root: &'a Root, binary: Option<&'a [u8]>) -> Result<Self, MeshFileError> {
        let mut bytes = Vec::with_capacity(root.buffers.len());
        for (i, buffer) in root.buffers.iter().enumerate() {
            let data = match (&buffer.uri, binary) {
                (Some(uri), _) => Cow::Owned(inline(uri, i)?),
                // The binary chunk is the first buffer's, and no other's (3.6.1.2).
                (None, Some(binary)) if i == 0 => Cow::Borrowed(binary),
                (None, _) => {
                    return Err(MeshFileError::Missing { place: format!("buffers[{i}]"), what: "bytes in this file" });
                }
            };
            if (data.len() as u64) < buffer.byte_length {
                let place = format!("buffers[{i}]");
                return Err(MeshFileError::Truncated { place, needed: buffer.byte_length, available: data.len() });
            }
            bytes.push(data);
        }
        Ok(Self { root, bytes })
    }

    pub fn positions(&self, accessor: usize) -> Result<Vec<Vec3>, MeshFileError> {
        let place = format!("accessors[{accessor}]");
        let described = entry(&self.root.accessors, accessor, "POSITION", "accessor")?;
        if (described.component_type, described.kind.as_str()) != (F32, "VEC3") {
            let what = format!("a position of type {} {}", described.component_type, described.kind);
            return Err(MeshFileError::Unsupported { place, what });
        }
        let records = self.records(described, &place, 12)?;
        let coordinate = |bytes: &[u8]| f64::from(f32::from_le_bytes(four(bytes)));
        Ok(records.map(|r| Vec3::new(coordinate(r), coordinate(&r[4..]), coordinate(&r[8..]))).collect())
    }

    /// Indices of vertices, each below `vertices`.
    pub fn indices(&self, accessor: usize, vertices: usize) -> Result<Vec<u32>, MeshFileError> {
        let place = format!("accessors[{accessor}]");
        let described = entry(&self.root.accessors, accessor, "indices", "accessor")?;
        let indices: Vec<u32> = match (described.component_type, described.kind.as_str()) {
            (U8, "SCALAR") => self.records(described, &place, 1)?.map(|r| u32::from(r[0])).collect(),
            (U16, "SCALAR") => {
                self.records(described, &place, 2)?.map(|r| u32::from(u16::from_le_bytes([r[0], r[1]]))).collect()
            }
            (U32, "SCALAR") => self.records(described, &place, 4)?.map(|r| u32::from_le_bytes(four(r))).collect(),
            (component, kind) => {
                let what = format!("an index of type {component} {kind}");
                return Err(MeshFileError::Unsupported { place, what });
            }
        };
        match indices.iter().find(|&&index| index as usize >= vertices) {
            Some(&index) => {
                let index = i64::from(index);
                Err(MeshFileError::BadIndex { place, what: "vertex", index, available: vertices })
            }
            None => Ok(indices),
        }
    }

    /// The records of an accessor, `size` bytes each.
    fn records(
        &self,
        accessor: &Accessor,
        place: &str,
        size: usize,
    ) -> Result<impl Iterator<Item = &[u8]> + use<'_>, MeshFileError> {
        if accessor.sparse.is_some() {
            return Err(MeshFileError::Unsupported { place: place.to_owned(), what: "a sparse accessor".to_owned() });
        }
        let missing = || MeshFileError::Missing { place: place.to_owned(), what: "bufferView" };
        let view = entry(&self.root.buffer_views, accessor.buffer_view.ok_or_else(missing)?, place, "bufferView")?;
        let buffer: &[u8] = entry(&self.bytes, view.buffer, "bufferViews", "buffer")?;
        let stride = view.byte_stride.filter(|stride| *stride > 0).unwrap_or(size as u64);
        // All in 128 bits, where sums and products of these 64-bit fields cannot overflow.
        let (count, stride) = (u128::from(accessor.count), u128::from(stride));
        let needed =
            if count == 0 { 0 } else { u128::from(accessor.byte_offset) + (count - 1) * stride + size as u128 };
        let start = u128::from(view.byte_offset);
        let end = start + u128::from(view.byte_length);
        if needed > u128::from(view.byte_length) || end > buffer.len() as u128 {
            return Err(MeshFileError::Truncated {
                place: place.to_owned(),
                needed: u64::try_from(start + needed).unwrap_or(u64::MAX),
                available: buffer.len(),
            });
        }
        let first = view.byte_offset as usize + accessor.byte_offset.min(view.byte_length) as usize;
        let stride = usize::try_from(stride).unwrap_or(usize::MAX);
        let count = accessor.count as usize;
        Ok((0..count).map(move |i| &buffer[first + i * stride..][..size]))
    }
}

/// The bytes of a `data:` URI.
fn inline(uri: &str, buffer: usize) -> Result<Vec<u8>, MeshFileError> {
    let Some(data) = uri.strip_prefix("data:") else {
        let shown = uri.chars().take(100).collect();
        return Err(MeshFileError::ExternalBuffer { buffer, uri: shown });
    };
    let syntax = |problem: String| MeshFileError::Syntax { place: format!("buffers[{buffer}].uri"), problem };
    let (_, encoded) = data.split_once(";base64,").ok_or_else(|| syntax("is data:, but not base64".to_owned()))?;
    STANDARD.decode(encoded).map_err(|e| syntax(e.to_string()))
}

fn four(bytes: &[u8]) -> [u8; 4] {
    [bytes[0], bytes[1], bytes[2], bytes[3]]
}
