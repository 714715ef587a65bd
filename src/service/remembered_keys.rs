//! Was this change made before? A caller that lost an answer sends its request again under the same key, and gets the
//! first answer instead of a second change.

use std::collections::{BTreeMap, VecDeque};

use super::{ContentHash, ServiceError};

/// What tells a repeated request from a new one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct IdempotencyKey {
    /// Chosen by the caller.
    pub key: String,
    /// A hash of the edits: the same key with other edits is a mistake of the caller's.
    pub fingerprint: ContentHash,
}

/// The last keys of a scene, with what was answered.
#[derive(Debug)]
pub struct RememberedKeys<T> {
    kept: usize,
    oldest_first: VecDeque<String>,
    answers: BTreeMap<String, (ContentHash, T)>,
}

impl<T: Clone> RememberedKeys<T> {
    /// Keeps as many.
    #[must_use]
    pub fn new(kept: usize) -> Self {
        Self { kept, oldest_first: VecDeque::new(), answers: BTreeMap::new() }
    }

    /// What was answered to this request before, if it was.
    ///
    /// # Errors
    /// The key was used with other edits.
    pub fn recall(&self, key: &IdempotencyKey) -> Result<Option<T>, ServiceError> {
        match self.answers.get(&key.key) {
            None => Ok(None),
            Some((fingerprint, answer)) if *fingerprint == key.fingerprint => Ok(Some(answer.clone())),
            Some(_) => Err(ServiceError::KeyReused { key: key.key.clone() }),
        }
    }

    /// Keeps an answer, and forgets the oldest when there are too many.
    pub fn remember(&mut self, key: IdempotencyKey, answer: T) {
        self.oldest_first.push_back(key.key.clone());
        self.answers.insert(key.key, (key.fingerprint, answer));
        while self.oldest_first.len() > self.kept {
            if let Some(oldest) = self.oldest_first.pop_front() {
                self.answers.remove(&oldest);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(key: &str, fingerprint: u8) -> IdempotencyKey {
        IdempotencyKey { key: key.to_owned(), fingerprint: ContentHash::of(&[fingerprint]) }
    }

    #[test]
    fn a_repeated_request_gets_its_first_answer_until_it_is_forgotten() {
        let mut keys = RememberedKeys::new(2);
        for (name, answer) in [("a", 1), ("b", 2)] {
            assert_eq!(keys.recall(&key(name, 0)), Ok(None));
            keys.remember(key(name, 0), answer);
        }
        assert_eq!(keys.recall(&key("a", 0)), Ok(Some(1)));
        assert_eq!(keys.recall(&key("a", 9)), Err(ServiceError::KeyReused { key: "a".to_owned() }));
        keys.remember(key("c", 0), 3);
        assert_eq!(keys.recall(&key("a", 0)), Ok(None));
        assert_eq!(keys.recall(&key("c", 0)), Ok(Some(3)));
    }
}
