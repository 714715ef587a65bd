//! The gRPC door: services of `proto/clearance/v1`, health and reflection over HTTP/2.
//!
//! A handler hands its message to `transports::requests`. Caps are the service's; sizes of messages are set in `door`; the caller's deadline is ours to keep (`grpc_timeout`), because tonic's own answers CANCELLED.

mod access;
mod address;
mod assets;
mod bucket;
mod bulk;
mod certificate;
mod client;
mod clients;
mod connection;
mod contacts;
mod credentials;
mod door;
mod echo;
mod gate;
mod gate_body;
mod grpc_timeout;
mod handlers;
mod incoming;
mod items;
mod outcome;
mod queries;
mod refusal;
mod robots;
mod scenes;
mod server;
mod status;
mod streams;
mod tls;
mod tokens;
mod web;

pub use access::Scope;
pub use bulk::{BulkClient, BulkStates, BulkVerdicts};
pub use client::{
    Client, ClientError, Messages, Refusal, RemoteAttachment, RemoteEdit, RemoteOverlay, RemoteRobot, RemoteServer, Way,
};
pub use credentials::{Bearer, Credentials, Identity};
pub use door::{BindError, Config, Listening};
pub use echo::GrpcEcho;
pub use status::status_of;
pub use tls::{TlsError, TlsFiles};
pub use tokens::{Secret, TokenError, TokenSource};
pub use web::BadOrigin;
