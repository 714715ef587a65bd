//! A robot on its way: is it free all along straight lines of joint positions? `CheckMotions` and `CheckPath`.
//!
//! `motion_course` bisects a motion in time, `motion_measure` measures pairs in a state. `docs/derivations/motion.md` says
//! what is proved.

use super::answer::{Indeterminacy, ItemAnswer, MotionAnswer, PairAnswer, Refused, Verdict};
use super::motion_course::{Event, Open, Outcome, Rules, explore};
use super::motion_measure::{Gauge, Movable, Subject};
use super::overlay::Place;
use super::request::{CheckMotions, Find, Motions as Layout, Wants};
use super::robot_parts::{Placed, RobotParts};
use super::search::{Plan, Search};
use super::stage::{Stage, Standing};
use super::states::against_scene;
use crate::robot::JointLine;

/// A checked request.
pub(super) struct Motions<'a> {
    request: &'a CheckMotions,
    movable: Movable<'a>,
}

impl<'a> Motions<'a> {
    pub fn new(world: Place<'a>, request: &'a CheckMotions) -> Result<Self, Refused> {
        let robot = RobotParts::in_world(world, &request.robot, &request.context)?;
        let invalid = |field: &str, problem: String| Err(Refused::Invalid { field: field.to_owned(), problem });
        let resolution = request.resolution;
        if !(resolution.is_finite() && resolution > 0.0) {
            return invalid("resolution", format!("is not a positive number of metres: {resolution}"));
        }
        if request.max_states < 2 {
            return invalid("max_states", format!("is {}, and a motion has two ends", request.max_states));
        }
        let width = robot.model.degrees_of_freedom();
        let given = request.positions.len();
        if width == 0 {
            return invalid("robot", format!("{:?} has no joints that move", request.robot));
        }
        let (whole, what) = match request.motions {
            Layout::Edges => (2 * width, "motions, each from a start to a goal"),
            Layout::Path => (width, "waypoints"),
        };
        if !given.is_multiple_of(whole) {
            let problem = format!("{given} numbers are no whole number of {what}, of {width} positions each");
            return invalid("positions", problem);
        }
        Ok(Self { request, movable: Movable::new(robot) })
    }

    /// How many joints move.
    pub fn width(&self) -> usize {
        self.movable.robot.model.degrees_of_freedom()
    }

    pub fn len(&self) -> usize {
        let vectors = self.request.positions.len() / self.movable.robot.model.degrees_of_freedom();
        match self.request.motions {
            Layout::Edges => vectors / 2,
            Layout::Path => vectors.saturating_sub(1),
        }
    }

    /// Index of the position vector that a motion starts with; its goal is the next.
    fn first(&self, item: usize) -> usize {
        match self.request.motions {
            Layout::Edges => 2 * item,
            Layout::Path => item,
        }
    }

    fn positions(&self, vector: usize) -> &'a [f64] {
        let width = self.movable.robot.model.degrees_of_freedom();
        &self.request.positions[vector * width..(vector + 1) * width]
    }

    /// Which field of the request a position vector is.
    fn name(&self, item: usize, goal: bool) -> String {
        match self.request.motions {
            Layout::Edges => format!("motions[{item}].{}", if goal { "goal" } else { "start" }),
            Layout::Path => format!("waypoints[{}]", item + usize::from(goal)),
        }
    }

    pub fn answer(&self, item: usize, stop: &dyn Fn() -> bool) -> ItemAnswer {
        let robot = &self.movable.robot;
        let first = self.first(item);
        for goal in [false, true] {
            if let Err(problem) = robot.model.check_positions(self.positions(first + usize::from(goal))) {
                return ItemAnswer::invalid(format!("{}.{problem}", self.name(item, goal)));
            }
        }
        let (start, goal) = (self.positions(first), self.positions(first + 1));
        let line = match JointLine::new(robot.model, &self.movable.joints, &robot.robot.base, start, goal) {
            Ok(line) => line,
            Err(problem) => return ItemAnswer::invalid(format!("{}.{problem}", self.name(item, true))),
        };
        let context = &self.request.context;
        let largest_margin = context.margin.max(robot.snapshot.largest_margin());
        let mut gauge = Gauge::new(&self.movable, line, context.solver, largest_margin, stop);
        let rules = Rules {
            resolution: self.request.resolution,
            max_states: self.request.max_states as u64,
            locate: self.request.find == Find::FirstContact,
        };
        let outcome = explore(&mut gauge, &rules);
        if let Some(unclaimed) = gauge.unclaimed.take() {
            let cost = gauge.cost;
            return ItemAnswer { cost, ..ItemAnswer::invalid(format!("context.solver: {unclaimed}")) };
        }
        match outcome {
            Some(outcome) => self.told(item, &outcome, gauge, stop),
            None => ItemAnswer::without_work(Verdict::NotRun),
        }
    }

    /// The answer, with the pair that decides it.
    fn told(&self, item: usize, outcome: &Outcome, mut gauge: Gauge, stop: &dyn Fn() -> bool) -> ItemAnswer {
        let (verdict, at) = verdict(outcome);
        let reached = match verdict {
            Verdict::Collision => Some((outcome.apart_until, outcome.collision)),
            Verdict::Margin => Some((outcome.free_until, outcome.within)),
            Verdict::Free | Verdict::Indeterminate(_) | Verdict::NotRun | Verdict::InvalidInput => None,
        };
        let reached = reached.and_then(|(from, event)| event.map(|event| [from, event.t]));
        let undecided = match verdict {
            Verdict::Indeterminate(_) => outcome.not_apart.or(outcome.not_free).map(|undecided| undecided.t),
            Verdict::Collision | Verdict::Margin | Verdict::Free | Verdict::NotRun | Verdict::InvalidInput => None,
        };
        let nearest = at.and_then(|event| self.pair_at(item, &event, &mut gauge, stop));
        ItemAnswer {
            nearest,
            motion: Some(MotionAnswer {
                free_until: if verdict == Verdict::Free { 1.0 } else { outcome.free_until },
                reached,
                undecided,
                states: outcome.states,
                intervals: outcome.intervals,
            }),
            cost: gauge.cost,
            ..ItemAnswer::without_work(verdict)
        }
    }

    /// The pair that decides, as a question about its state would have it.
    fn pair_at(&self, item: usize, event: &Event, gauge: &mut Gauge, stop: &dyn Fn() -> bool) -> Option<PairAnswer> {
        let robot = &self.movable.robot;
        let context = &self.request.context;
        let wants = Wants { distance: true, pairs: false, ..context.wants };
        let plan = Plan::new(context, wants, robot.snapshot.largest_margin(), stop);
        let mut search = Search::new(&plan);
        let mut positions = Vec::new();
        gauge.line.positions(event.t, &mut positions);
        robot.place(&positions, &mut gauge.placed);
        self.offer(event.subject, &gauge.placed, &mut search);
        let standing = Standing { parts: robot, positions: &positions, placed: &gauge.placed };
        let stage = Stage { item, snapshot: robot.snapshot, shape: None, robot: Some(standing) };
        let found = search.finish(Some(&stage));
        gauge.cost += found.cost;
        found.nearest
    }

    fn offer(&self, subject: Subject, placed: &Placed, search: &mut Search) {
        let robot = &self.movable.robot;
        match self.movable.parts(subject) {
            (i, Some(j)) => {
                let margin = robot.self_pairs[subject as usize].margin;
                search.offer(&robot.party(i, placed), &robot.party(j, placed), margin);
            }
            (part, None) => against_scene(robot, part, search, placed),
        }
    }
}

/// The first that applies: a state in collision, one that is not proved apart, one within the margin, one that is not proved
/// beyond it; and the pair and time that decide.
fn verdict(outcome: &Outcome) -> (Verdict, Option<Event>) {
    if let Some(event) = outcome.collision {
        return (Verdict::Collision, Some(event));
    }
    let undecided = match (outcome.not_apart, outcome.within, outcome.not_free) {
        (Some(undecided), _, _) | (None, None, Some(undecided)) => undecided,
        (None, Some(event), _) => return (Verdict::Margin, Some(event)),
        (None, None, None) => return (Verdict::Free, None),
    };
    let why = match undecided.why {
        Open::Resolution => Indeterminacy::Resolution,
        Open::Rounding => Indeterminacy::Rounding,
        Open::States => Indeterminacy::IterationLimit,
    };
    let event = Event { t: undecided.t[0], subject: undecided.subject };
    (Verdict::Indeterminate(why), Some(event))
}
