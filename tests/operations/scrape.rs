//! Asks the metrics endpoint as Prometheus does, and reads what it tells.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{Read, Write};
use std::net::TcpStream;

use crate::daemon::{Daemon, PATIENCE};

/// What came back.
pub struct Response {
    pub status: u16,
    pub head: String,
    pub body: String,
}

/// Sends `request` as it is, and reads until the connection closes.
pub fn send(address: &str, request: &str) -> Response {
    let mut socket = TcpStream::connect(address).unwrap();
    socket.set_read_timeout(Some(PATIENCE)).unwrap();
    socket.write_all(request.as_bytes()).unwrap();
    let mut text = String::new();
    socket.read_to_string(&mut text).unwrap();
    let (head, body) = text.split_once("\r\n\r\n").unwrap_or_else(|| panic!("no response: {text:?}"));
    let status = head.split(' ').nth(1).and_then(|status| status.parse().ok()).unwrap();
    Response { status, head: head.to_lowercase(), body: body.to_owned() }
}

pub fn get(address: &str, path: &str) -> Response {
    send(address, &format!("GET {path} HTTP/1.1\r\nHost: localhost\r\n\r\n"))
}

/// What one scrape tells.
#[derive(Debug, Default)]
pub struct Scrape {
    /// Values by name and labels, as they are written.
    pub samples: BTreeMap<String, f64>,
    /// Families, and what kind each is.
    pub types: BTreeMap<String, String>,
    pub helped: BTreeSet<String>,
}

impl Scrape {
    pub fn of(daemon: &Daemon) -> Self {
        let response = get(&daemon.metrics, "/metrics");
        assert_eq!(response.status, 200);
        assert!(response.head.contains("content-type: text/plain; version=0.0.4"), "{}", response.head);
        Self::read(&response.body)
    }

    pub fn read(text: &str) -> Self {
        let mut scrape = Self::default();
        for line in text.lines() {
            if let Some(comment) = line.strip_prefix("# ") {
                match comment.splitn(3, ' ').collect::<Vec<_>>()[..] {
                    ["TYPE", name, kind] => drop(scrape.types.insert(name.to_owned(), kind.to_owned())),
                    ["HELP", name, _] => drop(scrape.helped.insert(name.to_owned())),
                    _ => assert_eq!(comment, "EOF"),
                }
            } else {
                let (name, value) = line.rsplit_once(' ').unwrap();
                let before = scrape.samples.insert(name.to_owned(), value.parse().unwrap());
                assert_eq!(before, None, "{name} is told twice");
            }
        }
        scrape
    }

    /// The value of a sample that is there.
    pub fn value(&self, sample: &str) -> f64 {
        self.find(sample).unwrap_or_else(|| panic!("{sample} is not told among {:#?}", self.samples.keys()))
    }

    pub fn find(&self, sample: &str) -> Option<f64> {
        self.samples.get(sample).copied()
    }

    /// Names of samples, without labels.
    pub fn names(&self) -> BTreeSet<String> {
        self.samples.keys().map(|sample| sample.split('{').next().unwrap().to_owned()).collect()
    }
}
