//! Are the recorded answers those of the library? `CLEARANCE_REGENERATE=1 cargo test --test clients` records anew.

use std::path::Path;

use clearance::transports::wire::v1;
use prost::Message;

use crate::library::Library;
use crate::questions::{Call, calls, robot};
use crate::record::Record;
use crate::watchdog::watched;

/// Of the repository.
const RECORDS: &str = "tests/data/conformance/records.txt";
const STREAM: &str = "Queries/QueryStream";

pub fn file(path: &str) -> Vec<u8> {
    std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap()
}

/// What is in the file, without its remarks.
pub fn kept() -> Vec<Record> {
    let text = String::from_utf8(file(RECORDS)).unwrap();
    text.lines().filter(|line| !line.starts_with('#')).map(Record::parse).collect()
}

async fn recorded() -> Vec<Record> {
    let library = Library::new();
    let mut records = Vec::new();
    for call in robot() {
        records.push(answered(&library, call).await);
    }
    let Some(Record::Ask { answer, .. }) = records.last() else { panic!("the robot was refused") };
    let model = v1::LoadRobotResponse::decode(&answer[..]).unwrap().robot.unwrap().id;
    for call in calls(&model) {
        records.push(answered(&library, call).await);
    }
    records
}

async fn answered(library: &Library, call: Call) -> Record {
    match call {
        Call::Asset(path) => {
            library.upload(&file(&path)).await;
            Record::Asset(path)
        }
        Call::Ask(method, request) => match library.ask(method, &request).await {
            Ok(answer) => Record::Ask { method: method.to_owned(), request, answer },
            Err(refusal) => Record::Refuse { method: method.to_owned(), request, refusal },
        },
        Call::Stream(requests) => {
            let answers = library.query_stream(&requests).await;
            Record::Stream { method: STREAM.to_owned(), requests, answers }
        }
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn the_recorded_answers_are_those_of_the_library() {
    let records = watched("recording", recorded()).await;
    if std::env::var_os("CLEARANCE_REGENERATE").is_some() {
        let head = "# Made by `CLEARANCE_REGENERATE=1 cargo test --test clients`; tests/clients/record.rs says what a line means.\n";
        let lines: String = records.iter().map(|record| format!("{record}\n")).collect();
        std::fs::write(Path::new(env!("CARGO_MANIFEST_DIR")).join(RECORDS), format!("{head}{lines}")).unwrap();
    }
    let kept = kept();
    assert_eq!(records.len(), kept.len(), "record anew: CLEARANCE_REGENERATE=1");
    for (now, then) in records.iter().zip(&kept) {
        assert!(now == then, "record anew (CLEARANCE_REGENERATE=1) if this was meant to change:\n{now}\n{then}");
    }
}

/// A record that nothing could go wrong with shows nothing.
#[test]
fn every_kind_of_record_is_there() {
    let kept = kept();
    let of = |wanted: fn(&Record) -> bool| kept.iter().filter(|record| wanted(record)).count();
    assert_eq!(of(|record| matches!(record, Record::Asset(_))), 17);
    assert!(of(|record| matches!(record, Record::Ask { .. })) >= 25);
    assert!(of(|record| matches!(record, Record::Refuse { .. })) >= 8);
    assert_eq!(of(|record| matches!(record, Record::Stream { .. })), 1);
}
