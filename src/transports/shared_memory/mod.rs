//! The shared-memory door: requests and answers as columns in memory that both processes see, by iceoryx2.
//!
//! `layout` says where everything stands, `sections` reads and writes columns, `request` and `subjects` read questions,
//! `answer` writes answers; `message` and `reply` are the client's side of the same. A segment is hostile: it is copied
//! once, and what is checked and used is the copy.

mod answer;
mod codes;
pub mod layout;
mod message;
mod questions;
mod reply;
mod request;
mod sections;
mod subjects;

pub use message::{Ask, PlainShape, PlainSubject};
pub use reply::{Refusal, Reply};
pub use request::{Request, decode};
pub use sections::Malformed;
