//! What is recorded of one call, as a line of text that a program in any language reads with a split and a hexadecimal decoder:
//!
//! ```text
//! asset PATH                                          a file of this repository that is uploaded
//! ask SERVICE/METHOD REQUEST ANSWER                   both as hexadecimal digits of the message's bytes
//! refuse SERVICE/METHOD REQUEST CODE REASON FIELD     gRPC's name of the code; `-` where there is no field
//! stream SERVICE/METHOD REQUEST,REQUEST... ANSWER,... all are sent, then the answers come in this order
//! ```
//!
//! An empty message is `-`. Answers are in their canonical form (docs/conventions.md): `epoch` and `nodes` are zero.

use std::fmt::{self, Write as _};

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Record {
    Asset(String),
    Ask { method: String, request: Vec<u8>, answer: Vec<u8> },
    Refuse { method: String, request: Vec<u8>, refusal: String },
    Stream { method: String, requests: Vec<Vec<u8>>, answers: Vec<Vec<u8>> },
}

impl fmt::Display for Record {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Asset(path) => write!(f, "asset {path}"),
            Self::Ask { method, request, answer } => write!(f, "ask {method} {} {}", hex(request), hex(answer)),
            Self::Refuse { method, request, refusal } => write!(f, "refuse {method} {} {refusal}", hex(request)),
            Self::Stream { method, requests, answers } => {
                write!(f, "stream {method} {} {}", list(requests), list(answers))
            }
        }
    }
}

impl Record {
    pub fn parse(line: &str) -> Self {
        let words: Vec<&str> = line.splitn(4, ' ').collect();
        match words[..] {
            ["asset", path] => Self::Asset(path.to_owned()),
            ["ask", method, request, answer] => {
                Self::Ask { method: method.to_owned(), request: bytes(request), answer: bytes(answer) }
            }
            ["refuse", method, request, refusal] => {
                Self::Refuse { method: method.to_owned(), request: bytes(request), refusal: refusal.to_owned() }
            }
            ["stream", method, requests, answers] => {
                let all = |list: &str| list.split(',').map(bytes).collect();
                Self::Stream { method: method.to_owned(), requests: all(requests), answers: all(answers) }
            }
            _ => panic!("no record: {line}"),
        }
    }
}

fn hex(bytes: &[u8]) -> String {
    if bytes.is_empty() {
        return "-".to_owned();
    }
    bytes.iter().fold(String::new(), |mut text, byte| {
        write!(text, "{byte:02x}").unwrap();
        text
    })
}

fn list(messages: &[Vec<u8>]) -> String {
    messages.iter().map(|message| hex(message)).collect::<Vec<_>>().join(",")
}

fn bytes(text: &str) -> Vec<u8> {
    let digits = text.trim_start_matches('-');
    (0..digits.len() / 2).map(|i| u8::from_str_radix(&digits[2 * i..2 * i + 2], 16).unwrap()).collect()
}
