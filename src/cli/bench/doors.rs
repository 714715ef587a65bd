//! The doors, each open beside the others to one service, and the bare stack under each.

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use prost::Message;
use tokio::runtime::{Handle, Runtime};
use tonic::transport::{Channel, Endpoint};

use super::super::exit_code::Failed;
use super::asker::{Asker, Last};
use super::workload::Batch;
use crate::service::Service;
use crate::transports::echo::Echo;
use crate::transports::grpc::{self, GrpcEcho};
use crate::transports::wire::v1;
use crate::transports::wire::v1::queries_client::QueriesClient;

/// A door with what is measured through it.
pub(super) struct OpenDoor {
    /// What it is called in tables.
    pub name: &'static str,
    /// Asks through it.
    pub asker: Box<dyn Asker>,
    /// The bare stack under it.
    pub floor: Box<dyn Echo>,
}

/// Every door of this build. `runtime` runs the daemon's side.
pub(super) fn open(
    service: &Arc<Service>,
    runtime: &Handle,
    folder: &Path,
    spin: Duration,
) -> Result<Vec<OpenDoor>, Failed> {
    let socket = |name: &str| folder.join(name).display().to_string();
    let tcp = serve_grpc(service, runtime, "127.0.0.1:0")?;
    let unix = serve_grpc(service, runtime, &format!("unix:{}", socket("clearance.sock")))?;
    let tcp_floor = GrpcEcho::new(runtime, None).map_err(Failed::failure)?;
    let unix_floor = GrpcEcho::new(runtime, Some(&socket("echo.sock"))).map_err(Failed::failure)?;
    let mut doors = vec![
        OpenDoor { name: "gRPC, TCP", asker: Box::new(Unary::new(&tcp)?), floor: Box::new(tcp_floor) },
        OpenDoor { name: "gRPC, Unix socket", asker: Box::new(Unary::new(&unix)?), floor: Box::new(unix_floor) },
    ];
    #[cfg(feature = "shared-memory")]
    doors.push(shared_memory::open(service, runtime, folder, spin)?);
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

/// A connection as clients make them.
pub(super) async fn connected(address: &str) -> Result<QueriesClient<Channel>, Failed> {
    const WINDOW: u32 = 8 << 20;
    let url = if address.starts_with("unix:") { address.to_owned() } else { format!("http://{address}") };
    let endpoint = Endpoint::from_shared(url).map_err(Failed::failure)?;
    let endpoint = endpoint.tcp_nodelay(true).initial_stream_window_size(WINDOW).initial_connection_window_size(WINDOW);
    let channel = endpoint.connect().await.map_err(Failed::failure)?;
    Ok(QueriesClient::new(channel).max_decoding_message_size(usize::MAX))
}

/// One call after the other.
struct Unary {
    queries: QueriesClient<Channel>,
    runtime: Runtime,
    sent: usize,
    answer: v1::CheckStatesResponse,
}

impl Unary {
    fn new(address: &str) -> Result<Self, Failed> {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().map_err(Failed::failure)?;
        let queries = runtime.block_on(connected(address))?;
        Ok(Self { queries, runtime, sent: 0, answer: v1::CheckStatesResponse::default() })
    }
}

impl Asker for Unary {
    fn ask(&mut self, batch: &Batch) -> Result<(), Failed> {
        let call = self.queries.check_states(batch.message.clone());
        self.answer = self.runtime.block_on(call).map_err(Failed::failure)?.into_inner();
        self.sent = batch.message.encoded_len();
        Ok(())
    }

    fn last(&self) -> Last {
        let bulk = self.answer.answer.as_ref().and_then(|answer| answer.bulk.clone()).unwrap_or_default();
        Last::of_bulk(&bulk.verdicts, self.sent, self.answer.encoded_len())
    }
}

#[cfg(feature = "shared-memory")]
pub(super) mod shared_memory {
    //! Through memory that both sides see.

    use super::*;
    use crate::transports::shared_memory::layout::kind;
    use crate::transports::shared_memory::{Ask, Client, Config, Options, Reply, SharedMemoryEcho};

    pub fn open(service: &Arc<Service>, runtime: &Handle, folder: &Path, spin: Duration) -> Result<OpenDoor, Failed> {
        let name = format!("bench-{}", std::process::id());
        serve(service, runtime, folder, &name, spin)?;
        let floor = SharedMemoryEcho::new(&format!("{name}-echo"), folder, service.limits());
        let floor = Box::new(floor.map_err(Failed::failure)?);
        Ok(OpenDoor { name: "shared memory", asker: Box::new(Columns::new(&name, folder)?), floor })
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
            let verdicts = self.answer.as_ref().and_then(|answer| answer.bytes(kind::VERDICTS)).unwrap_or_default();
            let came = self.answer.as_ref().map_or(0, Reply::message_bytes);
            Last::of_bulk(&prost::bytes::Bytes::copy_from_slice(verdicts), self.sent, came)
        }
    }
}
