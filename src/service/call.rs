//! One call, from its arrival at a door to its end: whoever observes the service is told of both.
//!
//! A door begins a [`Call`] with [`super::Service::begin_call`] and does its work within it. How it ended is told by the door, or
//! found out by dropping it: its caller went away.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use tracing::{Instrument, Span};

use super::ServiceError;
use super::call_notes::{Asker, CallNotes, Rpc};
use super::observer::{Ending, Observer, Outcome};

/// Everybody who is told of calls.
pub(super) type Observers = Arc<[Box<dyn Observer>]>;

/// A call under way. One that nobody observes costs nothing.
#[derive(Debug, Default)]
pub struct Call(Option<Observed>);

#[derive(Debug)]
struct Observed {
    notes: Arc<CallNotes>,
    observers: Observers,
    over: AtomicBool,
}

impl Call {
    /// A call that nobody observes.
    #[must_use]
    pub fn unobserved() -> Self {
        Self(None)
    }

    pub(super) fn begin(number: u64, rpc: Rpc, asker: Asker, observers: &Observers) -> Self {
        let span = tracing::debug_span!(
            target: "clearance::call",
            "call",
            otel.name = rpc.name,
            otel.kind = "server",
            otel.status_code = tracing::field::Empty,
            call = i64::try_from(number).unwrap_or(i64::MAX),
            rpc = rpc.name,
            door = asker.door,
            client = &*asker.client,
            scene = tracing::field::Empty,
            revision = tracing::field::Empty,
            items = tracing::field::Empty,
            pairs = tracing::field::Empty,
            waited_seconds = tracing::field::Empty,
            worked_seconds = tracing::field::Empty,
            outcome = tracing::field::Empty,
        );
        let notes = Arc::new(CallNotes::new(number, rpc, asker, span));
        observers.iter().for_each(|observer| observer.begun(&notes, notes.span()));
        Self(Some(Observed { notes, observers: Arc::clone(observers), over: AtomicBool::new(false) }))
    }

    /// Its number, where it is observed.
    #[must_use]
    pub fn number(&self) -> Option<u64> {
        self.0.as_ref().map(|Observed { notes, .. }| notes.number())
    }

    /// Does work that belongs to the call.
    pub fn work<F: Future>(&self, work: F) -> impl Future<Output = F::Output> + use<F> {
        let notes = self.0.as_ref().map(|Observed { notes, .. }| Arc::clone(notes));
        async move {
            match notes {
                Some(notes) => {
                    let span = notes.span().clone();
                    notes.follow(work.instrument(span)).await
                }
                None => work.await,
            }
        }
    }

    /// Does all the work of the call.
    ///
    /// # Errors
    /// What `answering` says.
    pub async fn answer<T>(&self, answering: impl Future<Output = Result<T, ServiceError>>) -> Result<T, ServiceError> {
        let outcome = self.work(answering).await;
        self.end(Outcome::of_result(&outcome));
        outcome
    }

    /// Does a part of the work of the call on this thread.
    pub fn work_here<T>(&self, work: impl FnOnce() -> T) -> T {
        match &self.0 {
            Some(Observed { notes, .. }) => Arc::clone(notes).follow_here(work),
            None => work(),
        }
    }

    /// The call has ended. Only the first end counts.
    pub fn end(&self, outcome: Outcome) {
        let Some(Observed { notes, observers, over }) = &self.0 else { return };
        if over.swap(true, Ordering::AcqRel) {
            return;
        }
        let ending = Ending { outcome, took: notes.begun().elapsed() };
        record(notes, outcome);
        observers.iter().for_each(|observer| observer.ended(notes, ending));
    }
}

impl Drop for Call {
    fn drop(&mut self) {
        self.end(Outcome::ABANDONED);
    }
}

/// What the span says at its end.
fn record(notes: &CallNotes, outcome: Outcome) {
    let span: &Span = notes.span();
    if span.is_disabled() {
        return;
    }
    span.record("outcome", outcome.word);
    if outcome.word == "internal" {
        span.record("otel.status_code", "ERROR");
    }
    let seconds = |time: Option<std::time::Duration>| time.map(|time| time.as_secs_f64());
    span.record("scene", notes.scene());
    // Exporters of spans know numbers with a sign.
    let number = |number: u64| i64::try_from(number).unwrap_or(i64::MAX);
    span.record("revision", notes.revision().map(|revision| number(revision.0)));
    span.record("items", notes.question().map(|question| number(question.items as u64)));
    span.record("pairs", notes.answered().map(|answered| number(answered.cost.pairs)));
    span.record("waited_seconds", seconds(notes.waited()));
    span.record("worked_seconds", seconds(notes.worked()));
}
