//! Whoever comes to the metrics endpoint with bad intentions harms nobody else: not the next scrape, not the end of the daemon.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

use crate::daemon::Daemon;
use crate::scrape::{get, send};

#[test]
fn connections_that_never_ask_keep_nobody_out_and_hold_up_no_end() {
    let daemon = Daemon::start(&[]);
    let slow: Vec<TcpStream> = (0..200)
        .map(|_| {
            let mut socket = TcpStream::connect(&daemon.metrics).unwrap();
            // Some have been cut already: there are too many of them.
            _ = socket.write_all(b"GET /metr");
            socket
        })
        .collect();
    let begun = Instant::now();
    assert_eq!(get(&daemon.metrics, "/livez").status, 200);
    assert_eq!(get(&daemon.metrics, "/metrics").status, 200);
    assert!(begun.elapsed() < Duration::from_secs(2), "{:?}", begun.elapsed());
    let (code, log, took) = daemon.stop();
    assert_eq!(code, Some(0), "{log}");
    assert!(took < Duration::from_secs(3), "{took:?}");
    drop(slow);
}

#[test]
fn a_head_that_does_not_come_is_waited_for_a_few_seconds_alone() {
    let daemon = Daemon::start(&[]);
    let mut socket = TcpStream::connect(&daemon.metrics).unwrap();
    socket.set_read_timeout(Some(Duration::from_secs(30))).unwrap();
    let begun = Instant::now();
    // A byte now and then does not help.
    let mut writer = socket.try_clone().unwrap();
    let dripping = std::thread::spawn(move || {
        for byte in "GET /metrics HTTP/1.1\r\nX-Slow: ".bytes().chain(std::iter::repeat_n(b'x', 100)) {
            if writer.write_all(&[byte]).is_err() {
                break;
            }
            std::thread::sleep(Duration::from_millis(100));
        }
    });
    let mut answer = Vec::new();
    // Closed, or reset because a byte was on its way.
    _ = socket.read_to_end(&mut answer);
    assert!((2.0..9.0).contains(&begun.elapsed().as_secs_f64()), "{:?}", begun.elapsed());
    assert!(!String::from_utf8_lossy(&answer).contains("200 OK"));
    drop(socket);
    dripping.join().unwrap();
}

#[test]
fn a_reader_that_does_not_read_holds_up_no_end() {
    let daemon = Daemon::start(&[]);
    let readers: Vec<TcpStream> = (0..20)
        .map(|_| {
            let mut socket = TcpStream::connect(&daemon.metrics).unwrap();
            socket.write_all(b"GET /metrics HTTP/1.1\r\nHost: x\r\n\r\n").unwrap();
            socket
        })
        .collect();
    assert_eq!(get(&daemon.metrics, "/metrics").status, 200);
    let (code, log, took) = daemon.stop();
    assert_eq!(code, Some(0), "{log}");
    assert!(took < Duration::from_secs(3), "{took:?}");
    drop(readers);
}

#[test]
fn requests_that_are_none_are_refused_and_the_next_is_answered() {
    let daemon = Daemon::start(&[]);
    let huge = format!("GET /metrics HTTP/1.1\r\nHost: x\r\nX-Huge: {}\r\n\r\n", "x".repeat(1 << 20));
    let refused = try_send(&daemon.metrics, &huge);
    assert!(refused.is_none_or(|status| status == 431), "{refused:?}");
    let many: String = (0..10_000).map(|i| format!("X-{i}: y\r\n")).collect();
    let refused = try_send(&daemon.metrics, &format!("GET /metrics HTTP/1.1\r\nHost: x\r\n{many}\r\n"));
    assert!(refused.is_none_or(|status| status == 431), "{refused:?}");
    for (request, status) in [
        ("\x16\x03\x01\x02\x00\x01\x00\x01\r\n\r\n", 400),
        ("POST /metrics HTTP/1.1\r\nHost: x\r\nContent-Length: 5\r\n\r\nhello", 405),
        ("DELETE / HTTP/1.1\r\nHost: x\r\n\r\n", 405),
        ("GET /../../etc/passwd HTTP/1.1\r\nHost: x\r\n\r\n", 404),
        ("GET / HTTP/1.0\r\n\r\n", 404),
        ("HEAD /livez HTTP/1.1\r\nHost: x\r\n\r\n", 200),
    ] {
        assert_eq!(send(&daemon.metrics, request).status, status, "{request:?}");
    }
    assert_eq!(get(&daemon.metrics, "/metrics").status, 200);
    let (code, log, _) = daemon.stop();
    assert_eq!(code, Some(0), "{log}");
}

/// The status, where the daemon did not just hang up while it was still being written to.
fn try_send(address: &str, request: &str) -> Option<u16> {
    let mut socket = TcpStream::connect(address).unwrap();
    socket.set_read_timeout(Some(Duration::from_secs(30))).unwrap();
    _ = socket.write_all(request.as_bytes());
    let mut answer = Vec::new();
    _ = socket.read_to_end(&mut answer);
    String::from_utf8_lossy(&answer).split(' ').nth(1)?.parse().ok()
}
