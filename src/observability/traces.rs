//! Which calls are traced, and where do their spans go? To a collector of OpenTelemetry by OTLP over gRPC. A call that comes with
//! a `traceparent` (W3C Trace Context) belongs to that trace, and is sampled as its caller says.
//!
//! Spans leave on a thread of their own, from a queue that drops what it has no room for: a collector that is slow or gone
//! holds up no call, and is told of in the log at most once a second.

use std::time::Duration;

use opentelemetry::propagation::{Extractor, TextMapPropagator};
use opentelemetry::trace::{TraceContextExt, TracerProvider};
use opentelemetry_otlp::{ExporterBuildError, Protocol, WithExportConfig};
use opentelemetry_sdk::Resource;
use opentelemetry_sdk::error::OTelSdkResult;
use opentelemetry_sdk::propagation::TraceContextPropagator;
use opentelemetry_sdk::trace::{Sampler, SdkTracerProvider, SpanData, SpanExporter};
use tracing::{Span, Subscriber};
use tracing_opentelemetry::OpenTelemetrySpanExt;
use tracing_subscriber::Layer;
use tracing_subscriber::filter::filter_fn;
use tracing_subscriber::registry::LookupSpan;

use super::TARGET;
use crate::service::{CallNotes, Ending, Observer, Seldom};

/// How long the collector has to take a batch of spans.
const PATIENCE: Duration = Duration::from_secs(3);
/// How long the end of the daemon waits for the last spans to go.
const LAST_SPANS: Duration = Duration::from_secs(1);

/// What is traced, and for whom.
#[derive(Clone, Debug, PartialEq)]
pub struct TracesConfig {
    /// The collector, for example `http://127.0.0.1:4317`.
    pub endpoint: String,
    /// Of calls that come without a trace, this share begins one: 0 to 1.
    pub sample_ratio: f64,
}

/// Why nothing can be traced.
#[derive(Debug, thiserror::Error)]
#[error("traces.endpoint {endpoint:?}: {source}")]
pub struct TracesError {
    endpoint: String,
    source: ExporterBuildError,
}

/// Spans on their way to a collector.
#[derive(Debug)]
pub struct Traces {
    provider: SdkTracerProvider,
}

impl Traces {
    /// Ready to send; nobody is connected to yet. Called within a runtime.
    ///
    /// # Errors
    /// The endpoint is none.
    pub fn new(config: &TracesConfig) -> Result<Self, TracesError> {
        let exporter = opentelemetry_otlp::SpanExporter::builder()
            .with_tonic()
            .with_protocol(Protocol::Grpc)
            .with_endpoint(&config.endpoint)
            .with_timeout(PATIENCE)
            .build()
            .map_err(|source| TracesError { endpoint: config.endpoint.clone(), source })?;
        let resource = Resource::builder()
            .with_service_name("clearance")
            .with_attribute(opentelemetry::KeyValue::new("service.version", env!("CARGO_PKG_VERSION")));
        let provider = SdkTracerProvider::builder()
            .with_sampler(Sampler::ParentBased(Box::new(Sampler::TraceIdRatioBased(config.sample_ratio))))
            .with_resource(resource.build())
            .with_batch_exporter(ToldOf { inner: exporter, failed: Seldom::new() })
            .build();
        Ok(Self { provider })
    }

    /// Makes spans of what the subscriber is told: of calls, and of nothing else.
    pub fn layer<S: Subscriber + for<'a> LookupSpan<'a> + Send + Sync>(&self) -> impl Layer<S> + use<S> {
        let layer = tracing_opentelemetry::layer()
            .with_tracer(self.provider.tracer("clearance"))
            .with_location(false)
            .with_threads(false)
            .with_tracked_inactivity(false);
        layer.with_filter(filter_fn(|metadata| metadata.is_span() && metadata.target() == TARGET))
    }

    /// Sends what is left. Called outside of a runtime that still runs; waits a second at most.
    pub fn finish(self) {
        if let Err(error) = self.provider.shutdown_with_timeout(LAST_SPANS) {
            tracing::debug!(%error, "the last spans were not sent");
        }
    }
}

/// Puts each call into the trace that its caller names.
#[derive(Debug, Default)]
pub struct TraceParents {
    propagator: TraceContextPropagator,
}

impl Observer for TraceParents {
    fn begun(&self, notes: &CallNotes, span: &Span) {
        if let Some(traceparent) = &notes.asker().traceparent {
            let parent = self.propagator.extract(&Traceparent(traceparent));
            if parent.span().span_context().is_valid() {
                // It fails where nobody makes spans.
                _ = span.set_parent(parent);
            }
        }
        let context = span.context();
        let span = context.span();
        if span.span_context().is_valid() {
            notes.note_trace(span.span_context().trace_id().to_string());
        }
    }

    fn ended(&self, _notes: &CallNotes, _ending: Ending) {}
}

/// The one header that is looked at.
struct Traceparent<'a>(&'a str);

impl Extractor for Traceparent<'_> {
    fn get(&self, key: &str) -> Option<&str> {
        (key == "traceparent").then_some(self.0)
    }

    fn keys(&self) -> Vec<&str> {
        vec!["traceparent"]
    }
}

/// An exporter whose failures are told in the log.
#[derive(Debug)]
struct ToldOf<E> {
    inner: E,
    failed: Seldom,
}

impl<E: SpanExporter> SpanExporter for ToldOf<E> {
    async fn export(&self, batch: Vec<SpanData>) -> OTelSdkResult {
        let outcome = self.inner.export(batch).await;
        if let Err(error) = &outcome
            && let Some(times) = self.failed.due()
        {
            tracing::warn!(%error, times, "spans could not be sent to the collector, and are lost");
        }
        outcome
    }

    fn shutdown_with_timeout(&self, timeout: Duration) -> OTelSdkResult {
        self.inner.shutdown_with_timeout(timeout)
    }

    fn force_flush(&self) -> OTelSdkResult {
        self.inner.force_flush()
    }

    fn set_resource(&mut self, resource: &Resource) {
        self.inner.set_resource(resource);
    }
}
