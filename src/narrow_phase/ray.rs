//! Where does a ray first meet a shape?
//!
//! Formulas propose and bounds prove. In the frame of a convex part a formula (or, for parts that have none here, conservative
//! advancement of a point) says where the ray enters; that the ray is outside before is proved by a plane, that it is inside after by
//! membership, each with all roundings taken off (`docs/derivations/advancement.md`). A miss is proved the same way. What is left is
//! a ray that grazes, and it is called undecided.

use super::advancement::{Asked, Pair};
use super::approach::Approach;
use super::element::Element;
use super::impact::{NoImpact, Outcome};
use super::outcome::{Bracket, Cost, Termination};
use super::ray_forms::{self, Form};
use super::ray_trees;
use super::separation::separation;
use super::support::radius;
use super::trees::Growth;
use super::{Goal, NoSeparation};
use crate::geometry::tolerance::{SUPPORT_ERROR_ULPS, UNIT_ROUNDOFF};
use crate::geometry::{Core, Part, Placement, Pose, Quaternion, Ray, RigidMotion, Shape, Vec3, length};

/// What is asked of a ray and a shape.
#[derive(Clone, Copy)]
pub struct RayGoal<'a> {
    /// The ray meets what it passes as near as this; metres, not negative.
    pub margin: f64,
    /// Nothing needs to be known of what comes later than this; metres along the ray.
    pub until: f64,
    /// Asked between rounds; true ends the work.
    pub stop: &'a dyn Fn() -> bool,
}

impl RayGoal<'_> {
    /// Everything along the ray, without a limit on time.
    #[must_use]
    pub fn whole() -> Self {
        Self { margin: 0.0, until: f64::INFINITY, stop: &|| false }
    }
}

impl std::fmt::Debug for RayGoal<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("RayGoal").field("margin", &self.margin).field("until", &self.until).finish_non_exhaustive()
    }
}

/// Where a ray meets a shape. Distances are metres along the ray.
#[derive(Clone, Debug, PartialEq)]
pub struct RayImpact {
    /// What was proved.
    pub outcome: Outcome,
    /// Of a hit: the first one is between these. Undecided: apart before `lower`, and again after `upper` as far as is known. Clear:
    /// both are the end of what was asked.
    pub bracket: Bracket,
    /// The shape is solid and holds the origin of the ray: the hit is at 0.
    pub starts_inside: bool,
    /// The best estimate of where it is hit, metres, in the frame of the ray.
    pub point: Vec3,
    /// Unit vector out of the surface that is hit, to the side that the ray comes from; of a ray that starts inside, against the ray.
    pub normal: Vec3,
    /// Triangle of a mesh or part of a compound; 0 for a single convex shape.
    pub subshape: u32,
    /// How the work stopped.
    pub termination: Termination,
    /// What it cost.
    pub cost: Cost,
}

/// Where a ray first meets a shape, placed in the ray's frame.
///
/// Solid shapes are met from outside, or at once by a ray that starts in them; meshes that are not declared solid, planes,
/// triangles and segments are met from either side. With a margin the ray is as thick as that.
///
/// # Errors
/// A margin beyond all lengths.
pub fn cast_ray(ray: &Ray, shape: &Shape, at: &Placement, goal: &RayGoal) -> Result<RayImpact, NoImpact> {
    let grown = if goal.margin > 0.0 { Some(shape.swept(goal.margin)?) } else { None };
    let shape = grown.as_ref().unwrap_or(shape);
    let until = goal.until.min(ray.length());
    let mut search = Search { first: None, lower: f64::INFINITY, open_until: 0.0, until, cost: Cost::default() };
    if let Core::Compound(compound) = shape.core() {
        for (number, part) in (0..).zip(compound.parts()) {
            let inner = part.pose.placement();
            let placed = Placement::computed(at.rotation * inner.rotation, at.point(inner.translation));
            let composing = SUPPORT_ERROR_ULPS
                * UNIT_ROUNDOFF
                * (radius(part.shape.core()) + length(inner.translation) + length(at.translation - ray.origin()));
            search.piece(ray, shape, Some((number, part)), &placed, composing, goal);
        }
    } else {
        search.piece(ray, shape, None, at, 0.0, goal);
    }
    Ok(search.finish(ray, shape, at, goal))
}

/// A ray in the frame of a piece, cut to where it can meet it: x(t) = start + t direction.
pub(super) struct Local {
    pub start: Vec3,
    /// Of unit length, but for rounding.
    pub direction: Vec3,
    /// How far it goes on from the start, metres.
    pub length: f64,
    /// Of the start, metres along the whole ray.
    pub offset: f64,
    /// How far a point of it may be from where it is in the truth, and what else is taken off; metres.
    pub error: f64,
}

impl Local {
    pub fn point(&self, t: f64) -> Vec3 {
        self.start + self.direction * t
    }
}

/// Where a ray meets a piece; metres from the start of the cut ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct Met {
    pub outcome: Outcome,
    pub lower: f64,
    pub upper: f64,
    pub starts_inside: bool,
    /// In the piece's frame, towards where the ray comes from.
    pub normal: Vec3,
    pub number: u32,
    pub termination: Termination,
}

impl Met {
    pub fn nothing() -> Self {
        Self {
            outcome: Outcome::Clear,
            lower: f64::INFINITY,
            upper: f64::INFINITY,
            starts_inside: false,
            normal: Vec3::zeros(),
            number: 0,
            termination: Termination::ClosedForm,
        }
    }
}

/// Units of roundoff by which a point of the ray in a piece's frame may be off, of how far its origin is and how far it went:
/// 37 and 5 for the turn, 3 for the direction, and the rest for sums.
const POINT_ERROR_ULPS: f64 = 64.0;

/// The first hit over the pieces of a shape.
struct Search {
    /// With the piece's place.
    first: Option<(Met, Placement)>,
    lower: f64,
    open_until: f64,
    until: f64,
    cost: Cost,
}

impl Search {
    fn piece(
        &mut self,
        ray: &Ray,
        whole: &Shape,
        part: Option<(u32, &Part)>,
        at: &Placement,
        composing: f64,
        goal: &RayGoal,
    ) {
        let shape = part.map_or(whole, |(_, part)| &part.shape);
        if shape.is_empty() {
            return;
        }
        let element = Element::new(whole, part);
        let from_piece = ray.origin() - at.translation;
        let start = at.direction_into(from_piece);
        let direction = at.direction_into(ray.direction());
        let distance = length(start);
        self.cost.pairs += 1;
        let off = |t: f64| POINT_ERROR_ULPS * UNIT_ROUNDOFF * (distance + t) + composing;
        let mut local = Local { start, direction, length: self.until, offset: 0.0, error: off(0.0) };
        let met = if let Some((normal, offset, thin)) = element.plane() {
            let rate = POINT_ERROR_ULPS * UNIT_ROUNDOFF;
            ray_forms::wall(&local, normal, offset, thin, element.swept_radius, rate)
        } else {
            // Nothing of the piece is outside of a ball around its origin.
            let ball = (radius(shape.core()) + element.swept_radius) * (1.0 + 16.0 * UNIT_ROUNDOFF);
            let middle = -start.dot(&direction);
            let nearest = length(start + direction * middle.clamp(0.0, self.until));
            let slack = 4.0 * off(middle.abs() + ball);
            if nearest > ball + slack {
                return;
            }
            let (from, to) = ((middle - ball - slack).max(0.0), (middle + ball + slack).min(self.until));
            if to < from {
                return;
            }
            local.start = local.point(from);
            (local.offset, local.length, local.error) = (from, to - from, 2.0 * off(to) + 16.0 * UNIT_ROUNDOFF * ball);
            self.bounded(&local, shape, &element, goal)
        };
        self.take(&met, &local, at);
    }

    fn bounded(&mut self, local: &Local, shape: &Shape, element: &Element, goal: &RayGoal) -> Met {
        if let Some(tree) = Growth::of_core(shape.core()) {
            return ray_trees::cast(local, shape.core(), &tree, element, goal, &mut self.cost);
        }
        match ray_forms::convex(local, element.core(), element.swept_radius) {
            Form::Known(met) => Met { number: element.number, ..met },
            Form::Unknown => advance(local, element, goal, &mut self.cost),
        }
    }

    fn take(&mut self, met: &Met, local: &Local, at: &Placement) {
        if met.outcome == Outcome::Clear {
            return;
        }
        let along = |t: f64, up: f64| {
            let sum = local.offset + t;
            (sum + up * 2.0 * UNIT_ROUNDOFF * sum).max(0.0)
        };
        // An offset of nothing is added without rounding.
        let (lower, upper) =
            if local.offset == 0.0 { (met.lower, met.upper) } else { (along(met.lower, -1.0), along(met.upper, 1.0)) };
        let met = Met { lower, upper, ..*met };
        self.lower = self.lower.min(lower);
        if met.outcome == Outcome::Undecided {
            self.open_until = self.open_until.max(upper);
        } else {
            self.until = self.until.min(upper);
        }
        let rank = |met: &Met| (met.outcome != Outcome::Hit, met.upper, met.lower, met.number);
        if self.first.as_ref().is_none_or(|(first, _)| rank(&met) < rank(first)) {
            self.first = Some((met, *at));
        }
    }

    fn finish(self, ray: &Ray, shape: &Shape, at: &Placement, goal: &RayGoal) -> RayImpact {
        let mut cost = self.cost;
        let Some((met, placed)) = self.first else {
            let until = goal.until.min(ray.length());
            return RayImpact {
                outcome: Outcome::Clear,
                bracket: Bracket { lower: until, upper: until },
                starts_inside: false,
                point: ray.point(until),
                normal: -ray.direction(),
                subshape: 0,
                termination: Termination::ClosedForm,
                cost,
            };
        };
        let mut found = RayImpact {
            outcome: met.outcome,
            bracket: Bracket { lower: self.lower, upper: met.upper },
            starts_inside: met.starts_inside,
            point: Vec3::zeros(),
            normal: placed.direction(met.normal),
            subshape: met.number,
            termination: met.termination,
            cost,
        };
        if met.outcome == Outcome::Undecided {
            found.bracket.upper = self.open_until;
        }
        if self.lower == 0.0 && !met.starts_inside {
            // The ray begins on the surface, or too near it: whether it does is asked with all digits there are.
            let origin = Pose::new(ray.origin(), Quaternion::IDENTITY).map(|pose| pose.placement());
            let asked = Goal { stop: goal.stop, ..Goal::verdict() };
            let there = origin.ok().map(|origin| separation(&Shape::point(), shape, &origin, at, &asked));
            if let Some(Ok(there)) = there {
                cost += there.cost;
                if there.bracket.upper <= 0.0 {
                    found.outcome = Outcome::Hit;
                    found.starts_inside = true;
                    found.bracket = Bracket { lower: 0.0, upper: 0.0 };
                    (found.subshape, found.termination) = (there.subshape_b, there.termination);
                }
            } else if let Some(Err(NoSeparation::Unbounded { .. } | NoSeparation::Unclaimed(_))) = there {
                unreachable!("a point is bounded, and the solver is the default one");
            }
        }
        found.cost = cost;
        if found.starts_inside {
            found.normal = -ray.direction();
        }
        found.point = ray.point(found.bracket.lower + 0.5 * found.bracket.width());
        found
    }
}

/// A convex piece without a formula: a point moves along the ray until it touches.
pub(super) fn advance(local: &Local, element: &Element, goal: &RayGoal, cost: &mut Cost) -> Met {
    let point = Shape::point();
    let pose = |at: Vec3| Pose::new(at, Quaternion::IDENTITY).ok();
    let way = local.direction * local.length;
    let motion = pose(local.start).and_then(|start| RigidMotion::by(start, way, Vec3::zeros()).ok());
    // What is cut to the reach of a shape has finite places.
    let Some(motion) = motion else { return undecided(local, Termination::RoundingFloor) };
    let still = RigidMotion::still(Pose::identity());
    let approach = Approach::computed(&motion, &still, local.error);
    let alone = element.alone();
    let ball = Element::new(&point, None);
    let asked = Asked { resolution: RAY_RESOLUTION, stop: goal.stop };
    let timing = Pair::new(&approach, &ball, &alone).first_contact(0.0, 1.0, &asked);
    *cost += timing.cost;
    if timing.free_until > 1.0 {
        return Met::nothing();
    }
    let lower = timing.free_until * local.length * (1.0 - 2.0 * UNIT_ROUNDOFF);
    let normal = timing.last.map_or_else(|| -local.direction, |seen| -seen.separation.normal);
    let is_hit = timing.touching_at <= 1.0;
    let upper = if is_hit { timing.touching_at } else { timing.open_until.min(1.0) };
    Met {
        outcome: if is_hit { Outcome::Hit } else { Outcome::Undecided },
        lower,
        upper: upper * local.length * (1.0 + 2.0 * UNIT_ROUNDOFF),
        starts_inside: timing.touching_at == 0.0 && local.offset == 0.0,
        normal,
        number: element.number,
        termination: timing.limit.unwrap_or(if is_hit { Termination::Converged } else { Termination::RoundingFloor }),
    }
}

/// Parts of the cut ray need not be told apart beyond this by advancement.
const RAY_RESOLUTION: f64 = 1e-13;

/// Nothing is known along the whole cut ray.
pub(super) fn undecided(local: &Local, termination: Termination) -> Met {
    Met {
        outcome: Outcome::Undecided,
        lower: 0.0,
        upper: local.length,
        normal: -local.direction,
        termination,
        ..Met::nothing()
    }
}
