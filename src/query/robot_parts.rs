//! The shapes of a robot that is asked about: which pairs of them count, and where they are in a state.

use super::answer::{Refused, Side};
use super::context::Sieve;
use super::request::Context;
use super::search::Party;
use crate::geometry::{Aabb, Placement, Pose, Shape, Vec3};
use crate::robot::{LinkShape, RobotModel};
use crate::scene::{Body, RobotInScene, Snapshot};

/// A robot of the scene with the pairs that the question's filter and the scene's tables admit.
pub(super) struct RobotParts<'a> {
    pub snapshot: &'a Snapshot,
    context: &'a Context,
    sieve: Sieve<'a>,
    pub robot: &'a RobotInScene,
    pub model: &'a RobotModel,
    pub parts: Vec<LinkPart<'a>>,
    /// Pairs of parts of links that are held against each other.
    pub self_pairs: Vec<SelfPair>,
}

/// One shape of one link.
pub(super) struct LinkPart<'a> {
    pub link: u32,
    pub shape_index: u32,
    pub of_link: &'a LinkShape,
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
    pub fn new(snapshot: &'a Snapshot, robot: &str, context: &'a Context) -> Result<Self, Refused> {
        let sieve = Sieve::new(snapshot, context)?;
        let not_found = || Refused::NotFound { what: "robot", name: robot.to_owned(), revision: snapshot.revision() };
        let robot = snapshot.robot(robot).ok_or_else(not_found)?;
        let model: &RobotModel = &robot.model;
        let mut parts = Vec::with_capacity(model.links().iter().map(|link| link.shapes.len()).sum());
        for (link, l) in (0u32..).zip(model.links()) {
            for (shape_index, of_link) in (0u32..).zip(&l.shapes) {
                parts.push(LinkPart { link, shape_index, of_link });
            }
        }
        let mut robot = Self { snapshot, context, sieve, robot, model, parts, self_pairs: Vec::new() };
        robot.self_pairs = robot.pairs_of_parts();
        Ok(robot)
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
        for &(a, b) in links {
            let margin = self.snapshot.margin(self.robot.link(a), self.robot.link(b));
            let margin = margin.unwrap_or(self.context.margin);
            for i in parts_of(a) {
                parts_of(b).for_each(|j| pairs.push(SelfPair { i, j, margin }));
            }
        }
        pairs
    }

    /// The margin of a link and a body, metres; none where the pair does not count.
    pub fn margin(&self, link: u32, body: &Body) -> Option<f64> {
        let admits = || self.sieve.disregards_allowed_collisions() || self.snapshot.admits_link(self.robot, link, body);
        let own = || self.snapshot.margin(self.robot.link(link), body.member()).unwrap_or(self.context.margin);
        (self.sieve.passes(body) && admits()).then(own)
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
        let LinkPart { link, of_link, .. } = &self.parts[part];
        let at = placed.poses[*link as usize].compose(&of_link.pose).placement();
        placed.placements[part] = at;
        placed.bounds[part] = of_link.shape.placed_bounds(&at).expect("the shapes of links are bounded");
    }

    pub fn party<'s>(&'s self, part: usize, placed: &'s Placed) -> Party<'s> {
        let LinkPart { link, shape_index, .. } = self.parts[part];
        let side = Side::Link { link, shape: shape_index, subshape: 0 };
        Party { side, shape: self.parts[part].shape(), at: &placed.placements[part] }
    }
}

impl LinkPart<'_> {
    pub fn shape(&self) -> &Shape {
        &self.of_link.shape
    }
}
