//! Contacts, as they change.

use super::answer::{cost, pair};
use super::declared::coverage;
use crate::query::{ContactChanges, ContactEvent, ContactEventKind, ContactState, EndReason};
use crate::transports::wire::v1;

/// Events of one message at most: some hundred kilobytes.
const EVENTS: usize = 2048;

/// What became of the contacts, in as many messages as it takes; one, if nothing did.
#[must_use]
pub fn contact_messages(changes: &ContactChanges) -> Vec<v1::WatchContactsResponse> {
    let message = |events: &[ContactEvent]| v1::WatchContactsResponse {
        epoch: changes.epoch.0,
        from_revision: changes.from.map(|revision| revision.0),
        revision: changes.revision.0,
        events: events.iter().map(event).collect(),
        more: true,
        contacts: changes.contacts as u64,
        undecided: changes.undecided as u64,
        cost: Some(cost(changes.cost)),
        coverage: coverage(&changes.coverage),
    };
    let mut messages: Vec<v1::WatchContactsResponse> = changes.events.chunks(EVENTS).map(message).collect();
    if messages.is_empty() {
        messages.push(message(&[]));
    }
    messages.iter_mut().last().into_iter().for_each(|last| last.more = false);
    messages
}

fn event(event: &ContactEvent) -> v1::ContactEvent {
    let kind = match event.kind {
        ContactEventKind::Begin => v1::ContactEventKind::Begin,
        ContactEventKind::Stay => v1::ContactEventKind::Stay,
        ContactEventKind::End => v1::ContactEventKind::End,
        ContactEventKind::Undecided => v1::ContactEventKind::Undecided,
    };
    let reason = event.reason.map_or(v1::ContactEndReason::Unspecified, |reason| match reason {
        EndReason::Removed => v1::ContactEndReason::Removed,
        EndReason::Disabled => v1::ContactEndReason::Disabled,
        EndReason::NotAPair => v1::ContactEndReason::NotAPair,
        EndReason::Apart => v1::ContactEndReason::Apart,
    });
    v1::ContactEvent {
        a: event.a.0,
        b: event.b.0,
        kind: kind.into(),
        before: state(event.before).into(),
        after: state(event.after).into(),
        reason: reason.into(),
        pair: event.pair.as_ref().map(pair),
    }
}

fn state(state: ContactState) -> v1::ContactState {
    match state {
        ContactState::Apart => v1::ContactState::Apart,
        ContactState::Undecided => v1::ContactState::Undecided,
        ContactState::Contact => v1::ContactState::Contact,
    }
}
