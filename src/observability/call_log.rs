//! Which calls were there, and what became of each? One line for every call that has ended.

use crate::service::{CallNotes, Ending, Observer};

/// What the lines are filtered by: `clearance::call=debug` shows them and nothing else.
pub const TARGET: &str = "clearance::call";

/// Writes the lines.
#[derive(Clone, Copy, Debug, Default)]
pub struct CallLog;

impl Observer for CallLog {
    fn ended(&self, notes: &CallNotes, ending: Ending) {
        let seconds = |time: Option<std::time::Duration>| time.map(|time| time.as_secs_f64());
        let asker = notes.asker();
        tracing::debug!(
            target: TARGET,
            parent: None,
            call = notes.number(),
            rpc = notes.rpc().name,
            door = asker.door,
            client = &*asker.client,
            scene = notes.scene(),
            revision = notes.revision().map(|revision| revision.0),
            items = notes.question().map(|question| question.items),
            edits = notes.edits(),
            outcome = ending.outcome.word,
            limit = ending.outcome.limit,
            took_seconds = ending.took.as_secs_f64(),
            waited_seconds = seconds(notes.waited()),
            worked_seconds = seconds(notes.worked()),
            trace_id = notes.trace(),
            "call"
        );
    }
}
