//! May this call in? Looks at the token, then at what its client has under way, before any handler sees the call; counts
//! what goes through until the call is over.

use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};

use http::{HeaderMap, Request, Response, header};
use tonic::Status;
use tonic::body::Body;
use tower::{Layer, Service};

use super::access::{Need, need};
use super::clients::Client;
use super::connection::Peer;
use super::door::DOOR;
use super::gate_body::{Answered, Asked};
use super::outcome::outcome_of;
use super::refusal::{Refusal, name_message_limit};
use super::tokens::Tokens;
use crate::service::{Asker, Call as ObservedCall, Rpc, Seldom, Service as Daemon, Traffic};
use crate::transports::requests::rpc_named;

/// Puts a gate in front of all services.
#[derive(Clone, Debug)]
pub(super) struct GateLayer {
    keeper: Arc<Keeper>,
}

/// A service behind the gate.
#[derive(Clone, Debug)]
pub(super) struct Gate<S> {
    inner: S,
    keeper: Arc<Keeper>,
}

/// What all calls share.
#[derive(Debug)]
struct Keeper {
    tokens: Tokens,
    strangers: Seldom,
    service: Arc<Daemon>,
    traffic: Arc<Traffic>,
}

/// Who asks; handlers find it among the extensions of a request.
#[derive(Clone, Debug)]
pub(super) struct Caller(pub Arc<Client>);

impl GateLayer {
    pub fn new(tokens: Tokens, service: Arc<Daemon>) -> Self {
        let traffic = service.traffic(DOOR);
        Self { keeper: Arc::new(Keeper { tokens, strangers: Seldom::new(), service, traffic }) }
    }
}

impl<S> Layer<S> for GateLayer {
    type Service = Gate<S>;

    fn layer(&self, inner: S) -> Gate<S> {
        Gate { inner, keeper: Arc::clone(&self.keeper) }
    }
}

impl Keeper {
    /// Who asks, if they may.
    fn client(&self, path: &str, headers: &HeaderMap, peer: &Peer) -> Result<Arc<Client>, Refusal> {
        if self.tokens.is_empty() {
            return Ok(Arc::clone(&peer.client));
        }
        let found = match bearer(headers) {
            Some(shown) => self.tokens.find(shown).ok_or(Refusal::UnknownToken),
            None => Err(Refusal::NoToken),
        };
        match (need(path), found) {
            (Need::Nothing, Err(_)) => Ok(Arc::clone(&peer.client)),
            (Need::Scope(_), Err(refusal)) => Err(refusal),
            (Need::Scope(scope), Ok(token)) if !token.allows(scope) => Err(Refusal::MissingScope(scope)),
            (Need::Nothing | Need::Scope(_), Ok(token)) => Ok(Arc::clone(&token.client)),
        }
    }

    /// The call as those see it who observe the daemon. Health and reflection are not for them.
    fn observed(&self, rpc: Option<Rpc>, headers: &HeaderMap, client: &Client) -> ObservedCall {
        let Some(rpc) = rpc else { return ObservedCall::unobserved() };
        let traceparent = || headers.get("traceparent")?.to_str().ok().map(Into::into);
        let asker = || Asker { door: DOOR, client: Arc::clone(client.name()), traceparent: traceparent() };
        self.service.begin_call(rpc, asker)
    }

    /// Whom the door knows is told for every call; who knocks without a token could fill the log.
    fn log(&self, path: &str, peer: &Peer, refusal: Refusal) {
        let client = &**peer.client.name();
        match refusal {
            Refusal::NoToken | Refusal::UnknownToken => {
                if let Some(times) = self.strangers.due() {
                    tracing::warn!(client, rpc = path, ?refusal, times, "not let in");
                }
            }
            Refusal::MissingScope(_) | Refusal::OverQuota(_) => {
                tracing::debug!(client, rpc = path, ?refusal, "not let in");
            }
        }
    }
}

/// The token of `authorization: Bearer TOKEN`.
fn bearer(headers: &HeaderMap) -> Option<&[u8]> {
    let value = headers.get(header::AUTHORIZATION)?.as_bytes();
    let (scheme, token) = value.split_at_checked("Bearer ".len())?;
    scheme.eq_ignore_ascii_case(b"Bearer ").then(|| token.trim_ascii())
}

type Outcome<E> = Pin<Box<dyn Future<Output = Result<Response<Body>, E>> + Send>>;

impl<S> Service<Request<Body>> for Gate<S>
where
    S: Service<Request<Body>, Response = Response<Body>>,
    S::Future: Send + 'static,
    S::Error: Send + 'static,
{
    type Response = Response<Body>;
    type Error = S::Error;
    type Future = Outcome<S::Error>;

    fn poll_ready(&mut self, context: &mut Context<'_>) -> Poll<Result<(), S::Error>> {
        self.inner.poll_ready(context)
    }

    fn call(&mut self, mut request: Request<Body>) -> Self::Future {
        let Some(peer) = request.extensions().get::<Peer>().cloned() else {
            return refused(Status::internal("the connection is not known"));
        };
        let on_connection = peer.progress.enter();
        let path = request.uri().path();
        let rpc = rpc_named(path);
        let client = self.keeper.client(path, request.headers(), &peer);
        let seen_as = client.as_ref().unwrap_or(&peer.client);
        let observed = self.keeper.observed(rpc, request.headers(), seen_as);
        let call = client.and_then(|client| client.enter().map_err(Refusal::OverQuota));
        let call = match call {
            Ok(call) => call,
            Err(refusal) => {
                self.keeper.log(path, &peer, refusal);
                let mut response = Status::from(refusal).into_http();
                numbered(response.headers_mut(), &observed);
                observed.end(outcome_of(response.headers()));
                return Box::pin(std::future::ready(Ok(response)));
            }
        };
        let client = Arc::clone(call.client());
        request.extensions_mut().insert(Caller(Arc::clone(&client)));
        let traffic = Arc::clone(&self.keeper.traffic);
        let request = request.map(|body| Body::new(Asked::new(body, client, Arc::clone(&traffic))));
        let answering = observed.work(self.inner.call(request));
        Box::pin(async move {
            let mut response = answering.await?;
            name_message_limit(response.headers_mut());
            let has_ended = response.headers().contains_key(Status::GRPC_STATUS);
            let until_read = if rpc.is_some_and(|rpc| rpc.streams) && !has_ended {
                observed
            } else {
                numbered(response.headers_mut(), &observed);
                observed.end(outcome_of(response.headers()));
                ObservedCall::unobserved()
            };
            let answered = |body| Body::new(Answered::new(body, (call, on_connection), until_read, traffic));
            Ok(response.map(answered))
        })
    }
}

/// A caller that was not answered is told the number of its call, which an operator finds in the log.
fn numbered(headers: &mut HeaderMap, call: &ObservedCall) {
    if let Some(number) = call.number()
        && headers.get(Status::GRPC_STATUS).is_some_and(|status| status != "0")
    {
        headers.insert("clearance-call", number.into());
    }
}

fn refused<E: Send + 'static>(status: Status) -> Outcome<E> {
    Box::pin(std::future::ready(Ok(status.into_http())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_token_is_what_stands_behind_bearer() {
        let shown = |value: &str| {
            let mut headers = HeaderMap::new();
            headers.insert(header::AUTHORIZATION, value.parse().unwrap());
            bearer(&headers).map(|token| String::from_utf8(token.to_vec()).unwrap())
        };
        assert_eq!(shown("Bearer secret").as_deref(), Some("secret"));
        assert_eq!(shown("bearer  secret ").as_deref(), Some("secret"));
        assert_eq!(shown("Basic secret"), None);
        assert_eq!(shown("Bearer"), None);
        assert_eq!(bearer(&HeaderMap::new()), None);
    }
}
