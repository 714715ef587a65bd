//! What only a connection can show: sizes of messages, deadlines, callers that go away, and that the socket changes not
//! a byte of an answer.

use std::sync::Arc;

use clearance::app::Drained;
use clearance::limits::Limits;
use clearance::scene::SceneOptions;
use clearance::transports::wire::v1;
use clearance::transports::wire::v1::queries_client::QueriesClient;
use clearance::transports::wire::v1::server_client::ServerClient;
use prost::Message;
use tonic::{Code, Request};
use tonic_health::pb::HealthCheckRequest;
use tonic_health::pb::health_client::HealthClient;
use tonic_reflection::pb::v1::ServerReflectionRequest;
use tonic_reflection::pb::v1::server_reflection_client::ServerReflectionClient;
use tonic_reflection::pb::v1::server_reflection_request::MessageRequest;
use tonic_reflection::pb::v1::server_reflection_response::MessageResponse;

use crate::support::door::{Door, Grpc, InProcess, Refusal};
use crate::support::messages::*;
use crate::support::watchdog::{eventually, watched};

/// A scene in which one question keeps a thread busy for much longer than any test lasts.
async fn crowd(door: &impl Door) {
    door.create_scene(SCENE).await.unwrap();
    let radii = Some(vec3(1.0, 0.8, 0.6));
    let body = |i: u32| {
        let core = v1::shape::Core::Ellipsoid(v1::Ellipsoid { radii });
        add(&format!("body{i}"), shape(core), at(0.001 * f64::from(i), 0.0, 0.0))
    };
    door.apply(apply((0..400).map(body).collect())).await.unwrap();
}

fn endless_question() -> v1::DistanceRequest {
    let mut question = distance(vec![all_pairs(); 1000]);
    question.context.as_mut().unwrap().wants =
        Some(v1::Wants { distance: true, witness: true, depth: true, pairs: true, patch: true, derivatives: true });
    question
}

#[tokio::test(flavor = "multi_thread")]
async fn the_socket_changes_not_a_byte() {
    let grpc = Grpc::open(Limits::default()).await;
    let library = InProcess { service: Arc::clone(&grpc.daemon.service) };
    let robot = grpc.load_robot(load(ROBOT)).await.unwrap();
    grpc.create_scene(SCENE).await.unwrap();
    let bodies = [
        add_robot("arm", &robot.id),
        add("block", cuboid(0.2, 0.2, 0.2), at(1.0, 0.0, -1.0)),
        add("ball", sphere(0.4), at(-0.3, 0.9, 0.1)),
    ];
    grpc.apply(apply(bodies.to_vec())).await.unwrap();
    let wants = v1::Wants { distance: true, witness: true, depth: true, pairs: true, patch: true, derivatives: false };
    let positions: Vec<f64> = (0..400).map(|i| f64::from(i % 29) * 0.1 - f64::from(i % 7)).collect();
    for form in [v1::AnswerForm::Items, v1::AnswerForm::Bulk] {
        let wants = Some(v1::Wants { derivatives: form == v1::AnswerForm::Items, ..wants });
        let context = Some(v1::Context { wants, answer_form: form.into(), ..context() });
        let question = v1::CheckStatesRequest { context: context.clone(), ..states(positions.clone()) };
        let over_socket = watched("states", grpc.check_states(question.clone())).await.unwrap();
        let in_process = library.check_states(question).await.unwrap();
        assert_eq!(over_socket.encode_to_vec(), in_process.encode_to_vec());
        let items = vec![all_pairs(), body(named("ball")), placed(sphere(2.0), at(0.0, 0.0, 0.0))];
        let question = v1::DistanceRequest { context, ..distance(items) };
        let over_socket = grpc.distance(question.clone()).await.unwrap();
        assert_eq!(over_socket.encode_to_vec(), library.distance(question).await.unwrap().encode_to_vec());
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_message_beyond_the_cap_is_refused_and_the_connection_lives() {
    let grpc = Grpc::open(Limits { max_message_bytes: 10_000, ..Limits::default() }).await;
    grpc.create_scene(SCENE).await.unwrap();
    let beyond = |refusal: Refusal, asked: u64| {
        assert_eq!((refusal.code, refusal.reason.as_str()), (Code::ResourceExhausted, "LIMIT_EXCEEDED"), "{refusal:?}");
        let told = format!("max_message_bytes exceeded: asked for {asked}, allowed is 10000");
        assert_eq!(refusal.message, told);
    };
    let question = states(vec![0.0; 2_000]);
    let asked = question.encoded_len() as u64;
    beyond(grpc.check_states(question).await.unwrap_err(), asked);
    // A small question with a large answer.
    grpc.apply(heap()).await.unwrap();
    let question = heap_listed(1);
    let library = InProcess { service: Arc::clone(&grpc.daemon.service) };
    let answer = v1::CollideResponse { answer: Some(library.collide(question.clone()).await.unwrap()) };
    assert!(question.encoded_len() < 10_000 && answer.encoded_len() > 10_000);
    beyond(grpc.collide(question).await.unwrap_err(), answer.encoded_len() as u64);
    assert!(grpc.collide(collide(vec![all_pairs()])).await.is_ok());
}

#[tokio::test(flavor = "multi_thread")]
async fn a_deadline_in_the_past_is_exceeded_at_once() {
    let grpc = Grpc::open(Limits::default()).await;
    grpc.create_scene(SCENE).await.unwrap();
    let question = v1::Context { time_budget: Some(0.0), ..context() };
    let question = v1::CollideRequest { context: Some(question), ..collide(vec![all_pairs()]) };
    let refusal = grpc.collide(question).await.unwrap_err();
    assert_eq!((refusal.code, refusal.reason.as_str()), (Code::DeadlineExceeded, "DEADLINE_EXCEEDED"));
    let mut request = Request::new(collide(vec![all_pairs()]));
    request.metadata_mut().insert("grpc-timeout", "soon".parse().unwrap());
    let refusal = Refusal::from(QueriesClient::new(grpc.channel.clone()).collide(request).await.unwrap_err());
    assert_eq!((refusal.code, refusal.field.as_str()), (Code::InvalidArgument, "grpc-timeout"));
}

/// tonic's own timer would say CANCELLED; the service is done a little earlier.
#[tokio::test(flavor = "multi_thread")]
async fn a_deadline_without_any_answer_is_exceeded() {
    let grpc = Grpc::open(Limits::default()).await;
    crowd(&grpc).await;
    let mut request = Request::new(endless_question());
    request.metadata_mut().insert("grpc-timeout", "1S".parse().unwrap());
    let told = watched("a refusal", QueriesClient::new(grpc.channel.clone()).distance(request)).await;
    let refusal = Refusal::from(told.unwrap_err());
    assert_eq!((refusal.code, refusal.reason.as_str()), (Code::DeadlineExceeded, "DEADLINE_EXCEEDED"), "{refusal:?}");
}

#[tokio::test(flavor = "multi_thread")]
async fn an_answer_cut_by_time_has_what_was_done_by_then() {
    let grpc = Grpc::open(Limits::default()).await;
    crowd(&grpc).await;
    // Quick items first, then the one that does not end.
    let quick = placed(sphere(0.1), at(50.0, 0.0, 0.0));
    let items = [vec![quick; 8], vec![all_pairs(); 64]].concat();
    let mut question = v1::DistanceRequest { items, ..endless_question() };
    question.context.as_mut().unwrap().time_budget = Some(0.3);
    let answer = watched("a cut answer", grpc.distance(question)).await.unwrap();
    assert!(answer.out_of_time);
    let verdicts = verdicts(&answer);
    assert_eq!(verdicts[..8], [v1::Verdict::Free; 8]);
    assert_eq!(verdicts[71], v1::Verdict::NotRun);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_caller_that_goes_away_frees_its_thread() {
    let grpc = Grpc::open(Limits { max_queries_in_flight: 1, ..Limits::default() }).await;
    crowd(&grpc).await;
    let service = Arc::clone(&grpc.daemon.service);
    let mut queries = QueriesClient::new(grpc.channel.clone());
    let asking = tokio::spawn(async move { queries.distance(endless_question()).await });
    eventually("the question is being answered", || service.queries_in_flight() == 1).await;
    let refusal = grpc.collide(collide(vec![all_pairs()])).await.unwrap_err();
    assert_eq!(refusal.code, Code::ResourceExhausted);
    assert!(refusal.message.starts_with("max_queries_in_flight exceeded"), "{refusal:?}");
    asking.abort();
    eventually("the thread is free again", || service.queries_in_flight() == 0).await;
    let answer = grpc.collide(collide(vec![placed(sphere(0.1), at(50.0, 0.0, 0.0))])).await.unwrap();
    assert_eq!(verdicts(&answer), [v1::Verdict::Free]);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_draining_daemon_answers_what_is_under_way_and_takes_nothing_new() {
    let grpc = Grpc::open(Limits::default()).await;
    crowd(&grpc).await;
    let service = Arc::clone(&grpc.daemon.service);
    let mut question = endless_question();
    question.context.as_mut().unwrap().time_budget = Some(1.0);
    // Something to show for the second: a quick item.
    question.items.insert(0, placed(sphere(0.1), at(50.0, 0.0, 0.0)));
    let mut queries = QueriesClient::new(grpc.channel.clone());
    let asking = tokio::spawn(async move { queries.distance(question).await });
    eventually("the question is being answered", || service.queries_in_flight() == 1).await;
    let Grpc { daemon, channel: _kept, .. } = grpc;
    let stopping = tokio::spawn(daemon.stop());
    let answer = watched("the answer under way", asking).await.unwrap().unwrap();
    assert!(answer.into_inner().answer.unwrap().out_of_time);
    assert_eq!(watched("the end", stopping).await.unwrap(), Drained::Clean);
    let refused = service.create_scene("late", &SceneOptions::default()).unwrap_err();
    assert_eq!(Refusal::from(refused).reason, "SHUTTING_DOWN");
}

#[tokio::test(flavor = "multi_thread")]
async fn the_daemon_tells_its_doors_caps_and_health() {
    let grpc = Grpc::open(Limits { max_items: 7, ..Limits::default() }).await;
    grpc.create_scene(SCENE).await.unwrap();
    let request = v1::GetServerInfoRequest {};
    let info = ServerClient::new(grpc.channel.clone()).get_server_info(request).await.unwrap().into_inner();
    assert_eq!(info.version, env!("CARGO_PKG_VERSION"));
    assert_eq!((info.doors[0].kind.as_str(), &info.doors[0].address), ("grpc", &grpc.daemon.address));
    assert_eq!(info.limits.iter().find(|limit| limit.name == "max_items").unwrap().value, 7);
    assert_eq!((info.scenes.len(), info.scenes[0].name.as_str(), info.threads), (1, SCENE, 2));
    for service in ["", "clearance.v1.Queries"] {
        let request = HealthCheckRequest { service: service.to_owned() };
        let health = HealthClient::new(grpc.channel.clone()).check(request).await.unwrap().into_inner();
        assert_eq!(health.status, 1, "{service:?} is not SERVING");
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn tools_learn_the_services_and_their_messages_by_reflection() {
    let grpc = Grpc::open(Limits::default()).await;
    let ask = async |question| {
        let request = ServerReflectionRequest { host: String::new(), message_request: Some(question) };
        let mut client = ServerReflectionClient::new(grpc.channel.clone());
        let mut answers = client.server_reflection_info(tokio_stream::once(request)).await.unwrap().into_inner();
        watched("reflection", answers.message()).await.unwrap().unwrap().message_response.unwrap()
    };
    let MessageResponse::ListServicesResponse(listed) = ask(MessageRequest::ListServices(String::new())).await else {
        panic!("not a list of services")
    };
    let names: Vec<&str> = listed.service.iter().map(|service| service.name.as_str()).collect();
    for service in ["Assets", "Queries", "Robots", "Scenes", "Server"] {
        assert!(names.contains(&format!("clearance.v1.{service}").as_str()), "{names:?}");
    }
    let symbol = MessageRequest::FileContainingSymbol("clearance.v1.CheckStatesRequest".to_owned());
    assert!(matches!(ask(symbol).await, MessageResponse::FileDescriptorResponse(_)));
}
