//! Why a robot was refused.

use crate::geometry::InvalidShape;
use crate::geometry::mesh_file::MeshFileError;

/// Why a URDF, an SRDF or the options were refused. `item` names the element, for example `joint "elbow"`.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RobotError {
    /// Not XML.
    #[error("{document} is not well-formed XML: {problem}")]
    Xml {
        /// `URDF` or `SRDF`.
        document: &'static str,
        /// What the XML reader says, with line and column.
        problem: String,
    },
    /// XML, but of something else.
    #[error("{document} begins with <{found}>, not with <robot>")]
    NotARobot {
        /// `URDF` or `SRDF`.
        document: &'static str,
        /// The outermost element.
        found: String,
    },
    /// Something that has to be there is not.
    #[error("{item} has no {field}")]
    Missing {
        /// The element.
        item: String,
        /// What it lacks.
        field: String,
    },
    /// Words where numbers are needed; NaN; infinities; too few or too many numbers.
    #[error("{item}: {field} is to be {expected}, not {found:?}")]
    BadNumber {
        /// The element.
        item: String,
        /// The attribute.
        field: String,
        /// How many finite numbers are needed.
        expected: &'static str,
        /// What is there.
        found: String,
    },
    /// Two of one name.
    #[error("there are two {kind}s named {name:?}")]
    Duplicate {
        /// `link`, `joint`, `group` ...
        kind: &'static str,
        /// The name.
        name: String,
    },
    /// A name of something that is not there.
    #[error("{item}: {field} names {kind} {name:?}, which does not exist")]
    Unknown {
        /// The element.
        item: String,
        /// The attribute or child element.
        field: String,
        /// `link`, `joint`, `group`.
        kind: &'static str,
        /// The name.
        name: String,
    },
    /// More of something than a robot has.
    #[error("there are {found} {kind}s, {limit} are allowed")]
    TooMany {
        /// `link` or `group`.
        kind: &'static str,
        /// How many there are.
        found: usize,
        /// How many may be.
        limit: usize,
    },
    /// A robot without links.
    #[error("the URDF has no links")]
    NoLinks,
    /// A link that two joints lead to.
    #[error("link {link:?} is the child of two joints, {first:?} and {second:?}")]
    TwoParents {
        /// The link.
        link: String,
        /// A joint that leads to it.
        first: String,
        /// Another.
        second: String,
    },
    /// Links that are not joined to each other.
    #[error("there are two root links, {first:?} and {second:?}: no joint leads to either")]
    TwoRoots {
        /// A link without parent.
        first: String,
        /// Another.
        second: String,
    },
    /// Joints that lead round in a circle.
    #[error("link {link:?} is its own ancestor")]
    Cycle {
        /// A link of the circle, or hanging from it.
        link: String,
    },
    /// An axis without direction.
    #[error("joint {joint:?}: axis is zero")]
    ZeroAxis {
        /// The joint.
        joint: String,
    },
    /// A kind of joint that cannot be computed with here.
    #[error("joint {joint:?}: type {kind:?} is not supported")]
    UnsupportedJoint {
        /// The joint.
        joint: String,
        /// Its type.
        kind: String,
    },
    /// An interval turned round.
    #[error("joint {joint:?}: limit has lower {lower} above upper {upper}")]
    LimitsReversed {
        /// The joint.
        joint: String,
        /// Radians or metres.
        lower: f64,
        /// Radians or metres.
        upper: f64,
    },
    /// A joint that follows itself, perhaps by way of others.
    #[error("joint {joint:?} mimics itself, directly or by way of others")]
    MimicCycle {
        /// The joint.
        joint: String,
    },
    /// A joint that cannot follow, or be followed.
    #[error("joint {joint:?} is to mimic {target:?}, but a {kind} joint has no single position")]
    MimicKind {
        /// The joint that mimics.
        joint: String,
        /// The joint that is mimicked.
        target: String,
        /// The kind that is in the way.
        kind: &'static str,
    },
    /// A shape that is not known.
    #[error("{item}: geometry <{kind}> is not supported")]
    UnsupportedGeometry {
        /// The link and its collision element.
        item: String,
        /// The element's name.
        kind: String,
    },
    /// Numbers that are no shape.
    #[error("{item}: {source}")]
    Shape {
        /// The link and its collision element.
        item: String,
        /// Why.
        source: InvalidShape,
    },
    /// The resolver has no such mesh.
    #[error("{item}: mesh {filename:?} is not available: {reason}")]
    MeshUnavailable {
        /// The link and its collision element.
        item: String,
        /// As the URDF writes it.
        filename: String,
        /// What the resolver says.
        reason: String,
    },
    /// The mesh's bytes are wrong.
    #[error("{item}: mesh {filename:?}: {source}")]
    Mesh {
        /// The link and its collision element.
        item: String,
        /// As the URDF writes it.
        filename: String,
        /// Why.
        source: MeshFileError,
    },
    /// A group that contains itself.
    #[error("group {group:?} contains itself, directly or by way of others")]
    GroupCycle {
        /// The group.
        group: String,
    },
}
