//! The shared-memory door: the same numbers as through gRPC, hostile segments, faults of processes, the C header.

mod equality;
mod faults;
mod header;
mod hostile;
mod limits;
mod place;
