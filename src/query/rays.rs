//! What do rays meet? `CastRays`.

use super::answer::{Indeterminacy, Refused};
use super::cast_answer::{CastHit, CastItem, CastVerdict, why};
use super::cast_request::CastRays;
use super::item_batch::ItemBatch;
use super::met::MetBodies;
use super::opponents::Opponents;
use crate::geometry::{Aabb, BoxCast, Ray, Vec3};
use crate::narrow_phase::{RayGoal, RayImpact, cast_ray};
use crate::scene::{Body, BodyId, Snapshot};

/// A checked request.
pub struct Rays<'a> {
    opponents: Opponents<'a>,
    request: &'a CastRays,
}

impl<'a> Rays<'a> {
    /// # Errors
    /// A context that cannot be; numbers that are no whole number of rays.
    pub fn new(snapshot: &'a Snapshot, request: &'a CastRays) -> Result<Self, Refused> {
        let opponents = Opponents::without_solver(snapshot, &request.context)?;
        let refused = |field: &str, problem: String| Err(Refused::Invalid { field: field.to_owned(), problem });
        let (origins, directions, lengths) = (request.origins.len(), request.directions.len(), request.lengths.len());
        if !origins.is_multiple_of(3) {
            return refused("origins", format!("{origins} numbers are no whole number of points of 3 each"));
        }
        if directions != origins {
            return refused("directions", format!("has {directions} numbers, for the {} rays of origins", origins / 3));
        }
        if lengths != 1 && lengths != origins / 3 {
            let problem = format!("has {lengths} numbers; one for all, or one for each of the {} rays", origins / 3);
            return refused("lengths", problem);
        }
        Ok(Self { opponents, request })
    }

    fn ray(&self, item: usize) -> Result<Ray, String> {
        let vector = |numbers: &[f64]| Vec3::new(numbers[3 * item], numbers[3 * item + 1], numbers[3 * item + 2]);
        let lengths = &self.request.lengths;
        let length = if lengths.len() == 1 { lengths[0] } else { lengths[item] };
        Ray::new(vector(&self.request.origins), vector(&self.request.directions), length)
            .map_err(|problem| format!("rays[{item}]: {problem}"))
    }
}

impl ItemBatch for Rays<'_> {
    type Item = CastItem;

    fn snapshot(&self) -> &Snapshot {
        self.opponents.snapshot
    }

    fn len(&self) -> usize {
        self.request.origins.len() / 3
    }

    fn not_run(&self) -> CastItem {
        CastItem::without_work(CastVerdict::NotRun)
    }

    fn answer(&self, item: usize, stop: &dyn Fn() -> bool) -> CastItem {
        let ray = match self.ray(item) {
            Ok(ray) => ray,
            Err(problem) => return CastItem::invalid(problem),
        };
        let Opponents { snapshot, context, .. } = &self.opponents;
        let mut met = MetBodies::new(self.request.mode, ray.length(), context.max_pairs);
        let mut problem = None;
        let mut look_at = |met: &mut MetBodies, id: BodyId| {
            let body: &Body = snapshot.body(id).expect("the broad phase holds bodies of the snapshot");
            let Some(margin) = self.opponents.margin(None, body) else { return };
            // How far it has to look is not told, so that the answer does not depend on what was seen before.
            match cast_ray(&ray, &body.shape, &body.placement, &RayGoal { margin, until: f64::INFINITY, stop }) {
                Ok(found) => {
                    met.cost += found.cost;
                    met.take(found.outcome, hit(&found, id), reason(&found));
                }
                Err(error) => problem = problem.take().or(Some(format!("context.margin: {error}"))),
            }
        };
        let grown = self.opponents.largest_margin(None);
        let origin = Aabb { min: ray.origin(), max: ray.origin() };
        let rounding = 8.0 * f64::EPSILON * (ray.origin().amax() + grown);
        let start = if grown > 0.0 { origin.grown(grown + rounding) } else { origin };
        let cast = BoxCast { start, motion: ray.direction() * ray.length() };
        // Parts of the way, rounded up.
        let share = |reach: f64| {
            if ray.length() == 0.0 { reach.signum() } else { reach / ray.length() * (1.0 + 4.0 * f64::EPSILON) }
        };
        let stats = snapshot.broad_phase().cast(&cast, 1.0, |id, _| {
            if stop() {
                return -1.0;
            }
            look_at(&mut met, BodyId(id));
            share(met.reach())
        });
        met.cost.nodes += stats.nodes;
        for id in snapshot.unbounded() {
            if met.reach() >= 0.0 {
                look_at(&mut met, *id);
            }
        }
        problem.map_or_else(|| met.finish(), CastItem::invalid)
    }
}

fn hit(found: &RayImpact, body: BodyId) -> CastHit {
    CastHit {
        body,
        subshape: found.subshape,
        own_subshape: 0,
        lower: found.bracket.lower,
        upper: found.bracket.upper,
        at_start: found.starts_inside,
        point: found.point,
        normal: found.normal,
    }
}

fn reason(found: &RayImpact) -> Indeterminacy {
    why(found.termination)
}
