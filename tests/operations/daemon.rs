//! A daemon of its own process, and short words for what it is asked.

use std::io::{BufRead, BufReader, Read};
use std::process::{Child, Command, Stdio};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use clearance::transports::wire::v1;
use clearance::transports::wire::v1::queries_client::QueriesClient;
use clearance::transports::wire::v1::scenes_client::ScenesClient;
use tonic::transport::{Channel, Endpoint};

/// No test hangs.
pub const PATIENCE: Duration = Duration::from_secs(60);

/// A daemon that does not outlive its test.
pub struct Daemon {
    child: Child,
    pub grpc: String,
    pub zenoh: String,
    pub metrics: String,
    log: Option<JoinHandle<String>>,
}

/// `clearance serve` at free ports, without shared memory.
pub fn serve() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_clearance"));
    command.args(["serve", "--grpc-address", "127.0.0.1:0", "--no-shared-memory", "--no-zenoh"]);
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

impl Daemon {
    /// With metrics, and what else is said.
    pub fn start(flags: &[&str]) -> Self {
        Self::run(serve().args(["--metrics-address", "127.0.0.1:0"]).args(flags))
    }

    pub fn run(command: &mut Command) -> Self {
        let mut child = command.spawn().unwrap();
        let (stdout, mut stderr) = (child.stdout.take().unwrap(), child.stderr.take().unwrap());
        let log = std::thread::spawn(move || {
            let mut text = String::new();
            stderr.read_to_string(&mut text).unwrap();
            text
        });
        let mut daemon =
            Self { child, grpc: String::new(), zenoh: String::new(), metrics: String::new(), log: Some(log) };
        for line in BufReader::new(stdout).lines() {
            let line = line.unwrap();
            match line.strip_prefix("listening ").and_then(|line| line.split_once(' ')) {
                Some(("grpc", address)) => daemon.grpc = address.to_owned(),
                Some(("zenoh", endpoint)) => daemon.zenoh = endpoint.to_owned(),
                Some(("metrics", address)) => {
                    daemon.metrics = address.to_owned();
                    return daemon;
                }
                Some(_) | None => {}
            }
        }
        panic!("the daemon told no address of its metrics: {:?}", daemon.ended());
    }

    pub fn terminate(&self) {
        let kill = Command::new("kill").args(["-TERM", &self.child.id().to_string()]).status().unwrap();
        assert!(kill.success());
    }

    /// How it ended, and what it wrote on stderr.
    pub fn ended(&mut self) -> (Option<i32>, String) {
        let until = Instant::now() + PATIENCE;
        loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                return (status.code(), self.log.take().unwrap().join().unwrap());
            }
            assert!(Instant::now() < until, "the daemon does not end");
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    /// Told to end: how it ended, what it wrote on stderr, and how long that took.
    pub fn stop(mut self) -> (Option<i32>, String, Duration) {
        let begun = Instant::now();
        self.terminate();
        let (code, log) = self.ended();
        (code, log, begun.elapsed())
    }

    pub async fn channel(&self) -> Channel {
        Endpoint::new(format!("http://{}", self.grpc)).unwrap().timeout(PATIENCE).connect().await.unwrap()
    }

    pub async fn scenes(&self) -> ScenesClient<Channel> {
        ScenesClient::new(self.channel().await)
    }

    pub async fn queries(&self) -> QueriesClient<Channel> {
        QueriesClient::new(self.channel().await)
    }

    /// A scene with two balls that overlap, and a third that is far away.
    pub async fn with_balls(&self, scene: &str) {
        let mut scenes = self.scenes().await;
        let create = v1::CreateSceneRequest { name: scene.to_owned(), ..v1::CreateSceneRequest::default() };
        scenes.create_scene(create).await.unwrap();
        let edits = vec![ball("a", 0.0), ball("b", 0.5), ball("c", 10.0)];
        let apply = v1::ApplyRequest { scene: scene.to_owned(), edits, ..v1::ApplyRequest::default() };
        scenes.apply(apply).await.unwrap();
    }
}

impl Drop for Daemon {
    fn drop(&mut self) {
        if self.child.try_wait().is_ok_and(|status| status.is_none()) {
            self.child.kill().and_then(|()| self.child.wait()).map(drop).unwrap_or_default();
        }
    }
}

/// A ball of radius 0.5 on the x axis.
pub fn ball(name: &str, x: f64) -> v1::Edit {
    let core = v1::shape::Core::Sphere(v1::Sphere { radius: 0.5 });
    let body = v1::AddBody {
        name: name.to_owned(),
        shape: Some(v1::Shape { swept_radius: 0.0, core: Some(core) }),
        pose: Some(v1::Pose { translation: Some(v1::Vec3 { x, y: 0.0, z: 0.0 }), rotation: None }),
        ..v1::AddBody::default()
    };
    v1::Edit { kind: Some(v1::edit::Kind::AddBody(body)) }
}

/// What touches each of these bodies?
pub fn collide(scene: &str, bodies: &[&str]) -> v1::CollideRequest {
    let of = |name: &&str| {
        let by = Some(v1::body_ref::By::Name((*name).to_owned()));
        v1::Subject { kind: Some(v1::subject::Kind::Body(v1::BodyRef { by })) }
    };
    v1::CollideRequest {
        context: Some(v1::Context { scene: scene.to_owned(), ..v1::Context::default() }),
        items: bodies.iter().map(of).collect(),
        ..v1::CollideRequest::default()
    }
}
