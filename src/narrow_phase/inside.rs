//! Whether a point is inside a closed mesh: how often a ray from it crosses the surface.
//!
//! An odd number of crossings means inside. The count goes wrong where a ray meets an edge or a corner, so each crossing
//! is told by the exact signs of the volumes of tetrahedra (Shewchuk's adaptive test, from the `robust` crate), and a ray for which one of those
//! that matter is zero is given up for the next. Boxes that the ray misses are not opened, so the cost
//! grows with the depth of the tree and the number of crossings, not with the triangles.
//! If all rays fail, or numbers are too large or too small for exact products, the solid angles of the triangles are added up (van Oosterom and
//! Strackee 1983), which make 4 pi inside and 0 outside.

use robust::{Coord3D, orient3d};

use crate::geometry::tolerance::UNSCALED_EXTENT;
use crate::geometry::{Content, MOST_LEVELS, MeshTree, NodeId, OrientedBox, TriangleMesh, Vec3, length};

/// Directions of the rays: along no axis and no diagonal, so that meshes made on a grid have few edges in their way.
const RAYS: [[f64; 3]; 4] =
    [[0.877, 0.381, 0.293], [-0.359, 0.851, -0.383], [0.271, -0.443, 0.854], [-0.617, -0.563, -0.549]];

/// Whether a point, in the mesh's frame and not on its surface, is inside a solid mesh.
pub(super) fn is_inside(mesh: &TriangleMesh, point: Vec3) -> bool {
    let bounds = mesh.bounds();
    let extent = length(bounds.min.abs().sup(&bounds.max.abs()).sup(&point.abs()));
    // Beyond that, products overflow.
    let rays = if extent <= UNSCALED_EXTENT.1 { &RAYS[..] } else { &[] };
    // Longer than from anywhere to anywhere in the bounds.
    let end = |ray: &[f64; 3]| point + Vec3::from(*ray) * (4.0 * extent);
    let count = rays.iter().find_map(|ray| crossings(mesh.tree(), point, end(ray)));
    count.map_or_else(|| winds_around(mesh, point), |count| count % 2 == 1)
}

/// How many triangles the segment crosses; none where it meets an edge or a corner, or ends on a triangle.
fn crossings(tree: &MeshTree, from: Vec3, to: Vec3) -> Option<u32> {
    let nodes = tree.nodes();
    let segment = Segment::new(from, to);
    let mut waiting = [NodeId::ROOT; MOST_LEVELS + 1];
    let mut open = 1;
    let mut count = 0;
    while open > 0 {
        open -= 1;
        let node = waiting[open];
        if segment.misses(&nodes.bounds(node)) {
            continue;
        }
        match nodes.content(node) {
            Content::Leaf(leaf) => count += u32::from(crosses(tree.corners(leaf), from, to)?),
            Content::Children(children) => {
                for child in children {
                    waiting[open] = child;
                    open += 1;
                }
            }
        }
    }
    Some(count)
}

/// Whether the segment passes through the inner of the triangle; none where it meets the triangle in some other way, or may.
fn crosses(triangle: &[Vec3; 3], from: Vec3, to: Vec3) -> Option<bool> {
    let [a, b, c] = triangle.map(coord);
    let (p, q) = (coord(from), coord(to));
    let edges = [orient3d(p, q, a, b), orient3d(p, q, b, c), orient3d(p, q, c, a)].map(sign);
    if edges.contains(&1) && edges.contains(&-1) {
        return Some(false); // The line passes by.
    }
    let ends = [orient3d(a, b, c, p), orient3d(a, b, c, q)].map(sign);
    if ends[0] * ends[1] == 1 {
        return Some(false); // Both ends are on one side.
    }
    let is_proper = !edges.contains(&0) && !ends.contains(&0);
    is_proper.then_some(true)
}

/// A volume smaller than this, cubic metres, may be nothing but underflow in the exact products: it counts as zero.
const LEAST_VOLUME: f64 = 1e-250;

fn sign(volume: f64) -> i32 {
    if volume > LEAST_VOLUME {
        1
    } else if volume < -LEAST_VOLUME {
        -1
    } else {
        0
    }
}

fn coord(v: Vec3) -> Coord3D<f64> {
    Coord3D { x: v.x, y: v.y, z: v.z }
}

/// A segment that boxes are held against.
struct Segment {
    middle: Vec3,
    half: Vec3,
    /// What lengths may be off by, metres.
    slack: f64,
}

impl Segment {
    fn new(from: Vec3, to: Vec3) -> Self {
        let half = 0.5 * (to - from);
        // Some 30 roundings, and axes that are orthonormal to 16 units: 48 of the distance from a box's centre to its corners.
        let slack = 256.0 * f64::EPSILON * (length(from) + length(to));
        Self { middle: from + half, half, slack }
    }

    /// Whether the segment surely misses the box: a plane along a face of the box parts them, or one along the segment and an edge of the box.
    fn misses(&self, b: &OrientedBox) -> bool {
        let middle = b.axes.tr_mul(&(self.middle - b.center));
        let half = b.axes.tr_mul(&self.half);
        let reach = b.half_extents.add_scalar(self.slack);
        if (middle.abs() - half.abs() - reach).max() > 0.0 {
            return true;
        }
        let across = half.cross(&middle).abs();
        let h = half.abs();
        let limit =
            Vec3::new(reach.y * h.z + reach.z * h.y, reach.z * h.x + reach.x * h.z, reach.x * h.y + reach.y * h.x);
        (across - limit).add_scalar(-self.slack * h.sum()).max() > 0.0
    }
}

/// By the sum of the solid angles of all triangles: linear in their number.
fn winds_around(mesh: &TriangleMesh, point: Vec3) -> bool {
    // Directions to the corners: lengths cancel, and products of them could overflow.
    let solid_angle = |i: usize| {
        let [a, b, c] = mesh.triangle(i).map(|v| (v - point) / length(v - point));
        let volume = a.dot(&b.cross(&c));
        let denominator = 1.0 + a.dot(&b) + b.dot(&c) + c.dot(&a);
        2.0 * libm::atan2(volume, denominator)
    };
    let total: f64 = (0..mesh.triangles().len()).map(solid_angle).sum();
    total > 2.0 * std::f64::consts::PI
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cube of half side 1 with its faces cut along diagonals.
    fn cube() -> TriangleMesh {
        let sign = |bit: usize| if bit == 0 { -1.0 } else { 1.0 };
        let corners: Vec<Vec3> = (0..8).map(|i| Vec3::new(sign(i & 1), sign(i & 2), sign(i & 4))).collect();
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let faces = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
        TriangleMesh::solid(corners, faces).unwrap()
    }

    #[test]
    fn a_ray_through_a_corner_an_edge_or_a_diagonal_is_given_up_and_others_count() {
        let tree_of = cube();
        let through = |to: Vec3| crossings(tree_of.tree(), Vec3::zeros(), to);
        assert_eq!(through(Vec3::new(9.0, 9.0, 9.0)), None, "a corner");
        assert_eq!(through(Vec3::new(9.0, 9.0, 1.0)), None, "an edge");
        assert_eq!(through(Vec3::new(9.0, 0.0, 0.0)), None, "a face's diagonal");
        assert_eq!(through(Vec3::new(9.0, 1.0, 2.0)), Some(1));
        assert_eq!(crossings(tree_of.tree(), Vec3::new(-8.0, 0.3, 0.1), Vec3::new(9.0, 0.2, -0.3)), Some(2));
        assert_eq!(crossings(tree_of.tree(), Vec3::new(-8.0, 0.3, 0.1), Vec3::new(9.0, 9.2, -0.3)), Some(0));
    }

    /// Oracle: the cube's definition; and the solid angles for the same points.
    #[test]
    fn rays_and_solid_angles_agree_with_the_definition_of_a_cube() {
        let cube = cube();
        let mut inside = 0;
        for i in 0..1000 {
            let t = f64::from(i);
            let point = Vec3::new(libm::sin(1.3 * t), libm::sin(2.1 * t + 1.0), libm::sin(3.7 * t)) * 1.2;
            let expected = point.amax() < 1.0;
            assert_eq!(is_inside(&cube, point), expected, "{point}");
            assert_eq!(winds_around(&cube, point), expected, "{point}");
            inside += u32::from(expected);
        }
        assert!((100..900).contains(&inside), "{inside} inside");
        // Level with corners and edges: rays that are tried first may be given up, the answer is not.
        for k in 1..20 {
            let x = f64::from(k) * 0.1;
            for point in [Vec3::new(x, x, x), Vec3::new(x, 0.0, 0.0), Vec3::new(-x, x, 0.0)] {
                assert_eq!(is_inside(&cube, point * 1.001), (x * 1.001) < 1.0);
            }
        }
    }
}
