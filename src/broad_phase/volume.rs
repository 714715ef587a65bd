//! What must a bounding volume be able to do so that the dynamic tree can hold it?
//!
//! The tree knows a volume in three forms. The *volume* itself, in `f64`, decides what is reported. Its *bound*, in `f32`,
//! holds it and is what nodes keep and compare. *Lanes* are the bounds of the eight children of a node, laid out so that
//! one question is held against all eight at once. A further volume is three types and the functions below; everything
//! else (insertion, splits, moves, building, maintenance, traversals, health) is written once over this trait.
//! `sphere.rs` is the shortest example; `kdop.rs` and `obb.rs` compare eight at once.

use std::fmt::Debug;

/// Children of a node, and entries of a leaf.
pub const LANES: usize = 8;

/// Which lanes of a node meet a probe, a bit each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Meeting {
    /// Lanes that may meet it: every lane whose volume does is among them.
    pub maybe: u8,
    /// Lanes whose volumes certainly do, so that the exact comparison need not be made. A subset of `maybe`; zero is
    /// always right.
    pub surely: u8,
}

/// A volume that bounds something, and that bounds of volumes can be joined to bound many.
///
/// Finite volumes that are not empty, metres. Nothing here may round the wrong way: a bound that does not hold its
/// volume, or a lane wrongly left out of [`Meeting::maybe`], loses pairs.
pub trait BoundingVolume: Copy + PartialEq + Debug {
    /// Holds one volume, or several, in single precision.
    type Bound: Copy + PartialEq + Debug;
    /// The bounds of eight children. Lanes without a child are empty.
    type Lanes: Clone + Debug;
    /// A volume or bound made ready for being held against many lanes.
    type Probe;

    /// A bound that holds this volume.
    fn bound(&self) -> Self::Bound;
    /// Whether the closed volumes have a point in common: this decides what is reported. A volume for which that is not
    /// decided exactly says what more it reports; it leaves nothing out, and the order of the two does not matter.
    fn overlaps(&self, other: &Self) -> bool;
    /// The volume as a question.
    fn probe(&self) -> Self::Probe;
    /// A bound as a question: whatever meets something within the bound is among the lanes that may meet it, and those
    /// that surely do meet every volume that has this bound.
    fn probe_of(bound: &Self::Bound) -> Self::Probe;

    /// The bound that holds nothing: joined with another it gives that other one. Only ever asked for unions.
    fn nothing() -> Self::Bound;

    /// A bound that holds both.
    fn union(a: &Self::Bound, b: &Self::Bound) -> Self::Bound;
    /// Whether every volume within `inner` is known to be within `outer`. A bound holds itself and what it was joined of.
    fn holds(outer: &Self::Bound, inner: &Self::Bound) -> bool;
    /// What a traversal pays for a bound: in proportion to its surface, finite, and never less for a larger one.
    fn cost(bound: &Self::Bound) -> f32;
    /// Where the bound is, finite; in any unit, as long as it is the same for all.
    fn centre(bound: &Self::Bound) -> [f32; 3];

    /// Lanes without any child.
    fn no_lanes() -> Self::Lanes;
    /// Puts a bound into a lane.
    fn put(lanes: &mut Self::Lanes, lane: usize, bound: &Self::Bound);
    /// Empties a lane.
    fn clear(lanes: &mut Self::Lanes, lane: usize);
    /// The bound in a lane that is not empty.
    fn get(lanes: &Self::Lanes, lane: usize) -> Self::Bound;
    /// A bound that holds all of the first `count` lanes, at least one.
    fn joined(lanes: &Self::Lanes, count: usize) -> Self::Bound {
        (1..count).fold(Self::get(lanes, 0), |all, lane| Self::union(&all, &Self::get(lanes, lane)))
    }
    /// Which lanes meet the probe. Empty lanes never do.
    fn meeting(lanes: &Self::Lanes, probe: &Self::Probe) -> Meeting;
    /// What each of the first `count` lanes would cost with another bound taken in, and by how much more than now. What
    /// stands in the other lanes does not matter.
    fn growth(lanes: &Self::Lanes, count: usize, bound: &Self::Bound) -> Growth {
        let mut growth = Growth { after: [0.0; LANES], by: [0.0; LANES] };
        for lane in 0..count {
            let before = Self::get(lanes, lane);
            growth.after[lane] = Self::cost(&Self::union(&before, bound));
            growth.by[lane] = growth.after[lane] - Self::cost(&before);
        }
        growth
    }
}

/// What taking in another bound makes of each lane.
#[derive(Clone, Copy, Debug)]
pub struct Growth {
    /// The cost it then has.
    pub after: [f32; LANES],
    /// The cost it then has, less the one it has now.
    pub by: [f32; LANES],
}
