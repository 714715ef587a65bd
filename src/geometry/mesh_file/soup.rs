//! Triangles over vertices, and how the meshes of a scene graph add up to one.

use super::MeshFileError;
use crate::geometry::Vec3;

/// Triangles a file may expand to. Scene graphs may instance one mesh many times, so the file's size is no bound.
pub const MOST_TRIANGLES: usize = 5_000_000;

/// What a file holds: triangles over the vertices they use. Metres, in the file's frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshSoup {
    /// Finite; each is a corner of some triangle.
    pub vertices: Vec<Vec3>,
    /// Indices of vertices, in the file's winding (mirroring transforms are undone). Never empty, all in range.
    pub triangles: Vec<[u32; 3]>,
}

/// What the meshes of a scene graph expand to, as far as they have been met.
#[derive(Default)]
pub(super) struct Expansion {
    pub soup: MeshSoup,
    vertices_visited: usize,
}

impl Expansion {
    /// Adds a mesh given in its own indices.
    pub fn append(&mut self, vertices: &[Vec3], triangles: &[[u32; 3]]) -> Result<(), MeshFileError> {
        // Vertices count too, used or not: they are what the time goes into where many small pieces share many.
        self.vertices_visited += vertices.len();
        if self.soup.triangles.len() + triangles.len() > MOST_TRIANGLES || self.vertices_visited > 3 * MOST_TRIANGLES {
            return Err(MeshFileError::TooManyTriangles);
        }
        let first = self.soup.vertices.len() as u32; // Fits: 3 * MOST_TRIANGLES does.
        self.soup.vertices.extend_from_slice(vertices);
        self.soup.triangles.extend(triangles.iter().map(|corners| corners.map(|c| first + c)));
        Ok(())
    }
}

/// A mesh and its hull are to agree, so vertices that no triangle uses do not count.
pub(super) fn without_unused_vertices(soup: MeshSoup) -> MeshSoup {
    let mut used = vec![false; soup.vertices.len()];
    soup.triangles.iter().flatten().for_each(|&corner| used[corner as usize] = true);
    if used.iter().all(|used| *used) {
        return soup;
    }
    let mut next = 0;
    let index: Vec<u32> = used.iter().map(|&used| (next, next += u32::from(used)).0).collect();
    let vertices = soup.vertices.into_iter().zip(&used).filter(|(_, used)| **used).map(|(v, _)| v).collect();
    let triangles = soup.triangles.into_iter().map(|t| t.map(|c| index[c as usize])).collect();
    MeshSoup { vertices, triangles }
}
