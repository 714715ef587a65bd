//! A robot in many states: against itself and against the scene.

use super::answer::{ItemAnswer, Refused, Side};
use super::context::Sieve;
use super::pairs::finish;
use super::request::{CheckStates, Wants};
use super::search::{Party, Plan, Search};
use crate::geometry::{Aabb, Placement, Pose, Shape};
use crate::robot::RobotModel;
use crate::scene::{Body, BodyId, RobotInScene, Snapshot};

/// Box distances are rounded down by this factor, so that none is above the true one.
const ROUNDING_DOWN: f64 = 1.0 - 4.0 * f64::EPSILON;

/// A checked request.
pub(super) struct States<'a> {
    snapshot: &'a Snapshot,
    request: &'a CheckStates,
    wants: Wants,
    sieve: Sieve<'a>,
    robot: &'a RobotInScene,
    model: &'a RobotModel,
    parts: Vec<LinkPart<'a>>,
    /// Pairs of parts of links that are held against each other, with their margins.
    self_pairs: Vec<(usize, usize, f64)>,
}

/// One shape of one link.
struct LinkPart<'a> {
    link: u32,
    shape_index: u32,
    in_link: &'a Pose,
    shape: &'a Shape,
}

/// Memory that one run uses again from state to state.
pub(super) struct Scratch {
    poses: Vec<Pose>,
    placements: Vec<Placement>,
    bounds: Vec<Aabb>,
    near: Vec<(f64, usize)>,
}

impl<'a> States<'a> {
    pub fn new(snapshot: &'a Snapshot, request: &'a CheckStates) -> Result<Self, Refused> {
        let sieve = Sieve::new(snapshot, &request.context)?;
        let robot = snapshot.robot(&request.robot).ok_or_else(|| Refused::NotFound {
            what: "robot",
            name: request.robot.clone(),
            revision: snapshot.revision(),
        })?;
        let model: &RobotModel = &robot.model;
        let width = model.degrees_of_freedom();
        let given = request.positions.len();
        if !given.is_multiple_of(width) {
            let problem = format!("{given} numbers are no whole number of states of {width} positions each");
            return Err(Refused::Invalid { field: "positions".to_owned(), problem });
        }
        let mut parts = Vec::new();
        for (link, l) in (0u32..).zip(model.links()) {
            for (shape_index, s) in (0u32..).zip(&l.shapes) {
                parts.push(LinkPart { link, shape_index, in_link: &s.pose, shape: &s.shape });
            }
        }
        let mut states = Self {
            snapshot,
            request,
            wants: request.context.wants.closed(),
            sieve,
            robot,
            model,
            parts,
            self_pairs: Vec::new(),
        };
        states.self_pairs = states.pairs_of_parts();
        Ok(states)
    }

    /// Every shape of one link against every shape of the other, for the pairs of links that are held against each other.
    fn pairs_of_parts(&self) -> Vec<(usize, usize, f64)> {
        let links =
            if self.sieve.disregards_allowed_collisions() { self.model.self_pairs() } else { &self.robot.self_pairs };
        let shapes_of = |link: u32| {
            let first = self.parts.partition_point(|part| part.link < link);
            let end = self.parts.partition_point(|part| part.link <= link);
            first..end
        };
        let mut pairs = Vec::new();
        for &(a, b) in links {
            let margin = self.snapshot.margin(self.robot.link(a), self.robot.link(b));
            let margin = margin.unwrap_or(self.request.context.margin);
            pairs.extend(shapes_of(a).flat_map(|i| shapes_of(b).map(move |j| (i, j, margin))));
        }
        pairs
    }

    fn admits(&self, link: u32, body: &Body) -> bool {
        self.sieve.disregards_allowed_collisions() || self.snapshot.admits_link(self.robot, link, body)
    }

    fn margin(&self, link: u32, body: &Body) -> f64 {
        self.snapshot.margin(self.robot.link(link), body.member()).unwrap_or(self.request.context.margin)
    }

    /// A robot that cannot move has one state, of no numbers.
    pub fn len(&self) -> usize {
        self.request.positions.len().checked_div(self.model.degrees_of_freedom()).unwrap_or(1)
    }

    pub fn scratch(&self) -> Scratch {
        let n = self.parts.len();
        Scratch {
            poses: Vec::with_capacity(self.model.links().len()),
            placements: Vec::with_capacity(n),
            bounds: Vec::with_capacity(n),
            near: Vec::with_capacity(self.self_pairs.len()),
        }
    }

    pub fn answer(&self, item: usize, scratch: &mut Scratch, stop: &dyn Fn() -> bool) -> ItemAnswer {
        let width = self.model.degrees_of_freedom();
        let positions = &self.request.positions[item * width..(item + 1) * width];
        if let Err(problem) = self.model.check_positions(positions) {
            return ItemAnswer::invalid(format!("states[{item}].{problem}"));
        }
        self.place(positions, scratch);
        let plan = Plan::new(&self.request.context, self.wants, self.snapshot.largest_margin(), stop);
        let mut own = Search::new(&plan);
        self.against_itself(&mut own, scratch);
        let mut outer = Search::new(&plan);
        if !own.is_settled() {
            self.against_scene(&mut outer, scratch);
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

    /// Forward kinematics, and where that puts every shape.
    fn place(&self, positions: &[f64], scratch: &mut Scratch) {
        self.model.link_poses(positions, &self.robot.base, &mut scratch.poses);
        scratch.placements.clear();
        scratch.bounds.clear();
        for part in &self.parts {
            let at = scratch.poses[part.link as usize].compose(part.in_link).placement();
            scratch.placements.push(at);
            scratch.bounds.push(part.shape.placed_bounds(&at).expect("the shapes of links are bounded"));
        }
    }

    fn against_itself(&self, search: &mut Search, scratch: &mut Scratch) {
        scratch.near.clear();
        let reach = search.reach();
        for (k, &(i, j, _)) in self.self_pairs.iter().enumerate() {
            let distance = scratch.bounds[i].distance(&scratch.bounds[j]) * ROUNDING_DOWN;
            if distance <= reach {
                scratch.near.push((distance, k));
            }
        }
        scratch.near.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for &(distance, k) in &scratch.near {
            if distance > search.reach() {
                break;
            }
            let (i, j, margin) = self.self_pairs[k];
            search.offer(&self.party(i, scratch), &self.party(j, scratch), margin);
        }
    }

    fn against_scene(&self, search: &mut Search, scratch: &Scratch) {
        for part in 0..self.parts.len() {
            if search.is_settled() {
                return;
            }
            let one = self.party(part, scratch);
            let offer = |search: &mut Search, id: BodyId| {
                let body = self.snapshot.body(id).expect("the broad phase holds bodies of the snapshot");
                let link = self.parts[part].link;
                if self.sieve.passes(body) && self.admits(link, body) {
                    let other = Party { side: Side::Body { id, subshape: 0 }, shape: &body.shape, at: &body.placement };
                    search.offer(&one, &other, self.margin(link, body));
                }
            };
            let reach = search.reach();
            let stats = self.snapshot.broad_phase().nearest(&scratch.bounds[part], reach, |id, _| {
                offer(search, BodyId(id));
                search.reach()
            });
            search.cost.nodes += stats.nodes;
            self.snapshot.unbounded().iter().for_each(|id| offer(search, *id));
        }
    }

    fn party<'s>(&'s self, part: usize, scratch: &'s Scratch) -> Party<'s> {
        let LinkPart { link, shape_index, shape, .. } = &self.parts[part];
        let side = Side::Link { link: *link, shape: *shape_index, subshape: 0 };
        Party { side, shape, at: &scratch.placements[part] }
    }
}
