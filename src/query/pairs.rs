//! Bodies and bare shapes against the scene: `Collide` and `Distance`.

use super::answer::{ItemAnswer, Refused, Side, Verdict};
use super::context::Sieve;
use super::overlay::Place;
use super::request::{PairQuery, Subject, Wants};
use super::search::{Found, Party, Plan, Search};
use super::stage::Stage;
use crate::geometry::{Aabb, Placement, Shape};
use crate::scene::{Body, BodyId, Snapshot};

/// A checked request.
pub(super) struct Pairs<'a> {
    snapshot: &'a Snapshot,
    request: &'a PairQuery,
    wants: Wants,
    sieve: Sieve<'a>,
    /// Margins do not count: neither the question's nor the scene's.
    touching: bool,
    /// Every pair within this is listed, metres.
    within: Option<f64>,
}

impl<'a> Pairs<'a> {
    pub fn collide(snapshot: &'a Snapshot, request: &'a PairQuery) -> Result<Self, Refused> {
        Self::new(snapshot, request, Wants { pairs: true, ..request.context.wants })
    }

    pub fn distance(snapshot: &'a Snapshot, request: &'a PairQuery) -> Result<Self, Refused> {
        Self::new(snapshot, request, Wants { distance: true, ..request.context.wants })
    }

    /// Every pair that is not proved farther than `within` metres.
    pub fn clearance(snapshot: &'a Snapshot, request: &'a PairQuery, within: f64) -> Result<Self, Refused> {
        let wants = Wants { distance: true, pairs: true, ..request.context.wants };
        Ok(Self { within: Some(within), ..Self::new(snapshot, request, wants)? })
    }

    fn new(snapshot: &'a Snapshot, request: &'a PairQuery, wants: Wants) -> Result<Self, Refused> {
        let sieve = Sieve::new(snapshot, &request.context)?;
        request.items.iter().enumerate().try_for_each(|(item, subject)| check_revision(snapshot, item, subject))?;
        Ok(Self { snapshot, request, wants, sieve, touching: false, within: None })
    }

    /// The same question in the world of an overlay. What the context names was looked for in the world it was made with.
    pub fn in_world(&self, world: Place<'a>) -> Self {
        let Self { request, wants, touching, within, .. } = *self;
        Self { snapshot: world.snapshot, request, wants, sieve: Sieve::unchecked(&request.context), touching, within }
    }

    /// For contacts that are tracked: what the filter names has to be there at the `first` revision only.
    pub(super) fn tracked(
        snapshot: &'a Snapshot,
        request: &'a PairQuery,
        touching: bool,
        first: bool,
    ) -> Result<Self, Refused> {
        let context = &request.context;
        let sieve = if first { Sieve::new(snapshot, context)? } else { Sieve::unchecked(context) };
        Ok(Self { snapshot, request, wants: context.wants, sieve, touching, within: None })
    }

    /// What is asked of every pair.
    pub(super) fn plan<'s>(&'s self, stop: &'s dyn Fn() -> bool) -> Plan<'s> {
        let largest = if self.touching { 0.0 } else { self.snapshot.largest_margin() };
        Plan::new(&self.request.context, self.wants, largest, stop).listing(self.within)
    }

    pub(super) fn snapshot(&self) -> &'a Snapshot {
        self.snapshot
    }

    pub(super) fn passes(&self, body: &Body) -> bool {
        self.sieve.passes(body)
    }

    pub fn len(&self) -> usize {
        self.request.items.len()
    }

    pub fn answer(&self, item: usize, stop: &dyn Fn() -> bool) -> ItemAnswer {
        let plan = self.plan(stop);
        let mut search = Search::new(&plan);
        let mut stage = self.stage(item);
        match &self.request.items[item] {
            Subject::All => self.everything(&mut search),
            Subject::ChangedSince(revision) => match self.snapshot.changes_since(*revision) {
                Ok(changes) => self.changed(&changes, &mut search),
                Err(not_kept) => return ItemAnswer::invalid(format!("items[{item}].changed_since: {not_kept}")),
            },
            Subject::Body(id) => match self.snapshot.body(*id) {
                Some(body) => self.body(body, &mut search),
                None => {
                    return ItemAnswer::invalid(format!("items[{item}].body: no body {id} in the scene"));
                }
            },
            Subject::Shape { shape, pose } => {
                if let (None, Some(id)) = (shape.bounds(), self.first_unbounded())
                    && !shape.is_empty()
                {
                    let kind = shape.kind();
                    return ItemAnswer::invalid(format!(
                        "items[{item}].shape: a {kind} is unbounded, and so is body {id}: they have no signed distance"
                    ));
                }
                let at = pose.placement();
                stage.shape = Some((shape, at));
                self.shape(shape, &at, &mut search);
            }
        }
        let mut whole = finish(search.finish(Some(&stage)));
        plan.derive(&mut whole.pairs, [whole.nearest.as_ref(), None], &stage, &mut whole.cost);
        whole
    }

    /// Where the sides of pairs of bodies are.
    pub(super) fn stage(&self, item: usize) -> Stage<'a> {
        Stage { item, snapshot: self.snapshot, shape: None, robot: None }
    }

    /// Layers and mask of a bare shape.
    fn query_layers(&self) -> (u32, u32) {
        let filter = &self.request.context.filter;
        (filter.layers.unwrap_or(u32::MAX), filter.mask.unwrap_or(u32::MAX))
    }

    /// A body without bounds that a bare shape is held against.
    fn first_unbounded(&self) -> Option<BodyId> {
        let (layers, mask) = self.query_layers();
        let meets = |body: &Body| self.sieve.passes(body) && body.meets(layers, mask);
        let met = |id: &&BodyId| self.snapshot.body(**id).is_some_and(|body| meets(body));
        self.snapshot.unbounded().iter().find(met).copied()
    }

    /// Every body against those with higher ids, so that each pair comes once. Quiet bodies do not look for others, and are found by
    /// all of them.
    pub(super) fn everything(&self, search: &mut Search) {
        let (quiet, mut loners) = (self.snapshot.quiet_bodies(), self.snapshot.loners());
        for body in self.snapshot.bodies().filter(|b| self.passes(b)) {
            if search.is_settled() {
                return;
            }
            if loners.has(body.member()) || quiet.has(body.member()) {
                continue;
            }
            self.against_bodies(search, &party(body), body.bounds, &mut |other| {
                let is_new = other.id > body.id || quiet.has(other.member());
                (is_new && self.admits(body, other)).then(|| self.margin(body, other))
            });
        }
    }

    fn body(&self, body: &Body, search: &mut Search) {
        if !body.enabled || self.snapshot.meets_no_body(body.member()) {
            return;
        }
        self.against_bodies(search, &party(body), body.bounds, &mut |other| {
            (other.id != body.id && self.admits(body, other)).then(|| self.margin(body, other))
        });
    }

    fn shape(&self, shape: &Shape, at: &Placement, search: &mut Search) {
        let query = Party { side: Side::Query { subshape: 0 }, shape, at };
        let (layers, mask) = self.query_layers();
        let margin = self.request.context.margin;
        self.against_bodies(search, &query, shape.placed_bounds(at), &mut |other| {
            other.meets(layers, mask).then_some(margin)
        });
    }

    /// Offers the bodies that `margin` gives a margin, as far as the search reaches.
    pub(super) fn against_bodies(
        &self,
        search: &mut Search,
        one: &Party,
        bounds: Option<Aabb>,
        margin: &mut dyn FnMut(&Body) -> Option<f64>,
    ) {
        let snapshot = self.snapshot;
        let mut offer = |search: &mut Search, id: BodyId| {
            let body = snapshot.body(id).expect("the broad phase holds bodies of the snapshot");
            if self.sieve.passes(body)
                && let Some(margin) = margin(body)
            {
                let other = party(body);
                // The query's shape, or the lower id, is side A.
                let (a, b) = if one.side < other.side { (one, &other) } else { (&other, one) };
                search.offer(a, b, margin);
            }
        };
        match bounds {
            Some(bounds) => {
                let reach = search.reach();
                let stats = snapshot.broad_phase().nearest(&bounds, reach, |id, _| {
                    offer(search, BodyId(id));
                    search.reach()
                });
                search.cost.nodes += stats.nodes;
                snapshot.unbounded().iter().for_each(|id| offer(search, *id));
            }
            // A half-space has no box: every bounded body is looked at, by one support value each.
            None if one.shape.is_empty() => {}
            None => {
                snapshot.bodies().filter(|b| b.bounds.is_some()).for_each(|b| offer(search, b.id));
            }
        }
    }

    pub(super) fn admits(&self, one: &Body, other: &Body) -> bool {
        if self.sieve.disregards_allowed_collisions() {
            let declared_empty = self.snapshot.is_declared_empty(one.member(), other.member());
            return other.enabled && one.meets(other.layers, other.mask) && !declared_empty;
        }
        self.snapshot.admits(one, other)
    }

    pub(super) fn margin(&self, one: &Body, other: &Body) -> f64 {
        if self.touching {
            return 0.0;
        }
        self.snapshot.margin(one.member(), other.member()).unwrap_or(self.request.context.margin)
    }
}

pub(super) fn party(body: &Body) -> Party<'_> {
    Party { side: Side::Body { id: body.id, subshape: 0 }, shape: &body.shape, at: &body.placement }
}

/// Whether the snapshot knows what changed since the revision that a subject names, if it names one.
fn check_revision(snapshot: &Snapshot, item: usize, subject: &Subject) -> Result<(), Refused> {
    let Subject::ChangedSince(asked) = *subject else { return Ok(()) };
    let (oldest, latest) = (snapshot.oldest_change(), snapshot.revision());
    if asked > latest {
        let problem = format!("revision {asked} comes after revision {latest}, which is asked");
        return Err(Refused::Invalid { field: format!("items[{item}].changed_since"), problem });
    }
    if asked < oldest { Err(Refused::Gone { asked, oldest }) } else { Ok(()) }
}

/// What was found, as the answer to an item.
pub(super) fn finish(found: Found) -> ItemAnswer {
    if let Some(unclaimed) = found.unclaimed {
        return ItemAnswer { cost: found.cost, ..ItemAnswer::invalid(format!("context.solver: {unclaimed}")) };
    }
    ItemAnswer {
        nearest: found.nearest,
        pairs: found.pairs,
        truncated: found.truncated,
        cost: found.cost,
        ..ItemAnswer::without_work(found.verdict)
    }
}

impl ItemAnswer {
    /// An item that cannot be asked.
    pub(super) fn invalid(problem: String) -> Self {
        Self { problem: Some(problem), ..Self::without_work(Verdict::InvalidInput) }
    }
}
