//! The ladder of solvers: what each one is, and which pairs it claims.
//!
//! Every solver's answer is a proved bracket: below by the support value along its best direction, above by a pair of points
//! or, in an overlap, by a proved depth, whatever its own arithmetic did. They differ in work and in how narrow a bracket they
//! reach. `docs/queries.md` says when to ask for which, `docs/acceleration.md` what they cost.
//!
//! A mesh or compound is taken apart first, and the solver does its convex pieces. A swept radius is kept out of every solver,
//! so a sphere is a point to it. Against a half-space or plane there is only one direction to look along: all solvers that
//! claim the bounded shape give the same closed form.

use std::fmt;

use super::small_polytope::MAX_VERTICES;
use crate::geometry::{Core, Shape};

/// A way to find the signed distance of two convex pieces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Solver {
    /// Chosen for each pair by the kinds of its shapes; `docs/queries.md` says how and why.
    #[default]
    Default,
    /// Frank-Wolfe with line search (Frank and Wolfe 1956): one point of the difference, moved toward one vertex at a time.
    /// Any shapes; slow, for comparison. Overlaps go on to EPA, as do pairs that it cannot part within its cap.
    FrankWolfe,
    /// GJK, which is Frank-Wolfe that corrects over all of its simplex (Gilbert, Johnson, Keerthi 1988). Any shapes; overlaps
    /// are measured by EPA.
    Gjk,
    /// GJK with a momentum on directions that dies out as 1/(k+1). Any shapes, as `Gjk`.
    GjkPolyak,
    /// GJK with Nesterov's momentum (Montaut, Le Lidec, Petrik, Sivic, Carpentier 2022). Any shapes, as `Gjk`.
    GjkNesterov,
    /// The same with direction and gradient scaled to one length before they are mixed. Any shapes, as `Gjk`.
    GjkNesterovNormalised,
    /// Separating axes: the normals of all faces, and the products of those edges that can matter (Gregorius 2013). Points,
    /// segments, triangles, boxes, and hulls of at most 64 corners with proved faces. Overlaps are measured by it alone, but
    /// for slivers, whose normals are lost in rounding; of pairs apart it finds a parting axis, and GJK the distance from there.
    Sat,
    /// A quadratic program over the weights of the corners, by an interior-point solver. Polytopes; to some 1e-8 of the
    /// distance, and slow, for comparison. Overlaps go on to EPA.
    Qp,
    /// Integers in place of doubles, started where `Default` ends: the bracket's ends are next to each other. Polytopes, in an
    /// overlap too; some ten to a thousand microseconds. Numbers so far apart in size that they need more than 4096 bits keep
    /// the bracket that doubles gave.
    Exact,
}

/// A solver does not take one of the shapes.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the solver {solver} does not take a {a} and a {b}: {reason}")]
pub struct Unclaimed {
    /// The solver that was asked for.
    pub solver: Solver,
    /// Kind of the first shape.
    pub a: &'static str,
    /// Kind of the second.
    pub b: &'static str,
    /// What it lacks.
    pub reason: String,
}

impl Solver {
    /// All of them, from the bottom of the ladder up.
    pub const ALL: [Self; 9] = [
        Self::Default,
        Self::FrankWolfe,
        Self::Gjk,
        Self::GjkPolyak,
        Self::GjkNesterov,
        Self::GjkNesterovNormalised,
        Self::Sat,
        Self::Qp,
        Self::Exact,
    ];

    /// As it is written on the command line and in Python.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Default => "default",
            Self::FrankWolfe => "frank_wolfe",
            Self::Gjk => "gjk",
            Self::GjkPolyak => "gjk_polyak",
            Self::GjkNesterov => "gjk_nesterov",
            Self::GjkNesterovNormalised => "gjk_nesterov_normalised",
            Self::Sat => "sat",
            Self::Qp => "qp",
            Self::Exact => "exact",
        }
    }

    /// The solver of that name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|solver| solver.name() == name)
    }

    /// Whether the solver takes these two shapes, in whatever places.
    ///
    /// # Errors
    /// [`Unclaimed`], with the reason.
    pub fn claims(self, a: &Shape, b: &Shape) -> Result<(), Unclaimed> {
        let unclaimed = |reason| Unclaimed { solver: self, a: a.kind(), b: b.kind(), reason };
        [a, b].into_iter().try_for_each(|shape| self.takes(shape.core())).map_err(unclaimed)
    }

    /// Whether the solver takes a core, or every piece of it; else what it lacks.
    fn takes(self, core: &Core) -> Result<(), String> {
        match self {
            Self::Default
            | Self::FrankWolfe
            | Self::Gjk
            | Self::GjkPolyak
            | Self::GjkNesterov
            | Self::GjkNesterovNormalised => Ok(()),
            Self::Sat | Self::Qp | Self::Exact => self.takes_polytope(core),
        }
    }

    fn takes_polytope(self, core: &Core) -> Result<(), String> {
        match core {
            Core::Cylinder { .. } => Err("a cylinder is no polytope".to_owned()),
            Core::Cone { .. } => Err("a cone is no polytope".to_owned()),
            Core::Ellipsoid { .. } => Err("an ellipsoid is no polytope".to_owned()),
            Core::HeightField(_) | Core::Column(_) | Core::Voxels(_) | Core::Block(_) if self == Self::Sat => {
                Err("columns of terrain and cells of voxels have no list of faces".to_owned())
            }
            Core::Compound(compound) => {
                compound.parts().iter().try_for_each(|part| self.takes_polytope(part.shape.core()))
            }
            Core::Convex(hull) if self == Self::Sat && hull.points().len() > MAX_VERTICES => {
                Err(format!("the hull has {} corners, and {MAX_VERTICES} are the most", hull.points().len()))
            }
            Core::Convex(hull) if self == Self::Sat && hull.surface().is_none() => {
                Err("the faces of the hull are not proved: it is flat, or too thin".to_owned())
            }
            Core::Point
            | Core::Cuboid { .. }
            | Core::AxialSegment { .. }
            | Core::Convex(_)
            | Core::Triangle(_)
            | Core::Segment(_)
            | Core::HalfSpace { .. }
            | Core::Plane { .. }
            | Core::Mesh(_)
            | Core::HeightField(_)
            | Core::PointCloud(_)
            | Core::Voxels(_)
            | Core::Column(_)
            | Core::Block(_) => Ok(()),
        }
    }
}

impl fmt::Display for Solver {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
