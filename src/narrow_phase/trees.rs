//! What a walk goes down: the tree of a mesh, of a point cloud, of terrain, of voxels, or a convex piece that is a leaf of its own.
//!
//! All are seen as binary trees of boxes in the piece's frame. Those of meshes are boxes in memory, side by side; the others make
//! theirs when they are asked. A walk is compiled for two sides that are meshes or convex ([`Branches`]), and for two of any kind ([`Growth`]).

use std::borrow::Borrow;

use super::pieces::Piece;
use super::support::support;
use crate::geometry::vector::ORIGIN;
use crate::geometry::{
    Aabb, Cells, Content, Core, HeightField, MeshTree, NodeId, Nodes, OrientedBox, Patch, PointCloud, Run, Siblings,
    TriangleMesh, TwinBox, Vec3, Voxels,
};

/// A binary tree of boxes with convex things in its leaves.
pub(super) trait Tree<'a>: Copy {
    /// A box of the tree.
    type Node: Copy;
    /// What is in a box that is not opened any further.
    type Leaf: Copy;
    /// Two sibling boxes.
    type Boxes: Borrow<TwinBox>;

    fn root(&self) -> Self::Node;
    fn bounds(&self, node: Self::Node) -> OrientedBox;
    /// The longest half edge of a node's box, metres.
    fn size(&self, node: Self::Node) -> f64;
    fn both(&self, children: [Self::Node; 2]) -> Self::Boxes;
    /// The root, twice.
    fn root_twice(&self) -> Self::Boxes;
    fn inside(&self, node: Self::Node) -> Inside<Self::Node, Self::Leaf>;
    /// The number of what is in a leaf; none for a piece that is a leaf of its own.
    fn number(&self, leaf: Self::Leaf) -> Option<u32>;
    /// The corners of a triangle in the order of its mesh; none for other leaves.
    fn triangle(&self, leaf: Self::Leaf) -> Option<&'a [Vec3; 3]>;
    /// What is in a leaf; none for a piece that is a leaf of its own.
    fn core(&self, leaf: Self::Leaf) -> Option<Core>;
}

/// What is in a box.
pub(super) enum Inside<N, L> {
    Children([N; 2]),
    Leaf(L),
}

/// Levels of any of the trees at most: a mesh has less than 2^31 triangles and a cloud no more than 2^31 points, all cut in halves;
/// terrain has as many cells at most, cut along rows and along columns, and those in two; a map has 21 levels of octants, cut three times
/// each, and bricks of 64 cells.
pub(super) const MOST_LEVELS: usize = 72;

const _: () = assert!(MOST_LEVELS >= crate::geometry::MOST_LEVELS);

/// The tree of a mesh, or a convex piece's bounds that stand for one.
#[derive(Clone, Copy)]
pub(super) struct Branches<'a> {
    nodes: Nodes<'a>,
    /// None for a convex piece.
    mesh: Option<&'a MeshTree>,
}

impl<'a> Branches<'a> {
    fn of_mesh(mesh: &'a TriangleMesh) -> Self {
        Self { nodes: mesh.tree().nodes(), mesh: Some(mesh.tree()) }
    }

    fn alone(only: &'a Siblings) -> Self {
        Self { nodes: Nodes::alone(only), mesh: None }
    }

    /// `alone`: the piece's bounds. None where the piece has a tree of another kind.
    pub fn of(piece: &Piece<'a>, alone: &'a Siblings) -> Option<Self> {
        let core = piece.shape.core();
        if let Core::Mesh(mesh) = core {
            Some(Self::of_mesh(mesh))
        } else {
            (!is_tree(core)).then(|| Self::alone(alone))
        }
    }
}

impl<'a> Tree<'a> for Branches<'a> {
    type Node = NodeId;
    type Leaf = usize;
    type Boxes = &'a TwinBox;

    #[inline(always)]
    fn root(&self) -> NodeId {
        NodeId::ROOT
    }

    #[inline(always)]
    fn bounds(&self, node: NodeId) -> OrientedBox {
        self.nodes.bounds(node)
    }

    #[inline(always)]
    fn size(&self, node: NodeId) -> f64 {
        self.nodes.size(node)
    }

    #[inline(always)]
    fn both(&self, children: [NodeId; 2]) -> &'a TwinBox {
        self.nodes.both(children)
    }

    fn root_twice(&self) -> &'a TwinBox {
        self.nodes.both([NodeId::ROOT; 2])
    }

    #[inline(always)]
    fn inside(&self, node: NodeId) -> Inside<NodeId, usize> {
        match self.nodes.content(node) {
            Content::Children(children) => Inside::Children(children),
            Content::Leaf(leaf) => Inside::Leaf(leaf),
        }
    }

    fn number(&self, leaf: usize) -> Option<u32> {
        self.mesh.map(|tree| tree.number(leaf))
    }

    #[inline(always)]
    fn triangle(&self, leaf: usize) -> Option<&'a [Vec3; 3]> {
        self.mesh.map(|tree| tree.corners(leaf))
    }

    #[inline(always)]
    fn core(&self, leaf: usize) -> Option<Core> {
        self.mesh.map(|tree| Core::Triangle(*tree.corners(leaf)))
    }
}

/// A tree of any kind.
#[derive(Clone, Copy)]
pub(super) enum Growth<'a> {
    Branches(Branches<'a>),
    Cloud(&'a PointCloud),
    Field(&'a HeightField),
    /// A map and all its cells.
    Map(&'a Voxels, Cells<'a>),
}

/// A node of a tree of any kind: of the one it came from.
#[derive(Clone, Copy)]
pub(super) enum AnyNode<'a> {
    Branch(NodeId),
    Run(Run),
    Patch(Patch),
    Cells(Cells<'a>),
}

/// A leaf of a tree of any kind: of the one it came from.
#[derive(Clone, Copy)]
pub(super) enum AnyLeaf {
    Branch(usize),
    /// A place in the order of the cloud's tree.
    Point(u32),
    /// The number of a column.
    Column(u32),
    /// A cell and its number.
    Voxel([i32; 3], u32),
}

impl<'a> Growth<'a> {
    /// `alone`: the piece's bounds. None for a map without cells.
    pub fn of(piece: &Piece<'a>, alone: &'a Siblings) -> Option<Self> {
        let core = piece.shape.core();
        if is_tree(core) { Self::of_core(core) } else { Some(Self::Branches(Branches::alone(alone))) }
    }

    /// The tree of a core that is made of many; none of one that is a leaf of its own, and of a map without cells.
    pub fn of_core(core: &'a Core) -> Option<Self> {
        if let Core::Mesh(mesh) = core {
            Some(Self::Branches(Branches::of_mesh(mesh)))
        } else if let Core::PointCloud(cloud) = core {
            Some(Self::Cloud(cloud))
        } else if let Core::HeightField(field) = core {
            Some(Self::Field(field))
        } else if let Core::Voxels(map) = core {
            map.root().map(|cells| Self::Map(map, cells))
        } else {
            None
        }
    }

    /// The box of a node of a cloud, field or map along the axes.
    fn upright(&self, node: AnyNode<'a>) -> Aabb {
        match (self, node) {
            (Self::Cloud(cloud), AnyNode::Run(run)) => cloud.bounds_of(run),
            (Self::Field(field), AnyNode::Patch(patch)) => field.bounds_of(patch),
            (Self::Map(map, _), AnyNode::Cells(cells)) => map.bounds_of(cells),
            (Self::Branches(_) | Self::Cloud(_) | Self::Field(_) | Self::Map(..), _) => unreachable!("{ANOTHERS}"),
        }
    }
}

const ANOTHERS: &str = "a node or leaf of another kind of tree";

impl<'a> Tree<'a> for Growth<'a> {
    type Node = AnyNode<'a>;
    type Leaf = AnyLeaf;
    type Boxes = TwinBox;

    fn root(&self) -> AnyNode<'a> {
        match self {
            Self::Branches(tree) => AnyNode::Branch(tree.root()),
            Self::Cloud(cloud) => AnyNode::Run(cloud.root()),
            Self::Field(field) => AnyNode::Patch(field.root()),
            Self::Map(_, cells) => AnyNode::Cells(*cells),
        }
    }

    fn bounds(&self, node: AnyNode<'a>) -> OrientedBox {
        if let (Self::Branches(tree), AnyNode::Branch(node)) = (self, node) {
            return tree.bounds(node);
        }
        OrientedBox::upright(&self.upright(node))
    }

    fn size(&self, node: AnyNode<'a>) -> f64 {
        if let (Self::Branches(tree), AnyNode::Branch(node)) = (self, node) {
            return tree.size(node);
        }
        self.upright(node).half_extents().max()
    }

    fn both(&self, children: [AnyNode<'a>; 2]) -> TwinBox {
        if let (Self::Branches(tree), [AnyNode::Branch(one), AnyNode::Branch(other)]) = (self, children) {
            return *tree.both([one, other]);
        }
        let [one, other] = children.map(|child| self.bounds(child));
        TwinBox::new([&one, &other])
    }

    fn root_twice(&self) -> TwinBox {
        let root = self.bounds(self.root());
        TwinBox::new([&root, &root])
    }

    fn inside(&self, node: AnyNode<'a>) -> Inside<AnyNode<'a>, AnyLeaf> {
        match (self, node) {
            (Self::Branches(tree), AnyNode::Branch(node)) => match tree.inside(node) {
                Inside::Children(children) => Inside::Children(children.map(AnyNode::Branch)),
                Inside::Leaf(leaf) => Inside::Leaf(AnyLeaf::Branch(leaf)),
            },
            (Self::Cloud(cloud), AnyNode::Run(run)) => match cloud.halves(run) {
                Some(halves) => Inside::Children(halves.map(AnyNode::Run)),
                None => Inside::Leaf(AnyLeaf::Point(run.start())),
            },
            (Self::Field(field), AnyNode::Patch(patch)) => match (field.halves(patch), field.column_number(patch)) {
                (Some(halves), _) => Inside::Children(halves.map(AnyNode::Patch)),
                (None, number) => Inside::Leaf(AnyLeaf::Column(number.unwrap_or_default())),
            },
            (Self::Map(..), AnyNode::Cells(cells)) => match (cells.halves(), cells.first()) {
                (Some(halves), _) => Inside::Children(halves.map(AnyNode::Cells)),
                (None, (cell, number)) => Inside::Leaf(AnyLeaf::Voxel(cell, number)),
            },
            (Self::Branches(_) | Self::Cloud(_) | Self::Field(_) | Self::Map(..), _) => unreachable!("{ANOTHERS}"),
        }
    }

    fn number(&self, leaf: AnyLeaf) -> Option<u32> {
        match (self, leaf) {
            (Self::Branches(tree), AnyLeaf::Branch(leaf)) => tree.number(leaf),
            (Self::Cloud(cloud), AnyLeaf::Point(place)) => Some(cloud.number(place)),
            (Self::Field(_), AnyLeaf::Column(number)) | (Self::Map(..), AnyLeaf::Voxel(_, number)) => Some(number),
            (Self::Branches(_) | Self::Cloud(_) | Self::Field(_) | Self::Map(..), _) => unreachable!("{ANOTHERS}"),
        }
    }

    fn triangle(&self, leaf: AnyLeaf) -> Option<&'a [Vec3; 3]> {
        match (self, leaf) {
            (Self::Branches(tree), AnyLeaf::Branch(leaf)) => tree.triangle(leaf),
            (Self::Branches(_) | Self::Cloud(_) | Self::Field(_) | Self::Map(..), _) => None,
        }
    }

    fn core(&self, leaf: AnyLeaf) -> Option<Core> {
        match (self, leaf) {
            (Self::Branches(tree), AnyLeaf::Branch(leaf)) => tree.core(leaf),
            (Self::Cloud(cloud), AnyLeaf::Point(place)) => Some(Core::Segment([cloud.at(place); 2])),
            (Self::Field(field), AnyLeaf::Column(number)) => Some(Core::Column(field.column(number))),
            (Self::Map(map, _), AnyLeaf::Voxel(cell, _)) => Some(Core::Block(map.box_of(cell))),
            (Self::Branches(_) | Self::Cloud(_) | Self::Field(_) | Self::Map(..), _) => unreachable!("{ANOTHERS}"),
        }
    }
}

impl<'a> Growth<'a> {
    /// A point of what is in a node, in the piece's frame.
    pub fn any_point_in(&self, node: AnyNode<'a>) -> Vec3 {
        let mut node = node;
        loop {
            match self.inside(node) {
                Inside::Children([first, _]) => node = first,
                Inside::Leaf(leaf) => return self.core(leaf).and_then(|core| any_point(&core)).unwrap_or(ORIGIN),
            }
        }
    }
}

/// Whether a core's pieces need not hang together: clouds and voxels. Meshes know their parts by themselves.
pub(super) fn has_loose_parts(core: &Core) -> bool {
    matches!(core, Core::PointCloud(_) | Core::Voxels(_))
}

/// Whether a piece has to be walked down, as it is made of many convex ones.
pub(super) fn has_tree(piece: &Piece) -> bool {
    is_tree(piece.shape.core())
}

/// Whether a core is made of many convex ones, with a tree over them.
pub(super) fn is_tree(core: &Core) -> bool {
    match core {
        Core::Mesh(_) | Core::HeightField(_) | Core::PointCloud(_) | Core::Voxels(_) => true,
        Core::Point
        | Core::Cuboid { .. }
        | Core::AxialSegment { .. }
        | Core::Cylinder { .. }
        | Core::Cone { .. }
        | Core::Ellipsoid { .. }
        | Core::Convex(_)
        | Core::Triangle(_)
        | Core::Segment(_)
        | Core::HalfSpace { .. }
        | Core::Plane { .. }
        | Core::Compound(_)
        | Core::Column(_)
        | Core::Block(_) => false,
    }
}

/// A point of the part of a shape with the number 0, in its frame; none of what has no bounds, is empty or a compound.
pub(super) fn any_point(core: &Core) -> Option<Vec3> {
    match core {
        // A vertex may belong to no triangle.
        Core::Mesh(mesh) => Some(mesh.triangle(0)[0]),
        Core::PointCloud(cloud) => Some(cloud.first()),
        Core::HeightField(field) => Some(field.column(0).top[0]),
        Core::Voxels(map) => map.root().map(|cells| map.box_of(cells.first().0).min),
        Core::Point
        | Core::Cuboid { .. }
        | Core::AxialSegment { .. }
        | Core::Cylinder { .. }
        | Core::Cone { .. }
        | Core::Ellipsoid { .. }
        | Core::Convex(_)
        | Core::Triangle(_)
        | Core::Segment(_)
        | Core::Column(_)
        | Core::Block(_) => Some(support(core, Vec3::z())),
        Core::HalfSpace { .. } | Core::Plane { .. } | Core::Compound(_) => None,
    }
}
