//! Why a shape was refused.

use super::InvalidPose;

/// Why numbers were refused as a shape. Each text names the field, so that a caller needs only to add which item it was.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum InvalidShape {
    /// NaN or an infinity where a number is needed.
    #[error("{field} is not finite")]
    NotFinite {
        /// The field, for example `half_extents.x` or `points[3]`.
        field: String,
    },
    /// A length below zero.
    #[error("{field} is negative: {value}")]
    Negative {
        /// The field.
        field: String,
        /// What was given, metres.
        value: f64,
    },
    /// Numbers so large that squares of lengths overflow.
    #[error("{field} is beyond {limit:e} m: {value:e}")]
    TooLarge {
        /// The field.
        field: String,
        /// What was given, metres.
        value: f64,
        /// The largest accepted size, metres.
        limit: f64,
    },
    /// A shape made of nothing.
    #[error("{field} is empty")]
    Empty {
        /// The field.
        field: &'static str,
    },
    /// Zero where a length above zero is needed.
    #[error("{field} is not positive: {value}")]
    NotPositive {
        /// The field.
        field: &'static str,
        /// What was given, metres.
        value: f64,
    },
    /// Too little to be a shape.
    #[error("{field} is {count}, at least {least} are needed")]
    TooFew {
        /// The field.
        field: &'static str,
        /// What was given.
        count: usize,
        /// How many there must be.
        least: usize,
    },
    /// More than can be counted.
    #[error("{field} has more than {limit} elements")]
    TooMany {
        /// The field.
        field: &'static str,
        /// How many there may be.
        limit: u64,
    },
    /// A list whose length follows from other fields, and is another.
    #[error("{field} has {count} numbers, {wanted} are needed")]
    WrongCount {
        /// The field.
        field: &'static str,
        /// What was given.
        count: usize,
        /// What the other fields ask for.
        wanted: usize,
    },
    /// A height below the floor of its field.
    #[error("heights[{sample}] is below the floor: {height} < {floor}")]
    BelowFloor {
        /// Which height.
        sample: usize,
        /// As it was given, metres.
        height: f64,
        /// Height of the floor, metres.
        floor: f64,
    },
    /// A mesh that is a point, or one on which the decomposition gives up.
    #[error("the mesh has no extent, or cannot be cut into convex pieces")]
    NotDecomposed,
    /// A box whose least corner is above its greatest.
    #[error("min.{axis} is above max.{axis}")]
    UpsideDown {
        /// Along which axis.
        axis: &'static str,
    },
    /// A normal without a direction.
    #[error("normal is zero")]
    ZeroNormal,
    /// A triangle that names a vertex which is not there.
    #[error("triangles[{triangle}] names vertex {index}, but there are {vertices} vertices")]
    BadIndex {
        /// Which triangle.
        triangle: usize,
        /// The vertex it names.
        index: u32,
        /// How many there are.
        vertices: usize,
    },
    /// A mesh declared solid whose surface is not closed: an edge without its opposite.
    #[error(
        "mesh is not closed, so it cannot be solid: edge {from} -> {to} has {opposite} opposite edges, 1 is needed"
    )]
    NotClosed {
        /// First vertex of the edge (after equal vertices were merged).
        from: u32,
        /// Second vertex of the edge.
        to: u32,
        /// How often the opposite edge occurs.
        opposite: usize,
    },
    /// A mesh declared solid whose triangles face inwards.
    #[error("mesh faces inwards, so it cannot be solid: its signed volume is {volume:e} m^3")]
    InsideOut {
        /// Signed volume, cubic metres.
        volume: f64,
    },
    /// A part of a compound, or a scaled or padded shape, that may not be there.
    #[error("{field} is a {kind}, which cannot be {role}")]
    NotAllowed {
        /// The field.
        field: String,
        /// Its kind.
        kind: &'static str,
        /// What it was to be.
        role: &'static str,
    },
    /// The pose of a part is wrong.
    #[error("{field}: {source}")]
    Pose {
        /// The field.
        field: String,
        /// What is wrong with it.
        source: InvalidPose,
    },
    /// A part of a compound is wrong.
    #[error("parts[{part}]: {source}")]
    Part {
        /// Which part.
        part: usize,
        /// What is wrong with it.
        source: Box<InvalidShape>,
    },
}
