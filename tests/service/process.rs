//! `clearance serve` as its user sees it: what it prints, how it ends.

use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread::JoinHandle;

use clearance::transports::grpc::{Client, Credentials};
use clearance::transports::wire::v1;
use clearance::transports::wire::v1::queries_client::QueriesClient;

use crate::support::certificates::{Authority, Files, trusting};
use crate::support::watchdog::{eventually, watched};

pub fn serve() -> Command {
    serve_at("127.0.0.1:0")
}

fn serve_at(address: &str) -> Command {
    serve_with(&["--grpc-address", address, "--no-shared-memory", "--no-zenoh"])
}

/// With these arguments, and at any free port if they do not say where.
pub fn serve_with(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_clearance"));
    command.arg("serve").args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped());
    if !arguments.contains(&"--grpc-address") {
        command.args(["--grpc-address", "127.0.0.1:0"]);
    }
    command
}

/// A process that does not outlive its test.
pub struct Killed {
    child: Child,
    /// What it writes on stderr, read all the while: a full pipe would stop it.
    log: Option<JoinHandle<String>>,
}

impl Drop for Killed {
    fn drop(&mut self) {
        if self.child.try_wait().is_ok_and(|status| status.is_none()) {
            self.child.kill().and_then(|()| self.child.wait()).map(drop).unwrap_or_default();
        }
    }
}

impl Killed {
    /// A daemon, and where it says that gRPC listens.
    pub async fn listening(command: &mut Command) -> (Self, String) {
        Self::listening_at(command, "grpc").await
    }

    /// A daemon, and where it says that a door is.
    pub async fn listening_at(command: &mut Command, door: &str) -> (Self, String) {
        let mut child = command.spawn().unwrap();
        let (stdout, mut stderr) = (child.stdout.take().unwrap(), child.stderr.take().unwrap());
        let log = std::thread::spawn(move || {
            let mut text = String::new();
            stderr.read_to_string(&mut text).unwrap();
            text
        });
        let child = Self { child, log: Some(log) };
        let (sender, told) = tokio::sync::oneshot::channel();
        let begins = format!("listening {door} ");
        // It is read to its end: a daemon that cannot say where its other doors are does not begin.
        std::thread::spawn(move || {
            let mut lines = BufReader::new(stdout).lines().map_while(Result::ok);
            let line = lines.find(|line| line.starts_with(&begins));
            // Without a line the receiver finds nobody who sends.
            drop(line.map(|line| sender.send(line[begins.len()..].to_owned())));
            lines.for_each(drop);
        });
        let address = watched("where it listens", told).await.unwrap_or_else(|_| panic!("no line of the {door} door"));
        (child, address)
    }

    /// Told to end: its code, and what it wrote on stderr.
    pub async fn stopped(mut self) -> (Option<i32>, String) {
        self.signal("-TERM");
        let code = self.ended().await.code();
        (code, self.log.take().unwrap().join().unwrap())
    }

    pub fn signal(&self, signal: &str) {
        let kill = Command::new("kill").args([signal, &self.child.id().to_string()]).status().unwrap();
        assert!(kill.success());
    }

    pub fn id(&self) -> u32 {
        self.child.id()
    }

    pub fn kill(&mut self) {
        self.child.kill().unwrap();
    }

    async fn ended(&mut self) -> ExitStatus {
        let mut status = None;
        eventually("the end of the process", || {
            status = self.child.try_wait().unwrap();
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
    let (child, address) = Killed::listening(&mut serve()).await;
    let client = watched("connecting", Client::connect(&address)).await.unwrap();
    client.create_scene("cell").await.unwrap();
    assert_eq!(client.server_info().await.unwrap().version, env!("CARGO_PKG_VERSION"));
    assert_eq!(child.stopped().await.0, Some(0));
    let error = watched("a call to nobody", client.server_info()).await.unwrap_err();
    assert!(!error.to_string().is_empty());
}

#[tokio::test(flavor = "multi_thread")]
async fn a_killed_daemon_does_not_leave_the_readers_of_its_watches_waiting() {
    let (mut child, address) = Killed::listening(&mut serve()).await;
    watched("connecting", Client::connect(&address)).await.unwrap().create_scene("cell").await.unwrap();
    let mut queries = QueriesClient::connect(format!("http://{address}")).await.unwrap();
    let context = Some(v1::Context { scene: "cell".to_owned(), ..v1::Context::default() });
    let request = v1::WatchContactsRequest { context, ..v1::WatchContactsRequest::default() };
    let mut watch = queries.watch_contacts(request).await.unwrap().into_inner();
    assert_eq!(watched("the first step", watch.message()).await.unwrap().unwrap().revision, 0);
    child.child.kill().unwrap();
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

#[tokio::test(flavor = "multi_thread")]
async fn an_open_address_wants_tls_and_a_token_or_a_client_ca() {
    let (ca, files) = (Authority::new("ours"), Files::new());
    let server = ca.server();
    let (certificate, key) = (files.put("c.pem", &server.certificate), files.put("k.pem", &server.key));
    let authority = files.put("ca.pem", &ca.pem());
    let token = format!(
        "[[grpc.tokens]]\nname = \"planner\"\nfile = {:?}\nscopes = [\"read\"]\n",
        files.put("token", "a-token-of-the-planner")
    );
    let tokens = files.put("clearance.toml", &token);
    let with_tls = || {
        let mut command = serve_at("0.0.0.0:0");
        command.arg("--grpc-tls-certificate").arg(&certificate).arg("--grpc-tls-key").arg(&key);
        command
    };
    for mut insufficient in [serve_at("0.0.0.0:0"), with_tls()] {
        let (code, text) = refused(&mut insufficient);
        assert_eq!(code, Some(2), "{text}");
        assert!(text.contains("--insecure"), "{text}");
    }
    let (code, text) = refused(serve_at("0.0.0.0:0").arg("--config").arg(&tokens));
    assert_eq!(code, Some(2), "{text}");

    let (child, _) = Killed::listening(with_tls().arg("--grpc-tls-client-ca").arg(&authority)).await;
    assert_eq!(child.stopped().await.0, Some(0));
    let (child, address) = Killed::listening(with_tls().args(["--log", "trace"]).arg("--config").arg(&tokens)).await;
    let credentials = Credentials { token: Some("a-token-of-the-planner".to_owned()), ..trusting(&ca) };
    let address = address.replace("0.0.0.0", "https://localhost");
    let client = watched("connecting", Client::connect_as(&address, &credentials)).await.unwrap();
    assert!(client.server_info().await.is_ok());
    let wrong = Credentials { token: Some("another-token-altogether".to_owned()), ..credentials };
    let client = watched("connecting", Client::connect_as(&address, &wrong)).await.unwrap();
    assert!(client.server_info().await.is_err());
    drop(client);
    let (code, log) = child.stopped().await;
    assert_eq!(code, Some(0), "{log}");
    // Log lines name clients, and never a token.
    let log = log.replace("\u{1b}", "");
    assert!(log.contains("token:planner") && log.contains("UnknownToken"), "{log}");
    for secret in ["a-token-of-the-planner", "another-token-altogether"] {
        assert!(!log.contains(secret), "{log}");
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn files_of_tls_that_do_not_fit_are_told_by_name_and_an_expired_certificate_in_the_log() {
    let (ca, files) = (Authority::new("ours"), Files::new());
    let (server, other, expired) = (ca.server(), ca.server(), ca.expired_server());
    let [c, k] = [files.put("c.pem", &server.certificate), files.put("k.pem", &server.key)];
    let [other, empty] = [files.put("other.pem", &other.key), files.put("empty.pem", "")];
    let missing = other.with_file_name("missing.pem");
    let with = |certificate: &Path, key: &Path| {
        let mut command = serve();
        command.arg("--grpc-tls-certificate").arg(certificate).arg("--grpc-tls-key").arg(key);
        command
    };
    for (certificate, key, named) in [
        (&c, &other, "other.pem is not the key of"),
        (&empty, &k, "empty.pem: there is no certificate in it"),
        (&c, &empty, "empty.pem: "),
        (&missing, &k, "missing.pem: No such file"),
    ] {
        let (code, text) = refused(&mut with(certificate, key));
        assert_eq!(code, Some(3), "{text}");
        assert!(text.contains(named), "{text}");
    }
    let (code, text) = refused(serve().arg("--grpc-tls-key").arg(&k));
    assert_eq!(code, Some(2), "{text}");
    assert!(text.contains("grpc.tls: there is a key, but no certificate"), "{text}");
    let (c, k) = (files.put("expired.pem", &expired.certificate), files.put("its_key.pem", &expired.key));
    let (child, _) = Killed::listening(&mut with(&c, &k)).await;
    let (code, log) = child.stopped().await;
    assert_eq!(code, Some(0), "{log}");
    assert!(log.contains("ERROR") && log.contains("the certificate has expired"), "{log}");
}

#[tokio::test(flavor = "multi_thread")]
async fn a_unix_socket_is_left_behind_only_by_a_kill_and_replaced_then() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("clearance.sock");
    let address = format!("unix:{}", path.display());
    for killed in [true, false] {
        let (mut child, listens) = Killed::listening(&mut serve_at(&address)).await;
        assert_eq!(listens, address);
        let client = watched("connecting", Client::connect(&address)).await.unwrap();
        watched("a scene", client.create_scene("cell")).await.unwrap();
        // A second one is told that the first is there, and does it no harm.
        let (code, text) = refused(&mut serve_at(&address));
        assert_eq!(code, Some(1), "{text}");
        assert!(text.contains("another process listens there"), "{text}");
        assert!(client.server_info().await.is_ok());
        if killed {
            child.child.kill().unwrap();
            child.ended().await;
            assert!(path.exists());
        } else {
            assert_eq!(child.stopped().await.0, Some(0));
            assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
        }
    }
}
