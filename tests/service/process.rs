//! `clearance serve` as its user sees it: what it prints, how it ends.

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, ExitStatus, Stdio};

use clearance::transports::grpc::Client;
use clearance::transports::wire::v1;
use clearance::transports::wire::v1::queries_client::QueriesClient;

use crate::support::watchdog::{eventually, watched};

fn serve() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_clearance"));
    command
        .args(["serve", "--grpc-address", "127.0.0.1:0", "--no-shared-memory"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command
}

/// A process that does not outlive its test.
struct Killed(Child);

impl Drop for Killed {
    fn drop(&mut self) {
        if self.0.try_wait().is_ok_and(|status| status.is_none()) {
            self.0.kill().and_then(|()| self.0.wait()).map(drop).unwrap_or_default();
        }
    }
}

impl Killed {
    async fn ended(&mut self) -> ExitStatus {
        let mut status = None;
        eventually("the end of the process", || {
            status = self.0.try_wait().unwrap();
            status.is_some()
        })
        .await;
        status.unwrap()
    }
}

/// How a run ends that does not begin to serve, and what it says.
fn refused(command: &mut Command) -> (Option<i32>, String) {
    let output = command.output().unwrap();
    assert!(output.stdout.is_empty(), "{output:?}");
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

#[tokio::test(flavor = "multi_thread")]
async fn sigterm_ends_a_daemon_that_was_asked_with_success() {
    let mut child = Killed(serve().spawn().unwrap());
    let stdout = child.0.stdout.take().unwrap();
    let line = tokio::task::spawn_blocking(move || BufReader::new(stdout).lines().next().unwrap().unwrap());
    let line = watched("the first line", line).await.unwrap();
    let address = line.strip_prefix("listening grpc ").unwrap_or_else(|| panic!("{line:?}"));
    let client = watched("connecting", Client::connect(address)).await.unwrap();
    client.create_scene("cell").await.unwrap();
    assert_eq!(client.server_info().await.unwrap().version, env!("CARGO_PKG_VERSION"));
    let kill = Command::new("kill").args(["-TERM", &child.0.id().to_string()]).status().unwrap();
    assert!(kill.success());
    assert_eq!(child.ended().await.code(), Some(0));
    let error = watched("a call to nobody", client.server_info()).await.unwrap_err();
    assert!(!error.to_string().is_empty());
}

#[tokio::test(flavor = "multi_thread")]
async fn a_killed_daemon_does_not_leave_the_readers_of_its_watches_waiting() {
    let mut child = Killed(serve().spawn().unwrap());
    let stdout = child.0.stdout.take().unwrap();
    let line = tokio::task::spawn_blocking(move || BufReader::new(stdout).lines().next().unwrap().unwrap());
    let line = watched("the first line", line).await.unwrap();
    let address = line.strip_prefix("listening grpc ").unwrap_or_else(|| panic!("{line:?}"));
    watched("connecting", Client::connect(address)).await.unwrap().create_scene("cell").await.unwrap();
    let mut queries = QueriesClient::connect(format!("http://{address}")).await.unwrap();
    let context = Some(v1::Context { scene: "cell".to_owned(), ..v1::Context::default() });
    let request = v1::WatchContactsRequest { context, ..v1::WatchContactsRequest::default() };
    let mut watch = queries.watch_contacts(request).await.unwrap().into_inner();
    assert_eq!(watched("the first step", watch.message()).await.unwrap().unwrap().revision, 0);
    child.0.kill().unwrap();
    assert!(watched("the end of the watch", watch.message()).await.is_err());
}

#[test]
fn bad_configuration_is_told_by_exit_code_and_text() {
    let (code, text) = refused(serve().args(["--limit", "max_cheese=1"]));
    assert_eq!(code, Some(2), "{text}");
    assert!(text.contains("max_cheese"), "{text}");
    let (code, text) = refused(serve().args(["--threads", "many"]));
    assert_eq!(code, Some(2), "{text}");
    let (code, text) = refused(serve().args(["--config", "/no/such/file.toml"]));
    assert_eq!(code, Some(3), "{text}");
    assert!(text.contains("/no/such/file.toml"), "{text}");
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("clearance.toml");
    std::fs::write(&file, "[grpc]\nadress = \"127.0.0.1:0\"\n").unwrap();
    let (code, text) = refused(serve().arg("--config").arg(&file));
    assert_eq!(code, Some(3), "{text}");
    assert!(text.contains("adress"), "{text}");
}

#[test]
fn an_open_address_is_refused_unless_it_is_wanted() {
    let mut command = Command::new(env!("CARGO_BIN_EXE_clearance"));
    let (code, text) = refused(command.args(["serve", "--grpc-address", "0.0.0.0:0"]));
    assert_eq!(code, Some(2), "{text}");
    assert!(text.contains("--insecure"), "{text}");
}

#[test]
fn flags_win_over_the_environment_and_that_over_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("clearance.toml");
    std::fs::write(&file, "log = \"nonsense=from=file\"\n").unwrap();
    let (code, text) = refused(serve().arg("--config").arg(&file));
    assert_eq!(code, Some(2), "{text}");
    assert!(text.contains("from=file"), "{text}");
    let (_, text) = refused(serve().arg("--config").arg(&file).env("CLEARANCE_LOG", "nonsense=from=environment"));
    assert!(text.contains("from=environment"), "{text}");
    let flags = ["--log", "nonsense=from=flag"];
    let (_, text) = refused(serve().arg("--config").arg(&file).env("CLEARANCE_LOG", "x=y=z").args(flags));
    assert!(text.contains("from=flag"), "{text}");
}

#[test]
fn a_taken_port_is_told() {
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let address = taken.local_addr().unwrap().to_string();
    let mut command = Command::new(env!("CARGO_BIN_EXE_clearance"));
    let (code, text) = refused(command.args(["serve", "--grpc-address", &address]));
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains(&address), "{text}");
}
