//! A robot in many states: against itself and against the scene.

use super::answer::{ItemAnswer, Refused, Side};
use super::pairs::finish;
use super::request::{CheckStates, Wants};
use super::robot_parts::{Placed, RobotParts};
use super::search::{Party, Plan, Search};
use crate::scene::{BodyId, Snapshot};

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
    pub fn new(snapshot: &'a Snapshot, request: &'a CheckStates) -> Result<Self, Refused> {
        let robot = RobotParts::new(snapshot, &request.robot, &request.context)?;
        let width = robot.model.degrees_of_freedom();
        let given = request.positions.len();
        if !given.is_multiple_of(width) {
            let problem = format!("{given} numbers are no whole number of states of {width} positions each");
            return Err(Refused::Invalid { field: "positions".to_owned(), problem });
        }
        Ok(Self { request, wants: request.context.wants.closed(), within: None, robot })
    }

    /// With every pair that is not proved farther than `within` metres.
    pub fn clearance(snapshot: &'a Snapshot, request: &'a CheckStates, within: f64) -> Result<Self, Refused> {
        let states = Self::new(snapshot, request)?;
        let wants = Wants { distance: true, pairs: true, ..states.wants };
        Ok(Self { wants, within: Some(within), ..states })
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
            for part in 0..self.robot.parts.len() {
                against_scene(&self.robot, part, &mut outer, &scratch.placed);
            }
        }
        let (own, outer) = (own.finish(), outer.finish());
        let minima = self.wants.distance.then(|| (own.nearest.clone(), outer.nearest.clone()));
        let (nearest_self, nearest_scene) = minima.unwrap_or_default();
        let whole = finish(own.and(outer, &plan));
        if whole.problem.is_some() {
            return whole;
        }
        ItemAnswer { nearest_self, nearest_scene, ..whole }
    }
}

/// Offers the pairs of links that may matter, nearest boxes first. `near` is memory to use again.
pub(super) fn against_itself(robot: &RobotParts, search: &mut Search, placed: &Placed, near: &mut Vec<(f64, usize)>) {
    near.clear();
    let reach = search.reach();
    for (k, pair) in robot.self_pairs.iter().enumerate() {
        let distance = placed.bounds[pair.i].distance(&placed.bounds[pair.j]) * ROUNDING_DOWN;
        if distance <= reach {
            near.push((distance, k));
        }
    }
    near.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    for &(distance, k) in &*near {
        if distance > search.reach() {
            break;
        }
        let pair = &robot.self_pairs[k];
        search.offer(&robot.party(pair.i, placed), &robot.party(pair.j, placed), pair.margin);
    }
}

/// Offers the bodies that may matter to one part of a link.
pub(super) fn against_scene(robot: &RobotParts, part: usize, search: &mut Search, placed: &Placed) {
    if search.is_settled() {
        return;
    }
    let snapshot = robot.snapshot;
    let one = robot.party(part, placed);
    let offer = |search: &mut Search, id: BodyId| {
        let body = snapshot.body(id).expect("the broad phase holds bodies of the snapshot");
        if let Some(margin) = robot.margin(robot.parts[part].link, body) {
            let other = Party { side: Side::Body { id, subshape: 0 }, shape: &body.shape, at: &body.placement };
            search.offer(&one, &other, margin);
        }
    };
    let reach = search.reach();
    let stats = snapshot.broad_phase().nearest(&placed.bounds[part], reach, |id, _| {
        offer(search, BodyId(id));
        search.reach()
    });
    search.cost.nodes += stats.nodes;
    snapshot.unbounded().iter().for_each(|id| offer(search, *id));
}
