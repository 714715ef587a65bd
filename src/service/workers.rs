//! Where is work done? Questions on a pool of threads of their own, everything else that takes long (parsing, building
//! trees, changing a scene) on the runtime's blocking threads. Callers wait without holding a thread.
//!
//! A panic in either is caught, logged under a number, and becomes [`ServiceError::Internal`]: the daemon goes on.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::time::Instant;

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use tokio::sync::oneshot;

use super::ServiceError;
use super::call_notes::CallNotes;

/// Threads that answer questions.
#[derive(Debug)]
pub struct Workers {
    pool: ThreadPool,
    /// Work that waits for a thread.
    waiting: Arc<AtomicUsize>,
}

impl Workers {
    /// `threads` of them; 0 means one for each core.
    ///
    /// # Errors
    /// The system gives no more threads.
    pub fn new(threads: usize) -> Result<Self, ThreadPoolBuildError> {
        let pool =
            ThreadPoolBuilder::new().num_threads(threads).thread_name(|index| format!("query-{index}")).build()?;
        Ok(Self { pool, waiting: Arc::default() })
    }

    /// How many threads there are.
    #[must_use]
    pub fn threads(&self) -> usize {
        self.pool.current_num_threads()
    }

    /// How much work waits for a thread.
    #[must_use]
    pub fn waiting(&self) -> usize {
        self.waiting.load(Ordering::Relaxed)
    }

    /// Does `work` on the pool, where it may split itself with rayon.
    ///
    /// # Errors
    /// What `work` says, or [`ServiceError::Internal`] if it panics.
    pub async fn answer<T: Send + 'static>(
        &self,
        work: impl FnOnce() -> Result<T, ServiceError> + Send + 'static,
    ) -> Result<T, ServiceError> {
        let (sender, receiver) = oneshot::channel();
        // Whether somebody still waits for the result is not the work's concern.
        self.answer_then(work, |result| drop(sender.send(result)));
        receiver.await.unwrap_or_else(|_| Err(incident("a worker ended without a result")))
    }

    /// Does `work` on the pool, and there what follows from its result.
    pub fn answer_then<T: 'static>(
        &self,
        work: impl FnOnce() -> Result<T, ServiceError> + Send + 'static,
        then: impl FnOnce(Result<T, ServiceError>) + Send + 'static,
    ) {
        let (waiting, work) = (Arc::clone(&self.waiting), noted(work));
        waiting.fetch_add(1, Ordering::Relaxed);
        self.pool.spawn(move || {
            waiting.fetch_sub(1, Ordering::Relaxed);
            then(work());
        });
    }
}

/// Does `work` on a thread that may take its time.
///
/// # Errors
/// What `work` says, or [`ServiceError::Internal`] if it panics.
pub async fn prepare<T: Send + 'static>(
    work: impl FnOnce() -> Result<T, ServiceError> + Send + 'static,
) -> Result<T, ServiceError> {
    match tokio::task::spawn_blocking(noted(work)).await {
        Ok(result) => result,
        Err(_) => Err(ServiceError::ShuttingDown), // Panics are caught above, so the runtime is going down.
    }
}

/// The same work, for another thread: a panic is caught, and if it belongs to a call, that call's notes say how long it waited
/// and took.
fn noted<T>(work: impl FnOnce() -> Result<T, ServiceError>) -> impl FnOnce() -> Result<T, ServiceError> {
    let call = CallNotes::current().map(|notes| (notes, Instant::now()));
    move || match call {
        Some((notes, handed_over)) => {
            notes.note_waited(handed_over.elapsed());
            notes.work(|| caught(work))
        }
        None => caught(work),
    }
}

/// Nothing that outlives a panic is shared with it but immutable snapshots and values behind locks that notice.
pub(super) fn caught<T>(work: impl FnOnce() -> Result<T, ServiceError>) -> Result<T, ServiceError> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| Err(incident(text_of(panic.as_ref()))))
}

/// Logs a defect under a number that the caller is told.
pub(super) fn incident(what: &str) -> ServiceError {
    static NEXT: AtomicU64 = AtomicU64::new(1);
    let incident = NEXT.fetch_add(1, Ordering::Relaxed);
    tracing::error!(incident, "defect while answering a request: {what}");
    ServiceError::Internal { incident }
}

fn text_of(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<&str>().copied();
    text.or_else(|| panic.downcast_ref::<String>().map(String::as_str)).unwrap_or("a panic without a text")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn a_panic_is_an_internal_error_and_the_pool_goes_on() {
        let workers = Workers::new(1).unwrap();
        let defect = workers.answer(|| -> Result<(), _> { panic!("out of cheese") }).await;
        assert!(matches!(defect, Err(ServiceError::Internal { .. })), "{defect:?}");
        assert_eq!(workers.answer(|| Ok(2 + 2)).await, Ok(4));
        let defect = prepare(|| -> Result<(), _> { panic!("{} of {}", "out", "cheese") }).await;
        assert!(matches!(defect, Err(ServiceError::Internal { .. })), "{defect:?}");
    }
}
