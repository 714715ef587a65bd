//! A mesh as a few convex hulls: cheaper to ask than its triangles, and with an inside, at the price of an error that is measured
//! (`narrow_phase::fit`).
//!
//! The cut is VHACD's (Mamou and Ghorbel, "A simple and efficient approach for 3D mesh approximate convex decomposition", ICIP 2009), from
//! the crate parry3d: the mesh is filled with cells, and the set of cells is cut by planes until its parts are nearly convex. Each piece is
//! the hull of the mesh's own surface within the cells of a part, not of the cells, so that it does not reach farther than the mesh does.
//! There is no randomness and no thread in it: equal meshes have equal pieces.

use std::collections::HashMap;

use super::shape::position;
use super::{Aabb, Compound, InvalidShape, Part, Pose, Shape, Vec3};

/// Cells along the longest side of the mesh's bounds.
const RESOLUTION: u32 = 64;
/// How far the volume of a part may be from its hull's, as a share of the volume of the mesh's hull, before it is cut.
const CONCAVITY: f64 = 0.005;
/// Pieces at most. Most links of robots come out as fewer than half of them.
const MOST_PIECES: u32 = 64;

/// The pieces of a mesh: a compound of convex hulls, in the order VHACD gives them.
///
/// # Errors
/// No triangles, a vertex that is not finite, an index out of range; a mesh that cannot be decomposed, which is one without extent.
pub fn decomposed(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Result<Compound, InvalidShape> {
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
    let bounds = Aabb::around(triangles.iter().flatten().map(|&c| vertices[c as usize]));
    let (center, size) = (bounds.center(), bounds.half_extents().amax());
    if size <= f64::MIN_POSITIVE {
        return Err(InvalidShape::NotDecomposed);
    }
    // The cut has absolute tolerances, so it is shown a mesh of unit size, centred.
    let unit: Vec<Vec3> = vertices.iter().map(|v| (v - center) / size).collect();
    // A corner of the mesh is itself again, not what scaling there and back rounds it to.
    let mut vertex_at = HashMap::with_capacity(unit.len());
    unit.iter().zip(vertices).for_each(|(p, v)| _ = vertex_at.entry(bits(*p)).or_insert(*v));
    let given = |p: Vec3| vertex_at.get(&bits(p)).copied().unwrap_or(center + p * size);
    let mut parts = Vec::new();
    for points in cut(&unit, triangles).ok_or(InvalidShape::NotDecomposed)? {
        let points: Vec<Vec3> = points.into_iter().map(given).collect();
        if !points.is_empty() {
            parts.push(Part { shape: Shape::convex(&points)?, pose: Pose::identity() });
        }
    }
    if parts.is_empty() {
        return Err(InvalidShape::NotDecomposed);
    }
    Compound::new(parts)
}

fn bits(p: Vec3) -> [u64; 3] {
    [p.x, p.y, p.z].map(|c| (c + 0.0).to_bits()) // + 0.0: -0 equals 0
}

/// The corners of each part's hull, in the unit frame. None where the crate gives up, for which it panics.
fn cut(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Option<Vec<Vec<Vec3>>> {
    use parry3d_f64::math::Vector;
    use parry3d_f64::transformation::vhacd::{VHACD, VHACDParameters};
    use parry3d_f64::transformation::voxelization::VoxelSet;

    let points: Vec<Vector> = vertices.iter().map(|p| Vector::new(p.x, p.y, p.z)).collect();
    let parameters = VHACDParameters {
        resolution: RESOLUTION,
        concavity: CONCAVITY,
        max_convex_hulls: MOST_PIECES,
        ..VHACDParameters::default()
    };
    let of_parts = std::panic::catch_unwind(|| {
        let decomposition = VHACD::decompose(&parameters, &points, triangles, true);
        let corners = |part: &VoxelSet| {
            // Of a flat part the crate makes no hull; ours takes any points.
            let hull = std::panic::catch_unwind(|| part.compute_exact_convex_hull(&points, triangles));
            hull.map_or_else(|_| part.compute_primitive_intersections(&points, triangles), |(corners, _)| corners)
        };
        decomposition.voxel_parts().iter().map(corners).collect::<Vec<_>>()
    });
    let vector = |p: Vector| Vec3::new(p.x, p.y, p.z);
    Some(of_parts.ok()?.into_iter().map(|part| part.into_iter().map(vector).collect()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Core;

    /// An L of two bars, 1 m long and 0.2 m thick, as a closed mesh.
    fn corner_piece() -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let outline = [(0.0, 0.0), (1.0, 0.0), (1.0, 0.2), (0.2, 0.2), (0.2, 1.0), (0.0, 1.0)];
        let level = |z: f64| outline.map(|(x, y)| Vec3::new(x, y, z));
        let vertices = [level(0.0), level(0.2)].concat();
        let caps = [[0, 1, 2], [0, 2, 3], [0, 3, 5], [3, 4, 5]];
        let mut triangles: Vec<[u32; 3]> = caps.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
        triangles.extend(caps.map(|cap| cap.map(|i| i + 6)));
        for i in 0..6 {
            let j = (i + 1) % 6;
            triangles.extend([[i, j, j + 6], [i, j + 6, i + 6]]);
        }
        (vertices, triangles)
    }

    #[test]
    fn an_l_is_a_few_pieces_that_reach_no_farther_than_it_and_the_same_each_time() {
        let (vertices, triangles) = corner_piece();
        let pieces = decomposed(&vertices, &triangles).unwrap();
        assert!((2..=8).contains(&pieces.parts().len()), "{} pieces", pieces.parts().len());
        let bounds = Aabb::around(vertices.iter().copied());
        assert!(bounds.grown(1e-9).contains(&pieces.bounds()) && pieces.bounds().grown(1e-9).contains(&bounds));
        let corners = |compound: &Compound| -> Vec<Vec<Vec3>> {
            let hull = |part: &Part| {
                let Core::Convex(hull) = part.shape.core() else { panic!("{part:?}") };
                hull.points().to_vec()
            };
            compound.parts().iter().map(hull).collect()
        };
        assert_eq!(corners(&pieces), corners(&decomposed(&vertices, &triangles).unwrap()));
    }

    #[test]
    fn what_cannot_be_decomposed_is_refused_by_name() {
        let text = |vertices: &[Vec3], triangles: &[[u32; 3]]| decomposed(vertices, triangles).unwrap_err().to_string();
        assert_eq!(text(&[], &[]), "triangles is empty");
        assert_eq!(text(&[Vec3::zeros(); 3], &[[0, 1, 3]]), "triangles[0] names vertex 3, but there are 3 vertices");
        assert_eq!(text(&[Vec3::repeat(f64::NAN); 3], &[[0, 1, 2]]), "vertices[0] is not finite");
        assert_eq!(text(&[Vec3::x(); 3], &[[0, 1, 2]]), "the mesh has no extent, or cannot be cut into convex pieces");
    }
}
