//! Segments that lie: every section, count, offset and number that cannot be is refused with its field, and the daemon
//! goes on.

use clearance::query::{Context, Wants};
use clearance::transports::shared_memory::layout::{ENTRY_BYTES, RequestHeader, SectionEntry, kind};
use clearance::transports::shared_memory::{
    Ask, Client, ClientError, Envelope, Options, PlainShape, PlainSubject, Refusal, Reply, request_message,
};

use super::place::*;
use crate::support::messages::SCENE;

type HeaderChange = fn(&mut RequestHeader);
type EntryChange = fn(&mut SectionEntry);

const NONCE: [u8; 16] = [9; 16];

fn written(client: &Client, ask: Ask<'_>) -> Vec<u8> {
    let target = target();
    let (timeout, client) = (Some(Options::default().timeout), client.id());
    let envelope = Envelope { target: &target, timeout, time_budget: None, wants_sides: false, nonce: NONCE, client };
    request_message(&envelope, ask)
}

fn send(client: &mut Client, message: &[u8]) -> Result<Reply, ClientError> {
    tokio::task::block_in_place(|| client.exchange(message, NONCE, &Options::default()))
}

fn change_header(message: &[u8], change: impl FnOnce(&mut RequestHeader)) -> Vec<u8> {
    let mut message = message.to_vec();
    let mut header = RequestHeader::read(&message);
    change(&mut header);
    header.write(&mut message);
    message
}

/// The entry of a kind, changed.
fn change_entry(message: &[u8], kind: u32, change: impl FnOnce(&mut SectionEntry)) -> Vec<u8> {
    let mut message = message.to_vec();
    let sections = RequestHeader::read(&message).sections as usize;
    let places = (0..sections).map(|index| RequestHeader::BYTES + index * ENTRY_BYTES);
    let place = places.into_iter().find(|place| SectionEntry::read(&message[*place..]).kind == kind).unwrap();
    let mut entry = SectionEntry::read(&message[place..]);
    change(&mut entry);
    entry.write(&mut message[place..]);
    message
}

#[tokio::test(flavor = "multi_thread")]
async fn what_cannot_be_is_refused_with_its_field() {
    let place = Place::with_crane(small()).await;
    let mut client = place.client();
    let states = crane_states(
        vec![0.0, -0.2, 0.1, -0.3],
        Context { wants: Wants { patch: false, derivatives: false, ..Wants::ALL }, ..Context::default() },
    );
    let good = written(&client, Ask::States(&states, 2));
    assert_eq!(send(&mut client, &good).unwrap().items(), 2, "the message that the others are made from");

    let header: [(&str, HeaderChange); 24] = [
        ("header.magic", |h| h.magic[3] = 0),
        ("header.version", |h| h.version = 2),
        ("header.abi_hash", |h| h.abi_hash ^= 1),
        ("header.flags", |h| h.flags |= 1 << 20),
        ("header.total_bytes", |h| h.total_bytes = u64::MAX),
        ("header.total_bytes", |h| h.total_bytes += 1),
        ("sections", |h| h.sections = u32::MAX),
        ("sections", |h| h.total_bytes = 256),
        ("header.question", |h| h.question = 0),
        ("header.question", |h| h.question = 77),
        ("context.revision", |h| h.revision_rule = 3),
        ("mode", |h| h.mode = 2),
        ("context.wants", |h| h.wants = 1 << 9),
        ("context.wants", |h| h.wants = 32), // Contact patches: batches have no columns for them.
        ("context.wants", |h| h.wants = 64), // Derivatives: nor for them.
        ("context.solver", |h| h.solver = 99),
        ("positions", |h| h.items = 1),
        ("positions", |h| h.items = 3),
        ("positions", |h| h.items = 0),
        ("subject_kinds", |h| h.question = 4),
        ("lengths", |h| h.question = 6),
        ("context.margin", |h| h.margin = -1.0),
        ("context.margin", |h| h.margin = f64::NAN),
        ("context.accuracy.relative", |h| h.accuracy_relative = f64::INFINITY),
    ];
    for (field, change) in header {
        let refusal = refusal(send(&mut client, &change_header(&good, change)));
        assert_eq!((refusal.reason.as_str(), refusal.field.as_str()), ("INVALID_FIELD", field), "{refusal:?}");
        assert_eq!(refusal.code, 3);
    }
    let refused = refusal(send(&mut client, &change_header(&good, |h| h.items = u32::MAX)));
    assert_eq!((refused.reason.as_str(), refused.code), ("LIMIT_EXCEEDED", 8), "{refused:?}");

    let entries: [(u32, &str, EntryChange); 12] = [
        (kind::POSITIONS, "offset", |e| e.offset += 8),
        (kind::POSITIONS, "offset", |e| e.offset = u64::MAX - 63),
        (kind::POSITIONS, "offset", |e| e.offset = 0),
        (kind::POSITIONS, "bytes", |e| e.bytes = u64::MAX),
        (kind::POSITIONS, "bytes", |e| e.bytes = 1 << 33),
        (kind::POSITIONS, "bytes", |e| e.bytes += 8),
        (kind::POSITIONS, "stride", |e| e.stride = 0),
        (kind::POSITIONS, "stride", |e| e.stride = 3),
        (kind::POSITIONS, "kind", |e| e.kind = 12345),
        (kind::SCENE, "kind", |e| (e.kind, e.stride) = (kind::ROBOT, 1)),
        (kind::SCENE, "stride", |e| e.stride = 2),
        (kind::SCENE, "reserved", |e| e.reserved = 1),
    ];
    for (kind, field, change) in entries {
        let refusal = refusal(send(&mut client, &change_entry(&good, kind, change)));
        assert!(refusal.field.starts_with("sections[") && refusal.field.ends_with(field), "{field}: {refusal:?}");
    }
    // The same numbers in rows of another width would make other states.
    let wide = change_header(&change_entry(&good, kind::POSITIONS, |e| e.stride = 32), |h| h.items = 1);
    let refused = refusal(send(&mut client, &wide));
    assert!(refused.field == "positions" && refused.message.contains("2 joints"), "{refused:?}");
    let cut = refusal(send(&mut client, &good[..100]));
    assert_eq!(cut.field, "message");
    let mut no_text = good.clone();
    let place_of_name = no_text.windows(SCENE.len()).position(|window| window == SCENE.as_bytes()).unwrap();
    no_text[place_of_name] = 0xff;
    assert_eq!(refusal(send(&mut client, &no_text)).field, "scene");
    assert_eq!(send(&mut client, &good).unwrap().items(), 2, "the daemon goes on");
}

#[tokio::test(flavor = "multi_thread")]
async fn bad_subjects_are_refused_with_item_and_field() {
    let place = Place::with_crane(small()).await;
    let mut client = place.client();
    let context = Context::default();
    let pose = clearance::geometry::Pose::identity();
    let refused = |client: &mut Client, subjects: &[PlainSubject]| -> Refusal {
        refusal(ask(client, Ask::Collide(subjects, &context), &Options::default()))
    };
    let fine = PlainSubject::Shape(PlainShape::sphere(0.1), pose);
    let bad = [
        ("shape_parameters[1]", PlainSubject::Shape(PlainShape::sphere(-1.0), pose)),
        ("shape_parameters[1]", PlainSubject::Shape(PlainShape::cuboid([0.1, f64::NAN, 0.1]), pose)),
        ("shape_parameters[1]", PlainSubject::Shape(PlainShape::sphere(0.1).swept(f64::INFINITY), pose)),
        ("subject_ids[1]", PlainSubject::ShapeOfBody(999, pose)),
    ];
    for (field, subject) in bad {
        let refusal = refused(&mut client, &[fine, subject]);
        assert_eq!((refusal.reason.as_str(), refusal.field.as_str()), ("INVALID_FIELD", field), "{refusal:?}");
    }
    let good = written(&client, Ask::Collide(&[fine, fine], &context));
    let place_of = |kind: u32| {
        let mut place = 0;
        change_entry(&good, kind, |entry| place = entry.offset as usize);
        place
    };
    let changed = |kind: u32, byte: usize, value: u8| {
        let mut message = good.clone();
        message[place_of(kind) + byte] = value;
        message
    };
    for (field, message) in [
        ("subject_kinds[1]", changed(kind::SUBJECT_KINDS, 1, 9)),
        ("subject_kinds[0]", changed(kind::SUBJECT_KINDS, 0, 0)),
        ("shape_kinds[1]", changed(kind::SHAPE_KINDS, 1, 200)),
        // The last bytes of a double: 0x7ff.. is no number.
        ("poses[1]", {
            let mut message = changed(kind::POSES, 56 + 7, 0x7f);
            message[place_of(kind::POSES) + 56 + 6] = 0xf8;
            message
        }),
    ] {
        let refusal = refusal(send(&mut client, &message));
        assert_eq!(refusal.field, field, "{refusal:?}");
    }
    let zero_quaternion = {
        let mut message = good.clone();
        let begin = place_of(kind::POSES) + 24;
        message[begin..begin + 32].fill(0);
        message
    };
    let refused = refusal(send(&mut client, &zero_quaternion));
    assert!(refused.field == "poses[0]" && refused.message.contains("zero quaternion"), "{refused:?}");
}

/// Bytes flipped at random, by a fixed generator: each message is answered or refused, and none stops the daemon.
#[tokio::test(flavor = "multi_thread")]
async fn random_damage_is_answered_or_refused() {
    let place = Place::with_crane(small()).await;
    let mut client = place.client();
    let context = Context { wants: Wants { patch: false, derivatives: false, ..Wants::ALL }, ..Context::default() };
    let states = crane_states(vec![0.0, -0.2, 0.1, -0.3], context.clone());
    let subject = PlainSubject::Shape(PlainShape::sphere(0.1), clearance::geometry::Pose::identity());
    let messages =
        [written(&client, Ask::States(&states, 2)), written(&client, Ask::Distance(&[subject, subject], &context))];
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state as usize
    };
    let (mut answers, mut refusals) = (0, 0);
    for round in 0..3000 {
        let mut message = messages[round % 2].clone();
        for _ in 0..1 + random() % 4 {
            let place = random() % message.len();
            // Neither nonce nor the client's name, whose damage the client could not tell from a foreign answer, nor its
            // patience.
            if !(32..64).contains(&place) && !(104..120).contains(&place) {
                message[place] = random() as u8;
            }
        }
        if random() % 10 == 0 {
            message.truncate(64 + random() % message.len());
        }
        match send(&mut client, &message) {
            Ok(_) => answers += 1,
            Err(ClientError::Refused(_)) => refusals += 1,
            Err(error) => panic!("round {round}: {error}"),
        }
    }
    assert!(answers > 100 && refusals > 100, "{answers} answers, {refusals} refusals");
}
