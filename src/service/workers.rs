//! Where is work done? Questions on a pool of threads of their own, everything else that takes long (parsing, building
//! trees, changing a scene) on the runtime's blocking threads. Callers wait without holding a thread.
//!
//! A question splits itself into parts with rayon, and a thread that waits for parts takes other work meanwhile. If that were
//! the next question, and while waiting for that one's parts the next again, the first would lie under all of them for as long as
//! questions come. So questions wait in a queue of our own, and rayon knows of no more of them at a time than it has threads: what
//! a waiting thread finds then is at most these, one each, and every question has its turn.
//!
//! A panic in either is caught, logged under a number, and becomes [`ServiceError::Internal`]: the daemon goes on.

use std::any::Any;
use std::collections::VecDeque;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use tokio::sync::oneshot;

use super::ServiceError;
use super::call_notes::CallNotes;

/// Threads that answer questions.
#[derive(Debug)]
pub struct Workers {
    pool: ThreadPool,
    queue: Arc<Queue>,
}

/// A question, and what follows from its answer.
type Job = Box<dyn FnOnce() + Send>;

/// Questions in the order they came.
#[derive(Default)]
struct Queue(Mutex<Line>);

#[derive(Default)]
struct Line {
    waiting: VecDeque<Job>,
    /// Jobs that the pool has, or is about to take from here.
    given: usize,
}

impl std::fmt::Debug for Queue {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Queue").field("waiting", &self.line().waiting.len()).finish_non_exhaustive()
    }
}

impl Queue {
    /// Jobs are run outside the lock: nothing behind it can be left half changed.
    fn line(&self) -> MutexGuard<'_, Line> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Workers {
    /// `threads` of them; 0 means one for each core.
    ///
    /// # Errors
    /// The system gives no more threads.
    pub fn new(threads: usize) -> Result<Self, ThreadPoolBuildError> {
        let pool =
            ThreadPoolBuilder::new().num_threads(threads).thread_name(|index| format!("query-{index}")).build()?;
        Ok(Self { pool, queue: Arc::default() })
    }

    /// How many threads there are.
    #[must_use]
    pub fn threads(&self) -> usize {
        self.pool.current_num_threads()
    }

    /// How much work waits for a thread.
    #[must_use]
    pub fn waiting(&self) -> usize {
        self.queue.line().waiting.len()
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
        let work = noted(work);
        let mut line = self.queue.line();
        line.waiting.push_back(Box::new(move || then(work())));
        if line.given < self.pool.current_num_threads() {
            line.given += 1;
            drop(line);
            let queue = Arc::clone(&self.queue);
            self.pool.spawn(move || next(queue));
        }
    }
}

/// Does the first job of the queue on this thread of the pool; if there are more, the pool has to do the next.
fn next(queue: Arc<Queue>) {
    let job = queue.line().waiting.pop_front();
    if let Some(job) = job {
        job();
    }
    let mut line = queue.line();
    if line.waiting.is_empty() {
        line.given -= 1;
    } else {
        drop(line);
        rayon::spawn(move || next(queue));
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
    use std::sync::atomic::AtomicBool;
    use std::time::Duration;

    use super::*;

    /// Questions that split themselves, and come for as long as the first one is not answered.
    #[tokio::test(flavor = "multi_thread")]
    async fn no_question_lies_under_those_that_came_later() {
        use rayon::prelude::*;
        const CROWD: u64 = 16;
        // One part of each takes long: whoever gave it away has to wait for it.
        let busy = |part: u64| {
            let end = Instant::now() + Duration::from_micros(if part == 12 { 300 } else { 5 });
            while Instant::now() < end {
                std::hint::spin_loop();
            }
        };
        let split = move || move || Ok((0..16).into_par_iter().map(busy).collect::<Vec<()>>().len());
        let (workers, over) = (Arc::new(Workers::new(2).unwrap()), Arc::new(AtomicBool::new(false)));
        let answered = Arc::new(AtomicU64::new(0));
        let ask = |workers: Arc<Workers>, over: Arc<AtomicBool>, answered: Arc<AtomicU64>| async move {
            while !over.load(Ordering::Acquire) {
                workers.answer(split()).await.unwrap();
                answered.fetch_add(1, Ordering::AcqRel);
            }
        };
        let crowd: Vec<_> = (0..CROWD)
            .map(|_| tokio::spawn(ask(Arc::clone(&workers), Arc::clone(&over), Arc::clone(&answered))))
            .collect();
        let (mut most, mut all) = (0, 0);
        for _ in 0..300 {
            let before = answered.load(Ordering::Acquire);
            assert_eq!(workers.answer(split()).await, Ok(16));
            let meanwhile = answered.load(Ordering::Acquire) - before;
            (most, all) = (most.max(meanwhile), all + meanwhile);
        }
        over.store(true, Ordering::Release);
        for one in crowd {
            one.await.unwrap();
        }
        assert!(all > 300, "there was no crowd: {all}");
        assert!(most <= 4 * CROWD, "one waited for {most} others");
    }

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
