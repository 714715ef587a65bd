//! Which function answers an rpc that is named in words? For doors that carry any message as bytes.

use std::sync::Arc;
use std::time::Duration;

use prost::Message;
use prost::bytes::Bytes;

use super::*;
use crate::service::{ContentHash, Service, ServiceError};
use crate::transports::wire::v1;
use crate::transports::wire::v1::put_asset_request::Part;

/// The answer to a unary rpc, as bytes of its response message. `rpc` is `SERVICE/METHOD`, for example `Queries/Collide`;
/// `message` the bytes of its request message, or, of `Assets/PutAsset`, those of the stream's messages, each behind its
/// length as a varint.
///
/// # Errors
/// An rpc that is not there or streams its answers, bytes that are no such message, or what the service says.
pub async fn call(
    service: &Arc<Service>,
    rpc: &str,
    message: Bytes,
    timeout: Option<Duration>,
) -> Result<Vec<u8>, ServiceError> {
    let call = Call { service, message, timeout };
    match rpc {
        "Scenes/CreateScene" => call.at_once(|service, message| create_scene(service, &message)),
        "Scenes/ListScenes" => call.at_once(|service, _: v1::ListScenesRequest| Ok(list_scenes(service))),
        "Scenes/GetScene" => call.waiting(get_scene).await,
        "Scenes/GetSceneHealth" => {
            call.waiting(async |service, message, _| get_scene_health(service, message).await).await
        }
        "Scenes/DeleteScene" => call.at_once(|service, message| delete_scene(service, &message)),
        "Scenes/Apply" => call.waiting(apply).await,
        "Assets/HasAssets" => call.at_once(|service, message| has_assets(service, &message)),
        "Assets/PutAsset" => call.upload().await,
        "Assets/DescribeMesh" => {
            call.waiting(async |service, message, timeout| describe_mesh(service, &message, timeout).await).await
        }
        "Robots/LoadRobot" => call.waiting(async |service, message, _| load_robot(service, message).await).await,
        "Robots/ListRobots" => call.at_once(|service, _: v1::ListRobotsRequest| Ok(list_robots(service))),
        "Robots/GetRobot" => call.at_once(|service, message| get_robot(service, &message)),
        "Queries/CheckStates" => call.waiting(check_states).await,
        "Queries/Collide" => call.waiting(collide).await,
        "Queries/Distance" => call.waiting(distance).await,
        "Queries/CastRays" => call.waiting(cast_rays).await,
        "Queries/CastShapes" => call.waiting(cast_shapes).await,
        "Queries/CheckMovingPairs" => call.waiting(check_moving_pairs).await,
        "Queries/Overlap" => call.waiting(overlap).await,
        "Queries/NearestBodies" => call.waiting(nearest_bodies).await,
        "Queries/CheckMotions" => call.waiting(check_motions).await,
        "Queries/CheckPath" => call.waiting(check_path).await,
        "Queries/Clearance" => call.waiting(clearance).await,
        "Queries/Estimate" => call.waiting(estimate).await,
        "Server/GetServerInfo" => call.at_once(|service, _: v1::GetServerInfoRequest| Ok(get_server_info(service))),
        _ => Err(ServiceError::invalid("rpc", format!("{rpc:?} is none that is answered with one message"))),
    }
}

/// A call whose function is being looked for.
struct Call<'a> {
    service: &'a Arc<Service>,
    message: Bytes,
    timeout: Option<Duration>,
}

impl Call<'_> {
    fn at_once<M: Message + Default, T: Message>(
        self,
        answer: impl FnOnce(&Arc<Service>, M) -> Result<T, ServiceError>,
    ) -> Result<Vec<u8>, ServiceError> {
        Ok(answer(self.service, decoded(self.message)?)?.encode_to_vec())
    }

    async fn waiting<M: Message + Default, T: Message>(
        self,
        answer: impl AsyncFnOnce(&Arc<Service>, M, Option<Duration>) -> Result<T, ServiceError>,
    ) -> Result<Vec<u8>, ServiceError> {
        Ok(answer(self.service, decoded(self.message)?, self.timeout).await?.encode_to_vec())
    }

    /// What a stream of `PutAssetRequest` is to gRPC.
    async fn upload(mut self) -> Result<Vec<u8>, ServiceError> {
        let Some(Part::Header(v1::AssetHeader { sha256, bytes })) = self.part()? else {
            return Err(ServiceError::invalid("header", "is missing: it has to be the first message"));
        };
        let hash: ContentHash = sha256.parse().map_err(|error| ServiceError::invalid("header.sha256", error))?;
        let mut upload = self.service.begin_upload(hash, bytes)?;
        while !self.message.is_empty() {
            let Some(Part::Chunk(chunk)) = self.part()? else {
                return Err(ServiceError::invalid("chunk", "is missing: only the first message is a header"));
            };
            upload.push(&chunk)?;
        }
        Ok(put_asset_response(&self.service.finish_upload(upload).await?).encode_to_vec())
    }

    /// The next message of an upload.
    fn part(&mut self) -> Result<Option<Part>, ServiceError> {
        let message = v1::PutAssetRequest::decode_length_delimited(&mut self.message);
        Ok(message.map_err(|error| ServiceError::invalid("message", error))?.part)
    }
}

pub(super) fn decoded<M: Message + Default>(message: Bytes) -> Result<M, ServiceError> {
    M::decode(message).map_err(|error| ServiceError::invalid("message", error))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::service::Config;
    use crate::transports::wire::descriptors::{Method, methods};
    use crate::transports::wire::v1::DESCRIPTORS;

    #[tokio::test]
    async fn every_rpc_that_answers_with_one_message_is_found_and_no_other() {
        let service = Service::new(&Config { threads: 1, ..Config::default() }).unwrap();
        let (mut found, mut not_found) = (0, 0);
        for Method { service: name, method, streams_answers } in methods(DESCRIPTORS) {
            let rpc = format!("{}/{method}", name.strip_prefix("clearance.v1.").unwrap());
            let outcome = call(&service, &rpc, Bytes::new(), None).await;
            let unknown = matches!(&outcome, Err(ServiceError::Invalid { field, .. }) if field == "rpc");
            assert_eq!(unknown, streams_answers, "{rpc}: {outcome:?}");
            if unknown { not_found += 1 } else { found += 1 }
        }
        assert_eq!((found, not_found), (25, 4));
    }

    #[tokio::test]
    async fn bytes_that_are_no_message_are_told_so() {
        let service = Service::new(&Config { threads: 1, ..Config::default() }).unwrap();
        for (rpc, bytes) in [("Queries/Collide", "\x0a\x05x"), ("Assets/PutAsset", "\x09x")] {
            let error = call(&service, rpc, Bytes::from_static(bytes.as_bytes()), None).await.unwrap_err();
            assert!(matches!(&error, ServiceError::Invalid { field, .. } if field == "message"), "{error:?}");
        }
    }
}
