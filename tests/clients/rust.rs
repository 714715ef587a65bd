//! Does the Rust client bring the recorded answers?

use clearance::limits::Limits;
use clearance::transports::grpc::Client;
use clearance::transports::wire::v1;
use prost::Message;

use crate::daemon::{RunningDaemon, config};
use crate::library::{Canonical, Refusal, Told, refusal};
use crate::record::Record;
use crate::records::{file, kept};
use crate::watchdog::watched;

/// Asks through a method of one of the generated clients.
macro_rules! ask {
    ($stub:expr, $method:ident($message:ident), $request:expr) => {
        match $stub.$method(v1::$message::decode($request).unwrap()).await {
            Ok(answer) => Ok(answer.into_inner().canonical().encode_to_vec()),
            Err(status) => Err(refusal(&Refusal::from(status))),
        }
    };
}

async fn ask(client: &Client, method: &str, request: &[u8]) -> Told {
    match method {
        "Scenes/CreateScene" => ask!(client.scenes(), create_scene(CreateSceneRequest), request),
        "Scenes/Apply" => ask!(client.scenes(), apply(ApplyRequest), request),
        "Scenes/GetScene" => ask!(client.scenes(), get_scene(GetSceneRequest), request),
        "Assets/HasAssets" => ask!(client.assets(), has_assets(HasAssetsRequest), request),
        "Robots/LoadRobot" => ask!(client.robots(), load_robot(LoadRobotRequest), request),
        "Queries/CheckStates" => ask!(client.queries(), check_states(CheckStatesRequest), request),
        "Queries/Collide" => ask!(client.queries(), collide(CollideRequest), request),
        "Queries/Distance" => ask!(client.queries(), distance(DistanceRequest), request),
        "Queries/CastRays" => ask!(client.queries(), cast_rays(CastRaysRequest), request),
        "Queries/CastShapes" => ask!(client.queries(), cast_shapes(CastShapesRequest), request),
        "Queries/CheckMovingPairs" => ask!(client.queries(), check_moving_pairs(CheckMovingPairsRequest), request),
        "Queries/Overlap" => ask!(client.queries(), overlap(OverlapRequest), request),
        "Queries/NearestBodies" => ask!(client.queries(), nearest_bodies(NearestBodiesRequest), request),
        "Queries/CheckMotions" => ask!(client.queries(), check_motions(CheckMotionsRequest), request),
        "Queries/CheckPath" => ask!(client.queries(), check_path(CheckPathRequest), request),
        "Queries/Clearance" => ask!(client.queries(), clearance(ClearanceRequest), request),
        _ => panic!("no such method: {method}"),
    }
}

async fn stream(client: &Client, requests: &[Vec<u8>]) -> Vec<Vec<u8>> {
    let sent: Vec<_> = requests.iter().map(|request| v1::QueryStreamRequest::decode(&request[..]).unwrap()).collect();
    let mut stream = client.queries().query_stream(tokio_stream::iter(sent)).await.unwrap().into_inner();
    let mut answers = Vec::new();
    while let Some(answer) = stream.message().await.unwrap() {
        answers.push(answer.canonical().encode_to_vec());
    }
    answers
}

#[tokio::test(flavor = "multi_thread")]
async fn the_rust_client_brings_the_recorded_answers() {
    let daemon = RunningDaemon::start(&config(Limits::default())).await;
    let client = Client::connect(&daemon.address).await.unwrap();
    for record in kept() {
        let line = record.to_string();
        let brought = async {
            match record {
                Record::Asset(path) => {
                    client.put_asset(&file(&path)).await.unwrap();
                    Record::Asset(path)
                }
                Record::Ask { method, request, .. } | Record::Refuse { method, request, .. } => {
                    match ask(&client, &method, &request).await {
                        Ok(answer) => Record::Ask { method, request, answer },
                        Err(refusal) => Record::Refuse { method, request, refusal },
                    }
                }
                Record::Stream { method, requests, .. } => {
                    let answers = stream(&client, &requests).await;
                    Record::Stream { method, requests, answers }
                }
            }
        };
        let brought = watched(&line, brought).await.to_string();
        assert!(brought == line, "brought\n{brought}\nrecorded\n{line}");
    }
    drop(client);
    daemon.stop().await;
}
