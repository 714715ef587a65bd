//! The shared-memory door: requests and answers as columns in memory that both processes see, by iceoryx2.
//!
//! `layout` says where everything stands, `sections` reads and writes columns, `request` and `subjects` read questions,
//! `answer` writes answers; `message` and `reply` are the client's side of the same. `door` opens and closes, its
//! `attendant` answers. A segment is hostile: it is copied once, and what is checked and used is the copy.

mod answer;
mod attendant;
mod client;
mod codes;
mod door;
mod echo;
mod endpoint;
pub mod layout;
mod message;
mod questions;
mod reply;
mod request;
mod sections;
mod space;
mod subjects;

pub use client::{Client, ClientError, Options};
pub use door::{BindError, Config, Listening};
pub use echo::SharedMemoryEcho;
pub use endpoint::{BadEndpoint, Endpoint};
pub use message::{Ask, Envelope, PlainShape, PlainSubject, call_message, request_message};
pub use reply::{Refusal, Reply};
pub use request::{Called, ClientId, Nonce, Question, Received, Request, decode};
pub use sections::Malformed;
pub use space::NoSpace;
