//! The bodies whose geometry is approximated: a shelf, and a mug that stands in it, as closed meshes.

use std::sync::Arc;

use crate::geometry::{InvalidShape, TriangleMesh, Vec3};

/// Boards along x, walls along z, all 2 cm thick; open to the front (-y), with a back. 0.8 x 0.3 x 0.8 m, three compartments.
pub(super) fn shelf() -> Result<Arc<TriangleMesh>, InvalidShape> {
    const T: f64 = 0.02;
    let across = [0.0, T, 0.8 - T, 0.8];
    let along = [0.0, 0.3 - T, 0.3];
    let up = [0.0, T, 0.26, 0.26 + T, 0.52, 0.52 + T, 0.8 - T, 0.8];
    let is_wall = |[i, j, k]: [usize; 3]| i != 1 || j == 1 || k % 2 == 0;
    from_blocks(&across, &along, &up, is_wall)
}

/// The surface of the blocks of a grid that are filled.
fn from_blocks(
    x: &[f64],
    y: &[f64],
    z: &[f64],
    is_filled: impl Fn([usize; 3]) -> bool,
) -> Result<Arc<TriangleMesh>, InvalidShape> {
    let counts = [x.len() - 1, y.len() - 1, z.len() - 1];
    let filled = |block: [usize; 3]| (0..3).all(|axis| block[axis] < counts[axis]) && is_filled(block);
    let vertex = |[i, j, k]: [usize; 3]| (i * y.len() + j) * z.len() + k;
    let mut vertices = Vec::new();
    for x in x {
        for y in y {
            vertices.extend(z.iter().map(|z| Vec3::new(*x, *y, *z)));
        }
    }
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    let blocks = (0..counts[0]).flat_map(|i| (0..counts[1]).flat_map(move |j| (0..counts[2]).map(move |k| [i, j, k])));
    for block in blocks.filter(|block| filled(*block)) {
        for axis in 0..3 {
            for side in 0..2 {
                let mut next = block;
                next[axis] = next[axis].wrapping_add(if side == 1 { 1 } else { usize::MAX });
                if next[axis] != usize::MAX && filled(next) {
                    continue;
                }
                // The face's corners, the other two axes in cyclic order, so that side 1 faces outwards.
                let corner = |u: usize, v: usize| {
                    let mut at = block;
                    at[axis] += side;
                    at[(axis + 1) % 3] += u;
                    at[(axis + 2) % 3] += v;
                    vertex(at) as u32
                };
                let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                let faces = [[a, b, c], [a, c, d]];
                triangles.extend(if side == 1 { faces } else { faces.map(|[a, b, c]| [a, c, b]) });
            }
        }
    }
    TriangleMesh::solid(vertices, triangles).map(Arc::new)
}

/// Hollow, 8 cm wide and 10 cm high, walls of 4 mm, with a handle-less rim; `around` corners in each ring.
pub(super) fn mug(around: usize) -> Result<Arc<TriangleMesh>, InvalidShape> {
    // From the middle of the bottom outside, over the rim, to the middle of the bottom inside: radius and height.
    let mut profile = vec![(0.02, 0.0), (0.036, 0.0)];
    profile.extend((0..=6).map(|i| (0.036 + 0.004 * f64::from(i) / 6.0, 0.1 * f64::from(i) / 6.0)));
    profile.extend((0..=6).rev().map(|i| (0.032 + 0.004 * f64::from(i) / 6.0, 0.006 + 0.094 * f64::from(i) / 6.0)));
    profile.push((0.018, 0.006));
    profile.dedup();
    let ring = |(radius, height): (f64, f64)| {
        (0..around).map(move |i| {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * i as f64 / around as f64);
            Vec3::new(radius * cos, radius * sin, height)
        })
    };
    let mut vertices: Vec<Vec3> = profile.iter().copied().flat_map(ring).collect();
    let (bottom, inside) = (vertices.len() as u32, vertices.len() as u32 + 1);
    vertices.extend([Vec3::zeros(), Vec3::new(0.0, 0.0, 0.006)]);
    let at = |ring: usize, i: usize| (ring * around + i % around) as u32;
    let last = profile.len() - 1;
    let mut triangles = Vec::new();
    for i in 0..around {
        triangles.push([bottom, at(0, i + 1), at(0, i)]);
        triangles.push([inside, at(last, i), at(last, i + 1)]);
        for ring in 0..last {
            let [a, b, c, d] = [at(ring, i), at(ring, i + 1), at(ring + 1, i + 1), at(ring + 1, i)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    TriangleMesh::solid(vertices, triangles).map(Arc::new)
}

/// What a mesh takes in memory: corners, triangles, and a tree of two boxes a node.
pub(super) fn mesh_bytes(mesh: &TriangleMesh) -> usize {
    let (corners, triangles) = (mesh.vertices().len(), mesh.triangles().len());
    let of_triangle = size_of::<[u32; 3]>() + size_of::<[Vec3; 3]>() + size_of::<u32>();
    let nodes = triangles.saturating_sub(1) * size_of::<crate::geometry::Siblings>();
    corners * size_of::<Vec3>() + triangles * of_triangle + nodes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Placement, Pose, Quaternion, Shape};
    use crate::narrow_phase::{Goal, separation};

    fn signed_distance(mesh: &Arc<TriangleMesh>, point: Vec3) -> f64 {
        let at = Pose::new(point, Quaternion::IDENTITY).unwrap().placement();
        let shape = Shape::mesh(Arc::clone(mesh));
        separation(&shape, &Shape::point(), &Placement::identity(), &at, &Goal::penetration()).unwrap().signed_distance
    }

    #[test]
    fn the_shelf_is_closed_with_room_in_it() {
        let shelf = shelf().unwrap();
        assert!(signed_distance(&shelf, Vec3::new(0.4, 0.1, 0.14)) > 0.1); // in the lowest compartment
        assert!(signed_distance(&shelf, Vec3::new(0.4, 0.1, 0.27)) < 0.0); // in a board
        assert!(signed_distance(&shelf, Vec3::new(0.4, 0.29, 0.14)) < 0.0); // in the back
        assert!((signed_distance(&shelf, Vec3::new(-0.5, 0.1, 0.4)) - 0.5).abs() < 1e-12);
    }

    #[test]
    fn the_mug_is_closed_and_hollow() {
        let mug = mug(48).unwrap();
        assert!(signed_distance(&mug, Vec3::new(0.0, 0.0, 0.05)) > 0.02); // within
        assert!(signed_distance(&mug, Vec3::new(0.0, 0.0, 0.003)) < 0.0); // in the bottom
        assert!(mesh_bytes(&mug) > 200 * mug.triangles().len());
    }
}
