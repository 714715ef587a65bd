//! Terrain and point clouds: bodies and bare shapes made of many numbers.

use clearance::limits::Limits;
use clearance::transports::wire::v1;
use clearance::transports::wire::v1::numbers::Form;
use clearance::transports::wire::v1::shape::Core;
use tonic::Code;

use super::through_every_door;
use crate::support::door::Door;
use crate::support::messages::*;

through_every_door!(
    what_is_under_terrain_collides_and_what_is_over_it_is_as_far_as_the_surface,
    a_point_cloud_is_as_far_as_its_nearest_ball_and_names_it,
    numbers_mean_the_same_in_every_form,
    terrain_and_clouds_that_cannot_be_are_refused_by_field,
    hostile_sizes_are_refused_by_their_cap,
);

fn limits() -> Limits {
    Limits { max_height_samples: 100, max_cloud_points: 10, ..Limits::default() }
}

fn numbers(form: Form) -> Option<v1::Numbers> {
    Some(v1::Numbers { form: Some(form) })
}

fn packed(values: Vec<f64>) -> Option<v1::Numbers> {
    numbers(Form::Packed(v1::PackedDoubles { values }))
}

/// Four by three samples, one of them a metre higher than the others.
fn hill() -> v1::HeightField {
    let heights = (0..12).map(|i| if i == 5 { 2.0 } else { 1.0 }).collect();
    v1::HeightField { rows: 4, columns: 3, spacing_x: 1.0, spacing_y: 0.5, heights: packed(heights), floor: Some(-1.0) }
}

fn dots(values: Vec<f64>) -> v1::PointCloud {
    v1::PointCloud { points: packed(values), radius: 0.25 }
}

async fn nearest(door: &impl Door, subject: v1::Subject) -> v1::PairAnswer {
    let mut question = distance(vec![subject]);
    question.context.as_mut().unwrap().wants = Some(v1::Wants { depth: true, ..v1::Wants::default() });
    door.distance(question).await.unwrap().items.remove(0).nearest.unwrap()
}

fn bracketed(pair: &v1::PairAnswer, expected: f64) {
    let bracket = pair.bracket.as_ref().unwrap();
    assert!(bracket.lower - 1e-12 <= expected && expected <= bracket.upper + 1e-12, "{expected}: {pair:?}");
    assert!(bracket.upper - bracket.lower < 1e-9, "{pair:?}");
}

async fn what_is_under_terrain_collides_and_what_is_over_it_is_as_far_as_the_surface(door: &impl Door) {
    door.create_scene(SCENE).await.unwrap();
    let ground = shape(Core::HeightField(hill()));
    door.apply(apply(vec![add("ground", ground, at(0.0, 0.0, 10.0))])).await.unwrap();
    let ball = |z: f64| placed(sphere(0.1), at(0.5, 1.4, z));
    bracketed(&nearest(door, ball(12.0)).await, 0.9);
    let under = nearest(door, ball(10.0)).await;
    assert_eq!(under.verdict(), v1::Verdict::Collision, "{under:?}");
    bracketed(&nearest(door, ball(8.5)).await, 0.4);
    // Straight over the top; the columns of six cells meet there.
    bracketed(&nearest(door, placed(sphere(0.1), at(2.0, 0.5, 12.5))).await, 0.4);
    let contents = door
        .get_scene(v1::GetSceneRequest { scene: SCENE.to_owned(), ..v1::GetSceneRequest::default() })
        .await
        .unwrap();
    let body = &contents.bodies[0];
    let bounds = body.bounds.as_ref().unwrap();
    assert_eq!(body.shape_kind, "height_field");
    assert!((bounds.min.unwrap().z - 9.0).abs() < 1e-9 && (bounds.max.unwrap().z - 12.0).abs() < 1e-9, "{bounds:?}");
}

async fn a_point_cloud_is_as_far_as_its_nearest_ball_and_names_it(door: &impl Door) {
    door.create_scene(SCENE).await.unwrap();
    let cloud = shape(Core::PointCloud(dots(vec![0.0, 0.0, 0.0, 5.0, 0.0, 0.0, 2.0, 0.0, 0.0])));
    let ids = door.apply(apply(vec![add("seen", cloud, at(0.0, 1.0, 0.0))])).await.unwrap().added;
    let pair = nearest(door, placed(sphere(0.5), at(2.0, 1.0, 2.0))).await;
    bracketed(&pair, 1.25);
    let seen = v1::side::Kind::Body(v1::BodySide { id: ids[0], subshape: 2 });
    assert_eq!(pair.b.as_ref().and_then(|side| side.kind.as_ref()), Some(&seen), "{pair:?}");
    // Scaled and padded like any other body.
    let cloud = shape(Core::PointCloud(dots(vec![1.0, 0.0, 0.0])));
    let change = v1::ReplaceShape { body: Some(named("seen")), shape: Some(cloud), scale: Some(2.0), padding: 0.125 };
    door.apply(apply(vec![edit(v1::edit::Kind::ReplaceShape(change))])).await.unwrap();
    bracketed(&nearest(door, placed(sphere(0.5), at(2.0, 1.0, 2.0))).await, 0.875);
}

async fn numbers_mean_the_same_in_every_form(door: &impl Door) {
    door.create_scene(SCENE).await.unwrap();
    let values = [0.5, -1.25, 3.0, 0.75, 2.0, -0.5];
    let doubles: Vec<u8> = values.iter().flat_map(|v: &f64| v.to_le_bytes()).collect();
    let floats: Vec<u8> = values.iter().flat_map(|v| (*v as f32).to_le_bytes()).collect();
    let mut hashes = Vec::new();
    for bytes in [&doubles, &floats] {
        hashes.push(door.put_asset(announced(bytes), bytes).await.unwrap().sha256);
    }
    let forms = [
        Form::Packed(v1::PackedDoubles { values: values.to_vec() }),
        Form::LittleEndian(doubles.into()),
        Form::LittleEndianF32(floats.into()),
        Form::Sha256(hashes[0].clone()),
        Form::Sha256F32(hashes[1].clone()),
    ];
    let mut answers = Vec::new();
    for form in forms {
        let cloud = v1::PointCloud { points: numbers(form), radius: 0.1 };
        let grid = v1::HeightField { rows: 2, columns: 3, heights: cloud.points.clone(), floor: Some(-2.0), ..hill() };
        let edits = vec![
            add("cloud", shape(Core::PointCloud(cloud)), at(0.0, 0.0, 0.0)),
            add("grid", shape(Core::HeightField(grid)), at(5.0, 0.0, 0.0)),
        ];
        door.apply(apply(edits)).await.unwrap();
        let [cloud, grid] = ["cloud", "grid"].map(named);
        let subjects = [placed(sphere(0.1), at(0.0, 0.0, 9.0)), placed(sphere(0.1), at(5.5, 0.0, 9.0))];
        let mut told = Vec::new();
        for subject in subjects {
            told.push(nearest(door, subject).await.bracket);
        }
        answers.push(told);
        door.apply(apply(vec![remove(cloud), remove(grid)])).await.unwrap();
    }
    assert!(answers.iter().all(|answer| *answer == answers[0]), "{answers:?}");
}

async fn terrain_and_clouds_that_cannot_be_are_refused_by_field(door: &impl Door) {
    door.create_scene(SCENE).await.unwrap();
    let field = |change: &dyn Fn(&mut v1::HeightField)| {
        let mut field = hill();
        change(&mut field);
        Core::HeightField(field)
    };
    let cloud = |points| Core::PointCloud(v1::PointCloud { points, radius: 0.1 });
    let mut sunk = vec![1.0; 12];
    sunk[7] = -1.5;
    let cases = [
        (field(&|f| f.floor = None), "height_field.floor"),
        (field(&|f| f.floor = Some(f64::NAN)), "height_field.floor"),
        (field(&|f| f.rows = 1), "height_field.rows"),
        (field(&|f| f.columns = 0), "height_field.columns"),
        (field(&|f| f.columns = 4), "height_field.heights"),
        (field(&|f| f.heights = None), "height_field.heights"),
        (field(&|f| f.heights = packed(vec![f64::NAN; 12])), "height_field.heights[0]"),
        (field(&|f| f.heights = packed(sunk.clone())), "height_field.heights[7]"),
        (field(&|f| f.spacing_y = 0.0), "height_field.spacing.y"),
        (field(&|f| f.spacing_x = f64::INFINITY), "height_field.spacing.x"),
        (field(&|f| f.heights = numbers(Form::LittleEndian(vec![0; 95].into()))), "height_field.heights.little_endian"),
        (field(&|f| f.heights = numbers(Form::Sha256("abc".to_owned()))), "height_field.heights.sha256"),
        (cloud(packed(vec![0.0; 4])), "point_cloud.points"),
        (cloud(packed(Vec::new())), "point_cloud.points"),
        (cloud(packed(vec![0.0, 0.0, 0.0, 0.0, f64::INFINITY, 0.0])), "point_cloud.points[1]"),
        (cloud(numbers(Form::LittleEndianF32(vec![0; 13].into()))), "point_cloud.points.little_endian_f32"),
        (Core::PointCloud(v1::PointCloud { points: packed(vec![0.0; 3]), radius: -1.0 }), "point_cloud.radius"),
    ];
    for (core, field) in cases {
        let refusal = door.apply(apply(vec![add("bad", shape(core), at(0.0, 0.0, 0.0))])).await.expect_err(field);
        let expected = format!("edits[0].add_body.shape.{field}");
        assert_eq!((refusal.code, refusal.field), (Code::InvalidArgument, expected), "{}", refusal.message);
    }
    let missing = cloud(numbers(Form::Sha256(announced(b"?").sha256)));
    let refusal = door.apply(apply(vec![add("bad", shape(missing), at(0.0, 0.0, 0.0))])).await.unwrap_err();
    assert_eq!(refusal.code, Code::NotFound, "{refusal:?}");
    let contents = door
        .get_scene(v1::GetSceneRequest { scene: SCENE.to_owned(), ..v1::GetSceneRequest::default() })
        .await
        .unwrap();
    assert_eq!((contents.revision, contents.bodies.len()), (0, 0));
}

async fn hostile_sizes_are_refused_by_their_cap(door: &impl Door) {
    door.create_scene(SCENE).await.unwrap();
    // Announced, but not there: refused before anything is allocated for it.
    let endless = v1::HeightField { rows: u32::MAX, columns: u32::MAX, ..hill() };
    let large = v1::HeightField { heights: packed(vec![1.0; 101]), ..hill() };
    let many = dots(vec![0.0; 33]);
    let bytes = v1::PointCloud { points: numbers(Form::LittleEndianF32(vec![0; 132].into())), radius: 0.1 };
    for (core, cap) in [
        (Core::HeightField(endless), "max_height_samples"),
        (Core::HeightField(large), "max_height_samples"),
        (Core::PointCloud(many), "max_cloud_points"),
        (Core::PointCloud(bytes), "max_cloud_points"),
    ] {
        let refusal = door.apply(apply(vec![add("bad", shape(core), at(0.0, 0.0, 0.0))])).await.expect_err(cap);
        assert_eq!((refusal.code, refusal.reason.as_str()), (Code::ResourceExhausted, "LIMIT_EXCEEDED"), "{refusal:?}");
        assert!(refusal.message.starts_with(&format!("{cap} exceeded")), "{refusal:?}");
    }
}
