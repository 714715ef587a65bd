//! The shapes of a robot that is asked about: which pairs of them count, and where they are in a state.

use super::answer::{Refused, Side};
use super::context::Sieve;
use super::overlay::{Held, Place};
use super::request::Context;
use super::search::Party;
use crate::geometry::{Aabb, Ball, Placement, Pose, Shape, Vec3};
use crate::robot::RobotModel;
use crate::scene::{Body, BodyId, RobotInScene, Snapshot};

/// A robot of the scene with the pairs that the question's filter and the scene's tables admit.
pub(super) struct RobotParts<'a> {
    pub snapshot: &'a Snapshot,
    context: &'a Context,
    sieve: Sieve<'a>,
    pub robot: &'a RobotInScene,
    pub model: &'a RobotModel,
    pub parts: Vec<LinkPart<'a>>,
    /// Pairs of parts of links, and of bodies that links hold, that are held against each other.
    pub self_pairs: Vec<SelfPair>,
    /// Bodies that the robot holds, sorted: they are not where the scene has them.
    held: Vec<BodyId>,
}

/// One shape of one link, or a body that a link holds.
pub(super) struct LinkPart<'a> {
    pub link: u32,
    pub shape_index: u32,
    pub shape: &'a Shape,
    /// Its frame in the link's, metres.
    pub in_link: &'a Pose,
    /// Holds the shape; in the shape's frame, metres.
    #[cfg_attr(not(feature = "effect-motion"), expect(dead_code, reason = "only motions ask for it"))]
    pub ball: Ball,
    /// Not a shape of the link's own.
    pub held: Option<&'a Body>,
    /// Everything that is declared of it and bodies of the scene is empty: it need not look for them.
    pub meets_no_body: bool,
}

/// Two parts that are held against each other.
pub(super) struct SelfPair {
    pub i: usize,
    pub j: usize,
    /// Metres.
    pub margin: f64,
}

/// Where everything is in one state; memory that is used again from state to state.
pub(super) struct Placed {
    pub poses: Vec<Pose>,
    pub placements: Vec<Placement>,
    pub bounds: Vec<Aabb>,
}

impl<'a> RobotParts<'a> {
    /// In the world of an overlay. What the context names was looked for in the common one.
    pub fn in_world(world: Place<'a>, robot: &str, context: &'a Context) -> Result<Self, Refused> {
        world.check_held_by(robot)?;
        let snapshot = world.snapshot;
        let sieve = if world.number == 0 { Sieve::new(snapshot, context)? } else { Sieve::unchecked(context) };
        let mut robot = Self::with_sieve(snapshot, robot, context, sieve)?;
        world.held.iter().for_each(|held| robot.hold(held));
        Ok(robot)
    }

    fn with_sieve(
        snapshot: &'a Snapshot,
        robot: &str,
        context: &'a Context,
        sieve: Sieve<'a>,
    ) -> Result<Self, Refused> {
        let not_found = || Refused::NotFound { what: "robot", name: robot.to_owned(), revision: snapshot.revision() };
        let robot = snapshot.robot(robot).ok_or_else(not_found)?;
        let model: &RobotModel = &robot.model;
        let mut parts = Vec::with_capacity(model.links().iter().map(|link| link.shapes.len()).sum());
        let mut loners = snapshot.loners();
        for (link, l) in (0u32..).zip(model.links()) {
            let meets_no_body = loners.has(robot.link(link));
            for (shape_index, of_link) in (0u32..).zip(&l.shapes) {
                let (shape, in_link, ball) = (&*of_link.shape, &of_link.pose, of_link.ball);
                parts.push(LinkPart { link, shape_index, shape, in_link, ball, held: None, meets_no_body });
            }
        }
        let (self_pairs, held) = (Vec::new(), Vec::new());
        let mut robot = Self { snapshot, context, sieve, robot, model, parts, self_pairs, held };
        robot.self_pairs = robot.pairs_of_parts();
        Ok(robot)
    }

    /// A body moves with a link from now on. It is held against the other links but for those that may touch it, against
    /// bodies that other links hold, and against the scene.
    fn hold(&mut self, held: &'a Held) {
        if let Err(place) = self.held.binary_search(&held.body) {
            self.held.insert(place, held.body);
        }
        let Some(body) = self.snapshot.body(held.body).map(|body| &**body) else { return };
        if !self.sieve.admits_held(body) || body.shape.is_empty() {
            return;
        }
        let j = self.parts.len();
        for (i, part) in self.parts.iter().enumerate() {
            let margin = match part.held {
                _ if part.link == held.link => None,
                None if held.may_touch.contains(&part.link) => None,
                None => self.margin_of_link(part.link, body),
                Some(other) => self.margin_of_bodies(other, body),
            };
            // The lower id is side A, as everywhere.
            let (i, j) = if part.held.is_some_and(|other| other.id > body.id) { (j, i) } else { (i, j) };
            self.self_pairs.extend(margin.map(|margin| SelfPair { i, j, margin }));
        }
        let (shape, in_link) = (&*body.shape, &held.body_in_link);
        let Some(ball) = Ball::around(shape) else { return };
        let meets_no_body = self.snapshot.meets_no_body(body.member());
        self.parts.push(LinkPart {
            link: held.link,
            shape_index: 0,
            shape,
            in_link,
            ball,
            held: Some(body),
            meets_no_body,
        });
    }

    /// Every shape of one link against every shape of the other, for the pairs of links that are held against each other.
    fn pairs_of_parts(&self) -> Vec<SelfPair> {
        let links =
            if self.sieve.disregards_allowed_collisions() { self.model.self_pairs() } else { &self.robot.self_pairs };
        // By link: the first of its parts.
        let mut first: Vec<usize> = Vec::with_capacity(self.model.links().len() + 1);
        first.push(0);
        for link in self.model.links() {
            first.push(first[first.len() - 1] + link.shapes.len());
        }
        let parts_of = |link: u32| first[link as usize]..first[link as usize + 1];
        let mut pairs = Vec::with_capacity(links.len());
        let disregards = self.sieve.disregards_allowed_collisions();
        for &(a, b) in links {
            if disregards && self.snapshot.is_declared_empty(self.robot.link(a), self.robot.link(b)) {
                continue; // The others were left out by the scene.
            }
            let margin = self.snapshot.margin(self.robot.link(a), self.robot.link(b));
            let margin = margin.unwrap_or(self.context.margin);
            for i in parts_of(a) {
                parts_of(b).for_each(|j| pairs.push(SelfPair { i, j, margin }));
            }
        }
        pairs
    }

    /// The margin of a part and a body of the scene, metres; none where the pair does not count.
    pub fn margin(&self, part: &LinkPart, body: &Body) -> Option<f64> {
        if !self.sieve.passes(body) || self.held.binary_search(&body.id).is_ok() {
            return None;
        }
        match part.held {
            None => self.margin_of_link(part.link, body),
            Some(held) => self.margin_of_bodies(held, body),
        }
    }

    fn margin_of_link(&self, link: u32, body: &Body) -> Option<f64> {
        let admits = if self.sieve.disregards_allowed_collisions() {
            !self.snapshot.is_declared_empty(self.robot.link(link), body.member())
        } else {
            self.snapshot.admits_link(self.robot, link, body)
        };
        let own = || self.snapshot.margin(self.robot.link(link), body.member()).unwrap_or(self.context.margin);
        admits.then(own)
    }

    fn margin_of_bodies(&self, one: &Body, other: &Body) -> Option<f64> {
        let admits = if self.sieve.disregards_allowed_collisions() {
            one.meets(other.layers, other.mask) && !self.snapshot.is_declared_empty(one.member(), other.member())
        } else {
            self.snapshot.admits(one, other)
        };
        let own = || self.snapshot.margin(one.member(), other.member()).unwrap_or(self.context.margin);
        admits.then(own)
    }

    /// Which part a side of a pair stands for; none for a body that the robot does not hold.
    #[cfg(feature = "effect-derivatives")]
    pub fn part_of(&self, side: &Side) -> Option<usize> {
        // Shapes of links come first, in order.
        let own = self.parts.partition_point(|part| part.held.is_none());
        match *side {
            Side::Link { link, shape, .. } => {
                let place = |part: &LinkPart| (part.link, part.shape_index);
                self.parts[..own].binary_search_by_key(&(link, shape), place).ok()
            }
            Side::Body { id, .. } => {
                let of = |part: &LinkPart| part.held.is_some_and(|held| held.id == id);
                self.parts[own..].iter().position(of).map(|index| own + index)
            }
            Side::Query { .. } => None,
        }
    }

    pub fn placed(&self) -> Placed {
        let n = self.parts.len();
        let nowhere = Aabb { min: Vec3::zeros(), max: Vec3::zeros() };
        Placed {
            poses: Vec::with_capacity(self.model.links().len()),
            placements: vec![Placement::identity(); n],
            bounds: vec![nowhere; n],
        }
    }

    /// Forward kinematics, and where that puts every shape.
    pub fn place(&self, positions: &[f64], placed: &mut Placed) {
        self.place_links(positions, placed);
        (0..self.parts.len()).for_each(|part| self.place_part(part, placed));
    }

    /// Forward kinematics alone; then [`Self::place_part`] for the shapes that matter.
    pub fn place_links(&self, positions: &[f64], placed: &mut Placed) {
        self.model.link_poses(positions, &self.robot.base, &mut placed.poses);
    }

    /// Where its link puts a shape.
    pub fn place_part(&self, part: usize, placed: &mut Placed) {
        let LinkPart { link, shape, in_link, .. } = &self.parts[part];
        let at = placed.poses[*link as usize].compose(in_link).placement();
        placed.placements[part] = at;
        placed.bounds[part] = shape.placed_bounds(&at).expect("the shapes of links and of held bodies are bounded");
    }

    pub fn party<'s>(&'s self, part: usize, placed: &'s Placed) -> Party<'s> {
        let LinkPart { link, shape_index, shape, held, .. } = self.parts[part];
        let side = match held {
            None => Side::Link { link, shape: shape_index, subshape: 0 },
            Some(body) => Side::Body { id: body.id, subshape: 0 },
        };
        Party { side, shape, at: &placed.placements[part] }
    }
}
