//! Maps that are edited in a scene: points come, boxes go, and older snapshots keep what they had.

use super::*;
use crate::geometry::{Aabb, Core, Voxels};
use crate::limits::Limits;

fn map(name: &str) -> NewBody {
    NewBody::new(name, Arc::new(Shape::voxels(Voxels::new(0.5).unwrap())), at(10.0))
}

fn insert(body: &str, points: &[[f64; 3]]) -> Edit {
    Edit::InsertPoints { body: body.into(), points: points.iter().map(|p| Vec3::from(*p)).collect() }
}

fn clear(body: &str, min: [f64; 3], max: [f64; 3]) -> Edit {
    Edit::ClearBox { body: body.into(), bounds: Aabb { min: min.into(), max: max.into() } }
}

fn cells(snapshot: &Snapshot, body: &str) -> usize {
    let body = snapshot.body_named(body).unwrap();
    let Core::Voxels(map) = body.shape.core() else { panic!("{body:?}") };
    map.len()
}

#[test]
fn a_map_begins_empty_grows_and_is_cleared_while_older_snapshots_stay() {
    let mut scene = scene_of([map("map"), floor("floor")]);
    let empty = scene.snapshot();
    assert_eq!((cells(&empty, "map"), empty.unbounded().len()), (0, 1), "an empty map is not without end");
    assert!(empty.body_named("map").unwrap().bounds.is_none());
    apply(&mut scene, &[insert("map", &[[0.1, 0.1, 0.1], [0.2, 0.2, 0.2], [3.0, 0.0, 0.0]])]);
    let two = scene.snapshot();
    assert_eq!(cells(&two, "map"), 2);
    let bounds = two.body_named("map").unwrap().bounds.unwrap();
    assert!(bounds.min.x <= 10.0 && bounds.max.x >= 13.5 && bounds.max.x < 13.6, "{bounds:?}");
    apply(&mut scene, &[clear("map", [2.9, 0.0, 0.0], [3.1, 0.0, 0.0])]);
    apply(&mut scene, &[clear("map", [-1.0; 3], [1.0; 3])]);
    assert_eq!([&empty, &two, &scene.snapshot()].map(|snapshot| cells(snapshot, "map")), [0, 2, 0]);
    assert_eq!(scene.snapshot().unbounded().len(), 1);
    // Hidden maps are edited too, and come back as they are then.
    let enable = |enabled| Edit::SetEnabled { body: "map".into(), enabled };
    apply(&mut scene, &[enable(false), insert("map", &[[0.0; 3]])]);
    apply(&mut scene, &[enable(true)]);
    assert_eq!(cells(&scene.snapshot(), "map"), 1);
}

#[test]
fn scale_and_padding_stay_through_edits() {
    let body = NewBody { scale: 2.0, padding: 0.25, ..map("map") };
    let mut scene = scene_of([body]);
    apply(&mut scene, &[insert("map", &[[0.1; 3], [0.9; 3], [1.1; 3]])]);
    let snapshot = scene.snapshot();
    let body = snapshot.body_named("map").unwrap();
    assert_eq!((cells(&snapshot, "map"), body.shape.swept_radius(), body.scale), (2, 0.25, 2.0));
    assert_eq!(body.shape.bounds(), Some(Aabb { min: Vec3::repeat(-0.25), max: Vec3::repeat(2.25) }));
}

#[test]
fn edits_of_maps_that_cannot_be_are_refused_as_a_whole() {
    let limits = Limits { max_voxel_cells: 3, ..Limits::default() };
    let mut scene = Scene::with_limits(Epoch(1), limits);
    apply(&mut scene, &[Edit::AddBody(map("map")), Edit::AddBody(ball("ball", 0.0))]);
    let good = insert("map", &[[0.0; 3], [1.0; 3]]);
    for (bad, text) in [
        (insert("map", &[[0.0, f64::NAN, 0.0]]), "edits[1].points: points[0] is not finite"),
        (insert("map", &[[0.0; 3], [0.0, 0.0, 1e9]]), "edits[1].points: points[1] is beyond 2.097152e6 m: 1e9"),
        (insert("map", &[[2.0; 3], [3.0; 3]]), "edits[1].points: max_voxel_cells exceeded: asked for 4, allowed is 3"),
        (insert("ball", &[[0.0; 3]]), "edits[1].body: the body's shape is a sphere, and only voxels can be edited"),
        (insert("nobody", &[[0.0; 3]]), "edits[1].body: no body is named \"nobody\""),
        (
            clear("ball", [0.0; 3], [1.0; 3]),
            "edits[1].body: the body's shape is a sphere, and only voxels can be edited",
        ),
        (clear("map", [0.0, 2.0, 0.0], [1.0; 3]), "edits[1].box: min.y is above max.y"),
        (clear("map", [f64::NAN; 3], [1.0; 3]), "edits[1].box: min is not finite"),
    ] {
        let refusal = scene.apply(&[good.clone(), bad], None).unwrap_err();
        assert_eq!(refusal.to_string(), text);
        assert_eq!((cells(&scene.snapshot(), "map"), scene.snapshot().revision()), (0, Revision(1)));
    }
}

/// It did not: watched contacts missed what grew into a map.
#[test]
fn an_edited_map_has_changed() {
    let mut scene = scene_of([map("map")]);
    let before = scene.snapshot().revision();
    apply(&mut scene, &[insert("map", &[[2.5, 0.5, 0.5]])]);
    apply(&mut scene, &[clear("map", [2.4; 3], [2.6; 3])]);
    let snapshot = scene.snapshot();
    let id = snapshot.body_named("map").unwrap().id;
    for since in [before, Revision(before.0 + 1)] {
        let changed = snapshot.changes_since(since).unwrap();
        assert_eq!(changed.bodies(), [BodyChange { id, kinds: ChangeKinds::RESHAPED }]);
    }
}
