//! What do moving shapes and bodies meet, and when? `CastShapes` and `CheckMovingPairs`.

use super::answer::{Indeterminacy, Refused};
use super::cast_answer::{CastHit, CastItem, CastVerdict, why};
use super::cast_request::{CastMode, CastShapes, CheckMovingPairs, Moved, Mover, Way};
use super::declared::{Coverage, effects_of};
use super::item_batch::ItemBatch;
use super::met::MetBodies;
use super::opponents::Opponents;
use crate::geometry::{Aabb, BoxCast, Placement, Pose, RigidMotion, Shape, Vec3};
use crate::narrow_phase::{Impact, ImpactGoal, NoImpact, impact};
use crate::scene::{Body, BodyId, BodyRef, Effect, Effects, Party, Snapshot};

/// Beyond this turn, radians, a box around the ball that a shape turns in is as good as any.
const LARGE_TURN: f64 = 1.5;

/// Boxes are grown by this, relatively to the numbers they are made of, for their rounding.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// A checked request of [`CastShapes`].
pub struct Casts<'a> {
    opponents: Opponents<'a>,
    request: &'a CastShapes,
    coverage: Coverage,
}

/// A checked request of [`CheckMovingPairs`].
pub struct MovingPairs<'a> {
    opponents: Opponents<'a>,
    request: &'a CheckMovingPairs,
    coverage: Coverage,
}

/// Something that moves, looked up in the scene.
struct Traveller<'a> {
    shape: &'a Shape,
    motion: RigidMotion,
    /// None for a shape that is not in the scene.
    body: Option<&'a Body>,
}

fn checked_resolution(resolution: f64) -> Result<(), Refused> {
    // Comparison order matters: NaN is refused, too.
    if (0.0..=1.0).contains(&resolution) {
        return Ok(());
    }
    let problem = format!("is {resolution}, not a part of the motion between 0 and 1");
    Err(Refused::Invalid { field: "resolution".to_owned(), problem })
}

impl<'a> Traveller<'a> {
    fn new(mover: &'a Mover, snapshot: &'a Snapshot, path: &str) -> Result<Self, String> {
        let (shape, body) = match &mover.moved {
            Moved::Shape(shape) => (shape, None),
            Moved::Body(id) => {
                let body = snapshot.body(*id).ok_or_else(|| format!("{path}.body: no body {id} in the scene"))?;
                (&*body.shape, Some(&**body))
            }
        };
        let own = body.map_or_else(Pose::identity, |body| body.pose);
        let start = mover.start.unwrap_or(own);
        let motion = match mover.way {
            Way::Still => RigidMotion::still(start),
            Way::To(end) => RigidMotion::between(start, end),
            Way::By { displacement, turn } => {
                RigidMotion::by(start, displacement, turn).map_err(|problem| format!("{path}.way: {problem}"))?
            }
        };
        Ok(Self { shape, motion, body })
    }
}

impl<'a> Casts<'a> {
    /// # Errors
    /// A context or a resolution that cannot be.
    pub fn new(snapshot: &'a Snapshot, request: &'a CastShapes) -> Result<Self, Refused> {
        checked_resolution(request.resolution)?;
        let opponents = Opponents::without_solver(snapshot, &request.context)?;
        let bodies = request.items.iter().filter_map(|item| item.moved.body());
        let coverage = opponents.coverage(bodies, Effects::of(Effect::Motion))?;
        Ok(Self { opponents, request, coverage })
    }

    fn cast(&self, one: &Traveller, stop: &dyn Fn() -> bool) -> Result<CastItem, String> {
        let Opponents { snapshot, context, .. } = &self.opponents;
        if one.body.is_some_and(|body| !self.opponents.may_meet(body)) {
            return Ok(MetBodies::new(self.request.mode, 1.0, 0).finish());
        }
        let mut met = MetBodies::new(self.request.mode, 1.0, context.max_pairs);
        let mut problem = None;
        let mut look_at = |met: &mut MetBodies, id: BodyId| {
            let body: &Body = snapshot.body(id).expect("the broad phase holds bodies of the snapshot");
            let Some(margin) = self.opponents.margin(one.body, body) else { return };
            let goal = ImpactGoal { margin, resolution: self.request.resolution, until: met.reach().min(1.0), stop };
            match impact(one.shape, &body.shape, &one.motion, &RigidMotion::still(body.pose), &goal) {
                Ok(found) => {
                    met.cost += found.cost;
                    met.take(found.outcome, hit(&found, id), reason(&found));
                }
                // Two bodies without bounds are not a pair.
                Err(NoImpact::Unbounded { .. }) => {}
                Err(NoImpact::Margin(error)) => problem = problem.take().or(Some(format!("context.margin: {error}"))),
            }
        };
        let margin = self.opponents.largest_margin(one.body);
        match way_of(one.shape, &one.motion, margin) {
            Some(cast) => {
                let stats = snapshot.broad_phase().cast(&cast, 1.0, |id, _| {
                    if stop() {
                        return -1.0;
                    }
                    look_at(&mut met, BodyId(id));
                    met.reach() * (1.0 + 4.0 * f64::EPSILON)
                });
                met.cost.nodes += stats.nodes;
                for id in snapshot.unbounded() {
                    if met.reach() >= 0.0 {
                        look_at(&mut met, *id);
                    }
                }
            }
            // A half-space has no box: every bounded body is looked at.
            None => {
                for body in snapshot.bodies().filter(|body| body.bounds.is_some()) {
                    if met.reach() >= 0.0 {
                        look_at(&mut met, body.id);
                    }
                }
            }
        }
        problem.map_or_else(|| Ok(met.finish()), Err)
    }
}

impl ItemBatch for Casts<'_> {
    type Item = CastItem;

    fn snapshot(&self) -> &Snapshot {
        self.opponents.snapshot
    }

    fn len(&self) -> usize {
        self.request.items.len()
    }

    fn not_run(&self) -> CastItem {
        CastItem::without_work(CastVerdict::NotRun)
    }

    fn coverage(&self) -> Coverage {
        self.coverage.clone()
    }

    fn answer(&self, item: usize, stop: &dyn Fn() -> bool) -> CastItem {
        let path = format!("items[{item}]");
        let one = match Traveller::new(&self.request.items[item], self.opponents.snapshot, &path) {
            Ok(one) => one,
            Err(problem) => return CastItem::invalid(problem),
        };
        if let Some(problem) = self.opponents.unbounded_problem(one.shape, one.body) {
            return CastItem::invalid(format!("{path}.shape: {problem}"));
        }
        self.cast(&one, stop).unwrap_or_else(CastItem::invalid)
    }
}

impl<'a> MovingPairs<'a> {
    /// # Errors
    /// A context or a resolution that cannot be.
    pub fn new(snapshot: &'a Snapshot, request: &'a CheckMovingPairs) -> Result<Self, Refused> {
        checked_resolution(request.resolution)?;
        let opponents = Opponents::without_solver(snapshot, &request.context)?;
        let pairs = request.items.iter().filter_map(|[a, b]| Some((a.moved.body()?, b.moved.body()?)));
        let coverage = coverage_of_pairs(&opponents, pairs)?;
        Ok(Self { opponents, request, coverage })
    }

    fn pair(&self, item: usize, stop: &dyn Fn() -> bool) -> Result<CastItem, String> {
        let [a, b] = &self.request.items[item];
        let snapshot = self.opponents.snapshot;
        let a = Traveller::new(a, snapshot, &format!("items[{item}].a"))?;
        let b = Traveller::new(b, snapshot, &format!("items[{item}].b"))?;
        let margin = match (a.body, b.body) {
            (None, None) => Some(self.opponents.context.margin),
            (Some(one), Some(two)) if one.id == two.id => {
                return Err(format!("items[{item}].b: body {} is on both sides", one.id));
            }
            (Some(one), Some(two)) => self.opponents.margin(Some(one), two).filter(|_| one.enabled),
            (Some(body), None) | (None, Some(body)) => self.opponents.margin(None, body),
        };
        let mut met = MetBodies::new(CastMode::First, 1.0, 1);
        let Some(margin) = margin else { return Ok(met.finish()) };
        let goal = ImpactGoal { margin, resolution: self.request.resolution, until: 1.0, stop };
        let found =
            impact(a.shape, b.shape, &a.motion, &b.motion, &goal).map_err(|error| format!("items[{item}]: {error}"))?;
        met.cost += found.cost;
        let body = b.body.or(a.body).map_or(BodyId(0), |body| body.id);
        met.take(found.outcome, hit(&found, body), reason(&found));
        Ok(met.finish())
    }
}

/// Checks what the scene declares of exactly these pairs of bodies.
fn coverage_of_pairs(
    opponents: &Opponents,
    pairs: impl Iterator<Item = (BodyId, BodyId)>,
) -> Result<Coverage, Refused> {
    let Opponents { snapshot, context, .. } = opponents;
    if !snapshot.declares_effects() {
        return Ok(Coverage::default());
    }
    let wanted = effects_of(context.wants, context.margin).and(Effects::of(Effect::Motion));
    let mut empty = Vec::new();
    for (a, b) in pairs {
        // A body that is not there makes its item invalid.
        let Some((one, two)) = snapshot.body(a).zip(snapshot.body(b)) else { continue };
        let Some(declared) = snapshot.declared(one.member(), two.member()) else { continue };
        let [a, b] = [a, b].map(|id| Party::Body(BodyRef::Id(id)));
        if declared.is_empty() {
            empty.push((a, b));
        } else if let Some(effect) = declared.lacking(wanted) {
            return Err(Refused::NotDeclared { effect, a, b });
        }
    }
    Ok(Coverage::of(empty, context.max_pairs))
}

impl ItemBatch for MovingPairs<'_> {
    type Item = CastItem;

    fn snapshot(&self) -> &Snapshot {
        self.opponents.snapshot
    }

    fn len(&self) -> usize {
        self.request.items.len()
    }

    fn not_run(&self) -> CastItem {
        CastItem::without_work(CastVerdict::NotRun)
    }

    fn coverage(&self) -> Coverage {
        self.coverage.clone()
    }

    fn answer(&self, item: usize, stop: &dyn Fn() -> bool) -> CastItem {
        self.pair(item, stop).unwrap_or_else(CastItem::invalid)
    }
}

fn hit(found: &Impact, body: BodyId) -> CastHit {
    let (point, normal) = found.place.map_or((Vec3::zeros(), Vec3::z()), |place| (place.point_on_b, -place.normal));
    CastHit {
        body,
        subshape: found.subshape_b,
        own_subshape: found.subshape_a,
        lower: found.free_until,
        upper: found.touching_at.or(found.open_until).unwrap_or(1.0),
        at_start: found.starts_touching,
        point,
        normal,
    }
}

fn reason(found: &Impact) -> Indeterminacy {
    why(found.termination)
}

/// A box that moves along and holds the shape, grown by the margin, at every time of its motion; none for a shape without bounds.
///
/// A point that turns by an angle a around the body's origin stays within r a^2 / 8 of the chord between its ends, and always
/// within r of the origin.
fn way_of(shape: &Shape, motion: &RigidMotion, margin: f64) -> Option<BoxCast> {
    let local = shape.bounds()?;
    let at = motion.start().translation();
    let start = if motion.turn_error() == 0.0 {
        shape.placed_bounds(&motion.start().placement())?
    } else {
        let reach = local.min.abs().sup(&local.max.abs()).norm() * (1.0 + ROUNDING);
        let ball = Aabb::centred(Vec3::zeros(), Vec3::repeat(reach));
        let angle = motion.turn().norm();
        let turning = if angle < LARGE_TURN {
            let at_origin = |t: f64| Placement { translation: Vec3::zeros(), ..motion.turned(t) };
            let ends = shape.placed_bounds(&at_origin(0.0))?.union(&shape.placed_bounds(&at_origin(1.0))?);
            let ends = ends.grown(reach * (angle * angle / 8.0 + motion.turn_error()) * (1.0 + ROUNDING));
            Aabb { min: ends.min.sup(&ball.min), max: ends.max.inf(&ball.max) }
        } else {
            ball
        };
        let slack = ROUNDING * (at.amax() + reach);
        Aabb { min: at + turning.min, max: at + turning.max }.grown(slack)
    };
    let rounding = ROUNDING * (start.min.amax() + start.max.amax() + margin);
    let start = if margin > 0.0 { start.grown(margin + rounding) } else { start };
    Some(BoxCast { start, motion: motion.displacement() })
}
