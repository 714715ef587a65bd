//! Bytes as requests through shared memory: read as a question or refused with a field, never a panic.
#![no_main]

use clearance::limits::Limits;
use clearance::service::ServiceError;
use clearance::transports::shared_memory::layout::{ABI_HASH, MAGIC, RequestHeader, VERSION};
use clearance::transports::shared_memory::{Received, decode};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    // As they are, and with the words right that no mutation would find, so that what is behind them is reached.
    looked_at(bytes);
    let mut message = bytes.to_vec();
    let mut header = RequestHeader::read(&message);
    (header.magic, header.version, header.abi_hash) = (MAGIC, VERSION, ABI_HASH);
    header.total_bytes = header.total_bytes.min(message.len() as u64);
    header.flags &= 1023;
    header.write(&mut message);
    looked_at(&message);
});

fn looked_at(message: &[u8]) {
    match decode(message, &Limits::default()) {
        Ok(Received::Asked(request)) => {
            assert!(request.items <= Limits::default().max_items && !request.target.scene.contains('\u{fffd}'))
        }
        Ok(Received::Called(called)) => assert!(called.rpc.len() <= 64),
        Err(ServiceError::Invalid { field, problem }) => assert!(!field.is_empty() && !problem.is_empty()),
        Err(error) => assert!(matches!(error, ServiceError::Limit(_)), "{error}"),
    }
}
