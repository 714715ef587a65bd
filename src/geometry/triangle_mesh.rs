//! A surface made of triangles, with its own read-only tree.

use std::collections::BTreeMap;

use super::shape::position;
use super::{Aabb, InvalidShape, MeshTree, Vec3};

/// Triangles over shared vertices. A mesh is a surface without interior, unless it was declared solid: then it was
/// checked to be closed and to face outwards, and what lies inside collides with it.
#[derive(Clone, Debug)]
pub struct TriangleMesh {
    vertices: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    tree: MeshTree,
    bounds: Aabb,
    /// One vertex of each connected part of the surface.
    parts: Vec<u32>,
    solid: bool,
}

impl TriangleMesh {
    /// A surface. Degenerate triangles are kept: they are segments or points, and can be touched.
    ///
    /// # Errors
    /// No triangles, a vertex that is not finite, an index out of range.
    pub fn surface(vertices: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Result<Self, InvalidShape> {
        if triangles.is_empty() {
            return Err(InvalidShape::Empty { field: "triangles" });
        }
        for (i, v) in vertices.iter().enumerate() {
            position(|| format!("vertices[{i}]"), *v)?;
        }
        for (i, corners) in triangles.iter().enumerate() {
            if let Some(&index) = corners.iter().find(|&&c| c as usize >= vertices.len()) {
                return Err(InvalidShape::BadIndex { triangle: i, index, vertices: vertices.len() });
            }
        }
        let corners: Vec<[Vec3; 3]> = triangles.iter().map(|t| t.map(|c| vertices[c as usize])).collect();
        let bounds = Aabb::around(corners.iter().flatten().copied());
        let tree = MeshTree::new(&corners);
        let parts = connected_parts(&merged(&vertices), &triangles);
        Ok(Self { vertices, triangles, tree, bounds, parts, solid: false })
    }

    /// A solid body. Vertices at equal positions are taken as one (STL repeats each of them).
    ///
    /// # Errors
    /// As for a surface; and an edge that is not matched by exactly one opposite edge, or triangles that face inwards.
    pub fn solid(vertices: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Result<Self, InvalidShape> {
        let mut mesh = Self::surface(vertices, triangles)?;
        mesh.check_closed()?;
        let (unit_volume, volume) = mesh.signed_volume();
        // The negation also catches the NaN of a mesh that is a point.
        if !(unit_volume > 0.0) {
            return Err(InvalidShape::InsideOut { volume });
        }
        mesh.solid = true;
        Ok(mesh)
    }

    /// Vertices, metres, in the mesh's frame.
    #[must_use]
    pub fn vertices(&self) -> &[Vec3] {
        &self.vertices
    }

    /// Corners of each triangle as indices of vertices, counter-clockwise from outside.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The corners of one triangle.
    #[must_use]
    pub fn triangle(&self, index: usize) -> [Vec3; 3] {
        self.triangles[index].map(|c| self.vertices[c as usize])
    }

    /// The tree over the triangles.
    #[must_use]
    pub fn tree(&self) -> &MeshTree {
        &self.tree
    }

    /// One vertex of each connected part of the surface, metres.
    pub fn parts(&self) -> impl Iterator<Item = Vec3> {
        self.parts.iter().map(|&v| self.vertices[v as usize])
    }

    /// Whether what lies inside belongs to the body.
    #[must_use]
    pub fn is_solid(&self) -> bool {
        self.solid
    }

    /// Bounds of the triangles in the mesh's frame.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// The mesh with its axes multiplied by `factors` (URDF scales meshes per axis). A mirrored solid keeps facing
    /// outwards.
    ///
    /// # Errors
    /// Vertices out of reach; a solid scaled flat.
    pub fn scaled(&self, factors: Vec3) -> Result<Self, InvalidShape> {
        let vertices = self.vertices.iter().map(|v| v.component_mul(&factors)).collect();
        let mut triangles = self.triangles.clone();
        if factors.product() < 0.0 {
            triangles.iter_mut().for_each(|t| t.swap(1, 2));
        }
        if self.solid { Self::solid(vertices, triangles) } else { Self::surface(vertices, triangles) }
    }

    /// Sum of the signed volumes of the tetrahedra from the centre of the bounds to each triangle: summed for a mesh of unit
    /// size, so that the sign is right where the volume itself over- or underflows.
    fn signed_volume(&self) -> (f64, f64) {
        let (c, size) = (self.bounds().center(), self.bounds().half_extents().amax());
        let tetrahedron = |corners: [Vec3; 3]| {
            let [a, b, d] = corners.map(|v| (v - c) / size);
            a.dot(&b.cross(&d))
        };
        let unit = (0..self.triangles.len()).map(|i| tetrahedron(self.triangle(i))).sum::<f64>() / 6.0;
        (unit, unit * size * size * size)
    }

    /// Each directed edge must occur once, and so must its opposite.
    fn check_closed(&self) -> Result<(), InvalidShape> {
        let merged = merged(&self.vertices);
        let mut edges: BTreeMap<(u32, u32), usize> = BTreeMap::new();
        for corners in &self.triangles {
            let [a, b, c] = corners.map(|i| merged[i as usize]);
            if a == b || b == c || c == a {
                continue; // Collapsed to a segment or point: it bounds nothing.
            }
            for edge in [(a, b), (b, c), (c, a)] {
                *edges.entry(edge).or_default() += 1;
            }
        }
        for (&(from, to), &times) in &edges {
            let opposite = edges.get(&(to, from)).copied().unwrap_or(0);
            if opposite != 1 || times != 1 {
                return Err(InvalidShape::NotClosed { from, to, opposite });
            }
        }
        Ok(())
    }
}

/// For each vertex the first one at the same position.
fn merged(vertices: &[Vec3]) -> Vec<u32> {
    let mut first_at = BTreeMap::new();
    let position = |v: &Vec3| [v.x, v.y, v.z].map(|c| (c + 0.0).to_bits()); // + 0.0: -0 equals 0
    (0u32..).zip(vertices).map(|(i, v)| *first_at.entry(position(v)).or_insert(i)).collect()
}

/// One vertex of each set of triangles that hang together by their (merged) corners: a union-find.
fn connected_parts(merged: &[u32], triangles: &[[u32; 3]]) -> Vec<u32> {
    let mut parent: Vec<u32> = (0u32..).take(merged.len()).collect();
    let root = |parent: &mut Vec<u32>, mut v: u32| {
        while parent[v as usize] != v {
            parent[v as usize] = parent[parent[v as usize] as usize];
            v = parent[v as usize];
        }
        v
    };
    for corners in triangles {
        let [a, b, c] = corners.map(|v| root(&mut parent, merged[v as usize]));
        let least = a.min(b).min(c);
        [a, b, c].into_iter().for_each(|v| parent[v as usize] = least);
    }
    let mut parts: Vec<u32> = triangles.iter().map(|t| root(&mut parent, merged[t[0] as usize])).collect();
    parts.sort_unstable();
    parts.dedup();
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tetrahedron() -> (Vec<Vec3>, Vec<[u32; 3]>) {
        (vec![Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()], vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    }

    #[test]
    fn a_closed_outward_mesh_is_accepted_as_solid_even_with_repeated_vertices() {
        let (vertices, triangles) = tetrahedron();
        assert!(TriangleMesh::solid(vertices.clone(), triangles.clone()).unwrap().is_solid());
        let soup: Vec<Vec3> = triangles.iter().flatten().map(|&i| vertices[i as usize]).collect();
        let faces = (0..4).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        assert!(TriangleMesh::solid(soup, faces).is_ok());
    }

    #[test]
    fn an_open_mesh_and_an_inverted_one_are_refused_as_solid() {
        let (vertices, mut triangles) = tetrahedron();
        let inverted: Vec<_> = triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
        let error = TriangleMesh::solid(vertices.clone(), inverted).unwrap_err();
        assert!(matches!(error, InvalidShape::InsideOut { .. }), "{error}");
        triangles.pop();
        let error = TriangleMesh::solid(vertices, triangles).unwrap_err();
        assert!(matches!(error, InvalidShape::NotClosed { .. }), "{error}");
    }

    #[test]
    fn a_bad_index_is_refused_by_name() {
        let error = TriangleMesh::surface(vec![Vec3::zeros(); 3], vec![[0, 1, 2], [0, 1, 3]]).unwrap_err();
        assert_eq!(error.to_string(), "triangles[1] names vertex 3, but there are 3 vertices");
    }

    #[test]
    fn a_mirrored_solid_still_faces_outwards() {
        let (vertices, triangles) = tetrahedron();
        let mesh = TriangleMesh::solid(vertices, triangles).unwrap();
        assert!(mesh.scaled(Vec3::new(-1.0, 2.0, 1.0)).unwrap().is_solid());
    }
}
