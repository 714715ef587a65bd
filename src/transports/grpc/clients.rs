//! Whose call is it, and how much may that client have? A client is the name of a token, else the subject of a TLS
//! certificate, else the address a connection comes from; all its connections share what it may have.

use std::collections::BTreeMap;
use std::net::IpAddr;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::bucket::{Bucket, Overdrawn};
use crate::limits::{LimitExceeded, Limits};

/// Clients remembered before those are forgotten that have nothing under way and owe nothing.
const REMEMBERED: usize = 4_096;

/// Everybody who asks.
#[derive(Debug)]
pub(super) struct Clients {
    limits: Limits,
    known: Mutex<BTreeMap<String, Arc<Client>>>,
}

/// One who asks.
#[derive(Debug)]
pub(super) struct Client {
    name: Arc<str>,
    calls: AtomicUsize,
    max_calls: usize,
    items: Option<Mutex<Bucket>>,
    bytes: Option<Mutex<Bucket>>,
}

/// Why a client has to wait.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct OverQuota {
    /// Which limit, how much was asked, how much is allowed.
    pub exceeded: LimitExceeded,
    /// When to ask again, where that is known.
    pub wait: Option<Duration>,
}

impl Clients {
    pub fn new(limits: &Limits) -> Self {
        Self { limits: limits.clone(), known: Mutex::default() }
    }

    /// The client of that name, known or new.
    pub fn named(&self, name: &str) -> Arc<Client> {
        let mut known = locked(&self.known);
        if let Some(client) = known.get(name) {
            return Arc::clone(client);
        }
        if known.len() >= REMEMBERED {
            let now = Instant::now();
            known.retain(|_, client| Arc::strong_count(client) > 1 || client.owes(now));
        }
        let client = Arc::new(Client::new(name, &self.limits));
        known.insert(name.to_owned(), Arc::clone(&client));
        client
    }

    /// The client behind an address. A network of IPv6 addresses that one customer gets is one client.
    pub fn at(&self, address: IpAddr) -> Arc<Client> {
        match address.to_canonical() {
            IpAddr::V4(address) => self.named(&format!("peer:{address}")),
            IpAddr::V6(address) => {
                let [a, b, c, d, ..] = address.segments();
                self.named(&format!("peer:{a:x}:{b:x}:{c:x}:{d:x}::/64"))
            }
        }
    }
}

impl Client {
    fn new(name: &str, limits: &Limits) -> Self {
        let now = Instant::now();
        let bucket = |limit, rate| Bucket::new(limit, rate, now).map(Mutex::new);
        Self {
            name: name.into(),
            calls: AtomicUsize::new(0),
            max_calls: limits.max_client_calls,
            items: bucket("max_client_items_per_second", limits.max_client_items_per_second),
            bytes: bucket("max_client_bytes_per_second", limits.max_client_bytes_per_second),
        }
    }

    /// As it stands in log lines.
    pub fn name(&self) -> &Arc<str> {
        &self.name
    }

    /// Begins a call; it lasts until what is returned is dropped.
    ///
    /// # Errors
    /// The client has too much under way, or took too much.
    pub fn enter(self: &Arc<Self>) -> Result<Call, OverQuota> {
        for bucket in [&self.items, &self.bytes].into_iter().flatten() {
            let overdrawn = |Overdrawn { exceeded, wait }| OverQuota { exceeded, wait: Some(wait) };
            locked(bucket).check(Instant::now()).map_err(overdrawn)?;
        }
        let before = self.calls.fetch_add(1, Ordering::AcqRel);
        let call = Call { client: Arc::clone(self) };
        LimitExceeded::check("max_client_calls", before + 1, self.max_calls)
            .map_err(|exceeded| OverQuota { exceeded, wait: None })?;
        Ok(call)
    }

    /// Takes answered items off what the client may have.
    pub fn take_items(&self, items: usize) {
        if let Some(bucket) = &self.items {
            locked(bucket).take(items, Instant::now());
        }
    }

    /// Takes bytes that came or went off what the client may have.
    pub fn take_bytes(&self, bytes: usize) {
        if let Some(bucket) = &self.bytes {
            locked(bucket).take(bytes, Instant::now());
        }
    }

    /// How long the next message of a stream of answers has to wait.
    pub fn items_wait(&self) -> Option<Duration> {
        wait(self.items.as_ref()?)
    }

    /// How long the next bytes of a body that is being read have to wait.
    pub fn bytes_wait(&self) -> Option<Duration> {
        wait(self.bytes.as_ref()?)
    }

    fn owes(&self, now: Instant) -> bool {
        [&self.items, &self.bytes].into_iter().flatten().any(|bucket| !locked(bucket).is_full(now))
    }
}

/// A call under way.
#[derive(Debug)]
pub(super) struct Call {
    client: Arc<Client>,
}

impl Call {
    pub fn client(&self) -> &Arc<Client> {
        &self.client
    }
}

impl Drop for Call {
    fn drop(&mut self) {
        self.client.calls.fetch_sub(1, Ordering::AcqRel);
    }
}

fn wait(bucket: &Mutex<Bucket>) -> Option<Duration> {
    locked(bucket).check(Instant::now()).err().map(|overdrawn| overdrawn.wait)
}

/// Nothing behind these locks can be left half changed.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn connections_of_one_client_share_its_calls_and_a_refused_one_takes_no_place() {
        let clients = Clients::new(&Limits { max_client_calls: 2, ..Limits::default() });
        let (here, there) = (clients.named("planner"), clients.named("planner"));
        let first = here.enter().unwrap();
        let second = there.enter().unwrap();
        for _ in 0..3 {
            let refused = here.enter().unwrap_err();
            assert_eq!(refused.exceeded, LimitExceeded { limit: "max_client_calls", asked: 3, allowed: 2 });
            assert_eq!(refused.wait, None);
        }
        assert!(clients.named("another").enter().is_ok());
        drop((first, second));
        assert!(there.enter().is_ok());
    }

    #[test]
    fn a_client_that_comes_back_still_owes_what_it_took() {
        let limits = Limits { max_client_items_per_second: 10, ..Limits::default() };
        let clients = Clients::new(&limits);
        clients.named("planner").take_items(1_000_000);
        for i in 0..2 * REMEMBERED {
            clients.named(&format!("peer:{i}"));
        }
        assert!(locked(&clients.known).len() <= REMEMBERED + 1);
        let refused = clients.named("planner").enter().unwrap_err();
        assert_eq!(refused.exceeded.limit, "max_client_items_per_second");
        assert!(refused.wait.is_some_and(|wait| wait > Duration::from_secs(1_000)));
    }

    #[test]
    fn one_network_of_the_sixth_version_is_one_client() {
        let clients = Clients::new(&Limits::default());
        let at = |text: &str| clients.at(text.parse().unwrap()).name().to_string();
        assert_eq!(at("2001:db8:1:2::5"), at("2001:db8:1:2:ffff::"));
        assert_ne!(at("2001:db8:1:2::5"), at("2001:db8:1:3::5"));
        assert_eq!(at("::ffff:10.0.0.1"), "peer:10.0.0.1");
    }
}
