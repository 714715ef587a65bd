//! Browsers: gRPC-Web over plain HTTP/1.1, as a page's `fetch` would send it, and the questions a browser asks first.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::Duration;

use clearance::limits::Limits;
use clearance::transports::grpc::{Scope, Secret, TokenSource};
use clearance::transports::wire::v1;
use prost::Message;

use crate::support::daemon::{RunningDaemon, config};
use crate::support::watchdog::watched;

const PAGE: &str = "http://localhost:3000";
const TOKEN: &str = "a-token-of-a-web-page";

async fn daemon(origins: &[&str]) -> RunningDaemon {
    let mut config = config(Limits::default());
    config.grpc.allowed_origins = origins.iter().map(|&origin| origin.to_owned()).collect();
    RunningDaemon::start(&config).await
}

/// The answer's head in small letters, and its body.
async fn sent(address: &str, head: String, body: Vec<u8>) -> (String, Vec<u8>) {
    let address = address.to_owned();
    let talk = tokio::task::spawn_blocking(move || {
        let mut socket = TcpStream::connect(&address).unwrap();
        socket.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
        let length = body.len();
        let head = format!("{head}host: {address}\r\nconnection: close\r\ncontent-length: {length}\r\n\r\n");
        // A connection that is not served may be reset, whatever is done with it at that moment.
        socket.write_all(&[head.as_bytes(), &body].concat()).unwrap_or_default();
        let mut answer = Vec::new();
        socket.read_to_end(&mut answer).unwrap_or_default();
        answer
    });
    let answer = watched("an answer", talk).await.unwrap();
    let end = answer.windows(4).position(|bytes| bytes == b"\r\n\r\n").map_or(answer.len(), |end| end + 4);
    (String::from_utf8_lossy(&answer[..end]).to_lowercase(), answer[end..].to_vec())
}

fn posted(path: &str, more: &str) -> String {
    format!(
        "POST {path} HTTP/1.1\r\norigin: {PAGE}\r\ncontent-type: application/grpc-web+proto\r\nx-grpc-web: 1\r\n{more}"
    )
}

/// One frame of gRPC-Web: a byte, a length, a message.
fn framed(message: &impl Message) -> Vec<u8> {
    let bytes = message.encode_to_vec();
    [&[0][..], &u32::try_from(bytes.len()).unwrap().to_be_bytes(), &bytes].concat()
}

/// The frames of an answer that came in chunks: messages, then trailers.
fn frames(body: &[u8]) -> (Vec<Vec<u8>>, String) {
    let mut whole = Vec::new();
    let mut rest = body;
    while let Some(end) = rest.windows(2).position(|bytes| bytes == b"\r\n") {
        let size = usize::from_str_radix(std::str::from_utf8(&rest[..end]).unwrap(), 16).unwrap();
        whole.extend_from_slice(&rest[end + 2..end + 2 + size]);
        rest = &rest[end + 2 + size + 2..];
    }
    let (mut messages, mut trailers, mut at) = (Vec::new(), String::new(), 0);
    while at < whole.len() {
        let size = u32::from_be_bytes(whole[at + 1..at + 5].try_into().unwrap()) as usize;
        let frame = whole[at + 5..at + 5 + size].to_vec();
        if whole[at] & 0x80 == 0 {
            messages.push(frame)
        } else {
            trailers = String::from_utf8(frame).unwrap()
        }
        at += 5 + size;
    }
    (messages, trailers)
}

fn preflight(origin: &str) -> String {
    format!(
        "OPTIONS /clearance.v1.Server/GetServerInfo HTTP/1.1\r\norigin: {origin}\r\naccess-control-request-method: POST\r\n\
         access-control-request-headers: authorization,content-type,grpc-timeout,x-grpc-web\r\n"
    )
}

#[tokio::test(flavor = "multi_thread")]
async fn a_page_of_an_allowed_origin_is_answered() {
    let daemon = daemon(&[PAGE]).await;
    let (head, _) = sent(&daemon.address, preflight(PAGE), Vec::new()).await;
    assert!(head.starts_with("http/1.1 200"), "{head}");
    assert!(head.contains(&format!("access-control-allow-origin: {PAGE}\r\n")), "{head}");
    for wanted in ["authorization", "content-type", "grpc-timeout", "x-grpc-web"] {
        let allowed = head.lines().find_map(|line| line.strip_prefix("access-control-allow-headers: ")).unwrap();
        assert!(allowed.split(',').any(|header| header == wanted), "{head}");
    }

    let head = posted("/clearance.v1.Server/GetServerInfo", "");
    let (head, body) = sent(&daemon.address, head, framed(&v1::GetServerInfoRequest {})).await;
    assert!(head.starts_with("http/1.1 200"), "{head}");
    assert!(head.contains(&format!("access-control-allow-origin: {PAGE}\r\n")), "{head}");
    assert!(head.contains("access-control-expose-headers: ") && head.contains("clearance-reason"), "{head}");
    let (messages, trailers) = frames(&body);
    let info = v1::GetServerInfoResponse::decode(messages[0].as_slice()).unwrap();
    assert_eq!((messages.len(), info.version.as_str()), (1, env!("CARGO_PKG_VERSION")));
    assert!(trailers.contains("grpc-status:0"), "{trailers}");

    // A refusal reaches the page, too.
    let request = v1::DeleteSceneRequest { scene: "nowhere".to_owned() };
    let (head, body) = sent(&daemon.address, posted("/clearance.v1.Scenes/DeleteScene", ""), framed(&request)).await;
    let told = format!("{head}{}", frames(&body).1);
    assert!(told.contains("clearance-reason: not_found") || told.contains("clearance-reason:NOT_FOUND"), "{told}");
}

#[tokio::test(flavor = "multi_thread")]
async fn a_page_of_another_origin_is_told_that_it_may_not() {
    let daemon = daemon(&[PAGE]).await;
    for origin in ["http://evil.example", "http://localhost:3001", "null"] {
        let (head, _) = sent(&daemon.address, preflight(origin), Vec::new()).await;
        assert!(!head.contains("access-control-allow-origin"), "{head}");
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn without_origins_the_door_does_not_speak_to_browsers() {
    let daemon = daemon(&[]).await;
    for head in [preflight(PAGE), posted("/clearance.v1.Server/GetServerInfo", "")] {
        let (head, _) = sent(&daemon.address, head, framed(&v1::GetServerInfoRequest {})).await;
        assert!(!head.starts_with("http/1.1 200"), "{head}");
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_browsers_first_question_needs_no_token_and_its_call_does() {
    let mut config = config(Limits::default());
    config.grpc.allowed_origins = vec![PAGE.to_owned()];
    config.grpc.tokens = vec![TokenSource {
        name: "page".to_owned(),
        secret: Secret::Sha256(clearance::service::ContentHash::of(TOKEN.as_bytes()).to_string()),
        scopes: vec![Scope::Read],
    }];
    let daemon = RunningDaemon::start(&config).await;
    let (head, _) = sent(&daemon.address, preflight(PAGE), Vec::new()).await;
    assert!(head.starts_with("http/1.1 200") && head.contains("access-control-allow-origin"), "{head}");
    let path = "/clearance.v1.Server/GetServerInfo";
    let message = framed(&v1::GetServerInfoRequest {});
    let (head, body) = sent(&daemon.address, posted(path, ""), message.clone()).await;
    let told = format!("{head}{}", frames(&body).1);
    assert!(told.contains("grpc-status: 16") || told.contains("grpc-status:16"), "{told}");
    let (head, body) =
        sent(&daemon.address, posted(path, &format!("authorization: Bearer {TOKEN}\r\n")), message).await;
    assert!(frames(&body).1.contains("grpc-status:0"), "{head}");
}
