//! What a caller sees at each limit, and of what is not there.

use std::time::Duration;

use clearance::limits::Limits;
use clearance::query::{Context, Wants};
use clearance::transports::shared_memory::{Ask, ClientError, Options};

use super::place::*;
use crate::support::door::Door;
use crate::support::messages::SCENE;

#[tokio::test(flavor = "multi_thread")]
async fn what_is_not_there_is_named() {
    let place = Place::with_crane(small()).await;
    let mut client = place.client();
    let mut question = crane_states(vec![0.0, -0.2], Context::default());
    question.robot = "nobody".to_owned();
    let refused = refusal(ask(&mut client, Ask::States(&question, 2), &Options::default()));
    assert_eq!((refused.reason.as_str(), refused.code), ("NOT_FOUND", 5));
    assert!(refused.message.contains("robot \"nobody\""), "{refused:?}");
    place.inside.delete_scene(SCENE).await.unwrap();
    let refused = refusal(ask(&mut client, Ask::States(&question, 2), &Options::default()));
    assert!(refused.reason == "NOT_FOUND" && refused.message.contains("scene \"cell\""), "{refused:?}");
    let missing = tempfile::tempdir().unwrap();
    let error = connect(&unused_name(), missing.path()).unwrap_err();
    assert!(matches!(error, ClientError::NoDaemon { .. }), "{error}");
}

#[tokio::test(flavor = "multi_thread")]
async fn a_deadline_ends_the_wait_for_a_revision() {
    let place = Place::with_crane(small()).await;
    let mut client = place.client();
    let question = crane_states(vec![0.0, -0.2], Context::default());
    let options = Options { timeout: Duration::from_millis(300), ..Options::default() };
    let asked = tokio::task::block_in_place(|| client.ask(&at_least(77), Ask::States(&question, 2), &options));
    let refused = refusal(asked);
    assert_eq!((refused.reason.as_str(), refused.code), ("REVISION_NOT_YET", 14), "{refused:?}");
    assert!(refused.details.contains(&("revision".to_owned(), "1".to_owned())), "{refused:?}");
    let budget = Options { time_budget: Some(Duration::ZERO), ..Options::default() };
    let refused = refusal(ask(&mut client, Ask::States(&question, 2), &budget));
    assert_eq!((refused.reason.as_str(), refused.code), ("DEADLINE_EXCEEDED", 4));
}

#[tokio::test(flavor = "multi_thread")]
async fn a_full_table_refuses_and_a_place_given_back_is_free() {
    let place = Place::with_crane(small()).await;
    let (mut first, second) = (place.client(), place.client());
    let error = connect(&place.name, &place.root()).unwrap_err();
    assert!(matches!(error, ClientError::TooManyClients), "{error:?}");
    assert!(error.to_string().contains("max_shared_memory_clients"));
    let question = crane_states(vec![0.0, -0.2], Context::default());
    assert!(ask(&mut first, Ask::States(&question, 2), &Options::default()).is_ok(), "those inside go on");
    drop(second);
    let mut third = place.client();
    assert!(ask(&mut third, Ask::States(&question, 2), &Options::default()).is_ok());
}

#[tokio::test(flavor = "multi_thread")]
async fn requests_and_answers_beyond_their_size_are_refused_with_both_numbers() {
    let limits = Limits { max_shared_memory_response_bytes: 64 << 10, ..small() };
    let place = Place::with_crane(limits).await;
    let mut client = place.client();
    let many = crane_states([0.0, -0.2].repeat(70_000), Context::default());
    match ask(&mut client, Ask::States(&many, 2), &Options::default()) {
        Err(ClientError::TooLarge(exceeded)) => {
            assert_eq!((exceeded.limit, exceeded.allowed), ("max_shared_memory_request_bytes", 1 << 20));
            assert!(exceeded.asked > 1 << 20);
        }
        other => panic!("{other:?}"),
    }
    let context = Context { wants: Wants { distance: true, ..Wants::VERDICT }, ..Context::default() };
    let some = crane_states([0.0, -0.2].repeat(2000), context);
    let refused = refusal(ask(&mut client, Ask::States(&some, 2), &Options::default()));
    assert_eq!((refused.reason.as_str(), refused.code), ("LIMIT_EXCEEDED", 8));
    assert!(refused.details.contains(&("limit".to_owned(), "max_shared_memory_response_bytes".to_owned())));
    let few = crane_states([0.0, -0.2].repeat(200), Context::default());
    assert_eq!(ask(&mut client, Ask::States(&few, 2), &Options::default()).unwrap().items(), 200);
}

/// A client that takes no notice of the daemon's limit gets a longer segment past its own checks, not past the daemon's.
#[tokio::test(flavor = "multi_thread")]
async fn a_longer_message_than_allowed_is_refused_by_the_daemon_too() {
    use clearance::transports::shared_memory::layout::{ResponseHeader, kind};
    use iceoryx2::prelude::{FileName, NodeBuilder, Path, SemanticString, ServiceName, SignalHandlingMode, ipc};
    let place = Place::with_crane(small()).await;
    let mut config = iceoryx2::config::Config::default();
    config.global.prefix = FileName::new(format!("{}.", &*place.name).as_bytes()).unwrap();
    config.global.set_root_path(&Path::new(place.root().to_str().unwrap().as_bytes()).unwrap());
    let builder = NodeBuilder::new().config(&config).signal_handling_mode(SignalHandlingMode::Disabled);
    let node = builder.create::<ipc::Service>().unwrap();
    let open = |part: &str| node.service_builder(&ServiceName::new(&format!("{}/{part}", &*place.name)).unwrap());
    let questions = open("questions").request_response::<[[u8; 64]], [[u8; 64]]>().open().unwrap();
    let asked = open("asked").event().open().unwrap().notifier_builder().create().unwrap();
    let client = questions.client_builder().initial_max_slice_len(3 << 14).create().unwrap();
    let pending = client.loan_slice_uninit(2 << 14).unwrap().write_from_slice(&vec![[0; 64]; 2 << 14]).send().unwrap();
    asked.notify().unwrap();
    let end = std::time::Instant::now() + Duration::from_secs(60);
    let answer = loop {
        match pending.receive().unwrap() {
            Some(response) => break response.payload().as_flattened().to_vec(),
            None => assert!(std::time::Instant::now() < end, "no answer"),
        }
        std::thread::sleep(Duration::from_millis(1));
    };
    let header = ResponseHeader::read(&answer);
    assert_eq!(header.code, 8);
    let text = String::from_utf8_lossy(&answer).into_owned();
    assert!(text.contains("limit=max_shared_memory_request_bytes\nasked=2097152\nallowed=1048576"), "{text:?}");
    assert!(kind::column(kind::ERROR_DETAILS).is_some());
}

#[tokio::test(flavor = "multi_thread")]
async fn a_draining_daemon_says_so_and_then_is_gone() {
    let place = Place::with_crane(small()).await;
    let mut client = place.client();
    let question = crane_states(vec![0.0, -0.2], Context::default());
    place.daemon.service.begin_drain();
    let refused = refusal(ask(&mut client, Ask::States(&question, 2), &Options::default()));
    assert_eq!((refused.reason.as_str(), refused.code), ("SHUTTING_DOWN", 14));
    assert_eq!(place.daemon.stop().await, clearance::app::Drained::Clean);
    let error = ask(&mut client, Ask::States(&question, 2), &Options::default()).unwrap_err();
    assert!(matches!(error, ClientError::Gone), "{error:?}");
}

#[tokio::test(flavor = "multi_thread")]
async fn the_door_is_listed() {
    let place = Place::open(small()).await;
    let doors = place.daemon.service.doors();
    assert!(doors.iter().any(|door| door.kind == "shared-memory" && door.address == *place.name), "{doors:?}");
}
