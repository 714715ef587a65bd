//! Does the operator's page say what a caller sees? Every reason of a refusal has its row, with the code that gRPC gives it and
//! what else comes with it.

use clearance::limits::LimitExceeded;
use clearance::scene::{Effect, Epoch, Party, Revision};
use clearance::service::{Outcome, ServiceError};
use clearance::transports::grpc::status_of;

/// One error of each kind that the service tells.
fn errors() -> Vec<ServiceError> {
    let text = || "x".to_owned();
    vec![
        ServiceError::Invalid { field: text(), problem: text() },
        ServiceError::NotFound { what: "scene", name: text() },
        ServiceError::AlreadyExists { what: "scene", name: text() },
        ServiceError::EditRefused { field: text(), problem: text() },
        ServiceError::KeyReused { key: text() },
        ServiceError::WrongEpoch { asked: Epoch(1), current: Epoch(2) },
        ServiceError::RevisionMovedOn { expected: Revision(1), current: Revision(2) },
        ServiceError::RevisionGone { asked: Revision(1), oldest: Revision(2) },
        ServiceError::RevisionNotYet { asked: Revision(2), current: Revision(1) },
        ServiceError::Limit(LimitExceeded { limit: "max_items", asked: 2, allowed: 1 }),
        ServiceError::DeadlineExceeded,
        ServiceError::HashMismatch { problem: text() },
        ServiceError::EffectNotDeclared { effect: Effect::Depth, a: Party::Everything, b: Party::Everything },
        ServiceError::EffectNotBuilt { field: "context.wants", effect: "patch" },
        ServiceError::ShuttingDown,
        ServiceError::Internal { incident: 1 },
    ]
}

#[test]
fn every_reason_has_its_row_with_code_and_trailers() {
    let page = include_str!("../../docs/operations.md");
    let mut told = 0;
    for error in errors() {
        let status = status_of(&error);
        let of = |key: &str| status.metadata().get(key).unwrap().to_str().unwrap().to_owned();
        let reason = of("clearance-reason");
        let mut trailers = Vec::new();
        for key in status.metadata().keys() {
            if let tonic::metadata::KeyRef::Ascii(key) = key
                && key.as_str() != "clearance-reason"
            {
                trailers.push(format!("`{}`", key.as_str()));
            }
        }
        trailers.sort();
        let code = format!("{:?}", status.code());
        let row = format!("| `{reason}` | {} | {} |", screaming(&code), trailers.join(", "));
        assert!(
            page.lines().any(|line| line.starts_with(&row)),
            "docs/operations.md lacks a row that begins with\n{row}"
        );
        assert_eq!(Outcome::of(&error).word, reason.to_lowercase());
        told += 1;
    }
    for (reason, code) in
        [("NO_TOKEN", "UNAUTHENTICATED"), ("UNKNOWN_TOKEN", "UNAUTHENTICATED"), ("MISSING_SCOPE", "PERMISSION_DENIED")]
    {
        assert!(page.lines().any(|line| line.starts_with(&format!("| `{reason}` | {code} |"))), "{reason}");
        told += 1;
    }
    // And three that no caller is told by a reason.
    assert_eq!(told + 3, Outcome::WORDS.len());
}

/// `NotFound` as `NOT_FOUND`.
fn screaming(name: &str) -> String {
    let mut text = String::new();
    for letter in name.chars() {
        if letter.is_ascii_uppercase() && !text.is_empty() {
            text.push('_');
        }
        text.push(letter.to_ascii_uppercase());
    }
    text
}
