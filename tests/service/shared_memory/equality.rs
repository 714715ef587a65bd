//! The oracle is gRPC's bulk form: what shared memory answers is put into the same messages, and their bytes compared.

use clearance::geometry::{Pose, Quaternion, Vec3};
use clearance::query::{CastMode, CastRays, CheckMotions, CheckStates, Context, Find, Mode, Motions, Wants};
use clearance::transports::shared_memory::layout::kind;
use clearance::transports::shared_memory::{Ask, Options, PlainShape, PlainSubject, Reply};
use clearance::transports::wire::{from_proto, to_proto, v1};
use prost::Message;

use super::place::*;
use crate::support::messages::*;
use crate::support::watchdog::watched;

/// The columns of an answer as gRPC's message, without the count of nodes, which no canonical form has.
fn message(reply: &Reply) -> v1::Answer {
    let bytes = |kind| prost::bytes::Bytes::copy_from_slice(reply.bytes(kind).unwrap_or_default());
    let brackets = |first: u32| {
        reply.bytes(first).map(|_| v1::BulkBrackets {
            lower: bytes(first),
            upper: bytes(first + 1),
            signed_distance: bytes(first + 2),
        })
    };
    let problem = |(item, problem)| v1::BulkProblem { item: item as u32, problem };
    let cost = reply.cost();
    v1::Answer {
        epoch: reply.epoch().0,
        revision: reply.revision().0,
        items: Vec::new(),
        bulk: Some(v1::BulkAnswer {
            verdicts: bytes(kind::VERDICTS),
            indeterminacies: bytes(kind::INDETERMINACIES),
            nearest: brackets(kind::NEAREST_LOWER),
            nearest_self: brackets(kind::SELF_LOWER),
            nearest_scene: brackets(kind::SCENE_LOWER),
            problems: reply.problems().into_iter().map(problem).collect(),
        }),
        added_bodies: Vec::new(),
        coverage: None,
        stopped_at: reply.stopped_at().map(|item| item as u32),
        out_of_time: reply.out_of_time(),
        cost: Some(v1::Cost {
            supports: cost.supports,
            gjk_iterations: cost.gjk_iterations,
            epa_iterations: cost.epa_iterations,
            nodes: 0,
            pairs: cost.pairs,
            escalations: cost.escalations,
            ..v1::Cost::default()
        }),
    }
}

fn canonical(mut answer: v1::Answer) -> v1::Answer {
    answer.cost.as_mut().unwrap().nodes = 0;
    answer
}

fn motion_columns(reply: &Reply) -> v1::BulkMotions {
    let bytes = |kind| prost::bytes::Bytes::copy_from_slice(reply.bytes(kind).unwrap());
    v1::BulkMotions {
        free_until: bytes(kind::FREE_UNTIL),
        reached_from: bytes(kind::REACHED_FROM),
        reached_to: bytes(kind::REACHED_TO),
        undecided_from: bytes(kind::UNDECIDED_FROM),
        undecided_to: bytes(kind::UNDECIDED_TO),
        states: bytes(kind::STATES),
    }
}

fn in_bulk(context: Option<v1::Context>) -> Option<v1::Context> {
    context.map(|context| v1::Context { answer_form: v1::AnswerForm::Bulk.into(), ..context })
}

fn contexts() -> Vec<Context> {
    let distance = Wants { distance: true, ..Wants::VERDICT };
    vec![
        Context::default(),
        Context { wants: distance, margin: 0.15, ..Context::default() },
        Context {
            wants: Wants { patch: false, derivatives: false, ..Wants::ALL },
            cut_off: Some(1.0),
            max_pairs: 3,
            ..Context::default()
        },
    ]
}

/// States that are free, near, in collision and not to be asked, in a mixed order; `count` of them.
fn states(count: usize) -> Vec<f64> {
    let state = |index: usize| {
        let part = index as f64 / count as f64;
        let lower = if index % 17 == 5 { f64::NAN } else { -0.1 * (index % 10) as f64 };
        [-0.2 + 1.6 * part, lower]
    };
    (0..count).flat_map(state).collect()
}

#[tokio::test(flavor = "multi_thread")]
async fn states_have_the_same_bytes_as_through_grpc() {
    let place = Place::with_crane(small()).await;
    let (mut client, mut queries) = (place.client(), place.queries.clone());
    let mut seen = std::collections::BTreeSet::new();
    // Few items are answered on the door's own thread, many are handed over.
    for count in [1, 8, 9, 500] {
        for context in contexts() {
            for mode in [Mode::All, Mode::StopAtFirst] {
                let question = CheckStates { mode, ..crane_states(states(count), context.clone()) };
                let mut request = to_proto::check_states_request(&target(), &question);
                request.context = in_bulk(request.context);
                let told = watched("gRPC", queries.check_states(request)).await.unwrap().into_inner().answer.unwrap();
                let reply = ask(&mut client, Ask::States(&question, 2), &Options::default()).unwrap();
                assert_eq!(message(&reply).encode_to_vec(), canonical(told).encode_to_vec(), "{count} {context:?}");
                assert_eq!(reply.items(), count);
                seen.extend(reply.bytes(kind::VERDICTS).unwrap().iter().copied());
            }
        }
    }
    assert!([1, 2, 3, 5, 6].iter().all(|verdict| seen.contains(verdict)), "verdicts seen: {seen:?}");
}

#[tokio::test(flavor = "multi_thread")]
async fn motions_and_paths_have_the_same_bytes_as_through_grpc() {
    let place = Place::with_crane(small()).await;
    let (mut client, mut queries) = (place.client(), place.queries.clone());
    let waypoints = vec![1.5, -0.5, 0.0, -0.5, 0.0, -0.9, 1.2, -0.2];
    for find in [Find::FirstContact, Find::AnyContact] {
        for motions in [Motions::Edges, Motions::Path] {
            let question = CheckMotions {
                robot: "arm".to_owned(),
                positions: waypoints.clone(),
                motions,
                mode: Mode::All,
                find,
                resolution: 1e-3,
                max_states: 1000,
                context: Context::default(),
            };
            let (answer, bulk) = match motions {
                Motions::Edges => {
                    let mut request = to_proto::check_motions_request(&target(), &question);
                    request.context = in_bulk(request.context);
                    let told = watched("gRPC", queries.check_motions(request)).await.unwrap().into_inner();
                    (told.answer.unwrap(), told.bulk.unwrap())
                }
                Motions::Path => {
                    let mut request = to_proto::check_path_request(&target(), &question);
                    request.context = in_bulk(request.context);
                    let told = watched("gRPC", queries.check_path(request)).await.unwrap().into_inner();
                    (told.answer.unwrap(), told.bulk.unwrap())
                }
            };
            let reply = ask(&mut client, Ask::Motions(&question, 2), &Options::default()).unwrap();
            assert_eq!(message(&reply).encode_to_vec(), canonical(answer).encode_to_vec());
            assert_eq!(motion_columns(&reply).encode_to_vec(), bulk.encode_to_vec());
            assert!(reply.bytes(kind::VERDICTS).unwrap().contains(&3), "one of them meets the block");
        }
    }
}

fn pose(x: f64, y: f64, z: f64) -> Pose {
    let turned = Quaternion { w: 0.9, x: 0.1, y: -0.2, z: 0.3 };
    Pose::new(Vec3::new(x, y, z), turned).unwrap()
}

/// Subjects in both forms.
fn subjects() -> Vec<(PlainSubject, v1::Subject)> {
    let shapes = [
        (PlainShape::sphere(0.2), sphere(0.2)),
        (PlainShape::cuboid([0.1, 0.2, 0.3]), cuboid(0.1, 0.2, 0.3)),
        (PlainShape::point(), shape(v1::shape::Core::Point(v1::Point {}))),
        (PlainShape::capsule(0.1, 0.2), shape(v1::shape::Core::Capsule(v1::Capsule { radius: 0.1, half_length: 0.2 }))),
        (
            PlainShape::cylinder(0.1, 0.2),
            shape(v1::shape::Core::Cylinder(v1::Cylinder { radius: 0.1, half_length: 0.2 })),
        ),
        (PlainShape::cone(0.1, 0.2), shape(v1::shape::Core::Cone(v1::Cone { radius: 0.1, half_length: 0.2 }))),
        (
            PlainShape::ellipsoid([0.1, 0.2, 0.3]),
            shape(v1::shape::Core::Ellipsoid(v1::Ellipsoid { radii: Some(vec3(0.1, 0.2, 0.3)) })),
        ),
        (PlainShape::cuboid([0.1; 3]).swept(0.05), v1::Shape { swept_radius: 0.05, ..cuboid(0.1, 0.1, 0.1) }),
    ];
    let places = [pose(1.0, 0.1, -0.7), pose(1.0, 0.2, -0.3), pose(0.3, 3.0, 0.0)];
    let mut all: Vec<(PlainSubject, v1::Subject)> = vec![
        (PlainSubject::All, all_pairs()),
        (PlainSubject::Body(1), body(numbered(1))),
        (PlainSubject::ChangedSince(0), changed_since(0)),
        // The block's own shape elsewhere, and gRPC is given the shape.
        (PlainSubject::ShapeOfBody(1, places[1]), placed(cuboid(0.2, 0.2, 0.2), to_proto::pose(&places[1]))),
    ];
    for (plain, message) in shapes {
        for at in places {
            all.push((PlainSubject::Shape(plain, at), placed(message.clone(), to_proto::pose(&at))));
        }
    }
    all
}

#[tokio::test(flavor = "multi_thread")]
async fn subjects_have_the_same_bytes_as_through_grpc() {
    let place = Place::with_crane(small()).await;
    let (mut client, mut queries) = (place.client(), place.queries.clone());
    let ids: Vec<u64> = place
        .daemon
        .service
        .ask(&target(), Default::default(), |view| Ok(view.snapshot().bodies().map(|body| body.id.0).collect()))
        .await
        .unwrap();
    assert_eq!(ids[0], 1, "the block's id, which the subjects name: {ids:?}");
    let (plain, messages): (Vec<_>, Vec<_>) = subjects().into_iter().unzip();
    for count in [6, plain.len()] {
        for context in contexts() {
            let message_context =
                in_bulk(to_proto::check_states_request(&target(), &crane_states(vec![], context.clone())).context);
            let items = messages[messages.len() - count..].to_vec();
            let plain = &plain[plain.len() - count..];
            let request = v1::CollideRequest { context: message_context.clone(), items: items.clone(), mode: 0 };
            let told = watched("gRPC", queries.collide(request)).await.unwrap().into_inner().answer.unwrap();
            let reply = ask(&mut client, Ask::Collide(plain, &context), &Options::default()).unwrap();
            assert_eq!(message(&reply).encode_to_vec(), canonical(told).encode_to_vec(), "collide {count} {context:?}");
            let request = v1::DistanceRequest { context: message_context, items, mode: 0 };
            let told = watched("gRPC", queries.distance(request)).await.unwrap().into_inner().answer.unwrap();
            let reply = ask(&mut client, Ask::Distance(plain, &context), &Options::default()).unwrap();
            assert_eq!(
                message(&reply).encode_to_vec(),
                canonical(told).encode_to_vec(),
                "distance {count} {context:?}"
            );
        }
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn sides_witnesses_and_listed_pairs_are_those_of_the_items() {
    let place = Place::with_crane(small()).await;
    let (mut client, mut queries) = (place.client(), place.queries.clone());
    let context =
        Context { wants: Wants { patch: false, derivatives: false, ..Wants::ALL }, margin: 0.5, ..Context::default() };
    let question = crane_states(states(40), context);
    let request = to_proto::check_states_request(&target(), &question);
    let told = watched("gRPC", queries.check_states(request)).await.unwrap().into_inner().answer.unwrap();
    let items = from_proto::answer(&told).unwrap().items;
    let options = Options { wants_sides: true, ..Options::default() };
    let reply = ask(&mut client, Ask::States(&question, 2), &options).unwrap();
    let bits = |kind| reply.doubles(kind).unwrap().into_iter().map(f64::to_bits).collect::<Vec<_>>();
    let wanted = |number: fn(&clearance::query::PairAnswer) -> f64| -> Vec<u64> {
        items.iter().map(|item| item.nearest.as_ref().map_or(f64::NAN, number).to_bits()).collect()
    };
    assert_eq!(
        bits(kind::NEAREST_POINT_ERROR),
        wanted(|pair| pair.witness.as_ref().map_or(f64::NAN, |w| w.point_error))
    );
    let points: Vec<u64> = items
        .iter()
        .flat_map(|item| {
            let witness = item.nearest.as_ref().and_then(|pair| pair.witness);
            witness.map_or([f64::NAN; 3], |witness| witness.point_on_b.into())
        })
        .map(f64::to_bits)
        .collect();
    assert_eq!(bits(kind::NEAREST_POINT_ON_B), points);
    let body_of = |pair: &clearance::query::PairAnswer| match pair.b {
        clearance::query::Side::Body { id, .. } => (3, id.0),
        clearance::query::Side::Link { link, .. } => (1, link.into()),
        clearance::query::Side::Query { .. } => (2, 0),
    };
    let (kinds, ids): (Vec<u8>, Vec<u64>) =
        items.iter().map(|item| item.nearest.as_ref().map_or((0, 0), body_of)).unzip();
    assert_eq!(reply.bytes(kind::NEAREST_B_KIND).unwrap(), kinds);
    assert_eq!(reply.integers(kind::NEAREST_B_ID).unwrap(), ids);
    let counts: Vec<u32> = items.iter().map(|item| item.pairs.len() as u32).collect();
    assert_eq!(reply.counts(kind::PAIR_COUNTS).unwrap(), counts);
    assert!(counts.iter().any(|count| *count > 1) && kinds.contains(&3) && kinds.contains(&0));
    let upper: Vec<u64> = items.iter().flat_map(|item| &item.pairs).map(|pair| pair.bracket.upper.to_bits()).collect();
    assert_eq!(bits(kind::PAIR_UPPER), upper);
    let ids: Vec<u64> = items.iter().flat_map(|item| &item.pairs).map(|pair| body_of(pair).1).collect();
    assert_eq!(reply.integers(kind::PAIR_B_ID).unwrap(), ids);
}

#[tokio::test(flavor = "multi_thread")]
async fn rays_have_the_same_bytes_as_through_grpc() {
    let place = Place::with_crane(small()).await;
    let (mut client, mut queries) = (place.client(), place.queries.clone());
    for count in [4, 300] {
        for mode in [CastMode::First, CastMode::All, CastMode::Any] {
            let along = |index: usize| index as f64 / count as f64;
            let question = CastRays {
                origins: (0..count)
                    .flat_map(|i| [1.0, -1.0 + along(i), if i % 7 == 3 { f64::NAN } else { -0.9 }])
                    .collect(),
                directions: (0..count).flat_map(|i| [0.3 * along(i), 1.0, 0.0]).collect(),
                lengths: vec![3.0],
                mode,
                context: Context { max_pairs: 1, ..Context::default() },
            };
            let doubles = |values: &[f64]| {
                let packed = v1::PackedDoubles { values: values.to_vec() };
                Some(v1::Doubles { form: Some(v1::doubles::Form::Packed(packed)) })
            };
            let number = match mode {
                CastMode::First => v1::CastMode::First,
                CastMode::All => v1::CastMode::All,
                CastMode::Any => v1::CastMode::Any,
            };
            let request = v1::CastRaysRequest {
                context: to_proto::check_states_request(&target(), &crane_states(vec![], question.context.clone()))
                    .context,
                origins: doubles(&question.origins),
                directions: doubles(&question.directions),
                lengths: doubles(&question.lengths),
                mode: number.into(),
            };
            let mut told = watched("gRPC", queries.cast_rays(request)).await.unwrap().into_inner();
            told.cost.as_mut().unwrap().nodes = 0;
            let reply = ask(&mut client, Ask::Rays(&question), &Options::default()).unwrap();
            let bytes = |kind| prost::bytes::Bytes::copy_from_slice(reply.bytes(kind).unwrap());
            let ours = v1::CastRaysResponse {
                epoch: reply.epoch().0,
                revision: reply.revision().0,
                out_of_time: reply.out_of_time(),
                verdicts: bytes(kind::VERDICTS),
                indeterminacies: bytes(kind::INDETERMINACIES),
                free_until: bytes(kind::FREE_UNTIL),
                truncated: bytes(kind::TRUNCATED),
                hit_counts: bytes(kind::HIT_COUNTS),
                hits: Some(v1::RayHits {
                    bodies: bytes(kind::HIT_BODIES),
                    subshapes: bytes(kind::HIT_SUBSHAPES),
                    lower: bytes(kind::HIT_LOWER),
                    upper: bytes(kind::HIT_UPPER),
                    at_start: bytes(kind::HIT_AT_START),
                    points: bytes(kind::HIT_POINTS),
                    normals: bytes(kind::HIT_NORMALS),
                }),
                grazed_counts: bytes(kind::GRAZED_COUNTS),
                grazed: Some(v1::GrazedBodies {
                    bodies: bytes(kind::GRAZED_BODIES),
                    lower: bytes(kind::GRAZED_LOWER),
                    upper: bytes(kind::GRAZED_UPPER),
                    indeterminacies: bytes(kind::GRAZED_INDETERMINACIES),
                }),
                problems: message(&reply).bulk.unwrap().problems,
                cost: message(&reply).cost,
            };
            assert_eq!(ours.encode_to_vec(), told.encode_to_vec(), "{count} {mode:?}");
            assert!(ours.verdicts.contains(&2) && ours.verdicts.contains(&5), "hits and problems: {:?}", ours.verdicts);
        }
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn revisions_are_chosen_and_named() {
    use crate::support::door::Door;
    let place = Place::with_crane(small()).await;
    let mut client = place.client();
    place.inside.apply(apply(vec![add("late", sphere(0.1), at(1.0, 0.0, -0.5))])).await.unwrap();
    let question = crane_states(vec![0.0, -0.4], Context::default());
    let mut at = |target| {
        let asked = Ask::States(&question, 2);
        tokio::task::block_in_place(|| client.ask(&target, asked, &Options::default())).unwrap()
    };
    let (old, new, latest) = (at(exactly(1)), at(at_least(2)), at(target()));
    assert_eq!((old.revision().0, new.revision().0, latest.revision().0), (1, 2, 2));
    assert_eq!(old.bytes(kind::VERDICTS).unwrap(), [1], "the ball in the way came later");
    assert_eq!(new.bytes(kind::VERDICTS).unwrap(), [3]);
}
