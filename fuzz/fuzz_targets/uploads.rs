//! Bytes as uploads in chunks, and as the files that were uploaded: kept or refused, read or refused, never a panic.
#![no_main]

use std::sync::{Arc, OnceLock};

use clearance::geometry::mesh_file::{MeshFormat, read};
use clearance::limits::Limits;
use clearance::service::{Config, ContentHash, Service, ServiceError};
use clearance::transports::requests;
use clearance::transports::wire::v1;
use libfuzzer_sys::fuzz_target;
use prost::Message;
use prost::bytes::Bytes;
use tokio::runtime::{Builder, Runtime};

static DAEMON: OnceLock<(Runtime, Arc<Service>)> = OnceLock::new();

fuzz_target!(|bytes: &[u8]| {
    let (runtime, service) = DAEMON.get_or_init(|| {
        let runtime = Builder::new_current_thread().build().expect("a runtime can be started");
        // Little room: uploads meet every cap.
        let limits = Limits { max_asset_bytes: 2_048, max_total_asset_bytes: 1 << 16, ..Limits::default() };
        (runtime, Service::new(&Config { threads: 1, limits }).expect("a thread can be started"))
    });
    let put = |message: Vec<u8>| runtime.block_on(requests::call(service, "Assets/PutAsset", message.into(), None));
    // As the messages of an upload, and as the chunks of one that is announced as it is.
    if let Err(error) = put(bytes.to_vec()) {
        refused(&error);
    }
    let Some((size, file)) = bytes.split_first() else { return };
    let header = v1::AssetHeader { sha256: ContentHash::of(file).to_string(), bytes: file.len() as u64 };
    let parts = std::iter::once(v1::put_asset_request::Part::Header(header)).chain(
        file.chunks(usize::from(*size).max(1))
            .map(|chunk| v1::put_asset_request::Part::Chunk(Bytes::copy_from_slice(chunk))),
    );
    let message = parts.flat_map(|part| v1::PutAssetRequest { part: Some(part) }.encode_length_delimited_to_vec());
    match put(message.collect()) {
        Ok(stored) => {
            let stored = v1::PutAssetResponse::decode(stored.as_slice()).expect("it is a response");
            assert_eq!(stored.bytes, file.len() as u64);
        }
        Err(error) => assert!(matches!(error, ServiceError::Limit(_)), "{error}"),
    }
    for format in [MeshFormat::Obj, MeshFormat::Stl, MeshFormat::Collada, MeshFormat::Gltf] {
        _ = read(file, format);
    }
});

fn refused(error: &ServiceError) {
    match error {
        ServiceError::Invalid { field, problem } => assert!(!field.is_empty() && !problem.is_empty()),
        ServiceError::Limit(_) | ServiceError::HashMismatch { .. } => {}
        other => panic!("{other}"),
    }
}
