//! How lists of corners make triangles.

use roxmltree::Node;

use super::super::MeshFileError;
use super::elements::{child, children, missing, place_of, uneven, unsupported, whole, words_of};

/// Where in a primitive's `<p>` the vertices stand.
pub(super) struct Inputs<'a, 'input> {
    pub vertex: Node<'a, 'input>,
    offset: usize,
    stride: usize,
}

impl<'a, 'input> Inputs<'a, 'input> {
    pub fn of(primitive: Node<'a, 'input>) -> Result<Self, MeshFileError> {
        let mut stride = 0;
        for input in children(primitive, "input") {
            stride = stride.max(whole(input, "offset", Some(0))?.saturating_add(1));
        }
        let vertex = children(primitive, "input").find(|input| input.attribute("semantic") == Some("VERTEX"));
        let vertex = vertex.ok_or_else(|| missing(primitive, "VERTEX input"))?;
        Ok(Self { vertex, offset: whole(vertex, "offset", Some(0))?, stride })
    }

    /// The vertex of each corner listed in `p`.
    fn corners(&self, p: Node, vertices: usize) -> Result<Vec<u32>, MeshFileError> {
        let indices = words_of(p);
        let mut corners = Vec::new();
        for word in indices.skip(self.offset).step_by(self.stride) {
            let index: u32 = word.parse().map_err(|_| MeshFileError::Syntax {
                place: place_of(p),
                problem: format!("{word:?} is not an index"),
            })?;
            if index as usize >= vertices {
                let (place, index) = (place_of(p), i64::from(index));
                return Err(MeshFileError::BadIndex { place, what: "vertex", index, available: vertices });
            }
            corners.push(index);
        }
        Ok(corners)
    }
}

/// How corners make triangles.
#[derive(Clone, Copy)]
pub(super) enum Layout {
    /// Three by three.
    Triangles,
    /// As many at a time as `vcount` says.
    Polylist,
    /// One polygon in each `p`.
    Polygons,
    /// One strip in each `p`, every second triangle turned over.
    Strips,
}

impl Layout {
    pub fn cut(
        self,
        primitive: Node,
        inputs: &Inputs,
        vertices: usize,
        triangles: &mut Vec<[u32; 3]>,
    ) -> Result<(), MeshFileError> {
        if child(primitive, "ph").is_some() {
            return Err(unsupported(primitive, "a polygon with holes"));
        }
        for p in children(primitive, "p") {
            let corners = inputs.corners(p, vertices)?;
            match self {
                Self::Triangles => {
                    let (whole, rest) = corners.as_chunks::<3>();
                    if !rest.is_empty() {
                        return Err(uneven(p, "triangles"));
                    }
                    triangles.extend(whole);
                }
                Self::Polylist => {
                    let mut rest = corners.as_slice();
                    let counts = child(primitive, "vcount").ok_or_else(|| missing(primitive, "vcount"))?;
                    for word in words_of(counts) {
                        let count = word.parse().ok().filter(|count| *count <= rest.len());
                        let (polygon, others) = rest.split_at(count.ok_or_else(|| uneven(counts, "polygons"))?);
                        fan(polygon, triangles);
                        rest = others;
                    }
                    if !rest.is_empty() {
                        return Err(uneven(counts, "polygons"));
                    }
                }
                Self::Polygons => fan(&corners, triangles),
                Self::Strips => {
                    let windows = corners.windows(3).enumerate();
                    triangles
                        .extend(windows.map(|(i, w)| if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[0], w[2], w[1]] }));
                }
            }
        }
        Ok(())
    }
}

fn fan(polygon: &[u32], triangles: &mut Vec<[u32; 3]>) {
    if let [first, rest @ ..] = polygon {
        triangles.extend(rest.windows(2).map(|pair| [*first, pair[0], pair[1]]));
    }
}
