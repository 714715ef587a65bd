//! Everything that can be wrong with a field: the error names it, and the scene is as before.

use clearance::limits::Limits;
use clearance::transports::wire::v1;
use clearance::transports::wire::v1::shape::Core;
use tonic::Code;

use super::through_every_door;
use crate::support::door::Door;
use crate::support::messages::*;

through_every_door!(
    shapes_that_cannot_be_are_refused_by_field,
    poses_that_cannot_be_are_refused_by_field,
    edits_that_say_too_little_are_refused_by_field,
    contexts_that_cannot_be_are_refused_by_field,
);

fn limits() -> Limits {
    Limits::default()
}

/// Tries to change a scene with each edit, and looks that nothing happened.
async fn check_edits(door: &impl Door, cases: Vec<(v1::Edit, &str)>) {
    door.create_scene(SCENE).await.unwrap();
    for (bad, field) in cases {
        let edits = vec![add("good", sphere(1.0), at(0.0, 0.0, 0.0)), bad];
        let refusal = door.apply(apply(edits)).await.expect_err(field);
        assert_eq!((refusal.code, refusal.field.as_str()), (Code::InvalidArgument, field), "{refusal:?}");
    }
    let contents = v1::GetSceneRequest { scene: SCENE.to_owned(), ..v1::GetSceneRequest::default() };
    let contents = door.get_scene(contents).await.unwrap();
    assert_eq!((contents.revision, contents.bodies.len()), (0, 0));
}

async fn shapes_that_cannot_be_are_refused_by_field(door: &impl Door) {
    let mesh = |triangles, mode: v1::MeshMode| {
        let vertices = vec![vec3(0.0, 0.0, 0.0), vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0)];
        Core::Mesh(v1::Mesh { vertices, triangles, mode: mode.into() })
    };
    let compound = |part| {
        let part = v1::Part { shape: Some(part), pose: None };
        Core::Compound(v1::Compound { parts: vec![v1::Part { shape: Some(sphere(1.0)), pose: None }, part] })
    };
    let points = vec![vec3(0.0, 0.0, 0.0), vec3(0.0, f64::INFINITY, 0.0)];
    let cases = [
        (Core::Sphere(v1::Sphere { radius: -1.0 }), "sphere.radius"),
        (Core::Sphere(v1::Sphere { radius: f64::NAN }), "sphere.radius"),
        (Core::Box(v1::Box { half_extents: None }), "box.half_extents"),
        (Core::Box(v1::Box { half_extents: Some(vec3(1.0, -2.0, 1.0)) }), "box.half_extents.y"),
        (Core::Capsule(v1::Capsule { radius: 0.1, half_length: f64::INFINITY }), "capsule.half_length"),
        (Core::Cylinder(v1::Cylinder { radius: -0.1, half_length: 1.0 }), "cylinder.radius"),
        (Core::Cone(v1::Cone { radius: 1e200, half_length: 1.0 }), "cone.radius"),
        (Core::Ellipsoid(v1::Ellipsoid { radii: Some(vec3(1.0, 1.0, f64::NAN)) }), "ellipsoid.radii.z"),
        (Core::Convex(v1::Convex { points: Vec::new() }), "convex.points"),
        (Core::Convex(v1::Convex { points }), "convex.points[1]"),
        (Core::HalfSpace(v1::HalfSpace { normal: Some(vec3(0.0, 0.0, 0.0)), offset: 0.0 }), "half_space.normal"),
        (Core::Plane(v1::Plane { normal: Some(vec3(0.0, 0.0, 1.0)), offset: f64::NAN }), "plane.offset"),
        (Core::Segment(v1::Segment { a: Some(vec3(0.0, 0.0, 0.0)), b: None }), "segment.b"),
        (mesh(vec![0, 1], v1::MeshMode::Exact), "mesh.triangles"),
        (mesh(vec![0, 1, 3], v1::MeshMode::Exact), "mesh.triangles[0]"),
        (mesh(vec![0, 1, 2], v1::MeshMode::Solid), "mesh"),
        (mesh(vec![0, 1, 2], v1::MeshMode::Unspecified), "mesh.mode"),
        (compound(sphere(-1.0)), "compound.parts[1].shape.sphere.radius"),
        (compound(shape(compound(sphere(1.0)))), "compound.parts[1].shape"),
        (Core::Compound(v1::Compound { parts: Vec::new() }), "compound.parts"),
    ];
    let bad = |(core, field)| (add("bad", shape(core), at(0.0, 0.0, 0.0)), field);
    let fields: Vec<String> = cases.iter().map(|(_, field)| format!("edits[1].add_body.shape.{field}")).collect();
    let edits = cases.into_iter().map(bad).zip(&fields).map(|((edit, _), field)| (edit, field.as_str())).collect();
    check_edits(door, edits).await;
}

async fn poses_that_cannot_be_are_refused_by_field(door: &impl Door) {
    let turned = |w: f64| v1::Pose { translation: None, rotation: Some(v1::Quaternion { w, x: 0.0, y: 0.0, z: 0.0 }) };
    let cases = vec![
        (add("bad", sphere(1.0), at(f64::NAN, 0.0, 0.0)), "edits[1].add_body.pose.translation"),
        (add("bad", sphere(1.0), at(0.0, f64::INFINITY, 0.0)), "edits[1].add_body.pose.translation"),
        (add("bad", sphere(1.0), turned(0.0)), "edits[1].add_body.pose.rotation"),
        (add("bad", sphere(1.0), turned(f64::NAN)), "edits[1].add_body.pose.rotation"),
        (move_to(named("good"), turned(0.0)), "edits[1].move_body.pose.rotation"),
    ];
    check_edits(door, cases).await;
}

async fn edits_that_say_too_little_are_refused_by_field(door: &impl Door) {
    use v1::edit::Kind;
    let move_nothing = Kind::MoveBody(v1::MoveBody { body: None, pose: Some(at(0.0, 0.0, 0.0)) });
    let move_nowhere = Kind::MoveBody(v1::MoveBody { body: Some(named("good")), pose: None });
    let no_shape = Kind::AddBody(v1::AddBody { name: "bad".to_owned(), ..v1::AddBody::default() });
    let no_party = Kind::SetAllowedCollision(v1::SetAllowedCollision { a: None, b: None, allowed: Some(true) });
    let party = Some(v1::Party { kind: Some(v1::party::Kind::Everything(v1::Everything {})) });
    let negative = Kind::SetPairMargin(v1::SetPairMargin { a: party.clone(), b: party, margin: Some(-1.0) });
    let cases = vec![
        (v1::Edit { kind: None }, "edits[1]"),
        (edit(move_nothing), "edits[1].move_body.body"),
        (edit(move_nowhere), "edits[1].move_body.pose"),
        (edit(no_shape), "edits[1].add_body.shape"),
        (edit(no_party), "edits[1].set_allowed_collision.a"),
        (edit(negative), "edits[1].margin"),
        (add("", sphere(1.0), at(0.0, 0.0, 0.0)), "edits[1].name"),
    ];
    check_edits(door, cases).await;
}

async fn contexts_that_cannot_be_are_refused_by_field(door: &impl Door) {
    door.create_scene(SCENE).await.unwrap();
    let refusal = door.collide(v1::CollideRequest::default()).await.unwrap_err();
    assert_eq!((refusal.code, refusal.field.as_str()), (Code::InvalidArgument, "context"), "{refusal:?}");
    let accuracy = |absolute, relative| Some(v1::Accuracy { absolute, relative });
    let cases = [
        (v1::Context { margin: -1.0, ..context() }, "context.margin"),
        (v1::Context { margin: f64::NAN, ..context() }, "context.margin"),
        (v1::Context { cut_off: Some(-1.0), ..context() }, "context.cut_off"),
        (v1::Context { accuracy: accuracy(f64::NAN, 0.0), ..context() }, "context.accuracy.absolute"),
        (v1::Context { accuracy: accuracy(0.0, -1.0), ..context() }, "context.accuracy.relative"),
        (v1::Context { time_budget: Some(f64::NAN), ..context() }, "context.time_budget"),
        (v1::Context { time_budget: Some(-1.0), ..context() }, "context.time_budget"),
        (v1::Context { answer_form: 77, ..context() }, "context.answer_form"),
        (v1::Context { solver: 77, ..context() }, "context.solver"),
    ];
    for (context, field) in cases {
        let question = v1::DistanceRequest { context: Some(context), ..distance(vec![all_pairs()]) };
        let refusal = door.distance(question).await.expect_err(field);
        assert_eq!((refusal.code, refusal.field.as_str()), (Code::InvalidArgument, field), "{refusal:?}");
    }
    let question = v1::DistanceRequest { mode: 9, ..distance(vec![all_pairs()]) };
    assert_eq!(door.distance(question).await.unwrap_err().field, "mode");
    let empty = v1::Subject { kind: None };
    assert_eq!(door.distance(distance(vec![all_pairs(), empty])).await.unwrap_err().field, "items[1]");
    let bad = placed(cuboid(1.0, 1.0, f64::NAN), at(0.0, 0.0, 0.0));
    let refusal = door.distance(distance(vec![bad])).await.unwrap_err();
    assert_eq!(refusal.field, "items[0].shape.shape.box.half_extents.z");
}
