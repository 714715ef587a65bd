//! Doors that carry any message as bytes: an rpc is called by its name, and that is all such a door has to do.

use clearance::limits::Limits;
use clearance::transports::wire::v1;
use clearance::transports::wire::v1::put_asset_request::Part;
use prost::Message;

use super::door::{Door, Told};

/// Calls rpcs by their names.
#[allow(async_fn_in_trait, reason = "the tests know all implementations")]
pub trait ByName: Sized {
    async fn open_with(limits: Limits) -> Self;
    /// Request message in, response message out, as bytes.
    async fn call_bytes(&self, rpc: &'static str, message: Vec<u8>) -> Told<Vec<u8>>;

    async fn call<T: Message + Default>(&self, rpc: &'static str, message: &impl Message) -> Told<T> {
        Ok(T::decode(self.call_bytes(rpc, message.encode_to_vec()).await?.as_slice()).unwrap())
    }
}

impl<N: ByName> Door for N {
    async fn open(limits: Limits) -> Self {
        Self::open_with(limits).await
    }

    async fn create(&self, request: v1::CreateSceneRequest) -> Told<v1::SceneSummary> {
        Ok(self.call::<v1::CreateSceneResponse>("Scenes/CreateScene", &request).await?.scene.unwrap())
    }

    async fn delete_scene(&self, name: &str) -> Told<v1::SceneSummary> {
        let request = v1::DeleteSceneRequest { scene: name.to_owned() };
        Ok(self.call::<v1::DeleteSceneResponse>("Scenes/DeleteScene", &request).await?.scene.unwrap())
    }

    async fn get_scene(&self, request: v1::GetSceneRequest) -> Told<v1::SceneContents> {
        Ok(self.call::<v1::GetSceneResponse>("Scenes/GetScene", &request).await?.scene.unwrap())
    }

    async fn scene_health(&self, scene: &str) -> Told<v1::SceneHealth> {
        let request = v1::GetSceneHealthRequest { scene: scene.to_owned(), against_rebuilt: true };
        Ok(self.call::<v1::GetSceneHealthResponse>("Scenes/GetSceneHealth", &request).await?.health.unwrap())
    }

    async fn apply(&self, request: v1::ApplyRequest) -> Told<v1::ApplyResponse> {
        self.call("Scenes/Apply", &request).await
    }

    async fn put_asset(&self, announced: v1::AssetHeader, bytes: &[u8]) -> Told<v1::PutAssetResponse> {
        let chunks = bytes.chunks(7).map(|chunk| Part::Chunk(chunk.to_vec().into()));
        let parts = std::iter::once(Part::Header(announced)).chain(chunks);
        let message = |part| v1::PutAssetRequest { part: Some(part) }.encode_length_delimited_to_vec();
        let answer = self.call_bytes("Assets/PutAsset", parts.flat_map(message).collect()).await?;
        Ok(v1::PutAssetResponse::decode(answer.as_slice()).unwrap())
    }

    async fn describe_mesh(&self, request: v1::DescribeMeshRequest) -> Told<v1::MeshCard> {
        Ok(self.call::<v1::DescribeMeshResponse>("Assets/DescribeMesh", &request).await?.card.unwrap())
    }

    async fn load_robot(&self, request: v1::LoadRobotRequest) -> Told<v1::RobotModel> {
        Ok(self.call::<v1::LoadRobotResponse>("Robots/LoadRobot", &request).await?.robot.unwrap())
    }

    async fn check_states(&self, request: v1::CheckStatesRequest) -> Told<v1::Answer> {
        Ok(self.call::<v1::CheckStatesResponse>("Queries/CheckStates", &request).await?.answer.unwrap())
    }

    async fn collide(&self, request: v1::CollideRequest) -> Told<v1::Answer> {
        Ok(self.call::<v1::CollideResponse>("Queries/Collide", &request).await?.answer.unwrap())
    }

    async fn distance(&self, request: v1::DistanceRequest) -> Told<v1::Answer> {
        Ok(self.call::<v1::DistanceResponse>("Queries/Distance", &request).await?.answer.unwrap())
    }

    async fn cast_rays(&self, request: v1::CastRaysRequest) -> Told<v1::CastRaysResponse> {
        self.call("Queries/CastRays", &request).await
    }

    async fn cast_shapes(&self, request: v1::CastShapesRequest) -> Told<v1::CastShapesResponse> {
        self.call("Queries/CastShapes", &request).await
    }

    async fn check_moving_pairs(&self, request: v1::CheckMovingPairsRequest) -> Told<v1::CheckMovingPairsResponse> {
        self.call("Queries/CheckMovingPairs", &request).await
    }

    async fn overlap(&self, request: v1::OverlapRequest) -> Told<v1::OverlapResponse> {
        self.call("Queries/Overlap", &request).await
    }

    async fn nearest_bodies(&self, request: v1::NearestBodiesRequest) -> Told<v1::NearestBodiesResponse> {
        self.call("Queries/NearestBodies", &request).await
    }

    async fn check_motions(&self, request: v1::CheckMotionsRequest) -> Told<v1::CheckMotionsResponse> {
        self.call("Queries/CheckMotions", &request).await
    }

    async fn check_path(&self, request: v1::CheckPathRequest) -> Told<v1::CheckPathResponse> {
        self.call("Queries/CheckPath", &request).await
    }

    async fn clearance(&self, request: v1::ClearanceRequest) -> Told<v1::Answer> {
        Ok(self.call::<v1::ClearanceResponse>("Queries/Clearance", &request).await?.answer.unwrap())
    }

    async fn estimate(&self, request: v1::EstimateRequest) -> Told<v1::EstimateResponse> {
        self.call("Queries/Estimate", &request).await
    }
}
