//! What does the daemon answer? A client's checked view of the message of an answer.

use super::answer::{OUT_OF_TIME, STOPPED};
use super::codes;
use super::layout::{ABI_HASH, MAGIC, ResponseHeader, VERSION, kind};
use super::request::Nonce;
use super::sections::{Malformed, Sections};
use crate::narrow_phase::Cost;
use crate::query::Verdict;
use crate::scene::{Epoch, Revision};

/// An answer, owned by the client.
#[derive(Clone, Debug, PartialEq)]
pub struct Reply {
    header: ResponseHeader,
    message: Vec<u8>,
}

/// The daemon refuses the request.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct Refusal {
    /// The number of the gRPC status.
    pub code: u32,
    /// A name of `ErrorReason` without its prefix.
    pub reason: String,
    /// For people.
    pub message: String,
    /// The field at fault; empty where none is.
    pub field: String,
    /// Keys and values, as in gRPC's metadata.
    pub details: Vec<(String, String)>,
}

/// What came back.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Came {
    /// An answer.
    Reply(Reply),
    /// An error.
    Refusal(Refusal),
    /// A message with another nonce: somebody else's.
    Foreign,
}

/// Reads what came back to the request of `nonce`.
pub(super) fn decode(message: Vec<u8>, nonce: Nonce) -> Result<Came, Malformed> {
    let header = ResponseHeader::read(&message);
    if message.len() < ResponseHeader::BYTES || header.magic != MAGIC {
        return Err(Malformed::new("header.magic", "is not that of an answer"));
    }
    if header.version != VERSION || header.abi_hash != ABI_HASH {
        return Err(Malformed::new("header.abi_hash", "is another: the daemon was built for another layout"));
    }
    if header.nonce != nonce {
        return Ok(Came::Foreign);
    }
    if header.total_bytes != message.len() as u64 {
        let problem = format!("{} is not the length {}", header.total_bytes, message.len());
        return Err(Malformed::new("header.total_bytes", problem));
    }
    let sections = Sections::check(&message, ResponseHeader::BYTES, header.sections)?;
    if header.code == 0 {
        return Ok(Came::Reply(Reply { header, message }));
    }
    refusal(header.code, &sections).map(Came::Refusal)
}

fn refusal(code: u32, sections: &Sections<'_>) -> Result<Refusal, Malformed> {
    let text = |kind| Ok(sections.text(kind)?.unwrap_or_default().to_owned());
    let lines = sections.text(kind::ERROR_DETAILS)?.unwrap_or_default();
    let line = |line: &str| line.split_once('=').map(|(key, value)| (key.to_owned(), value.to_owned()));
    Ok(Refusal {
        code,
        reason: text(kind::ERROR_REASON)?,
        message: text(kind::ERROR_MESSAGE)?,
        field: text(kind::ERROR_FIELD)?,
        details: lines.lines().filter_map(line).collect(),
    })
}

impl Reply {
    /// Of states: for each whether it is proved free.
    #[must_use]
    pub fn free(&self) -> Vec<bool> {
        let (free, _) = codes::verdict(Verdict::Free);
        self.bytes(kind::VERDICTS).unwrap_or_default().iter().map(|verdict| *verdict == free).collect()
    }

    /// Bytes of the whole message.
    #[must_use]
    pub fn message_bytes(&self) -> usize {
        self.message.len()
    }

    /// Which life of the scene was asked.
    #[must_use]
    pub fn epoch(&self) -> Epoch {
        Epoch(self.header.epoch)
    }

    /// Which state of it.
    #[must_use]
    pub fn revision(&self) -> Revision {
        Revision(self.header.revision)
    }

    /// Items answered.
    #[must_use]
    pub fn items(&self) -> usize {
        self.header.items as usize
    }

    /// The item that stopped the batch.
    #[must_use]
    pub fn stopped_at(&self) -> Option<usize> {
        (self.header.flags & STOPPED != 0).then_some(self.header.stopped_at as usize)
    }

    /// Time ran out before every item was looked at.
    #[must_use]
    pub fn out_of_time(&self) -> bool {
        self.header.flags & OUT_OF_TIME != 0
    }

    /// What all of it cost.
    #[must_use]
    pub fn cost(&self) -> Cost {
        let ResponseHeader { supports, gjk_iterations, epa_iterations, nodes, pairs, escalations, .. } = self.header;
        Cost { supports, gjk_iterations, epa_iterations, nodes, pairs, escalations, ..Cost::default() }
    }

    fn sections(&self) -> Option<Sections<'_>> {
        // It was checked when it came.
        Sections::check(&self.message, ResponseHeader::BYTES, self.header.sections).ok()
    }

    /// A column's bytes; the kinds are [`kind`]'s.
    #[must_use]
    pub fn bytes(&self, kind: u32) -> Option<&[u8]> {
        self.sections()?.bytes(kind)
    }

    /// A column of doubles.
    #[must_use]
    pub fn doubles(&self, kind: u32) -> Option<Vec<f64>> {
        self.sections()?.doubles(kind)
    }

    /// A column of 64-bit integers.
    #[must_use]
    pub fn integers(&self, kind: u32) -> Option<Vec<u64>> {
        self.sections()?.integers(kind)
    }

    /// A column of 32-bit integers.
    #[must_use]
    pub fn counts(&self, kind: u32) -> Option<Vec<u32>> {
        self.sections()?.counts(kind)
    }

    /// The items that cannot be asked, and what is wrong with each.
    #[must_use]
    pub fn problems(&self) -> Vec<(usize, String)> {
        let items = self.counts(kind::PROBLEM_ITEMS).unwrap_or_default();
        let texts = self.sections().and_then(|sections| sections.texts(kind::PROBLEM_TEXTS).ok()).unwrap_or_default();
        items.into_iter().map(|item| item as usize).zip(texts.into_iter().map(str::to_owned)).collect()
    }

    /// Pairs of parties that the scene declares empty and that no item says anything about, by their names.
    #[must_use]
    pub fn declared_empty(&self) -> Vec<[String; 2]> {
        let texts = self.sections().and_then(|sections| sections.texts(kind::DECLARED_EMPTY).ok()).unwrap_or_default();
        texts.as_chunks::<2>().0.iter().map(|pair| pair.map(str::to_owned)).collect()
    }

    /// How many more such pairs there are than are listed.
    #[must_use]
    pub fn declared_empty_not_listed(&self) -> u64 {
        self.integers(kind::DECLARED_EMPTY_NOT_LISTED).and_then(|column| column.first().copied()).unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::service::ServiceError;
    use crate::transports::shared_memory::answer::error_message;

    const OWN: Nonce = [1; 16];

    #[test]
    fn an_answer_to_another_is_told_from_ones_own() {
        let theirs = error_message([2; 16], &ServiceError::DeadlineExceeded);
        assert_eq!(decode(theirs, OWN), Ok(Came::Foreign));
        let Ok(Came::Refusal(refusal)) = decode(error_message(OWN, &ServiceError::DeadlineExceeded), OWN) else {
            panic!("no refusal")
        };
        assert_eq!((refusal.code, refusal.reason.as_str()), (4, "DEADLINE_EXCEEDED"));
    }

    #[test]
    fn what_is_no_answer_is_refused_with_its_field() {
        let good = error_message(OWN, &ServiceError::invalid("positions", "x".repeat(9000)));
        let changed = |place: usize| {
            let mut bytes = good.clone();
            bytes[place] ^= 1;
            decode(bytes, OWN).unwrap_err().field
        };
        assert_eq!(decode(good[..64].to_vec(), OWN).unwrap_err().field, "header.magic");
        assert_eq!(
            ["header.magic", "header.abi_hash", "header.total_bytes"],
            [0, 8, 24].map(changed).each_ref().map(String::as_str)
        );
        assert!(changed(ResponseHeader::BYTES + 9).starts_with("sections[0]."));
        let Ok(Came::Refusal(refusal)) = decode(good, OWN) else { panic!("no refusal") };
        assert!(refusal.field == "positions" && refusal.message.len() < 5000, "a long text is cut");
    }
}
