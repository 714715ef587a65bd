//! How busy is the daemon just now, and how near to its limits? Read from the service at the moment of a scrape.

use std::fmt;
use std::sync::Arc;
use std::time::Instant;

use prometheus_client::collector::Collector;
use prometheus_client::encoding::DescriptorEncoder;

use super::exposition::Exposition;
use crate::service::{Service, Traffic};

/// Figures of the daemon as a whole, and of its doors.
#[derive(Debug)]
pub(super) struct DaemonMetrics {
    service: Arc<Service>,
    since: Instant,
}

impl DaemonMetrics {
    pub fn new(service: Arc<Service>) -> Self {
        Self { service, since: Instant::now() }
    }
}

/// The doors that this program was built with, separated by commas.
fn doors_built_in() -> String {
    let doors = [
        ("grpc", cfg!(feature = "grpc")),
        ("shared-memory", cfg!(feature = "shared-memory")),
        ("zenoh", cfg!(feature = "zenoh")),
    ];
    doors.into_iter().filter_map(|(door, built_in)| built_in.then_some(door)).collect::<Vec<_>>().join(",")
}

impl Collector for DaemonMetrics {
    fn encode(&self, encoder: DescriptorEncoder) -> fmt::Result {
        let (service, mut out) = (&self.service, Exposition::new(encoder));
        let build = [("version", env!("CARGO_PKG_VERSION").to_owned()), ("doors", doors_built_in())];
        out.gauges("clearance_build_info", "1; what the program is", [(build, 1.0)])?;
        out.gauge("clearance_uptime_seconds", "Time since the start", self.since.elapsed().as_secs_f64())?;
        let draining = f64::from(u8::from(service.is_draining()));
        out.gauge("clearance_draining", "1 while the daemon ends and takes no new requests", draining)?;
        for (name, help, count) in [
            ("clearance_query_threads", "Threads that answer questions", service.threads()),
            (
                "clearance_queries_in_flight",
                "Questions being answered or waiting for a thread",
                service.queries_in_flight(),
            ),
            (
                "clearance_queries_waiting",
                "Pieces of work that wait for a thread which answers questions",
                service.waiting_for_threads(),
            ),
            ("clearance_watchers", "Callers that watch scenes or contacts", service.watchers()),
            ("clearance_streams", "Streams of poses or questions", service.streams()),
            ("clearance_uploads_in_flight", "Uploads and robot loadings under way", service.uploads_in_flight()),
            ("clearance_robot_models", "Robot models", service.robots().list().len()),
            ("clearance_assets_bytes", "Bytes of all uploaded files", service.library().assets().total_bytes()),
            ("clearance_scenes", "Scenes", service.scene_count()),
        ] {
            out.gauge(name, help, count as f64)?;
        }
        let limits = service.limits().table();
        let limits = limits.iter().map(|limit| ([("limit", limit.name)], limit.value as f64));
        out.gauges("clearance_limit", "The limits as they are set", limits)?;
        let doors = service.all_traffic();
        let mut counted = |name: &str, help: &str, count: fn(&Traffic) -> u64| {
            out.counters(name, help, doors.iter().map(|(door, traffic)| ([("door", *door)], count(traffic) as f64)))
        };
        counted("clearance_received_bytes", "Bytes of messages that came", |door| door.received_bytes.get())?;
        counted("clearance_sent_bytes", "Bytes of messages that went", |door| door.sent_bytes.get())?;
        counted("clearance_connections_opened", "Connections that were let in", |door| door.connections_opened.get())?;
        counted("clearance_connections_refused", "Connections closed at once: there were too many", |door| {
            door.connections_refused.get()
        })?;
        counted("clearance_handshakes_failed", "Connections that did not finish to shake hands", |door| {
            door.handshakes_failed.get()
        })?;
        let open = doors.iter().map(|(door, traffic)| {
            let closed = traffic.connections_closed.get();
            ([("door", *door)], traffic.connections_opened.get().saturating_sub(closed) as f64)
        });
        out.gauges("clearance_connections", "Connections that are there", open)
    }
}
