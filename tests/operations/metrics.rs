//! What is asked is counted, where it was asked and with what came out; the endpoint is opened as configured, and no further.

use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use clearance::transports::wire::v1;
use clearance::transports::wire::v1::assets_client::AssetsClient;
use clearance::transports::wire::v1::put_asset_request::Part;
use clearance::transports::wire::v1::query_stream_request::Question;
use tokio_stream::StreamExt;

use crate::daemon::{Daemon, ball, collide, serve};
use crate::scrape::{Scrape, get, send};

/// A daemon that was asked everything that has a metric of its own, while a watch is open.
pub async fn well_used() -> (Daemon, tonic::Streaming<v1::WatchResponse>) {
    let daemon = Daemon::start(&["--limit", "max_items=20000"]);
    daemon.with_balls("cell").await;
    let (mut queries, mut scenes) = (daemon.queries().await, daemon.scenes().await);
    queries.collide(collide("cell", &["a", "b", "c"])).await.unwrap();
    // Refused, and not there.
    queries.collide(collide("cell", &["a"; 20_001])).await.unwrap_err();
    queries.collide(collide("nowhere", &["a"])).await.unwrap_err();
    // A stream of questions, ended.
    let asked = Question::Collide(collide("cell", &["a", "c"]));
    let messages = vec![v1::QueryStreamRequest { id: 7, question: Some(asked) }];
    let mut answers = queries.query_stream(tokio_stream::iter(messages)).await.unwrap().into_inner();
    while let Some(answer) = answers.next().await {
        answer.unwrap();
    }
    // A batch whose time runs out before its end: half of it is told, on whatever machine.
    let mut budget = 1e-3;
    loop {
        let mut many = collide("cell", &["a"; 20_000]);
        if let Some(context) = &mut many.context {
            context.time_budget = Some(budget);
        }
        match queries.collide(many).await {
            Ok(answer) if answer.get_ref().answer.as_ref().unwrap().out_of_time => break,
            // Too quick, or nothing at all.
            Ok(_) => budget /= 2.0,
            Err(_) => budget *= 1.5,
        }
    }
    let watch = v1::WatchRequest { scene: "cell".to_owned(), ..v1::WatchRequest::default() };
    let mut watch = scenes.watch(watch).await.unwrap().into_inner();
    watch.next().await.unwrap().unwrap();
    // The first look at the scenes.
    let until = Instant::now() + Duration::from_secs(30);
    while Scrape::of(&daemon).find("clearance_scene_tree_depth_nodes{scene=\"cell\"}").is_none() {
        assert!(Instant::now() < until, "the scene is not looked at");
        std::thread::sleep(Duration::from_millis(50));
    }
    (daemon, watch)
}

#[tokio::test(flavor = "multi_thread")]
async fn what_is_asked_is_counted_by_rpc_door_outcome_and_verdict() {
    let daemon = Daemon::start(&["--limit", "max_items=3"]);
    daemon.with_balls("cell").await;
    let mut queries = daemon.queries().await;
    for _ in 0..2 {
        queries.collide(collide("cell", &["a", "b", "c"])).await.unwrap();
    }
    queries.collide(collide("cell", &["a"; 4])).await.unwrap_err();
    queries.collide(collide("nowhere", &["a"])).await.unwrap_err();
    let asked = Question::Collide(collide("cell", &["c"]));
    let messages = vec![v1::QueryStreamRequest { id: 7, question: Some(asked) }];
    let mut answers = queries.query_stream(tokio_stream::iter(messages)).await.unwrap().into_inner();
    while let Some(answer) = answers.next().await {
        answer.unwrap();
    }
    let scrape = Scrape::of(&daemon);
    let calls = |outcome: &str| {
        let labels = format!("{{door=\"grpc\",rpc=\"Collide\",outcome=\"{outcome}\"}}");
        scrape.value(&format!("clearance_call_duration_seconds_count{labels}"))
    };
    // Two by themselves and one in the stream.
    assert_eq!((calls("ok"), calls("limit_exceeded"), calls("not_found")), (3.0, 1.0, 1.0));
    let items = |verdict: &str| {
        let labels = format!("{{door=\"grpc\",rpc=\"Collide\",verdict=\"{verdict}\",reason=\"\"}}");
        scrape.value(&format!("clearance_items_total{labels}"))
    };
    assert_eq!((items("collision"), items("free")), (4.0, 3.0));
    for (sample, expected) in [
        ("clearance_call_duration_seconds_count{door=\"grpc\",rpc=\"Apply\",outcome=\"ok\"}", 1.0),
        ("clearance_call_wait_seconds_count{door=\"grpc\",rpc=\"Apply\"}", 1.0),
        // A refused question was worked on, too: it is decoded first. One about no scene was not.
        ("clearance_call_work_seconds_count{door=\"grpc\",rpc=\"Collide\"}", 4.0),
        ("clearance_limit_refusals_total{door=\"grpc\",limit=\"max_items\"}", 1.0),
        ("clearance_streams_ended_total{door=\"grpc\",rpc=\"QueryStream\",outcome=\"ok\"}", 1.0),
        ("clearance_edits_total{door=\"grpc\"}", 3.0),
        ("clearance_calls_in_flight{door=\"grpc\"}", 0.0),
        ("clearance_queries_in_flight", 0.0),
        ("clearance_scenes", 1.0),
        ("clearance_scene_revision{scene=\"cell\"}", 1.0),
        ("clearance_scene_bodies{scene=\"cell\"}", 3.0),
        ("clearance_scene_kept_revisions{scene=\"cell\"}", 2.0),
        ("clearance_limit{limit=\"max_items\"}", 3.0),
        ("clearance_draining", 0.0),
    ] {
        assert_eq!(scrape.value(sample), expected, "{sample}");
    }
    let work = scrape.value("clearance_call_work_seconds_sum{door=\"grpc\",rpc=\"Collide\"}");
    assert!(work > 0.0 && work < 10.0, "{work} s");
    for counted in ["clearance_received_bytes_total{door=\"grpc\"}", "clearance_sent_bytes_total{door=\"grpc\"}"] {
        assert!(scrape.value(counted) > 100.0, "{counted}");
    }
    assert!(scrape.value("clearance_connections_opened_total{door=\"grpc\"}") >= 2.0);
    assert!(scrape.value("process_resident_memory_bytes") > 1e6);
    assert!(scrape.value("process_open_fds") > 5.0);
    assert!(scrape.value("process_start_time_seconds") > 1.7e9);
}

#[tokio::test(flavor = "multi_thread")]
async fn every_name_follows_the_rules_and_every_family_has_help_and_a_type() {
    let (daemon, watch) = well_used().await;
    let scrape = Scrape::of(&daemon);
    let lower = |name: &str| name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_');
    for (family, kind) in &scrape.types {
        assert!(scrape.helped.contains(family), "{family} has no help");
        assert!(lower(family) && (family.starts_with("clearance_") || family.starts_with("process_")), "{family}");
        match kind.as_str() {
            "counter" => assert!(family.ends_with("_total"), "{family}"),
            "histogram" => assert!(family.ends_with("_seconds"), "{family}"),
            "gauge" => assert!(!family.ends_with("_total") && !family.ends_with("_count"), "{family}"),
            other => panic!("{family} is a {other}"),
        }
        // Base units alone.
        for unit in ["milliseconds", "microseconds", "_ms", "_us", "kilobytes", "_kb", "percent", "minutes"] {
            assert!(!family.contains(unit), "{family}");
        }
    }
    let families: Vec<_> = scrape.types.keys().collect();
    assert!(families.len() > 50, "only {} families: {families:?}", families.len());
    for name in scrape.names() {
        let of_histogram = ["_bucket", "_sum", "_count"].iter().filter_map(|end| name.strip_suffix(end));
        let known = scrape.types.contains_key(&name) || of_histogram.into_iter().any(|f| scrape.types.contains_key(f));
        assert!(known, "{name} has no type");
    }
    assert_eq!(scrape.value("clearance_watchers"), 1.0);
    assert!(scrape.value("clearance_answers_out_of_time_total{door=\"grpc\",rpc=\"Collide\"}") >= 1.0);
    drop(watch);
    // The same in the form that Prometheus asks for.
    let accept =
        "GET /metrics HTTP/1.1\r\nHost: x\r\nAccept: application/openmetrics-text;version=1.0.0,text/plain\r\n\r\n";
    let response = send(&daemon.metrics, accept);
    assert!(response.head.contains("content-type: application/openmetrics-text; version=1.0.0"), "{}", response.head);
    assert!(response.body.ends_with("# EOF\n"));
    assert_eq!(Scrape::read(&response.body).names(), Scrape::of(&daemon).names());
    assert_eq!(daemon.stop().0, Some(0));
}

#[tokio::test(flavor = "multi_thread")]
async fn scenes_beyond_the_cap_have_no_figures_and_are_counted_and_names_are_escaped() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("clearance.toml");
    std::fs::write(&file, "[metrics]\nscenes = 2\n").unwrap();
    let daemon = Daemon::start(&["--config", file.to_str().unwrap()]);
    let mut scenes = daemon.scenes().await;
    for name in ["a\"\n\\} 7", "b", "c", "d"] {
        let create = v1::CreateSceneRequest { name: name.to_owned(), ..v1::CreateSceneRequest::default() };
        scenes.create_scene(create).await.unwrap();
    }
    let scrape = Scrape::of(&daemon);
    assert_eq!((scrape.value("clearance_scenes"), scrape.value("clearance_scenes_untold")), (4.0, 2.0));
    assert_eq!(scrape.value(r#"clearance_scene_bodies{scene="a\"\n\\} 7"}"#), 0.0);
    assert_eq!(scrape.value(r#"clearance_scene_bodies{scene="b"}"#), 0.0);
    assert_eq!(scrape.find(r#"clearance_scene_bodies{scene="c"}"#), None);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_call_whose_caller_goes_away_is_counted_as_abandoned() {
    let daemon = Daemon::start(&[]);
    let mut scenes = daemon.scenes().await;
    daemon.with_balls("cell").await;
    // Waits for a revision that nobody makes.
    let rule = v1::revision_rule::Rule::AtLeast(99);
    let mut asked = collide("cell", &["a"]);
    if let Some(context) = &mut asked.context {
        context.revision = Some(v1::RevisionRule { epoch: None, rule: Some(rule) });
    }
    let mut queries = daemon.queries().await;
    let waiting = tokio::time::timeout(Duration::from_millis(300), queries.collide(asked)).await;
    assert!(waiting.is_err(), "nobody makes revision 99");
    let abandoned = "clearance_call_duration_seconds_count{door=\"grpc\",rpc=\"Collide\",outcome=\"abandoned\"}";
    let until = Instant::now() + Duration::from_secs(20);
    while Scrape::of(&daemon).find(abandoned) != Some(1.0) {
        assert!(Instant::now() < until, "the call is not counted as abandoned");
        std::thread::sleep(Duration::from_millis(20));
    }
    let apply =
        v1::ApplyRequest { scene: "cell".to_owned(), edits: vec![ball("d", 3.0)], ..v1::ApplyRequest::default() };
    scenes.apply(apply).await.unwrap();
}

#[test]
fn questions_through_shared_memory_are_counted_under_their_own_door() {
    use clearance::transports::shared_memory::Client;
    use prost::Message;
    let folder = tempfile::tempdir().unwrap();
    let name = format!("operations-{}", std::process::id());
    let root = folder.path().join("root");
    let mut command = Command::new(serve().get_program());
    command.args(["serve", "--grpc-address", "127.0.0.1:0", "--metrics-address", "127.0.0.1:0", "--no-zenoh"]);
    command.args(["--shared-memory-name", &name, "--shared-memory-root"]).arg(&root);
    command.args(["--limit", "max_shared_memory_clients=2", "--limit", "max_shared_memory_request_bytes=1048576"]);
    command.args(["--limit", "max_shared_memory_response_bytes=1048576"]);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let daemon = Daemon::run(&mut command);
    let mut client = Client::connect(&name, &root).unwrap();
    let patience = Duration::from_secs(30);
    let create = v1::CreateSceneRequest { name: "cell".to_owned(), ..v1::CreateSceneRequest::default() };
    client.call("Scenes/CreateScene", &create.encode_to_vec(), patience).unwrap();
    client.call("Queries/Collide", &collide("nowhere", &["a"]).encode_to_vec(), patience).unwrap_err();
    counted(&daemon, "shared-memory");
    drop(client);
    assert_eq!(daemon.stop().0, Some(0));
}

/// A scene was made and a scene was not found, through that door alone.
fn counted(daemon: &Daemon, door: &str) {
    let scrape = Scrape::of(daemon);
    for (rpc, outcome) in [("CreateScene", "ok"), ("Collide", "not_found")] {
        let labels = format!("{{door=\"{door}\",rpc=\"{rpc}\",outcome=\"{outcome}\"}}");
        assert_eq!(scrape.value(&format!("clearance_call_duration_seconds_count{labels}")), 1.0);
    }
    assert!(scrape.value(&format!("clearance_received_bytes_total{{door=\"{door}\"}}")) > 0.0);
}

#[tokio::test(flavor = "multi_thread")]
async fn questions_through_zenoh_are_counted_under_their_own_door() {
    use clearance::transports::zenoh::Client;
    use prost::Message;
    let mut command = Command::new(serve().get_program());
    command.args(["serve", "--grpc-address", "127.0.0.1:0", "--metrics-address", "127.0.0.1:0"]);
    command.args(["--no-shared-memory", "--zenoh-listen", "tcp/127.0.0.1:0"]);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let daemon = tokio::task::block_in_place(|| Daemon::run(&mut command));
    let client = Client::connect(&daemon.zenoh, "clearance").await.unwrap();
    let patience = Duration::from_secs(30);
    let create = v1::CreateSceneRequest { name: "cell".to_owned(), ..v1::CreateSceneRequest::default() };
    client.call("Scenes/CreateScene", create.encode_to_vec(), patience).await.unwrap();
    client.call("Queries/Collide", collide("nowhere", &["a"]).encode_to_vec(), patience).await.unwrap_err();
    tokio::task::block_in_place(|| counted(&daemon, "zenoh"));
    drop(client);
    assert_eq!(tokio::task::block_in_place(|| daemon.stop()).0, Some(0));
}

/// How a run ends that does not begin to serve, and what it says.
fn refused(flags: &[&str]) -> (Option<i32>, String) {
    let output = serve().args(flags).output().unwrap();
    assert!(output.stdout.is_empty(), "{output:?}");
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

#[test]
fn a_taken_port_and_an_exposed_address_end_the_start_with_their_own_codes() {
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let address = taken.local_addr().unwrap().to_string();
    let (code, text) = refused(&["--metrics-address", &address]);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("metrics.address") && text.contains(&address), "{text}");
    let (code, text) = refused(&["--metrics-address", "0.0.0.0:0"]);
    assert_eq!(code, Some(2), "{text}");
    assert!(text.contains("--metrics-exposed"), "{text}");
    let daemon = Daemon::run(serve().args(["--metrics-address", "0.0.0.0:0", "--metrics-exposed"]));
    let port = daemon.metrics.rsplit(':').next().unwrap();
    assert_eq!(get(&format!("127.0.0.1:{port}"), "/livez").status, 200);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_daemon_that_drains_is_alive_and_not_ready_and_is_still_scraped() {
    let mut daemon = Daemon::start(&["--drain-seconds", "30"]);
    assert_eq!(get(&daemon.metrics, "/readyz").status, 200);
    // An upload that is not finished holds up the end.
    let hash = "0".repeat(64);
    let (send_part, parts) = tokio::sync::mpsc::channel(1);
    let header = Part::Header(v1::AssetHeader { sha256: hash, bytes: 10 });
    send_part.send(v1::PutAssetRequest { part: Some(header) }).await.unwrap();
    let mut assets = AssetsClient::new(daemon.channel().await);
    let upload =
        tokio::spawn(
            async move { assets.put_asset(tokio_stream::wrappers::ReceiverStream::new(parts)).await.map(drop) },
        );
    let until = Instant::now() + Duration::from_secs(20);
    while Scrape::of(&daemon).value("clearance_uploads_in_flight") != 1.0 {
        assert!(Instant::now() < until, "the upload does not begin");
        tokio::time::sleep(Duration::from_millis(10)).await;
    }
    daemon.terminate();
    while get(&daemon.metrics, "/readyz").status != 503 {
        assert!(Instant::now() < until, "the daemon does not drain");
        tokio::time::sleep(Duration::from_millis(10)).await;
    }
    assert_eq!(get(&daemon.metrics, "/livez").status, 200);
    assert_eq!(Scrape::of(&daemon).value("clearance_draining"), 1.0);
    // The wrong bytes end the upload, and with it the drain.
    let chunk = Part::Chunk(b"0123456789".to_vec().into());
    send_part.send(v1::PutAssetRequest { part: Some(chunk) }).await.unwrap();
    drop(send_part);
    assert!(upload.await.unwrap().is_err());
    assert_eq!(daemon.ended().0, Some(0));
}

#[test]
fn nothing_listens_where_nobody_asked_for_metrics() {
    use std::io::Read;
    let mut child = serve().spawn().unwrap();
    std::thread::sleep(Duration::from_millis(500));
    let kill = Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap();
    assert!(kill.success());
    assert_eq!(child.wait().unwrap().code(), Some(0));
    let mut told = String::new();
    child.stdout.take().unwrap().read_to_string(&mut told).unwrap();
    assert_eq!(told.lines().count(), 1, "{told}");
    assert!(told.starts_with("listening grpc "), "{told}");
}
