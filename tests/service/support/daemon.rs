//! A whole daemon in this process, on a free port, told to end when its test is over.

use std::sync::Arc;

use clearance::app::{Config, Daemon, Drained, GrpcSettings, Settings, SharedMemorySettings, ZenohSettings};
use clearance::limits::Limits;
use clearance::service::Service;
use tokio::sync::oneshot;
use tokio::task::JoinHandle;

use super::watchdog::watched;

pub struct RunningDaemon {
    pub service: Arc<Service>,
    pub address: String,
    stop: oneshot::Sender<()>,
    task: JoinHandle<Drained>,
}

pub fn config(limits: Limits) -> Config {
    let address = Some("127.0.0.1:0".to_owned());
    // Tests run beside one another; those of other doors give them names and ports of their own.
    let shared_memory = SharedMemorySettings { enabled: Some(false), ..SharedMemorySettings::default() };
    let zenoh = ZenohSettings { enabled: Some(false), ..ZenohSettings::default() };
    let grpc = GrpcSettings { address, ..GrpcSettings::default() };
    let settings = Settings { threads: Some(2), grpc, shared_memory, zenoh, ..Settings::default() };
    let mut config = settings.resolve().unwrap();
    config.service.limits = limits;
    config
}

impl RunningDaemon {
    pub async fn start(config: &Config) -> Self {
        let daemon = Daemon::build(config).await.unwrap();
        let service = Arc::clone(daemon.service());
        let address = daemon.doors()[0].address.clone();
        let (stop, told_to_stop) = oneshot::channel();
        let run = daemon.run(async { told_to_stop.await.unwrap_or_default() });
        let task = tokio::spawn(async { run.await.unwrap() });
        Self { service, address, stop, task }
    }

    pub async fn stop(self) -> Drained {
        self.stop.send(()).unwrap();
        watched("draining", self.task).await.unwrap()
    }
}
