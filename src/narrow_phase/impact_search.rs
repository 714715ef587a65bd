//! The search for when two moving shapes meet.
//!
//! The second door for pairs that move. Compounds are taken apart, and meshes are gone down tree by tree: a pair of boxes that is
//! proved to stay apart until after the first contact found so far is not opened. The answer is the least over all pairs of
//! convex parts, whatever their order: its lower end the least time until which one of them is proved free, its upper end
//! the least at which one is proved to touch.

use super::advancement::{Asked, Pair, Timing};
use super::approach::Approach;
use super::box_gaps::BOX_ERROR_ULPS;
use super::element::Element;
use super::goal::Goal;
use super::impact::{Impact, ImpactGoal, NoImpact, Outcome, Place};
use super::outcome::{Cost, Separation, Termination};
use super::separation::{NoSeparation, separation};
use super::trees::{AnyLeaf, AnyNode, Growth, Inside, Tree};
use super::witness::WITNESS_ERROR_ULPS;
use crate::geometry::tolerance::UNIT_ROUNDOFF;
use crate::geometry::{Core, Part, RigidMotion, Shape, Vec3, length};

/// When shape A first comes within the goal's margin of shape B, each on its own motion in one frame.
///
/// Whatever limits the work, `0..free_until` is proved free, about the numbers as given and the motions as [`RigidMotion`]
/// defines them: rounding included, time never passes a contact.
///
/// # Errors
/// Two shapes without bounds; a margin beyond all lengths.
pub fn impact(
    a: &Shape,
    b: &Shape,
    motion_a: &RigidMotion,
    motion_b: &RigidMotion,
    goal: &ImpactGoal,
) -> Result<Impact, NoImpact> {
    if !a.is_empty() && !b.is_empty() && a.bounds().is_none() && b.bounds().is_none() {
        return Err(NoImpact::Unbounded { a: a.kind(), b: b.kind() });
    }
    let grown = if goal.margin > 0.0 { Some(a.swept(goal.margin)?) } else { None };
    let a = grown.as_ref().unwrap_or(a);
    let mut search = Search::new(goal);
    let has_solids = bodies_of(a).chain(bodies_of(b)).any(|body| is_solid_mesh(body.shape));
    if has_solids && let Some(start) = search.at_the_start(a, b, motion_a, motion_b) {
        return Ok(start);
    }
    let approach = Approach::new(motion_a, motion_b);
    for one in bodies_of(a) {
        for other in bodies_of(b) {
            search.pair(&approach, &one, &other);
        }
    }
    Ok(search.finish(&approach))
}

/// A shape that is no compound: a body, or a part of one.
struct Body<'a> {
    shape: &'a Shape,
    element: Element<'a>,
}

fn bodies_of(shape: &Shape) -> impl Iterator<Item = Body<'_>> {
    let parts: &[Part] = if let Core::Compound(compound) = shape.core() { compound.parts() } else { &[] };
    let alone = parts.is_empty().then(|| Body { shape, element: Element::new(shape, None) });
    let parts = (0..)
        .zip(parts)
        .map(move |(number, part)| Body { shape: &part.shape, element: Element::new(shape, Some((number, part))) });
    // Nothing meets a shape without a point.
    alone.into_iter().chain(parts).filter(|body| !body.shape.is_empty())
}

fn is_solid_mesh(shape: &Shape) -> bool {
    if let Core::Mesh(mesh) = shape.core() { mesh.is_solid() } else { false }
}

/// The earliest impact over the pairs looked at so far.
struct Search<'a> {
    asked: Asked<'a>,
    /// Later contacts do not matter.
    bound: f64,
    until: f64,
    free_until: f64,
    touching_at: f64,
    open_until: f64,
    /// The pair that touches first, or, as long as none does, the one that is undecided first.
    first: Option<(Timing, [u32; 2])>,
    limit: Option<Termination>,
    cost: Cost,
}

impl<'a> Search<'a> {
    fn new(goal: &ImpactGoal<'a>) -> Self {
        let never = f64::INFINITY;
        let until = goal.until.clamp(0.0, 1.0);
        Self {
            asked: Asked { resolution: goal.resolution, stop: goal.stop },
            bound: until,
            until,
            free_until: never,
            touching_at: never,
            open_until: f64::NEG_INFINITY,
            first: None,
            limit: None,
            cost: Cost::default(),
        }
    }

    /// What is inside of a solid mesh touches no triangle: whether they meet at the beginning is asked of the bodies as wholes.
    fn at_the_start(&mut self, a: &Shape, b: &Shape, motion_a: &RigidMotion, motion_b: &RigidMotion) -> Option<Impact> {
        let (at_a, at_b) = (motion_a.start().placement(), motion_b.start().placement());
        let goal = Goal { stop: self.asked.stop, ..Goal::verdict() };
        let found = match separation(a, b, &at_a, &at_b, &goal) {
            Ok(found) => found,
            Err(NoSeparation::Unbounded { .. } | NoSeparation::Empty { .. } | NoSeparation::Unclaimed(_)) => {
                return None;
            }
        };
        self.cost += found.cost;
        if found.bracket.upper <= 0.0 {
            return Some(Impact {
                outcome: Outcome::Hit,
                free_until: 0.0,
                touching_at: Some(0.0),
                open_until: None,
                starts_touching: true,
                place: Some(place(&found, Vec3::zeros(), 0.0)),
                subshape_a: found.subshape_a,
                subshape_b: found.subshape_b,
                termination: found.termination,
                cost: self.cost,
            });
        }
        if found.bracket.lower <= 0.0 {
            // It may be inside, and then nothing that follows would tell.
            self.free_until = 0.0;
            self.open_until = 1.0;
            if found.termination == Termination::TimeLimit {
                self.limit = Some(Termination::TimeLimit);
            }
        }
        None
    }

    fn pair(&mut self, approach: &Approach, a: &Body, b: &Body) {
        let (grove_a, grove_b) = (Grove::new(a), Grove::new(b));
        if grove_a.tree.is_none() && grove_b.tree.is_none() {
            self.elements(approach, &a.element, &b.element, 0.0);
        } else {
            self.walk(approach, &grove_a, &grove_b);
        }
    }

    /// Down both trees, towards what is met first.
    fn walk(&mut self, approach: &Approach, a: &Grove, b: &Grove) {
        let mut waiting = vec![(0.0, a.root(), b.root())];
        while let Some((from, node_a, node_b)) = waiting.pop() {
            if from > self.bound {
                continue;
            }
            if (self.asked.stop)() {
                self.give_up(from);
                return;
            }
            let children = match (a.inside(node_a), b.inside(node_b)) {
                (Inside::Leaf(leaf_a), Inside::Leaf(leaf_b)) => {
                    self.elements(approach, &a.leaf(leaf_a), &b.leaf(leaf_b), from);
                    continue;
                }
                (Inside::Children([first, second]), other)
                    if matches!(other, Inside::Leaf(_)) || a.size(node_a) >= b.size(node_b) =>
                {
                    [(first, node_b), (second, node_b)]
                }
                (_, Inside::Children([first, second])) => [(node_a, first), (node_a, second)],
                (Inside::Children(_), Inside::Leaf(_)) => unreachable!("covered by the second arm"),
            };
            self.cost.nodes += 1;
            let arrivals = children.map(|(child_a, child_b)| {
                let (box_a, box_b) = (a.outline(child_a), b.outline(child_b));
                Pair::new(approach, &box_a, &box_b).arrival(from, self.bound, &self.asked, &mut self.cost)
            });
            let sooner = usize::from(arrivals[1] < arrivals[0]);
            for child in [1 - sooner, sooner] {
                if arrivals[child] <= self.bound {
                    let (child_a, child_b) = children[child];
                    waiting.push((arrivals[child], child_a, child_b));
                }
            }
        }
    }

    /// Time ran out, and what is left may touch from `time` on.
    fn give_up(&mut self, time: f64) {
        self.limit = Some(Termination::TimeLimit);
        self.free_until = self.free_until.min(time);
        self.open_until = 1.0;
    }

    fn elements(&mut self, approach: &Approach, a: &Element, b: &Element, from: f64) {
        let timing = Pair::new(approach, a, b).first_contact(from, self.bound, &self.asked);
        self.cost += timing.cost;
        self.limit = self.limit.max(timing.limit);
        self.free_until = self.free_until.min(timing.free_until);
        if timing.touching_at > 1.0 && timing.free_until <= 1.0 {
            self.open_until = self.open_until.max(timing.open_until);
        }
        self.touching_at = self.touching_at.min(timing.touching_at);
        self.bound = self.bound.min(timing.touching_at);
        // Among equals the one of the least numbers, so that no order of the walk shows.
        let numbers = [a.number, b.number];
        let rank = |timing: &Timing| (timing.touching_at, timing.free_until);
        let (sooner, later) = (rank(&timing), self.first.as_ref().map(|(first, _)| rank(first)));
        let is_first = timing.free_until <= 1.0
            && later.is_none_or(|later| {
                sooner < later || (sooner == later && self.first.as_ref().is_some_and(|(_, first)| numbers < *first))
            });
        if is_first {
            self.first = Some((timing, numbers));
        }
    }

    fn finish(self, approach: &Approach) -> Impact {
        let outcome = if self.touching_at <= self.until {
            Outcome::Hit
        } else if self.free_until <= self.until {
            Outcome::Undecided
        } else {
            Outcome::Clear
        };
        let shown = self.first.filter(|_| outcome != Outcome::Clear);
        let free_until = if outcome == Outcome::Clear { self.until } else { self.free_until };
        let [subshape_a, subshape_b] = shown.as_ref().map_or([0; 2], |(_, numbers)| *numbers);
        let seen = shown.and_then(|(timing, _)| timing.last);
        let ended = seen.as_ref().map_or(Termination::Decided, |seen| seen.separation.termination);
        let termination = self.limit.unwrap_or(match outcome {
            Outcome::Clear => Termination::Decided,
            Outcome::Hit => Termination::Converged.min(ended),
            Outcome::Undecided => Termination::RoundingFloor,
        });
        Impact {
            outcome,
            free_until,
            touching_at: (outcome == Outcome::Hit).then_some(self.touching_at),
            open_until: (outcome == Outcome::Undecided).then_some(self.open_until.min(self.until)),
            starts_touching: outcome == Outcome::Hit && self.touching_at == 0.0,
            place: seen.map(|seen| place(&seen.separation, seen.origin, approach.origin_error())),
            subshape_a,
            subshape_b,
            termination,
            cost: self.cost,
        }
    }
}

fn place(found: &Separation, origin: Vec3, origin_error: f64) -> Place {
    let rounding = WITNESS_ERROR_ULPS * UNIT_ROUNDOFF * length(origin) + origin_error;
    Place {
        point_on_a: origin + found.point_on_a,
        point_on_b: origin + found.point_on_b,
        normal: found.normal,
        point_error: found.point_error + rounding,
        signed_distance: found.signed_distance,
    }
}

/// A body as a tree of elements, or as one.
struct Grove<'a> {
    element: &'a Element<'a>,
    /// None for a body that is a leaf of its own.
    tree: Option<Growth<'a>>,
    /// How far what is in a box may stick out of it, metres.
    slack: f64,
}

impl<'a> Grove<'a> {
    fn new(body: &'a Body<'a>) -> Self {
        let element = &body.element;
        let slack = BOX_ERROR_ULPS * UNIT_ROUNDOFF * element.reach;
        Self { element, tree: Growth::of_core(body.shape.core()), slack }
    }

    /// None stands for the body itself.
    fn root(&self) -> Option<AnyNode<'a>> {
        self.tree.as_ref().map(Tree::root)
    }

    fn inside(&self, node: Option<AnyNode<'a>>) -> Inside<Option<AnyNode<'a>>, Option<AnyLeaf>> {
        let Some((tree, node)) = self.tree.as_ref().zip(node) else { return Inside::Leaf(None) };
        match tree.inside(node) {
            Inside::Children(children) => Inside::Children(children.map(Some)),
            Inside::Leaf(leaf) => Inside::Leaf(Some(leaf)),
        }
    }

    fn size(&self, node: Option<AnyNode<'a>>) -> f64 {
        self.tree.as_ref().zip(node).map_or(0.0, |(tree, node)| tree.size(node))
    }

    /// What is around everything below a node.
    fn outline(&self, node: Option<AnyNode<'a>>) -> Element<'a> {
        let boxed = |(tree, node): (&Growth<'a>, AnyNode<'a>)| self.element.boxed(&tree.bounds(node), self.slack);
        self.tree.as_ref().zip(node).map_or_else(|| self.element.clone(), boxed)
    }

    fn leaf(&self, leaf: Option<AnyLeaf>) -> Element<'a> {
        let made =
            self.tree.as_ref().zip(leaf).and_then(|(tree, leaf)| {
                Some(self.element.leaf(tree.core(leaf)?, tree.number(leaf).unwrap_or_default()))
            });
        made.unwrap_or_else(|| self.element.clone())
    }
}
