//! Where is every link, given the joints' positions?
//!
//! The tree of a URDF's joints is checked and put in order once: each link after the one it hangs from. A pass over that
//! order then composes poses as quaternions, whose norm stays 1 to rounding and does not matter anyway, since a pose
//! means R(q/|q|). No allocation but the caller's vector, and no sines but `libm`'s.

use std::collections::BTreeMap;

use super::RobotError;
use super::joint::{BadPositions, Joint, JointKind};
use super::urdf::{Urdf, UrdfJoint};
use crate::geometry::tolerance::LARGEST_LENGTH;
use crate::geometry::{Pose, Quaternion, Vec3};

/// The joint that leads to a link.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parent {
    /// Index of the link on the other side.
    pub link: u32,
    /// Index of the joint among all joints of the URDF, fixed ones included.
    pub joint: usize,
    /// Whether it never moves.
    pub fixed: bool,
}

/// The tree of links, ready to be evaluated.
#[derive(Clone, Debug)]
pub(super) struct Kinematics {
    /// How each link is reached; none for the root. By link.
    pub parents: Vec<Option<Parent>>,
    root: u32,
    /// Each link after the one it hangs from.
    pub steps: Vec<Step>,
    width: usize,
}

/// How one link's pose follows from its parent's.
#[derive(Clone, Debug)]
pub(super) struct Step {
    pub link: u32,
    pub parent: u32,
    /// The joint's frame in the parent link's, at position zero.
    pub origin: Pose,
    pub motion: Motion,
}

#[derive(Clone, Copy, Debug)]
pub(super) enum Motion {
    Fixed,
    /// About a unit vector of the joint's frame.
    Turn {
        axis: Vec3,
        coordinate: Coordinate,
    },
    /// Along a unit vector, here in the parent link's frame.
    Slide {
        direction: Vec3,
        coordinate: Coordinate,
    },
    /// Seven numbers from `first` on.
    Free {
        first: usize,
    },
}

/// A joint's position as a function of the position vector: `multiplier * positions[index] + offset`. For joints that
/// mimic nothing that is the number itself, exactly.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coordinate {
    pub index: usize,
    pub multiplier: f64,
    pub offset: f64,
}

impl Coordinate {
    pub fn value(self, positions: &[f64]) -> f64 {
        self.multiplier * positions[self.index] + self.offset
    }
}

impl Kinematics {
    /// The tree, and the joints that have positions of their own, in the URDF's order.
    pub fn new(urdf: &Urdf, links: &BTreeMap<&str, u32>) -> Result<(Self, Vec<Joint>), RobotError> {
        let (parents, joints) = connect(urdf, links)?;
        let root = single_root(urdf, &parents)?;
        let width = joints.iter().map(|joint| joint.kind.width()).sum();
        let mut children = vec![Vec::new(); urdf.links.len()];
        for (link, parent) in (0u32..).zip(&parents) {
            if let Some(parent) = parent {
                children[parent.link as usize].push((link, parent.joint));
            }
        }
        let mut steps = Vec::with_capacity(urdf.joints.len());
        let mut ready = vec![root];
        while let Some(parent) = ready.pop() {
            for &(link, joint) in &children[parent as usize] {
                let joint = &urdf.joints[joint];
                steps.push(Step { link, parent, origin: joint.origin, motion: motion(urdf, joint, &joints)? });
                ready.push(link);
            }
        }
        if steps.len() + 1 < urdf.links.len() {
            let mut reached = vec![false; urdf.links.len()];
            reached[root as usize] = true;
            steps.iter().for_each(|step| reached[step.link as usize] = true);
            let unreached = reached.iter().position(|reached| !reached).expect("fewer steps than links below the root");
            return Err(RobotError::Cycle { link: urdf.links[unreached].name.clone() });
        }
        Ok((Self { parents, root, steps, width }, joints))
    }

    /// Length of a position vector.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Checks that a position vector has poses: see [`super::RobotModel::check_positions`].
    pub fn check(&self, joints: &[Joint], positions: &[f64]) -> Result<(), BadPositions> {
        if positions.len() != self.width {
            return Err(BadPositions::WrongCount { found: positions.len(), expected: self.width });
        }
        let owner = |index: usize| {
            let after = joints.partition_point(|joint| joint.first <= index);
            joints[after - 1].name.clone()
        };
        if let Some(index) = positions.iter().position(|position| !position.is_finite()) {
            return Err(BadPositions::NotFinite { index, joint: owner(index) });
        }
        let too_large =
            |index: usize| Err(BadPositions::TooLarge { index, joint: owner(index), value: positions[index] });
        for step in &self.steps {
            match step.motion {
                Motion::Fixed => {}
                Motion::Turn { coordinate, .. } if coordinate.value(positions).is_finite() => {}
                Motion::Slide { direction, coordinate }
                    if (step.origin.translation() + coordinate.value(positions) * direction).amax()
                        <= LARGEST_LENGTH => {}
                Motion::Turn { coordinate, .. } | Motion::Slide { coordinate, .. } => {
                    return too_large(coordinate.index);
                }
                Motion::Free { first } => {
                    if let Some(i) = (first..first + 3).find(|&i| positions[i].abs() > LARGEST_LENGTH) {
                        return too_large(i);
                    }
                    if positions[first + 3..first + 7].iter().all(|component| *component == 0.0) {
                        return Err(BadPositions::ZeroQuaternion { index: first + 3, joint: owner(first) });
                    }
                }
            }
        }
        Ok(())
    }

    /// Poses of all links in the frame that `base`, the pose of the root link, is given in. By link.
    ///
    /// # Panics
    /// On positions that did not pass [`Kinematics::check`].
    pub fn link_poses(&self, positions: &[f64], base: &Pose, poses: &mut Vec<Pose>) {
        assert_eq!(positions.len(), self.width, "positions were not checked");
        poses.clear();
        poses.resize(self.parents.len(), *base);
        for step in &self.steps {
            let link_in_parent = step.link_in_parent(positions);
            poses[step.link as usize] = poses[step.parent as usize].compose(&link_in_parent);
        }
    }

    /// The link that no joint leads to.
    pub fn root(&self) -> u32 {
        self.root
    }
}

impl Step {
    fn link_in_parent(&self, positions: &[f64]) -> Pose {
        let origin = &self.origin;
        let moved = match self.motion {
            Motion::Fixed => return *origin,
            Motion::Turn { axis, coordinate } => {
                let turn = Quaternion::about_axis(axis, coordinate.value(positions));
                Pose::new(origin.translation(), origin.rotation().compose(turn))
            }
            Motion::Slide { direction, coordinate } => {
                Pose::new(origin.translation() + coordinate.value(positions) * direction, origin.rotation())
            }
            Motion::Free { first } => {
                let p = &positions[first..first + 7];
                let rotation = Quaternion { x: p[3], y: p[4], z: p[5], w: p[6] };
                Pose::new(Vec3::new(p[0], p[1], p[2]), rotation).map(|pose| origin.compose(&pose))
            }
        };
        moved.expect("positions were checked")
    }
}

/// How each link is reached, and the joints with positions of their own.
fn connect(urdf: &Urdf, links: &BTreeMap<&str, u32>) -> Result<(Vec<Option<Parent>>, Vec<Joint>), RobotError> {
    let mut parents: Vec<Option<Parent>> = vec![None; urdf.links.len()];
    let mut joints = Vec::new();
    let mut first = 0;
    for (index, joint) in urdf.joints.iter().enumerate() {
        let end = |field: &str, name: &str| {
            links.get(name).copied().ok_or_else(|| RobotError::Unknown {
                item: format!("joint {:?}", joint.name),
                field: field.to_owned(),
                kind: "link",
                name: name.to_owned(),
            })
        };
        let (parent, child) = (end("parent", &joint.parent)?, end("child", &joint.child)?);
        let entry = &mut parents[child as usize];
        if let Some(other) = entry {
            return Err(RobotError::TwoParents {
                link: joint.child.clone(),
                first: urdf.joints[other.joint].name.clone(),
                second: joint.name.clone(),
            });
        }
        *entry = Some(Parent { link: parent, joint: index, fixed: joint.kind.is_none() });
        if let (Some(kind), None) = (joint.kind, &joint.mimic) {
            joints.push(Joint { name: joint.name.clone(), kind, limits: joint.limits, first, parent, child });
            first += kind.width();
        }
    }
    Ok((parents, joints))
}

fn single_root(urdf: &Urdf, parents: &[Option<Parent>]) -> Result<u32, RobotError> {
    let mut roots = (0u32..).zip(parents).filter(|(_, parent)| parent.is_none()).map(|(link, _)| link);
    let name = |link: u32| urdf.links[link as usize].name.clone();
    match (roots.next(), roots.next()) {
        (Some(root), None) => Ok(root),
        (Some(first), Some(second)) => Err(RobotError::TwoRoots { first: name(first), second: name(second) }),
        (None, _) if urdf.links.is_empty() => Err(RobotError::NoLinks),
        (None, _) => Err(RobotError::Cycle { link: name(0) }),
    }
}

fn motion(urdf: &Urdf, joint: &UrdfJoint, joints: &[Joint]) -> Result<Motion, RobotError> {
    let Some(kind) = joint.kind else { return Ok(Motion::Fixed) };
    let (leader, multiplier, offset) = leader(urdf, joint)?;
    let first = joints.iter().find(|candidate| candidate.name == leader.name).map(|leader| leader.first);
    let index = first.expect("a leader moves and mimics nothing");
    let coordinate = Coordinate { index, multiplier, offset };
    Ok(match kind {
        JointKind::Revolute | JointKind::Continuous => Motion::Turn { axis: joint.axis, coordinate },
        JointKind::Prismatic => Motion::Slide { direction: joint.origin.placement().direction(joint.axis), coordinate },
        JointKind::Floating => Motion::Free { first: index },
    })
}

/// The joint whose position decides where `joint` is, followed through mimics of mimics, and by which line.
fn leader<'a>(urdf: &'a Urdf, joint: &'a UrdfJoint) -> Result<(&'a UrdfJoint, f64, f64), RobotError> {
    let (mut leader, mut multiplier, mut offset) = (joint, 1.0, 0.0);
    let single = |joint: &UrdfJoint| match joint.kind {
        None => Err("fixed"),
        Some(JointKind::Floating) => Err("floating"),
        Some(JointKind::Revolute | JointKind::Continuous | JointKind::Prismatic) => Ok(()),
    };
    let mut followed = 0;
    while let Some(mimic) = &leader.mimic {
        let target = urdf.joints.iter().find(|candidate| candidate.name == mimic.joint);
        let target = target.ok_or_else(|| RobotError::Unknown {
            item: format!("joint {:?}", leader.name),
            field: "mimic".to_owned(),
            kind: "joint",
            name: mimic.joint.clone(),
        })?;
        single(leader).and(single(target)).map_err(|kind| RobotError::MimicKind {
            joint: leader.name.clone(),
            target: target.name.clone(),
            kind,
        })?;
        // a (m x + o) + b = (a m) x + (a o + b)
        (multiplier, offset) = (multiplier * mimic.multiplier, multiplier * mimic.offset + offset);
        if !(multiplier.is_finite() && offset.is_finite()) {
            return Err(RobotError::BadNumber {
                item: format!("joint {:?}", joint.name),
                field: "mimic".to_owned(),
                expected: "a line of finite slope and offset",
                found: format!("{multiplier} * position + {offset}"),
            });
        }
        leader = target;
        followed += 1;
        if followed > urdf.joints.len() {
            return Err(RobotError::MimicCycle { joint: joint.name.clone() });
        }
    }
    Ok((leader, multiplier, offset))
}
