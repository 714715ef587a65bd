//! Questions to a snapshot of a scene, and their answers. Pure: no threads, clocks, files or network.

mod answer;
mod batch;
mod changed_pairs;
mod contact_tracker;
mod contacts;
mod context;
mod motion_course;
mod motion_measure;
mod motions;
mod pairs;
mod request;
mod robot_parts;
mod search;
mod states;
mod verdict;

pub use answer::{Answer, Indeterminacy, ItemAnswer, MotionAnswer, PairAnswer, Refused, Side, Verdict, Witness};
pub use batch::{Part, Prepared};
pub use contact_tracker::ContactTracker;
pub use contacts::{
    ContactChanges, ContactEvent, ContactEventKind, ContactQuestion, ContactState, EndReason, NotAdvanced, Threshold,
};
pub use request::{
    CheckMotions, CheckStates, Clearance, ClearanceOf, Context, Filter, Find, Mode, Motions, PairQuery, Subject, Wants,
};
