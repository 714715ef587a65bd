//! The scene against what it should hold. Here is what the tests have in common: small bodies, a small robot, and edits
//! that must be accepted.

mod changes;
mod declared;
mod entries;
mod history;
mod memory;
mod model;
mod random_edits;
mod refusals;
mod voxels;

use std::sync::Arc;

use super::*;
use crate::geometry::{Pose, Quaternion, Shape, Vec3};
use crate::robot::{ModelOptions, RobotModel};

fn at(x: f64) -> Pose {
    Pose::new(Vec3::new(x, 0.0, 0.0), Quaternion::IDENTITY).unwrap()
}

fn ball(name: &str, x: f64) -> NewBody {
    NewBody::new(name, Arc::new(Shape::sphere(0.5).unwrap()), at(x))
}

fn grouped(name: &str, groups: &[&str]) -> NewBody {
    NewBody { groups: groups.iter().map(|group| (*group).to_owned()).collect(), ..ball(name, 0.0) }
}

fn floor(name: &str) -> NewBody {
    NewBody::new(name, Arc::new(Shape::half_space(Vec3::z(), 0.0).unwrap()), Pose::identity())
}

/// A chain of the links `base`, `upper`, `lower`: the outer two are held against each other, neighbours are not.
fn arm() -> Arc<RobotModel> {
    let link = |name: &str| {
        let ball = "<geometry><sphere radius='0.1'/></geometry>";
        format!("<link name='{name}'><collision>{ball}</collision></link>")
    };
    let joint = |name: &str, parent: &str, child: &str| {
        format!(
            "<joint name='{name}' type='continuous'><origin xyz='0 0 0.3'/><axis xyz='1 0 0'/>\
             <parent link='{parent}'/><child link='{child}'/></joint>"
        )
    };
    let (links, joints) = (
        ["base", "upper", "lower"].map(link).concat(),
        joint("shoulder", "base", "upper") + &joint("elbow", "upper", "lower"),
    );
    let urdf = format!("<robot name='arm'>{links}{joints}</robot>");
    let model = RobotModel::from_urdf(&urdf, None, &mut |_| Err("no meshes".to_owned()), &ModelOptions::default());
    Arc::new(model.unwrap())
}

fn add_arm(name: &str, model: &Arc<RobotModel>) -> Edit {
    Edit::AddRobot { name: name.to_owned(), model: Arc::clone(model), base: Pose::identity() }
}

/// Applies edits that must be accepted, and looks at the result as a whole.
fn apply(scene: &mut Scene, edits: &[Edit]) -> Applied {
    let applied = scene.apply(edits, None).unwrap();
    assert_eq!(scene.snapshot().validate(), Ok(()));
    assert_eq!(scene.snapshot().revision(), applied.revision);
    applied
}

fn scene_of(bodies: impl IntoIterator<Item = NewBody>) -> Scene {
    let mut scene = Scene::new(Epoch(7));
    apply(&mut scene, &bodies.into_iter().map(Edit::AddBody).collect::<Vec<_>>());
    scene
}

fn one(name: &str) -> Party {
    Party::Body(name.into())
}

fn group(name: &str) -> Party {
    Party::Group(name.to_owned())
}

fn link(robot: &str, link: &str) -> Party {
    Party::Link { robot: robot.to_owned(), link: link.to_owned() }
}

fn allow(a: Party, b: Party, allowed: Option<bool>) -> Edit {
    Edit::SetAllowedCollision { a, b, allowed }
}

fn margin(a: Party, b: Party, margin: Option<f64>) -> Edit {
    Edit::SetPairMargin { a, b, margin }
}

fn declare(a: Party, b: Party, effects: Option<Effects>) -> Edit {
    Edit::DeclareEffects { a, b, effects }
}

fn admits(scene: &Scene, a: &str, b: &str) -> bool {
    let snapshot = scene.snapshot();
    let (a, b) = (snapshot.body_named(a).unwrap(), snapshot.body_named(b).unwrap());
    assert_eq!(snapshot.admits(a, b), snapshot.admits(b, a));
    snapshot.admits(a, b)
}
