//! Solid meshes: what lies inside collides, though it may touch no triangle.

use super::given::Given;
use super::goal::Goal;
use super::inside::is_inside;
use super::outcome::{Bracket, Separation, Termination};
use super::pieces::{Piece, Pieces, least_of_pieces, mesh_of};
use super::support::radius;
use super::trees::{Growth, Inside, Tree, any_point, has_loose_parts};
use super::walk::walk;
use crate::geometry::tolerance::{SUPPORT_ERROR_ULPS, UNIT_ROUNDOFF};
use crate::geometry::{Aabb, Core, Mat3, OrientedBox, Placement, Shape, Siblings, TriangleMesh, Vec3, length};

/// The separation of the surfaces of two pieces, corrected where one is wholly inside the other and that is solid.
///
/// Then the depth is at least the distance of the surfaces (a translation that frees the inner one has to take it
/// through the outer's surface), and at most what slides their bounds apart along the best axis.
pub(super) fn with_containment(surfaces: Separation, a: &Piece, b: &Piece, goal: &Goal) -> Separation {
    // Surfaces that are not proved apart: the triangles have said all there is to say.
    if surfaces.bracket.lower <= 0.0 || !(may_contain(a) || may_contain(b)) {
        return surfaces;
    }
    let lower = least_of_pieces(a, b).min(-surfaces.bracket.lower);
    if (goal.stop)() {
        // No time to find out.
        let bracket = Bracket { lower, upper: surfaces.bracket.upper };
        return Separation { bracket, termination: Termination::TimeLimit, ..surfaces };
    }
    let gap = surfaces.bracket.lower;
    match (contains(a, b, gap, goal), contains(b, a, gap, goal)) {
        (Some(false), Some(false)) => return surfaces,
        (Some(true), _) | (_, Some(true)) => {}
        (None, _) | (_, None) => {
            let bracket = Bracket { lower, upper: surfaces.bracket.upper };
            return Separation { bracket, termination: Termination::RoundingFloor, ..surfaces };
        }
    }
    let bracket = Bracket { lower, upper: -surfaces.bracket.lower };
    let signed_distance = (-surfaces.signed_distance).clamp(bracket.lower, bracket.upper);
    let (normal, termination) = (-surfaces.normal, Termination::Decided);
    // The points are on the surfaces, but the way out may be another.
    Separation { bracket, signed_distance, normal, termination, normal_error: std::f64::consts::PI, ..surfaces }
}

fn may_contain(piece: &Piece) -> bool {
    mesh_of(piece).is_some_and(TriangleMesh::is_solid)
}

/// Whether `outer` is a solid mesh with a part of `inner` in it; none where that is too close to tell or time runs out. Their surfaces are
/// `gap` apart, so one point tells for all of a connected part, and for all that is in a box smaller than the gap.
fn contains(outer: &Piece, inner: &Piece, gap: f64, goal: &Goal) -> Option<bool> {
    let Some(mesh) = mesh_of(outer).filter(|mesh| mesh.is_solid()) else { return Some(false) };
    let inner_in_outer = Placement::relative(&outer.at, &inner.at);
    let extent = radius(outer.shape.core()) + radius(inner.shape.core()) + length(inner_in_outer.translation);
    let error = SUPPORT_ERROR_ULPS * UNIT_ROUNDOFF * extent + outer.placement_error + inner.placement_error;
    let is_in = |point: Vec3| {
        let point = inner_in_outer.point(point);
        // A point as stored is on the same side as the true one, if no surface comes as near to it as their difference.
        if gap <= 2.0 * error && !is_clear(outer, point, 2.0 * error) {
            return None;
        }
        Some(mesh.bounds().contains(&Aabb { min: point, max: point }) && is_inside(mesh, point))
    };
    let core = inner.shape.core();
    if let Core::Mesh(parts) = core {
        // One part inside is enough, whatever is unknown of the others.
        let mut known = Some(false);
        for part in parts.parts() {
            match is_in(part) {
                Some(true) => return Some(true),
                Some(false) => {}
                None => known = None,
            }
        }
        return known;
    }
    if has_loose_parts(core) {
        return holds_any(inner, &mesh.bounds().grown(error), &inner_in_outer, gap, &is_in, goal);
    }
    any_point(core).map_or(Some(false), is_in)
}

/// Whether any part of a piece, whose frame is at `place`, is in; none where that is open. What is not in the box is not.
fn holds_any(
    inner: &Piece,
    around: &Aabb,
    place: &Placement,
    gap: f64,
    is_in: &impl Fn(Vec3) -> Option<bool>,
    goal: &Goal,
) -> Option<bool> {
    let alone = Siblings::alone(&OrientedBox::upright(&inner.shape.core().bounds()?));
    let tree = Growth::of(inner, &alone)?;
    let mut known = Some(false);
    let mut open = vec![tree.root()];
    while let Some(node) = open.pop() {
        let OrientedBox { center, half_extents, .. } = tree.bounds(node);
        let half = place.rotation.abs() * half_extents;
        if !Aabb::centred(place.point(center), half).grown(1e-9 * half.amax()).overlaps(around) {
            continue;
        }
        if (goal.stop)() {
            return None;
        }
        match tree.inside(node) {
            // No surface is between two points that are nearer to one another than to it.
            Inside::Children(children) if !(2.0 * length(half_extents) < 0.999 * gap) => open.extend(children),
            Inside::Children(_) | Inside::Leaf(_) => match is_in(tree.any_point_in(node)) {
                Some(true) => return Some(true),
                Some(false) => {}
                None => known = None,
            },
        }
    }
    known
}

/// Whether a point in the frame of a mesh is farther than that from its triangles.
fn is_clear(mesh: &Piece, point: Vec3, distance: f64) -> bool {
    // The point was computed, so no precision knows more of it.
    let shape = Shape::point();
    let frame = Placement::computed(Mat3::identity(), Vec3::zeros());
    let given = Given::alone(&shape, &frame);
    let surface = Piece { at: frame, swept_radius: 0.0, placement_error: 0.0, given, ..*mesh };
    let there = Pieces::alone(&shape, Placement { translation: point, ..frame }, &frame);
    let goal = Goal { margin: distance, ..Goal::verdict() };
    walk(&surface, &there, &goal).is_some_and(|found| found.bracket.lower > distance)
}
