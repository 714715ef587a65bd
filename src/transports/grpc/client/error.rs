//! Why did a daemon give no answer?

use std::time::Duration;

use tonic::{Code, Status};

use crate::transports::wire::from_proto::NotAnAnswer;
use crate::transports::wire::v1;

/// Why a daemon gave no answer.
#[derive(Debug, thiserror::Error)]
pub enum ClientError {
    /// It cannot be reached.
    #[error("{address}: {source}")]
    Unreachable {
        /// As asked for.
        address: String,
        /// What the connection says.
        source: tonic::transport::Error,
    },
    /// The token cannot be sent.
    #[error("the token is not printable ASCII")]
    BadToken,
    /// It refused the request, or the way to it broke.
    #[error("{} ({:?})", .0.message, .0.code)]
    Refused(Box<Refusal>),
    /// It answered with something this version does not know.
    #[error(transparent)]
    NotAnAnswer(#[from] NotAnAnswer),
    /// It left out something that has to be there.
    #[error("the daemon's answer has no {0}")]
    Missing(&'static str),
}

impl ClientError {
    /// What the daemon said, if it was the daemon.
    #[must_use]
    pub fn refusal(&self) -> Option<&Refusal> {
        match self {
            Self::Refused(refusal) => Some(refusal),
            Self::Unreachable { .. } | Self::BadToken | Self::NotAnAnswer(_) | Self::Missing(_) => None,
        }
    }
}

/// A request that was refused. What the daemon did not say is empty.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal {
    /// gRPC's kind of error.
    pub code: Code,
    /// The reason for programs, as in `ErrorReason`, for example `INVALID_FIELD`.
    pub reason: String,
    /// The reason for people.
    pub message: String,
    /// The field that cannot be as it is, for example `items[3].shape.box.half_extents.x`.
    pub field: Option<String>,
    /// Of a list of edits, subjects or the like: which element the field is in.
    pub item: Option<usize>,
    /// The cap that was hit.
    pub limit: Option<String>,
    /// How much was asked.
    pub asked: Option<u64>,
    /// How much is allowed.
    pub allowed: Option<u64>,
    /// When the limit lets this client in again.
    pub retry_after: Option<Duration>,
    /// The scope that the token lacks, `read` or `write`.
    pub scope: Option<String>,
    /// The epoch of the scene, where it is not the one expected.
    pub epoch: Option<u64>,
    /// The revision of the scene, where it is not the one expected.
    pub revision: Option<u64>,
    /// The oldest revision that can still be asked.
    pub oldest_revision: Option<u64>,
}

impl Refusal {
    fn new(code: Code, message: &str, of: impl Fn(&str) -> Option<String>) -> Self {
        let number = |key| of(key).and_then(|text| text.parse().ok());
        let field = of("clearance-field");
        Self {
            code,
            reason: of("clearance-reason").unwrap_or_default(),
            message: message.to_owned(),
            item: field.as_deref().and_then(item),
            field,
            limit: of("clearance-limit"),
            asked: number("clearance-asked"),
            allowed: number("clearance-allowed"),
            retry_after: number("clearance-retry-after-ms").map(Duration::from_millis),
            scope: of("clearance-scope"),
            epoch: number("clearance-epoch"),
            revision: number("clearance-revision"),
            oldest_revision: number("clearance-oldest-revision"),
        }
    }
}

impl From<Status> for ClientError {
    fn from(status: Status) -> Self {
        let of = |key: &str| status.metadata().get(key).and_then(|value| value.to_str().ok()).map(str::to_owned);
        Self::Refused(Box::new(Refusal::new(status.code(), status.message(), of)))
    }
}

/// The error of one question of a stream: as a call of its own would have ended.
impl From<&v1::QueryError> for ClientError {
    fn from(error: &v1::QueryError) -> Self {
        let name = error.reason().as_str_name();
        let of = |key: &str| match key {
            "clearance-reason" => Some(name.strip_prefix("ERROR_REASON_").unwrap_or(name).to_owned()),
            _ => error.details.get(key).cloned(),
        };
        Self::Refused(Box::new(Refusal::new(Code::from_i32(error.code), &error.message, of)))
    }
}

/// `edits[3].shape` is of item 3.
fn item(field: &str) -> Option<usize> {
    let (list, rest) = field.split_once('[')?;
    let is_name = !list.is_empty() && list.chars().all(|c| c.is_alphanumeric() || c == '_');
    is_name.then(|| rest.split_once(']')?.0.parse().ok())?
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_item_is_that_of_the_outermost_list() {
        assert_eq!(item("edits[12].add_body.shape.convex.points[3].x"), Some(12));
        assert_eq!(item("context.filter.ignore[3]"), None);
        assert_eq!(item("positions"), None);
    }

    #[test]
    fn a_refused_question_of_a_stream_is_told_as_a_refused_call() {
        let details = [("clearance-limit", "max_items"), ("clearance-asked", "7"), ("clearance-allowed", "5")];
        let details: Vec<_> = details.into_iter().map(|(key, value)| (key.to_owned(), value.to_owned())).collect();
        let error = v1::QueryError {
            code: Code::ResourceExhausted.into(),
            reason: v1::ErrorReason::LimitExceeded.into(),
            message: "too many".to_owned(),
            details: details.into_iter().collect(),
        };
        let told = ClientError::from(&error);
        let refusal = told.refusal().unwrap();
        assert_eq!((refusal.code, refusal.reason.as_str()), (Code::ResourceExhausted, "LIMIT_EXCEEDED"));
        assert_eq!((refusal.limit.as_deref(), refusal.asked, refusal.allowed), (Some("max_items"), Some(7), Some(5)));
        assert_eq!(told.to_string(), "too many (ResourceExhausted)");
    }
}
