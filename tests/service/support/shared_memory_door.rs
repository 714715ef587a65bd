//! The door of shared memory: the messages that gRPC would carry, in segments that both sides see.

use std::ops::Deref;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use clearance::app::SharedMemory as Choice;
use clearance::limits::Limits;
use clearance::transports::shared_memory::{Client, ClientError, Config};
use clearance::transports::wire::v1;
use clearance::transports::wire::v1::put_asset_request::Part;
use prost::Message;
use tempfile::TempDir;
use tonic::Code;

use super::daemon::{RunningDaemon, config};
use super::door::{Door, Refusal, Told};

/// A name that no other test has, on this machine.
pub fn unused_name() -> Name {
    static NEXT: AtomicUsize = AtomicUsize::new(0);
    Name(format!("test-{}-{}", std::process::id(), NEXT.fetch_add(1, Ordering::Relaxed)))
}

/// A door's name. Whatever is left of the door in /dev/shm goes with it: nobody opens the name again who would clean up.
pub struct Name(String);

impl Deref for Name {
    type Target = str;

    fn deref(&self) -> &str {
        &self.0
    }
}

impl Drop for Name {
    fn drop(&mut self) {
        let prefix = format!("{}.", self.0);
        let files = std::fs::read_dir("/dev/shm").into_iter().flatten().flatten();
        for file in files.filter(|file| file.file_name().to_string_lossy().starts_with(&prefix)) {
            std::fs::remove_file(file.path()).unwrap_or_default();
        }
    }
}

/// What calls rpcs by their names. A client has one call under way: calls at the same time have one each.
pub struct SharedMemory {
    _daemon: RunningDaemon,
    idle: Arc<Mutex<Vec<Client>>>,
    name: Name,
    root: TempDir,
}

/// Calls at the same time, at most.
const CLIENTS: usize = 4;
const PATIENCE: Duration = Duration::from_secs(100);

impl SharedMemory {
    async fn call<T: Message + Default>(&self, rpc: &'static str, message: &impl Message) -> Told<T> {
        self.call_bytes(rpc, message.encode_to_vec()).await
    }

    async fn call_bytes<T: Message + Default>(&self, rpc: &'static str, message: Vec<u8>) -> Told<T> {
        let (idle, name, root) = (Arc::clone(&self.idle), self.name.to_owned(), self.root.path().to_owned());
        let calling = tokio::task::spawn_blocking(move || {
            let one = idle.lock().unwrap().pop();
            let mut client = one.unwrap_or_else(|| Client::connect(&name, Path::new(&root)).unwrap());
            let outcome = client.call(rpc, &message, PATIENCE);
            idle.lock().unwrap().push(client);
            outcome
        });
        Ok(T::decode(calling.await.unwrap()?.as_slice()).unwrap())
    }
}

impl From<ClientError> for Refusal {
    fn from(error: ClientError) -> Self {
        let ClientError::Refused(refusal) = error else { panic!("{error}") };
        Self {
            code: Code::from(refusal.code as i32),
            reason: refusal.reason,
            field: refusal.field,
            message: refusal.message,
        }
    }
}

impl Door for SharedMemory {
    async fn open(limits: Limits) -> Self {
        let (name, root) = (unused_name(), tempfile::tempdir().unwrap());
        let limits = Limits {
            max_shared_memory_clients: CLIENTS,
            max_shared_memory_request_bytes: 1 << 20,
            max_shared_memory_response_bytes: 1 << 20,
            ..limits
        };
        let mut config = config(limits);
        let door = Config { name: name.to_string(), root: root.path().to_owned(), spin: Duration::ZERO };
        config.shared_memory = Choice::On(door);
        let daemon = RunningDaemon::start(&config).await;
        Self { _daemon: daemon, idle: Arc::default(), name, root }
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
        self.call_bytes("Assets/PutAsset", parts.flat_map(message).collect()).await
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
}
