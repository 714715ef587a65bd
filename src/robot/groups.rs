//! Groups of an SRDF: which joints move together, which links belong to them, and named states.
//!
//! A group holds the joints it lists, the joints that lead to the links it lists, the joints on the way between the ends
//! of its chains, and everything its subgroups hold. Its links are those it lists and those its joints move.

use std::collections::{BTreeMap, BTreeSet};

use super::RobotError;
use super::joint::Joint;
use super::kinematics::Parent;
use super::srdf::{Srdf, SrdfGroup, SrdfState};
use super::urdf::Urdf;

/// A group, resolved.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Group {
    /// Unique among the robot's groups.
    pub name: String,
    /// Indices of joints with positions of their own, ascending.
    pub joints: Vec<usize>,
    /// Indices of links, ascending.
    pub links: Vec<u32>,
}

/// Positions that have a name, such as `home`.
#[derive(Clone, Debug, PartialEq)]
pub struct GroupState {
    /// Unique within the group.
    pub name: String,
    /// Index of its group.
    pub group: usize,
    /// Joint by joint, as many numbers as it is wide. Fixed, virtual and mimicking joints, whose positions nobody
    /// chooses, are left out.
    pub positions: Vec<(usize, Vec<f64>)>,
}

/// What names of an SRDF refer to.
pub(super) struct Names<'a> {
    pub urdf: &'a Urdf,
    pub links: &'a BTreeMap<&'a str, u32>,
    pub joints: &'a [Joint],
    pub parents: &'a [Option<Parent>],
}

pub(super) fn resolve(names: &Names, srdf: &Srdf) -> Result<(Vec<Group>, Vec<GroupState>), RobotError> {
    let mut by_name = BTreeMap::new();
    for (i, group) in srdf.groups.iter().enumerate() {
        if by_name.insert(group.name.as_str(), i).is_some() {
            return Err(RobotError::Duplicate { kind: "group", name: group.name.clone() });
        }
    }
    let scope = Scope { names, srdf, by_name };
    let groups = (0..srdf.groups.len()).map(|i| scope.group(i)).collect::<Result<Vec<_>, _>>()?;
    let mut met = BTreeSet::new();
    for state in &srdf.states {
        if !met.insert((&state.group, &state.name)) {
            return Err(RobotError::Duplicate { kind: "group_state", name: state.name.clone() });
        }
    }
    let states = srdf.states.iter().map(|state| scope.state(state)).collect::<Result<_, _>>()?;
    Ok((groups, states))
}

/// A joint that an SRDF names.
enum Named {
    /// Of the URDF, by index.
    Real(usize),
    /// Of the SRDF; a base pose stands in for it.
    Virtual,
}

struct Scope<'a> {
    names: &'a Names<'a>,
    srdf: &'a Srdf,
    by_name: BTreeMap<&'a str, usize>,
}

impl Scope<'_> {
    fn group(&self, index: usize) -> Result<Group, RobotError> {
        // Joints by their index in the URDF.
        let (mut joints, mut links) = (BTreeSet::new(), BTreeSet::new());
        let mut open = vec![index];
        let mut met = BTreeSet::from([index]);
        while let Some(group) = open.pop() {
            let group = &self.srdf.groups[group];
            self.own_members(group, &mut joints, &mut links)?;
            for name in &group.subgroups {
                let subgroup = self.find_group(&format!("group {:?}", group.name), name)?;
                if subgroup == index {
                    return Err(RobotError::GroupCycle { group: name.clone() });
                }
                if met.insert(subgroup) {
                    open.push(subgroup);
                }
            }
        }
        let name = self.srdf.groups[index].name.clone();
        let own = |joint: &usize| self.position_of(*joint);
        Ok(Group { name, joints: joints.iter().filter_map(own).collect(), links: links.into_iter().collect() })
    }

    fn own_members(
        &self,
        group: &SrdfGroup,
        joints: &mut BTreeSet<usize>,
        links: &mut BTreeSet<u32>,
    ) -> Result<(), RobotError> {
        let item = format!("group {:?}", group.name);
        for name in &group.joints {
            if let Named::Real(joint) = self.find_joint(&item, name)? {
                joints.insert(joint);
                links.insert(self.names.links[self.names.urdf.joints[joint].child.as_str()]);
            }
        }
        for name in &group.links {
            let link = self.find_link(&item, "link", name)?;
            links.insert(link);
            joints.extend(self.names.parents[link as usize].map(|parent| parent.joint));
        }
        for [base, tip] in &group.chains {
            let base = self.find_link(&item, "base_link", base)?;
            let tip = self.find_link(&item, "tip_link", tip)?;
            // The way between two links of a tree: up from each of them, where the ways to the root differ.
            let (from_base, from_tip) = (self.way_up(base), self.way_up(tip));
            for &(joint, link) in from_base.symmetric_difference(&from_tip) {
                joints.insert(joint);
                links.insert(link);
            }
        }
        Ok(())
    }

    /// The joints between a link and the root, each with the link it moves.
    fn way_up(&self, mut link: u32) -> BTreeSet<(usize, u32)> {
        let mut way = BTreeSet::new();
        while let Some(parent) = self.names.parents[link as usize] {
            way.insert((parent.joint, link));
            link = parent.link;
        }
        way
    }

    fn state(&self, state: &SrdfState) -> Result<GroupState, RobotError> {
        let item = format!("group_state {:?}", state.name);
        let group = self.find_group(&item, &state.group)?;
        let mut positions = Vec::with_capacity(state.positions.len());
        for (name, numbers) in &state.positions {
            let Named::Real(joint) = self.find_joint(&item, name)? else { continue };
            let Some(joint) = self.position_of(joint) else { continue };
            let width = self.names.joints[joint].kind.width();
            if numbers.len() != width {
                return Err(RobotError::BadNumber {
                    item: format!("{item}, joint {name:?}"),
                    field: "value".to_owned(),
                    expected: if width == 1 { "a finite number" } else { "seven finite numbers" },
                    found: format!("{numbers:?}"),
                });
            }
            positions.push((joint, numbers.clone()));
        }
        Ok(GroupState { name: state.name.clone(), group, positions })
    }

    /// Index among the joints with positions of their own, of a joint of the URDF.
    fn position_of(&self, joint: usize) -> Option<usize> {
        let name = &self.names.urdf.joints[joint].name;
        self.names.joints.iter().position(|candidate| candidate.name == *name)
    }

    fn find_joint(&self, item: &str, name: &str) -> Result<Named, RobotError> {
        if let Some(joint) = self.names.urdf.joints.iter().position(|joint| joint.name == name) {
            return Ok(Named::Real(joint));
        }
        if self.srdf.virtual_joints.iter().any(|joint| joint == name) {
            return Ok(Named::Virtual);
        }
        Err(unknown(item, "joint", "joint", name))
    }

    fn find_link(&self, item: &str, field: &str, name: &str) -> Result<u32, RobotError> {
        self.names.links.get(name).copied().ok_or_else(|| unknown(item, field, "link", name))
    }

    fn find_group(&self, item: &str, name: &str) -> Result<usize, RobotError> {
        self.by_name.get(name).copied().ok_or_else(|| unknown(item, "group", "group", name))
    }
}

fn unknown(item: &str, field: &str, kind: &'static str, name: &str) -> RobotError {
    RobotError::Unknown { item: item.to_owned(), field: field.to_owned(), kind, name: name.to_owned() }
}
