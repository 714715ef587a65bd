//! Solid meshes: what lies inside collides, though it may touch no triangle.

use super::outcome::{Bracket, Separation};
use super::support::{is_convex, support};
use super::union::{Piece, deepest_possible};
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
                let freed = deepest_possible(pa, pb).unwrap_or(f64::MAX);
                deepest = Some(deepest.map_or(freed, |d: f64| d.max(freed)));
            }
        }
    }
    let Some(freed) = deepest else { return surfaces };
    let bracket = Bracket { lower: -freed.max(surfaces.bracket.lower), upper: -surfaces.bracket.lower };
    let signed_distance = (-surfaces.signed_distance).clamp(bracket.lower, bracket.upper);
    Separation { bracket, signed_distance, normal: -surfaces.normal, ..surfaces }
}

/// Whether `outer` is a solid mesh with a part of `inner` in it. Their surfaces are apart, so one point tells for all of a
/// connected part.
fn contains(outer: &Piece, inner: &Piece) -> bool {
    let Core::Mesh(mesh) = outer.shape.core() else { return false };
    if !mesh.is_solid() {
        return false;
    }
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
    let solid_angle = |i: usize| {
        let [a, b, c] = mesh.triangle(i).map(|v| v - point);
        let (la, lb, lc) = (a.norm(), b.norm(), c.norm());
        let volume = a.dot(&b.cross(&c));
        let denominator = la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
        2.0 * libm::atan2(volume, denominator)
    };
    let total: f64 = (0..mesh.triangles().len()).map(solid_angle).sum();
    total > 2.0 * std::f64::consts::PI
}
