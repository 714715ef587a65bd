//! The service `Server`.

use crate::service::Service;
use crate::transports::wire::{to_proto, v1};

/// The daemon itself.
#[must_use]
pub fn get_server_info(service: &Service) -> v1::GetServerInfoResponse {
    v1::GetServerInfoResponse {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        doors: service.doors().iter().map(to_proto::door).collect(),
        limits: service.limits().table().iter().map(to_proto::limit).collect(),
        scenes: service.scenes().iter().map(to_proto::scene_summary).collect(),
        threads: u32::try_from(service.threads()).unwrap_or(u32::MAX),
    }
}
