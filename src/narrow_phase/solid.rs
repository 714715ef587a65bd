//! Solid meshes: what lies inside collides, though it may touch no triangle.

use super::outcome::{Bracket, Separation};
use super::support::{is_convex, support};
use super::union::{Piece, is_inside};
use crate::geometry::{Aabb, Core, Placement, TriangleMesh, Vec3};

/// The separation of the surfaces, corrected where one piece is wholly inside another that is solid.
///
/// Then the depth is at least the distance of the surfaces (a translation that frees the inner one has to take it
/// through the outer's surface), and at most what slides their bounds apart along the best axis.
pub(super) fn with_containment(surfaces: Separation, a: &[Piece], b: &[Piece]) -> Separation {
    // Surfaces that are not proved apart: the triangles have said all there is to say.
    if surfaces.bracket.lower <= 0.0 {
        return surfaces;
    }
    let mut deepest: Option<f64> = None;
    for pa in a {
        for pb in b {
            if contains(pa, pb) || contains(pb, pa) {
                let freed = freeing_translation(pa, pb);
                deepest = Some(deepest.map_or(freed, |d: f64| d.max(freed)));
            }
        }
    }
    let Some(freed) = deepest else { return surfaces };
    let bracket = Bracket { lower: -freed.max(surfaces.bracket.lower), upper: -surfaces.bracket.lower };
    let signed_distance = (-surfaces.signed_distance).clamp(bracket.lower, bracket.upper);
    Separation { bracket, signed_distance, normal: -surfaces.normal, ..surfaces }
}

/// Whether `outer` is a solid mesh with a point of `inner` in it. Their surfaces are apart, so one point tells for all.
fn contains(outer: &Piece, inner: &Piece) -> bool {
    let Core::Mesh(mesh) = outer.shape.core() else { return false };
    if !mesh.is_solid() {
        return false;
    }
    let Some(point) = any_point(inner.shape.core()) else { return false };
    let point = Placement::relative(&outer.at, &inner.at).point(point);
    mesh.bounds().contains(&Aabb { min: point, max: point }) && is_inside(mesh, point)
}

/// A point of a bounded piece, in its frame.
fn any_point(core: &Core) -> Option<Vec3> {
    if let Core::Mesh(mesh) = core {
        return Some(first_corner(mesh));
    }
    is_convex(core).then(|| support(core, Vec3::z()))
}

fn first_corner(mesh: &TriangleMesh) -> Vec3 {
    mesh.triangle(0)[0]
}

/// Length of an axis-parallel translation, in the frame of `a`, that surely separates two pieces, metres.
fn freeing_translation(a: &Piece, b: &Piece) -> f64 {
    let identity = Placement { rotation: crate::geometry::Mat3::identity(), translation: Vec3::zeros() };
    let b_in_a = Placement::relative(&a.at, &b.at);
    let (Some(box_a), Some(box_b)) = (a.shape.placed_bounds(&identity), b.shape.placed_bounds(&b_in_a)) else {
        return f64::INFINITY;
    };
    let (one_way, other_way) = (box_a.max - box_b.min, box_b.max - box_a.min);
    one_way.min().min(other_way.min()) + a.swept_radius + b.swept_radius
}
