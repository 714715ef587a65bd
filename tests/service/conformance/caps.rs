//! Caps: a request beyond one is refused with the cap's name, and changes nothing.

use clearance::limits::Limits;
use clearance::transports::wire::v1;
use tonic::Code;

use super::through_every_door;
use crate::support::door::{Door, Told};
use crate::support::messages::*;

through_every_door!(requests_beyond_a_cap_are_refused_by_its_name);

fn limits() -> Limits {
    Limits {
        max_items: 3,
        max_joint_values: 8,
        max_pairs: 50,
        max_scenes: 2,
        max_bodies: 2,
        max_edits: 4,
        max_hull_points: 4,
        max_mesh_triangles: 1,
        max_compound_parts: 1,
        max_name_bytes: 8,
        max_robot_models: 1,
        max_description_bytes: 2000,
        ..Limits::default()
    }
}

fn beyond<T>(cap: &str, told: Told<T>) {
    let Err(refusal) = told else { panic!("{cap}: the request passed") };
    assert_eq!((refusal.code, refusal.reason.as_str()), (Code::ResourceExhausted, "LIMIT_EXCEEDED"), "{refusal:?}");
    assert!(refusal.message.starts_with(&format!("{cap} exceeded")), "{refusal:?}");
}

async fn requests_beyond_a_cap_are_refused_by_its_name(door: &impl Door) {
    door.create_scene(SCENE).await.unwrap();
    beyond("max_name_bytes", door.create_scene("far too long").await);
    door.create_scene("second").await.unwrap();
    beyond("max_scenes", door.create_scene("third").await);

    beyond("max_items", door.collide(collide(vec![all_pairs(); 4])).await);
    let mut many_pairs = collide(vec![all_pairs()]);
    many_pairs.context.as_mut().unwrap().max_pairs = Some(51);
    beyond("max_pairs", door.collide(many_pairs).await);

    let ball = |name: &str| add(name, sphere(1.0), at(0.0, 0.0, 0.0));
    beyond("max_bodies", door.apply(apply(vec![ball("a"), ball("b"), ball("c")])).await);
    beyond("max_edits", door.apply(apply(vec![ball("a"); 5])).await);
    beyond("max_name_bytes", door.apply(apply(vec![ball("far too long")])).await);

    let points = vec![vec3(0.0, 0.0, 0.0); 5];
    let hull = v1::shape::Core::Convex(v1::Convex { points: points.clone() });
    let mode = v1::MeshMode::Exact.into();
    let mesh = v1::shape::Core::Mesh(v1::Mesh { vertices: points, triangles: vec![0, 1, 2, 2, 3, 4], mode });
    let part = v1::Part { shape: Some(sphere(1.0)), pose: None };
    let compound = v1::shape::Core::Compound(v1::Compound { parts: vec![part; 2] });
    for (cap, core) in [("max_hull_points", hull), ("max_mesh_triangles", mesh), ("max_compound_parts", compound)] {
        beyond(cap, door.apply(apply(vec![add("a", shape(core), at(0.0, 0.0, 0.0))])).await);
    }

    let stored = door.put_asset(announced(TETRAHEDRON), TETRAHEDRON).await.unwrap();
    beyond("max_mesh_triangles", door.load_robot(load_with_mesh(&stored.sha256)).await);
    let robot = door.load_robot(load(ROBOT)).await.unwrap();
    beyond("max_robot_models", door.load_robot(v1::LoadRobotRequest { padding: 0.1, ..load(ROBOT) }).await);
    beyond("max_description_bytes", door.load_robot(load(&" ".repeat(2001))).await);
    door.apply(apply(vec![add_robot("arm", &robot.id)])).await.unwrap();
    beyond("max_joint_values", door.check_states(states(vec![0.0; 10])).await);
    beyond("max_items", door.check_states(states(vec![0.0; 8])).await);
    let contents = v1::GetSceneRequest { scene: SCENE.to_owned(), ..v1::GetSceneRequest::default() };
    assert_eq!(door.get_scene(contents).await.unwrap().revision, 1);
}
