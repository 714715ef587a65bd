//! Depth of an overlap, and the direction out of it: the expanding polytope algorithm on the Minkowski difference C.
//!
//! Depth is the distance from the origin to the boundary of C. A polytope inside C is grown, by the support point
//! beyond its face nearest the origin, until that face is on the boundary. Source: van den Bergen 2001. Departures:
//! - It need not start around the origin. Offsets of faces are signed, so it also sharpens the answer for cores that
//!   touch or miss by less than GJK can tell: for any unit n, the signed distance is at least `min over C of n . c`.
//! - It stops on a bracket. From below: that bound, for every direction asked about. From above, when the origin is
//!   strictly inside the surface (exact test): the ball around it that no face cuts, for the surface is in C's hull.
//! - A difference without volume is recognised, and separated along its thinnest direction.

use arrayvec::ArrayVec;

use super::bracketing::Target;
use super::minkowski::{Difference, Vertex};
use super::outcome::{Cost, Termination};
use super::polytope::Polytope;
use super::simplex::{nearest_of_triangle, orientation};
use super::support::unit;
use crate::geometry::Vec3;
use crate::geometry::vector::opposite;

/// Rounds at most. Pairs with one deepest direction need fewer than 150. Bodies of revolution about one axis have a
/// whole circle of them, and each round narrows the bracket at one place of it.
const MAX_ITERATIONS: u32 = 500;

/// In these rounds the faces at the newest vertex go first: on a circle of deepest directions that follows one of them
/// to the end, so that the estimate is good though the bracket stays wide.
const LOCAL_ITERATIONS: std::ops::Range<u32> = 250..350;

/// What EPA found out. Metres, frame of the difference.
pub(super) struct Epa {
    /// The signed distance of the cores is at least this.
    pub lower: f64,
    /// And at most this.
    pub upper: f64,
    /// The best unit direction from the origin to where C would be if the cores were apart: `lower` is its bound.
    pub direction: Vec3,
    /// Where the boundary of C is nearest the origin, with the points of A and B it is the difference of.
    pub nearest: Vertex,
    /// How it stopped.
    pub termination: Termination,
}

/// Narrows `known` (valid bounds that GJK found, with the nearest point it found), starting from some vertices of C.
#[inline(never)]
pub(super) fn epa(difference: &mut Difference, seeds: &[Vertex], known: Epa, target: &Target, cost: &mut Cost) -> Epa {
    let mut best = known;
    let mut polytope = Polytope::new(difference.extent + 2.0 * difference.error);
    let enclosing = <[Vertex; 4]>::try_from(seeds).ok().filter(|seeds| is_solid(seeds, difference.extent));
    if let Some(seeds) = enclosing
        && polytope.start(seeds)
    {
        return expand(difference, &mut polytope, best, target, cost);
    }
    let mut pool: Pool = seeds.iter().copied().collect();
    match starting_vertices(difference, &mut pool, cost) {
        Start::Flat(across) => {
            for direction in [across, -across] {
                cost.supports += 1;
                raise_lower(&mut best, direction, direction.dot(&lowest(difference, direction).w), difference);
            }
            if target.is_met(&target.bracket(best.lower, best.upper)) {
                best.termination = Termination::Converged;
            } else if best.upper - best.lower <= 4.0 * difference.error {
                best.termination = Termination::RoundingFloor;
            }
            best
        }
        Start::Solid(corners) => {
            polytope.start(corners);
            for vertex in pool {
                if let Some(face) = polytope.visible_face(&vertex) {
                    polytope.insert(vertex, face);
                }
            }
            expand(difference, &mut polytope, best, target, cost)
        }
    }
}

/// Whether a tetrahedron is thick enough to grow from without help: a millionth of what it could be.
fn is_solid(&[a, b, c, d]: &[Vertex; 4], extent: f64) -> bool {
    (a.w - d.w).dot(&(b.w - d.w).cross(&(c.w - d.w))).abs() > 1e-6 * extent * extent * extent
}

fn expand(
    difference: &mut Difference,
    polytope: &mut Polytope,
    mut best: Epa,
    target: &Target,
    cost: &mut Cost,
) -> Epa {
    let error = difference.error;
    best.termination = Termination::IterationLimit;
    // Of faces that cannot be pushed out further.
    let mut least_final_offset = f64::INFINITY;
    // Once inside, the origin stays inside: the surface only grows.
    let mut encloses = polytope.encloses_origin();
    let mut follow = true;
    // Corners of the face of the best direction.
    let mut deepest = None;
    for iteration in 0..MAX_ITERATIONS {
        let local = (follow && LOCAL_ITERATIONS.contains(&iteration)).then(|| polytope.nearest_newest_face()).flatten();
        let Some(face) = local.or_else(|| polytope.nearest_face()) else {
            best.termination = Termination::RoundingFloor;
            break;
        };
        let offset = polytope.face(face).offset;
        if let Some(ball) = (encloses && local.is_none()).then(|| offset.min(least_final_offset))
            && ball > error
        {
            best.upper = best.upper.min(error - ball);
        }
        let (outward, length) = (polytope.face(face).outward, polytope.face(face).length);
        let vertex = lowest(difference, opposite(outward));
        let reach = outward.dot(&vertex.w) / length;
        cost.supports += 1;
        cost.epa_iterations += 1;
        if raise_lower(&mut best, opposite(outward) / length, -reach, difference) {
            deepest = Some(polytope.corners(face));
            if !encloses {
                best.upper =
                    best.upper.min(nearest_of_triangle(polytope.corners(face), difference.extent).w.norm() + error);
            }
        }
        if target.may_be_enough(best.lower, best.upper) {
            let bracket = target.bracket(best.lower, best.upper);
            if target.is_met(&bracket) || target.is_decided(&bracket) {
                best.termination = if target.is_met(&bracket) { Termination::Converged } else { Termination::Decided };
                break;
            }
        }
        if target.must_stop() {
            best.termination = Termination::TimeLimit;
            break;
        }
        let gain = reach - offset;
        if gain <= 0.25 * error || !polytope.is_outside(face, &vertex) {
            if local.is_some() {
                follow = false;
                continue;
            }
            least_final_offset = least_final_offset.min(offset);
            // The face that holds the ball back is on the boundary of C, so nothing wider can be proved.
            if -offset - 2.0 * error <= best.lower {
                best.termination = Termination::RoundingFloor;
                break;
            }
            continue;
        }
        if polytope.is_full() {
            break;
        }
        polytope.insert(vertex, face);
        encloses = encloses || polytope.encloses_origin();
    }
    if let Some(corners) = deepest {
        best.nearest = nearest_of_triangle(corners, difference.extent);
        let height = best.direction.dot(&best.nearest.w);
        if (best.nearest.w - best.direction * height).norm() > 8.0 * error {
            best.nearest = nearest_in_plane(polytope, &best, difference);
        }
    }
    best
}

/// The nearest point on the faces that lie in one plane with the face of the best direction: the first of them that came up
/// need not be the one that the origin is above.
#[cold]
fn nearest_in_plane(polytope: &Polytope, best: &Epa, difference: &Difference) -> Vertex {
    let height = best.direction.dot(&best.nearest.w);
    let is_level = |v: &Vertex| (best.direction.dot(&v.w) - height).abs() <= 8.0 * difference.error;
    let mut nearest = best.nearest;
    for corners in polytope.triangles().filter(|corners| corners.iter().all(is_level)) {
        let point = nearest_of_triangle(corners, difference.extent);
        if point.w.norm_squared() < nearest.w.norm_squared() {
            nearest = point;
        }
    }
    nearest
}

/// One copy of the support function is enough here, where the polytope is most of the work.
#[inline(never)]
fn lowest(difference: &mut Difference, direction: Vec3) -> Vertex {
    difference.lowest(direction)
}

/// Takes note of `value`, the least of `direction . c` over C, and says whether it is the best so far.
fn raise_lower(best: &mut Epa, direction: Vec3, value: f64, difference: &Difference) -> bool {
    let better = value - difference.error > best.lower;
    if better {
        best.lower = value - difference.error;
        best.direction = direction;
    }
    better
}

/// Vertices to start from.
type Pool = ArrayVec<Vertex, 20>;

enum Start {
    /// Four that span a volume.
    Solid([Vertex; 4]),
    /// No volume; a unit direction across which it is thin.
    Flat(Vec3),
}

/// Four vertices with volume from `pool`, to which support points are added as far as they are needed.
fn starting_vertices(difference: &mut Difference, pool: &mut Pool, cost: &mut Cost) -> Start {
    // Thinner than the error of its own vertices is without volume.
    let thin = 4.0 * difference.error;
    let mut ask = |directions: &[Vec3], pool: &mut Pool| {
        for d in directions {
            pool.push(lowest(difference, *d));
            pool.push(lowest(difference, -d));
            cost.supports += 2;
        }
    };
    ask(&[Vec3::x(), Vec3::y(), Vec3::z()], pool);
    let a = pool[0];
    let (b, length) = farthest(pool, |v| (v.w - a.w).norm());
    if length <= thin {
        return Start::Flat(Vec3::z());
    }
    let along = (b.w - a.w) / length;
    let across = unit(along.cross(&Vec3::ith(along.iamin(), 1.0))).unwrap_or_else(Vec3::x);
    let from_line = |v: &Vertex| along.cross(&(v.w - a.w)).norm();
    if farthest(pool, from_line).1 <= 0.01 * length {
        ask(&[across, along.cross(&across)], pool);
    }
    let (c, width) = farthest(pool, from_line);
    if width <= thin {
        return Start::Flat(across);
    }
    let Some(normal) = unit((b.w - a.w).cross(&(c.w - a.w))) else {
        return Start::Flat(across);
    };
    let height = |v: &Vertex| normal.dot(&(v.w - a.w)).abs();
    if farthest(pool, height).1 <= 0.01 * width {
        ask(&[normal], pool);
    }
    let (d, thickness) = farthest(pool, height);
    if thickness <= thin {
        return Start::Flat(normal);
    }
    if orientation(a.w, b.w, c.w, d.w) == 0.0 { Start::Flat(normal) } else { Start::Solid([a, b, c, d]) }
}

/// The vertex of greatest `measure`, and the measure; the first among equals.
fn farthest(pool: &[Vertex], measure: impl Fn(&Vertex) -> f64) -> (Vertex, f64) {
    let mut best = (pool[0], measure(&pool[0]));
    for v in &pool[1..] {
        let m = measure(v);
        if m > best.1 {
            best = (*v, m);
        }
    }
    best
}
