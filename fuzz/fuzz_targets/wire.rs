//! Bytes as the messages of the wire: decoded and read or refused by name, never a panic.
#![no_main]

use std::sync::{Arc, OnceLock};

use clearance::limits::Limits;
use clearance::service::{Config, Service};
use clearance::transports::wire::{from_proto, v1};
use libfuzzer_sys::fuzz_target;
use prost::Message;

static SERVICE: OnceLock<Arc<Service>> = OnceLock::new();

fuzz_target!(|bytes: &[u8]| {
    let service = SERVICE.get_or_init(|| {
        Service::new(&Config { threads: 1, limits: Limits::default() }).expect("a thread can be started")
    });
    let Some((choice, message)) = bytes.split_first() else { return };
    match choice % 3 {
        0 => {
            if let Ok(request) = v1::ApplyRequest::decode(message) {
                _ = from_proto::change(&request, service.library(), service.robots());
            }
        }
        1 => {
            if let Ok(request) = v1::LoadRobotRequest::decode(message) {
                _ = from_proto::robot_description(request);
            }
        }
        _ => {
            if let Ok(answer) = v1::Answer::decode(message) {
                _ = from_proto::answer(&answer);
            }
        }
    }
});
