//! Bytes as selectors of queries and as keys of poses: read, or refused with a field, never a panic.
#![no_main]

use std::sync::LazyLock;

use clearance::service::ServiceError;
use clearance::transports::zenoh::{Keys, Posed, Selected, is_client_id};
use libfuzzer_sys::fuzz_target;

static KEYS: LazyLock<Keys> = LazyLock::new(|| Keys::new("clearance").expect("it is a prefix"));

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let (key, parameters) = text.split_once('?').unwrap_or((text, ""));
    // As it is, and behind what no mutation would find.
    looked_at(key, parameters);
    looked_at(&KEYS.call(key), parameters);
    posed(key);
    posed(&format!("clearance/v1/scene/{key}"));
    if let Ok(keys) = Keys::new(key) {
        assert_eq!(keys.prefix(), key);
        assert_eq!(keys.rpc_of(&keys.call(parameters)), Some(parameters));
    }
});

fn looked_at(key: &str, parameters: &str) {
    match Selected::read(&KEYS, key, parameters) {
        Ok(selected) => {
            assert_eq!(KEYS.call(&selected.rpc), key);
            assert!(selected.timeout.is_none_or(|timeout| !timeout.is_zero()) && selected.steps != Some(0));
            assert!(selected.client.is_none_or(|client| is_client_id(&client)));
        }
        Err(ServiceError::Invalid { field, problem }) => assert!(!field.is_empty() && !problem.is_empty()),
        Err(error) => panic!("{error}"),
    }
}

/// What a key names has a key that names it.
fn posed(key: &str) {
    match KEYS.posed(key) {
        None => {}
        Some((scene, Posed::Many)) => assert_eq!(KEYS.posed(&KEYS.poses(&scene)), Some((scene, Posed::Many))),
        Some((scene, Posed::One(of))) => {
            assert_eq!(KEYS.posed(&KEYS.pose(&scene, &of)), Some((scene, Posed::One(of))));
        }
    }
}
