//! What is answered. Sorted and deterministic: equal questions to equal snapshots get equal bytes.

use super::declared::Coverage;
use crate::geometry::Vec3;
use crate::narrow_phase::{Bracket, ContactPatch, Cost, Derivatives, Termination};
use crate::scene::{BodyId, Effect, Epoch, Party, Revision};

/// What the bracket decides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Proved apart, farther than the margin.
    Free,
    /// Proved apart, and proved within the margin.
    Margin,
    /// Proved to touch or overlap.
    Collision,
    /// The bracket straddles the decision.
    Indeterminate(Indeterminacy),
    /// Not looked at: an earlier item stopped the batch, or the time ran out.
    NotRun,
    /// The item cannot be asked; [`ItemAnswer::problem`] names the field.
    InvalidInput,
}

/// Why a bracket straddles the decision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Indeterminacy {
    /// The numbers as given do not decide it within the rounding of `f64`.
    Rounding,
    /// The cap on iterations was reached first.
    IterationLimit,
    /// The time ran out first.
    TimeLimit,
    /// Of motions: a pair came nearer to contact, or to its margin, than the resolution, and no state that was looked at decides.
    Resolution,
}

/// One side of a pair.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Side {
    /// A link of the robot that was asked about: its index in the robot's links.
    Link {
        /// Index in the robot's links.
        link: u32,
        /// Which of the link's shapes.
        shape: u32,
        /// Triangle of a mesh or part of a compound.
        subshape: u32,
    },
    /// The bare shape of the question.
    Query {
        /// Triangle of a mesh or part of a compound.
        subshape: u32,
    },
    /// A body of the scene.
    Body {
        /// Its id.
        id: BodyId,
        /// Triangle of a mesh or part of a compound.
        subshape: u32,
    },
}

impl Side {
    /// The same side, down to one of its triangles or parts.
    #[must_use]
    pub fn with_subshape(&self, subshape: u32) -> Self {
        match *self {
            Self::Link { link, shape, .. } => Self::Link { link, shape, subshape },
            Self::Query { .. } => Self::Query { subshape },
            Self::Body { id, .. } => Self::Body { id, subshape },
        }
    }
}

/// Points and normal of a pair, world frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Witness {
    /// On side A, metres.
    pub point_on_a: Vec3,
    /// On side B, metres.
    pub point_on_b: Vec3,
    /// Unit vector from A to B.
    pub normal: Vec3,
    /// How far at most either point is from its shape; and, apart, the vector between them from the true nearest vector.
    /// Metres.
    pub point_error: f64,
    /// By how much at most the normal is turned from the true nearest vector, radians; pi where nothing is known, as in an
    /// overlap.
    pub normal_error: f64,
}

/// How a pair changes when its bodies move.
#[derive(Clone, Debug, PartialEq)]
pub struct PairDerivatives {
    /// With respect to twists of both sides about their own origins, in the world's axes. A link's origin is that of its frame, and a body's that a
    /// link holds is the link's.
    pub twists: Derivatives,
    /// Of pairs with a side that is a robot's, in questions about its states: the gradient of the signed distance with respect to the joints'
    /// positions, one number for each; metres per radian, or per metre. Else empty.
    pub joints: Vec<f64>,
}

/// What is known about one pair.
#[derive(Clone, Debug, PartialEq)]
pub struct PairAnswer {
    /// The robot's link or the query's shape if there is one, else the lower id.
    pub a: Side,
    /// The other side.
    pub b: Side,
    /// Of this pair alone.
    pub verdict: Verdict,
    /// The proof.
    pub bracket: Bracket,
    /// Best estimate inside the bracket, metres.
    pub signed_distance: f64,
    /// Where wanted; in an overlap only when its depth was wanted too.
    pub witness: Option<Witness>,
    /// Where wanted, of a pair that is not proved apart by more than its margin: where the faces of the two convex pieces
    /// touch that `a` and `b` name. None for a piece that is no single convex one, as of a mesh within a compound.
    pub patch: Option<Box<ContactPatch>>,
    /// Where wanted, of a pair that has a witness: how it changes when its bodies move. None for a piece that is no single convex one.
    pub derivatives: Option<Box<PairDerivatives>>,
    /// How the work on the pair stopped.
    pub termination: Termination,
}

/// Which part of a motion is proved. Times are fractions of it: 0 at the start, 1 at the goal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionAnswer {
    /// Every state before this time is proved free, farther than the margins. 1 for a motion that is `FREE`.
    pub free_until: f64,
    /// Of a `COLLISION`: every state before the first time is proved apart, and the state at the second is proved in
    /// collision, so that the first contact is between them. Of a `MARGIN`: the same for coming within a margin. The pair of
    /// [`ItemAnswer::nearest`] is in the state at the second time.
    pub reached: Option<[f64; 2]>,
    /// Of an `INDETERMINATE`: the first stretch that is not proved, and that no state decides. The pair of
    /// [`ItemAnswer::nearest`] is in the state at its start.
    pub undecided: Option<[f64; 2]>,
    /// States that pairs were measured in.
    pub states: u64,
    /// Stretches of time that were proved, halved or given up.
    pub intervals: u64,
}

/// The answer to one item.
#[derive(Clone, Debug, PartialEq)]
pub struct ItemAnswer {
    /// The first that applies to any pair in the order collision, indeterminate, margin, free.
    pub verdict: Verdict,
    /// Wanted distance: the pair of least signed distance, with the bracket of the minimum over all pairs; none when there was no pair to look at or none within the
    /// cut-off. Wanted verdict alone: the pair that decided, if one did.
    pub nearest: Option<PairAnswer>,
    /// Of states, wanted distance: the nearest pair of two links.
    pub nearest_self: Option<PairAnswer>,
    /// Of states, wanted distance: the nearest pair of a link and a body.
    pub nearest_scene: Option<PairAnswer>,
    /// Where wanted: the pairs that collide, cannot be decided or are within the margin, in order of their sides.
    pub pairs: Vec<PairAnswer>,
    /// Of an invalid item: which field, and what is wrong with it.
    pub problem: Option<String>,
    /// More pairs were there than the limit lets through.
    pub truncated: bool,
    /// Of motions: which part of them is proved.
    pub motion: Option<MotionAnswer>,
    /// What it cost.
    pub cost: Cost,
}

impl ItemAnswer {
    /// An item that no work was done for.
    #[must_use]
    pub fn without_work(verdict: Verdict) -> Self {
        Self {
            verdict,
            nearest: None,
            nearest_self: None,
            nearest_scene: None,
            pairs: Vec::new(),
            problem: None,
            truncated: false,
            motion: None,
            cost: Cost::default(),
        }
    }
}

/// The answer to a request.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// Which life of the scene was asked.
    pub epoch: Epoch,
    /// Which state of it.
    pub revision: Revision,
    /// One for each item of the request, in its order.
    pub items: Vec<ItemAnswer>,
    /// In `StopAtFirst`: the index of the item that stopped the batch.
    pub stopped_at: Option<usize>,
    /// The time ran out before every item was looked at; those are `NOT_RUN`.
    pub out_of_time: bool,
    /// What none of the items says anything about.
    pub coverage: Coverage,
    /// Sum over the items.
    pub cost: Cost,
}

impl Answer {
    /// The answer as it is compared: the same for equal questions to equal snapshots, whatever the number of threads, the
    /// door, the broad phase, and the edits that led to the snapshot. It leaves out how many nodes of trees were opened,
    /// the only figure that depends on how the broad phase came about.
    #[must_use]
    pub fn canonical(mut self) -> Self {
        self.cost.nodes = 0;
        self.items.iter_mut().for_each(|item| item.cost.nodes = 0);
        self
    }
}

/// Why a whole request was refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refused {
    /// A field that cannot be: text names item and field.
    #[error("{field}: {problem}")]
    Invalid {
        /// For example `context.margin` or `items[3].body`.
        field: String,
        /// What is wrong with it.
        problem: String,
    },
    /// What changed since a revision is not known any more.
    #[error("what changed since revision {asked} is not known any more; the oldest that can be asked is {oldest}")]
    Gone {
        /// The revision asked for.
        asked: Revision,
        /// The oldest that can be asked of this snapshot.
        oldest: Revision,
    },
    /// Something that is not in the scene.
    #[error("no {what} {name:?} in the scene (revision {revision})")]
    NotFound {
        /// `robot`, `body`, `group`.
        what: &'static str,
        /// As it was asked for.
        name: String,
        /// Where it was looked for.
        revision: Revision,
    },
    /// An effect is wanted that the scene does not declare for a pair that the question may be about.
    #[error("the pair of {a} and {b} is declared without the effect `{effect}`, which is wanted")]
    NotDeclared {
        /// The first that is lacking.
        effect: Effect,
        /// The asker's side.
        a: Party,
        /// The other side.
        b: Party,
    },
    /// An output whose code was left out of this build.
    #[error("{field}: this build is without the effect `{effect}`")]
    NotBuilt {
        /// Where it was wanted.
        field: &'static str,
        /// Its name.
        effect: &'static str,
    },
}
