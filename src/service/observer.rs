//! Who is told of every call? Observers: of its beginning, and of its end with what is known of it by then.

use std::fmt;
use std::time::Duration;

use tracing::Span;

use super::ServiceError;
use super::call_notes::CallNotes;

/// Told of calls, on the threads that serve them: it must not wait for anybody.
pub trait Observer: fmt::Debug + Send + Sync {
    /// A call begins. `span` is not entered yet, and disabled where nobody reads it.
    fn begun(&self, notes: &CallNotes, span: &Span) {
        _ = (notes, span);
    }

    /// A call has ended.
    fn ended(&self, notes: &CallNotes, ending: Ending);
}

/// How a call ended, and when.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ending {
    /// In a word.
    pub outcome: Outcome,
    /// From its beginning.
    pub took: Duration,
}

/// What became of a call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// One of [`Outcome::WORDS`].
    pub word: &'static str,
    /// Of `limit_exceeded`: the field of [`crate::limits::Limits`].
    pub limit: Option<&'static str>,
}

impl Outcome {
    /// Everything that can become of a call. But for the first three, these are the names that every door tells its callers
    /// (`ErrorReason` in `proto/clearance/v1`), in small letters.
    pub const WORDS: [&'static str; 22] = [
        "ok",
        "abandoned",
        "other",
        "invalid_field",
        "not_found",
        "already_exists",
        "edit_refused",
        "effect_not_declared",
        "effect_not_built",
        "key_reused",
        "wrong_epoch",
        "revision_moved_on",
        "revision_gone",
        "revision_not_yet",
        "limit_exceeded",
        "deadline_exceeded",
        "hash_mismatch",
        "shutting_down",
        "internal",
        "no_token",
        "unknown_token",
        "missing_scope",
    ];
    /// It was answered.
    pub const OK: Self = Self::word("ok");
    /// Its caller went away first.
    pub const ABANDONED: Self = Self::word("abandoned");
    /// The door failed it for a reason of its own, for example bytes that are no message.
    pub const OTHER: Self = Self::word("other");

    const fn word(word: &'static str) -> Self {
        Self { word, limit: None }
    }

    /// The outcome of an error.
    #[must_use]
    pub fn of(error: &ServiceError) -> Self {
        let word = match error {
            ServiceError::Limit(exceeded) => return Self::limit(exceeded.limit),
            ServiceError::Invalid { .. } => "invalid_field",
            ServiceError::NotFound { .. } => "not_found",
            ServiceError::AlreadyExists { .. } => "already_exists",
            ServiceError::EditRefused { .. } => "edit_refused",
            ServiceError::EffectNotDeclared { .. } => "effect_not_declared",
            ServiceError::EffectNotBuilt { .. } => "effect_not_built",
            ServiceError::KeyReused { .. } => "key_reused",
            ServiceError::WrongEpoch { .. } => "wrong_epoch",
            ServiceError::RevisionMovedOn { .. } => "revision_moved_on",
            ServiceError::RevisionGone { .. } => "revision_gone",
            ServiceError::RevisionNotYet { .. } => "revision_not_yet",
            ServiceError::DeadlineExceeded => "deadline_exceeded",
            ServiceError::HashMismatch { .. } => "hash_mismatch",
            ServiceError::ShuttingDown => "shutting_down",
            ServiceError::Internal { .. } => "internal",
        };
        Self::word(word)
    }

    /// The outcome of a result.
    #[must_use]
    pub fn of_result<T>(result: &Result<T, ServiceError>) -> Self {
        result.as_ref().map_or_else(Self::of, |_| Self::OK)
    }

    /// A limit was exceeded.
    #[must_use]
    pub fn limit(limit: &'static str) -> Self {
        Self { word: "limit_exceeded", limit: Some(limit) }
    }

    /// The outcome of that name, in capital letters or small ones.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::WORDS.into_iter().find(|word| word.eq_ignore_ascii_case(name)).map(Self::word)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limits::LimitExceeded;

    #[test]
    fn a_name_as_the_doors_tell_it_is_found_whatever_its_letters() {
        assert_eq!(Outcome::named("REVISION_GONE").unwrap().word, "revision_gone");
        assert_eq!(Outcome::named("ok"), Some(Outcome::OK));
        assert_eq!(Outcome::named("no such outcome"), None);
    }

    #[test]
    fn a_limit_is_told_by_its_name() {
        let error = ServiceError::Limit(LimitExceeded { limit: "max_items", asked: 7, allowed: 5 });
        assert_eq!(Outcome::of(&error), Outcome { word: "limit_exceeded", limit: Some("max_items") });
        assert!(Outcome::WORDS.contains(&Outcome::of(&error).word));
    }
}
