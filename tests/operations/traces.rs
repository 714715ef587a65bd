//! Calls become spans of their callers' traces, at a collector that is there; one that is not harms nobody.

use std::time::{Duration, Instant};

use opentelemetry_proto::tonic::collector::trace::v1::trace_service_server::{TraceService, TraceServiceServer};
use opentelemetry_proto::tonic::collector::trace::v1::{ExportTraceServiceRequest, ExportTraceServiceResponse};
use opentelemetry_proto::tonic::common::v1::any_value::Value;
use opentelemetry_proto::tonic::trace::v1::Span;
use tokio::sync::mpsc;
use tokio_stream::wrappers::TcpListenerStream;
use tonic::{Request, Response, Status};

use crate::daemon::{Daemon, PATIENCE, collide};

const TRACE: &str = "4bf92f3577b34da6a3ce929d0e0e4736";
const OTHER: &str = "00112233445566778899aabbccddeeff";
const PARENT: &str = "00f067aa0ba902b7";

/// Hands on what it is sent.
struct Collector(mpsc::UnboundedSender<ExportTraceServiceRequest>);

#[tonic::async_trait]
impl TraceService for Collector {
    async fn export(
        &self,
        request: Request<ExportTraceServiceRequest>,
    ) -> Result<Response<ExportTraceServiceResponse>, Status> {
        self.0.send(request.into_inner()).unwrap();
        Ok(Response::new(ExportTraceServiceResponse::default()))
    }
}

/// A collector in this process: where it is, and what comes.
async fn collector() -> (String, mpsc::UnboundedReceiver<ExportTraceServiceRequest>) {
    let listener = tokio::net::TcpListener::bind("127.0.0.1:0").await.unwrap();
    let address = format!("http://{}", listener.local_addr().unwrap());
    let (sender, receiver) = mpsc::unbounded_channel();
    let server = tonic::transport::Server::builder().add_service(TraceServiceServer::new(Collector(sender)));
    tokio::spawn(server.serve_with_incoming(TcpListenerStream::new(listener)));
    (address, receiver)
}

/// Every span that has come once the daemon has ended, and the name of the service that each came from.
fn spans(receiver: &mut mpsc::UnboundedReceiver<ExportTraceServiceRequest>) -> Vec<(String, Span)> {
    let mut spans = Vec::new();
    while let Ok(request) = receiver.try_recv() {
        for of_resource in request.resource_spans {
            let attributes = of_resource.resource.unwrap().attributes;
            let service = attributes.iter().find(|pair| pair.key == "service.name").unwrap();
            let service = format!("{:?}", service.value);
            let of_scopes = of_resource.scope_spans.into_iter().flat_map(|scope| scope.spans);
            spans.extend(of_scopes.map(|span| (service.clone(), span)));
        }
    }
    spans
}

fn attribute(span: &Span, key: &str) -> Option<Value> {
    span.attributes.iter().find(|pair| pair.key == key)?.value.clone()?.value
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// A question that belongs to a trace, which its caller samples or not.
fn asked(trace: &str, sampled: bool) -> Request<clearance::transports::wire::v1::CollideRequest> {
    let mut request = Request::new(collide("cell", &["a", "b"]));
    let traceparent = format!("00-{trace}-{PARENT}-0{}", u8::from(sampled));
    request.metadata_mut().insert("traceparent", traceparent.parse().unwrap());
    request
}

#[tokio::test(flavor = "multi_thread")]
async fn a_call_is_a_span_of_its_callers_trace_if_the_caller_samples_it() {
    let (endpoint, mut came) = collector().await;
    let daemon = Daemon::start(&["--traces-endpoint", &endpoint, "--traces-sample-ratio", "0"]);
    daemon.with_balls("cell").await;
    let mut queries = daemon.queries().await;
    queries.collide(asked(TRACE, true)).await.unwrap();
    queries.collide(asked(OTHER, false)).await.unwrap();
    queries.collide(collide("cell", &["a"])).await.unwrap();
    // The end sends what is left.
    let (code, log, _) = daemon.stop();
    assert_eq!(code, Some(0), "{log}");
    let spans = spans(&mut came);
    let [(service, span)] = spans.as_slice() else { panic!("{} spans: {spans:#?}", spans.len()) };
    assert!(service.contains("clearance"), "{service}");
    assert_eq!((hex(&span.trace_id), hex(&span.parent_span_id)), (TRACE.to_owned(), PARENT.to_owned()));
    assert_eq!(span.name, "Collide");
    let text = |key| match attribute(span, key) {
        Some(Value::StringValue(text)) => text,
        other => panic!("{key}: {other:?}"),
    };
    let number = |key| match attribute(span, key) {
        Some(Value::IntValue(number)) => number,
        other => panic!("{key}: {other:?}"),
    };
    assert_eq!((text("rpc").as_str(), text("door").as_str(), text("scene").as_str()), ("Collide", "grpc", "cell"));
    assert_eq!((text("outcome").as_str(), number("revision"), number("items")), ("ok", 1, 2));
    assert!(span.end_time_unix_nano > span.start_time_unix_nano);
}

#[tokio::test(flavor = "multi_thread")]
async fn calls_without_a_trace_begin_one_where_all_are_sampled() {
    let (endpoint, mut came) = collector().await;
    let daemon = Daemon::start(&["--traces-endpoint", &endpoint, "--traces-sample-ratio", "1"]);
    daemon.with_balls("cell").await;
    let (code, log, _) = daemon.stop();
    assert_eq!(code, Some(0), "{log}");
    let names: Vec<String> = spans(&mut came).into_iter().map(|(_, span)| span.name).collect();
    assert!(names.contains(&"CreateScene".to_owned()) && names.contains(&"Apply".to_owned()), "{names:?}");
}

#[tokio::test(flavor = "multi_thread")]
async fn a_collector_that_takes_nothing_holds_up_no_call_and_no_end() {
    // It takes connections, and says nothing.
    let silent = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let gone = std::net::TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap();
    for endpoint in [silent.local_addr().unwrap(), gone] {
        let endpoint = format!("http://{endpoint}");
        let daemon = Daemon::start(&["--traces-endpoint", &endpoint, "--traces-sample-ratio", "1"]);
        daemon.with_balls("cell").await;
        let mut queries = daemon.queries().await;
        let begun = Instant::now();
        // More than the queue holds.
        for _ in 0..3_000 {
            queries.collide(collide("cell", &["a"])).await.unwrap();
        }
        assert!(begun.elapsed() < PATIENCE / 2, "{:?}", begun.elapsed());
        let (code, log, took) = daemon.stop();
        assert_eq!(code, Some(0), "{log}");
        assert!(took < Duration::from_secs(5), "{took:?}");
    }
}

#[test]
fn an_endpoint_or_a_share_that_cannot_be_is_refused() {
    for (flags, named) in [
        (["--traces-endpoint", "https://127.0.0.1:4317"], "traces.endpoint"),
        (["--traces-endpoint", "http://not a host"], "traces.endpoint"),
        (["--traces-sample-ratio", "2"], "traces.sample_ratio"),
    ] {
        let output = crate::daemon::serve().args(flags).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{flags:?}");
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(text.contains(named), "{text}");
    }
}
