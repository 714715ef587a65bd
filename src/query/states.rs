//! A robot in many states: against itself and against the scene.

use super::answer::{ItemAnswer, Refused, Side};
use super::overlay::Place;
use super::pairs::finish;
use super::request::{CheckStates, Wants};
use super::robot_parts::{Placed, RobotParts, SelfPair};
use super::search::{Party, Plan, Search};
use super::stage::{Stage, Standing};
use crate::scene::BodyId;

/// Box distances are rounded down by this factor, so that none is above the true one.
pub(super) const ROUNDING_DOWN: f64 = 1.0 - 4.0 * f64::EPSILON;

/// A checked request.
pub(super) struct States<'a> {
    request: &'a CheckStates,
    wants: Wants,
    /// Every pair within this is listed, metres.
    within: Option<f64>,
    robot: RobotParts<'a>,
}

/// Memory that one run uses again from state to state.
pub(super) struct Scratch {
    placed: Placed,
    near: Vec<(f64, usize)>,
}

impl<'a> States<'a> {
    pub fn new(world: Place<'a>, request: &'a CheckStates) -> Result<Self, Refused> {
        let robot = RobotParts::in_world(world, &request.robot, &request.context)?;
        let width = robot.model.degrees_of_freedom();
        let given = request.positions.len();
        if !given.is_multiple_of(width) {
            let problem = format!("{given} numbers are no whole number of states of {width} positions each");
            return Err(Refused::Invalid { field: "positions".to_owned(), problem });
        }
        Ok(Self { request, wants: request.context.wants.closed(), within: None, robot })
    }

    /// With every pair that is not proved farther than `within` metres.
    pub fn clearance(world: Place<'a>, request: &'a CheckStates, within: f64) -> Result<Self, Refused> {
        let states = Self::new(world, request)?;
        let wants = Wants { distance: true, pairs: true, ..states.wants };
        Ok(Self { wants, within: Some(within), ..states })
    }

    /// How many joints move.
    pub fn width(&self) -> usize {
        self.robot.model.degrees_of_freedom()
    }

    /// A robot that cannot move has one state, of no numbers.
    pub fn len(&self) -> usize {
        self.request.positions.len().checked_div(self.robot.model.degrees_of_freedom()).unwrap_or(1)
    }

    pub fn scratch(&self) -> Scratch {
        Scratch { placed: self.robot.placed(), near: Vec::with_capacity(self.robot.self_pairs.len()) }
    }

    pub fn answer(&self, item: usize, scratch: &mut Scratch, stop: &dyn Fn() -> bool) -> ItemAnswer {
        let model = self.robot.model;
        let width = model.degrees_of_freedom();
        let positions = &self.request.positions[item * width..(item + 1) * width];
        if let Err(problem) = model.check_positions(positions) {
            return ItemAnswer::invalid(format!("states[{item}].{problem}"));
        }
        self.robot.place(positions, &mut scratch.placed);
        let largest_margin = self.robot.snapshot.largest_margin();
        let plan = Plan::new(&self.request.context, self.wants, largest_margin, stop).listing(self.within);
        let mut own = Search::new(&plan);
        against_itself(&self.robot, &mut own, &scratch.placed, &mut scratch.near);
        let mut outer = Search::new(&plan);
        if !own.is_settled() {
            all_against_scene(&self.robot, &mut outer, &scratch.placed);
        }
        let standing = Standing { parts: &self.robot, positions, placed: &scratch.placed };
        let stage = Stage { item, snapshot: self.robot.snapshot, shape: None, robot: Some(standing) };
        let (own, outer) = (own.finish(Some(&stage)), outer.finish(Some(&stage)));
        let minima = self.wants.distance.then(|| (own.nearest.clone(), outer.nearest.clone()));
        let (nearest_self, nearest_scene) = minima.unwrap_or_default();
        let mut whole = finish(own.and(outer, &plan));
        let told = [nearest_self.as_ref(), nearest_scene.as_ref()];
        plan.derive(&mut whole.pairs, told, &stage, &mut whole.cost);
        if whole.problem.is_some() {
            return whole;
        }
        ItemAnswer { nearest_self, nearest_scene, ..whole }
    }
}

/// Offers the pairs of links that may matter, nearest boxes first. `near` is memory to use again.
pub(super) fn against_itself(robot: &RobotParts, search: &mut Search, placed: &Placed, near: &mut Vec<(f64, usize)>) {
    near.clear();
    let offer = |search: &mut Search, k: usize| {
        let SelfPair { i, j, margin } = robot.self_pairs[k];
        search.offer(&robot.party(i, placed), &robot.party(j, placed), margin);
        search.reach()
    };
    // Pairs whose boxes touch are in their order already, and what they tell leaves few of the others to be sorted.
    let mut reach = search.reach();
    for (k, pair) in robot.self_pairs.iter().enumerate() {
        let distance = placed.bounds[pair.i].distance(&placed.bounds[pair.j]) * ROUNDING_DOWN;
        if distance > reach {
            continue;
        }
        if distance > 0.0 {
            near.push((distance, k));
            continue;
        }
        reach = offer(search, k);
        if reach < 0.0 {
            return;
        }
    }
    near.retain(|(distance, _)| *distance <= reach);
    near.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    for &(distance, k) in &*near {
        if distance > reach {
            break;
        }
        reach = offer(search, k);
    }
}

/// Offers the bodies that may matter to any part of a link.
fn all_against_scene(robot: &RobotParts, search: &mut Search, placed: &Placed) {
    let parts = (0..robot.parts.len()).filter(|part| !robot.parts[*part].meets_no_body);
    if !search.may_narrow() {
        parts.for_each(|part| against_scene(robot, part, search, placed));
        return;
    }
    // What touches the box of any part comes first: the nearest is among it as a rule, and then the others are looked for
    // within less.
    for part in parts.clone() {
        if search.is_settled() {
            return;
        }
        let offers = PartOffers::new(robot, part, placed);
        offers.bounded(search, 0.0, |_| true);
        offers.unbounded(search);
    }
    for part in parts {
        let reach = search.reach();
        if reach <= 0.0 {
            return;
        }
        PartOffers::new(robot, part, placed).bounded(search, reach, |distance| distance > 0.0);
    }
}

/// Offers the bodies that may matter to one part of a link.
pub(super) fn against_scene(robot: &RobotParts, part: usize, search: &mut Search, placed: &Placed) {
    if search.is_settled() || robot.parts[part].meets_no_body {
        return;
    }
    let offers = PartOffers::new(robot, part, placed);
    let reach = search.reach();
    offers.bounded(search, reach, |_| true);
    offers.unbounded(search);
}

/// Offers bodies to one part of a link.
struct PartOffers<'a> {
    robot: &'a RobotParts<'a>,
    part: usize,
    placed: &'a Placed,
    party: Party<'a>,
}

impl<'a> PartOffers<'a> {
    fn new(robot: &'a RobotParts<'a>, part: usize, placed: &'a Placed) -> Self {
        Self { robot, part, placed, party: robot.party(part, placed) }
    }

    /// Those with a box within `reach` metres, and as far as the search reaches then, if `counts` says so of the distance of the
    /// boxes.
    fn bounded(&self, search: &mut Search, reach: f64, counts: impl Fn(f64) -> bool) {
        let stats = self.robot.snapshot.broad_phase().nearest(&self.placed.bounds[self.part], reach, |id, distance| {
            if counts(distance) {
                self.offer(search, BodyId(id));
            }
            search.reach()
        });
        search.cost.nodes += stats.nodes;
    }

    fn unbounded(&self, search: &mut Search) {
        self.robot.snapshot.unbounded().iter().for_each(|id| self.offer(search, *id));
    }

    fn offer(&self, search: &mut Search, id: BodyId) {
        let body = self.robot.snapshot.body(id).expect("the broad phase holds bodies of the snapshot");
        if let Some(margin) = self.robot.margin(&self.robot.parts[self.part], body) {
            let other = Party { side: Side::Body { id, subshape: 0 }, shape: &body.shape, at: &body.placement };
            // A link is side A, and of two bodies the lower id.
            let (a, b) = if self.party.side < other.side { (&self.party, &other) } else { (&other, &self.party) };
            search.offer(a, b, margin);
        }
    }
}
