//! Solid meshes: what lies inside collides, though it may touch no triangle.

use super::goal::Goal;
use super::outcome::{Bracket, Separation, Termination};
use super::pieces::{Piece, least_of_pieces, mesh_of};
use super::support::{is_convex, support};
use crate::geometry::{Aabb, Core, Placement, TriangleMesh, Vec3, length};

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
    if !(contains(a, b) || contains(b, a)) {
        return surfaces;
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

/// Whether `outer` is a solid mesh with a part of `inner` in it. Their surfaces are apart, so one point tells for all of a
/// connected part.
fn contains(outer: &Piece, inner: &Piece) -> bool {
    let Some(mesh) = mesh_of(outer).filter(|mesh| mesh.is_solid()) else { return false };
    let inner_in_outer = Placement::relative(&outer.at, &inner.at);
    let is_in = |point: Vec3| {
        let point = inner_in_outer.point(point);
        mesh.bounds().contains(&Aabb { min: point, max: point }) && is_inside(mesh, point)
    };
    let core = inner.shape.core();
    if let Core::Mesh(parts) = core {
        return parts.parts().any(is_in);
    }
    is_convex(core) && is_in(support(core, Vec3::z()))
}

/// Whether a point, in the mesh's frame and not on its surface, is inside a solid mesh: by the sum of the solid angles
/// of its triangles (van Oosterom and Strackee 1983), which is 4 pi inside and 0 outside.
fn is_inside(mesh: &TriangleMesh, point: Vec3) -> bool {
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
