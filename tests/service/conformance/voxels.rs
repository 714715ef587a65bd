//! Maps that a mapping loop updates: points come, boxes go, and older revisions keep what they had.

use clearance::limits::Limits;
use clearance::transports::wire::v1;
use clearance::transports::wire::v1::edit::Kind;
use clearance::transports::wire::v1::numbers::Form;
use clearance::transports::wire::v1::shape::Core;
use tonic::Code;

use super::through_every_door;
use crate::support::door::Door;
use crate::support::messages::*;

through_every_door!(
    a_map_grows_and_is_cleared_and_older_revisions_stay,
    maps_told_by_points_and_by_cells_are_alike,
    edits_of_maps_that_cannot_be_change_nothing,
);

fn limits() -> Limits {
    Limits { max_voxel_cells: 50, max_cloud_points: 20, ..Limits::default() }
}

fn numbers(values: Vec<f64>) -> Option<v1::Numbers> {
    Some(v1::Numbers { form: Some(Form::Packed(v1::PackedDoubles { values })) })
}

fn map(resolution: f64, points: Option<v1::Numbers>, cells: Vec<i32>) -> v1::Shape {
    shape(Core::Voxels(v1::Voxels { resolution, points, cells }))
}

fn insert(body: &str, points: Vec<f64>) -> v1::Edit {
    edit(Kind::InsertPoints(v1::InsertPoints { body: Some(named(body)), points: numbers(points) }))
}

fn clear(body: &str, min: v1::Vec3, max: v1::Vec3) -> v1::Edit {
    let bounds = v1::Aabb { min: Some(min), max: Some(max) };
    edit(Kind::ClearBox(v1::ClearBox { body: Some(named(body)), r#box: Some(bounds) }))
}

/// How far a ball at the origin is from everything; none when there is nothing.
async fn gap(door: &impl Door, context: v1::Context) -> Option<f64> {
    let mut question = distance(vec![placed(sphere(0.25), at(0.0, 0.0, 0.0))]);
    question.context = Some(context);
    let item = door.distance(question).await.unwrap().items.remove(0);
    assert!(item.nearest.is_some() || item.verdict() == v1::Verdict::Free, "{item:?}");
    item.nearest.map(|pair| pair.signed_distance)
}

async fn a_map_grows_and_is_cleared_and_older_revisions_stay(door: &impl Door) {
    door.create_scene(SCENE).await.unwrap();
    door.apply(apply(vec![add("map", map(0.5, None, Vec::new()), at(0.0, 0.0, 0.0))])).await.unwrap();
    assert_eq!(gap(door, context()).await, None);
    door.apply(apply(vec![insert("map", vec![2.1, 0.1, 0.1, 9.0, 9.0, 9.0])])).await.unwrap();
    door.apply(apply(vec![insert("map", vec![1.2, 0.2, 0.2])])).await.unwrap();
    door.apply(apply(vec![clear("map", vec3(0.0, 0.0, 0.0), vec3(3.0, 0.3, 0.3))])).await.unwrap();
    door.apply(apply(vec![clear("map", vec3(-10.0, -10.0, -10.0), vec3(10.0, 10.0, 10.0))])).await.unwrap();
    let far = 9.0 * 3f64.sqrt() - 0.25;
    for (revision, expected) in [(1, None), (2, Some(1.75)), (3, Some(0.75)), (4, Some(far)), (5, None)] {
        let found = gap(door, asked_of(v1::revision_rule::Rule::Exactly(revision))).await;
        let alike = found.zip(expected).map_or(found == expected, |(a, b)| (a - b).abs() < 1e-9);
        assert!(alike, "revision {revision}: {found:?}, {expected:?}");
    }
}

async fn maps_told_by_points_and_by_cells_are_alike(door: &impl Door) {
    door.create_scene(SCENE).await.unwrap();
    let by_points = map(0.5, numbers(vec![1.1, 0.0, 0.0, -3.0, 0.0, 0.0]), Vec::new());
    let by_cells = map(0.5, None, vec![2, 0, 0, -6, 0, 0]);
    let by_both = map(0.5, numbers(vec![1.1, 0.0, 0.0]), vec![-6, 0, 0]);
    for shape in [by_points, by_cells, by_both] {
        door.apply(apply(vec![add("map", shape, at(0.0, 0.0, 0.0))])).await.unwrap();
        let contents = door
            .get_scene(v1::GetSceneRequest { scene: SCENE.to_owned(), ..v1::GetSceneRequest::default() })
            .await
            .unwrap();
        let bounds = contents.bodies[0].bounds.as_ref().unwrap();
        assert!((bounds.min.unwrap().x + 3.0).abs() < 1e-9 && (bounds.max.unwrap().x - 1.5).abs() < 1e-9, "{bounds:?}");
        assert_eq!(contents.bodies[0].shape_kind, "voxels");
        assert!((gap(door, context()).await.unwrap() - 0.75).abs() < 1e-9);
        door.apply(apply(vec![remove(named("map"))])).await.unwrap();
    }
}

async fn edits_of_maps_that_cannot_be_change_nothing(door: &impl Door) {
    door.create_scene(SCENE).await.unwrap();
    let edits =
        vec![add("map", map(0.5, None, Vec::new()), at(0.0, 0.0, 0.0)), add("ball", sphere(1.0), at(50.0, 0.0, 0.0))];
    door.apply(apply(edits)).await.unwrap();
    let no_box = edit(Kind::ClearBox(v1::ClearBox { body: Some(named("map")), r#box: None }));
    let no_points = edit(Kind::InsertPoints(v1::InsertPoints { body: Some(named("map")), points: None }));
    let (low, high) = (vec3(0.0, 0.0, 0.0), vec3(1.0, 1.0, 1.0));
    let bad = |shape| add("bad", shape, at(0.0, 0.0, 0.0));
    let invalid = Code::InvalidArgument;
    for (edit, code, field) in [
        (insert("map", vec![0.0, 1.0]), invalid, "edits[1].insert_points.points"),
        (insert("map", vec![0.0, f64::NAN, 1.0]), invalid, "edits[1].points"),
        (no_points, invalid, "edits[1].insert_points.points"),
        (no_box, invalid, "edits[1].clear_box.box"),
        (clear("map", high, low), invalid, "edits[1].box"),
        (insert("ball", vec![0.0; 3]), Code::FailedPrecondition, "edits[1].body"),
        (clear("ball", low, high), Code::FailedPrecondition, "edits[1].body"),
        (insert("map", vec![0.0; 63]), Code::ResourceExhausted, ""),
        (bad(map(0.0, None, Vec::new())), invalid, "edits[1].add_body.shape.voxels.resolution"),
        (bad(map(0.5, None, vec![1, 2])), invalid, "edits[1].add_body.shape.voxels.cells"),
        (bad(map(0.5, None, vec![1, 2, 1 << 23])), invalid, "edits[1].add_body.shape.voxels.cells[0]"),
        (bad(map(0.5, None, vec![0; 153])), Code::ResourceExhausted, ""),
    ] {
        let good = insert("map", vec![0.0, 0.0, 0.0]);
        let refusal = door.apply(apply(vec![good, edit])).await.expect_err(field);
        assert_eq!((refusal.code, refusal.field.as_str()), (code, field), "{refusal:?}");
        assert_eq!(gap(door, context()).await.map(|gap| (gap - 48.75).abs() < 1e-9), Some(true));
    }
    // Cells beyond the cap, one insertion after the other.
    let points = |row: f64| (0..20).flat_map(|i| [f64::from(i), row, 0.0]).collect();
    door.apply(apply(vec![insert("map", points(0.0)), insert("map", points(1.0))])).await.unwrap();
    let refusal = door.apply(apply(vec![insert("map", points(2.0))])).await.unwrap_err();
    assert!(refusal.message.starts_with("max_voxel_cells exceeded: asked for 60, allowed is 50"), "{refusal:?}");
}
