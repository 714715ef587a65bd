//! Bytes as the messages of the wire: decoded and read or refused by name, never a panic.
#![no_main]

use std::sync::{Arc, OnceLock};

use clearance::limits::Limits;
use clearance::query::Worlds;
use clearance::scene::{Epoch, Scene, Snapshot};
use clearance::service::{Config, Service};
use clearance::transports::wire::{from_proto, v1};
use libfuzzer_sys::fuzz_target;
use prost::Message;

static SERVICE: OnceLock<Arc<Service>> = OnceLock::new();
static SNAPSHOT: OnceLock<Arc<Snapshot>> = OnceLock::new();
static WORLDS: OnceLock<Worlds> = OnceLock::new();

/// Decodes a message, and reads it if that can be done.
fn read<M: Message + Default, T>(bytes: &[u8], reader: impl FnOnce(&M) -> T) {
    if let Ok(message) = M::decode(bytes) {
        _ = reader(&message);
    }
}

fuzz_target!(|bytes: &[u8]| {
    let service = SERVICE.get_or_init(|| {
        Service::new(&Config { threads: 1, limits: Limits::default() }).expect("a thread can be started")
    });
    let snapshot = SNAPSHOT.get_or_init(|| Scene::new(Epoch(1)).snapshot());
    let worlds = WORLDS.get_or_init(|| Worlds::as_is(snapshot));
    let Some((choice, message)) = bytes.split_first() else { return };
    let (library, robots) = (service.library(), service.robots());
    match choice % 16 {
        0 => read(message, |request: &v1::ApplyRequest| from_proto::change(request, library, robots)),
        1 => read(message, |request: &v1::LoadRobotRequest| from_proto::robot_description(request.clone())),
        2 => read(message, |answer: &v1::Answer| from_proto::answer(answer)),
        3 => read(message, |request: &v1::CheckStatesRequest| from_proto::check_states(request, snapshot)),
        4 => read(message, |request: &v1::CollideRequest| from_proto::collide(request, worlds, library)),
        5 => read(message, |request: &v1::CheckMotionsRequest| from_proto::check_motions(request, snapshot)),
        6 => read(message, |request: &v1::CheckPathRequest| from_proto::check_path(request, snapshot)),
        7 => read(message, |request: &v1::CastRaysRequest| from_proto::cast_rays(request, snapshot)),
        8 => read(message, |request: &v1::CastShapesRequest| from_proto::cast_shapes(request, snapshot, library)),
        9 => read(message, |request: &v1::OverlapRequest| from_proto::overlap(request, snapshot, library)),
        10 => {
            read(message, |request: &v1::NearestBodiesRequest| from_proto::nearest_bodies(request, snapshot, library))
        }
        11 => read(message, |context: &v1::Context| from_proto::overlays(context, library, robots)),
        12 => read(message, |request: &v1::PoseStreamRequest| from_proto::poses(request)),
        13 => read(message, |request: &v1::EstimateRequest| from_proto::estimate(request, worlds, library)),
        14 => read(message, |response: &v1::EstimateResponse| from_proto::estimated(response)),
        _ => read(message, |request: &v1::WatchContactsRequest| {
            from_proto::contact_question(request, snapshot, &Limits::default())
        }),
    }
});
