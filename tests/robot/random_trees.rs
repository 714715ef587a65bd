//! Forward kinematics of robots made at random, against products of 4x4 matrices.
//!
//! Reference: each joint's matrix written out from the URDF's numbers (rotations about x, y and z multiplied, Rodrigues'
//! formula for the axis), multiplied from the link up to the root. It shares nothing with the quaternions under test;
//! its own rounding grows with the depth of the tree, as does the bound.

use std::fmt::Write;

use clearance::geometry::{Pose, Quaternion, Vec3};
use clearance::robot::{JointKind, LinkGradient, RobotModel};
use nalgebra::{Matrix3, Matrix4};
use proptest::prelude::*;
use proptest::strategy::ValueTree;

use crate::arm::model;

/// A joint as it goes into the text, and into the reference.
#[derive(Clone, Debug)]
struct Written {
    kind: &'static str,
    parent: usize,
    xyz: [f64; 3],
    rpy: [f64; 3],
    axis: [f64; 3],
    /// Multiplier and offset, where it follows the latest joint before it that has a single position of its own.
    mimic: Option<[f64; 2]>,
    /// Its position, or pose for a floating one.
    position: [f64; 7],
}

fn written(index: usize) -> impl Strategy<Value = Written> {
    let kind = prop::sample::select(vec!["revolute", "continuous", "prismatic", "fixed", "floating"]);
    let vector = || prop::array::uniform3(-2.0..2.0f64);
    let axis = vector().prop_filter("has a direction", |a| Vec3::from(*a).norm() > 1e-3);
    let mimic = prop::option::weighted(0.3, prop::array::uniform2(-2.0..2.0f64));
    let position = prop::array::uniform7(-3.0..3.0f64)
        .prop_filter("has an orientation", |p| p[3..].iter().map(|c| c * c).sum::<f64>() > 1e-3);
    (kind, 0..=index, vector(), vector(), axis, mimic, position).prop_map(
        |(kind, parent, xyz, rpy, axis, mimic, position)| Written { kind, parent, xyz, rpy, axis, mimic, position },
    )
}

fn trees() -> impl Strategy<Value = Vec<Written>> {
    (1..14usize).prop_flat_map(|count| (0..count).map(written).collect::<Vec<_>>())
}

/// The URDF, links in reverse so that children come before their parents. Joint `i` moves link `i + 1`.
fn urdf(joints: &[Written]) -> String {
    let mut text = String::from("<robot name=\"random\">");
    for link in (0..=joints.len()).rev() {
        writeln!(text, "<link name=\"l{link}\"/>").unwrap();
    }
    for (i, joint) in joints.iter().enumerate() {
        let three = |v: [f64; 3]| format!("{} {} {}", v[0], v[1], v[2]);
        writeln!(text, "<joint name=\"j{i}\" type=\"{}\">", joint.kind).unwrap();
        writeln!(text, "<origin xyz=\"{}\" rpy=\"{}\"/>", three(joint.xyz), three(joint.rpy)).unwrap();
        writeln!(text, "<parent link=\"l{}\"/><child link=\"l{}\"/>", joint.parent, i + 1).unwrap();
        writeln!(text, "<axis xyz=\"{}\"/><limit lower=\"-1\" upper=\"1\"/>", three(joint.axis)).unwrap();
        if let Some((leader, [multiplier, offset])) = leader(joints, i) {
            writeln!(text, "<mimic joint=\"j{leader}\" multiplier=\"{multiplier}\" offset=\"{offset}\"/>").unwrap();
        }
        text.push_str("</joint>");
    }
    text + "</robot>"
}

fn has_single_position(joint: &Written) -> bool {
    !["fixed", "floating"].contains(&joint.kind)
}

/// Whom joint `i` mimics: possibly a joint that mimics another.
fn leader(joints: &[Written], i: usize) -> Option<(usize, [f64; 2])> {
    let line = joints[i].mimic.filter(|_| has_single_position(&joints[i]))?;
    (0..i).rev().find(|&k| has_single_position(&joints[k])).map(|k| (k, line))
}

fn single_position(joints: &[Written], i: usize) -> f64 {
    match leader(joints, i) {
        Some((leader, [multiplier, offset])) => multiplier * single_position(joints, leader) + offset,
        None => joints[i].position[0],
    }
}

fn homogeneous(rotation: Matrix3<f64>, translation: Vec3) -> Matrix4<f64> {
    rotation.to_homogeneous().append_translation(&translation)
}

fn about(axis: Vec3, angle: f64) -> Matrix3<f64> {
    let (sin, cos) = libm::sincos(angle);
    let k = axis.normalize().cross_matrix();
    Matrix3::identity() + k * sin + k * k * (1.0 - cos)
}

fn joint_matrix(joints: &[Written], i: usize) -> Matrix4<f64> {
    let joint = &joints[i];
    let [roll, pitch, yaw] = joint.rpy;
    let rotation = about(Vec3::z(), yaw) * about(Vec3::y(), pitch) * about(Vec3::x(), roll);
    let axis = Vec3::from(joint.axis);
    let motion = match joint.kind {
        "fixed" => Matrix4::identity(),
        "prismatic" => homogeneous(Matrix3::identity(), axis.normalize() * single_position(joints, i)),
        "floating" => {
            let [x, y, z, qx, qy, qz, qw] = joint.position;
            let unit = nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(qw, qx, qy, qz));
            homogeneous(unit.to_rotation_matrix().into_inner(), Vec3::new(x, y, z))
        }
        _ => homogeneous(about(axis, single_position(joints, i)), Vec3::zeros()),
    };
    homogeneous(rotation, Vec3::from(joint.xyz)) * motion
}

fn positions(joints: &[Written], model: &RobotModel) -> Vec<f64> {
    let mut positions = Vec::new();
    for joint in model.joints() {
        let index: usize = joint.name[1..].parse().unwrap();
        assert_eq!(joint.first, positions.len());
        positions.extend(&joints[index].position[..joint.kind.width()]);
    }
    positions
}

proptest! {
    #[test]
    fn link_poses_agree_with_products_of_matrices(joints in trees(), turn in prop::array::uniform3(-3.0..3.0f64)) {
        let model = model(&urdf(&joints), None).unwrap();
        let moving: Vec<usize> =
            (0..joints.len()).filter(|&i| joints[i].kind != "fixed" && leader(&joints, i).is_none()).collect();
        let names: Vec<String> = moving.iter().map(|i| format!("j{i}")).collect();
        prop_assert!(model.joints().iter().map(|j| &j.name).eq(&names));
        let positions = positions(&joints, &model);
        prop_assert_eq!(positions.len(), model.degrees_of_freedom());
        prop_assert_eq!(model.check_positions(&positions), Ok(()));
        let rotation = Quaternion::from_roll_pitch_yaw(turn[0], turn[1], turn[2]);
        let base = Pose::new(Vec3::new(turn[2], 0.5, turn[0]), rotation).unwrap();
        let mut poses = Vec::new();
        model.link_poses(&positions, &base, &mut poses);
        let mut expected = vec![homogeneous(base.placement().rotation, base.translation())];
        for (i, joint) in joints.iter().enumerate() {
            expected.push(expected[joint.parent] * joint_matrix(&joints, i));
        }
        for (i, expected) in expected.iter().enumerate() {
            let pose = poses[model.link(&format!("l{i}")).unwrap() as usize];
            let found = homogeneous(pose.placement().rotation, pose.translation());
            let reach = 1.0 + 16.0 * joints.len() as f64;
            prop_assert!((found - expected).amax() <= 4e-16 * reach * joints.len() as f64, "{}", found - expected);
            let q = pose.rotation();
            let square = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
            prop_assert!((0.25..=4.0).contains(&square));
        }
    }
}

/// The generator has to reach what it is for.
#[test]
fn random_trees_reach_every_kind_of_joint_and_mimics_of_mimics() {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let (mut floating, mut mimics_of_mimics, mut deepest) = (0, 0, 0);
    for _ in 0..200 {
        let joints = trees().new_tree(&mut runner).unwrap().current();
        let model = model(&urdf(&joints), None).unwrap();
        floating += model.joints().iter().filter(|joint| joint.kind == JointKind::Floating).count();
        let follows_follower = |i: usize| leader(&joints, i).is_some_and(|(l, _)| leader(&joints, l).is_some());
        mimics_of_mimics += (0..joints.len()).filter(|&i| follows_follower(i)).count();
        let depth = |mut link: usize| {
            let mut depth = 0;
            while link > 0 {
                link = joints[link - 1].parent;
                depth += 1;
            }
            depth
        };
        deepest = deepest.max((0..=joints.len()).map(depth).max().unwrap());
    }
    assert!(floating > 50 && mimics_of_mimics > 20 && deepest > 4, "{floating} {mimics_of_mimics} {deepest}");
}

#[test]
fn urdf_rs_reads_the_same_numbers() {
    let text = include_str!("../data/robot-ur5/ur5.urdf");
    let theirs = urdf_rs::read_from_string(text).unwrap();
    let stripped = text.replace("<mesh filename=\"", "<sphere radius=\"1\" was=\"");
    let ours = model(&stripped, None).unwrap();
    assert!(ours.links().iter().map(|link| &link.name).eq(theirs.links.iter().map(|link| &link.name)));
    let actuated = || theirs.joints.iter().filter(|joint| joint.joint_type != urdf_rs::JointType::Fixed);
    assert!(ours.joints().iter().map(|joint| &joint.name).eq(actuated().map(|joint| &joint.name)));
    for (ours, theirs) in ours.joints().iter().zip(actuated()) {
        let limits = ours.limits.unwrap();
        assert_eq!((limits.lower, limits.upper), (theirs.limit.lower, theirs.limit.upper));
    }
}

/// A point that a link holds, in the link's frame.
type HeldPoint = (u32, Vec3);

fn place_of(poses: &[Pose], (link, point): HeldPoint) -> Vec3 {
    poses[link as usize].placement().point(point)
}

/// Of the height of a held point along a fixed direction: the point moves like the link, and about its origin.
fn gradient_of_height(poses: &[Pose], held: HeldPoint, along: Vec3) -> LinkGradient {
    let turning = (place_of(poses, held) - poses[held.0 as usize].translation()).cross(&along);
    LinkGradient { link: held.0, twist: [along.x, along.y, along.z, turning.x, turning.y, turning.z] }
}

proptest! {
    /// Reference: central differences of forward kinematics, in every number of the vector: floating joints, slides, mimics of mimics. The distance
    /// of two points that two links hold, and the height of one of them.
    #[test]
    fn joint_gradients_agree_with_differences(
        joints in trees(),
        turn in prop::array::uniform3(-3.0..3.0f64),
        points in prop::array::uniform2(prop::array::uniform3(-2.0..2.0f64)),
        chosen in prop::array::uniform2(any::<prop::sample::Index>()),
    ) {
        let model = model(&urdf(&joints), None).unwrap();
        let positions = positions(&joints, &model);
        let base = Pose::new(Vec3::from(turn), Quaternion::from_roll_pitch_yaw(turn[1], turn[2], turn[0])).unwrap();
        let [one, two] = [0, 1].map(|i| (chosen[i].index(joints.len() + 1) as u32, Vec3::from(points[i])));
        let poses_at = |positions: &[f64]| {
            let mut poses = Vec::new();
            model.link_poses(positions, &base, &mut poses);
            poses
        };
        let up = Vec3::new(0.6, 0.0, -0.8);
        let distance = |poses: &[Pose]| (place_of(poses, two) - place_of(poses, one)).norm();
        let height = |poses: &[Pose]| place_of(poses, one).dot(&up);
        let poses = poses_at(&positions);
        prop_assume!(distance(&poses) > 0.3);
        let normal = (place_of(&poses, two) - place_of(&poses, one)).normalize();
        let apart = [gradient_of_height(&poses, one, -normal), gradient_of_height(&poses, two, normal)];
        let of_distance = model.joint_gradient(&positions, &poses, &apart[0], Some(&apart[1]));
        let of_height = model.joint_gradient(&positions, &poses, &gradient_of_height(&poses, one, up), None);
        prop_assert_eq!(model.joint_gradient(&positions, &poses, &apart[1], Some(&apart[0])), &*of_distance);
        if one.0 == two.0 {
            prop_assert!(of_distance.iter().all(|g| *g == 0.0), "one body");
        }
        // A short quaternion turns most, and differences see how that bends.
        let norm = |first: usize| positions[first + 3..first + 7].iter().map(|c| c * c).sum::<f64>().sqrt();
        let floating = model.joints().iter().filter(|joint| joint.kind == JointKind::Floating);
        let short = floating.map(|joint| norm(joint.first)).fold(1.0, f64::min);
        let reach = 1.0 + 16.0 * joints.len() as f64;
        let (step, tolerance) = (1e-5 * short, 1e-8 * reach * reach / short);
        for i in 0..positions.len() {
            let beside = [-step, step].map(|by| {
                let mut there = positions.clone();
                there[i] += by;
                poses_at(&there)
            });
            for (number, gradient) in [(&distance as &dyn Fn(&[Pose]) -> f64, &of_distance), (&height, &of_height)] {
                let difference = (number(&beside[1]) - number(&beside[0])) / (2.0 * step);
                let error = (gradient[i] - difference).abs();
                prop_assert!(error <= tolerance, "{}: {} and not {}", i, gradient[i], difference);
            }
        }
    }
}
