//! Who answers at the door? One thread that sleeps until a request comes, answers small ones itself and hands the
//! others to the threads that answer questions.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::thread;
use std::time::{Duration, Instant};

use iceoryx2::active_request::ActiveRequest;
use iceoryx2::port::notifier::Notifier;
use iceoryx2::port::{LoanError, ReceiveError};
use iceoryx2::prelude::CallbackProgression;
use tokio::runtime::Handle;

use super::answer::{error_message, response_message};
use super::door::{DOOR, Ports};
use super::endpoint::{Ipc, Line, lines, listener_name, sleep, told};
use super::layout::RequestHeader;
use super::questions::answered;
use super::request::{Called, ClientId, Nonce, PairsOf, Question, Received, Request, decode};
use super::subjects::Asked;
use crate::limits::LimitExceeded;
use crate::query::{Motions, Subject};
use crate::service::{Asker, Call, FEW_ITEMS, Outcome, Rpc, Service, ServiceError, Traffic, View, Waiting};
use crate::transports::requests;

/// A request that waits for its answer.
type Pending = ActiveRequest<Ipc, [Line], (), [Line], ()>;

/// A sleeping door looks around this often without being woken.
const LOOK: Duration = Duration::from_secs(1);
/// The same while it drains.
const LOOK_DRAINING: Duration = Duration::from_millis(20);
/// What dead processes left is cleaned up this often at the least, even when there is always something to do.
const CLEANUP: Duration = Duration::from_secs(10);
/// Whether the caller is still there is looked at this often while others work on the answer.
const STILL_THERE: Duration = Duration::from_millis(50);
/// A caller that has not fetched its last answers for so long gets no more.
const ROOM_PATIENCE: Duration = Duration::from_millis(100);

/// The thread's state.
#[derive(Debug)]
pub(super) struct Attendant {
    ports: Ports,
    desk: Arc<Desk>,
    runtime: Handle,
    spin: Duration,
    draining: Arc<AtomicBool>,
    /// The last request: its memory serves the next.
    copy: Vec<u8>,
    /// Requests that others work on, and what stops the work.
    handed_over: Vec<(Weak<Mutex<Pending>>, Waiting)>,
}

/// What the thread shares with work that was handed over.
#[derive(Debug)]
struct Desk {
    service: Arc<Service>,
    traffic: Arc<Traffic>,
    answered: Arc<Notifier<Ipc>>,
    handed_over: AtomicUsize,
    /// Wakes the attendant.
    attendant: Arc<Notifier<Ipc>>,
    /// The attendant was told of a request that it cannot see yet.
    looked_in_vain: AtomicBool,
}

/// To whom an answer goes.
#[derive(Clone, Copy, Debug)]
struct Caller {
    nonce: Nonce,
    client: ClientId,
}

impl Attendant {
    pub fn new(
        ports: Ports,
        service: Arc<Service>,
        runtime: Handle,
        spin: Duration,
        draining: Arc<AtomicBool>,
    ) -> Self {
        let desk = Desk {
            traffic: service.traffic(DOOR),
            service,
            answered: Arc::clone(&ports.answered),
            handed_over: AtomicUsize::new(0),
            attendant: Arc::clone(&ports.wake),
            looked_in_vain: AtomicBool::new(false),
        };
        Self { ports, desk: Arc::new(desk), runtime, spin, draining, copy: Vec::new(), handed_over: Vec::new() }
    }

    /// Answers until the door drains and everything under way is answered.
    ///
    /// # Errors
    /// The memory is taken away.
    pub fn attend(mut self) -> Result<(), String> {
        let (mut cleaned, mut woken) = (Instant::now(), 0);
        loop {
            let draining = self.draining.load(Ordering::Acquire);
            let mut any = self.take_all();
            if woken > 0 && !any {
                // A client's next request stays out of sight until its last one is let go of, a moment after the answer was
                // sent. Whoever lets go of it after this look wakes the attendant again.
                self.desk.looked_in_vain.store(true, Ordering::SeqCst);
                any = self.take_all();
            }
            if draining && self.desk.handed_over.load(Ordering::Acquire) == 0 {
                return Ok(());
            }
            // Work for nobody stops here; what is answered has no request left.
            self.handed_over.retain(|(pending, _)| pending.upgrade().is_some_and(|pending| is_wanted(&pending)));
            if any && self.comes_soon() {
                continue;
            }
            let look = match (draining, self.handed_over.is_empty()) {
                (true, _) => LOOK_DRAINING,
                (false, false) => STILL_THERE,
                (false, true) => LOOK,
            };
            woken = sleep(&self.ports.asked, look)?;
            // Where nothing comes, or only work for somebody who may have died is left.
            if woken == 0 && cleaned.elapsed() >= LOOK || cleaned.elapsed() > CLEANUP {
                self.ports.node.try_cleanup_dead_nodes();
                cleaned = Instant::now();
            }
        }
    }

    /// Takes every request that is there; whether there was any.
    fn take_all(&mut self) -> bool {
        let mut any = false;
        while let Some(waiting) = self.next() {
            any = true;
            self.take(waiting);
        }
        any
    }

    fn next(&self) -> Option<Pending> {
        match self.ports.server.receive() {
            Ok(request) => request,
            // Of a client whose last request is not let go of yet.
            Err(ReceiveError::ExceedsMaxBorrows) => None,
            // A broken connection is its client's misfortune, not the door's.
            Err(error @ ReceiveError::ConnectionFailure(_)) => {
                tracing::warn!("a connection of shared memory cannot be read: {error}");
                None
            }
        }
    }

    /// Looks for the next request for a short time, which is quicker than sleeping and being woken.
    fn comes_soon(&self) -> bool {
        let end = Instant::now() + self.spin;
        while Instant::now() < end {
            if self.ports.server.has_requests().unwrap_or(false) {
                return true;
            }
            std::hint::spin_loop();
        }
        false
    }

    fn take(&mut self, waiting: Pending) {
        let limits = self.desk.service.limits();
        let (most, most_answered) = (limits.max_shared_memory_request_bytes, limits.max_shared_memory_response_bytes);
        // From here on only the copy counts: the client may go on writing to its memory.
        let shared = waiting.payload().as_flattened();
        let size = LimitExceeded::check("max_shared_memory_request_bytes", shared.len(), most);
        self.desk.traffic.received_bytes.add(shared.len() as u64);
        self.copy.clear();
        self.copy.extend_from_slice(shared.get(..shared.len().min(most)).unwrap_or_default());
        let message = &self.copy;
        let header = RequestHeader::read(message);
        let caller = Caller { nonce: header.nonce, client: header.client };
        let decoded = size.map_err(ServiceError::from).and_then(|()| decode(message, limits));
        let request = match decoded {
            Ok(Received::Asked(request)) => *request,
            Ok(Received::Called(called)) => return self.call(waiting, caller, called),
            Err(error) => {
                self.desk.begin_call(Some(Rpc::UNREADABLE), caller).end(Outcome::of(&error));
                return self.desk.give(waiting, caller, &error_message(caller.nonce, &error));
            }
        };
        let call = self.desk.begin_call(rpc_of(&request), caller);
        if is_small(&request) {
            let question = |view: &_| answered(&request, caller.nonce, most_answered, view);
            let asked = || self.desk.service.ask_here(&request.target, request.patience, question);
            if let Some(answer) = call.work_here(asked) {
                call.end(Outcome::of_result(&answer));
                return self.desk.give(waiting, caller, &message_of(caller.nonce, answer));
            }
        }
        self.hand_over(waiting, caller, request, Arc::new(call));
    }

    /// Has the threads that answer questions send the answer, too: a way back over this thread would cost a wake-up.
    fn hand_over(&mut self, waiting: Pending, caller: Caller, request: Request, call: Arc<Call>) {
        let (waiting, request) = (Arc::new(Mutex::new(waiting)), Arc::new(request));
        let most = self.desk.service.limits().max_shared_memory_response_bytes;
        let (pending, counted) = (Arc::clone(&waiting), Counted::new(&self.desk));
        let ended = Arc::clone(&call);
        let then = move |answer| {
            ended.end(Outcome::of_result(&answer));
            counted.0.give_back(pending, caller, &message_of(caller.nonce, answer));
        };
        let asked = Arc::clone(&request);
        let question = move |view: &View| answered(&asked, caller.nonce, most, view);
        let service = &self.desk.service;
        match call.work_here(|| service.ask_then(&request.target, request.patience, question, then)) {
            Ok(Some(work)) => self.handed_over.push((Arc::downgrade(&waiting), work)),
            Ok(None) => self.wait(waiting, caller, request, call),
            Err(error) => {
                call.end(Outcome::of(&error));
                self.desk.give_back(waiting, caller, &error_message(caller.nonce, &error));
            }
        }
    }

    /// Waits for a revision that is still to come.
    fn wait(&self, waiting: Arc<Mutex<Pending>>, caller: Caller, request: Arc<Request>, call: Arc<Call>) {
        let service = Arc::clone(&self.desk.service);
        self.work(waiting, caller, async move {
            let most = service.limits().max_shared_memory_response_bytes;
            let asked = Arc::clone(&request);
            let question = move |view: &View| answered(&asked, caller.nonce, most, view);
            call.answer(service.ask(&request.target, request.patience, question)).await
        });
    }

    fn call(&self, waiting: Pending, caller: Caller, Called { rpc, message, timeout }: Called) {
        let service = Arc::clone(&self.desk.service);
        let call = self.desk.begin_call(requests::rpc_named(&rpc), caller);
        self.work(Arc::new(Mutex::new(waiting)), caller, async move {
            let response = call.answer(requests::call(&service, &rpc, message, timeout)).await?;
            let message = response_message(caller.nonce, &response);
            let most = service.limits().max_shared_memory_response_bytes;
            LimitExceeded::check("max_shared_memory_response_bytes", message.len(), most)?;
            Ok(message)
        });
    }

    /// Has a task work on the answer, as long as its caller is there.
    fn work(
        &self,
        waiting: Arc<Mutex<Pending>>,
        caller: Caller,
        answering: impl Future<Output = Result<Vec<u8>, ServiceError>> + Send + 'static,
    ) {
        let counted = Counted::new(&self.desk);
        self.runtime.spawn(async move {
            let desk = &counted.0;
            tokio::pin!(answering);
            loop {
                match tokio::time::timeout(STILL_THERE, &mut answering).await {
                    Ok(answer) => return desk.give_back(waiting, caller, &message_of(caller.nonce, answer)),
                    // Dropping the question stops the work.
                    Err(_) if !is_wanted(&waiting) => return,
                    Err(_) => {}
                }
            }
        });
    }
}

/// Whether the caller is still there. While the answer is being sent, it counts as there.
fn is_wanted(waiting: &Mutex<Pending>) -> bool {
    waiting.try_lock().map_or(true, |waiting| waiting.is_connected())
}

/// Nothing behind the lock can be left half changed.
fn locked(waiting: &Mutex<Pending>) -> MutexGuard<'_, Pending> {
    waiting.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A request that is counted as handed over, however the work on it ends.
struct Counted(Arc<Desk>);

impl Counted {
    fn new(desk: &Arc<Desk>) -> Self {
        desk.handed_over.fetch_add(1, Ordering::AcqRel);
        Self(Arc::clone(desk))
    }
}

impl Drop for Counted {
    fn drop(&mut self) {
        self.0.handed_over.fetch_sub(1, Ordering::AcqRel);
    }
}

fn message_of(nonce: Nonce, answer: Result<Vec<u8>, ServiceError>) -> Vec<u8> {
    answer.unwrap_or_else(|error| error_message(nonce, &error))
}

/// Whether a question surely takes little time. One motion can take long, and so can all pairs of a scene.
fn is_small(request: &Request) -> bool {
    let all_pairs = |asked: &Asked| matches!(asked, Asked::Subject(Subject::All | Subject::ChangedSince(_)));
    let quick = match &request.question {
        Question::States(..) | Question::Rays(_) => true,
        Question::Motions(..) => false,
        Question::Pairs { items, .. } => !items.iter().any(all_pairs),
    };
    quick && request.items <= FEW_ITEMS
}

/// The rpc that asks the same through other doors.
fn rpc_of(request: &Request) -> Option<Rpc> {
    requests::rpc_named(match &request.question {
        Question::States(..) => "Queries/CheckStates",
        Question::Motions(motions, _) if motions.motions == Motions::Path => "Queries/CheckPath",
        Question::Motions(..) => "Queries/CheckMotions",
        Question::Pairs { what: PairsOf::Collide, .. } => "Queries/Collide",
        Question::Pairs { what: PairsOf::Distance, .. } => "Queries/Distance",
        Question::Rays(_) => "Queries/CastRays",
    })
}

impl Desk {
    /// The call as those see it who observe the daemon.
    fn begin_call(&self, rpc: Option<Rpc>, caller: Caller) -> Call {
        let Some(rpc) = rpc else { return Call::unobserved() };
        let client = || format!("shared-memory:{:032x}", u128::from_be_bytes(caller.client)).into();
        self.service.begin_call(rpc, || Asker { door: DOOR, client: client(), traceparent: None })
    }

    /// Sends an answer, lets go of the request, and wakes the one who waits. A caller that is gone, or does not fetch its
    /// answers, gets none: it has stopped waiting, or will by its own deadline.
    fn give(&self, waiting: Pending, caller: Caller, message: &[u8]) {
        self.send(&waiting, message);
        drop(waiting);
        self.wake(caller.client);
    }

    /// The same of a request that was handed over.
    fn give_back(&self, waiting: Arc<Mutex<Pending>>, caller: Caller, message: &[u8]) {
        self.send(&locked(&waiting), message);
        drop(waiting);
        self.wake(caller.client);
        if self.looked_in_vain.swap(false, Ordering::SeqCst)
            && let Err(error) = self.attendant.notify()
        {
            tracing::debug!("the attendant of shared memory was not woken: {error:?}");
        }
    }

    fn send(&self, waiting: &Pending, message: &[u8]) {
        self.traffic.sent_bytes.add(message.len() as u64);
        if let Err(problem) = self.try_give(waiting, message) {
            tracing::warn!("an answer through shared memory was not delivered: {problem}");
        }
    }

    fn try_give(&self, waiting: &Pending, message: &[u8]) -> Result<(), String> {
        let (lines, until) = (lines(message), Instant::now() + ROOM_PATIENCE);
        let room = loop {
            // A dead client's slot may have a new owner; the nonce keeps the new one safe, this spares it the work.
            if !waiting.is_connected() {
                return Ok(());
            }
            match waiting.loan_slice_uninit(lines.len()) {
                Ok(room) => break room,
                Err(LoanError::OutOfMemory) if Instant::now() < until => thread::sleep(Duration::from_millis(1)),
                Err(error) => return Err(error.to_string()),
            }
        };
        room.write_from_slice(lines).send().map_err(told).map(drop)
    }

    fn wake(&self, client: ClientId) {
        let name = listener_name(client);
        self.answered.for_each_listener(|one, details| {
            if details.listener_name.as_str() != name {
                return CallbackProgression::Continue;
            }
            if let Err(error) = one.notify() {
                tracing::debug!("a client of shared memory was not woken: {error:?}");
            }
            CallbackProgression::Stop
        });
    }
}
