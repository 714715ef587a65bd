//! `clearance bench transports`: what each door costs beside the same work within the process and beside its bare stack.

use std::io::Write;
use std::net::TcpStream;
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::time::{Duration, Instant};

use tokio::runtime::Runtime;

use super::super::exit_code::Failed;
use super::super::folder::Folder;
#[cfg(feature = "shared-memory")]
use super::super::own_name::OwnName;
use super::asker::{Asker, InProcess};
use super::doors::{self, OpenDoor, Place};
use super::placement::Placement;
use super::report::{Report, Row};
use super::sampling::Times;
use super::throughput;
use super::workload::{Batch, Workload};
use crate::app::defaults;
use crate::limits::Limits;
use crate::service::{Config, Service};
use crate::transports::echo::{Echo, Parcel, SocketEcho};
use crate::transports::grpc::Client;

/// Flags of `clearance bench transports`.
#[derive(clap::Args, Clone, Debug)]
pub struct Transports {
    /// Robot states of one question.
    #[arg(long, value_name = "N", value_delimiter = ',', default_values_t = [1, 64, 1024, 65536])]
    items: Vec<usize>,
    /// Seconds that one door is measured with one number of items, about.
    #[arg(long, value_name = "SECONDS", default_value_t = 6.0)]
    seconds: f64,
    /// Microseconds that the shared-memory door looks for the next request before it sleeps.
    #[arg(long, value_name = "MICROSECONDS", default_value_t = defaults::SHARED_MEMORY_SPIN)]
    spin: u64,
    /// JSON lines instead of a table.
    #[arg(long)]
    json: bool,
}

/// Samples of one thing, at least and at most.
const FEWEST: usize = 5;
const MOST: usize = 3000;
/// Small questions are asked so often in a row.
const BLOCK: usize = 20;
const LARGE: usize = 10_000;
/// Rounds before samples are kept.
const WARM: usize = 3;

/// Opens every door and measures.
///
/// # Errors
/// A door that cannot be opened, answers that differ, or output that cannot be written.
pub(super) fn run(flags: &Transports, output: &mut dyn Write) -> Result<(), Failed> {
    // What is made first goes last.
    #[cfg(feature = "shared-memory")]
    let own = OwnName::new("bench");
    let (folder, placement) = (Folder::new()?, Placement::new()?);
    let place = Place {
        folder: folder.path(),
        #[cfg(feature = "shared-memory")]
        own: &own,
    };
    // The threads that answer questions run anywhere.
    let service = Service::new(&Config { threads: 0, limits: Limits::default() }).map_err(Failed::failure)?;
    placement.as_daemon()?;
    let runtime = threads()?;
    let address = doors::serve_grpc(&service, runtime.handle(), "127.0.0.1:0")?;
    let client = runtime.block_on(Client::connect(&address)).map_err(Failed::daemon)?;
    let probe = runtime.block_on(Workload::probe(&client))?;
    let mut doors = doors::open(&service, runtime.handle(), place, Duration::from_micros(flags.spin))?;
    let (mut tcp, mut unix) = bare_sockets(folder.path())?;
    placement.as_caller()?;
    let mut here = InProcess::new(&service)?;
    let mut report = Report::new(output, flags.json);
    report.begin(service.threads())?;
    for &items in &flags.items {
        let batch = probe.batch(items);
        for door in &mut doors {
            report.row(&compared(door, &mut here, &batch, flags.seconds)?)?;
        }
    }
    report.sockets()?;
    for &items in &flags.items {
        let parcel = Parcel::new(8 * probe.batch(items).question.positions.len(), 2 * items);
        let [tcp, unix] = [carried(&mut tcp, &parcel, flags.seconds)?, carried(&mut unix, &parcel, flags.seconds)?];
        report.socket(items, &tcp, &unix)?;
    }
    placement.anywhere()?;
    let unplaced = threads()?;
    let planner = runtime.block_on(Workload::planner(&client))?;
    let measured = throughput::measure(&service, unplaced.handle(), place, &planner, flags.seconds)?;
    report.throughput(&measured)?;
    unplaced.shutdown_background();
    runtime.shutdown_background();
    Ok(())
}

/// The daemon's tasks.
fn threads() -> Result<Runtime, Failed> {
    tokio::runtime::Builder::new_multi_thread().enable_all().build().map_err(Failed::failure)
}

fn bare_sockets(folder: &Path) -> Result<(SocketEcho<TcpStream>, SocketEcho<UnixStream>), Failed> {
    let tcp = SocketEcho::tcp().map_err(Failed::failure)?;
    let unix = SocketEcho::unix(&folder.join("bare.sock")).map_err(Failed::failure)?;
    Ok((tcp, unix))
}

/// A door, the same work within the process and the bare stack, in turn.
fn compared(door: &mut OpenDoor, here: &mut InProcess, batch: &Batch, seconds: f64) -> Result<Row, Failed> {
    door.asker.ask(batch)?;
    here.ask(batch)?;
    let last = door.asker.last();
    if last.free != here.last().free {
        return Err(Failed::failure(format!("{}: the verdicts are not those of the library", door.name)));
    }
    let parcel = Parcel::new(last.sent, last.came);
    let [mut through, mut within, mut bare] = <[Times; 3]>::default();
    let (mut begun, end) = (Instant::now(), Duration::from_secs_f64(seconds));
    let block = if batch.items < LARGE { BLOCK } else { 1 };
    for round in 0..WARM + MOST {
        if round == WARM {
            [through, within, bare] = <[Times; 3]>::default();
            begun = Instant::now();
        }
        if round >= WARM + FEWEST && begun.elapsed() > end {
            break;
        }
        within.take_block(block, || here.ask(batch))?;
        through.take_block(block, || door.asker.ask(batch))?;
        bare.take_block(block, || door.floor.exchange(&parcel).map_err(Failed::failure))?;
    }
    Ok(Row { door: door.name, items: batch.items, sent: last.sent, came: last.came, through, within, bare })
}

/// Bytes through a socket and back.
fn carried(echo: &mut dyn Echo, parcel: &Parcel, seconds: f64) -> Result<Times, Failed> {
    let mut times = Times::default();
    let (begun, end) = (Instant::now(), Duration::from_secs_f64(seconds / 6.0));
    while times.count() < FEWEST || times.count() < MOST && begun.elapsed() < end {
        times.take(|| echo.exchange(parcel).map_err(Failed::failure))?;
    }
    Ok(times)
}
