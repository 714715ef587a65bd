//! Which geometry files are here? Named by the SHA-256 of their bytes, uploaded once, kept in memory until the daemon
//! ends.
//!
//! An upload announces its hash and size first. Its size is set aside at once, so that all uploads together stay within
//! the cap, and given back if the upload fails or its caller goes away.

use std::collections::BTreeMap;
use std::fmt;
use std::str::FromStr;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use sha2::{Digest, Sha256};

use super::ServiceError;
use super::admission::{Admission, Permit};
use crate::limits::{LimitExceeded, Limits};

/// SHA-256 of a file's bytes; as text, 64 lower-case hexadecimal digits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ContentHash([u8; 32]);

impl ContentHash {
    /// The hash of some bytes.
    #[must_use]
    pub fn of(bytes: &[u8]) -> Self {
        Self(Sha256::digest(bytes).into())
    }
}

impl fmt::Display for ContentHash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

/// A text that is not a hash.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("is not a SHA-256 of 64 lower-case hexadecimal digits")]
pub struct NotAHash;

impl FromStr for ContentHash {
    type Err = NotAHash;

    fn from_str(text: &str) -> Result<Self, NotAHash> {
        let digit = |c: u8| match c {
            b'0'..=b'9' => Ok(c - b'0'),
            b'a'..=b'f' => Ok(c - b'a' + 10),
            _ => Err(NotAHash),
        };
        let mut hash = [0; 32];
        if text.len() != 2 * hash.len() {
            return Err(NotAHash);
        }
        for (byte, pair) in hash.iter_mut().zip(text.as_bytes().chunks_exact(2)) {
            *byte = digit(pair[0])? << 4 | digit(pair[1])?;
        }
        Ok(Self(hash))
    }
}

/// What became of an upload.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stored {
    /// Of the bytes that arrived.
    pub hash: ContentHash,
    /// How many arrived.
    pub bytes: usize,
    /// They were here before.
    pub already_present: bool,
}

/// The files of the daemon.
#[derive(Debug)]
pub struct Assets {
    max_bytes: usize,
    max_total_bytes: usize,
    uploads: Admission,
    shelf: Mutex<Shelf>,
}

#[derive(Debug, Default)]
struct Shelf {
    files: BTreeMap<ContentHash, Arc<[u8]>>,
    /// Bytes of the files and of the uploads under way.
    spoken_for: usize,
}

impl Assets {
    /// An empty store; `uploads` admits uploads.
    #[must_use]
    pub fn new(limits: &Limits, uploads: Admission) -> Self {
        Self {
            max_bytes: limits.max_asset_bytes,
            max_total_bytes: limits.max_total_asset_bytes,
            uploads,
            shelf: Mutex::default(),
        }
    }

    /// Whether a file is here.
    #[must_use]
    pub fn has(&self, hash: ContentHash) -> bool {
        self.shelf().files.contains_key(&hash)
    }

    /// Bytes of all files, and of the uploads under way.
    #[must_use]
    pub fn total_bytes(&self) -> usize {
        self.shelf().spoken_for
    }

    /// A file's bytes.
    ///
    /// # Errors
    /// It was never uploaded.
    pub fn get(&self, hash: ContentHash) -> Result<Arc<[u8]>, ServiceError> {
        let missing = || ServiceError::NotFound { what: "asset", name: hash.to_string() };
        self.shelf().files.get(&hash).cloned().ok_or_else(missing)
    }

    /// Begins an upload of `bytes` bytes that will have this hash.
    ///
    /// # Errors
    /// Too large, or too many at a time.
    pub fn begin_upload(self: &Arc<Self>, hash: ContentHash, bytes: u64) -> Result<Upload, ServiceError> {
        let permit = self.uploads.enter()?;
        let announced = usize::try_from(bytes).unwrap_or(usize::MAX);
        LimitExceeded::check("max_asset_bytes", announced, self.max_bytes)?;
        let mut shelf = self.shelf();
        let spoken_for = shelf.spoken_for + announced;
        LimitExceeded::check("max_total_asset_bytes", spoken_for, self.max_total_bytes)?;
        shelf.spoken_for = spoken_for;
        Ok(Upload { assets: Arc::clone(self), hash, announced, received: Vec::new(), _permit: permit })
    }

    /// Nothing can panic halfway through a change of the shelf, so a poisoned lock guards a sound one.
    fn shelf(&self) -> MutexGuard<'_, Shelf> {
        self.shelf.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// An upload under way. Dropping it forgets what has arrived.
#[derive(Debug)]
pub struct Upload {
    assets: Arc<Assets>,
    hash: ContentHash,
    announced: usize,
    received: Vec<u8>,
    _permit: Permit,
}

impl Upload {
    /// The next bytes.
    ///
    /// # Errors
    /// More than were announced.
    pub fn push(&mut self, chunk: &[u8]) -> Result<(), ServiceError> {
        let total = self.received.len() + chunk.len();
        if total > self.announced {
            let problem = format!("{} bytes were announced, at least {total} came", self.announced);
            return Err(ServiceError::HashMismatch { problem });
        }
        self.received.extend_from_slice(chunk);
        Ok(())
    }

    /// Puts the file on the shelf if it is what was announced. Hashing takes milliseconds per megabyte.
    ///
    /// # Errors
    /// Fewer bytes than announced, or another hash.
    pub fn finish(mut self) -> Result<Stored, ServiceError> {
        let bytes = self.received.len();
        if bytes < self.announced {
            let problem = format!("{} bytes were announced, {bytes} came", self.announced);
            return Err(ServiceError::HashMismatch { problem });
        }
        let hash = ContentHash::of(&self.received);
        if hash != self.hash {
            let problem = format!("sha256 {} was announced, the bytes have {hash}", self.hash);
            return Err(ServiceError::HashMismatch { problem });
        }
        let file: Arc<[u8]> = std::mem::take(&mut self.received).into();
        let mut shelf = self.assets.shelf();
        let already_present = shelf.files.contains_key(&hash);
        if !already_present {
            shelf.files.insert(hash, file);
            self.announced = 0; // The bytes stay spoken for.
        }
        drop(shelf);
        Ok(Stored { hash, bytes, already_present })
    }
}

impl Drop for Upload {
    fn drop(&mut self) {
        self.assets.shelf().spoken_for -= self.announced;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn store(max_asset_bytes: usize, max_total_asset_bytes: usize) -> Arc<Assets> {
        let limits = Limits { max_asset_bytes, max_total_asset_bytes, ..Limits::default() };
        Arc::new(Assets::new(&limits, Admission::new("max_uploads_in_flight", 2)))
    }

    fn put(assets: &Arc<Assets>, bytes: &[u8]) -> Result<Stored, ServiceError> {
        let mut upload = assets.begin_upload(ContentHash::of(bytes), bytes.len() as u64)?;
        bytes.chunks(3).try_for_each(|chunk| upload.push(chunk))?;
        upload.finish()
    }

    #[test]
    fn the_hash_of_a_text_is_the_published_one() {
        let abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(ContentHash::of(b"abc").to_string(), abc);
        assert_eq!(abc.parse(), Ok(ContentHash::of(b"abc")));
        assert_eq!(abc.to_uppercase().parse::<ContentHash>(), Err(NotAHash));
        assert_eq!(abc[1..].parse::<ContentHash>(), Err(NotAHash));
    }

    #[test]
    fn a_file_is_kept_once_and_found_by_its_hash() {
        let assets = store(10, 20);
        assert!(!put(&assets, b"0123456").unwrap().already_present);
        assert!(put(&assets, b"0123456").unwrap().already_present);
        assert_eq!(&*assets.get(ContentHash::of(b"0123456")).unwrap(), b"0123456");
        assert!(matches!(assets.get(ContentHash::of(b"")), Err(ServiceError::NotFound { what: "asset", .. })));
        put(&assets, b"another file!").unwrap_err();
        put(&assets, b"another").unwrap();
        assert_eq!(assets.shelf().spoken_for, 14);
    }

    #[test]
    fn an_upload_that_is_not_what_was_announced_leaves_nothing_behind() {
        let assets = store(100, 100);
        let mut short = assets.begin_upload(ContentHash::of(b"abc"), 3).unwrap();
        short.push(b"ab").unwrap();
        assert!(matches!(short.finish(), Err(ServiceError::HashMismatch { .. })));
        let mut long = assets.begin_upload(ContentHash::of(b"abc"), 3).unwrap();
        assert!(matches!(long.push(b"abcd"), Err(ServiceError::HashMismatch { .. })));
        drop(long);
        let mut other = assets.begin_upload(ContentHash::of(b"abc"), 3).unwrap();
        other.push(b"xyz").unwrap();
        assert!(matches!(other.finish(), Err(ServiceError::HashMismatch { .. })));
        assert!(!assets.has(ContentHash::of(b"abc")));
        assert_eq!(assets.shelf().spoken_for, 0);
    }

    #[test]
    fn uploads_under_way_count_towards_the_caps() {
        let assets = store(60, 100);
        let first = assets.begin_upload(ContentHash::of(b"1"), 60).unwrap();
        let limit = |result: Result<Upload, ServiceError>| match result {
            Err(ServiceError::Limit(exceeded)) => exceeded.limit,
            other => panic!("{other:?}"),
        };
        assert_eq!(limit(assets.begin_upload(ContentHash::of(b"2"), 61)), "max_asset_bytes");
        assert_eq!(limit(assets.begin_upload(ContentHash::of(b"2"), 50)), "max_total_asset_bytes");
        let _second = assets.begin_upload(ContentHash::of(b"2"), 40).unwrap();
        assert_eq!(limit(assets.begin_upload(ContentHash::of(b"3"), 0)), "max_uploads_in_flight");
        drop(first);
        assert!(assets.begin_upload(ContentHash::of(b"3"), 60).is_ok());
    }
}
