//! Polytopes of few faces, with all that separating axes need of them: corners, outward normals, and edges between faces.
//!
//! Flat shapes are prisms without height: a triangle has its two sides and three normals across its edges, a segment is a box
//! without width. Then every edge lies between two faces less than half a turn apart, as on a solid, and normals that belong
//! to no face of their own do no harm: along any unit vector at all there is a bound.

use arrayvec::ArrayVec;

use crate::geometry::tolerance::UNIT_ROUNDOFF;
use crate::geometry::{Core, Placement, Vec3};

/// Corners at most. Pairs of edges are looked at one by one, some 30 000 of them for two hulls of this size.
pub(super) const MAX_VERTICES: usize = 64;
/// Euler: a triangulated sphere of v corners has 2 v - 4 faces and 3 v - 6 edges.
const MAX_FACES: usize = 2 * MAX_VERTICES - 4;
const MAX_EDGES: usize = 3 * MAX_VERTICES - 6;

/// The outward normal of a face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    /// Of unit length, within rounding.
    pub normal: Vec3,
    /// How far it may be turned from the true normal of the corners as stored; radians.
    pub turn: f64,
}

/// An edge and the faces on either side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    ends: [u8; 2],
    faces: [u8; 2],
}

/// A polytope of few faces, without allocation.
#[derive(Clone, Default)]
pub(super) struct SmallPolytope {
    vertices: ArrayVec<Vec3, MAX_VERTICES>,
    faces: ArrayVec<Face, MAX_FACES>,
    edges: ArrayVec<Edge, MAX_EDGES>,
}

impl SmallPolytope {
    /// None for round cores, for hulls of too many corners or without proved faces, and for slivers whose normals are lost in
    /// rounding.
    pub fn of(core: &Core) -> Option<Self> {
        let mut polytope = Self::default();
        match core {
            Core::Point => polytope.vertices.push(Vec3::zeros()),
            Core::Cuboid { half_extents } => polytope.add_box(*half_extents),
            Core::AxialSegment { half_length } => {
                polytope.add_segment([-half_length, *half_length].map(|z| Vec3::new(0.0, 0.0, z)))?;
            }
            Core::Segment(ends) => polytope.add_segment(*ends)?,
            Core::Triangle(corners) => polytope.add_triangle(*corners)?,
            Core::Convex(hull) if hull.points().len() <= MAX_VERTICES => {
                polytope.add_surface(hull.points(), hull.surface()?.triangles())?;
            }
            Core::Convex(_)
            | Core::Cylinder { .. }
            | Core::Cone { .. }
            | Core::Ellipsoid { .. }
            | Core::HalfSpace { .. }
            | Core::Plane { .. }
            | Core::Mesh(_)
            | Core::Compound(_)
            | Core::HeightField(_)
            | Core::PointCloud(_)
            | Core::Voxels(_)
            | Core::Column(_)
            | Core::Block(_) => return None,
        }
        Some(polytope)
    }

    pub fn vertices(&self) -> &[Vec3] {
        &self.vertices
    }

    pub fn faces(&self) -> &[Face] {
        &self.faces
    }

    /// Each edge as its two ends and the normals on either side.
    pub fn edges(&self) -> impl Iterator<Item = ([Vec3; 2], [Face; 2])> {
        let at = |edge: &Edge| {
            (edge.ends.map(|i| self.vertices[usize::from(i)]), edge.faces.map(|f| self.faces[usize::from(f)]))
        };
        self.edges.iter().map(at)
    }

    /// The polytope in the frame it is placed in. A rotation matrix is one only to rounding, so the normals of the image are
    /// turned a little against the images of the normals.
    pub fn placed(&self, at: &Placement) -> Self {
        // 118 u from the cross products of its columns, 83 u from the columns (docs/derivations/sat.md), 5 u to turn.
        let turn = 206.0 * UNIT_ROUNDOFF;
        let mut placed = self.clone();
        placed.vertices.iter_mut().for_each(|p| *p = at.point(*p));
        for face in &mut placed.faces {
            *face = Face { normal: at.direction(face.normal).normalize(), turn: face.turn + turn };
        }
        placed
    }

    fn add_edge(&mut self, ends: [usize; 2], faces: [usize; 2]) {
        // Counts are below 256.
        self.edges.push(Edge { ends: ends.map(|i| i as u8), faces: faces.map(|i| i as u8) });
    }

    fn add_box(&mut self, half: Vec3) {
        let sign = |corner: usize, axis: usize| if corner >> axis & 1 == 0 { -1.0 } else { 1.0 };
        for corner in 0..8 {
            self.vertices.push(Vec3::from_fn(|axis, _| half[axis] * sign(corner, axis)));
        }
        for face in 0..6 {
            self.faces.push(Face { normal: Vec3::ith(face / 2, sign(face, 0)), turn: 0.0 });
        }
        for axis in 0..3 {
            let (p, q) = ((axis + 1) % 3, (axis + 2) % 3);
            for (on_p, on_q) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let from = on_p << p | on_q << q;
                self.add_edge([from, from | 1 << axis], [2 * p + on_p, 2 * q + on_q]);
            }
        }
    }

    /// None when the direction is lost in rounding.
    fn add_segment(&mut self, [a, b]: [Vec3; 2]) -> Option<()> {
        self.vertices.push(a);
        if a == b {
            return Some(());
        }
        self.vertices.push(b);
        let along = (b - a).try_normalize(0.0)?;
        let across = along.cross(&Vec3::ith(along.iamin(), 1.0)).try_normalize(0.0)?;
        let third = along.cross(&across);
        // Any normals around the edge will do, if they are across it.
        for normal in [across, third, -across, -third, along, -along] {
            self.faces.push(Face { normal, turn: 8.0 * UNIT_ROUNDOFF });
        }
        (0..4).for_each(|side| self.add_edge([0, 1], [side, (side + 1) % 4]));
        Some(())
    }

    fn add_triangle(&mut self, corners: [Vec3; 3]) -> Option<()> {
        let upper = normal_of(corners)?;
        corners.into_iter().for_each(|p| self.vertices.push(p));
        self.faces.push(upper);
        self.faces.push(Face { normal: -upper.normal, ..upper });
        for i in 0..3 {
            let next = (i + 1) % 3;
            let outward = (corners[next] - corners[i]).cross(&upper.normal).try_normalize(0.0)?;
            self.faces.push(Face { normal: outward, turn: upper.turn + 8.0 * UNIT_ROUNDOFF });
            self.add_edge([i, next], [0, 2 + i]);
            self.add_edge([i, next], [1, 2 + i]);
        }
        Some(())
    }

    fn add_surface(&mut self, points: &[Vec3], triangles: &[[u32; 3]]) -> Option<()> {
        points.iter().for_each(|p| self.vertices.push(*p));
        // The face on the left of each directed edge; 0 is none.
        let mut left = [[0u8; MAX_VERTICES]; MAX_VERTICES];
        for triangle in triangles {
            let corners = triangle.map(|i| i as usize);
            self.faces.push(normal_of(corners.map(|i| points[i]))?);
            for (from, to) in [(0, 1), (1, 2), (2, 0)] {
                left[corners[from]][corners[to]] = self.faces.len() as u8;
            }
        }
        for from in 0..points.len() {
            for to in from + 1..points.len() {
                if let (Some(one), Some(other)) = (left[from][to].checked_sub(1), left[to][from].checked_sub(1)) {
                    self.add_edge([from, to], [usize::from(one), usize::from(other)]);
                }
            }
        }
        Some(())
    }
}

/// The normal of a triangle, seen counter-clockwise; none when rounding could turn it by a tenth or more.
fn normal_of([a, b, c]: [Vec3; 3]) -> Option<Face> {
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(&ac);
    let area = normal.norm();
    // Components of the edges are off by u of themselves, products by 3 u, differences of products by 1 u more: 4 u |ab| |ac| on
    // each of three components.
    let turn = 8.0 * UNIT_ROUNDOFF * ab.norm() * ac.norm() / area;
    // The negation also refuses a turn that is not a number.
    let is_lost = !(turn < 0.1);
    (!is_lost).then(|| Face { normal: normal / area, turn: turn + 3.0 * UNIT_ROUNDOFF })
}
