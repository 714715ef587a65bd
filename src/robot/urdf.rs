//! What does a URDF say? Its links and joints, each number checked, names not yet resolved.
//!
//! As in the format's description (wiki.ros.org/urdf/XML and its versions 1.1 and 1.2): angles of `rpy` about fixed axes,
//! default axis x, `capsule` and `quat_xyzw` accepted whatever version the file declares. What says nothing about where
//! collision shapes are (inertia, visuals, transmissions) is not read.

use roxmltree::Node;

use super::RobotError;
use super::attributes::{child, children, missing, name_of, number, number_or, numbers, parse, required, vector_or};
use super::joint::{JointKind, Limits};
use crate::geometry::tolerance::LARGEST_LENGTH;
use crate::geometry::{InvalidShape, Pose, Quaternion, Vec3};

/// A robot as written.
pub(super) struct Urdf {
    pub name: String,
    pub links: Vec<UrdfLink>,
    pub joints: Vec<UrdfJoint>,
}

pub(super) struct UrdfLink {
    pub name: String,
    pub collisions: Vec<Collision>,
}

/// A `<collision>` element.
pub(super) struct Collision {
    /// The shape's frame in the link's.
    pub origin: Pose,
    pub geometry: Geometry,
}

pub(super) enum Geometry {
    Box { size: Vec3 },
    Sphere { radius: f64 },
    Cylinder { radius: f64, length: f64 },
    Capsule { radius: f64, length: f64 },
    Mesh { filename: String, scale: Vec3 },
}

pub(super) struct UrdfJoint {
    pub name: String,
    /// `None` for a fixed one.
    pub kind: Option<JointKind>,
    pub parent: String,
    pub child: String,
    /// The joint's frame in the parent link's.
    pub origin: Pose,
    /// Of unit length, in the joint's frame.
    pub axis: Vec3,
    pub limits: Option<Limits>,
    pub mimic: Option<Mimic>,
}

/// Position = `multiplier` * position of `joint` + `offset`.
pub(super) struct Mimic {
    pub joint: String,
    pub multiplier: f64,
    pub offset: f64,
}

/// How a link or its n-th collision element is named in errors.
pub(super) fn collision_item(link: &str, ordinal: usize) -> String {
    format!("link {link:?}, collision {}", ordinal + 1)
}

impl Urdf {
    pub fn read(text: &str) -> Result<Self, RobotError> {
        let document = parse("URDF", text)?;
        let robot = document.root_element();
        let links = children(robot, "link").enumerate().map(|(i, node)| link(node, i)).collect::<Result<_, _>>()?;
        let open_ended = robot.attribute("version").is_some_and(omitted_limits_are_none);
        let joints = children(robot, "joint").enumerate();
        let joints = joints.map(|(i, node)| joint(node, i, open_ended)).collect::<Result<_, _>>()?;
        Ok(Self { name: robot.attribute("name").unwrap_or_default().to_owned(), links, joints })
    }
}

/// From version 1.2 on a bound that is left out means that there is none; before, it means zero.
fn omitted_limits_are_none(version: &str) -> bool {
    let parts = version.trim().split_once('.').map(|(major, minor)| (major.parse::<u32>(), minor.parse::<u32>()));
    matches!(parts, Some((Ok(major), Ok(minor))) if (major, minor) >= (1, 2))
}

fn link(node: Node, ordinal: usize) -> Result<UrdfLink, RobotError> {
    let name = name_of(node, "link", ordinal)?;
    let collision = |(i, node): (usize, Node)| {
        let item = collision_item(&name, i);
        Ok(Collision { origin: origin(node, &item)?, geometry: geometry(node, &item)? })
    };
    let collisions = children(node, "collision").enumerate().map(collision).collect::<Result<_, RobotError>>()?;
    Ok(UrdfLink { name, collisions })
}

fn geometry(collision: Node, item: &str) -> Result<Geometry, RobotError> {
    let element = child(collision, "geometry").ok_or_else(|| missing(item, "geometry"))?;
    let shape = element.children().find(Node::is_element).ok_or_else(|| missing(item, "shape in its geometry"))?;
    match shape.tag_name().name() {
        "box" => {
            let size = numbers(required(shape, item, "size")?, item, "size", "three finite numbers")?;
            Ok(Geometry::Box { size: Vec3::from(size) })
        }
        "sphere" => Ok(Geometry::Sphere { radius: number(shape, item, "radius")? }),
        "cylinder" => {
            let (radius, length) = (number(shape, item, "radius")?, number(shape, item, "length")?);
            Ok(Geometry::Cylinder { radius, length })
        }
        "capsule" => {
            let (radius, length) = (number(shape, item, "radius")?, number(shape, item, "length")?);
            Ok(Geometry::Capsule { radius, length })
        }
        "mesh" => {
            let filename = required(shape, item, "filename")?.to_owned();
            Ok(Geometry::Mesh { filename, scale: vector_or(shape, item, "scale", Vec3::repeat(1.0))? })
        }
        kind => Err(RobotError::UnsupportedGeometry { item: item.to_owned(), kind: kind.to_owned() }),
    }
}

fn joint(node: Node, ordinal: usize, open_ended: bool) -> Result<UrdfJoint, RobotError> {
    let name = name_of(node, "joint", ordinal)?;
    let item = format!("joint {name:?}");
    let kind = match required(node, &item, "type")? {
        "fixed" => None,
        "revolute" => Some(JointKind::Revolute),
        "continuous" => Some(JointKind::Continuous),
        "prismatic" => Some(JointKind::Prismatic),
        "floating" => Some(JointKind::Floating),
        kind => return Err(RobotError::UnsupportedJoint { joint: name, kind: kind.to_owned() }),
    };
    let end = |tag: &'static str| {
        let element = child(node, tag).ok_or_else(|| missing(&item, tag))?;
        required(element, &item, "link").map(str::to_owned)
    };
    let axis = match child(node, "axis") {
        Some(element) => vector_or(element, &item, "xyz", Vec3::x()),
        None => Ok(Vec3::x()),
    }?;
    let (parent, child_link) = (end("parent")?, end("child")?);
    let limits = match kind {
        Some(JointKind::Revolute | JointKind::Prismatic) => Some(limits(node, &name, &item, open_ended)?),
        Some(JointKind::Continuous | JointKind::Floating) | None => None,
    };
    let moves_along_axis = !matches!(kind, None | Some(JointKind::Floating));
    let axis = match unit(axis) {
        Some(unit) => unit,
        None if moves_along_axis => return Err(RobotError::ZeroAxis { joint: name }),
        None => Vec3::x(),
    };
    let mimic = child(node, "mimic").map(|element| {
        let joint = required(element, &item, "joint")?.to_owned();
        let multiplier = number_or(element, &item, "multiplier", 1.0)?;
        Ok(Mimic { joint, multiplier, offset: number_or(element, &item, "offset", 0.0)? })
    });
    let mimic = mimic.transpose()?;
    Ok(UrdfJoint { origin: origin(node, &item)?, name, kind, parent, child: child_link, axis, limits, mimic })
}

/// The vector at unit length; its size is taken out first, so that no square over- or underflows.
fn unit(v: Vec3) -> Option<Vec3> {
    let largest = v.amax();
    (largest > 0.0).then(|| (v / largest).normalize())
}

fn limits(node: Node, joint: &str, item: &str, open_ended: bool) -> Result<Limits, RobotError> {
    let element = child(node, "limit").ok_or_else(|| missing(item, "limit"))?;
    let omitted = if open_ended { f64::INFINITY } else { 0.0 };
    let lower = number_or(element, item, "lower", -omitted)?;
    let upper = number_or(element, item, "upper", omitted)?;
    if lower > upper {
        return Err(RobotError::LimitsReversed { joint: joint.to_owned(), lower, upper });
    }
    Ok(Limits { lower, upper })
}

/// `<origin>` of a joint or a collision shape; the identity where there is none.
fn origin(node: Node, item: &str) -> Result<Pose, RobotError> {
    let Some(element) = child(node, "origin") else { return Ok(Pose::identity()) };
    let translation = vector_or(element, item, "xyz", Vec3::zeros())?;
    if translation.amax() > LARGEST_LENGTH {
        let (field, value) = ("origin xyz".to_owned(), translation.amax());
        let source = InvalidShape::TooLarge { field, value, limit: LARGEST_LENGTH };
        return Err(RobotError::Shape { item: item.to_owned(), source });
    }
    let angles = vector_or(element, item, "rpy", Vec3::zeros())?;
    let rotation = match element.attribute("quat_xyzw") {
        None => Quaternion::from_roll_pitch_yaw(angles.x, angles.y, angles.z),
        Some(text) => {
            const FOUR: &str = "four finite numbers, not all zero, in the place of rpy";
            let [x, y, z, w] = numbers(text, item, "quat_xyzw", FOUR)?;
            if element.has_attribute("rpy") || [x, y, z, w] == [0.0; 4] {
                let (item, field, found) = (item.to_owned(), "quat_xyzw".to_owned(), text.to_owned());
                return Err(RobotError::BadNumber { item, field, expected: FOUR, found });
            }
            Quaternion { w, x, y, z }
        }
    };
    Ok(Pose::new(translation, rotation).expect("finite, and no quaternion made of angles is zero"))
}
