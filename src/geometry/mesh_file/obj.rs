//! Wavefront OBJ: lines of vertices and faces.
//!
//! Read are `v` and `f`; everything else (normals, texture coordinates, materials, groups, lines) says nothing about
//! where the surface is. Faces with more than three corners are cut into a fan about their first corner.

use super::text::finite_number;
use super::{MeshFileError, MeshSoup};
use crate::geometry::Vec3;

pub(super) fn read(text: &str) -> Result<MeshSoup, MeshFileError> {
    let mut soup = MeshSoup::default();
    let mut corners = Vec::new();
    for (number, line) in (1..).zip(text.lines()) {
        let place = || format!("line {number}");
        let mut words = line.split('#').next().unwrap_or_default().split_whitespace();
        match words.next() {
            Some("v") => soup.vertices.push(vertex(&mut words, &place)?),
            Some("f") => {
                corners.clear();
                for word in words {
                    corners.push(corner(word, soup.vertices.len(), &place)?);
                }
                let [first, rest @ ..] = corners.as_slice() else {
                    return Err(MeshFileError::Missing { place: place(), what: "corners" });
                };
                if rest.len() < 2 {
                    return Err(MeshFileError::Syntax { place: place(), problem: "a face needs three corners".into() });
                }
                soup.triangles.extend(rest.windows(2).map(|pair| [*first, pair[0], pair[1]]));
            }
            _ => {}
        }
    }
    Ok(soup)
}

/// `v x y z`, perhaps with a weight (that divides) or a colour (that does not matter) behind it.
fn vertex<'a>(words: &mut impl Iterator<Item = &'a str>, place: &impl Fn() -> String) -> Result<Vec3, MeshFileError> {
    let mut position = Vec3::zeros();
    for coordinate in position.iter_mut() {
        let word = words.next().ok_or_else(|| MeshFileError::Missing { place: place(), what: "three coordinates" })?;
        *coordinate = finite_number(word, place)?;
    }
    if let (Some(weight), None) = (words.next(), words.next()) {
        let divided = position / finite_number(weight, place)?;
        if !divided.iter().all(|c| c.is_finite()) {
            return Err(MeshFileError::BadNumber { place: place(), text: weight.to_owned() });
        }
        return Ok(divided);
    }
    Ok(position)
}

/// The vertex of a corner `v`, `v/vt`, `v//vn` or `v/vt/vn`; counted from 1, or backwards from -1.
fn corner(word: &str, vertices: usize, place: &impl Fn() -> String) -> Result<u32, MeshFileError> {
    let number = word.split('/').next().unwrap_or_default();
    let bad_number = || MeshFileError::Syntax { place: place(), problem: format!("{number:?} is not a vertex number") };
    let number: i64 = number.parse().map_err(|_| bad_number())?;
    let count = i64::try_from(vertices).map_err(|_| bad_number())?;
    let index = if number < 0 { number.checked_add(count) } else { number.checked_sub(1) };
    match index {
        Some(index) if (0..count).contains(&index) => u32::try_from(index).map_err(|_| bad_number()),
        _ => Err(MeshFileError::BadIndex { place: place(), what: "vertex", index: number, available: vertices }),
    }
}
