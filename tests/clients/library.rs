//! The library as the one who answers: what it says is what is recorded.

use std::convert::Infallible;
use std::sync::Arc;

use clearance::service::{Config, ContentHash, Service, ServiceError};
use clearance::transports::grpc::status_of;
use clearance::transports::requests;
use clearance::transports::wire::v1;
use prost::Message;
use tonic::Code;

/// An answer in its canonical form, as bytes; or why there is none, as a record has it.
pub type Told = Result<Vec<u8>, String>;

pub struct Library {
    service: Arc<Service>,
}

/// Decodes a request of the type that the function takes.
fn decoded<M: Message + Default>(bytes: &[u8]) -> M {
    M::decode(bytes).unwrap()
}

fn told<M: Canonical>(outcome: Result<M, ServiceError>) -> Told {
    match outcome {
        Ok(answer) => Ok(answer.canonical().encode_to_vec()),
        Err(error) => Err(refusal(&status_of(&error).into())),
    }
}

impl Library {
    pub fn new() -> Self {
        Self { service: Service::new(&Config { threads: 2, ..Config::default() }).unwrap() }
    }

    pub async fn upload(&self, file: &[u8]) {
        let mut upload = self.service.begin_upload(ContentHash::of(file), file.len() as u64).unwrap();
        upload.push(file).unwrap();
        self.service.finish_upload(upload).await.unwrap();
    }

    pub async fn ask(&self, method: &str, request: &[u8]) -> Told {
        let service = &self.service;
        match method {
            "Scenes/CreateScene" => told(requests::create_scene(service, &decoded(request))),
            "Scenes/Apply" => told(requests::apply(service, decoded(request), None).await),
            "Scenes/GetScene" => told(requests::get_scene(service, decoded(request), None).await),
            "Assets/HasAssets" => told(requests::has_assets(service, &decoded(request))),
            "Robots/LoadRobot" => told(requests::load_robot(service, decoded(request)).await),
            "Queries/CheckStates" => told(requests::check_states(service, decoded(request), None).await),
            "Queries/Collide" => told(requests::collide(service, decoded(request), None).await),
            "Queries/Distance" => told(requests::distance(service, decoded(request), None).await),
            "Queries/CastRays" => told(requests::cast_rays(service, decoded(request), None).await),
            "Queries/CastShapes" => told(requests::cast_shapes(service, decoded(request), None).await),
            "Queries/CheckMovingPairs" => told(requests::check_moving_pairs(service, decoded(request), None).await),
            "Queries/Overlap" => told(requests::overlap(service, decoded(request), None).await),
            "Queries/NearestBodies" => told(requests::nearest_bodies(service, decoded(request), None).await),
            "Queries/CheckMotions" => told(requests::check_motions(service, decoded(request), None).await),
            "Queries/CheckPath" => told(requests::check_path(service, decoded(request), None).await),
            "Queries/Clearance" => told(requests::clearance(service, decoded(request), None).await),
            _ => panic!("no such method: {method}"),
        }
    }

    pub async fn query_stream(&self, questions: &[Vec<u8>]) -> Vec<Vec<u8>> {
        let sent: Vec<Result<v1::QueryStreamRequest, Infallible>> =
            questions.iter().map(|question| Ok(decoded(question))).collect();
        let mut stream = requests::query_stream(&self.service, tokio_stream::iter(sent), None).unwrap();
        let mut answers = Vec::new();
        while let Some(answer) = stream.next().await.unwrap() {
            answers.push(answer.canonical().encode_to_vec());
        }
        answers
    }
}

/// A refusal, as a record has it.
#[derive(Debug, PartialEq, Eq)]
pub struct Refusal {
    pub code: Code,
    pub reason: String,
    pub field: String,
}

impl From<tonic::Status> for Refusal {
    fn from(status: tonic::Status) -> Self {
        let of = |key| status.metadata().get(key).map_or("", |value| value.to_str().unwrap()).to_owned();
        Self { code: status.code(), reason: of("clearance-reason"), field: of("clearance-field") }
    }
}

pub fn refusal(refusal: &Refusal) -> String {
    let codes = [
        (Code::InvalidArgument, "INVALID_ARGUMENT"),
        (Code::NotFound, "NOT_FOUND"),
        (Code::AlreadyExists, "ALREADY_EXISTS"),
        (Code::FailedPrecondition, "FAILED_PRECONDITION"),
        (Code::Aborted, "ABORTED"),
        (Code::OutOfRange, "OUT_OF_RANGE"),
        (Code::ResourceExhausted, "RESOURCE_EXHAUSTED"),
    ];
    let known = codes.iter().find(|(code, _)| *code == refusal.code);
    let (_, code) = known.unwrap_or_else(|| panic!("no record has {:?}", refusal.code));
    let field = if refusal.field.is_empty() { "-" } else { &refusal.field };
    format!("{code} {} {field}", refusal.reason)
}

/// What is the same at every asking: no epoch, no count of nodes.
pub trait Canonical: Message + Default {
    fn canonical(self) -> Self;
}

fn no_nodes(cost: &mut Option<v1::Cost>) {
    if let Some(cost) = cost {
        cost.nodes = 0;
    }
}

fn answer(answer: &mut Option<v1::Answer>) {
    let Some(answer) = answer else { return };
    answer.epoch = 0;
    no_nodes(&mut answer.cost);
    answer.items.iter_mut().for_each(|item| no_nodes(&mut item.cost));
}

macro_rules! canonical {
    ($($message:ident: |$it:ident| $clear:expr;)*) => {
        $(impl Canonical for v1::$message {
            fn canonical(mut self) -> Self {
                let clear = |$it: &mut Self| -> () { $clear };
                clear(&mut self);
                self
            }
        })*
    };
}

canonical! {
    CreateSceneResponse: |it| it.scene.as_mut().unwrap().epoch = 0;
    ApplyResponse: |it| it.epoch = 0;
    GetSceneResponse: |it| it.scene.as_mut().unwrap().epoch = 0;
    HasAssetsResponse: |_it| ();
    LoadRobotResponse: |_it| ();
    CheckStatesResponse: |it| answer(&mut it.answer);
    CollideResponse: |it| answer(&mut it.answer);
    DistanceResponse: |it| answer(&mut it.answer);
    CheckMotionsResponse: |it| answer(&mut it.answer);
    CheckPathResponse: |it| answer(&mut it.answer);
    ClearanceResponse: |it| answer(&mut it.answer);
    CastRaysResponse: |it| { it.epoch = 0; no_nodes(&mut it.cost) };
    CastShapesResponse: |it| { it.epoch = 0; it.items.iter_mut().for_each(|item| no_nodes(&mut item.cost)) };
    CheckMovingPairsResponse: |it| { it.epoch = 0; it.items.iter_mut().for_each(|item| no_nodes(&mut item.cost)) };
    OverlapResponse: |it| { it.epoch = 0; it.items.iter_mut().for_each(|item| no_nodes(&mut item.cost)) };
    NearestBodiesResponse: |it| { it.epoch = 0; it.items.iter_mut().for_each(|item| no_nodes(&mut item.cost)) };
}

impl Canonical for v1::QueryStreamResponse {
    fn canonical(mut self) -> Self {
        use v1::query_stream_response::Outcome;
        self.outcome = self.outcome.map(|outcome| match outcome {
            Outcome::CheckStates(it) => Outcome::CheckStates(it.canonical()),
            Outcome::Collide(it) => Outcome::Collide(it.canonical()),
            Outcome::Distance(it) => Outcome::Distance(it.canonical()),
            Outcome::CastRays(it) => Outcome::CastRays(it.canonical()),
            Outcome::CastShapes(it) => Outcome::CastShapes(it.canonical()),
            Outcome::CheckMovingPairs(it) => Outcome::CheckMovingPairs(it.canonical()),
            Outcome::Overlap(it) => Outcome::Overlap(it.canonical()),
            Outcome::NearestBodies(it) => Outcome::NearestBodies(it.canonical()),
            Outcome::CheckMotions(it) => Outcome::CheckMotions(it.canonical()),
            Outcome::CheckPath(it) => Outcome::CheckPath(it.canonical()),
            Outcome::Clearance(it) => Outcome::Clearance(it.canonical()),
            Outcome::Estimate(_) => unreachable!("times have no canonical form"),
            Outcome::Error(it) => Outcome::Error(it),
        });
        self
    }
}
