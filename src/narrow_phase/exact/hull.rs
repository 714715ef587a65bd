//! The surface that the exact depth is read off: a closed polytope of triangles around corners of the Minkowski difference.
//!
//! Corners are integers, so which faces a new corner sees is decided without error; doubles decide where they are sure.
//! A face in whose plane a corner lies is not seen: the surface is the convex hull of its corners at every step.

use dashu_int::IBig;

use super::pair::Corner;
use super::root::Root;
use super::vector::Vector;
use crate::geometry::Vec3;

/// A triangle of the surface, counter-clockwise from outside.
pub(super) struct Face {
    pub corners: [usize; 3],
    /// Outward, of any length.
    pub normal: Vector,
    /// `normal . corner`: how far the origin is below the plane, times the length of the normal.
    pub offset: IBig,
    /// The offset over the length of the normal, to a few units in the last place of itself; in the hull's unit of length.
    pub distance: f64,
    /// No corner of the difference is above it.
    pub is_final: bool,
    unit: Vec3,
}

/// The surface.
pub(super) struct Hull {
    corners: Vec<Corner>,
    /// The corners in doubles, in a unit in which none has a coordinate above 1.
    rounded: Vec<Vec3>,
    faces: Vec<Face>,
    exponent: i32,
}

/// A corner is on the side of a plane that doubles say when it is this far from it, in the hull's unit: normals and corners
/// are off by a few times 2^-53, and their products are of size 4 at most.
const SURE: f64 = 1.0 / (1u64 << 46) as f64;

impl Hull {
    /// A tetrahedron with volume; none when it is flat. `bits`: of the largest coordinate of any corner to come.
    pub fn new(corners: [Corner; 4], bits: usize) -> Option<Self> {
        let [a, b, c, d] = &corners;
        let volume = b.w.minus(&a.w).cross(&c.w.minus(&a.w)).dot(&d.w.minus(&a.w));
        if volume.is_zero() {
            return None;
        }
        let exponent = -i32::try_from(bits).ok()?;
        let mut hull = Self { corners: Vec::new(), rounded: Vec::new(), faces: Vec::new(), exponent };
        let below = volume < IBig::ZERO;
        corners.into_iter().for_each(|corner| hull.add_corner(corner));
        for [i, j, k] in [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]] {
            hull.add_face(if below { [i, j, k] } else { [i, k, j] });
        }
        Some(hull)
    }

    pub fn corner(&self, index: usize) -> &Corner {
        &self.corners[index]
    }

    pub fn faces(&self) -> &[Face] {
        &self.faces
    }

    /// The face of least distance that is not final, with its index.
    pub fn nearest_open_face(&self) -> Option<usize> {
        let open = (0..self.faces.len()).filter(|&f| !self.faces[f].is_final);
        open.min_by(|&f, &g| self.faces[f].distance.total_cmp(&self.faces[g].distance))
    }

    /// Notes that no corner of the difference is above the face.
    pub fn finish(&mut self, face: usize) {
        self.faces[face].is_final = true;
    }

    /// Whether a corner is strictly above the plane of the face.
    pub fn sees(&self, corner: &Corner, face: usize) -> bool {
        let face = &self.faces[face];
        face.normal.dot(&corner.w) > face.offset
    }

    /// Grows the surface to the hull of itself and a corner that is strictly above some face.
    pub fn insert(&mut self, corner: Corner) {
        let point = self.round(&corner.w);
        let seen = |face: &Face| {
            let height = face.unit.dot(&(point - self.rounded[face.corners[0]]));
            if height.abs() > SURE { height > 0.0 } else { face.normal.dot(&corner.w) > face.offset }
        };
        let mut edges = Vec::with_capacity(24);
        let mut kept = Vec::with_capacity(self.faces.len() + 8);
        for face in std::mem::take(&mut self.faces) {
            if seen(&face) {
                let [i, j, k] = face.corners;
                edges.extend([(i, j), (j, k), (k, i)]);
            } else {
                kept.push(face);
            }
        }
        self.faces = kept;
        let apex = self.corners.len();
        self.add_corner(corner);
        // The horizon: edges whose other side is not seen.
        for &(from, to) in edges.iter().filter(|(from, to)| !edges.contains(&(*to, *from))) {
            self.add_face([from, to, apex]);
        }
    }

    fn round(&self, w: &Vector) -> Vec3 {
        let [x, y, z] = [0, 1, 2].map(|i| super::integers::approximate(&w.0[i], self.exponent));
        Vec3::new(x, y, z)
    }

    fn add_corner(&mut self, corner: Corner) {
        self.rounded.push(self.round(&corner.w));
        self.corners.push(corner);
    }

    fn add_face(&mut self, corners: [usize; 3]) {
        let [a, b, c] = corners.map(|i| &self.corners[i].w);
        let normal = b.minus(a).cross(&c.minus(a));
        let offset = normal.dot(a);
        let (scaled, exponent) = normal.normalised();
        let length = scaled.norm();
        let distance = super::integers::approximate(&offset, exponent.saturating_add(self.exponent)) / length;
        let unit = scaled / length;
        self.faces.push(Face { corners, normal, offset, distance, is_final: false, unit });
    }
}

impl Face {
    /// Distance of its plane from the origin, which is on or below it, in integer lengths; as a root of a negative: the depth.
    pub fn depth(&self) -> Root {
        Root { negative: true, numerator: &self.offset * &self.offset, denominator: self.normal.square(), exponent: 0 }
    }
}
