//! Which part of the plane between two touching shapes both of them cover.
//!
//! Both faces are seen along the normal of a separation, and one is clipped by the other. Every corner of what they have in common has a
//! height on either face, and what lies between the two is its signed distance.

use super::super::convex::scale_of;
use super::super::outcome::Separation;
use super::super::support::radius;
use super::super::witness::WITNESS_ERROR_ULPS;
use super::common_region::{common, cut};
use super::contact_patch::{ContactPatch, ContactPoint, MOST_POINTS, NoPatch, PatchCost, PatchGoal};
use super::face::{View, across, face};
use super::face_height::Relief;
use super::flat_region::Flat;
use super::reduction::{Place, Places, reduce};
use super::touching_piece::{TouchingPiece, is_wall};
use crate::geometry::tolerance::{SUPPORT_ERROR_ULPS, UNIT_ROUNDOFF, UNSCALED_EXTENT};
use crate::geometry::vector::opposite;
use crate::geometry::{Placement, Shape, Vec3, length};

/// Largest tilt, radians: a corner of a box that stands on its tip is still one.
const MOST_TILT: f64 = 0.5;

/// A face that leans by less than this is as deep at one end as at the other, radians: normals are seldom better than that.
const LEAST_TILT: f64 = 1e-9;

/// How near, as a part of the shapes' size, a witness has to be known to be to them to count as a point of both. In some overlaps
/// the depth is known, and the place where it is not.
const SURE: f64 = 1e-4;

/// Of corners that are as deep as one another the polygon begins with the one least along this direction, which is along no
/// symmetry of usual shapes: so it is the same whichever side is A.
const FIRST: Vec3 = Vec3::new(0.799, 0.531, 0.283);

/// Where `a` and `b` touch or are nearest, given what was found out about them.
///
/// `found` has to be what [`separation`](crate::narrow_phase::separation) says of the same shapes in the same places. Its normal and witness are
/// taken as they are, so it should have been asked for a distance or, in an overlap, a penetration
/// ([`Depth`](crate::narrow_phase::Depth)). The shapes may be made of several pieces; the patch is that of the two pieces that `found` names.
///
/// # Errors
/// [`NoPatch`] when neither shape has bounds, or `found` does not tell which piece it is about, as of a mesh within a compound.
pub fn contact_patch(
    a: &Shape,
    b: &Shape,
    at_a: &Placement,
    at_b: &Placement,
    found: &Separation,
    goal: &PatchGoal,
) -> Result<ContactPatch, NoPatch> {
    let witness = found.point_on_a;
    let piece_a = TouchingPiece::of(a, found.subshape_a, at_a, witness)?;
    let piece_b = TouchingPiece::of(b, found.subshape_b, at_b, witness)?;
    if is_wall(&piece_a.core) && is_wall(&piece_b.core) {
        return Err(NoPatch::Unbounded { a: a.kind(), b: b.kind() });
    }
    let mut patch = ContactPatch::empty(found.normal);
    if found.bracket.lower > goal.cut_off {
        return Ok(patch);
    }
    let between = Between::of(&piece_a, &piece_b, found, goal, &mut patch.cost);
    let mut places = between.common(&mut patch.cost);
    between.straighten(&mut places);
    between.cut_off(&mut places, goal.cut_off, &mut patch.cost);
    between.begin_with_the_deepest(&mut places);
    // What is no more than a point is the witness, if it is known where that is.
    if places.len() == 1 && between.is_sure {
        places.clear();
    }
    let (corners, is_deeper) = (places.len(), between.witness_is_deeper(&places));
    let room = goal.most.clamp(1, MOST_POINTS) - usize::from(is_deeper);
    reduce(&mut places, room, |place| between.order(place));
    patch.truncated = !between.complete || places.len() < corners;
    patch.points = places.iter().map(|place| between.point(place)).collect();
    if places.is_empty() || is_deeper {
        let Separation { point_on_a, point_on_b, signed_distance, .. } = *found;
        patch.points.push(ContactPoint { point_on_a, point_on_b, signed_distance });
    }
    // A witness that is alone is a polygon of its own.
    patch.corners = places.len().max(1);
    Ok(patch)
}

/// What of one shape faces the other.
enum Facing {
    Face(Relief),
    /// All of a plane, at that height over the witness, towards the other shape; metres (scaled).
    Wall(f64),
}

impl Facing {
    fn height(&self, at: Flat, slack: f64) -> f64 {
        match self {
            Self::Face(face) => face.height(at, slack),
            Self::Wall(height) => *height,
        }
    }
}

/// Both faces, seen along the normal. Lengths are metres from the witness on A, times a power of two.
struct Between {
    witness: Vec3,
    /// The axes of the plane across the normal, and the normal.
    axes: [Vec3; 3],
    scale: f64,
    a: Facing,
    b: Facing,
    /// Of the tilt.
    tangent: f64,
    /// Rounding of places on one face against the other.
    slack: f64,
    /// Rounding of places on the finer of the two faces.
    fine_slack: f64,
    /// Of the witness, and how far that may be off.
    signed_distance: f64,
    width: f64,
    /// Whether the witness is on both shapes as well as such things are known.
    is_sure: bool,
    complete: bool,
}

impl Between {
    fn of(a: &TouchingPiece, b: &TouchingPiece, found: &Separation, goal: &PatchGoal, cost: &mut PatchCost) -> Self {
        let normal = found.normal;
        let (a_is_placed, b_is_placed) = (a.is_placed, b.is_placed);
        let [x, y] = across(normal);
        let walls = [a, b].map(|piece| is_wall(&piece.core));
        let extents = [a, b].map(|piece| {
            if is_wall(&piece.core) { 0.0 } else { radius(&piece.core) + length(piece.position) + piece.swept_radius }
        });
        let extent = extents[0] + extents[1];
        let is_usual = (UNSCALED_EXTENT.0..=UNSCALED_EXTENT.1).contains(&extent);
        let scale = if is_usual { 1.0 } else { scale_of(extent) };
        let tangent = libm::tan(goal.tilt.clamp(0.0, MOST_TILT)).max(WITNESS_ERROR_ULPS * f64::EPSILON);
        let slacks =
            extents.map(|extent| UNIT_ROUNDOFF * SUPPORT_ERROR_ULPS * extent * scale + 64.0 * f64::MIN_POSITIVE);
        let mut facing = |piece: &TouchingPiece, up: Vec3, slack: f64| {
            let view = View::new(&piece.rotation, piece.position, [x, y, up], piece.swept_radius, scale);
            Relief::of(face(&piece.core, &view.within(tangent, slack), cost), slack)
        };
        let signed_distance = found.signed_distance * scale;
        let faces = [
            (!walls[0]).then(|| facing(a, normal, slacks[0])),
            (!walls[1]).then(|| facing(b, opposite(normal), slacks[1])),
        ];
        let complete = faces.iter().flatten().all(|relief| relief.face.complete);
        // A wall is as far from the highest point of the other as the witness tells.
        let tops = faces.each_ref().map(|relief| relief.as_ref().map_or(0.0, |relief| relief.face.top.height));
        let wall = Facing::Wall(-(tops[0] + tops[1] + signed_distance));
        let fine_slack = match faces {
            [Some(_), Some(_)] => slacks[0].min(slacks[1]),
            [None, _] | [_, None] => slacks[0].max(slacks[1]),
        };
        let (a, b) = match faces {
            [Some(a), Some(b)] => (Facing::Face(a), Facing::Face(b)),
            [Some(a), None] => (Facing::Face(a), wall),
            [None, Some(b)] => (wall, Facing::Face(b)),
            [None, None] => (Facing::Wall(0.0), wall),
        };
        let (slack, width) = (slacks[0] + slacks[1], found.bracket.width() * scale);
        let (witness, axes) = (found.point_on_a, [x, y, normal]);
        let is_sure = found.point_error <= SURE * extent || !a_is_placed || !b_is_placed;
        Self { witness, axes, scale, a, b, tangent, slack, fine_slack, signed_distance, width, is_sure, complete }
    }

    fn place(&self, at: Flat) -> Place {
        let of_a = self.a.height(at, self.fine_slack);
        Place { at, height: of_a, gap: -(of_a + self.b.height(at, self.fine_slack)) }
    }

    /// Corners of what both faces cover.
    fn common(&self, cost: &mut PatchCost) -> Places {
        match (&self.a, &self.b) {
            (Facing::Face(a), Facing::Face(b)) => {
                let both = common(&a.face.outline, &b.face.outline, self.tangent, self.slack, &mut cost.cuts);
                both.into_iter().map(|at| self.place(at)).collect()
            }
            (Facing::Face(relief), Facing::Wall(_)) | (Facing::Wall(_), Facing::Face(relief)) => {
                relief.face.outline.iter().map(|corner| self.place(corner.at)).collect()
            }
            (Facing::Wall(_), Facing::Wall(_)) => Places::new(),
        }
    }

    /// Of corners in one place the deepest stays.
    fn merge(&self, places: &mut Places) {
        let mut i = 0;
        while places.len() > 1 && i < places.len() {
            let next = (i + 1) % places.len();
            if places[i].at.distance(places[next].at) > self.fine_slack {
                i += 1;
            } else if places[next].gap < places[i].gap {
                places.remove(i);
            } else {
                places.remove(next);
            }
        }
    }

    /// Corners where the outline turns by less than the tilt are none, as where two nearly parallel edges cross, unless they are deeper
    /// than both neighbours.
    fn straighten(&self, places: &mut Places) {
        self.merge(places);
        let mut i = 0;
        while places.len() > 2 && i < places.len() {
            let count = places.len();
            let [before, place, next] = [places[(i + count - 1) % count], places[i], places[(i + 1) % count]];
            let [one, other] =
                [(before.at, place.at), (place.at, next.at)].map(|(p, q)| Flat { x: q.x - p.x, y: q.y - p.y });
            let room = self.fine_slack * (one.length() + other.length());
            let ahead = one.dot(other);
            let is_straight = ahead > 0.0 && one.cross(other) <= self.tangent * ahead + room;
            if is_straight && place.gap >= before.gap.min(next.gap) - self.slack {
                places.remove(i);
            } else {
                i += 1;
            }
        }
    }

    /// Leaves what is within the cut-off, metres. A touching pair is as near as its deepest corners, whatever rounding makes of zero.
    fn cut_off(&self, places: &mut Places, cut_off: f64, cost: &mut PatchCost) {
        let level = (cut_off * self.scale).max(self.signed_distance + self.width + self.as_deep(places));
        if places.iter().all(|place| place.gap <= level) {
            return;
        }
        cost.cuts += places.len() as u64;
        *places = cut(places, |p| level - p.gap, 0.0, |p, q, part| self.place(p.at.toward(q.at, part)));
        self.merge(places);
    }

    /// How much deeper one corner has to be than another to count as deeper: more than what rounding and the least of tilts make.
    fn as_deep(&self, places: &Places) -> f64 {
        let size = places.iter().fold(0.0, |size: f64, place| size.max(place.at.distance(places[0].at)));
        self.slack + LEAST_TILT * size
    }

    /// Which of two equal corners is the first.
    fn order(&self, place: &Place) -> f64 {
        FIRST.dot(&(self.axes[0] * place.at.x + self.axes[1] * place.at.y))
    }

    fn begin_with_the_deepest(&self, places: &mut Places) {
        let least = places.iter().fold(f64::INFINITY, |least, place| least.min(place.gap)) + self.as_deep(places);
        let deepest = (0..places.len()).filter(|i| places[*i].gap <= least);
        if let Some(first) = deepest.min_by(|i, j| self.order(&places[*i]).total_cmp(&self.order(&places[*j]))) {
            places.rotate_left(first);
        }
    }

    /// Whether the deepest point is none of the corners.
    fn witness_is_deeper(&self, places: &Places) -> bool {
        let least = places.iter().fold(f64::INFINITY, |least, place| least.min(place.gap));
        self.is_sure && places.len() > 1 && self.signed_distance < least - self.width - self.as_deep(places)
    }

    fn point(&self, place: &Place) -> ContactPoint {
        let [x, y, normal] = self.axes;
        let signed_distance = place.gap / self.scale;
        let from_witness = (x * place.at.x + y * place.at.y + normal * place.height) / self.scale;
        let point_on_a = self.witness + from_witness;
        ContactPoint { point_on_a, point_on_b: point_on_a + normal * signed_distance, signed_distance }
    }
}
