//! Queries on the keys of calls: each is answered, with the response message or with an error reply.

use std::pin::Pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::task::{Context, Waker};
use std::time::Duration;

use prost::Message;
use prost::bytes::Bytes;
use tokio::runtime::Handle;
use tokio::sync::watch;
use zenoh::bytes::{Encoding, ZBytes};
use zenoh::query::{Query, Queryable};
use zenoh::{Result, Session, Wait};

use super::callers::Callers;
use super::door::DOOR;
use super::keys::Keys;
use super::selector::Selected;
use crate::limits::LimitExceeded;
use crate::service::{Asker, Call, Outcome, Rpc, Service, ServiceError, Traffic};
use crate::transports::requests::{self, Steps};
use crate::transports::wire::to_proto;

/// Queries of up to so many bytes are begun where they arrive. Most small questions are answered there, too: to hand them over
/// takes longer than the answer.
const SMALL_QUERY: usize = 4 << 10;
/// Replies of up to so many bytes are sent by the thread on which their query arrived, if they are there at once.
const SMALL_REPLY: usize = 16 << 10;

/// What all queries share.
#[derive(Debug)]
pub(super) struct Desk {
    pub service: Arc<Service>,
    pub keys: Keys,
    callers: Callers,
    traffic: Arc<Traffic>,
    /// How many are being answered.
    under_way: watch::Sender<usize>,
    /// How many replies are being sent: those to a caller that does not read wait for seconds.
    sending: AtomicUsize,
}

impl Desk {
    pub async fn new(session: &Session, service: &Arc<Service>, keys: &Keys) -> Result<Arc<Self>> {
        Ok(Arc::new(Self {
            service: Arc::clone(service),
            keys: keys.clone(),
            callers: Callers::new(session, keys).await?,
            traffic: service.traffic(DOOR),
            under_way: watch::Sender::new(0),
            sending: AtomicUsize::new(0),
        }))
    }

    /// Answers queries for as long as what is returned is kept.
    pub async fn open(self: &Arc<Self>, session: &Session) -> Result<Queryable<()>> {
        let (desk, runtime) = (Arc::clone(self), Handle::current());
        session
            .declare_queryable(self.keys.calls())
            .complete(true)
            .callback(move |query| begin(answer(Arc::clone(&desk), query), &runtime))
            .await
    }

    /// So many bytes of a message came.
    pub fn received(&self, bytes: usize) {
        self.traffic.received_bytes.add(bytes as u64);
    }

    /// So many bytes of a message went.
    pub fn sent(&self, bytes: usize) {
        self.traffic.sent_bytes.add(bytes as u64);
    }

    /// Waits until nothing is being answered.
    pub async fn idle(&self) {
        // The sender is here: it cannot be gone.
        _ = self.under_way.subscribe().wait_for(|under_way| *under_way == 0).await;
    }

    /// The call as those see it who observe the daemon.
    fn begin_call(&self, selected: Option<&Selected>) -> Call {
        let rpc = match selected {
            Some(Selected { rpc, .. }) => requests::rpc_named(rpc),
            None => Some(Rpc::UNREADABLE),
        };
        let Some(rpc) = rpc else { return Call::unobserved() };
        let client = selected.and_then(|selected| selected.client.as_deref());
        let traceparent = selected.and_then(|selected| selected.traceparent.as_deref());
        self.service.begin_call(rpc, || Asker {
            door: DOOR,
            client: client.map_or_else(|| DOOR.into(), |client| format!("{DOOR}:{client}").into()),
            traceparent: traceparent.map(Into::into),
        })
    }
}

/// A query that is counted while it is being answered.
struct Counted(Arc<Desk>);

impl Counted {
    fn new(desk: &Arc<Desk>) -> Self {
        desk.under_way.send_modify(|under_way| *under_way += 1);
        Self(Arc::clone(desk))
    }
}

impl Drop for Counted {
    fn drop(&mut self) {
        self.0.under_way.send_modify(|under_way| *under_way -= 1);
    }
}

/// Works on an answer on this thread, which is one of zenoh's, as far as it goes without waiting; a task does the rest.
fn begin(mut answering: Answering, runtime: &Handle) {
    if answering.is_quick {
        let _guard = runtime.enter();
        answering.here.store(true, Ordering::Relaxed);
        if answering.work.as_mut().poll(&mut Context::from_waker(Waker::noop())).is_ready() {
            return;
        }
        answering.here.store(false, Ordering::Relaxed);
    }
    // The first poll in there takes the place of the waker that does nothing.
    runtime.spawn(answering.work);
}

/// The answer to a query, on its way.
struct Answering {
    is_quick: bool,
    /// Whether the thread is the one on which the query arrived.
    here: Arc<AtomicBool>,
    work: Pin<Box<dyn Future<Output = ()> + Send>>,
}

fn answer(desk: Arc<Desk>, query: Query) -> Answering {
    let is_small = query.payload().is_none_or(|payload| payload.len() <= SMALL_QUERY);
    // Where one reply waits for its caller to read, the next could, too, and zenoh has few threads.
    let is_quick = is_small && desk.sending.load(Ordering::Acquire) == 0;
    let here = Arc::new(AtomicBool::new(false));
    let is_here = Arc::clone(&here);
    let counted = Counted::new(&desk);
    let work = async move {
        let _counted = counted;
        let bytes = query.payload().map_or(0, ZBytes::len);
        desk.received(bytes);
        let selected = Selected::read(&desk.keys, query.key_expr().as_str(), query.parameters().as_str());
        let call = desk.begin_call(selected.as_ref().ok());
        let reply = Replies { desk: &desk, query: &query, here: &is_here };
        let outcome = match selected {
            Ok(selected) => reply.answered(&selected, &call, bytes).await,
            Err(error) => Err(error),
        };
        match outcome {
            Ok(Ended::Told) => call.end(Outcome::OK),
            Ok(Ended::Left) => call.end(Outcome::ABANDONED),
            Err(error) => {
                call.end(Outcome::of(&error));
                reply.refuse(&error);
            }
        }
    };
    Answering { is_quick, here, work: Box::pin(work) }
}

/// How an answer ended without an error.
enum Ended {
    /// Everything is told.
    Told,
    /// The caller is gone.
    Left,
}

/// Where replies to a query go.
struct Replies<'a> {
    desk: &'a Desk,
    query: &'a Query,
    here: &'a AtomicBool,
}

impl Replies<'_> {
    async fn answered(
        &self,
        selected: &Selected,
        call: &Call,
        bytes: usize,
    ) -> std::result::Result<Ended, ServiceError> {
        let limits = self.desk.service.limits();
        LimitExceeded::check("max_message_bytes", bytes, limits.max_message_bytes)?;
        let longest = Duration::from_secs(limits.max_deadline_seconds as u64);
        let message = self.query.payload().map_or_else(Bytes::new, |payload| payload.to_bytes().into_owned().into());
        // zenoh tells nobody's leaving: without a timeout, nothing lasts longer than the longest deadline.
        let timeout = Some(selected.timeout.unwrap_or(longest));
        let answering = call.work(self.told(selected, message, timeout));
        let Some(client) = selected.client.clone() else { return answering.await };
        tokio::select! {
            biased;
            outcome = answering => outcome,
            () = self.desk.callers.departure(client) => Ok(Ended::Left),
        }
    }

    async fn told(
        &self,
        selected: &Selected,
        message: Bytes,
        timeout: Option<Duration>,
    ) -> std::result::Result<Ended, ServiceError> {
        let service = &self.desk.service;
        if let Some(steps) = requests::steps(service, &selected.rpc, message.clone(), timeout).await? {
            return self.step_by_step(steps, selected.steps).await;
        }
        if selected.steps.is_some() {
            return Err(ServiceError::invalid("parameters.steps", format!("{} is answered at once", selected.rpc)));
        }
        let response = requests::call(service, &selected.rpc, message, timeout).await?;
        LimitExceeded::check("max_message_bytes", response.len(), service.limits().max_message_bytes)?;
        self.send(response);
        Ok(Ended::Told)
    }

    async fn step_by_step(&self, mut steps: Steps, most: Option<u64>) -> std::result::Result<Ended, ServiceError> {
        let mut told = 0;
        loop {
            let step = steps.next().await?;
            self.send(step.message);
            told += u64::from(step.complete);
            if most.is_some_and(|most| told >= most) {
                return Ok(Ended::Told);
            }
        }
    }

    fn send(&self, message: Vec<u8>) {
        let bytes = message.len();
        self.tell(bytes, || {
            let reply = self.query.reply(self.query.key_expr(), message);
            reply.encoding(Encoding::APPLICATION_PROTOBUF).express(true).wait()
        });
    }

    fn refuse(&self, error: &ServiceError) {
        let message = to_proto::query_error(error).encode_to_vec();
        let bytes = message.len();
        self.tell(bytes, || self.query.reply_err(message).encoding(Encoding::APPLICATION_PROTOBUF).wait());
    }

    /// Sends a reply, which waits where the caller does not read what came before.
    fn tell(&self, bytes: usize, reply: impl FnOnce() -> Result<()>) {
        self.desk.sent(bytes);
        self.desk.sending.fetch_add(1, Ordering::AcqRel);
        let here = self.here.load(Ordering::Relaxed) && bytes <= SMALL_REPLY;
        told(if here { reply() } else { tokio::task::block_in_place(reply) });
        self.desk.sending.fetch_sub(1, Ordering::AcqRel);
    }
}

/// A reply that cannot be sent has nobody who waits for it any more.
fn told(sent: Result<()>) {
    if let Err(error) = sent {
        tracing::debug!("a reply through zenoh was not sent: {error}");
    }
}
