//! Which bodies are nearest, and is that sure? `NearestBodies`.

use super::answer::{PairAnswer, Refused, Side, Verdict, Witness};
use super::cast_answer::NearestItem;
use super::cast_request::NearestBodies;
use super::declared::Coverage;
use super::derivatives::{DerivativesOf, derivatives_of};
use super::item_batch::ItemBatch;
use super::opponents::Opponents;
use super::patch::{PatchOf, patch_of};
use super::request::{Subject, Wants};
use super::stage::Stage;
use crate::geometry::{Aabb, Placement, Shape};
use crate::narrow_phase::{Cost, Depth, Goal, NoSeparation, Separation, separation};
use crate::scene::{Body, BodyId, Effect, Effects, Snapshot};

/// A checked request.
pub struct Neighbours<'a> {
    opponents: Opponents<'a>,
    request: &'a NearestBodies,
    wants: Wants,
    /// What makes patches, where they are wanted.
    patch: Option<PatchOf>,
    /// What makes derivatives, where they are wanted.
    derivatives: Option<DerivativesOf>,
    coverage: Coverage,
}

/// What is asked about, in its place.
struct Asker<'a> {
    shape: &'a Shape,
    at: Placement,
    bounds: Option<Aabb>,
    body: Option<&'a Body>,
}

/// The nearest so far.
struct Found {
    count: usize,
    cut_off: f64,
    /// Those that may be among the nearest, by the order of their upper ends.
    pairs: Vec<PairAnswer>,
    cost: Cost,
}

impl<'a> Neighbours<'a> {
    /// # Errors
    /// A context that cannot be; a count of zero.
    pub fn new(snapshot: &'a Snapshot, request: &'a NearestBodies) -> Result<Self, Refused> {
        if request.count == 0 {
            let problem = "is 0: there has to be at least one".to_owned();
            return Err(Refused::Invalid { field: "count".to_owned(), problem });
        }
        let wants = request.context.wants.closed();
        let opponents = Opponents::new(snapshot, &request.context)?;
        // In an overlap the order is that of the depths.
        let coverage =
            opponents.coverage(request.items.iter().filter_map(Subject::body), Effects::of(Effect::Depth))?;
        let (patch, derivatives) = (patch_of(wants), derivatives_of(wants));
        Ok(Self { opponents, request, wants, patch, derivatives, coverage })
    }

    fn asker(&self, item: usize) -> Result<Asker<'a>, String> {
        match &self.request.items[item] {
            Subject::All | Subject::ChangedSince(_) => {
                Err(format!("items[{item}]: asks for pairs, and the nearest bodies are those of one body or shape"))
            }
            Subject::Body(id) => {
                let body = self.opponents.snapshot.body(*id);
                let body = body.ok_or_else(|| format!("items[{item}].body: no body {id} in the scene"))?;
                let (shape, at, bounds) = (&*body.shape, body.placement, body.bounds);
                Ok(Asker { shape, at, bounds, body: Some(body) })
            }
            Subject::Shape { shape, pose } => {
                if let Some(problem) = self.opponents.unbounded_problem(shape, None) {
                    return Err(format!("items[{item}].shape: {problem}"));
                }
                let at = pose.placement();
                Ok(Asker { shape, at, bounds: shape.placed_bounds(&at), body: None })
            }
        }
    }

    fn nearest(&self, item: usize, asker: &Asker, stop: &dyn Fn() -> bool) -> Result<NearestItem, String> {
        let Opponents { snapshot, context, .. } = &self.opponents;
        let cut_off = context.cut_off.unwrap_or(f64::INFINITY);
        let mut found = Found { count: self.request.count, cut_off, pairs: Vec::new(), cost: Cost::default() };
        if asker.body.is_some_and(|body| !self.opponents.may_meet(body)) {
            return Ok(found.finish());
        }
        let mut problem = None;
        let mut look_at = |found: &mut Found, id: BodyId| {
            let body: &Body = snapshot.body(id).expect("the broad phase holds bodies of the snapshot");
            let Some(margin) = self.opponents.margin(asker.body, body) else { return };
            let goal = Goal {
                // In an overlap the order is that of the depths.
                depth: Depth::Penetration,
                accuracy: context.accuracy,
                solver: context.solver,
                margin,
                cut_off: found.reach().max(margin),
                stop,
            };
            match separation(asker.shape, &body.shape, &asker.at, &body.placement, &goal) {
                Ok(separation) => {
                    let mut cost = separation.cost;
                    let pair = self.pair(&separation, asker, body, margin, &mut cost);
                    found.take(&pair, cost);
                }
                Err(NoSeparation::Unbounded { .. } | NoSeparation::Empty { .. }) => {}
                Err(NoSeparation::Unclaimed(unclaimed)) => {
                    problem = problem.take().or(Some(format!("context.solver: {unclaimed}")));
                }
            }
        };
        // Unbounded bodies first: how far the walk has to reach is then the less.
        for id in snapshot.unbounded() {
            look_at(&mut found, *id);
        }
        match asker.bounds {
            Some(bounds) => {
                let reach = found.reach();
                let stats = snapshot.broad_phase().nearest(&bounds, reach, |id, _| {
                    if stop() {
                        return -1.0;
                    }
                    look_at(&mut found, BodyId(id));
                    found.reach()
                });
                found.cost.nodes += stats.nodes;
            }
            None => {
                for body in snapshot.bodies().filter(|body| body.bounds.is_some()) {
                    look_at(&mut found, body.id);
                }
            }
        }
        if let Some(problem) = problem {
            return Err(problem);
        }
        let mut told = found.finish();
        if let Some(derivatives) = self.derivatives {
            let shape = asker.body.is_none().then_some((asker.shape, asker.at));
            let stage = Stage { item, snapshot, shape, robot: None };
            for pair in &mut told.nearest {
                pair.derivatives = derivatives(pair, &stage, context, stop, &mut told.cost);
            }
        }
        Ok(told)
    }

    fn pair(&self, found: &Separation, asker: &Asker, body: &Body, margin: f64, cost: &mut Cost) -> PairAnswer {
        let own = asker.body.map_or(Side::Query { subshape: 0 }, |body| Side::Body { id: body.id, subshape: 0 });
        let witness = Witness {
            point_on_a: found.point_on_a,
            point_on_b: found.point_on_b,
            normal: found.normal,
            point_error: found.point_error,
            normal_error: found.normal_error,
        };
        let verdict = Verdict::of(&found.bracket, margin, found.termination);
        let placed = [(asker.shape, &asker.at), (&*body.shape, &body.placement)];
        let patch = self.patch.filter(|_| verdict != Verdict::Free);
        // What was asked about is side A, whatever its id: each pair here is one of it and another.
        PairAnswer {
            a: own.with_subshape(found.subshape_a),
            b: Side::Body { id: body.id, subshape: found.subshape_b },
            verdict,
            bracket: found.bracket,
            signed_distance: found.signed_distance,
            witness: self.wants.witness.then_some(witness),
            patch: patch.and_then(|patch| patch(placed, found, margin, &self.request.context, cost)),
            derivatives: None,
            termination: found.termination,
        }
    }
}

impl Found {
    /// A body proved farther than this is not among the nearest; metres.
    fn reach(&self) -> f64 {
        let last = self.count.checked_sub(1).and_then(|last| self.pairs.get(last));
        // Bodies that overlap more are nearer, but their boxes are no nearer than 0.
        self.cut_off.min(last.map_or(f64::INFINITY, |pair| pair.bracket.upper)).max(0.0)
    }

    fn take(&mut self, pair: &PairAnswer, cost: Cost) {
        self.cost += cost;
        if pair.bracket.lower > self.cut_off {
            return;
        }
        let after = |one: &PairAnswer| one.bracket.upper.total_cmp(&pair.bracket.upper).is_le();
        let place = self.pairs.partition_point(after);
        self.pairs.insert(place, pair.clone());
        let Some(last) = self.pairs.get(self.count - 1).map(|pair| pair.bracket.upper) else { return };
        // What is proved to be farther than the last of the nearest will not be told.
        self.pairs.retain(|pair| pair.bracket.lower <= last);
    }

    fn finish(mut self) -> NearestItem {
        let order = |one: &PairAnswer, two: &PairAnswer| {
            one.signed_distance.total_cmp(&two.signed_distance).then_with(|| (&one.a, &one.b).cmp(&(&two.a, &two.b)))
        };
        self.pairs.sort_by(order);
        let rest = self.pairs.split_off(self.pairs.len().min(self.count));
        let farthest = self.pairs.iter().map(|pair| pair.bracket.upper).fold(f64::NEG_INFINITY, f64::max);
        let set_is_proved = rest.iter().all(|pair| pair.bracket.lower >= farthest);
        let order_is_proved = self.pairs.windows(2).all(|two| two[0].bracket.upper <= two[1].bracket.lower);
        let verdict = self.pairs.iter().fold(Verdict::Free, |all, pair| all.and(pair.verdict));
        NearestItem {
            nearest: self.pairs,
            set_is_proved,
            order_is_proved,
            cost: self.cost,
            ..NearestItem::without_work(verdict)
        }
    }
}

impl ItemBatch for Neighbours<'_> {
    type Item = NearestItem;

    fn snapshot(&self) -> &Snapshot {
        self.opponents.snapshot
    }

    fn len(&self) -> usize {
        self.request.items.len()
    }

    fn not_run(&self) -> NearestItem {
        NearestItem::without_work(Verdict::NotRun)
    }

    fn coverage(&self) -> Coverage {
        self.coverage.clone()
    }

    fn answer(&self, item: usize, stop: &dyn Fn() -> bool) -> NearestItem {
        let answer = self.asker(item).and_then(|asker| self.nearest(item, &asker, stop));
        let invalid =
            |problem| NearestItem { problem: Some(problem), ..NearestItem::without_work(Verdict::InvalidInput) };
        answer.unwrap_or_else(invalid)
    }
}
