//! What of a convex core faces the other: the corners that are farthest in some direction near the normal.
//!
//! A corner v is one of them when a direction turned by no more than the tilt has no corner farther out. In the plane across the normal
//! that is a vector u, no longer than the tangent of the tilt, with u . (c - v) >= h(c) - h(v) for every corner c, h being heights along
//! the normal: the least such u is looked for. It needs no faces, so flat hulls and hulls without a proved surface have theirs, and how
//! it decides does not depend on the size of the core. `docs/derivations/patch.md` shows why corners above a cone around the highest one
//! are all that has to be looked at.

use arrayvec::ArrayVec;

use super::super::support::corner;
use super::contact_patch::PatchCost;
use super::flat_region::{Corner, Corners, Flat, MOST_CORNERS, holds, hull};
use super::round_face::round_face;
use crate::geometry::{ConvexHull, Core, Mat3, Vec3};

/// From this many corners on a hull with a proved surface is searched along its edges.
const SEARCHED: usize = 24;

/// What faces the other shape. The heights of its corners are over the witness, towards the other shape, swept radius included; metres.
#[derive(Clone, Debug)]
pub(in super::super) struct Face {
    /// Of a convex polygon, counter-clockwise; two or one for an edge or a corner.
    pub outline: Corners,
    /// All of its corners, also those within the outline.
    #[cfg_attr(not(feature = "effect-patch"), expect(dead_code, reason = "only patches ask how high a face is"))]
    pub corners: Corners,
    /// The highest point.
    #[cfg_attr(not(feature = "effect-patch"), expect(dead_code, reason = "only patches ask how high a face is"))]
    pub top: Corner,
    /// Whether no corner was left out for want of room.
    pub complete: bool,
}

/// How a core is seen along the normal.
pub(in super::super) struct View {
    /// The axes of the plane, and the direction towards the other shape, in the core's frame.
    axes: [Vec3; 3],
    /// Where the core's origin is along these axes, from the witness; the swept radius is on top of its height.
    origin: Vec3,
    /// A power of two that lengths are multiplied with.
    scale: f64,
    /// Tangent of the tilt.
    pub tangent: f64,
    /// Rounding of coordinates and heights, metres (scaled).
    pub slack: f64,
}

impl View {
    /// `axes` and `position` (of the core's origin) are in the axes of both placements.
    pub fn new(rotation: &Mat3, position: Vec3, axes: [Vec3; 3], swept_radius: f64, scale: f64) -> Self {
        let along = axes.map(|axis| axis.dot(&position));
        let origin = Vec3::new(along[0], along[1], along[2] + swept_radius) * scale;
        Self { axes: axes.map(|axis| rotation.tr_mul(&axis)), origin, scale, tangent: 0.0, slack: 0.0 }
    }

    /// The same with another tilt and rounding.
    pub fn within(self, tangent: f64, slack: f64) -> Self {
        Self { tangent, slack, ..self }
    }

    /// The direction towards the other shape, in the core's frame.
    pub fn up(&self) -> Vec3 {
        self.axes[2]
    }

    /// A point of the core as seen.
    pub fn corner(&self, p: Vec3) -> Corner {
        let (axes, origin, scale) = (&self.axes, &self.origin, self.scale);
        let along = |axis: &Vec3| (axis.x * p.x + axis.y * p.y + axis.z * p.z) * scale;
        let at = Flat { x: along(&axes[0]) + origin.x, y: along(&axes[1]) + origin.y };
        Corner { at, height: along(&axes[2]) + origin.z }
    }

    /// Whether no line from the corner up to `top` is steeper than the tilt.
    fn is_near(&self, corner: &Corner, top: &Corner) -> bool {
        let drop = top.height - corner.height - self.slack;
        drop <= 0.0 || drop * drop <= self.tangent * self.tangent * corner.at.square_to(top.at)
    }
}

/// Two axes across a unit vector that make a right-handed frame with it, x, y, normal. Those of a normal along an axis are exact.
pub(in super::super) fn across(normal: Vec3) -> [Vec3; 2] {
    let least = normal.abs().imin();
    let axis = Vec3::ith(least, 1.0);
    let x = (axis - normal * normal[least]).normalize();
    [x, normal.cross(&x)]
}

/// What of a convex core faces the other shape.
pub(in super::super) fn face(core: &Core, view: &View, cost: &mut PatchCost) -> Face {
    match core {
        Core::Convex(hull) => face_of_hull(hull, view, cost),
        Core::Cylinder { .. } | Core::Cone { .. } | Core::Ellipsoid { .. } => round_face(core, view, cost),
        Core::Point
        | Core::Cuboid { .. }
        | Core::AxialSegment { .. }
        | Core::Triangle(_)
        | Core::Segment(_)
        | Core::Column(_)
        | Core::Block(_) => {
            let corners: ArrayVec<Vec3, 8> = (0..8).map_while(|number| corner(core, number)).collect();
            face_of_points(&corners, view, cost)
        }
        Core::HalfSpace { .. }
        | Core::Plane { .. }
        | Core::Mesh(_)
        | Core::Compound(_)
        | Core::HeightField(_)
        | Core::PointCloud(_)
        | Core::Voxels(_) => unreachable!("pieces are convex, and walls have no corners"),
    }
}

fn face_of_hull(hull: &ConvexHull, view: &View, cost: &mut PatchCost) -> Face {
    let points = hull.points();
    let Some(surface) = hull.surface().filter(|_| points.len() >= SEARCHED) else {
        return face_of_points(points, view, cost);
    };
    let highest = hull.farthest(view.up(), u32::MAX);
    let top = view.corner(points[highest as usize]);
    let mut reached = ArrayVec::<u32, MOST_CORNERS>::from_iter([highest]);
    let mut corners = Corners::from_iter([top]);
    let mut looked_at = 0;
    while let Some(&from) = reached.get(looked_at) {
        looked_at += 1;
        for &next in surface.neighbours(from) {
            if reached.contains(&next) {
                continue;
            }
            cost.corners += 1;
            let corner = view.corner(points[next as usize]);
            if !view.is_near(&corner, &top) {
                continue;
            }
            if reached.try_push(next).is_err() {
                return face_of_points(points, view, cost);
            }
            corners.push(corner);
        }
    }
    spanned(corners, top, true, view)
}

/// By looking at all points.
fn face_of_points(points: &[Vec3], view: &View, cost: &mut PatchCost) -> Face {
    cost.corners += points.len() as u64;
    let seen = points.iter().map(|p| view.corner(*p));
    let higher = |one: Corner, other: Corner| if other.height > one.height { other } else { one };
    let top = seen.clone().reduce(higher).unwrap_or(view.corner(Vec3::zeros()));
    let near = seen.filter(|corner| view.is_near(corner, &top));
    let mut corners = Corners::new();
    for corner in near {
        if corners.try_push(corner).is_err() {
            return widest(points, top, view);
        }
    }
    spanned(corners, top, true, view)
}

/// Of more corners than there is room for: those that are farthest in as many directions, which turn with the core.
#[cold]
fn widest(points: &[Vec3], top: Corner, view: &View) -> Face {
    let near = || points.iter().filter(|p| view.is_near(&view.corner(**p), &top));
    let [x, y] = across(view.up());
    let farthest = |k: usize| {
        // A part of a step on, so that no two corners of a regular face are as far.
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * (k as f64 + 0.127) / MOST_CORNERS as f64);
        let direction = x * cos + y * sin;
        let farther = |one, other| if direction.dot(other) > direction.dot(one) { other } else { one };
        near().reduce(farther).map_or(top, |p| view.corner(*p))
    };
    let corners: Corners = (0..MOST_CORNERS).map(farthest).collect();
    let outline = hull(&corners, view.slack);
    let complete = near().all(|p| holds(&outline, view.corner(*p).at, view.slack));
    spanned(corners, top, complete, view)
}

/// The face that is spanned by those of some corners that are farthest in some direction.
fn spanned(corners: Corners, top: Corner, complete: bool, view: &View) -> Face {
    let facing: Corners = corners.iter().filter(|corner| faces(corner, &corners, view)).copied().collect();
    let outline = hull(&facing, view.slack);
    Face { outline, corners: facing, top, complete }
}

/// Whether `v` is farthest of all in a direction that is turned by no more than the tilt.
fn faces(v: &Corner, all: &[Corner], view: &View) -> bool {
    // The least u that does what those looked at so far ask for.
    let mut u = Flat { x: 0.0, y: 0.0 };
    let asked = |c: &Corner| (Flat { x: c.at.x - v.at.x, y: c.at.y - v.at.y }, c.height - v.height - view.slack);
    for (i, c) in all.iter().enumerate() {
        let (way, rise) = asked(c);
        // Once more the rounding: of two corners in one place the second asks for nothing that noise could make much of.
        if u.dot(way) >= rise - view.slack {
            continue;
        }
        // It has to go to the line where u . way = rise: to its foot, or on it as far as the others ask.
        let square = way.dot(way);
        if square == 0.0 {
            return false; // Straight above.
        }
        let foot = Flat { x: way.x * rise / square, y: way.y * rise / square };
        let line = Flat { x: -way.y, y: way.x };
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        for (way, rise) in all[..i].iter().map(asked) {
            let (slope, rest) = (line.dot(way), rise - view.slack - foot.dot(way));
            if slope > 0.0 {
                low = low.max(rest / slope);
            } else if slope < 0.0 {
                high = high.min(rest / slope);
            } else if rest > 0.0 {
                return false;
            }
        }
        if low > high {
            return false;
        }
        let part = low.max(0.0).min(high);
        u = Flat { x: foot.x + line.x * part, y: foot.y + line.y * part };
        if u.dot(u) > view.tangent * view.tangent {
            return false;
        }
    }
    true
}
