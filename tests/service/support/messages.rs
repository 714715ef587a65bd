//! Short words for long messages.

use clearance::service::ContentHash;
use clearance::transports::wire::v1;

pub const SCENE: &str = "cell";

pub fn vec3(x: f64, y: f64, z: f64) -> v1::Vec3 {
    v1::Vec3 { x, y, z }
}

/// The pose of a body that is not turned.
pub fn at(x: f64, y: f64, z: f64) -> v1::Pose {
    v1::Pose { translation: Some(vec3(x, y, z)), rotation: None }
}

pub fn shape(core: v1::shape::Core) -> v1::Shape {
    v1::Shape { swept_radius: 0.0, core: Some(core) }
}

pub fn sphere(radius: f64) -> v1::Shape {
    shape(v1::shape::Core::Sphere(v1::Sphere { radius }))
}

pub fn cuboid(x: f64, y: f64, z: f64) -> v1::Shape {
    shape(v1::shape::Core::Box(v1::Box { half_extents: Some(vec3(x, y, z)) }))
}

pub fn edit(kind: v1::edit::Kind) -> v1::Edit {
    v1::Edit { kind: Some(kind) }
}

pub fn add(name: &str, shape: v1::Shape, pose: v1::Pose) -> v1::Edit {
    edit(v1::edit::Kind::AddBody(v1::AddBody {
        name: name.to_owned(),
        shape: Some(shape),
        pose: Some(pose),
        ..v1::AddBody::default()
    }))
}

pub fn named(name: &str) -> v1::BodyRef {
    v1::BodyRef { by: Some(v1::body_ref::By::Name(name.to_owned())) }
}

pub fn numbered(id: u64) -> v1::BodyRef {
    v1::BodyRef { by: Some(v1::body_ref::By::Id(id)) }
}

pub fn remove(body: v1::BodyRef) -> v1::Edit {
    edit(v1::edit::Kind::RemoveBody(v1::RemoveBody { body: Some(body) }))
}

pub fn move_to(body: v1::BodyRef, pose: v1::Pose) -> v1::Edit {
    edit(v1::edit::Kind::MoveBody(v1::MoveBody { body: Some(body), pose: Some(pose) }))
}

pub fn apply(edits: Vec<v1::Edit>) -> v1::ApplyRequest {
    v1::ApplyRequest { scene: SCENE.to_owned(), edits, ..v1::ApplyRequest::default() }
}

pub fn context() -> v1::Context {
    v1::Context { scene: SCENE.to_owned(), ..v1::Context::default() }
}

pub fn asked_of(rule: v1::revision_rule::Rule) -> v1::Context {
    v1::Context { revision: Some(v1::RevisionRule { epoch: None, rule: Some(rule) }), ..context() }
}

pub fn body(body: v1::BodyRef) -> v1::Subject {
    v1::Subject { kind: Some(v1::subject::Kind::Body(body)) }
}

pub fn placed(shape: v1::Shape, pose: v1::Pose) -> v1::Subject {
    let placed = v1::PlacedShape { shape: Some(shape), pose: Some(pose) };
    v1::Subject { kind: Some(v1::subject::Kind::Shape(placed)) }
}

pub fn all_pairs() -> v1::Subject {
    v1::Subject { kind: Some(v1::subject::Kind::AllPairs(v1::AllPairs {})) }
}

pub fn changed_since(revision: u64) -> v1::Subject {
    v1::Subject { kind: Some(v1::subject::Kind::ChangedSince(v1::ChangedSince { revision })) }
}

pub fn watch() -> v1::WatchContactsRequest {
    v1::WatchContactsRequest { context: Some(context()), threshold: 0, stays: false }
}

pub fn collide(items: Vec<v1::Subject>) -> v1::CollideRequest {
    v1::CollideRequest { context: Some(context()), items, mode: 0 }
}

/// Balls that all overlap: 1770 pairs.
pub fn heap() -> v1::ApplyRequest {
    apply((0..60).map(|i| add(&format!("ball{i}"), sphere(1.0), at(0.0, 0.0, 0.0))).collect())
}

/// Lists all pairs of a heap again and again: some 50 kB an item.
pub fn heap_listed(items: usize) -> v1::CollideRequest {
    let wants = Some(v1::Wants { pairs: true, ..v1::Wants::default() });
    v1::CollideRequest {
        context: Some(v1::Context { wants, max_pairs: Some(10_000), ..context() }),
        ..collide(vec![all_pairs(); items])
    }
}

pub fn distance(items: Vec<v1::Subject>) -> v1::DistanceRequest {
    v1::DistanceRequest { context: Some(context()), items, mode: 0 }
}

/// Joint positions of the robot "arm".
pub fn states(positions: Vec<f64>) -> v1::CheckStatesRequest {
    let packed = v1::doubles::Form::Packed(v1::PackedDoubles { values: positions });
    v1::CheckStatesRequest {
        context: Some(context()),
        robot: "arm".to_owned(),
        positions: Some(v1::Doubles { form: Some(packed) }),
        mode: 0,
    }
}

/// A rod of 1 m length along x that turns about z at the origin, with a ball at its end that a slide moves along z.
pub const ROBOT: &str = r#"<robot name="crane">
  <link name="foot"/>
  <link name="boom"><collision><origin xyz="0.5 0 0"/><geometry><box size="1 0.1 0.1"/></geometry></collision></link>
  <link name="hook"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <joint name="turn" type="revolute"><parent link="foot"/><child link="boom"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" velocity="1" effort="1"/></joint>
  <joint name="lower" type="prismatic"><parent link="boom"/><child link="hook"/><origin xyz="1 0 0"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="0" velocity="1" effort="1"/></joint>
</robot>"#;

pub fn load(urdf: &str) -> v1::LoadRobotRequest {
    v1::LoadRobotRequest { urdf: urdf.to_owned(), ..v1::LoadRobotRequest::default() }
}

/// A robot that is one link, whose shape is the hull of a mesh file.
pub fn load_with_mesh(sha256: &str) -> v1::LoadRobotRequest {
    let geometry = "<geometry><mesh filename='corner.obj'/></geometry>";
    let urdf = format!("<robot name='r'><link name='a'><collision>{geometry}</collision></link></robot>");
    let mesh = v1::MeshBinding { filename: "corner.obj".to_owned(), sha256: sha256.to_owned() };
    v1::LoadRobotRequest { meshes: vec![mesh], mesh_mode: v1::MeshMode::Hull.into(), ..load(&urdf) }
}

pub fn add_robot(name: &str, model: &str) -> v1::Edit {
    edit(v1::edit::Kind::AddRobot(v1::AddRobot { name: name.to_owned(), model: model.to_owned(), base: None }))
}

/// A tetrahedron with its corners at the origin and 1 m along each axis, as OBJ.
pub const TETRAHEDRON: &[u8] = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

pub fn announced(bytes: &[u8]) -> v1::AssetHeader {
    v1::AssetHeader { sha256: ContentHash::of(bytes).to_string(), bytes: bytes.len() as u64 }
}

pub fn mesh_asset(sha256: String, mode: v1::MeshMode) -> v1::Shape {
    let format = v1::MeshFormat::Obj.into();
    shape(v1::shape::Core::MeshAsset(v1::MeshAsset { sha256, format, mode: mode.into(), scale: None }))
}

pub fn verdicts(answer: &v1::Answer) -> Vec<v1::Verdict> {
    answer.items.iter().map(v1::ItemAnswer::verdict).collect()
}

/// Contexts with something that only some questions take, and the field it is in.
pub fn with_overlays() -> [(&'static str, v1::Context); 3] {
    [
        ("context.overlay", v1::Context { overlay: Some(v1::Overlay::default()), ..context() }),
        ("context.alternatives", v1::Context { alternatives: vec![v1::Overlay::default()], ..context() }),
        ("context.item_alternatives", v1::Context { item_alternatives: vec![0], ..context() }),
    ]
}
