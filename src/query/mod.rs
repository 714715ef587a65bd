//! Questions to a snapshot of a scene, and their answers. Pure: no threads, clocks, files or network.

mod answer;
mod batch;
mod context;
mod mesh_card;
mod pairs;
mod request;
mod search;
mod states;
mod verdict;

pub use answer::{Answer, Indeterminacy, ItemAnswer, PairAnswer, Refused, Side, Verdict, Witness};
pub use batch::{Part, Prepared};
pub use mesh_card::MeshCard;
pub use request::{CheckStates, Context, Filter, Mode, PairQuery, Subject, Wants};
