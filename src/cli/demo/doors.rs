//! The same question through every door of the daemon: are the answers equal, and what does each door take?

use std::path::PathBuf;
use std::time::{Duration, Instant};

use super::super::exit_code::Failed;
use crate::query::CheckStates;
use crate::service::{Door, Target};
use crate::transports::grpc::{BulkClient, BulkStates};

/// Times that each door is asked.
const TIMES: usize = 15;
/// How long an answer is waited for.
#[cfg(feature = "zenoh")]
const PATIENCE: Duration = Duration::from_secs(60);

/// What came through one door.
pub struct Through {
    /// The door.
    pub door: &'static str,
    /// For each state whether it is proved free.
    pub free: Vec<bool>,
    /// The median time of a question, seconds.
    pub median: f64,
}

/// Where the daemon of the tour has its doors.
pub struct Doors {
    /// As the daemon lists them.
    pub open: Vec<Door>,
    /// The folder of its shared memory.
    pub folder: PathBuf,
}

/// What is asked of each.
pub struct Asked<'a> {
    /// Of which scene.
    pub target: &'a Target,
    /// In which states.
    pub question: &'a CheckStates,
    /// Numbers of one state.
    pub width: usize,
}

impl Doors {
    /// Asks through each, one after the other.
    ///
    /// # Errors
    /// A door that gives no answer, or one that the tour does not know.
    pub async fn ask(&self, asked: &Asked<'_>) -> Result<Vec<Through>, Failed> {
        let mut all = Vec::new();
        for door in &self.open {
            all.push(match door.kind {
                "grpc" => through_grpc(&door.address, asked).await?,
                #[cfg(feature = "shared-memory")]
                "shared-memory" => {
                    let ask = || through_shared_memory(&door.address, &self.folder, asked);
                    tokio::task::block_in_place(ask)?
                }
                #[cfg(feature = "zenoh")]
                "zenoh" => through_zenoh(&door.address, asked).await?,
                unknown => return Err(Failed::failure(format!("the tour does not know the door {unknown:?}"))),
            });
        }
        Ok(all)
    }
}

async fn through_grpc(address: &str, asked: &Asked<'_>) -> Result<Through, Failed> {
    let client = BulkClient::connect(address).await.map_err(Failed::daemon)?;
    let batch = BulkStates::new(asked.target, asked.question);
    let (mut times, mut free) = (Vec::new(), Vec::new());
    for _ in 0..TIMES {
        let begun = Instant::now();
        let verdicts = client.check_states(&batch).await.map_err(Failed::daemon)?;
        times.push(begun.elapsed());
        free = verdicts.free();
    }
    Ok(Through { door: "gRPC", free, median: median(times) })
}

#[cfg(feature = "shared-memory")]
fn through_shared_memory(name: &str, folder: &std::path::Path, asked: &Asked<'_>) -> Result<Through, Failed> {
    use crate::transports::shared_memory::{Ask, Client, Options};
    let mut client = Client::connect(name, folder).map_err(Failed::daemon)?;
    let ask = Ask::States(asked.question, asked.width);
    let (mut times, mut free) = (Vec::new(), Vec::new());
    for _ in 0..TIMES {
        let begun = Instant::now();
        let reply = client.ask(asked.target, ask, &Options::default()).map_err(Failed::daemon)?;
        times.push(begun.elapsed());
        free = reply.free();
    }
    Ok(Through { door: "shared memory", free, median: median(times) })
}

#[cfg(feature = "zenoh")]
async fn through_zenoh(endpoint: &str, asked: &Asked<'_>) -> Result<Through, Failed> {
    use crate::app::defaults::ZENOH_PREFIX;
    use crate::transports::grpc::BulkVerdicts;
    use crate::transports::zenoh::Client;
    let client = Client::connect(endpoint, ZENOH_PREFIX).await.map_err(Failed::daemon)?;
    let message = BulkStates::new(asked.target, asked.question).encoded();
    let (mut times, mut free) = (Vec::new(), Vec::new());
    for _ in 0..TIMES {
        let begun = Instant::now();
        let called = client.call("Queries/CheckStates", message.clone(), PATIENCE).await;
        let verdicts = BulkVerdicts::decode(called.map_err(Failed::daemon)?).map_err(Failed::daemon)?;
        times.push(begun.elapsed());
        free = verdicts.free();
    }
    Ok(Through { door: "zenoh", free, median: median(times) })
}

fn median(mut times: Vec<Duration>) -> f64 {
    times.sort_unstable();
    times.get(times.len() / 2).map_or(f64::NAN, Duration::as_secs_f64)
}
