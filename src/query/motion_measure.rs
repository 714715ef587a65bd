//! How far is a pair of a moving robot from touching, in one state, and how fast may that change?

use super::answer::Side;
use super::motion_course::Waiting;
use super::robot_parts::{Placed, RobotParts};
use super::search::Party;
use super::states::ROUNDING_DOWN;
use crate::geometry::tolerance::UNIT_ROUNDOFF;
use crate::narrow_phase::{Accuracy, Bracket, Cost, Depth, Goal, NoSeparation, Solver, Unclaimed, separation};
use crate::robot::{Axis, JointLine, MovedBall, MovingJoints};
use crate::scene::BodyId;

/// How narrow the bracket of a distance is made before the bisection goes on with its lower end. A wider one costs more
/// states than it saves in measuring them.
const ACCURACY: Accuracy = Accuracy { absolute: 0.0, relative: 0.05 };

/// Metres: with no way to go and nothing hidden by rounding, distances beyond this do not matter.
const LEAST_NEED: f64 = 1e-12;

/// What stays the same from motion to motion of one robot: what may collide, and what moves it.
pub(super) struct Movable<'a> {
    pub robot: RobotParts<'a>,
    pub joints: MovingJoints,
    /// By part.
    balls: Vec<MovedBall>,
    /// By part: where its speeds begin in [`Gauge::speeds`], and the end of the last.
    first_speed: Vec<usize>,
    /// By pair of parts: how many joints move both alike.
    common: Vec<usize>,
}

/// A pair that is held together as one: a pair of parts, or (numbered after those) a part and all bodies.
pub(super) type Subject = u32;

/// What is known of a pair in a state.
#[derive(Clone, Copy, Debug)]
pub(super) struct Measured {
    /// Metres: proved distance, or less where no more mattered; less what rounding may hide anywhere on the motion.
    pub apart: f64,
    /// The same less the margin.
    pub free: f64,
    /// Proved to touch.
    pub collides: bool,
    /// Proved apart, and within the margin.
    pub within: bool,
}

/// One motion of a robot, and the state it is looked at in.
pub(super) struct Gauge<'a> {
    movable: &'a Movable<'a>,
    pub line: JointLine<'a>,
    solver: Solver,
    stop: &'a dyn Fn() -> bool,
    /// By part: how far rounding may put any of its points from where it is, and what that adds to radii. Metres.
    errors: Vec<f64>,
    slacks: Vec<f64>,
    largest_margin: f64,
    positions: Vec<f64>,
    pub placed: Placed,
    axes: Vec<Axis>,
    /// By part: how fast it moves, see [`JointLine::speeds`].
    speeds: Vec<f64>,
    /// Which parts are placed.
    is_placed: Vec<bool>,
    /// The first pair that the solver does not take: then there is no answer.
    pub unclaimed: Option<Unclaimed>,
    pub cost: Cost,
}

impl<'a> Movable<'a> {
    pub fn new(robot: RobotParts<'a>) -> Self {
        let joints = MovingJoints::of(robot.model);
        let balls: Vec<MovedBall> = (robot.parts.iter())
            .map(|part| MovedBall { link: part.link, in_link: *part.in_link, ball: part.ball })
            .collect();
        let mut first_speed = vec![0];
        for ball in &balls {
            first_speed.push(first_speed[first_speed.len() - 1] + joints.depth(ball.link) + 1);
        }
        let common =
            robot.self_pairs.iter().map(|pair| joints.common(balls[pair.i].link, balls[pair.j].link)).collect();
        Self { robot, joints, balls, first_speed, common }
    }

    /// The part and all bodies, or else the two parts.
    pub fn parts(&self, subject: Subject) -> (usize, Option<usize>) {
        let index = subject as usize;
        match self.robot.self_pairs.get(index) {
            Some(pair) => (pair.i, Some(pair.j)),
            None => (index - self.robot.self_pairs.len(), None),
        }
    }
}

impl<'a> Gauge<'a> {
    pub fn new(
        movable: &'a Movable<'a>,
        line: JointLine<'a>,
        solver: Solver,
        largest_margin: f64,
        stop: &'a dyn Fn() -> bool,
    ) -> Self {
        let base = &movable.robot.robot.base;
        let n = movable.balls.len();
        Self {
            errors: movable.balls.iter().map(|ball| line.error(ball, base)).collect(),
            slacks: movable.balls.iter().map(|ball| line.slack(ball, base)).collect(),
            line,
            solver,
            stop,
            largest_margin,
            positions: Vec::new(),
            placed: movable.robot.placed(),
            axes: Vec::new(),
            speeds: vec![0.0; movable.first_speed[n]],
            is_placed: vec![false; n],
            unclaimed: None,
            cost: Cost::default(),
            movable,
        }
    }

    pub fn subjects(&self) -> std::ops::Range<Subject> {
        0..(self.movable.robot.self_pairs.len() + self.movable.balls.len()) as Subject
    }

    /// Takes the state at `t`, with the parts of the pairs that wait, or all. Speeds will hold for times within `half` of it.
    pub fn stand(&mut self, t: f64, half: f64, waiting: Option<&[Waiting]>) {
        self.line.positions(t, &mut self.positions);
        self.movable.robot.place_links(&self.positions, &mut self.placed);
        self.movable.joints.axes(&self.placed.poses, &mut self.axes);
        self.is_placed.fill(false);
        match waiting {
            None => (0..self.movable.balls.len()).for_each(|part| self.place(part, half)),
            Some(waiting) => {
                for pair in waiting {
                    let (one, other) = self.movable.parts(pair.subject);
                    self.place(one, half);
                    other.into_iter().for_each(|other| self.place(other, half));
                }
            }
        }
    }

    fn place(&mut self, part: usize, half: f64) {
        if std::mem::replace(&mut self.is_placed[part], true) {
            return;
        }
        self.movable.robot.place_part(part, &mut self.placed);
        let ball = &self.movable.balls[part];
        let center = self.placed.placements[part].point(ball.ball.center);
        let range = self.movable.first_speed[part]..self.movable.first_speed[part + 1];
        self.line.speeds(ball, center, &self.axes, half, self.slacks[part], &mut self.speeds[range]);
    }

    /// How fast the two sides of a pair move towards each other at most, metres per unit of t.
    pub fn speed(&self, subject: Subject) -> f64 {
        let of = |part: usize, common: usize| self.speeds[self.movable.first_speed[part] + common];
        match self.movable.parts(subject) {
            (one, None) => of(one, 0),
            (one, Some(other)) => {
                let common = self.movable.common[subject as usize];
                (of(one, common) + of(other, common)) * (1.0 + 4.0 * f64::EPSILON)
            }
        }
    }

    /// Measures a pair as far as `need` metres beyond its margin, or beyond contact where margins do not matter. None
    /// when the time is over or the solver does not take the pair.
    pub fn measure(&mut self, subject: Subject, need: f64, with_margin: bool) -> Option<Measured> {
        if (self.stop)() {
            return None;
        }
        let movable = self.movable;
        let measured = match movable.parts(subject) {
            (i, Some(j)) => {
                let hidden = 2.0 * (self.errors[i] + self.errors[j]);
                let margin = if with_margin { movable.robot.self_pairs[subject as usize].margin } else { 0.0 };
                let mut nearest = Nearest::new(need, hidden, margin);
                let boxes = self.placed.bounds[i].distance(&self.placed.bounds[j]) * ROUNDING_DOWN;
                if boxes <= nearest.reach() {
                    let one = movable.robot.party(i, &self.placed);
                    let other = movable.robot.party(j, &self.placed);
                    let bracket = bracket(&one, &other, margin, nearest.free, self.solver, self.stop, &mut self.cost);
                    nearest.take(bracket, margin, &mut self.unclaimed);
                }
                nearest.measured(hidden, movable.robot.self_pairs[subject as usize].margin, with_margin)
            }
            (part, None) => self.against_bodies(part, need, with_margin),
        };
        (self.unclaimed.is_none() && !(self.stop)()).then_some(measured)
    }

    fn against_bodies(&mut self, part: usize, need: f64, with_margin: bool) -> Measured {
        let robot = &self.movable.robot;
        let snapshot = robot.snapshot;
        let hidden = 2.0 * self.errors[part];
        let mut nearest = Nearest::new(need, hidden, if with_margin { self.largest_margin } else { 0.0 });
        let one = robot.party(part, &self.placed);
        let (cost, unclaimed, solver, stop) = (&mut self.cost, &mut self.unclaimed, self.solver, self.stop);
        let mut look = |nearest: &mut Nearest, id: BodyId| {
            let body = snapshot.body(id).expect("the tree holds bodies of the snapshot");
            let Some(margin) = robot.margin(&robot.parts[part], body) else { return };
            let margin = if with_margin { margin } else { 0.0 };
            let other = Party { side: Side::Body { id, subshape: 0 }, shape: &body.shape, at: &body.placement };
            let bracket = bracket(&one, &other, margin, nearest.free, solver, stop, cost);
            nearest.take(bracket, margin, unclaimed);
        };
        if robot.parts[part].meets_no_body {
            return nearest.measured(hidden, self.largest_margin, with_margin);
        }
        let reach = nearest.reach();
        let stats = snapshot.broad_phase().nearest(&self.placed.bounds[part], reach, |id, _| {
            look(&mut nearest, BodyId(id));
            if stop() { -1.0 } else { nearest.reach() }
        });
        snapshot.unbounded().iter().for_each(|id| look(&mut nearest, *id));
        self.cost.nodes += stats.nodes;
        nearest.measured(hidden, self.largest_margin, with_margin)
    }
}

/// The bracket of a pair, as good as is needed to tell whether it is farther apart than `beyond` more than the margin.
fn bracket(
    one: &Party,
    other: &Party,
    margin: f64,
    beyond: f64,
    solver: Solver,
    stop: &dyn Fn() -> bool,
    cost: &mut Cost,
) -> Result<Bracket, NoSeparation> {
    let cut_off = beyond.max(0.0) + margin;
    let goal = Goal { depth: Depth::Distance, accuracy: ACCURACY, solver, margin, cut_off, stop };
    let found = separation(one.shape, other.shape, one.at, other.at, &goal)?;
    *cost += found.cost;
    Ok(found.bracket)
}

/// The least of several distances, as far as it matters.
struct Nearest {
    /// Proved lower bound of the distance less the margin, metres.
    free: f64,
    /// Proved lower bound of the distance, metres.
    apart: f64,
    largest_margin: f64,
    collides: bool,
    within: bool,
}

impl Nearest {
    /// Nothing beyond `need` more than its margin matters, `hidden` taken off. A little more is looked at, so that what is
    /// beyond is more than needed.
    fn new(need: f64, hidden: f64, largest_margin: f64) -> Self {
        let cap = 1.01 * need.max(0.0) + 2.0 * hidden + LEAST_NEED;
        Self { free: cap, apart: f64::INFINITY, largest_margin, collides: false, within: false }
    }

    /// What is farther than this does not matter, metres.
    fn reach(&self) -> f64 {
        self.free.max(0.0) + self.largest_margin
    }

    fn take(&mut self, bracket: Result<Bracket, NoSeparation>, margin: f64, unclaimed: &mut Option<Unclaimed>) {
        match bracket {
            Ok(bracket) => {
                let rounding = 4.0 * UNIT_ROUNDOFF * (bracket.lower.abs() + margin);
                self.apart = self.apart.min(bracket.lower);
                self.free = self.free.min(bracket.lower - margin - rounding);
                self.collides |= bracket.upper <= 0.0;
                self.within |= bracket.lower > 0.0 && bracket.upper <= margin;
            }
            // Two unbounded shapes have no distance, but links are bounded; and nothing is near a shape without a point.
            Err(NoSeparation::Unbounded { .. } | NoSeparation::Empty { .. }) => {}
            Err(NoSeparation::Unclaimed(pair)) => *unclaimed = Some(pair),
        }
    }

    /// What holds of all, those included that were too far to be looked at. `hidden`: what rounding may hide, metres.
    fn measured(&self, hidden: f64, largest_margin: f64, with_margin: bool) -> Measured {
        let apart = self.apart.min(self.reach()) - hidden;
        let free = if with_margin { self.free - hidden } else { apart - largest_margin };
        Measured { apart, free, collides: self.collides, within: self.within }
    }
}
