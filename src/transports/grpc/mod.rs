//! The gRPC door: services of `proto/clearance/v1`, health and reflection over HTTP/2.
//!
//! A handler hands its message to `transports::requests`. Caps are the service's; sizes of messages are set in `door`; the caller's deadline is ours to keep (`grpc_timeout`), because tonic's own answers CANCELLED.

mod assets;
mod client;
mod contacts;
mod door;
mod grpc_timeout;
mod handlers;
mod queries;
mod robots;
mod scenes;
mod server;
mod status;

pub use client::{Client, ClientError, RemoteEdit, RemoteRobot, RemoteServer};
pub use door::{BindError, Config, Listening};
pub use status::status_of;
