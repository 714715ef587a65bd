//! The doors, each open beside the others to one service, and the bare stack under each.

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use tokio::runtime::{Handle, Runtime};

use super::super::exit_code::Failed;
#[cfg(feature = "shared-memory")]
use super::super::own_name::OwnName;
use super::asker::{Asker, Last};
use super::workload::Batch;
use crate::service::Service;
use crate::transports::echo::Echo;
use crate::transports::grpc::{self, BulkClient, BulkVerdicts, GrpcEcho};

/// A door with what is measured through it.
pub(super) struct OpenDoor {
    /// What it is called in tables.
    pub name: &'static str,
    /// Asks through it.
    pub asker: Box<dyn Asker>,
    /// The bare stack under it.
    pub floor: Box<dyn Echo>,
}

/// Where doors that are no ports are found.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place<'a> {
    /// For sockets, and for what both sides of shared memory know of each other.
    pub folder: &'a Path,
    /// What the memory is called.
    #[cfg(feature = "shared-memory")]
    pub own: &'a OwnName,
}

/// Every door of this build. `runtime` runs the daemon's side.
pub(super) fn open(
    service: &Arc<Service>,
    runtime: &Handle,
    place: Place<'_>,
    spin: Duration,
) -> Result<Vec<OpenDoor>, Failed> {
    let socket = |name: &str| place.folder.join(name).display().to_string();
    let tcp = serve_grpc(service, runtime, "127.0.0.1:0")?;
    let unix = serve_grpc(service, runtime, &format!("unix:{}", socket("clearance.sock")))?;
    let tcp_floor = GrpcEcho::new(runtime, None).map_err(Failed::failure)?;
    let unix_floor = GrpcEcho::new(runtime, Some(&socket("echo.sock"))).map_err(Failed::failure)?;
    let mut doors = vec![
        OpenDoor { name: "gRPC, TCP", asker: Box::new(Unary::new(&tcp)?), floor: Box::new(tcp_floor) },
        OpenDoor { name: "gRPC, Unix socket", asker: Box::new(Unary::new(&unix)?), floor: Box::new(unix_floor) },
    ];
    #[cfg(feature = "zenoh")]
    doors.push(zenoh_door::open(service, runtime)?);
    #[cfg(feature = "shared-memory")]
    doors.push(shared_memory::open(service, runtime, place, spin)?);
    Ok(doors)
}

/// Opens the gRPC door, and says where.
pub(super) fn serve_grpc(service: &Arc<Service>, runtime: &Handle, address: &str) -> Result<String, Failed> {
    let config = grpc::Config {
        address: address.to_owned(),
        insecure: false,
        tls: None,
        tokens: Vec::new(),
        allowed_origins: Vec::new(),
    };
    let listening = runtime.block_on(config.bind()).map_err(Failed::failure)?;
    let address = listening.door().address;
    runtime.spawn(listening.serve(Arc::clone(service), std::future::pending()));
    Ok(address)
}

/// One call after the other.
struct Unary {
    client: BulkClient,
    runtime: Runtime,
    sent: usize,
    answer: BulkVerdicts,
}

impl Unary {
    fn new(address: &str) -> Result<Self, Failed> {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().map_err(Failed::failure)?;
        let client = runtime.block_on(BulkClient::connect(address)).map_err(Failed::daemon)?;
        Ok(Self { client, runtime, sent: 0, answer: BulkVerdicts::default() })
    }
}

impl Asker for Unary {
    fn ask(&mut self, batch: &Batch) -> Result<(), Failed> {
        self.answer = self.runtime.block_on(self.client.check_states(&batch.message)).map_err(Failed::daemon)?;
        self.sent = batch.message.message_bytes();
        Ok(())
    }

    fn last(&self) -> Last {
        Last { free: self.answer.free(), sent: self.sent, came: self.answer.message_bytes() }
    }
}

#[cfg(feature = "zenoh")]
pub(super) mod zenoh_door {
    //! Through zenoh, over TCP.

    use super::*;
    use crate::transports::zenoh::{Client, Config, ZenohEcho};

    /// What the keys of the bench begin with.
    pub const PREFIX: &str = "bench";
    const PATIENCE: Duration = Duration::from_secs(60);

    pub fn open(service: &Arc<Service>, runtime: &Handle) -> Result<OpenDoor, Failed> {
        let endpoint = serve(service, runtime)?;
        let floor = Box::new(ZenohEcho::new(service.limits()).map_err(Failed::failure)?);
        Ok(OpenDoor { name: "zenoh, TCP", asker: Box::new(Queries::new(&endpoint)?), floor })
    }

    /// Opens the door on a free port.
    pub fn serve(service: &Arc<Service>, runtime: &Handle) -> Result<String, Failed> {
        let config = Config::on_loopback(PREFIX);
        let listening = runtime.block_on(config.bind(service)).map_err(Failed::failure)?;
        let endpoint = listening.door().address;
        runtime.spawn(listening.serve(std::future::pending()));
        Ok(endpoint)
    }

    /// One query after the other.
    pub struct Queries {
        client: Client,
        runtime: Runtime,
        sent: usize,
        answer: BulkVerdicts,
    }

    impl Queries {
        pub fn new(endpoint: &str) -> Result<Self, Failed> {
            // zenoh wants a runtime with threads beside the one that waits.
            let runtime = tokio::runtime::Builder::new_multi_thread().worker_threads(1).enable_all().build();
            let runtime = runtime.map_err(Failed::failure)?;
            let client = runtime.block_on(Client::connect(endpoint, PREFIX)).map_err(Failed::failure)?;
            Ok(Self { client, runtime, sent: 0, answer: BulkVerdicts::default() })
        }
    }

    /// One batch.
    pub async fn asked(client: &Client, batch: &Batch) -> Result<BulkVerdicts, Failed> {
        let called = client.call("Queries/CheckStates", batch.message.encoded(), PATIENCE);
        BulkVerdicts::decode(called.await.map_err(Failed::failure)?).map_err(Failed::daemon)
    }

    impl Asker for Queries {
        fn ask(&mut self, batch: &Batch) -> Result<(), Failed> {
            self.answer = self.runtime.block_on(asked(&self.client, batch))?;
            self.sent = batch.message.message_bytes();
            Ok(())
        }

        fn last(&self) -> Last {
            Last { free: self.answer.free(), sent: self.sent, came: self.answer.message_bytes() }
        }
    }
}

#[cfg(feature = "shared-memory")]
pub(super) mod shared_memory {
    //! Through memory that both sides see.

    use super::*;
    use crate::transports::shared_memory::{Ask, Client, Config, Options, Reply, SharedMemoryEcho};

    pub fn open(
        service: &Arc<Service>,
        runtime: &Handle,
        place: Place<'_>,
        spin: Duration,
    ) -> Result<OpenDoor, Failed> {
        let Place { folder, own } = place;
        serve(service, runtime, folder, own.name(), spin)?;
        let floor = SharedMemoryEcho::new(&own.of("echo"), folder, service.limits());
        let floor = Box::new(floor.map_err(Failed::failure)?);
        Ok(OpenDoor { name: "shared memory", asker: Box::new(Columns::new(own.name(), folder)?), floor })
    }

    /// Opens the door under a name that no other on this machine has.
    pub fn serve(
        service: &Arc<Service>,
        runtime: &Handle,
        folder: &Path,
        name: &str,
        spin: Duration,
    ) -> Result<(), Failed> {
        let config = Config { name: name.to_owned(), root: folder.to_owned(), spin };
        let listening = config.bind(service.limits()).map_err(Failed::failure)?;
        runtime.spawn(listening.serve(Arc::clone(service), std::future::pending()));
        Ok(())
    }

    /// One request after the other.
    pub struct Columns {
        client: Client,
        answer: Option<Reply>,
        sent: usize,
    }

    impl Columns {
        pub fn new(name: &str, folder: &Path) -> Result<Self, Failed> {
            let client = Client::connect(name, folder).map_err(Failed::failure)?;
            Ok(Self { client, answer: None, sent: 0 })
        }
    }

    impl Asker for Columns {
        fn ask(&mut self, batch: &Batch) -> Result<(), Failed> {
            let ask = Ask::States(&batch.question, batch.width);
            let options = Options { timeout: Duration::from_secs(60), ..Options::default() };
            self.answer = Some(self.client.ask(&batch.target, ask, &options).map_err(Failed::failure)?);
            // Header and table of sections have less than a kilobyte.
            self.sent = batch.question.positions.len() * size_of::<f64>() + 512;
            Ok(())
        }

        fn last(&self) -> Last {
            let free = self.answer.as_ref().map(Reply::free).unwrap_or_default();
            Last { free, sent: self.sent, came: self.answer.as_ref().map_or(0, Reply::message_bytes) }
        }
    }
}
