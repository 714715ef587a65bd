//! Two sides of a walk down the trees of meshes, how they lie to one another, and what boxes and leaves say.

use super::box_gaps::{BOX_ERROR_ULPS, Facing};
use super::convex::{self, Convex};
use super::goal::Goal;
use super::outcome::Separation;
use super::pieces::{Piece, mesh_of};
use super::support::{radius, support};
use super::triangles::TrianglePair;
use crate::geometry::tolerance::{SUPPORT_ERROR_ULPS, UNIT_ROUNDOFF, UNSCALED_EXTENT};
use crate::geometry::vector::opposite;
use crate::geometry::{Content, Core, MeshTree, NodeId, Nodes, Placement, Siblings, Twin, TwinBox, Vec3, length};

/// One side of a walk.
#[derive(Clone, Copy)]
pub(super) struct Side<'a> {
    pub piece: &'a Piece<'a>,
    pub nodes: Nodes<'a>,
    /// None for a convex piece, which is a leaf of its own.
    tree: Option<&'a MeshTree>,
}

impl<'a> Side<'a> {
    /// `alone`: the piece's bounds, which stand for the tree that a convex piece does not have.
    pub fn new(piece: &'a Piece<'a>, alone: &'a Siblings) -> Self {
        let tree = mesh_of(piece).map(|mesh| mesh.tree());
        Self { piece, nodes: tree.map_or_else(|| Nodes::alone(alone), MeshTree::nodes), tree }
    }

    /// The number of what is in a leaf: the triangle's in its mesh, or the piece's own.
    pub fn number(&self, leaf: usize) -> u32 {
        self.tree.map_or(self.piece.part, |tree| tree.number(leaf))
    }

    /// What is in a leaf.
    fn with_core<T>(&self, leaf: usize, then: impl FnOnce(&Core) -> T) -> T {
        match self.tree {
            Some(tree) => then(&Core::Triangle(*tree.corners(leaf))),
            None => then(self.piece.shape.core()),
        }
    }

    fn convex<'c>(&'c self, core: &'c Core) -> Convex<'c> {
        let Piece { swept_radius, at, placement_error, given, .. } = self.piece;
        Convex { core, swept_radius: *swept_radius, at, placement_error: *placement_error, given: *given }
    }

    /// Any point of the piece, in its frame.
    pub fn any_point(&self) -> Vec3 {
        self.with_core(0, |core| support(core, Vec3::z()))
    }
}

/// A pair of nodes with one of them opened.
pub(super) enum Opened<'a> {
    /// Children of a node of A, and a node of B.
    A { one: NodeId, two: &'a TwinBox },
    /// A node of A, and children of a node of B.
    B { one: NodeId, two: &'a TwinBox },
}

/// What comes after a pair of nodes.
pub(super) enum Next<'a> {
    /// Two pairs of nodes.
    Children(Opened<'a>, [(NodeId, NodeId); 2]),
    /// Two leaves.
    Leaves(usize, usize),
}

/// What the boxes of two pairs of nodes say.
pub(super) struct Bounds {
    /// Lower bounds of the signed distance of what is in them, metres.
    pub lower: [f64; 2],
    /// The pair with the lesser number is to be looked at first. What is in a box is mostly about its middle, so the mean of the bound and the
    /// distance of the centres tells better than the bound alone where the nearest things are: a fifth fewer nodes are opened.
    pub order: [f64; 2],
}

/// What stays the same on a walk: two sides, how they lie to one another, and how far numbers may be off.
pub(super) struct Course<'a> {
    pub a: Side<'a>,
    pub b: Side<'a>,
    pub b_in_a: Placement,
    a_in_b: Placement,
    /// What a gap of two boxes may be off by, and the swept radii: taken off, it is a lower bound. Metres.
    pub slack: f64,
    /// Of the origins, metres.
    distance: f64,
    placement_error: f64,
    pub radii: f64,
}

impl<'a> Course<'a> {
    pub fn new(a: Side<'a>, b: Side<'a>) -> Self {
        let b_in_a = Placement::relative(&a.piece.at, &b.piece.at);
        let inverse = b_in_a.rotation.transpose();
        let a_in_b = Placement::computed(inverse, -(inverse * b_in_a.translation));
        let distance = length(b_in_a.translation);
        let extent = radius(a.piece.shape.core()) + radius(b.piece.shape.core()) + distance;
        let radii = a.piece.swept_radius + b.piece.swept_radius;
        // Below the normal numbers roundings are absolute.
        let placement_error = a.piece.placement_error + b.piece.placement_error + 64.0 * f64::MIN_POSITIVE;
        let slack = BOX_ERROR_ULPS * UNIT_ROUNDOFF * (extent + radii) + placement_error + radii;
        Self { a, b, b_in_a, a_in_b, slack, distance, placement_error, radii }
    }

    /// The whole of both sides, as if B's root were a pair of children.
    pub fn roots(&self) -> Opened<'a> {
        Opened::B { one: NodeId::ROOT, two: self.b.nodes.both([NodeId::ROOT; 2]) }
    }

    /// Lower bounds of the signed distance of what is in two pairs of nodes, as good as is needed to tell whether they are
    /// above `threshold`. `normal`: a direction from A to B that is worth asking about first, in both frames.
    pub fn bounds(&self, pair: &Opened, normal: Option<[Vec3; 2]>, threshold: f64) -> Bounds {
        let (facing, normal) = match pair {
            Opened::A { one, two } => {
                let from_b = normal.map(|[in_a, in_b]| [opposite(in_b), opposite(in_a)]);
                (Facing::new(self.b.nodes.bounds(*one), two, &self.a_in_b), from_b)
            }
            Opened::B { one, two } => (Facing::new(self.a.nodes.bounds(*one), two, &self.b_in_a), normal),
        };
        let slack = Twin::splat(self.slack);
        // Whether two boxes meet is told best by their faces, how far apart they are by their near points.
        if threshold <= 0.0 {
            let lower = (facing.along_faces() - slack).0;
            return Bounds { lower, order: lower };
        }
        let mut gap = Twin::splat(f64::NEG_INFINITY);
        if let Some([in_one, in_two]) = normal {
            gap = facing.along(in_one, in_two);
            let [first, second] = (gap - slack).0;
            if first > threshold && second > threshold {
                return Bounds { lower: [first, second], order: [first, second] };
            }
        }
        gap = facing.between_near_points().max(gap);
        let [first, second] = gap.0;
        if first <= 0.0 || second <= 0.0 {
            gap = facing.along_faces().max(gap);
        }
        let order = facing.between_centers() + gap;
        Bounds { lower: (gap - slack).0, order: order.0 }
    }

    /// The pair opened at its larger side, whose box says least.
    #[inline(always)]
    pub fn open(&self, a: NodeId, b: NodeId) -> Next<'a> {
        let (nodes_a, nodes_b) = (&self.a.nodes, &self.b.nodes);
        match (nodes_a.content(a), nodes_b.content(b)) {
            (Content::Leaf(a), Content::Leaf(b)) => Next::Leaves(a, b),
            (Content::Children(children), other)
                if matches!(other, Content::Leaf(_)) || nodes_a.size(a) >= nodes_b.size(b) =>
            {
                let opened = Opened::A { one: b, two: nodes_a.both(children) };
                Next::Children(opened, children.map(|child| (child, b)))
            }
            (_, Content::Children(children)) => {
                let opened = Opened::B { one: a, two: nodes_b.both(children) };
                Next::Children(opened, children.map(|child| (a, child)))
            }
            (Content::Children(_), Content::Leaf(_)) => unreachable!("covered by the second arm"),
        }
    }

    /// The triangles of two leaves, in A's frame; none unless both sides are meshes, of sizes whose products are exact enough.
    pub fn triangles(&self, a: usize, b: usize) -> Option<TrianglePair> {
        let (a, in_b) = (self.a.tree?.corners(a), self.b.tree?.corners(b));
        let reach = |t: &[Vec3; 3]| t.iter().map(|p| p.norm_squared()).fold(0.0, f64::max).sqrt();
        let extent = reach(a) + reach(in_b) + self.distance;
        let (least, greatest) = UNSCALED_EXTENT;
        let error = SUPPORT_ERROR_ULPS * UNIT_ROUNDOFF * extent + self.placement_error;
        let b = in_b.map(|p| self.b_in_a.point(p));
        (least..=greatest).contains(&extent).then_some(TrianglePair { a: *a, b, error })
    }

    /// A lower bound of the signed distance of two leaves by a gap of their stored corners that are off by `error`, metres.
    pub fn lower_bound(&self, gap: f64, error: f64) -> f64 {
        gap - error - self.radii - 4.0 * UNIT_ROUNDOFF * (gap.abs() + self.radii)
    }

    /// Names the triangles or pieces in two leaves.
    pub fn named(&self, found: Separation, a: usize, b: usize) -> Separation {
        Separation { subshape_a: self.a.number(a), subshape_b: self.b.number(b), ..found }
    }

    /// Whatever is in two leaves, by GJK and EPA.
    pub fn by_gjk(&self, a: usize, b: usize, goal: &Goal) -> Separation {
        let found = self.a.with_core(a, |core_a| {
            self.b.with_core(b, |core_b| convex::separation(self.a.convex(core_a), self.b.convex(core_b), goal))
        });
        self.named(found, a, b)
    }
}
