//! The same question through every door of the daemon: are the answers equal, and what does each door take?

use std::path::PathBuf;
use std::time::{Duration, Instant};

use super::super::exit_code::Failed;
use crate::query::CheckStates;
use crate::service::{Door, Target};
use crate::transports::grpc::{BulkClient, BulkStates};

/// Times that each door is asked.
const TIMES: usize = 15;

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

impl Doors {
    /// Asks through each, one after the other; a state has `width` numbers.
    ///
    /// # Errors
    /// A door that gives no answer.
    pub async fn ask(&self, target: &Target, (question, width): (&CheckStates, usize)) -> Result<Vec<Through>, Failed> {
        // Only columns of shared memory have to be told.
        _ = width;
        let mut all = Vec::new();
        for door in &self.open {
            match door.kind {
                "grpc" => all.push(through_grpc(&door.address, target, question).await?),
                #[cfg(feature = "shared-memory")]
                "shared-memory" => {
                    let ask = || through_shared_memory(&door.address, &self.folder, target, (question, width));
                    all.push(tokio::task::block_in_place(ask)?);
                }
                _ => {}
            }
        }
        Ok(all)
    }
}

async fn through_grpc(address: &str, target: &Target, question: &CheckStates) -> Result<Through, Failed> {
    let client = BulkClient::connect(address).await.map_err(Failed::daemon)?;
    let batch = BulkStates::new(target, question);
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
fn through_shared_memory(
    name: &str,
    folder: &std::path::Path,
    target: &Target,
    (question, width): (&CheckStates, usize),
) -> Result<Through, Failed> {
    use crate::transports::shared_memory::{Ask, Client, Options};
    let mut client = Client::connect(name, folder).map_err(Failed::daemon)?;
    let ask = Ask::States(question, width);
    let (mut times, mut free) = (Vec::new(), Vec::new());
    for _ in 0..TIMES {
        let begun = Instant::now();
        let reply = client.ask(target, ask, &Options::default()).map_err(Failed::daemon)?;
        times.push(begun.elapsed());
        free = reply.free();
    }
    Ok(Through { door: "shared memory", free, median: median(times) })
}

fn median(mut times: Vec<Duration>) -> f64 {
    times.sort_unstable();
    times.get(times.len() / 2).map_or(f64::NAN, Duration::as_secs_f64)
}
