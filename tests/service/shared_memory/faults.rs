//! Processes that die in the middle, and memory that is full.

use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use clearance::query::Context;
use clearance::transports::grpc;
use clearance::transports::shared_memory::layout::kind;
use clearance::transports::shared_memory::{Ask, Client, ClientError, Options};
use clearance::transports::wire::v1;

use super::place::*;
use crate::support::door::Door;
use crate::support::messages::*;
use crate::support::watchdog::{eventually, watched};

/// A process that does not outlive its test.
struct Killed(Child);

impl Drop for Killed {
    fn drop(&mut self) {
        self.0.kill().and_then(|()| self.0.wait()).map(drop).unwrap_or_default();
    }
}

const NAME: &str = "CLEARANCE_TEST_NAME";
const ROOT: &str = "CLEARANCE_TEST_ROOT";

/// Not a test by itself: the client that the test below kills. It asks of a revision that is still to come.
#[test]
#[ignore = "a process of client_killed"]
fn as_a_client_that_waits() {
    let (name, root) = (std::env::var(NAME).unwrap(), std::env::var(ROOT).unwrap());
    let mut client = Client::connect(&name, Path::new(&root)).unwrap();
    println!("connected");
    let question = crane_states([0.0, -0.9].repeat(5), Context::default());
    let revision = std::env::var("CLEARANCE_TEST_REVISION").unwrap().parse().unwrap();
    let options = Options { timeout: Duration::from_secs(60), ..Options::default() };
    let answer = client.ask(&at_least(revision), Ask::States(&question, 2), &options);
    println!("answered {answer:?}");
}

/// Starts that client and waits until its request is under way.
async fn waiting_client(place: &Place, revision: u64) -> Killed {
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args(["--exact", "--ignored", "--nocapture", "shared_memory::faults::as_a_client_that_waits"]);
    command.env(NAME, &*place.name).env(ROOT, place.root()).env("CLEARANCE_TEST_REVISION", revision.to_string());
    let child = Killed(command.stdout(Stdio::null()).spawn().unwrap());
    eventually("a request under way", || place.daemon.service.queries_in_flight() == 1).await;
    child
}

/// Eight times: a client dies while its question waits for a revision, another takes its place and asks, and the
/// revision comes. The other client's answers are its own, and the dead one's work is dropped.
#[tokio::test(flavor = "multi_thread")]
async fn a_client_killed_in_the_middle_leaves_nothing_to_the_next() {
    let place = Place::with_crane(clearance::limits::Limits { max_shared_memory_clients: 1, ..small() }).await;
    let question = crane_states(vec![1.5, -0.1], Context::default());
    for round in 0..8 {
        let next = 2 + round;
        let mut child = waiting_client(&place, next).await;
        child.0.kill().unwrap();
        child.0.wait().unwrap();
        // The only place is the dead client's: whoever connects cleans up behind it.
        let mut client = connect(&place.name, &place.root()).unwrap();
        let first = ask(&mut client, Ask::States(&question, 2), &Options::default()).unwrap();
        place.inside.apply(apply(vec![add(&format!("n{round}"), sphere(0.1), at(0.0, -9.0, 0.0))])).await.unwrap();
        for _ in 0..20 {
            let reply = ask(&mut client, Ask::States(&question, 2), &Options::default()).unwrap();
            assert_eq!((reply.items(), reply.bytes(kind::VERDICTS)), (1, Some(&[1][..])), "round {round}");
        }
        assert_eq!((first.items(), first.revision().0), (1, next - 1));
        eventually("the end of the dead client's question", || place.daemon.service.queries_in_flight() == 0).await;
    }
}

/// Not a test by itself: the client that the test below kills. Its question takes far longer than any test waits.
#[test]
#[ignore = "a process of the test of work that stops"]
fn as_a_client_that_asks_much() {
    let (name, root) = (std::env::var(NAME).unwrap(), std::env::var(ROOT).unwrap());
    let mut client = Client::connect(&name, Path::new(&root)).unwrap();
    let context = Context {
        wants: clearance::query::Wants { patch: false, derivatives: false, ..clearance::query::Wants::ALL },
        ..Context::default()
    };
    let subjects = [clearance::transports::shared_memory::PlainSubject::All; 1000];
    let options = Options { timeout: Duration::from_secs(600), ..Options::default() };
    println!("answered {:?}", client.ask(&target(), Ask::Distance(&subjects, &context), &options));
}

#[tokio::test(flavor = "multi_thread")]
async fn work_for_a_killed_client_stops() {
    let place = Place::open(small()).await;
    place.inside.create_scene(SCENE).await.unwrap();
    let radii = Some(vec3(1.0, 0.8, 0.6));
    let body = |i: u32| {
        let core = v1::shape::Core::Ellipsoid(v1::Ellipsoid { radii });
        add(&format!("body{i}"), shape(core), at(0.001 * f64::from(i), 0.0, 0.0))
    };
    place.inside.apply(apply((0..400).map(body).collect())).await.unwrap();
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args(["--exact", "--ignored", "--nocapture", "shared_memory::faults::as_a_client_that_asks_much"]);
    command.env(NAME, &*place.name).env(ROOT, place.root());
    let mut child = Killed(command.stdout(Stdio::null()).spawn().unwrap());
    let service = &place.daemon.service;
    eventually("the work", || service.queries_in_flight() == 1).await;
    child.0.kill().unwrap();
    child.0.wait().unwrap();
    eventually("the end of the work", || service.queries_in_flight() == 0).await;
}

fn serve(name: &str, root: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_clearance"));
    command.args(["serve", "--grpc-address", "127.0.0.1:0", "--shared-memory-name", name, "--shared-memory-root"]);
    command.arg(root).args(["--limit", "max_shared_memory_clients=2", "--no-zenoh"]);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// Starts a daemon; its gRPC address.
async fn started(name: &str, root: &Path) -> (Killed, String) {
    let mut child = Killed(serve(name, root).spawn().unwrap());
    let stdout = child.0.stdout.take().unwrap();
    let lines = tokio::task::spawn_blocking(move || {
        BufReader::new(stdout).lines().take(2).map(|line| line.unwrap()).collect::<Vec<_>>()
    });
    let lines = watched("the first lines", lines).await.unwrap();
    assert_eq!(lines[1], format!("listening shared-memory {name}"));
    (child, lines[0].strip_prefix("listening grpc ").unwrap().to_owned())
}

#[tokio::test(flavor = "multi_thread")]
async fn a_daemon_killed_in_the_middle_is_told_and_the_next_one_takes_its_place() {
    let (name, root) = (unused_name(), tempfile::tempdir().unwrap());
    let (mut daemon, address) = started(&name, root.path()).await;
    let grpc = watched("connecting", grpc::Client::connect(&address)).await.unwrap();
    grpc.create_scene(SCENE).await.unwrap();
    let waiting = {
        let (name, root) = (name.to_string(), root.path().to_owned());
        tokio::task::spawn_blocking(move || {
            let mut client = Client::connect(&name, &root).unwrap();
            let subjects = [clearance::transports::shared_memory::PlainSubject::All];
            let options = Options { timeout: Duration::from_secs(30), ..Options::default() };
            let context = Context::default();
            let question = Ask::Collide(&subjects, &context);
            assert!(client.ask(&target(), question, &options).is_ok());
            client.ask(&at_least(99), question, &options)
        })
    };
    // Long enough for the second question to be under way; killed earlier the outcome has to be the same.
    tokio::time::sleep(Duration::from_millis(500)).await;
    daemon.0.kill().unwrap();
    daemon.0.wait().unwrap();
    let outcome = watched("the end of the wait", waiting).await.unwrap();
    assert!(matches!(outcome, Err(ClientError::Gone | ClientError::Timeout(_))), "{outcome:?}");

    let (_daemon, address) = started(&name, root.path()).await;
    let grpc = watched("connecting", grpc::Client::connect(&address)).await.unwrap();
    grpc.create_scene(SCENE).await.unwrap();
    let mut client = connect(&name, root.path()).unwrap();
    let subjects = [clearance::transports::shared_memory::PlainSubject::All];
    let reply = ask(&mut client, Ask::Collide(&subjects, &Context::default()), &Options::default()).unwrap();
    assert_eq!(reply.items(), 1);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_name_that_is_taken_is_told_and_ends_the_start() {
    let (name, root) = (unused_name(), tempfile::tempdir().unwrap());
    let (_daemon, _) = started(&name, root.path()).await;
    let output = tokio::task::block_in_place(|| serve(&name, root.path()).output().unwrap());
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.contains("another daemon serves shared memory") && text.contains(&*name), "{text}");
}

#[tokio::test(flavor = "multi_thread")]
async fn a_stopped_daemon_costs_no_more_than_the_timeout_and_its_late_answer_is_not_taken() {
    let (name, root) = (unused_name(), tempfile::tempdir().unwrap());
    let (daemon, address) = started(&name, root.path()).await;
    let grpc = watched("connecting", grpc::Client::connect(&address)).await.unwrap();
    grpc.create_scene(SCENE).await.unwrap();
    let signal = |signal: &str| {
        let sent = Command::new("kill").args([signal, &daemon.0.id().to_string()]).status().unwrap();
        assert!(sent.success());
    };
    let mut client = connect(&name, root.path()).unwrap();
    let (subjects, context) = ([clearance::transports::shared_memory::PlainSubject::All; 2], Context::default());
    signal("-STOP");
    let stat = format!("/proc/{}/stat", daemon.0.id());
    // The signal is sent, and comes a moment later.
    eventually("the stop", || std::fs::read_to_string(&stat).unwrap().contains(") T ")).await;
    let short = Options { timeout: Duration::from_millis(300), ..Options::default() };
    let outcome = ask(&mut client, Ask::Collide(&subjects, &context), &short);
    assert!(matches!(outcome, Err(ClientError::Timeout(_))), "{outcome:?}");
    signal("-CONT");
    for _ in 0..20 {
        let reply = ask(&mut client, Ask::Collide(&subjects[..1], &context), &Options::default()).unwrap();
        assert_eq!(reply.items(), 1);
    }
}

/// Not a test by itself: runs where /dev/shm is small, fills it to the last byte, and asks.
#[tokio::test(flavor = "multi_thread")]
#[ignore = "a process of memory_that_becomes_full"]
async fn as_one_whose_memory_becomes_full() {
    let place = Place::with_crane(small()).await;
    let mut client = place.client();
    let mut filler = std::fs::File::create("/dev/shm/filler").unwrap();
    let block = vec![1; 4096];
    while std::io::Write::write_all(&mut filler, &block).is_ok() {}
    // Requests and answers of full size: every page of both segments is written to.
    let context =
        Context { wants: clearance::query::Wants { distance: true, ..Default::default() }, ..Context::default() };
    let question = crane_states([0.0, -0.2].repeat(10_000), context);
    for _ in 0..4 {
        let reply = ask(&mut client, Ask::States(&question, 2), &Options::default()).unwrap();
        assert_eq!(reply.items(), 10_000);
    }
    let long = crane_states([0.0, -0.2].repeat(60_000), Context::default());
    for _ in 0..4 {
        assert_eq!(ask(&mut client, Ask::States(&long, 2), &Options::default()).unwrap().items(), 60_000);
    }
    let error = connect(&place.name, &place.root()).unwrap_err();
    assert!(matches!(error, ClientError::NoSpace(_) | ClientError::NoDaemon { .. }), "{error}");
    println!("refused: {error}");
    assert!(ask(&mut client, Ask::States(&question, 2), &Options::default()).is_ok(), "those inside go on");
}

/// Pages are taken at the start: neither daemon nor client dies of SIGBUS when others fill /dev/shm.
#[tokio::test(flavor = "multi_thread")]
async fn memory_that_becomes_full_hurts_nobody_inside() {
    let program = std::env::current_exe().unwrap();
    let script = "mount -t tmpfs -o size=16m tmpfs /dev/shm && exec \"$0\" \"$@\"";
    let Some(mut command) = in_a_mount_namespace(script, &program) else { return };
    command.args(["--exact", "--ignored", "--nocapture", "shared_memory::faults::as_one_whose_memory_becomes_full"]);
    let output = tokio::task::block_in_place(|| command.output().unwrap());
    let text = [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned()).concat();
    assert!(output.status.success() && text.contains("1 passed"), "{:?} {text}", output.status);
}

/// `program` in a mount namespace of its own, after `script`; `None` where the system does not let this process make one.
fn in_a_mount_namespace(script: &str, program: &Path) -> Option<Command> {
    let may = Command::new("unshare").args(["--mount", "true"]).status().is_ok_and(|status| status.success());
    if !may {
        eprintln!("skipped: no mount namespaces here");
        return None;
    }
    let mut command = Command::new("unshare");
    command.args(["--mount", "sh", "-c", script]).arg(program);
    Some(command)
}

/// A daemon whose /dev/shm is a small file system of its own, as in a container; `None` where the system does not let
/// this process make one.
fn serve_in_small_memory(bytes: usize, arguments: &[&str]) -> Option<Command> {
    let script = format!("mount -t tmpfs -o size={bytes} tmpfs /dev/shm && exec \"$0\" \"$@\"");
    let mut command = in_a_mount_namespace(&script, Path::new(env!("CARGO_BIN_EXE_clearance")))?;
    command.arg("serve");
    command
        .args(["--grpc-address", "127.0.0.1:0", "--no-zenoh"])
        .args(arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    Some(command)
}

#[tokio::test(flavor = "multi_thread")]
async fn memory_that_is_too_small_is_told_at_the_start() {
    let (name, root) = (unused_name(), tempfile::tempdir().unwrap());
    let root_text = root.path().to_str().unwrap();
    let asked_for = ["--shared-memory-name", &name, "--shared-memory-root", root_text];
    let Some(mut command) = serve_in_small_memory(8 << 20, &asked_for) else { return };
    let output = tokio::task::block_in_place(|| command.output().unwrap());
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.contains("/dev/shm has 8388608 bytes free"), "{text}");

    // Not asked for: the daemon serves the other door, and says why not this one.
    let Some(mut command) = serve_in_small_memory(8 << 20, &["--shared-memory-root", root_text]) else { return };
    let mut child = Killed(command.spawn().unwrap());
    let stdout = child.0.stdout.take().unwrap();
    let line = tokio::task::spawn_blocking(move || BufReader::new(stdout).lines().next().unwrap().unwrap());
    let line = watched("the first line", line).await.unwrap();
    let address = line.strip_prefix("listening grpc ").unwrap_or_else(|| panic!("{line:?}"));
    let client = watched("connecting", grpc::Client::connect(address)).await.unwrap();
    client.create_scene(SCENE).await.unwrap();
    drop(child.0.kill());
    let mut text = String::new();
    child.0.stderr.take().unwrap().read_to_string(&mut text).unwrap();
    assert!(text.contains("there is no shared-memory door"), "{text}");
}
