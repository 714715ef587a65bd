//! `clearance serve`: the daemon. One line for each door on stdout, log lines on stderr, drained on SIGTERM.

use std::io::{self, Write};
use std::path::PathBuf;

use super::exit_code::Exit;
use crate::app::{
    BadLogging, LogFormat, Logging, MetricsSettings, ServiceState, TracesSettings, stop_signal, tell_service_manager,
};
use crate::app::{
    Config, ConfigError, Daemon, Drained, GrpcSettings, Settings, SharedMemorySettings, StartError, TlsSettings,
    ZenohSettings, defaults,
};
#[cfg(feature = "metrics")]
use crate::observability::EndpointError;
#[cfg(feature = "grpc")]
use crate::transports::grpc;
#[cfg(feature = "shared-memory")]
use crate::transports::shared_memory;
#[cfg(feature = "zenoh")]
use crate::transports::zenoh as zenoh_door;

/// Flags of `clearance serve`. Each may also stand in the environment, or in the file.
#[derive(clap::Args, Clone, Debug)]
pub struct Serve {
    /// TOML file with the same settings; flags and environment win over it.
    #[arg(long, value_name = "FILE", env = "CLEARANCE_CONFIG")]
    pub config: Option<PathBuf>,
    /// Where gRPC listens; port 0 takes any free one.
    #[arg(long, value_name = "HOST:PORT|unix:PATH", env = "CLEARANCE_GRPC_ADDRESS",
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
    /// Endpoints where zenoh's clients and peers connect; port 0 takes any free one.
    #[arg(long, value_name = "ENDPOINT", env = "CLEARANCE_ZENOH_LISTEN", value_delimiter = ',',
        help = format!("Endpoints where zenoh listens, for example tcp/127.0.0.1:0 [default: {}]", defaults::ZENOH_LISTEN))]
    pub zenoh_listen: Option<Vec<String>>,
    /// Endpoints of zenoh's routers that the daemon connects to, for example tls/router.example:7447 [default: none]
    #[arg(long, value_name = "ENDPOINT", env = "CLEARANCE_ZENOH_CONNECT", value_delimiter = ',')]
    pub zenoh_connect: Option<Vec<String>>,
    /// What the daemon's keys begin with; daemons of one network need different ones.
    #[arg(long, value_name = "KEY", env = "CLEARANCE_ZENOH_PREFIX",
        help = format!("What the daemon's keys in zenoh begin with [default: {}]", defaults::ZENOH_PREFIX))]
    pub zenoh_prefix: Option<String>,
    /// zenoh's own configuration (JSON5), for TLS, certificates, passwords, access control [default: none]
    #[arg(long, value_name = "FILE", env = "CLEARANCE_ZENOH_FILE")]
    pub zenoh_file: Option<PathBuf>,
    /// Let zenoh look for others by multicast and gossip.
    #[arg(long, env = "CLEARANCE_ZENOH_SCOUTING")]
    pub zenoh_scouting: bool,
    /// No zenoh door.
    #[arg(long, env = "CLEARANCE_NO_ZENOH")]
    pub no_zenoh: bool,
    /// Listen beyond loopback although it is not both encrypted and closed to strangers.
    #[arg(long, env = "CLEARANCE_INSECURE")]
    pub insecure: bool,
    /// Certificate that gRPC shows, and those between it and a root (PEM).
    #[arg(long, value_name = "FILE", env = "CLEARANCE_GRPC_TLS_CERTIFICATE")]
    pub grpc_tls_certificate: Option<PathBuf>,
    /// Private key of that certificate (PEM).
    #[arg(long, value_name = "FILE", env = "CLEARANCE_GRPC_TLS_KEY")]
    pub grpc_tls_key: Option<PathBuf>,
    /// Certificates of which one must have signed every client's (PEM) [default: clients need none]
    #[arg(long, value_name = "FILE", env = "CLEARANCE_GRPC_TLS_CLIENT_CA")]
    pub grpc_tls_client_ca: Option<PathBuf>,
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
    /// How log lines look [default: text]
    #[arg(long, value_name = "text|json", env = "CLEARANCE_LOG_FORMAT")]
    pub log_format: Option<LogFormat>,
    /// Log calls that take at least so many seconds, at most one line a second; 0: none [default: 0]
    #[arg(long, value_name = "SECONDS", env = "CLEARANCE_SLOW_QUERY_SECONDS")]
    pub slow_query_seconds: Option<f64>,
    /// Where /metrics, /livez and /readyz are, over HTTP; port 0 takes any free one [default: nowhere]
    #[arg(long, value_name = "HOST:PORT", env = "CLEARANCE_METRICS_ADDRESS")]
    pub metrics_address: Option<String>,
    /// Let them be beyond loopback: whoever reaches them reads the names of scenes and how busy the daemon is.
    #[arg(long, env = "CLEARANCE_METRICS_EXPOSED")]
    pub metrics_exposed: bool,
    /// Collector of OpenTelemetry that spans of calls are sent to (OTLP over gRPC) [default: none]
    #[arg(long, value_name = "http://HOST:PORT", env = "CLEARANCE_TRACES_ENDPOINT")]
    pub traces_endpoint: Option<String>,
    /// Of calls that come without a trace, this share begins one.
    #[arg(long, value_name = "0..1", env = "CLEARANCE_TRACES_SAMPLE_RATIO",
        help = format!("Of calls that come without a trace, this share begins one [default: {}]", defaults::TRACES_SAMPLE_RATIO))]
    pub traces_sample_ratio: Option<f64>,
    /// Read the configuration, say what is wrong with it, and end. Files that it names are not read.
    #[arg(long)]
    pub check: bool,
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
        Ok(_) if serve.check => Exit::Success,
        Ok(config) => started(&config, output),
        Err(error) => {
            let exit = match error {
                ConfigError::Unreadable { .. } | ConfigError::BadFile { .. } => Exit::Input,
                ConfigError::BadLimit { .. }
                | ConfigError::BadDoor { .. }
                | ConfigError::BadValue { .. }
                | ConfigError::NotBuiltIn { .. } => Exit::Usage,
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
        log_format: serve.log_format,
        slow_query_seconds: serve.slow_query_seconds,
        grpc: GrpcSettings {
            address: serve.grpc_address.clone(),
            insecure: serve.insecure.then_some(true),
            tls: TlsSettings {
                certificate: serve.grpc_tls_certificate.clone(),
                key: serve.grpc_tls_key.clone(),
                client_ca: serve.grpc_tls_client_ca.clone(),
            },
            ..GrpcSettings::default()
        },
        shared_memory: SharedMemorySettings {
            enabled: serve.no_shared_memory.then_some(false),
            name: serve.shared_memory_name.clone(),
            root: serve.shared_memory_root.clone(),
            spin_microseconds: None,
        },
        zenoh: ZenohSettings {
            enabled: serve.no_zenoh.then_some(false),
            prefix: serve.zenoh_prefix.clone(),
            listen: serve.zenoh_listen.clone(),
            connect: serve.zenoh_connect.clone(),
            scouting: serve.zenoh_scouting.then_some(true),
            file: serve.zenoh_file.clone(),
            insecure: serve.insecure.then_some(true),
        },
        metrics: MetricsSettings {
            address: serve.metrics_address.clone(),
            exposed: serve.metrics_exposed.then_some(true),
            scenes: None,
        },
        traces: TracesSettings { endpoint: serve.traces_endpoint.clone(), sample_ratio: serve.traces_sample_ratio },
        limits: serve.limit.iter().map(|(name, number)| (name.clone(), (*number).into())).collect(),
    };
    let file = serve.config.as_deref().map(Settings::read).transpose()?;
    flags.over(file.unwrap_or_default()).resolve()
}

fn started(config: &Config, output: &mut dyn Write) -> Exit {
    let runtime = match tokio::runtime::Builder::new_multi_thread().enable_all().build() {
        Ok(runtime) => runtime,
        Err(error) => return failed(Exit::Failure, &error),
    };
    let logging = match runtime.block_on(async { Logging::begin(config) }) {
        Ok(logging) => logging,
        Err(error @ BadLogging::Filter { .. }) => return failed(Exit::Usage, &error),
        #[cfg(feature = "traces")]
        Err(error @ BadLogging::Traces(_)) => return failed(Exit::Usage, &error),
    };
    let exit = runtime.block_on(served(config, output));
    logging.finish();
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
            let exit = match &error {
                #[cfg(feature = "grpc")]
                StartError::Grpc(error) => exit_of_grpc(error),
                #[cfg(feature = "shared-memory")]
                StartError::SharedMemory(error) => exit_of_shared_memory(error),
                #[cfg(feature = "zenoh")]
                StartError::Zenoh(error) => exit_of_zenoh(error),
                #[cfg(feature = "metrics")]
                StartError::Metrics(EndpointError::NotLoopback { .. }) => Exit::Usage,
                #[cfg(feature = "metrics")]
                StartError::Metrics(EndpointError::Address { .. }) => Exit::Failure,
                StartError::Threads(_) => Exit::Failure,
            };
            return failed(exit, &error);
        }
    };
    if let Err(error) = announce(&daemon, output) {
        return failed(Exit::Failure, &error);
    }
    tell_service_manager(ServiceState::Ready);
    let stop = async {
        stop.await;
        tell_service_manager(ServiceState::Stopping);
    };
    match daemon.run(stop).await {
        Ok(Drained::Clean) => Exit::Success,
        Ok(Drained::Late) => failed(Exit::Failure, &"requests were still under way when the time to drain was over"),
        Err(error) => failed(Exit::Failure, &error),
    }
}

/// How the process ends when the door cannot be opened.
#[cfg(feature = "grpc")]
fn exit_of_grpc(error: &grpc::BindError) -> Exit {
    use grpc::BindError;
    match error {
        BindError::Address { .. } => Exit::Failure,
        BindError::NotLoopback { .. } | BindError::TlsOnUnix { .. } | BindError::Origin(_) => Exit::Usage,
        BindError::Tls(_) | BindError::Token(_) => Exit::Input,
    }
}

/// How the process ends when the door cannot be opened.
#[cfg(feature = "shared-memory")]
fn exit_of_shared_memory(error: &shared_memory::BindError) -> Exit {
    use shared_memory::BindError;
    match error {
        BindError::Endpoint(_) | BindError::TooSmall { .. } => Exit::Usage,
        BindError::NoSpace(_) | BindError::Taken { .. } | BindError::System { .. } => Exit::Failure,
    }
}

/// How the process ends when the door cannot be opened.
#[cfg(feature = "zenoh")]
fn exit_of_zenoh(error: &zenoh_door::BindError) -> Exit {
    use zenoh_door::{BadConfig, BindError};
    match error {
        BindError::Config(BadConfig::File { .. }) => Exit::Input,
        BindError::Config(
            BadConfig::Prefix(_) | BadConfig::NoEndpoint { .. } | BadConfig::Exposed { .. } | BadConfig::Refused { .. },
        ) => Exit::Usage,
        BindError::System(_) => Exit::Failure,
    }
}

/// One line for each door, and for the metrics, so that whoever started the daemon knows where to ask.
fn announce(daemon: &Daemon, output: &mut dyn Write) -> io::Result<()> {
    for door in daemon.doors() {
        writeln!(output, "listening {} {}", door.kind, door.address)?;
    }
    if let Some(address) = daemon.metrics_address() {
        writeln!(output, "listening metrics {address}")?;
    }
    output.flush()
}

fn failed(exit: Exit, problem: &dyn std::fmt::Display) -> Exit {
    eprintln!("clearance: {problem}");
    exit
}
