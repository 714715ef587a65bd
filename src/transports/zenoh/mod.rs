//! The zenoh door: calls are queries, poses are puts, steps of scenes are publications, and who is there is a liveliness token.
//!
//! `keys` and `selector` say what is asked, `config` how the daemon stands in the network; `door` opens and closes. `calls` answers
//! queries for as long as `callers` are there, `poses` takes puts, `changes` publishes. `client` and `follower` are the other side.
//! `docs/zenoh.md` is the protocol.

mod callers;
mod calls;
mod changes;
mod client;
mod config;
mod door;
mod echo;
mod follower;
mod keys;
mod poses;
mod selector;

pub use client::{Client, ClientError, Refusal, Watch};
pub use config::{BadConfig, Config};
pub use door::{BindError, Listening};
pub use echo::ZenohEcho;
pub use follower::Follower;
pub use keys::{BadPrefix, Keys, Of, Posed, is_client_id};
pub use selector::Selected;
