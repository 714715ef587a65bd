//! STL: triangles without shared vertices, as text or binary.
//!
//! A file is text when it begins with `solid` and holds no zero byte, unless its length is just what the count field of a
//! binary file calls for: some exporters write `solid` into binary headers. Normals are not read: winding tells the same. Equal vertices are merged, first come first.

use std::collections::HashMap;

use super::text::{finite_number, utf8};
use super::{MeshFileError, MeshSoup};
use crate::geometry::Vec3;

const HEADER: usize = 80;
const COUNT_END: usize = HEADER + 4;
const RECORD: usize = 50; // Normal and three corners, each three f32; two bytes of attributes.

pub(super) fn read(bytes: &[u8]) -> Result<MeshSoup, MeshFileError> {
    let announced = announced_length(bytes);
    let begins_as_text = bytes.trim_ascii_start().get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    if begins_as_text && announced != Some(bytes.len() as u64) && !bytes.contains(&0) {
        return read_text(utf8(bytes)?);
    }
    let needed = announced.unwrap_or(COUNT_END as u64);
    if needed > bytes.len() as u64 {
        let place = "binary STL".to_owned();
        return Err(MeshFileError::Truncated { place, needed, available: bytes.len() });
    }
    read_binary(&bytes[COUNT_END..needed as usize])
}

/// Length of a binary file of as many triangles as the count field says.
fn announced_length(bytes: &[u8]) -> Option<u64> {
    let count = bytes.get(HEADER..COUNT_END)?.try_into().map(u32::from_le_bytes).ok()?;
    Some(COUNT_END as u64 + RECORD as u64 * u64::from(count))
}

fn read_binary(records: &[u8]) -> Result<MeshSoup, MeshFileError> {
    let mut merged = MergedVertices::default();
    let mut triangles = Vec::with_capacity(records.len() / RECORD);
    for (i, record) in records.chunks_exact(RECORD).enumerate() {
        let number = |offset: usize| {
            let bytes = [record[offset], record[offset + 1], record[offset + 2], record[offset + 3]];
            f64::from(f32::from_le_bytes(bytes))
        };
        let mut corners = [0; 3];
        for (k, corner) in corners.iter_mut().enumerate() {
            let at = 12 + 12 * k;
            let position = Vec3::new(number(at), number(at + 4), number(at + 8));
            if let Some(bad) = position.iter().find(|c| !c.is_finite()) {
                return Err(MeshFileError::BadNumber { place: format!("triangle {i}"), text: bad.to_string() });
            }
            *corner = merged.index(position);
        }
        triangles.push(corners);
    }
    Ok(MeshSoup { vertices: merged.vertices, triangles })
}

fn read_text(text: &str) -> Result<MeshSoup, MeshFileError> {
    let mut merged = MergedVertices::default();
    let mut triangles = Vec::new();
    let mut corners = Vec::new();
    let mut ended = false;
    for (number, line) in (1..).zip(text.lines()) {
        let place = || format!("line {number}");
        let syntax = |problem: String| MeshFileError::Syntax { place: place(), problem };
        let mut words = line.split_whitespace();
        let Some(keyword) = words.next() else { continue };
        match keyword.to_ascii_lowercase().as_str() {
            "solid" => ended = false,
            "endsolid" => ended = true,
            "facet" => corners.clear(),
            "vertex" => {
                let mut position = Vec3::zeros();
                for coordinate in position.iter_mut() {
                    let word = words.next().ok_or_else(|| syntax("a vertex needs three coordinates".to_owned()))?;
                    *coordinate = finite_number(word, place)?;
                }
                corners.push(merged.index(position));
            }
            "endfacet" => {
                let corners = <[u32; 3]>::try_from(corners.as_slice());
                triangles.push(corners.map_err(|_| syntax("a facet needs three vertices".to_owned()))?);
            }
            "outer" | "endloop" => {}
            _ => return Err(syntax(format!("{keyword:?} is not a keyword of STL"))),
        }
    }
    if !ended {
        return Err(MeshFileError::Missing { place: "text STL".to_owned(), what: "endsolid" });
    }
    Ok(MeshSoup { vertices: merged.vertices, triangles })
}

/// Vertices without repetitions, in the order of their first use.
#[derive(Default)]
struct MergedVertices {
    vertices: Vec<Vec3>,
    index_of: HashMap<[u64; 3], u32>,
}

impl MergedVertices {
    fn index(&mut self, position: Vec3) -> u32 {
        let key = [position.x, position.y, position.z].map(|c| (c + 0.0).to_bits()); // + 0.0: -0 equals 0
        *self.index_of.entry(key).or_insert_with(|| {
            self.vertices.push(position);
            (self.vertices.len() - 1) as u32
        })
    }
}
