//! Questions to a snapshot of a scene, and their answers. Pure: no threads, clocks, files or network.

mod answer;
mod batch;
mod changed_pairs;
mod contact_tracker;
mod contacts;
mod context;
mod pairs;
mod request;
mod robot_parts;
mod search;
mod states;
mod verdict;

pub use answer::{Answer, Indeterminacy, ItemAnswer, PairAnswer, Refused, Side, Verdict, Witness};
pub use batch::{Part, Prepared};
pub use contact_tracker::ContactTracker;
pub use contacts::{
    ContactChanges, ContactEvent, ContactEventKind, ContactQuestion, ContactState, EndReason, NotAdvanced, Threshold,
};
pub use request::{CheckStates, Context, Filter, Mode, PairQuery, Subject, Wants};
