//! How many states a second, when there is always more to ask? Every way of asking has as many batches under way.

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use tokio::runtime::Handle;
use tokio::task::JoinSet;

use super::super::exit_code::Failed;
use super::asker::asked;
use super::doors::{Place, serve_grpc};
use super::workload::{Batch, Workload};
use crate::service::Service;
use crate::transports::grpc::BulkClient;

/// States of one batch.
pub(super) const ITEMS: usize = 1024;
/// Batches under way.
const UNDER_WAY: usize = 4;
/// Every way is measured so often, in turn with the others.
const ROUNDS: usize = 5;

/// States a second of one way of asking, round by round.
#[derive(Clone, Debug)]
pub(super) struct Throughput {
    /// What it is called in tables.
    pub way: &'static str,
    /// States a second.
    pub rounds: Vec<f64>,
    /// What part of the throughput within the process it should have at least.
    pub target: Option<f64>,
}

impl Throughput {
    /// The median.
    pub fn median(&self) -> f64 {
        let mut sorted = self.rounds.clone();
        sorted.sort_by(f64::total_cmp);
        sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
    }
}

/// Batches done, and the time they took.
struct Run {
    batches: usize,
    seconds: f64,
}

/// Measures every way.
pub(super) fn measure(
    service: &Arc<Service>,
    runtime: &Handle,
    place: Place<'_>,
    workload: &Workload,
    seconds: f64,
) -> Result<Vec<Throughput>, Failed> {
    let batch = workload.batch(ITEMS);
    let time = Duration::from_secs_f64(seconds / 6.0);
    let address = serve_grpc(service, runtime, "127.0.0.1:0")?;
    let client = tokio::runtime::Builder::new_current_thread().enable_all().build().map_err(Failed::failure)?;
    let connection = client.block_on(BulkClient::connect(&address)).map_err(Failed::daemon)?;
    let way = |way, target| Throughput { way, rounds: Vec::new(), target };
    let mut here = way("within the process", None);
    let mut stream = way("gRPC, stream of batches", Some(0.7));
    let mut unary = way("gRPC, calls", None);
    #[cfg(feature = "zenoh")]
    let mut queries = way("zenoh, queries", Some(0.6));
    #[cfg(feature = "zenoh")]
    let zenoh_client = {
        use crate::transports::zenoh::Client;
        let endpoint = super::doors::zenoh_door::serve(service, runtime)?;
        let connected = runtime.block_on(Client::connect(&endpoint, super::doors::zenoh_door::PREFIX));
        Arc::new(connected.map_err(Failed::failure)?)
    };
    #[cfg(feature = "shared-memory")]
    let mut shared = way("shared memory", Some(0.9));
    #[cfg(feature = "shared-memory")]
    let (name, folder) = (place.own.of("busy"), place.folder);
    #[cfg(feature = "shared-memory")]
    super::doors::shared_memory::serve(service, runtime, folder, &name, Duration::ZERO)?;
    for _ in 0..ROUNDS {
        let run = client.block_on(within(service, &batch, time))?;
        here.rounds.push(per_second(&run));
        let run = client.block_on(streamed(&connection, &batch, time))?;
        stream.rounds.push(per_second(&run));
        let run = client.block_on(called(&connection, &batch, time))?;
        unary.rounds.push(per_second(&run));
        #[cfg(feature = "zenoh")]
        queries.rounds.push(per_second(&runtime.block_on(queried(&zenoh_client, &batch, time))?));
        #[cfg(feature = "shared-memory")]
        shared.rounds.push(per_second(&through_shared_memory((&name, folder), &batch, time)?));
    }
    Ok(vec![
        here,
        stream,
        unary,
        #[cfg(feature = "zenoh")]
        queries,
        #[cfg(feature = "shared-memory")]
        shared,
    ])
}

fn per_second(run: &Run) -> f64 {
    (run.batches * ITEMS) as f64 / run.seconds
}

/// Keeps work under way until the time is over, and waits for the rest.
async fn kept_busy<F: Future<Output = Result<(), String>> + Send + 'static>(
    time: Duration,
    work: impl Fn() -> F,
) -> Result<Run, Failed> {
    let (begun, mut batches, mut under_way) = (Instant::now(), 0, JoinSet::new());
    for _ in 0..UNDER_WAY {
        under_way.spawn(work());
    }
    while let Some(done) = under_way.join_next().await {
        done.map_err(Failed::failure)?.map_err(Failed::failure)?;
        batches += 1;
        if begun.elapsed() < time {
            under_way.spawn(work());
        }
    }
    Ok(Run { batches, seconds: begun.elapsed().as_secs_f64() })
}

async fn within(service: &Arc<Service>, batch: &Batch, time: Duration) -> Result<Run, Failed> {
    kept_busy(time, || {
        let (service, batch) = (Arc::clone(service), batch.clone());
        async move { asked(&service, &batch).await.map(drop).map_err(|error| error.to_string()) }
    })
    .await
}

async fn called(client: &BulkClient, batch: &Batch, time: Duration) -> Result<Run, Failed> {
    kept_busy(time, || {
        let (client, message) = (client.clone(), batch.message.clone());
        async move { client.check_states(&message).await.map(drop).map_err(|error| error.to_string()) }
    })
    .await
}

#[cfg(feature = "zenoh")]
async fn queried(client: &Arc<crate::transports::zenoh::Client>, batch: &Batch, time: Duration) -> Result<Run, Failed> {
    kept_busy(time, || {
        let (client, batch) = (Arc::clone(client), batch.clone());
        async move { super::doors::zenoh_door::asked(&client, &batch).await.map(drop).map_err(|error| error.message) }
    })
    .await
}

async fn streamed(client: &BulkClient, batch: &Batch, time: Duration) -> Result<Run, Failed> {
    let begun = Instant::now();
    let batches = client.stream(&batch.message, UNDER_WAY, || begun.elapsed() < time).await.map_err(Failed::daemon)?;
    Ok(Run { batches, seconds: begun.elapsed().as_secs_f64() })
}

/// A client has one request under way, so there are several clients, each with a thread.
#[cfg(feature = "shared-memory")]
fn through_shared_memory((name, folder): (&str, &Path), batch: &Batch, time: Duration) -> Result<Run, Failed> {
    use super::asker::Asker;
    use super::doors::shared_memory::Columns;
    let clients = (0..UNDER_WAY).map(|_| Columns::new(name, folder)).collect::<Result<Vec<_>, _>>()?;
    let begun = Instant::now();
    let batches = std::thread::scope(|scope| {
        let asking = clients.into_iter().map(|mut client| {
            scope.spawn(move || {
                let mut batches = 0;
                while begun.elapsed() < time {
                    client.ask(batch)?;
                    batches += 1;
                }
                Ok(batches)
            })
        });
        let asking: Vec<_> = asking.collect();
        let ended = asking.into_iter().map(|thread| thread.join().unwrap_or_else(|_| Err(Failed::failure("a panic"))));
        ended.sum::<Result<usize, Failed>>()
    })?;
    Ok(Run { batches, seconds: begun.elapsed().as_secs_f64() })
}
