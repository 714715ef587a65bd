//! Robots.

use super::count;
use crate::robot::{ExcludedPair, Group, Joint, JointKind, Link, MeshUse, RobotModel};
use crate::service::{LoadedRobot, RobotDescription};
use crate::transports::wire::v1;

/// Everything known of a model.
#[must_use]
pub fn robot_model(robot: &LoadedRobot) -> v1::RobotModel {
    let model = &robot.model;
    v1::RobotModel {
        id: robot.id.clone(),
        name: model.name().to_owned(),
        degrees_of_freedom: count(model.degrees_of_freedom()),
        joints: model.joints().iter().map(joint).collect(),
        links: model.links().iter().map(link).collect(),
        root: model.root(),
        self_pairs: model.self_pairs().iter().map(|&(a, b)| v1::LinkPair { a, b }).collect(),
        excluded_pairs: model.excluded_pairs().iter().map(excluded_pair).collect(),
        groups: model.groups().iter().enumerate().map(|(index, group)| joint_group(model, index, group)).collect(),
    }
}

/// A model in short.
#[must_use]
pub fn robot_summary(robot: &LoadedRobot) -> v1::RobotSummary {
    v1::RobotSummary { id: robot.id.clone(), name: robot.model.name().to_owned() }
}

fn joint(joint: &Joint) -> v1::Joint {
    let kind = match joint.kind {
        JointKind::Revolute => v1::JointKind::Revolute,
        JointKind::Continuous => v1::JointKind::Continuous,
        JointKind::Prismatic => v1::JointKind::Prismatic,
        JointKind::Floating => v1::JointKind::Floating,
    };
    v1::Joint {
        name: joint.name.clone(),
        kind: kind.into(),
        first: count(joint.first),
        width: count(joint.kind.width()),
        lower: joint.limits.map(|limits| limits.lower),
        upper: joint.limits.map(|limits| limits.upper),
        parent: joint.parent,
        child: joint.child,
    }
}

fn link(link: &Link) -> v1::Link {
    v1::Link { name: link.name.clone(), shapes: count(link.shapes.len()) }
}

fn excluded_pair(pair: &ExcludedPair) -> v1::ExcludedPair {
    v1::ExcludedPair { a: pair.links.0, b: pair.links.1, reason: pair.reason.to_string() }
}

fn joint_group(model: &RobotModel, index: usize, group: &Group) -> v1::JointGroup {
    let positions =
        |(joint, values): &(usize, Vec<f64>)| v1::JointPositions { joint: count(*joint), values: values.clone() };
    let own = model.group_states().iter().filter(|state| state.group == index);
    let states = own.map(|state| v1::NamedState {
        name: state.name.clone(),
        positions: state.positions.iter().map(positions).collect(),
    });
    v1::JointGroup {
        name: group.name.clone(),
        joints: group.joints.iter().copied().map(count).collect(),
        links: group.links.clone(),
        states: states.collect(),
    }
}

/// A robot's description.
#[must_use]
pub fn load_robot_request(description: &RobotDescription) -> v1::LoadRobotRequest {
    let RobotDescription { urdf, srdf, meshes, options } = description;
    let binding = |(filename, hash): (&String, &crate::service::ContentHash)| v1::MeshBinding {
        filename: filename.clone(),
        sha256: hash.to_string(),
    };
    let links = options.links.iter().map(|(link, own)| v1::LinkOptions {
        link: link.clone(),
        mesh_mode: own.mesh.map_or(v1::MeshMode::Unspecified, mesh_mode).into(),
        scale: own.scale,
        padding: own.padding,
    });
    v1::LoadRobotRequest {
        urdf: urdf.clone(),
        srdf: srdf.clone(),
        meshes: meshes.iter().map(binding).collect(),
        mesh_mode: mesh_mode(options.all.mesh).into(),
        padding: options.all.padding,
        scale: Some(options.all.scale),
        links: links.collect(),
    }
}

fn mesh_mode(mode: MeshUse) -> v1::MeshMode {
    match mode {
        MeshUse::Exact => v1::MeshMode::Exact,
        MeshUse::Solid => v1::MeshMode::Solid,
        MeshUse::Hull => v1::MeshMode::Hull,
        MeshUse::Decompose => v1::MeshMode::Decompose,
    }
}
