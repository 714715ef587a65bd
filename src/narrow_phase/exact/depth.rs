//! The depth of an overlap of two polytopes, exactly: the expanding polytope algorithm on integers.
//!
//! A surface inside the Minkowski difference is grown where it is nearest the origin, until the nearest face cannot be pushed
//! out. That face is then on the boundary of the difference, which proves the depth from above, and everything within that
//! distance of the origin is inside the surface, which proves it from below.

use dashu_int::IBig;

use super::hull::{Face, Hull};
use super::pair::{Corner, Pair};
use super::root::{Root, compare};
use super::vector::Vector;

/// What is known of the depth.
pub(super) enum Depth {
    /// The difference has volume: the face of its boundary nearest the origin.
    Solid {
        /// Minus the depth, in integer lengths.
        depth: Root,
        /// Outward normal of the face.
        outward: Vector,
        /// Corners of the face, and weights that mix the point of it nearest the origin.
        corners: [Corner; 3],
        weights: [IBig; 3],
    },
    /// The difference lies in a plane with this normal through the origin, or in less (then zero): the depth is zero.
    Flat(Vector),
}

/// Rounds at most. Two hulls of a thousand corners, one deep in the other, take some 200.
const MAX_ROUNDS: u32 = 1000;

/// Faces whose distances doubles cannot tell apart are compared exactly; the distances are off by a few times 2^-53 of themselves.
const TIE: f64 = 1.0 + 1.0 / (1u64 << 44) as f64;

/// The depth of the origin in the difference, which some corners of it enclose. None when the rounds ran out or `stop` said so.
pub(super) fn depth(pair: &mut Pair, enclosing: Vec<Corner>, stop: &dyn Fn() -> bool) -> Option<Depth> {
    let mut hull = match solid_start(pair, enclosing) {
        Ok(corners) => Hull::new(corners, pair.frames.bits)?,
        Err(across) => return Some(Depth::Flat(across)),
    };
    let mut final_distance = f64::INFINITY;
    for _ in 0..MAX_ROUNDS {
        let nearest = hull.nearest_open_face().filter(|&face| hull.faces()[face].distance <= final_distance * TIE);
        let Some(face) = nearest else {
            return best_final_face(&hull);
        };
        if stop() {
            return None;
        }
        let highest = pair.lowest(&hull.faces()[face].normal.negated());
        if hull.sees(&highest, face) {
            hull.insert(highest);
        } else {
            hull.finish(face);
        }
        let finals = hull.faces().iter().filter(|face| face.is_final).map(|face| face.distance);
        final_distance = finals.fold(f64::INFINITY, f64::min);
    }
    None
}

/// Of the final faces the nearest; of its triangles the one that the foot of the origin is in.
fn best_final_face(hull: &Hull) -> Option<Depth> {
    let finals = hull.faces().iter().filter(|face| face.is_final).map(|face| (face, face.depth(), foot(hull, face)));
    let (face, depth, weights) = finals.reduce(|one, other| {
        // The depth is negative: the greater is the nearer to zero.
        let is_better = match compare(&other.1, &one.1) {
            std::cmp::Ordering::Greater => true,
            std::cmp::Ordering::Equal => {
                one.2.iter().any(|w| *w < IBig::ZERO) && other.2.iter().all(|w| *w >= IBig::ZERO)
            }
            std::cmp::Ordering::Less => false,
        };
        if is_better { other } else { one }
    })?;
    let weights = weights.map(|w| w.max(IBig::ZERO));
    let corners = face.corners.map(|i| hull.corner(i).clone());
    Some(Depth::Solid { depth, outward: face.normal.clone(), corners, weights })
}

/// Weights that mix the foot of the origin on the plane of the face from its corners; negative where it is outside.
fn foot(hull: &Hull, face: &Face) -> [IBig; 3] {
    let [a, b, c] = face.corners.map(|i| &hull.corner(i).w);
    [(b, c), (c, a), (a, b)].map(|(p, q)| face.normal.dot(&p.cross(q)))
}

/// Four corners that span a tetrahedron around or next to the origin, which the given ones have in their hull; else the
/// direction the difference is flat across, zero when it is a segment or a point.
fn solid_start(pair: &mut Pair, mut corners: Vec<Corner>) -> Result<[Corner; 4], Vector> {
    loop {
        let directions = match corners.as_slice() {
            [a, b, c, d] => return Ok([a.clone(), b.clone(), c.clone(), d.clone()]),
            [a, b, c] => vec![normal(a, b, c)],
            [a, b] => {
                let along = b.w.minus(&a.w);
                let across: Vec<Vector> = (0..3).map(|i| along.cross(&Vector::axis(i))).collect();
                across
            }
            _ => (0..3).map(Vector::axis).collect(),
        };
        let from = corners[0].w.clone();
        let off = directions.iter().filter(|d| !d.is_zero()).find_map(|d| {
            let height = d.dot(&from);
            [d.clone(), d.negated()].into_iter().map(|d| pair.lowest(&d)).find(|corner| d.dot(&corner.w) != height)
        });
        match (off, corners.len()) {
            (Some(corner), _) => corners.push(corner),
            (None, 3) => return Err(directions[0].clone()),
            (None, _) => return Err(Vector::zero()),
        }
    }
}

fn normal(a: &Corner, b: &Corner, c: &Corner) -> Vector {
    b.w.minus(&a.w).cross(&c.w.minus(&a.w))
}
