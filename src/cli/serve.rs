//! `clearance serve`: the daemon. One line for each door on stdout, log lines on stderr, drained on SIGTERM.

use std::io::{self, Write};
use std::path::PathBuf;

use super::exit_code::Exit;
use crate::app::{
    Config, ConfigError, Daemon, Drained, GrpcSettings, Settings, SharedMemorySettings, StartError, defaults,
};
use crate::app::{log_to_stderr, stop_signal};

/// Flags of `clearance serve`. Each may also stand in the environment, or in the file.
#[derive(clap::Args, Clone, Debug)]
pub struct Serve {
    /// TOML file with the same settings; flags and environment win over it.
    #[arg(long, value_name = "FILE", env = "CLEARANCE_CONFIG")]
    pub config: Option<PathBuf>,
    /// Where gRPC listens; port 0 takes any free one.
    #[arg(long, value_name = "HOST:PORT", env = "CLEARANCE_GRPC_ADDRESS",
        help = format!("Where gRPC listens; port 0 takes any free one [default: {}]", defaults::GRPC_ADDRESS))]
    pub grpc_address: Option<String>,
    /// What the shared-memory door is called; with a name given, a daemon that cannot open it does not start.
    #[arg(long, value_name = "NAME", env = "CLEARANCE_SHARED_MEMORY_NAME",
        help = format!("What the shared-memory door is called; no other door of the machine may have the name [default: {}]", defaults::SHARED_MEMORY_NAME))]
    pub shared_memory_name: Option<String>,
    /// The folder of the shared-memory door.
    #[arg(long, value_name = "DIR", env = "CLEARANCE_SHARED_MEMORY_ROOT",
        help = format!("The folder of the shared-memory door [default: {}]", defaults::SHARED_MEMORY_ROOT))]
    pub shared_memory_root: Option<PathBuf>,
    /// No shared-memory door.
    #[arg(long, env = "CLEARANCE_NO_SHARED_MEMORY")]
    pub no_shared_memory: bool,
    /// Listen beyond loopback although there is neither TLS nor a token.
    #[arg(long, env = "CLEARANCE_INSECURE")]
    pub insecure: bool,
    /// Threads that answer questions; 0: one for each core [default: 0]
    #[arg(long, value_name = "N", env = "CLEARANCE_THREADS")]
    pub threads: Option<usize>,
    /// Seconds that requests under way may take to finish after SIGTERM.
    #[arg(long, value_name = "N", env = "CLEARANCE_DRAIN_SECONDS",
        help = format!("Seconds that requests under way may take to finish after SIGTERM [default: {}]", defaults::DRAIN_SECONDS))]
    pub drain_seconds: Option<u64>,
    /// Which log lines are written to stderr, for example `debug` or `clearance=debug,warn`.
    #[arg(long, value_name = "FILTER", env = "CLEARANCE_LOG",
        help = format!("Log lines written to stderr, for example `clearance=debug,warn` [default: {}]", defaults::LOG))]
    pub log: Option<String>,
    /// A cap of the service by its name in docs/operations.md; may be given several times.
    #[arg(long, value_name = "NAME=N", env = "CLEARANCE_LIMITS", value_delimiter = ',', value_parser = limit)]
    pub limit: Vec<(String, i64)>,
}

fn limit(text: &str) -> Result<(String, i64), String> {
    let (name, number) = text.split_once('=').ok_or("not NAME=N")?;
    let number = number.trim().parse().map_err(|_| format!("{number:?} is not a whole number"))?;
    Ok((name.trim().to_owned(), number))
}

/// Serves until SIGTERM or SIGINT.
pub fn run(serve: &Serve, output: &mut dyn Write) -> Exit {
    match configured(serve) {
        Ok(config) => started(&config, output),
        Err(error) => {
            let exit = match error {
                ConfigError::Unreadable { .. } | ConfigError::BadFile { .. } => Exit::Input,
                ConfigError::BadLimit { .. } => Exit::Usage,
            };
            failed(exit, &error)
        }
    }
}

fn configured(serve: &Serve) -> Result<Config, ConfigError> {
    let flags = Settings {
        threads: serve.threads,
        drain_seconds: serve.drain_seconds,
        log: serve.log.clone(),
        grpc: GrpcSettings { address: serve.grpc_address.clone(), insecure: serve.insecure.then_some(true) },
        shared_memory: SharedMemorySettings {
            enabled: serve.no_shared_memory.then_some(false),
            name: serve.shared_memory_name.clone(),
            root: serve.shared_memory_root.clone(),
            spin_microseconds: None,
        },
        limits: serve.limit.iter().map(|(name, number)| (name.clone(), (*number).into())).collect(),
    };
    let file = serve.config.as_deref().map(Settings::read).transpose()?;
    flags.over(file.unwrap_or_default()).resolve()
}

fn started(config: &Config, output: &mut dyn Write) -> Exit {
    if let Err(error) = log_to_stderr(&config.log) {
        return failed(Exit::Usage, &error);
    }
    let runtime = match tokio::runtime::Builder::new_multi_thread().enable_all().build() {
        Ok(runtime) => runtime,
        Err(error) => return failed(Exit::Failure, &error),
    };
    let exit = runtime.block_on(served(config, output));
    // Work that is still under way after the drain must not hold up the end of the process.
    runtime.shutdown_background();
    exit
}

async fn served(config: &Config, output: &mut dyn Write) -> Exit {
    let stop = match stop_signal() {
        Ok(stop) => stop,
        Err(error) => return failed(Exit::Failure, &error),
    };
    let daemon = match Daemon::build(config).await {
        Ok(daemon) => daemon,
        Err(error) => {
            let exit = match error {
                #[cfg(feature = "grpc")]
                StartError::Grpc(crate::transports::grpc::BindError::NotLoopback { .. }) => Exit::Usage,
                #[cfg(feature = "grpc")]
                StartError::Grpc(crate::transports::grpc::BindError::Address { .. }) => Exit::Failure,
                #[cfg(feature = "shared-memory")]
                StartError::SharedMemory(
                    crate::transports::shared_memory::BindError::Endpoint(_)
                    | crate::transports::shared_memory::BindError::TooSmall { .. },
                ) => Exit::Usage,
                #[cfg(feature = "shared-memory")]
                StartError::SharedMemory(
                    crate::transports::shared_memory::BindError::NoSpace(_)
                    | crate::transports::shared_memory::BindError::Taken { .. }
                    | crate::transports::shared_memory::BindError::System { .. },
                ) => Exit::Failure,
                StartError::Threads(_) => Exit::Failure,
            };
            return failed(exit, &error);
        }
    };
    if let Err(error) = announce(&daemon, output) {
        return failed(Exit::Failure, &error);
    }
    match daemon.run(stop).await {
        Ok(Drained::Clean) => Exit::Success,
        Ok(Drained::Late) => failed(Exit::Failure, &"requests were still under way when the time to drain was over"),
        Err(error) => failed(Exit::Failure, &error),
    }
}

/// One line for each door, so that whoever started the daemon knows where to ask.
fn announce(daemon: &Daemon, output: &mut dyn Write) -> io::Result<()> {
    for door in daemon.doors() {
        writeln!(output, "listening {} {}", door.kind, door.address)?;
    }
    output.flush()
}

fn failed(exit: Exit, problem: &dyn std::fmt::Display) -> Exit {
    eprintln!("clearance: {problem}");
    exit
}
