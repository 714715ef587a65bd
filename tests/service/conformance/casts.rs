//! Rays, moving shapes, regions and neighbours.

use clearance::limits::Limits;
use clearance::transports::wire::v1;
use tonic::Code;

use super::through_every_door;
use crate::support::door::Door;
use crate::support::messages::*;

through_every_door!(
    rays_are_answered_as_arrays,
    moving_shapes_and_bodies_are_answered_one_by_one,
    pairs_of_which_both_move_meet_half_way,
    regions_name_the_bodies_in_them,
    the_nearest_come_in_order,
    what_cannot_be_cast_is_refused_by_field,
    a_cap_on_items_counts_rays,
);

fn limits() -> Limits {
    Limits { max_items: 50, ..Limits::default() }
}

/// Balls of radius 0.5 whose centres are `x` metres along x; their ids begin with 1.
async fn balls(door: &impl Door, centres: &[f64]) {
    door.create_scene(SCENE).await.unwrap();
    let ball = |(i, x): (usize, &f64)| add(&format!("ball{i}"), sphere(0.5), at(*x, 0.0, 0.0));
    door.apply(apply(centres.iter().enumerate().map(ball).collect())).await.unwrap();
}

fn packed(values: Vec<f64>) -> Option<v1::Doubles> {
    Some(v1::Doubles { form: Some(v1::doubles::Form::Packed(v1::PackedDoubles { values })) })
}

fn rays(origins: Vec<f64>, directions: Vec<f64>, lengths: Vec<f64>, mode: v1::CastMode) -> v1::CastRaysRequest {
    v1::CastRaysRequest {
        context: Some(context()),
        origins: packed(origins),
        directions: packed(directions),
        lengths: packed(lengths),
        mode: mode.into(),
    }
}

fn numbers(bytes: &[u8]) -> Vec<f64> {
    bytes.as_chunks::<8>().0.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect()
}

fn ids(bytes: &[u8]) -> Vec<u64> {
    bytes.as_chunks::<8>().0.iter().map(|bytes| u64::from_le_bytes(*bytes)).collect()
}

fn counts(bytes: &[u8]) -> Vec<u32> {
    bytes.as_chunks::<4>().0.iter().map(|bytes| u32::from_le_bytes(*bytes)).collect()
}

fn mover(moved: v1::mover::Moved, way: v1::mover::Way) -> v1::Mover {
    v1::Mover { moved: Some(moved), start: None, way: Some(way) }
}

fn by(x: f64) -> v1::mover::Way {
    v1::mover::Way::By(v1::Twist { displacement: Some(vec3(x, 0.0, 0.0)), turn: None })
}

async fn rays_are_answered_as_arrays(door: &impl Door) {
    balls(door, &[0.0, 3.0, 6.0]).await;
    let origins = vec![-2.0, 0.0, 0.0, 0.0, 0.0, 0.1, 0.0, 9.0, 0.0, 9.0, 0.0, 0.0];
    let directions = vec![5.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let hit = v1::CastVerdict::Hit as u8;
    let expected = [hit, hit, v1::CastVerdict::Clear as u8, v1::CastVerdict::InvalidInput as u8];
    let ask = |mode| rays(origins.clone(), directions.clone(), vec![20.0], mode);
    let first = door.cast_rays(ask(v1::CastMode::First)).await.unwrap();
    assert_eq!(first.verdicts, expected.as_slice());
    assert_eq!(counts(&first.hit_counts), [1, 1, 0, 0]);
    let hits = first.hits.as_ref().unwrap();
    assert_eq!(ids(&hits.bodies), [1, 1]);
    let (lower, upper) = (numbers(&hits.lower), numbers(&hits.upper));
    assert!(lower[0] <= 1.5 && 1.5 <= upper[0] && upper[0] - lower[0] < 1e-9, "{lower:?}, {upper:?}");
    assert_eq!((lower[1], upper[1]), (0.0, 0.0));
    assert_eq!(hits.at_start.as_ref(), [0, 1]);
    assert!(numbers(&hits.points)[..3].iter().zip([-0.5, 0.0, 0.0]).all(|(a, b)| (a - b).abs() < 1e-9));
    assert!(numbers(&hits.normals)[..3].iter().zip([-1.0, 0.0, 0.0]).all(|(a, b)| (a - b).abs() < 1e-9));
    assert_eq!(numbers(&first.free_until)[2], 20.0);
    assert_eq!((first.problems.len(), first.problems[0].item), (1, 3));
    assert!(first.problems[0].problem.contains("direction is zero"), "{:?}", first.problems);
    let all = door.cast_rays(ask(v1::CastMode::All)).await.unwrap();
    assert_eq!(counts(&all.hit_counts), [3, 1, 0, 0]);
    assert_eq!(ids(&all.hits.as_ref().unwrap().bodies), [1, 2, 3, 1]);
    let any = door.cast_rays(ask(v1::CastMode::Any)).await.unwrap();
    assert_eq!(any.verdicts, expected.as_slice());
    assert_eq!(counts(&any.hit_counts), [0; 4]);
    // Past a ball by nothing.
    let grazing = rays(vec![-2.0, 0.5, 0.0], vec![1.0, 0.0, 0.0], vec![2.5], v1::CastMode::First);
    let grazing = door.cast_rays(grazing).await.unwrap();
    assert_eq!(grazing.verdicts.as_ref(), [v1::CastVerdict::Indeterminate as u8]);
    assert_eq!(counts(&grazing.grazed_counts), [1]);
    assert_eq!(ids(&grazing.grazed.unwrap().bodies), [1]);
    // Without the ball, as the filter says.
    let mut filtered = ask(v1::CastMode::First);
    filtered.context.as_mut().unwrap().filter =
        Some(v1::Filter { ignore: vec![named("ball0")], ..v1::Filter::default() });
    let filtered = door.cast_rays(filtered).await.unwrap();
    assert_eq!(ids(&filtered.hits.unwrap().bodies), [2]);
}

async fn moving_shapes_and_bodies_are_answered_one_by_one(door: &impl Door) {
    use v1::mover::{Moved, Way};
    balls(door, &[0.0, 3.0, 6.0]).await;
    let items = vec![
        mover(Moved::Body(named("ball0")), by(4.0)),
        mover(Moved::Shape(sphere(0.25)), Way::To(at(9.0, 0.0, 0.0))),
        mover(Moved::Body(named("ball2")), by(10.0)),
        mover(Moved::Body(numbered(99)), by(1.0)),
    ];
    let request = v1::CastShapesRequest { context: Some(context()), items, ..v1::CastShapesRequest::default() };
    let answer = door.cast_shapes(request).await.unwrap();
    let verdicts: Vec<v1::CastVerdict> = answer.items.iter().map(v1::CastItem::verdict).collect();
    use v1::CastVerdict::{Clear, Hit, InvalidInput};
    assert_eq!(verdicts, [Hit, Hit, Clear, InvalidInput]);
    let hit = &answer.items[0].hits[0];
    assert_eq!((hit.body, hit.at_start), (2, false));
    assert!(hit.lower <= 0.5 && 0.5 <= hit.upper && hit.upper - hit.lower < 1e-8, "{hit:?}");
    let normal = hit.normal.unwrap();
    assert!((normal.x + 1.0).abs() < 1e-6, "{normal:?}");
    assert!((hit.point.unwrap().x - 2.5).abs() < 1e-6);
    assert!(answer.items[1].hits[0].at_start && answer.items[1].free_until == 0.0);
    assert_eq!(answer.items[2].free_until, 1.0);
    assert_eq!(answer.items[3].problem, "items[3].body: no body 99 in the scene");
}

async fn pairs_of_which_both_move_meet_half_way(door: &impl Door) {
    use v1::mover::Moved;
    balls(door, &[0.0, 5.0]).await;
    let pair = |margin: f64| {
        let a = mover(Moved::Body(named("ball0")), by(4.0));
        let b = mover(Moved::Body(named("ball1")), by(-4.0));
        let items = vec![v1::MovingPair { a: Some(a), b: Some(b) }];
        let context = Some(v1::Context { margin, ..context() });
        v1::CheckMovingPairsRequest { context, items, resolution: None }
    };
    for (margin, expected) in [(0.0, 0.5), (1.0, 0.375)] {
        let answer = door.check_moving_pairs(pair(margin)).await.unwrap();
        let hit = &answer.items[0].hits[0];
        assert!(hit.lower <= expected && expected <= hit.upper && hit.upper - hit.lower < 1e-8, "{hit:?}");
    }
    let party = |name| Some(v1::Party { kind: Some(v1::party::Kind::Body(named(name))) });
    let allow = v1::SetAllowedCollision { a: party("ball0"), b: party("ball1"), allowed: Some(true) };
    door.apply(apply(vec![edit(v1::edit::Kind::SetAllowedCollision(allow))])).await.unwrap();
    let answer = door.check_moving_pairs(pair(0.0)).await.unwrap();
    assert_eq!(answer.items[0].verdict(), v1::CastVerdict::Clear);
}

async fn regions_name_the_bodies_in_them(door: &impl Door) {
    use v1::region::Kind;
    balls(door, &[0.0, 3.0, 6.0]).await;
    let region = |kind| v1::Region { kind: Some(kind) };
    let bounds = v1::Aabb { min: Some(vec3(0.4, 0.4, 0.4)), max: Some(vec3(2.6, 1.0, 1.0)) };
    let ball = v1::RegionBall { center: Some(vec3(4.5, 0.0, 0.0)), radius: 1.25 };
    let placed = v1::PlacedShape { shape: Some(cuboid(9.0, 0.1, 0.1)), pose: None };
    let items = vec![region(Kind::Box(bounds)), region(Kind::Ball(ball)), region(Kind::Shape(placed))];
    let ask = |bounds_only| v1::OverlapRequest { context: Some(context()), items: items.clone(), bounds_only };
    let told = |answer: &v1::OverlapResponse| answer.items.iter().map(|item| item.bodies.clone()).collect::<Vec<_>>();
    let answer = door.overlap(ask(false)).await.unwrap();
    assert_eq!(told(&answer), [vec![], vec![2, 3], vec![1, 2, 3]]);
    assert_eq!(answer.items[1].verdicts.as_ref(), [v1::Verdict::Collision as u8; 2]);
    assert_eq!(answer.items[0].verdict(), v1::Verdict::Free);
    // The corners of the boxes meet, the balls in them do not.
    let loose = door.overlap(ask(true)).await.unwrap();
    assert_eq!(told(&loose)[0], [1, 2]);
    assert_eq!(loose.items[0].verdicts.as_ref(), [v1::Verdict::NotRun as u8; 2]);
}

async fn the_nearest_come_in_order(door: &impl Door) {
    balls(door, &[0.0, 3.0, 7.0]).await;
    let ask = |count| {
        let items = vec![placed(sphere(0.5), at(5.5, 0.0, 0.0)), body(named("ball0"))];
        v1::NearestBodiesRequest { context: Some(context()), items, count }
    };
    let answer = door.nearest_bodies(ask(2)).await.unwrap();
    let told = |item: &v1::NearestItem| -> Vec<u64> {
        let id = |pair: &v1::PairAnswer| match pair.b.as_ref().unwrap().kind {
            Some(v1::side::Kind::Body(v1::BodySide { id, .. })) => id,
            other => panic!("{other:?}"),
        };
        item.nearest.iter().map(id).collect()
    };
    assert_eq!(told(&answer.items[0]), [3, 2]);
    assert_eq!(told(&answer.items[1]), [2, 3]);
    assert!(answer.items.iter().all(|item| item.set_is_proved && item.order_is_proved));
    let bracket = answer.items[0].nearest[0].bracket.unwrap();
    assert!(bracket.lower <= 0.5 && 0.5 <= bracket.upper);
    let refusal = door.nearest_bodies(ask(0)).await.unwrap_err();
    assert_eq!((refusal.code, refusal.field.as_str()), (Code::InvalidArgument, "count"), "{refusal:?}");
}

async fn what_cannot_be_cast_is_refused_by_field(door: &impl Door) {
    use v1::mover::{Moved, Way};
    balls(door, &[0.0]).await;
    let good = || rays(vec![0.0; 3], vec![1.0, 0.0, 0.0], vec![1.0], v1::CastMode::First);
    let cases = [
        (v1::CastRaysRequest { origins: None, ..good() }, "origins"),
        (v1::CastRaysRequest { origins: packed(vec![0.0; 4]), ..good() }, "origins"),
        (v1::CastRaysRequest { directions: packed(vec![0.0; 6]), ..good() }, "directions"),
        (v1::CastRaysRequest { lengths: packed(vec![]), ..good() }, "lengths"),
        (v1::CastRaysRequest { mode: 77, ..good() }, "mode"),
        (v1::CastRaysRequest { context: None, ..good() }, "context"),
    ];
    for (request, field) in cases {
        let refusal = door.cast_rays(request).await.expect_err(field);
        assert_eq!((refusal.code, refusal.field.as_str()), (Code::InvalidArgument, field), "{refusal:?}");
    }
    let turned = v1::Pose { translation: None, rotation: Some(v1::Quaternion::default()) };
    let shape = || Moved::Shape(sphere(1.0));
    let cases = [
        (v1::Mover { moved: None, start: None, way: Some(by(1.0)) }, "items[0].moved"),
        (v1::Mover { moved: Some(shape()), start: None, way: None }, "items[0].way"),
        (mover(shape(), Way::To(turned)), "items[0].to.rotation"),
        (v1::Mover { start: Some(turned), ..mover(shape(), by(1.0)) }, "items[0].start.rotation"),
        (mover(Moved::Shape(sphere(-1.0)), by(1.0)), "items[0].shape.sphere.radius"),
    ];
    for (item, field) in cases {
        let request =
            v1::CastShapesRequest { context: Some(context()), items: vec![item], ..v1::CastShapesRequest::default() };
        let refusal = door.cast_shapes(request).await.expect_err(field);
        assert_eq!((refusal.code, refusal.field.as_str()), (Code::InvalidArgument, field), "{refusal:?}");
    }
    let request = v1::CastShapesRequest {
        context: Some(context()),
        items: vec![mover(shape(), by(1.0))],
        resolution: Some(-1.0),
        ..v1::CastShapesRequest::default()
    };
    let refusal = door.cast_shapes(request).await.unwrap_err();
    assert_eq!(refusal.field, "resolution");
    let region = v1::OverlapRequest {
        context: Some(context()),
        items: vec![v1::Region { kind: Some(v1::region::Kind::Ball(v1::RegionBall { center: None, radius: 1.0 })) }],
        bounds_only: false,
    };
    let refusal = door.overlap(region).await.unwrap_err();
    assert_eq!(refusal.field, "items[0].ball.center");
}

async fn a_cap_on_items_counts_rays(door: &impl Door) {
    balls(door, &[0.0]).await;
    let many = rays(vec![0.0; 153], vec![1.0; 153], vec![1.0], v1::CastMode::First);
    let refusal = door.cast_rays(many).await.unwrap_err();
    assert_eq!(refusal.code, Code::ResourceExhausted, "{refusal:?}");
    assert!(refusal.message.contains("max_items"), "{refusal:?}");
}
