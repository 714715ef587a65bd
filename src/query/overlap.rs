//! Which bodies have a point in a region? `Overlap`.

use super::answer::{Refused, Verdict};
use super::cast_answer::{OverlapItem, Overlapping};
use super::cast_request::{Overlap, Region};
use super::item_batch::ItemBatch;
use super::opponents::Opponents;
use crate::geometry::{Aabb, Pose, Quaternion, Shape, Vec3};
use crate::narrow_phase::{Goal, NoSeparation, separation};
use crate::scene::{Body, BodyId, Snapshot};
use std::ops::ControlFlow;

/// A checked request.
pub struct Overlaps<'a> {
    opponents: Opponents<'a>,
    request: &'a Overlap,
}

impl<'a> Overlaps<'a> {
    /// # Errors
    /// A context that cannot be.
    pub fn new(snapshot: &'a Snapshot, request: &'a Overlap) -> Result<Self, Refused> {
        Ok(Self { opponents: Opponents::new(snapshot, &request.context)?, request })
    }

    fn overlapping(&self, item: usize, stop: &dyn Fn() -> bool) -> Result<OverlapItem, String> {
        let Opponents { snapshot, context, .. } = &self.opponents;
        let (shape, pose) = shape_of(&self.request.items[item]).map_err(|e| format!("items[{item}].{e}"))?;
        let unbounded = self.opponents.unbounded_problem(&shape, None);
        if let Some(problem) = unbounded.filter(|_| !self.request.bounds_only) {
            return Err(format!("items[{item}].shape: {problem}"));
        }
        let at = pose.placement();
        let mut answer = OverlapItem::without_work(Verdict::Free);
        let mut near: Vec<BodyId> = snapshot.unbounded().to_vec();
        let margin = context.margin;
        match shape.placed_bounds(&at) {
            Some(bounds) => {
                let slack = 8.0 * f64::EPSILON * (bounds.min.amax() + bounds.max.amax() + margin);
                let bounds = if margin > 0.0 { bounds.grown(margin + slack) } else { bounds };
                let stats = snapshot.broad_phase().overlap(&bounds, |id| {
                    near.push(BodyId(id));
                    ControlFlow::Continue(())
                });
                answer.cost.nodes += stats.nodes;
            }
            None => near.extend(snapshot.bodies().filter(|body| body.bounds.is_some()).map(|body| body.id)),
        }
        near.sort_unstable();
        for id in near {
            let body: &Body = snapshot.body(id).expect("the broad phase holds bodies of the snapshot");
            let Some(margin) = self.opponents.margin(None, body) else { continue };
            if stop() {
                break;
            }
            let verdict = if self.request.bounds_only {
                Verdict::NotRun
            } else {
                let goal = Goal { margin, solver: context.solver, stop, ..Goal::verdict() };
                match separation(&shape, &body.shape, &at, &body.placement, &goal) {
                    Ok(found) => {
                        answer.cost += found.cost;
                        Verdict::of(&found.bracket, margin, found.termination)
                    }
                    Err(NoSeparation::Unbounded { .. } | NoSeparation::Empty { .. }) => continue,
                    Err(NoSeparation::Unclaimed(unclaimed)) => return Err(format!("context.solver: {unclaimed}")),
                }
            };
            answer.verdict = answer.verdict.and(verdict);
            if verdict == Verdict::Free {
                continue;
            }
            if answer.bodies.len() < context.max_pairs {
                answer.bodies.push(Overlapping { body: id, verdict });
            } else {
                answer.truncated = true;
            }
        }
        Ok(answer)
    }
}

impl ItemBatch for Overlaps<'_> {
    type Item = OverlapItem;

    fn snapshot(&self) -> &Snapshot {
        self.opponents.snapshot
    }

    fn len(&self) -> usize {
        self.request.items.len()
    }

    fn not_run(&self) -> OverlapItem {
        OverlapItem::without_work(Verdict::NotRun)
    }

    fn answer(&self, item: usize, stop: &dyn Fn() -> bool) -> OverlapItem {
        let invalid =
            |problem| OverlapItem { problem: Some(problem), ..OverlapItem::without_work(Verdict::InvalidInput) };
        self.overlapping(item, stop).unwrap_or_else(invalid)
    }
}

/// A region as a placed shape. A box along the axes is the hull of its corners, so that not even its centre is rounded.
fn shape_of(region: &Region) -> Result<(Shape, Pose), String> {
    match region {
        Region::Shape { shape, pose } => Ok((shape.clone(), *pose)),
        Region::Ball { center, radius } => {
            let shape = Shape::sphere(*radius).map_err(|error| format!("ball.{error}"))?;
            let pose = Pose::new(*center, Quaternion::IDENTITY).map_err(|error| format!("ball.center: {error}"))?;
            Ok((shape, pose))
        }
        Region::Box(Aabb { min, max }) => {
            for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
                // Comparison order matters: NaN is refused, too.
                if !(min[axis] <= max[axis]) {
                    return Err(format!("box.{name}: min {} is not below max {}", min[axis], max[axis]));
                }
            }
            let corner = |i: usize| {
                let of = |axis: usize| if i >> axis & 1 == 0 { min[axis] } else { max[axis] };
                Vec3::new(of(0), of(1), of(2))
            };
            let corners: Vec<Vec3> = (0..8).map(corner).collect();
            let shape = Shape::convex(&corners).map_err(|error| format!("box.{error}"))?;
            Ok((shape, Pose::identity()))
        }
    }
}
