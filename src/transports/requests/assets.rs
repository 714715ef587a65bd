//! The service `Assets`, but for uploads, which each door takes in parts in its own way.

use std::sync::Arc;
use std::time::Duration;

use crate::service::{ContentHash, Patience, Service, ServiceError, Stored};
use crate::transports::wire::{from_proto, to_proto, v1};

/// # Errors
/// A hash that is none.
pub fn has_assets(service: &Service, message: &v1::HasAssetsRequest) -> Result<v1::HasAssetsResponse, ServiceError> {
    let present = |(index, hash): (usize, &String)| {
        let hash: ContentHash =
            hash.parse().map_err(|error| ServiceError::invalid(format!("sha256[{index}]"), error))?;
        Ok(service.library().assets().has(hash))
    };
    let present = message.sha256.iter().enumerate().map(present).collect::<Result<_, ServiceError>>()?;
    Ok(v1::HasAssetsResponse { present })
}

/// # Errors
/// As [`Service::mesh_card`].
pub async fn describe_mesh(
    service: &Arc<Service>,
    message: &v1::DescribeMeshRequest,
    timeout: Option<Duration>,
) -> Result<v1::DescribeMeshResponse, ServiceError> {
    let asked = from_proto::mesh_card_request(message)?;
    let patience = Patience { timeout, ..Patience::default() };
    let card = service.mesh_card(asked, patience, from_proto::unusable_mesh).await?;
    Ok(v1::DescribeMeshResponse { card: Some(to_proto::mesh_card(&card)) })
}

/// What an upload is answered with.
#[must_use]
pub fn put_asset_response(stored: &Stored) -> v1::PutAssetResponse {
    v1::PutAssetResponse {
        sha256: stored.hash.to_string(),
        bytes: stored.bytes as u64,
        already_present: stored.already_present,
    }
}
