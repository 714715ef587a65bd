//! How does a Rust program ask a daemon? The generated clients behind the library's own words: plain structs in and out,
//! as if the service were in the same process. Streams speak the messages themselves.

#[expect(clippy::module_inception, reason = "the type of that name is in it")]
mod client;
mod edits;
mod error;
mod questions;
mod streams;

pub(super) use client::WINDOW;
pub use client::{Client, RemoteRobot, RemoteServer, Way};
pub use edits::{RemoteAttachment, RemoteEdit, RemoteOverlay};
pub use error::{ClientError, Refusal};
pub use streams::Messages;
