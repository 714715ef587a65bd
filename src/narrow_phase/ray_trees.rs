//! Which part of a mesh, a point cloud, terrain or a map of cells does a ray meet first? Down its tree, nearest boxes first.
//!
//! A crossing is proved by the signs of volumes, each by more than what the places of the points may be off (`docs/derivations/mesh.md`,
//! "Crossing"), and where it is by the plane of the triangle. A ray through an edge or a corner crosses no triangle for sure, but it does cross
//! the patch of those around: if the border of a set of triangles goes an odd number of times around the ray, the ray meets
//! the set.

use super::Goal;
use super::element::Element;
use super::impact::Outcome;
use super::outcome::{Cost, Termination};
use super::ray::{Local, Met, RayGoal, advance, undecided};
use super::ray_forms::{self, Form};
use super::separation::separation;
use super::trees::{Growth, Inside, Tree};
use super::walk::NODES_PER_STOP;
use crate::geometry::tolerance::UNIT_ROUNDOFF;
use crate::geometry::{Aabb, Core, OrientedBox, Placement, Pose, Quaternion, Shape, TriangleMesh, Vec3, length};

/// What is told of a ray and a triangle.
pub(super) enum Crossing {
    /// It is met, and goes through.
    Crosses(Met),
    /// It is not met.
    Misses,
    /// Neither was proved.
    Unknown,
}

/// A box's faces may be off by so many units of roundoff of the numbers that go into a test: 48 for its axes, and some 30 sums.
const BOX_TEST_ULPS: f64 = 512.0;

/// Patches are looked for around a ray among so many triangles at most: what meets in one corner is rarely more.
const LARGEST_PATCH: usize = 256;

/// The first part that the ray meets; where a mesh is solid, its inside counts.
pub(super) fn cast(ray: &Local, core: &Core, tree: &Growth, element: &Element, goal: &RayGoal, cost: &mut Cost) -> Met {
    if let Core::Mesh(mesh) = core
        && mesh.is_solid()
        && ray.offset == 0.0
        && let Some(met) = from_inside(ray, mesh, element, goal, cost)
    {
        return met;
    }
    let mut first = Met::nothing();
    let mut lower = f64::INFINITY;
    let mut until = ray.length;
    let mut open_until = 0.0_f64;
    let mut open: Vec<(Met, [Vec3; 3])> = Vec::new();
    let grown = ray.error + element.swept_radius;
    let mut waiting = vec![(0.0, tree.root())];
    while let Some((from, node)) = waiting.pop() {
        if from > until {
            continue;
        }
        match tree.inside(node) {
            Inside::Leaf(leaf) => {
                let Some(inner) = tree.core(leaf) else { continue };
                let part = element.leaf(inner, tree.number(leaf).unwrap_or_default());
                let met = match ray_forms::convex(ray, part.core(), element.swept_radius) {
                    Form::Known(met) => met,
                    Form::Unknown => advance(ray, &part, goal, cost),
                };
                let met = Met { number: part.number, ..met };
                match met.outcome {
                    Outcome::Clear => continue,
                    Outcome::Undecided => {
                        open_until = open_until.max(met.upper);
                        open.extend(surface_of(part.core()).map(|corners| (met, corners)));
                    }
                    Outcome::Hit => until = until.min(met.upper),
                }
                lower = lower.min(met.lower);
                if rank(&met) < rank(&first) {
                    first = met;
                }
            }
            Inside::Children(children) => {
                cost.nodes += 1;
                if cost.nodes.is_multiple_of(NODES_PER_STOP) && (goal.stop)() {
                    return undecided(ray, Termination::TimeLimit);
                }
                let enters = children.map(|child| enters(ray, &tree.bounds(child), grown));
                let nearer = usize::from(enters[1] < enters[0]);
                for child in [1 - nearer, nearer] {
                    if enters[child] <= until {
                        waiting.push((enters[child], children[child]));
                    }
                }
            }
        }
    }
    if lower > ray.length {
        return Met::nothing();
    }
    let first = Met { lower, ..first };
    open.sort_by(|(one, _), (two, _)| one.lower.total_cmp(&two.lower).then(one.number.cmp(&two.number)));
    // A hit farther away does not matter where a patch before it is proved to be met.
    let patched = if element.swept_radius == 0.0 { patches(ray, &open, &first) } else { None };
    match patched {
        Some(patch) => Met { lower, ..patch },
        None if first.outcome == Outcome::Undecided => Met { upper: open_until, ..first },
        None => first,
    }
}

/// The first patch of triangles, each of them undecided, that is met all the same. What is open in stretches that do not overlap is not one
/// patch. `open` is sorted by where the stretches begin.
fn patches(ray: &Local, open: &[(Met, [Vec3; 3])], first: &Met) -> Option<Met> {
    let mut rest = open;
    while let Some(((sooner, _), _)) = rest.split_first() {
        if first.outcome == Outcome::Hit && first.upper <= sooner.lower {
            return None; // That is sooner than any patch.
        }
        let mut upper = sooner.upper;
        let mut count = 0;
        while let Some((next, _)) = rest.get(count).filter(|(next, _)| next.lower <= upper) {
            upper = upper.max(next.upper);
            count += 1;
        }
        let (cluster, later) = rest.split_at(count);
        if is_met(ray, cluster) {
            let upper = if first.outcome == Outcome::Hit { upper.min(first.upper) } else { upper };
            let normal = facing(cluster, ray.direction);
            return Some(Met { outcome: Outcome::Hit, upper, normal, termination: Termination::Converged, ..*sooner });
        }
        rest = later;
    }
    None
}

/// The triangle that a leaf is, or that covers a column from above: what patches are made of.
fn surface_of(core: &Core) -> Option<[Vec3; 3]> {
    if let Core::Triangle(corners) = core {
        Some(*corners)
    } else if let Core::Column(column) = core {
        Some(column.top)
    } else {
        None
    }
}

/// Hits before what is undecided, then what is sooner, then lesser numbers.
fn rank(met: &Met) -> (u8, f64, f64, u32) {
    let certainty = match met.outcome {
        Outcome::Hit => 0,
        Outcome::Undecided => 1,
        Outcome::Clear => 2,
    };
    (certainty, met.upper, met.lower, met.number)
}

/// A ray that starts in a solid, or too near its surface to tell from where.
fn from_inside(ray: &Local, mesh: &TriangleMesh, element: &Element, goal: &RayGoal, cost: &mut Cost) -> Option<Met> {
    let slack = element.swept_radius + ray.error;
    let there = Aabb { min: ray.start, max: ray.start };
    if !mesh.bounds().grown(slack).contains(&there) {
        return None;
    }
    let shape = element.shape();
    let point = Shape::sphere(ray.error).ok()?;
    // The truth is a point within the error of this one: a ball of that size which is inside holds it, and one that is apart parts it.
    let at = Pose::new(ray.start, Quaternion::IDENTITY).ok()?.placement();
    let asked = Goal { stop: goal.stop, ..Goal::verdict() };
    let swept = shape.swept(element.swept_radius - shape.swept_radius()).ok()?;
    let ball = separation(&point, &swept, &at, &Placement::identity(), &asked).ok()?;
    *cost += ball.cost;
    if ball.bracket.lower > 0.0 {
        return None;
    }
    let center = separation(&Shape::point(), &swept, &at, &Placement::identity(), &asked).ok()?;
    *cost += center.cost;
    // Deeper than the error: the whole ball is inside.
    if center.bracket.upper <= -ray.error {
        return Some(Met {
            outcome: Outcome::Hit,
            lower: 0.0,
            upper: 0.0,
            starts_inside: true,
            normal: -ray.direction,
            number: element.number.max(center.subshape_b),
            termination: center.termination,
        });
    }
    None
}

/// A lower bound of where the ray enters what is in a box that is grown by a length; infinite where it passes by.
fn enters(ray: &Local, bounds: &OrientedBox, grown: f64) -> f64 {
    let from_center = ray.start - bounds.center;
    let size = length(from_center) + ray.length + length(bounds.half_extents) + grown;
    let reach = bounds.half_extents.add_scalar(grown + BOX_TEST_ULPS * UNIT_ROUNDOFF * size);
    let x = bounds.axes.tr_mul(&from_center);
    let d = bounds.axes.tr_mul(&ray.direction);
    let (mut enters, mut leaves) = (0.0_f64, ray.length);
    for i in 0..3 {
        // As good as along the face: the slack holds what the direction is off, over the whole cut ray.
        if d[i].abs() * ray.length <= reach[i] * f64::EPSILON {
            if x[i].abs() > reach[i] {
                return f64::INFINITY;
            }
            continue;
        }
        let (one, two) = ((-reach[i] - x[i]) / d[i], (reach[i] - x[i]) / d[i]);
        enters = enters.max(one.min(two));
        leaves = leaves.min(one.max(two));
    }
    if enters > leaves { f64::INFINITY } else { enters }
}

/// The volume spanned by three vectors.
fn volume(a: Vec3, b: Vec3, c: Vec3) -> f64 {
    a.dot(&b.cross(&c))
}

/// The ray and a triangle in its frame.
pub(super) fn triangle(ray: &Local, corners: &[Vec3; 3]) -> Crossing {
    let [a, b, c] = corners.map(|corner| corner - ray.start);
    let d = ray.direction;
    // Volumes with the direction, of unit length: an edge and the ray lie to each other as their sign says. Each is off by less than
    // 6 E L for corners off by E, and by some 48 u L^2 for its own rounding; L is the distance of what goes into it.
    let reach = length(a).max(length(b)).max(length(c));
    let error = ray.error + 8.0 * UNIT_ROUNDOFF * (reach + length(ray.start));
    let rim = 8.0 * (error + 16.0 * UNIT_ROUNDOFF * reach) * reach;
    let edges = [volume(d, a, b), volume(d, b, c), volume(d, c, a)];
    let above = edges.iter().filter(|v| **v > rim).count();
    let below = edges.iter().filter(|v| **v < -rim).count();
    if above > 0 && below > 0 {
        return Crossing::Misses; // The line passes by.
    }
    let across = (b - a).cross(&(c - a));
    let area = length(across);
    if !(area > 0.0) {
        return Crossing::Unknown;
    }
    let normal = across / area;
    let (height, rate) = (normal.dot(&a), normal.dot(&d));
    // The normal of a thin triangle is turned by what its corners are off, over its least height.
    let longest = length(b - a).max(length(c - a)).max(length(c - b));
    let tilt = 8.0 * (error + UNIT_ROUNDOFF * reach) * longest / area;
    let flat = error + (tilt + 16.0 * UNIT_ROUNDOFF) * reach;
    if above < 3 && below < 3 {
        // Both ends on one side of the plane, by more than it is off.
        let end = height - rate * ray.length;
        let parted = |by: f64| by > flat + (tilt + 16.0 * UNIT_ROUNDOFF) * ray.length;
        if (parted(height) && parted(end)) || (parted(-height) && parted(-end)) {
            return Crossing::Misses;
        }
        return Crossing::Unknown;
    }
    // The line goes through the inner of the triangle: where is told by the heights over its plane.
    let proposal = height / rate;
    let off = 2.0 * (flat + (tilt + 16.0 * UNIT_ROUNDOFF) * proposal.abs()) / rate.abs();
    let off = off + 8.0 * UNIT_ROUNDOFF * proposal.abs();
    let (lower, upper) = (proposal - off, proposal + off);
    if tilt <= 0.25 * rate.abs() && (lower > ray.length || upper < 0.0) {
        return Crossing::Misses;
    }
    // Comparison order matters: a ray along the plane has no such place.
    if tilt > 0.25 * rate.abs() || !(lower >= 0.0 && upper <= ray.length) {
        return Crossing::Unknown;
    }
    Crossing::Crosses(Met { outcome: Outcome::Hit, lower, upper, normal: normal * -rate.signum(), ..Met::nothing() })
}

/// Whether the ray meets a set of triangles of which none could be told alone.
///
/// Seen along the ray each triangle is one in a plane, and the ray a point. The border of the set, that is the sides that an odd number
/// of its triangles have, parts the plane; a point that a half-line from it shows to be within an odd number of loops of it is covered by
/// the set. All of the border has to be farther from the ray than places may be off.
fn is_met(ray: &Local, set: &[(Met, [Vec3; 3])]) -> bool {
    if set.len() < 2 || set.len() > LARGEST_PATCH {
        return false;
    }
    // The line would meet what is beyond its ends.
    let slack = 4.0 * ray.error;
    let is_between = |corner: &Vec3| {
        let along = (corner - ray.start).dot(&ray.direction);
        along > slack && along < ray.length - slack
    };
    if !set.iter().all(|(_, corners)| corners.iter().all(is_between)) {
        return false;
    }
    let mut border: Vec<[Vec3; 2]> = Vec::new();
    for (_, [a, b, c]) in set {
        for side in [[*a, *b], [*b, *c], [*c, *a]] {
            let same = |other: &[Vec3; 2]| *other == side || (other[0] == side[1] && other[1] == side[0]);
            match border.iter().position(same) {
                Some(place) => drop(border.swap_remove(place)),
                None => border.push(side),
            }
        }
    }
    let reference = if ray.direction.x.abs() < 0.6 { Vec3::x() } else { Vec3::y() };
    let e = ray.direction.cross(&reference).normalize();
    let f = ray.direction.cross(&e);
    // A half-line may go through a corner: then another is tried.
    let half_lines = [(1.0, 0.0), (0.6, 0.8), (-0.28, 0.96), (-0.8, -0.6), (0.352, -0.936)];
    let counts = |(cos, sin): (f64, f64)| crossings(ray, &border, e * cos + f * sin, f * cos - e * sin);
    half_lines.into_iter().find_map(counts).is_some_and(|count| count % 2 == 1)
}

/// How many sides of a border the half-line from the ray along `u` crosses, seen along the ray, where `v` is across; none where one of them is
/// too near to tell.
fn crossings(ray: &Local, border: &[[Vec3; 2]], u: Vec3, v: Vec3) -> Option<u32> {
    let mut count = 0;
    for side in border {
        let from_start = side.map(|corner| corner - ray.start);
        let [p, q] = from_start.map(|p| (p.dot(&u), p.dot(&v)));
        let reach = length(from_start[0]).max(length(from_start[1]));
        let error = 4.0 * (ray.error + 16.0 * UNIT_ROUNDOFF * reach);
        if p.1.abs() <= error || q.1.abs() <= error {
            return None;
        }
        if (p.1 > 0.0) == (q.1 > 0.0) {
            continue;
        }
        let across = (p.0 * q.1 - q.0 * p.1) * (q.1 - p.1).signum();
        let size = p.0.abs() + p.1.abs() + q.0.abs() + q.1.abs();
        if across.abs() <= 8.0 * error * size {
            return None;
        }
        count += u32::from(across > 0.0);
    }
    Some(count)
}

/// The normal of the first triangle of a patch, towards where the ray comes from.
fn facing(patch: &[(Met, [Vec3; 3])], direction: Vec3) -> Vec3 {
    let across = patch.first().map(|(_, [a, b, c])| (b - a).cross(&(c - a)));
    match across.filter(|across| length(*across) > 0.0) {
        Some(across) => across.normalize() * -across.dot(&direction).signum(),
        None => -direction,
    }
}
