//! What is asked of every client: each question of the surface, in each of its forms, and some that are refused.

#![allow(clippy::approx_constant, reason = "states as people write them down")]

use std::path::Path;

use clearance::service::ContentHash;
use clearance::transports::wire::v1;
use prost::Message;

use crate::messages::*;

/// One call that is to be recorded.
pub enum Call {
    Asset(String),
    Ask(&'static str, Vec<u8>),
    Stream(Vec<Vec<u8>>),
}

fn ask(method: &'static str, request: impl Message) -> Call {
    Call::Ask(method, request.encode_to_vec())
}

const UR5: &str = "tests/data/robot-ur5";
/// Free, against the post, against itself, and beyond its limits.
const STATES: [[f64; 6]; 4] = [
    [-1.6, -0.6, 0.0, -1.57, -1.57, 3.14],
    [-1.2, -0.6, 0.0, -1.57, -1.57, 3.14],
    [0.0, -0.6, 2.9, -1.57, -1.57, 3.14],
    [9.0, -0.6, 0.0, -1.57, -1.57, 3.14],
];

/// Everything else, once the robot has its id.
pub fn calls(model: &str) -> Vec<Call> {
    let mut calls = scene(model);
    calls.extend(of_robots());
    calls.extend(of_bodies());
    calls.extend(of_casts());
    calls.extend(refused());
    calls.push(stream());
    calls.extend(declared());
    calls
}

/// What the scene declares, and what that leaves out and refuses.
fn declared() -> Vec<Call> {
    let party = |kind| Some(v1::Party { kind: Some(kind) });
    let declare = |a, b, effects: &[v1::Effect]| {
        let effects = Some(v1::Effects { effects: effects.iter().map(|effect| i32::from(*effect)).collect() });
        edit(v1::edit::Kind::DeclareEffects(v1::DeclareEffects { a: party(a), b: party(b), effects }))
    };
    let body = |name| v1::party::Kind::Body(named(name));
    let edits = vec![
        declare(v1::party::Kind::Robot("arm".to_owned()), body("table"), &[]),
        declare(body("wedge"), v1::party::Kind::Everything(v1::Everything {}), &[v1::Effect::Witness]),
    ];
    let depth = wanting(true, false, true, false);
    vec![
        ask("Scenes/Apply", apply(edits)),
        ask("Queries/CheckStates", of_states(&STATES[..1], wanting(true, true, false, false))),
        ask("Queries/CheckStates", of_states(&STATES[..1], depth)),
    ]
}

/// Uploads and loads the robot; the answer to the last call has its id.
pub fn robot() -> Vec<Call> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(UR5);
    let text = |name| std::fs::read_to_string(folder.join(name)).unwrap();
    let mut names: Vec<String> = std::fs::read_dir(folder.join("meshes"))
        .unwrap()
        .map(|file| file.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    let sha256 = |name: &String| ContentHash::of(&std::fs::read(folder.join("meshes").join(name)).unwrap()).to_string();
    let meshes = names
        .iter()
        .map(|name| v1::MeshBinding { filename: format!("package://ur5/meshes/{name}"), sha256: sha256(name) });
    let request = v1::LoadRobotRequest {
        srdf: Some(text("ur5.srdf")),
        meshes: meshes.collect(),
        mesh_mode: v1::MeshMode::Hull.into(),
        ..load(&text("ur5.urdf"))
    };
    let mut calls: Vec<Call> = names.iter().map(|name| Call::Asset(format!("{UR5}/meshes/{name}"))).collect();
    let hashes = names.iter().map(sha256).chain([ContentHash::of(b"nobody has this").to_string()]).collect();
    calls.push(ask("Assets/HasAssets", v1::HasAssetsRequest { sha256: hashes }));
    calls.push(ask("Robots/LoadRobot", request));
    calls
}

fn turned(x: f64, y: f64, z: f64, rotation: [f64; 4]) -> v1::Pose {
    let [w, i, j, k] = rotation;
    v1::Pose { rotation: Some(v1::Quaternion { w, x: i, y: j, z: k }), ..at(x, y, z) }
}

fn scene(model: &str) -> Vec<Call> {
    use v1::shape::Core;
    let ellipsoid = shape(Core::Ellipsoid(v1::Ellipsoid { radii: Some(vec3(0.3, 0.2, 0.1)) }));
    let capsule = shape(Core::Capsule(v1::Capsule { radius: 0.05, half_length: 0.3 }));
    let cone = v1::Shape { swept_radius: 0.01, ..shape(Core::Cone(v1::Cone { radius: 0.2, half_length: 0.3 })) };
    let corners = [[0.0, 0.0, 0.0], [0.4, 0.0, 0.0], [0.0, 0.4, 0.0], [0.0, 0.0, 0.4]];
    let vertices: Vec<v1::Vec3> = corners.iter().map(|[x, y, z]| vec3(*x, *y, *z)).collect();
    let triangles = vec![0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2];
    let mesh = shape(Core::Mesh(v1::Mesh { vertices, triangles, mode: v1::MeshMode::Solid.into() }));
    let ground = shape(Core::HalfSpace(v1::HalfSpace { normal: Some(vec3(0.0, 0.0, 1.0)), offset: -1.0 }));
    let party = |name| Some(v1::Party { kind: Some(v1::party::Kind::Body(named(name))) });
    let edits = vec![
        add_robot("arm", model),
        add("table", cuboid(1.0, 1.0, 0.02), at(0.0, 0.0, 0.7)),
        add("post", capsule, at(0.5, 0.3, 1.2)),
        add("ball", ellipsoid, turned(0.2, 0.8, 1.3, [0.8, 0.2, 0.4, 0.4])),
        add("cone", cone, turned(0.6, 0.9, 1.4, [1.0, 0.5, 0.0, 0.0])),
        add("wedge", mesh, at(-0.9, -0.4, 1.0)),
        add("ground", ground, at(0.0, 0.0, 0.0)),
    ];
    let margin = v1::SetPairMargin { a: party("ball"), b: party("cone"), margin: Some(0.5) };
    let later = vec![
        move_to(named("wedge"), turned(-0.9, -0.4, 1.1, [0.0, 0.0, 0.6, 0.8])),
        edit(v1::edit::Kind::SetPairMargin(margin)),
    ];
    vec![
        ask("Scenes/CreateScene", v1::CreateSceneRequest { name: SCENE.to_owned(), broad_phase: 0 }),
        ask("Scenes/Apply", apply(edits)),
        ask("Scenes/Apply", apply(later)),
        ask("Scenes/GetScene", v1::GetSceneRequest { scene: SCENE.to_owned(), ..v1::GetSceneRequest::default() }),
    ]
}

fn wanting(distance: bool, witness: bool, depth: bool, pairs: bool) -> v1::Context {
    v1::Context {
        wants: Some(v1::Wants { distance, witness, depth, pairs, patch: false, derivatives: false }),
        ..context()
    }
}

fn in_bulk(context: v1::Context) -> v1::Context {
    v1::Context { answer_form: v1::AnswerForm::Bulk.into(), ..context }
}

fn of_states(positions: &[[f64; 6]], context: v1::Context) -> v1::CheckStatesRequest {
    v1::CheckStatesRequest { context: Some(context), ..states(positions.concat()) }
}

fn doubles(numbers: &[f64]) -> Option<v1::Doubles> {
    let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
    Some(v1::Doubles { form: Some(v1::doubles::Form::LittleEndian(bytes.into())) })
}

fn of_robots() -> Vec<Call> {
    let everything = || v1::Context { margin: 0.05, ..wanting(true, true, true, true) };
    let held = v1::Overlay {
        edits: vec![move_to(named("post"), at(0.5, 2.0, 1.2)), add("cup", sphere(0.03), at(0.0, 0.0, 3.0))],
        attached: vec![v1::AttachBody {
            body: Some(named("cup")),
            link: Some(v1::LinkRef { robot: "arm".to_owned(), link: "wrist_3_link_0".to_owned() }),
            body_in_link: Some(at(0.0, 0.0, 0.2)),
            may_touch: vec!["fts_robotside_0".to_owned(), "robotiq_85_base_link_0".to_owned()],
        }],
    };
    let supposed = || v1::Context { overlay: Some(held.clone()), ..wanting(true, false, false, false) };
    let stop = |request| v1::CheckStatesRequest { mode: v1::Mode::StopAtFirst.into(), ..request };
    let edges = [STATES[0], STATES[1], STATES[0], [-1.59, -0.6, 0.0, -1.57, -1.57, 3.14]].concat();
    let motions = |context| v1::CheckMotionsRequest {
        context: Some(context),
        robot: "arm".to_owned(),
        positions: doubles(&edges),
        mode: 0,
        effort: None,
    };
    let effort = v1::MotionEffort { find: v1::Find::AnyContact.into(), resolution: Some(1e-3), max_states: Some(64) };
    let path = |context| v1::CheckPathRequest {
        context: Some(context),
        robot: "arm".to_owned(),
        waypoints: doubles(&[STATES[0], STATES[1], STATES[2]].concat()),
        mode: 0,
        effort: Some(effort),
    };
    let near = v1::ClearanceRequest {
        context: Some(wanting(true, true, false, false)),
        within: 0.2,
        mode: 0,
        subjects: Some(v1::clearance_request::Subjects::States(v1::RobotStates {
            robot: "arm".to_owned(),
            positions: doubles(&STATES[0]),
        })),
    };
    vec![
        ask("Queries/CheckStates", of_states(&STATES, context())),
        ask("Queries/CheckStates", of_states(&STATES, everything())),
        ask("Queries/CheckStates", of_states(&STATES, in_bulk(wanting(true, false, false, false)))),
        ask("Queries/CheckStates", stop(of_states(&STATES, in_bulk(context())))),
        ask("Queries/CheckStates", of_states(&STATES[..2], supposed())),
        ask("Queries/CheckStates", of_states(&STATES[..2], patches(0.05))),
        ask("Queries/CheckStates", of_states(&STATES[..2], derivatives(v1::DerivativeMethod::Unspecified))),
        ask("Queries/CheckMotions", motions(context())),
        ask("Queries/CheckMotions", motions(in_bulk(context()))),
        ask("Queries/CheckPath", path(context())),
        ask("Queries/Clearance", near),
    ]
}

fn of_bodies() -> Vec<Call> {
    let probe = placed(cuboid(0.1, 0.1, 0.1), turned(0.4, 0.4, 1.2, [1.0, 2.0, 3.0, 4.0]));
    let beside_ball = placed(sphere(0.05), at(0.1, 1.2, 1.2));
    let subjects = || vec![all_pairs(), body(named("ball")), probe.clone(), changed_since(1)];
    let asking = |context, items| v1::DistanceRequest { context: Some(context), ..distance(items) };
    let solver = |solver: v1::Solver| v1::Context { solver: solver.into(), ..wanting(true, true, true, false) };
    let filter = v1::Filter { ignore: vec![named("post")], ..v1::Filter::default() };
    let filtered = v1::Context { filter: Some(filter), max_pairs: Some(1), margin: 0.6, ..context() };
    let near = v1::ClearanceRequest {
        context: Some(context()),
        within: 0.5,
        mode: 0,
        subjects: Some(v1::clearance_request::Subjects::Items(v1::ClearanceSubjects { items: subjects() })),
    };
    vec![
        ask("Queries/Collide", collide(subjects())),
        ask("Queries/Collide", v1::CollideRequest { context: Some(filtered), ..collide(subjects()) }),
        ask("Queries/Distance", asking(wanting(true, true, true, false), subjects())),
        ask("Queries/Distance", asking(in_bulk(context()), subjects())),
        ask("Queries/Distance", asking(solver(v1::Solver::GjkNesterov), subjects())),
        ask("Queries/Distance", asking(solver(v1::Solver::Exact), vec![probe.clone()])),
        ask("Queries/Clearance", near),
        ask("Queries/Collide", v1::CollideRequest { context: Some(patches(0.6)), ..collide(subjects()) }),
        ask("Queries/Distance", asking(derivatives(v1::DerivativeMethod::Exact), subjects())),
        ask("Queries/Distance", asking(derivatives(v1::DerivativeMethod::Exact), vec![beside_ball])),
        ask("Queries/Distance", asking(derivatives(v1::DerivativeMethod::FiniteDifference), vec![probe.clone()])),
        ask("Queries/Distance", asking(derivatives(v1::DerivativeMethod::Smoothed0), vec![probe.clone()])),
        ask("Queries/Distance", asking(derivatives(v1::DerivativeMethod::Smoothed1Gaussian), vec![probe.clone()])),
        ask("Queries/Distance", asking(derivatives(v1::DerivativeMethod::Smoothed1Gumbel), vec![probe])),
    ]
}

/// Where faces touch, or are nearer than `margin`; no more than six points each.
fn patches(margin: f64) -> v1::Context {
    let wants = v1::Wants { pairs: true, patch: true, ..v1::Wants::default() };
    v1::Context { wants: Some(wants), margin, max_patch_points: Some(6), ..context() }
}

/// How the nearest pairs change when their bodies move.
fn derivatives(method: v1::DerivativeMethod) -> v1::Context {
    let wants = v1::Wants { depth: true, derivatives: true, ..v1::Wants::default() };
    let options =
        v1::DerivativeOptions { method: method.into(), epsilon: Some(0.05), samples: Some(8), seed: Some(1 << 40) };
    v1::Context { wants: Some(wants), derivatives: Some(options), ..context() }
}

fn of_casts() -> Vec<Call> {
    use v1::mover::{Moved, Way};
    use v1::region::Kind as Region;
    let rays = |mode: v1::CastMode| v1::CastRaysRequest {
        context: Some(context()),
        origins: doubles(&[0.5, 0.3, 3.0, 0.5, 0.3, 1.2, -3.0, 0.0, 1.0]),
        directions: doubles(&[0.0, 0.0, -1.0, 1.0, 0.0, 0.0, 1.0, 0.1, 0.0]),
        lengths: doubles(&[10.0]),
        mode: mode.into(),
    };
    let ball = v1::Mover {
        moved: Some(Moved::Shape(sphere(0.05))),
        start: Some(at(0.0, 0.3, 1.3)),
        way: Some(Way::To(at(1.0, 0.3, 1.3))),
    };
    let twist = v1::Twist { displacement: Some(vec3(0.5, 0.0, 0.0)), turn: Some(vec3(0.0, 0.0, 3.0)) };
    let wedge = v1::Mover { moved: Some(Moved::Body(named("wedge"))), start: None, way: Some(Way::By(twist)) };
    let shapes = v1::CastShapesRequest {
        context: Some(context()),
        items: vec![ball.clone(), wedge.clone()],
        mode: v1::CastMode::All.into(),
        resolution: None,
    };
    let pairs = v1::CheckMovingPairsRequest {
        context: Some(context()),
        items: vec![v1::MovingPair { a: Some(ball), b: Some(wedge) }],
        resolution: Some(1e-6),
    };
    let region = |kind| v1::Region { kind: Some(kind) };
    let regions = |bounds_only| v1::OverlapRequest {
        context: Some(context()),
        items: vec![
            region(Region::Box(v1::Aabb { min: Some(vec3(0.0, 0.0, 1.0)), max: Some(vec3(1.0, 1.0, 2.0)) })),
            region(Region::Ball(v1::RegionBall { center: Some(vec3(0.0, 0.0, 0.0)), radius: 0.75 })),
        ],
        bounds_only,
    };
    let nearest = v1::NearestBodiesRequest {
        context: Some(wanting(true, true, false, false)),
        items: vec![body(named("ball")), placed(sphere(0.1), at(0.0, 0.0, 2.0))],
        count: 3,
    };
    vec![
        ask("Queries/CastRays", rays(v1::CastMode::First)),
        ask("Queries/CastRays", rays(v1::CastMode::All)),
        ask("Queries/CastRays", rays(v1::CastMode::Any)),
        ask("Queries/CastShapes", shapes),
        ask("Queries/CheckMovingPairs", pairs),
        ask("Queries/Overlap", regions(false)),
        ask("Queries/Overlap", regions(true)),
        ask("Queries/NearestBodies", nearest),
    ]
}

fn refused() -> Vec<Call> {
    let elsewhere = v1::CollideRequest {
        context: Some(v1::Context { scene: "nowhere".to_owned(), ..context() }),
        ..collide(vec![all_pairs()])
    };
    let gone = v1::CollideRequest {
        context: Some(v1::Context { revision: Some(v1::RevisionRule { epoch: Some(7), rule: None }), ..context() }),
        ..collide(vec![all_pairs()])
    };
    let negative =
        vec![move_to(named("ball"), at(0.0, 0.0, 0.0)), add("flag", cuboid(1.0, -1.0, 0.1), at(0.0, 0.0, 0.0))];
    let not_a_number = v1::CollideRequest {
        context: Some(v1::Context { margin: f64::NAN, ..context() }),
        ..collide(vec![all_pairs()])
    };
    let no_samples = v1::Context {
        derivatives: Some(v1::DerivativeOptions { samples: Some(0), ..v1::DerivativeOptions::default() }),
        ..context()
    };
    let without_samples = v1::CollideRequest { context: Some(no_samples), ..collide(vec![all_pairs()]) };
    vec![
        ask("Scenes/CreateScene", v1::CreateSceneRequest { name: SCENE.to_owned(), broad_phase: 0 }),
        ask("Scenes/Apply", apply(negative)),
        ask("Scenes/Apply", apply(vec![remove(named("nobody"))])),
        ask("Scenes/Apply", v1::ApplyRequest { expected_revision: Some(0), ..apply(vec![remove(named("ball"))]) }),
        ask("Queries/Collide", elsewhere),
        ask("Queries/Collide", gone),
        ask("Queries/Collide", not_a_number),
        ask("Queries/Collide", without_samples),
        ask("Queries/CheckStates", states(vec![0.0; 5])),
    ]
}

fn stream() -> Call {
    use v1::query_stream_request::Question;
    let options = v1::QueryStreamOptions { in_order: true, max_in_flight: 4 };
    let questions = [
        Question::Options(options),
        Question::Collide(collide(vec![all_pairs()])),
        Question::CheckStates(of_states(&STATES[..2], in_bulk(wanting(true, false, false, false)))),
        Question::CheckStates(states(vec![0.0; 5])),
        Question::CheckStates(of_states(&STATES[..1], derivatives(v1::DerivativeMethod::Exact))),
        Question::Distance(distance(vec![body(named("post"))])),
    ];
    let numbered = questions.into_iter().zip(0..);
    Call::Stream(
        numbered
            .map(|(question, id)| v1::QueryStreamRequest { id, question: Some(question) }.encode_to_vec())
            .collect(),
    )
}
