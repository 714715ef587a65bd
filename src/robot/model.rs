//! A robot that is ready to be asked where its links are.

use std::collections::{BTreeMap, BTreeSet};

use super::collision_pairs::{CollisionPairs, ExcludedPair};
use super::groups::{self, Group, GroupState, Names};
use super::joint::{BadPositions, Joint, OutsideLimits};
use super::kinematics::Kinematics;
use super::link::{self, Link, MeshResolver};
use super::options::ModelOptions;
use super::robot_error::RobotError;
use super::srdf::Srdf;
use super::urdf::{Geometry, Urdf};
use crate::geometry::Pose;

/// Links, and groups, that a robot may have. Pairs of links grow with the square of their number, and are listed.
pub const MOST_LINKS: usize = 2000;

/// A robot: links in a tree of joints, their collision shapes, and the pairs of links that may collide.
///
/// Links keep the URDF's order, and so do joints. A position vector holds the numbers of all joints that are neither
/// fixed nor mimic another, joint after joint ([`Joint::first`], `kind.width()` numbers each).
#[derive(Clone, Debug)]
pub struct RobotModel {
    name: String,
    links: Vec<Link>,
    joints: Vec<Joint>,
    kinematics: Kinematics,
    tested_pairs: Vec<(u32, u32)>,
    excluded_pairs: Vec<ExcludedPair>,
    groups: Vec<Group>,
    group_states: Vec<GroupState>,
}

impl RobotModel {
    /// Reads a robot from the texts of a URDF and, if there is one, an SRDF. `resolver` finds the bytes of meshes by the
    /// names the URDF gives them.
    ///
    /// # Errors
    /// [`RobotError`], naming the element and the field.
    pub fn from_urdf(
        urdf: &str,
        srdf: Option<&str>,
        resolver: &mut MeshResolver,
        options: &ModelOptions,
    ) -> Result<Self, RobotError> {
        let urdf = Urdf::read(urdf)?;
        let srdf = srdf.map(Srdf::read).transpose()?;
        refuse_too_many("link", urdf.links.len())?;
        refuse_too_many("group", srdf.as_ref().map_or(0, |srdf| srdf.groups.len()))?;
        let index_of = link_indices(&urdf)?;
        refuse_equal_names(&urdf)?;
        if let Some(name) = options.links.keys().find(|name| !index_of.contains_key(name.as_str())) {
            let (item, field) = ("options".to_owned(), "links".to_owned());
            return Err(RobotError::Unknown { item, field, kind: "link", name: name.clone() });
        }
        let (kinematics, joints) = Kinematics::new(&urdf, &index_of)?;
        // Names are checked before meshes are fetched, which may take long.
        let names = Names { urdf: &urdf, links: &index_of, joints: &joints, parents: &kinematics.parents };
        let (groups, group_states) = groups::resolve(&names, srdf.as_ref().unwrap_or(&Srdf::default()))?;
        let links = link::build(&urdf, options, resolver)?;
        let pairs = CollisionPairs::new(&links, &kinematics.parents, srdf.as_ref(), &index_of)?;
        Ok(Self {
            name: urdf.name,
            links,
            joints,
            kinematics,
            tested_pairs: pairs.tested,
            excluded_pairs: pairs.excluded,
            groups,
            group_states,
        })
    }

    /// The robot's name, as the URDF has it; perhaps empty.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// All links, in the URDF's order; the index of a link is its place here.
    #[must_use]
    pub fn links(&self) -> &[Link] {
        &self.links
    }

    /// Index of the link of that name.
    #[must_use]
    pub fn link(&self, name: &str) -> Option<u32> {
        (0u32..).zip(&self.links).find(|(_, link)| link.name == name).map(|(index, _)| index)
    }

    /// The link that no joint leads to; the base pose of a robot is its pose.
    #[must_use]
    pub fn root(&self) -> u32 {
        self.kinematics.root()
    }

    /// Joints with positions of their own, in the URDF's order.
    #[must_use]
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// Length of a position vector.
    #[must_use]
    pub fn degrees_of_freedom(&self) -> usize {
        self.kinematics.width()
    }

    /// Checks that a vector of joint positions means a state: its length, finite numbers, lengths within reach, no zero
    /// quaternion. Limits do not count here: see [`RobotModel::positions_outside_limits`].
    ///
    /// # Errors
    /// [`BadPositions`], naming joint and index.
    pub fn check_positions(&self, positions: &[f64]) -> Result<(), BadPositions> {
        self.kinematics.check(&self.joints, positions)
    }

    /// The positions that are not within their joints' limits, in order. Joints that mimic have none of their own.
    pub fn positions_outside_limits(&self, positions: &[f64]) -> impl Iterator<Item = OutsideLimits> {
        let beyond = |(joint, of): (usize, &Joint)| {
            let (limits, position) = (of.limits?, *positions.get(of.first)?);
            let inside = limits.lower <= position && position <= limits.upper;
            (!inside).then_some(OutsideLimits { joint, index: of.first, position, limits })
        };
        self.joints.iter().enumerate().filter_map(beyond)
    }

    /// Poses of all links, by index, in the frame that `base` (the pose of the root link) is given in. `poses` is
    /// overwritten; a vector that is used again costs no allocation.
    ///
    /// # Panics
    /// On positions that [`RobotModel::check_positions`] refuses.
    pub fn link_poses(&self, positions: &[f64], base: &Pose, poses: &mut Vec<Pose>) {
        self.kinematics.link_poses(positions, base, poses);
    }

    /// Name of the joint that a number of a position vector belongs to.
    ///
    /// # Panics
    /// On an index beyond the vector.
    #[must_use]
    pub fn joint_of(&self, index: usize) -> &str {
        let after = self.joints.partition_point(|joint| joint.first <= index);
        &self.joints[after - 1].name
    }

    pub(super) fn kinematics(&self) -> &Kinematics {
        &self.kinematics
    }

    /// Pairs of links to look at for self-collision, each with the lower index first, sorted.
    #[must_use]
    pub fn self_pairs(&self) -> &[(u32, u32)] {
        &self.tested_pairs
    }

    /// The other pairs of links with shapes, sorted, each with the reason why it is left out.
    #[must_use]
    pub fn excluded_pairs(&self) -> &[ExcludedPair] {
        &self.excluded_pairs
    }

    /// Groups of the SRDF, in its order.
    #[must_use]
    pub fn groups(&self) -> &[Group] {
        &self.groups
    }

    /// The group of that name.
    #[must_use]
    pub fn group(&self, name: &str) -> Option<&Group> {
        self.groups.iter().find(|group| group.name == name)
    }

    /// Named states of groups, in the SRDF's order.
    #[must_use]
    pub fn group_states(&self) -> &[GroupState] {
        &self.group_states
    }
}

/// The distinct names of mesh files that a URDF's collision elements use, in order of first use: what has to be at hand
/// before a model can be made.
///
/// # Errors
/// As far as the URDF itself is wrong.
pub fn mesh_files(urdf: &str) -> Result<Vec<String>, RobotError> {
    let urdf = Urdf::read(urdf)?;
    let mut met = BTreeSet::new();
    let mut files = Vec::new();
    for collision in urdf.links.into_iter().flat_map(|link| link.collisions) {
        if let Geometry::Mesh { filename, .. } = collision.geometry
            && met.insert(filename.clone())
        {
            files.push(filename);
        }
    }
    Ok(files)
}

fn refuse_too_many(kind: &'static str, found: usize) -> Result<(), RobotError> {
    if found > MOST_LINKS { Err(RobotError::TooMany { kind, found, limit: MOST_LINKS }) } else { Ok(()) }
}

fn link_indices(urdf: &Urdf) -> Result<BTreeMap<&str, u32>, RobotError> {
    let mut index_of = BTreeMap::new();
    for (index, link) in (0u32..).zip(&urdf.links) {
        if index_of.insert(link.name.as_str(), index).is_some() {
            return Err(RobotError::Duplicate { kind: "link", name: link.name.clone() });
        }
    }
    Ok(index_of)
}

fn refuse_equal_names(urdf: &Urdf) -> Result<(), RobotError> {
    let mut met = BTreeSet::new();
    match urdf.joints.iter().find(|joint| !met.insert(joint.name.as_str())) {
        Some(joint) => Err(RobotError::Duplicate { kind: "joint", name: joint.name.clone() }),
        None => Ok(()),
    }
}
