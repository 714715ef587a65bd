//! The triangles of a convex hull, taken from a hull builder only when they are proved to be the hull's.
//!
//! Builders round. A surface that is convex only nearly would let a walk over its edges stop at a vertex that is not the
//! farthest, and every bound that rests on it would be wrong. So the surface is checked with exact predicates, in time
//! proportional to its size, and dropped if it fails:
//! 1. every directed edge occurs once and so does its opposite, and vertices - edges + faces = 2: a sphere, once;
//! 2. one point is strictly inside of every face: the surface is star-shaped about it, covers each direction once, and
//!    so does not cross itself;
//! 3. along every edge the neighbour's third vertex is not outside the face: locally convex.
//!
//! A closed, connected, locally convex body is convex (Tietze 1928, Nakajima 1928).

use std::collections::BTreeMap;

use super::Vec3;

/// Triangles and neighbours of a convex hull whose vertices are all of its points.
#[derive(Clone, Debug)]
pub struct HullSurface {
    triangles: Vec<[u32; 3]>,
    /// Neighbours of vertex v: `neighbours[starts[v]..starts[v + 1]]`, in increasing order.
    starts: Vec<u32>,
    neighbours: Vec<u32>,
}

/// Magnitudes for which the exact predicate neither over- nor underflows, metres; zero is fine too. The predicate multiplies
/// three differences and keeps the tails of the product, some 1e-48 of it.
const EXACT: std::ops::RangeInclusive<f64> = 1e-60..=1e60;

impl HullSurface {
    /// Bytes on the heap.
    pub(super) fn memory(&self) -> usize {
        size_of_val(&*self.triangles) + size_of_val(&*self.starts) + size_of_val(&*self.neighbours)
    }

    /// The surface, if it is proved to be that of the convex hull of `points` and every point is a vertex of it.
    pub(super) fn proved(points: &[Vec3], triangles: &[[u32; 3]]) -> Option<Self> {
        let is_exact = |c: &f64| *c == 0.0 || EXACT.contains(&c.abs());
        if points.len() < 4 || !points.iter().all(|p| p.iter().all(is_exact)) {
            return None;
        }
        let opposite = opposite_vertices(triangles)?;
        let edges = opposite.len() / 2;
        let is_sphere = points.len() + triangles.len() == edges + 2;
        let inner = points.iter().sum::<Vec3>() / points.len() as f64;
        let at = |i: u32| points[i as usize];
        let is_convex = triangles.iter().all(|&[a, b, c]| {
            let is_inside = |p: Vec3| side(at(a), at(b), at(c), p);
            is_inside(inner) > 0.0 && [(b, a), (c, b), (a, c)].iter().all(|edge| is_inside(at(opposite[edge])) >= 0.0)
        });
        if !(is_sphere && is_convex) {
            return None;
        }
        let mut starts = vec![0];
        let mut neighbours = Vec::with_capacity(opposite.len());
        let mut all_are_vertices = true;
        let mut edges = opposite.keys().peekable();
        for vertex in (0u32..).take(points.len()) {
            let before = neighbours.len();
            while let Some(&(_, to)) = edges.next_if(|(from, _)| *from == vertex) {
                neighbours.push(to);
            }
            all_are_vertices &= neighbours.len() > before;
            starts.push(u32::try_from(neighbours.len()).ok()?);
        }
        all_are_vertices.then(|| Self { triangles: triangles.to_vec(), starts, neighbours })
    }

    /// Corners of each triangle as indices of the hull's points, counter-clockwise from outside. Coplanar neighbours
    /// occur: a cube has twelve.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The vertices that share an edge with `vertex`, in increasing order.
    #[must_use]
    pub fn neighbours(&self, vertex: u32) -> &[u32] {
        let v = vertex as usize;
        &self.neighbours[self.starts[v] as usize..self.starts[v + 1] as usize]
    }
}

/// For each directed edge the third vertex of its triangle; none unless each edge has exactly one opposite and the
/// surface hangs together.
fn opposite_vertices(triangles: &[[u32; 3]]) -> Option<BTreeMap<(u32, u32), u32>> {
    let mut opposite = BTreeMap::new();
    for &[a, b, c] in triangles {
        for (edge, third) in [((a, b), c), ((b, c), a), ((c, a), b)] {
            if opposite.insert(edge, third).is_some() {
                return None;
            }
        }
    }
    if !opposite.keys().all(|&(from, to)| opposite.contains_key(&(to, from))) {
        return None;
    }
    // Across edges from one triangle all others are reached, or there is more than one surface.
    let first = *triangles.first()?;
    let mut seen: BTreeMap<(u32, u32), bool> = opposite.keys().map(|edge| (*edge, false)).collect();
    let mut open = vec![(first[0], first[1])];
    let mut count = 0;
    while let Some((a, b)) = open.pop() {
        if std::mem::replace(seen.get_mut(&(a, b))?, true) {
            continue;
        }
        count += 1;
        let c = opposite[&(a, b)];
        open.extend([(b, c), (b, a)]);
    }
    (count == opposite.len()).then_some(opposite)
}

/// Positive when `p` is strictly on the inner side of the triangle, zero when in its plane. Exact.
pub(super) fn side(a: Vec3, b: Vec3, c: Vec3, p: Vec3) -> f64 {
    let coord = |v: Vec3| robust::Coord3D { x: v.x, y: v.y, z: v.z };
    robust::orient3d(coord(a), coord(b), coord(c), coord(p))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tetrahedron() -> (Vec<Vec3>, Vec<[u32; 3]>) {
        (vec![Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()], vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    }

    #[test]
    fn a_tetrahedron_is_proved_and_knows_its_neighbours() {
        let (points, triangles) = tetrahedron();
        let surface = HullSurface::proved(&points, &triangles).unwrap();
        assert_eq!(surface.neighbours(2), [0, 1, 3]);
        assert_eq!(surface.triangles().len(), 4);
    }

    #[test]
    fn what_is_open_inverted_double_or_dented_is_not_proved() {
        let (points, triangles) = tetrahedron();
        assert!(HullSurface::proved(&points, &triangles[1..]).is_none(), "open");
        let inverted: Vec<_> = triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
        assert!(HullSurface::proved(&points, &inverted).is_none(), "inside out");
        let mut two = points.clone();
        two.extend(points.iter().map(|p| p * 2.0));
        let both: Vec<_> = triangles.iter().flat_map(|t| [*t, t.map(|i| i + 4)]).collect();
        assert!(HullSurface::proved(&two, &both).is_none(), "two surfaces");
        // A roof of four triangles whose top is a hair below the plane of its base.
        let dent = |height: f64| {
            let mut points: Vec<Vec3> =
                [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)].map(|(x, y)| Vec3::new(x, y, 0.0)).into();
            points.extend([Vec3::new(0.0, 0.0, height), Vec3::new(0.0, 0.0, -1.0)]);
            let ring = |i: u32| (i + 1) % 4;
            let faces: Vec<[u32; 3]> = (0..4).flat_map(|i| [[i, ring(i), 4], [ring(i), i, 5]]).collect();
            HullSurface::proved(&points, &faces).is_some()
        };
        assert!(dent(1e-300f64.sqrt().max(1e-50)) && dent(0.0) && !dent(-1e-50));
    }

    #[test]
    fn a_point_that_no_triangle_uses_is_no_vertex() {
        let (mut points, triangles) = tetrahedron();
        points.push(Vec3::repeat(0.1));
        assert!(HullSurface::proved(&points, &triangles).is_none());
    }
}
