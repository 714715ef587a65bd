//! The convex and unbounded parts of moving bodies, down to triangles and the boxes of their trees, in their places.

use super::approach::Instant;
use super::convex::{self, Convex};
use super::given::Given;
use super::goal::Goal;
use super::outcome::Separation;
use super::pieces::swapped;
use super::support::radius;
use super::unbounded::{self, Unbounded};
#[cfg(feature = "effect-motion")]
use crate::geometry::OrientedBox;
use crate::geometry::tolerance::{SUPPORT_ERROR_ULPS, UNIT_ROUNDOFF};
use crate::geometry::{Core, Part, Placement, Shape, Vec3, length};

/// What an element is before the ball is swept over it.
#[derive(Clone)]
enum Solid<'a> {
    Given(&'a Core),
    /// A triangle or a box out of a tree.
    Made(Core),
}

/// A convex or unbounded part of a body. Lengths are metres in the body's frame.
#[derive(Clone)]
pub(super) struct Element<'a> {
    core: Solid<'a>,
    whole: &'a Shape,
    part: Option<&'a Part>,
    /// The part's frame in the body's; none if they are one.
    inner: Option<Placement>,
    pub swept_radius: f64,
    /// How far what it stands for may stick out of it.
    slack: f64,
    /// Whether it is what was given, and no box around it.
    is_given: bool,
    /// No point of the core is farther from the body's origin; 0 for an unbounded one.
    pub reach: f64,
    /// Triangle of a mesh or part of a compound.
    pub number: u32,
}

impl<'a> Element<'a> {
    /// A body, or a part of a compound, that is not a mesh.
    #[inline(never)]
    pub fn new(whole: &'a Shape, part: Option<(u32, &'a Part)>) -> Self {
        let shape = part.map_or(whole, |(_, part)| &part.shape);
        let inner = part.map(|(_, part)| part.pose.placement());
        let (radii, number) = part.map_or((0.0, 0), |(number, part)| (part.shape.swept_radius(), number));
        let own = Self {
            core: Solid::Given(shape.core()),
            whole,
            part: part.map(|(_, part)| part),
            inner,
            swept_radius: whole.swept_radius() + radii,
            slack: 0.0,
            is_given: true,
            reach: 0.0,
            number,
        };
        own.measured()
    }

    /// The same core in its own frame, as a thing that was computed.
    pub fn alone(&self) -> Self {
        Self { inner: None, is_given: false, ..self.clone() }.measured()
    }

    /// What is in a leaf of the tree of this element's shape: a triangle of a mesh, say. Of a part of a compound the part is named.
    #[inline(never)]
    pub fn leaf(&self, core: Core, number: u32) -> Self {
        let number = if self.part.is_some() { self.number } else { number };
        Self { core: Solid::Made(core), number, ..self.clone() }.measured()
    }

    /// A box of the tree of this element's shape. `slack`: how far a corner may stick out of it.
    #[cfg(feature = "effect-motion")]
    pub fn boxed(&self, bounds: &OrientedBox, slack: f64) -> Self {
        let own = Placement::computed(bounds.axes, bounds.center);
        let inner = self.inner.map_or(own, |inner| composed(&inner, &own));
        let core = Solid::Made(Core::Cuboid { half_extents: bounds.half_extents });
        Self { core, inner: Some(inner), slack, is_given: false, ..self.clone() }.measured()
    }

    fn measured(self) -> Self {
        let inner = self.inner.as_ref().map_or(0.0, |inner| length(inner.translation));
        let reach = (radius(self.core()) + inner + self.slack) * (1.0 + 16.0 * UNIT_ROUNDOFF);
        Self { reach, ..self }
    }

    /// The shape of the body or part.
    pub fn shape(&self) -> &'a Shape {
        self.part.map_or(self.whole, |part| &part.shape)
    }

    pub fn core(&self) -> &Core {
        match &self.core {
            Solid::Given(core) => core,
            Solid::Made(core) => core,
        }
    }

    /// The normal, the offset, and whether it is thin, of an unbounded element.
    pub fn plane(&self) -> Option<(Vec3, f64, bool)> {
        if let Core::HalfSpace { normal, offset } = self.core() {
            Some((*normal, *offset, false))
        } else if let Core::Plane { normal, offset } = self.core() {
            Some((*normal, *offset, true))
        } else {
            None
        }
    }

    /// Its place, given the body's, and what that may be off by through composing two poses; metres.
    #[inline(never)]
    pub fn placed(&self, body: &Placement) -> (Placement, f64) {
        match &self.inner {
            None => (*body, self.slack),
            Some(inner) => {
                let error = SUPPORT_ERROR_ULPS * UNIT_ROUNDOFF * (self.reach + length(body.translation));
                (composed(body, inner), error + self.slack)
            }
        }
    }
}

fn composed(outer: &Placement, inner: &Placement) -> Placement {
    Placement::computed(outer.rotation * inner.rotation, outer.point(inner.translation))
}

/// How far two elements of bodies A and B are apart at one time, as far as the goal needs it; the points have A's origin as theirs.
/// Of two unbounded ones nothing is known, which callers have seen to. `reaches`: how far the points of each that matter are from
/// their origins, metres.
pub(super) fn measure(a: &Element, b: &Element, now: &Instant, reaches: [f64; 2], goal: &Goal) -> Option<Separation> {
    let ((at_a, error_a), (at_b, error_b)) = (a.placed(&now.at[0]), b.placed(&now.at[1]));
    let errors = [error_a + now.turn_errors[0] * reaches[0], error_b + now.turn_errors[1] * reaches[1] + now.drift];
    let convex = |element: &'_ Element, at: &'_ Placement, side: usize, then: &dyn Fn(Convex) -> Separation| {
        // Exact arithmetic knows nothing of boxes: their place, which was computed, tells it so.
        let given = if element.is_given { &now.given[side] } else { at };
        let given = Given { at: given, whole: element.whole, part: element.part };
        then(Convex {
            core: element.core(),
            swept_radius: element.swept_radius,
            at,
            placement_error: errors[side],
            given,
        })
    };
    let wall = |element: &'_ Element, at: &'_ Placement, side: usize, then: &dyn Fn(Unbounded) -> Separation| {
        let (normal, offset, thin) = element.plane()?;
        let given = Given { at: &now.given[side], whole: element.whole, part: element.part };
        Some(then(Unbounded {
            normal,
            offset,
            thin,
            swept_radius: element.swept_radius,
            at,
            placement_error: errors[side],
            given,
        }))
    };
    match (a.plane(), b.plane()) {
        (Some(_), Some(_)) => None,
        (None, Some(_)) => wall(b, &at_b, 1, &|b| convex(a, &at_a, 0, &|a| unbounded::separation(a, b, goal))),
        (Some(_), None) => {
            wall(a, &at_a, 0, &|a| convex(b, &at_b, 1, &|b| unbounded::separation(b, a, goal))).map(swapped)
        }
        (None, None) => Some(convex(a, &at_a, 0, &|a| convex(b, &at_b, 1, &|b| convex::separation(a, b, goal)))),
    }
}
