//! What is known of a call while it is under way? Each floor it passes notes what it knows, once; observers read it at the end.
//!
//! Notes follow a call by themselves: a task, and the thread it hands its work to, find those of the call they work for. A call
//! that nobody observes has none, and costs nothing.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

use tracing::Span;

use super::answered::{Answered, Question};
use crate::scene::Revision;

/// An rpc, as every door names it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rpc {
    /// Its method, for example `CheckStates`.
    pub name: &'static str,
    /// It is answered with more than one message.
    pub streams: bool,
}

impl Rpc {
    /// A message that says nothing of what it asks, or not in a way that can be read.
    pub const UNREADABLE: Self = Self { name: "unreadable", streams: false };
}

/// Who asks, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Asker {
    /// The kind of a [`super::Door`].
    pub door: &'static str,
    /// As far as the door knows; for log lines.
    pub client: Arc<str>,
    /// The caller's `traceparent` (W3C Trace Context), as it came.
    pub traceparent: Option<Arc<str>>,
}

/// What is known of one call.
#[derive(Debug)]
pub struct CallNotes {
    number: u64,
    rpc: Rpc,
    asker: Asker,
    begun: Instant,
    span: Span,
    scene: OnceLock<String>,
    revision: OnceLock<Revision>,
    question: OnceLock<Question>,
    answered: OnceLock<Answered>,
    edits: OnceLock<usize>,
    /// Nanoseconds; `u64::MAX` while nothing was waited for.
    waited: AtomicU64,
    worked: AtomicU64,
    trace: OnceLock<String>,
}

tokio::task_local! {
    static CURRENT: Arc<CallNotes>;
}

impl CallNotes {
    pub(super) fn new(number: u64, rpc: Rpc, asker: Asker, span: Span) -> Self {
        Self {
            number,
            rpc,
            asker,
            begun: Instant::now(),
            span,
            scene: OnceLock::new(),
            revision: OnceLock::new(),
            question: OnceLock::new(),
            answered: OnceLock::new(),
            edits: OnceLock::new(),
            waited: AtomicU64::new(u64::MAX),
            worked: AtomicU64::new(u64::MAX),
            trace: OnceLock::new(),
        }
    }

    /// Those of the call that this task or thread works for.
    pub(super) fn current() -> Option<Arc<Self>> {
        CURRENT.try_with(Arc::clone).ok()
    }

    pub(super) fn follow<F: Future>(self: Arc<Self>, work: F) -> impl Future<Output = F::Output> {
        CURRENT.scope(self, work)
    }

    pub(super) fn follow_here<T>(self: Arc<Self>, work: impl FnOnce() -> T) -> T {
        CURRENT.sync_scope(self, work)
    }

    /// Its number among the calls of this process; what a caller may tell and an operator look for.
    #[must_use]
    pub fn number(&self) -> u64 {
        self.number
    }

    /// What was called.
    #[must_use]
    pub fn rpc(&self) -> Rpc {
        self.rpc
    }

    /// By whom, and where.
    #[must_use]
    pub fn asker(&self) -> &Asker {
        &self.asker
    }

    /// When it began.
    #[must_use]
    pub fn begun(&self) -> Instant {
        self.begun
    }

    /// The span of the call: what is told within it belongs to the call.
    #[must_use]
    pub fn span(&self) -> &Span {
        &self.span
    }

    /// Which scene it is about.
    #[must_use]
    pub fn scene(&self) -> Option<&str> {
        self.scene.get().map(String::as_str)
    }

    /// Which revision was asked or made.
    #[must_use]
    pub fn revision(&self) -> Option<Revision> {
        self.revision.get().copied()
    }

    /// What was asked of the scene.
    #[must_use]
    pub fn question(&self) -> Option<&Question> {
        self.question.get()
    }

    /// What came out.
    #[must_use]
    pub fn answered(&self) -> Option<&Answered> {
        self.answered.get()
    }

    /// How many edits were sent.
    #[must_use]
    pub fn edits(&self) -> Option<usize> {
        self.edits.get().copied()
    }

    /// How long it waited for its turn: for a thread, and, of changes, for those before it.
    #[must_use]
    pub fn waited(&self) -> Option<Duration> {
        duration(&self.waited)
    }

    /// How long was worked on it, from the first of its threads to the last: decoding what is in the scene, answering, encoding.
    #[must_use]
    pub fn worked(&self) -> Option<Duration> {
        duration(&self.worked)
    }

    /// The trace it belongs to: 32 hexadecimal digits.
    #[must_use]
    pub fn trace(&self) -> Option<&str> {
        let told = || trace_of(self.asker.traceparent.as_deref()?);
        self.trace.get().map(String::as_str).or_else(told)
    }

    /// An observer knows the trace.
    pub fn note_trace(&self, trace: String) {
        self.trace.get_or_init(|| trace);
    }

    pub(super) fn note_scene(&self, scene: &str) {
        self.scene.get_or_init(|| scene.to_owned());
    }

    pub(super) fn note_revision(&self, revision: Revision) {
        self.revision.get_or_init(|| revision);
    }

    pub(super) fn note_question(&self, question: Question) {
        self.question.get_or_init(|| question);
    }

    pub(super) fn note_answered(&self, answered: Answered) {
        self.answered.get_or_init(|| answered);
    }

    pub(super) fn note_edits(&self, edits: usize) {
        self.edits.get_or_init(|| edits);
    }

    pub(super) fn note_waited(&self, time: Duration) {
        add(&self.waited, time);
    }

    /// Does a part of the call's work on this thread.
    pub(super) fn work<T>(&self, work: impl FnOnce() -> T) -> T {
        let _entered = self.span.enter();
        let begun = Instant::now();
        let done = work();
        add(&self.worked, begun.elapsed());
        done
    }
}

/// The trace that a `traceparent` (version-trace-parent-flags, in hexadecimal digits) names.
fn trace_of(traceparent: &str) -> Option<&str> {
    let mut parts = traceparent.split('-');
    let [version, trace, parent] = [parts.next()?, parts.next()?, parts.next()?];
    let is_hex = |text: &str, digits| text.len() == digits && text.bytes().all(|c| c.is_ascii_hexdigit());
    let is_one = is_hex(version, 2) && is_hex(trace, 32) && is_hex(parent, 16) && trace.bytes().any(|c| c != b'0');
    is_one.then_some(trace)
}

fn add(total: &AtomicU64, time: Duration) {
    let time = u64::try_from(time.as_nanos()).unwrap_or(u64::MAX - 1);
    let more = |total: u64| Some(if total == u64::MAX { time } else { total.saturating_add(time).min(u64::MAX - 1) });
    // It never gives up: the closure always has a value.
    _ = total.fetch_update(Ordering::AcqRel, Ordering::Acquire, more);
}

fn duration(total: &AtomicU64) -> Option<Duration> {
    match total.load(Ordering::Acquire) {
        u64::MAX => None,
        nanoseconds => Some(Duration::from_nanos(nanoseconds)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_add_up_and_none_is_told_from_zero() {
        let asker = Asker { door: "grpc", client: "test".into(), traceparent: None };
        let notes = CallNotes::new(1, Rpc { name: "Apply", streams: false }, asker, Span::none());
        assert_eq!((notes.waited(), notes.worked()), (None, None));
        notes.note_waited(Duration::ZERO);
        assert_eq!(notes.waited(), Some(Duration::ZERO));
        notes.note_waited(Duration::from_nanos(3));
        notes.note_waited(Duration::from_nanos(4));
        assert_eq!(notes.waited(), Some(Duration::from_nanos(7)));
        notes.note_waited(Duration::MAX);
        assert_eq!(notes.waited(), Some(Duration::from_nanos(u64::MAX - 1)));
    }

    #[test]
    fn only_a_trace_that_is_one_is_told() {
        let trace = "4bf92f3577b34da6a3ce929d0e0e4736";
        assert_eq!(trace_of(&format!("00-{trace}-00f067aa0ba902b7-01")), Some(trace));
        let zero = "0".repeat(32);
        for wrong in ["", "00", "00-x-y-01", &format!("00-{zero}-00f067aa0ba902b7-01"), "00-\n4bf92f3577b34da6a-1-01"] {
            assert_eq!(trace_of(wrong), None, "{wrong:?}");
        }
    }

    #[tokio::test]
    async fn notes_are_found_within_their_call_alone() {
        let asker = Asker { door: "grpc", client: "test".into(), traceparent: None };
        let notes = Arc::new(CallNotes::new(7, Rpc { name: "Apply", streams: false }, asker, Span::none()));
        assert!(CallNotes::current().is_none());
        let number = Arc::clone(&notes).follow(async { CallNotes::current().map(|notes| notes.number()) }).await;
        assert_eq!(number, Some(7));
        assert_eq!(notes.follow_here(|| CallNotes::current().map(|notes| notes.number())), Some(7));
        assert!(CallNotes::current().is_none());
    }
}
