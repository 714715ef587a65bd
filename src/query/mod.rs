//! Questions to a snapshot of a scene, and their answers. Pure: no threads, clocks, files or network.

mod answer;
mod batch;
mod batch_question;
mod cast_answer;
mod cast_request;
#[cfg(feature = "effect-motion")]
mod casts;
mod changed_pairs;
mod contact_tracker;
mod contacts;
mod context;
mod declared;
mod derivatives;
mod item_batch;
mod mesh_card;
mod met;
#[cfg(feature = "effect-motion")]
mod motion_course;
#[cfg(feature = "effect-motion")]
mod motion_measure;
#[cfg(feature = "effect-motion")]
mod motions;
mod nearest_bodies;
#[cfg(not(feature = "effect-motion"))]
mod no_motions;
mod opponents;
mod overlap;
mod overlay;
#[cfg(feature = "effect-derivatives")]
mod pair_derivatives;
mod pairs;
mod patch;
mod rays;
mod request;
mod robot_parts;
mod search;
mod stage;
mod states;
mod verdict;

pub use answer::{
    Answer, Indeterminacy, ItemAnswer, MotionAnswer, PairAnswer, PairDerivatives, Refused, Side, Verdict, Witness,
};
pub use batch::{OneByOne, Part, Prepared};
pub use batch_question::{BatchQuestion, Output};
pub use cast_answer::{Answers, CastHit, CastItem, CastVerdict, Grazed, NearestItem, OverlapItem, Overlapping};
pub use cast_request::{
    CastMode, CastRays, CastShapes, CheckMovingPairs, DEFAULT_RESOLUTION, Moved, Mover, NearestBodies, Overlap, Region,
    Way,
};
#[cfg(feature = "effect-motion")]
pub use casts::{Casts, MovingPairs};
pub use contact_tracker::ContactTracker;
pub use contacts::{
    ContactChanges, ContactEvent, ContactEventKind, ContactQuestion, ContactState, EndReason, NotAdvanced, Threshold,
};
pub use declared::Coverage;
pub use item_batch::ItemBatch;
pub use mesh_card::MeshCard;
pub use nearest_bodies::Neighbours;
#[cfg(not(feature = "effect-motion"))]
pub use no_motions::{Casts, MovingPairs};
pub use overlap::Overlaps;
pub use overlay::{Asked, Attached, NotSupposed, Overlay, Overlays, World, Worlds, field_of};
pub use rays::Rays;
pub use request::{
    CheckMotions, CheckStates, Clearance, ClearanceOf, Context, Filter, Find, Mode, Motions, PairQuery, Subject, Wants,
};
