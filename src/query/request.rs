//! What may be asked. Plain data: a transport decodes into these structs once, and nothing below sees bytes again.

use crate::geometry::{Pose, Shape};
use crate::narrow_phase::{Accuracy, DerivativeGoal, MOST_POINTS, Solver};
use crate::scene::{BodyId, Revision};

/// Outputs a request wants beside the verdict, which is always given. Only what is wanted is computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wants {
    /// The bracket of the minimum, and the pair it belongs to; for states also the minima against itself and against
    /// the scene.
    pub distance: bool,
    /// Points and normal of the deciding pair; includes `distance`.
    pub witness: bool,
    /// A tight bracket and witness in an overlap too; includes `distance`. Without it an overlap gets a valid loose
    /// bracket with `upper <= 0`.
    pub depth: bool,
    /// Every pair that collides or is within the margin, as far as the limit on pairs allows.
    pub pairs: bool,
    /// Where the faces of pairs touch that are told and not proved apart by more than their margin; includes `witness` and
    /// `depth`.
    pub patch: bool,
    /// How pairs that are told change when their bodies move, wherever they have a witness; includes `witness`.
    pub derivatives: bool,
}

impl Wants {
    /// The verdict alone.
    pub const VERDICT: Self =
        Self { distance: false, witness: false, depth: false, pairs: false, patch: false, derivatives: false };

    /// Everything there is.
    pub const ALL: Self =
        Self { distance: true, witness: true, depth: true, pairs: true, patch: true, derivatives: true };

    /// The wants with what they include.
    #[must_use]
    pub fn closed(self) -> Self {
        let (witness, depth) = (self.witness || self.patch || self.derivatives, self.depth || self.patch);
        Self { distance: self.distance || witness || depth, witness, depth, ..self }
    }
}

/// Which pairs count.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Filter {
    /// Look only at bodies of these groups; empty: at all.
    pub groups: Vec<String>,
    /// Leave these bodies out.
    pub ignore: Vec<BodyId>,
    /// Look at pairs that the scene's allowed-collision matrix allows to collide, too.
    pub disregard_allowed_collisions: bool,
    /// For a bare shape: the layers it is in, one bit each; `None`: all. For a body its own count.
    pub layers: Option<u32>,
    /// For a bare shape: the layers it collides with; `None`: all.
    pub mask: Option<u32>,
}

/// What every query carries beside its items.
#[derive(Clone, Debug, PartialEq)]
pub struct Context {
    /// What to compute.
    pub wants: Wants,
    /// A pair nearer than this, but apart, is `MARGIN`; metres, not negative. A scene's entry for a pair replaces it.
    pub margin: f64,
    /// Pairs farther than this need no distance; metres. An answer without a pair within it has no bracket.
    pub cut_off: Option<f64>,
    /// How narrow brackets have to be where `distance` is wanted.
    pub accuracy: Accuracy,
    /// Who measures each pair. A pair that the solver does not take makes its item invalid.
    pub solver: Solver,
    /// Which pairs count.
    pub filter: Filter,
    /// Pairs listed per item at most; more set the answer's `truncated`.
    pub max_pairs: usize,
    /// Points of a contact patch at most, from 1 to [`MOST_POINTS`]; a patch that has more corners says so.
    pub max_patch_points: usize,
    /// How derivatives are made, where they are wanted. Each pair has a stream of its own, whatever is said here.
    pub derivatives: DerivativeGoal,
}

impl Default for Context {
    fn default() -> Self {
        Self {
            wants: Wants::VERDICT,
            margin: 0.0,
            cut_off: None,
            accuracy: Accuracy::default(),
            solver: Solver::Default,
            filter: Filter::default(),
            max_pairs: 100,
            max_patch_points: MOST_POINTS,
            derivatives: DerivativeGoal::default(),
        }
    }
}

/// All items, or up to the first that is not free.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// A verdict for every item.
    #[default]
    All,
    /// Items in order until one collides or cannot be decided; the rest are `NOT_RUN`. The answer says which it was.
    StopAtFirst,
}

/// Is the robot free in these states?
#[derive(Clone, Debug, PartialEq)]
pub struct CheckStates {
    /// The robot's name in the scene.
    pub robot: String,
    /// Joint positions, state after state, each in the order of the robot's joints; radians or metres.
    pub positions: Vec<f64>,
    /// All states or up to the first hit.
    pub mode: Mode,
    /// The rest.
    pub context: Context,
}

/// Which position vectors are the ends of a motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Motions {
    /// Start and goal of each, one after the other: start, goal, start, goal.
    #[default]
    Edges,
    /// Waypoints of a path: each motion starts where the one before it ends.
    Path,
}

/// What is wanted of a motion that collides.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Find {
    /// The first contact, in a bracket as narrow as the resolution: all before it is proved free.
    #[default]
    FirstContact,
    /// That there is one; the bracket is as wide as it was when the first contact was met.
    AnyContact,
}

/// Is the robot free all along these motions?
#[derive(Clone, Debug, PartialEq)]
pub struct CheckMotions {
    /// The robot's name in the scene.
    pub robot: String,
    /// Joint positions, vector after vector, each in the order of the robot's joints; radians or metres. A motion is the straight
    /// line between two of them: `start + t (goal - start)` in every number; joints without limits are not wrapped.
    pub positions: Vec<f64>,
    /// How they make motions.
    pub motions: Motions,
    /// All motions or up to the first that is blocked.
    pub mode: Mode,
    /// How much is wanted of a contact.
    pub find: Find,
    /// A pair whose parts move by no more than this between two states, and that is not proved free between them, is
    /// left undecided there; metres, positive.
    pub resolution: f64,
    /// States that are looked at for one motion, at most; then the rest is undecided.
    pub max_states: usize,
    /// The rest.
    pub context: Context,
}

impl CheckMotions {
    /// Metres.
    pub const DEFAULT_RESOLUTION: f64 = 1e-4;

    /// States for one motion.
    pub const DEFAULT_MAX_STATES: usize = 4096;
}

/// What is held against the scene.
#[derive(Clone, Debug)]
pub enum Subject {
    /// Every pair of bodies of the scene.
    All,
    /// Every pair of bodies that changed after this revision: a side of it was added, moved, reshaped, put in other
    /// layers or groups, or enabled, or an entry for pairs that speaks of it was made, replaced or taken back. Each pair
    /// once.
    ChangedSince(Revision),
    /// One body against the others.
    Body(BodyId),
    /// A shape that is not in the scene, placed in the world, against all bodies.
    Shape {
        /// The shape.
        shape: Shape,
        /// Its frame in the world.
        pose: Pose,
    },
}

impl Subject {
    /// The body, if it is one body of the scene.
    #[must_use]
    pub fn body(&self) -> Option<BodyId> {
        match self {
            Self::Body(id) => Some(*id),
            Self::All | Self::ChangedSince(_) | Self::Shape { .. } => None,
        }
    }
}

/// Which pairs are within a distance? Every one of them with its bracket, where the other questions want the nearest.
#[derive(Clone, Debug)]
pub struct Clearance {
    /// What is held against the scene; the context's want `distance` or more is added, `cut_off` does not count.
    pub subjects: ClearanceOf,
    /// Metres, not negative: pairs proved farther apart than this are left out.
    pub within: f64,
}

/// Whose clearance.
#[derive(Clone, Debug)]
pub enum ClearanceOf {
    /// A robot's in some states, against itself and the scene.
    States(CheckStates),
    /// Bodies' and bare shapes'.
    Subjects(PairQuery),
}

/// What touches (with `Collide`), or how far is the nearest (with `Distance`)?
#[derive(Clone, Debug)]
pub struct PairQuery {
    /// Answered one by one, in order.
    pub items: Vec<Subject>,
    /// All items or up to the first hit.
    pub mode: Mode,
    /// The rest. `Distance` adds the want `distance`, `Collide` the want `pairs`.
    pub context: Context,
}
