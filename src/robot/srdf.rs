//! What does an SRDF say? Groups, their named states, and which pairs of links need no look. Names not yet resolved.
//!
//! Virtual joints are read for their names only (a scene places a robot by a base pose, but groups mention them). End
//! effectors, passive joints and spheres that stand in for links are not read.

use roxmltree::Node;

use super::RobotError;
use super::attributes::{children, finite_numbers, name_of, parse, required};

/// An SRDF as written.
#[derive(Default)]
pub(super) struct Srdf {
    pub virtual_joints: Vec<String>,
    pub groups: Vec<SrdfGroup>,
    pub states: Vec<SrdfState>,
    /// Links whose pairs are off unless enabled one by one.
    pub quiet_links: Vec<String>,
    pub enabled: Vec<[String; 2]>,
    pub disabled: Vec<DisabledPair>,
}

pub(super) struct DisabledPair {
    pub links: [String; 2],
    /// As written, perhaps empty.
    pub reason: String,
}

pub(super) struct SrdfGroup {
    pub name: String,
    pub joints: Vec<String>,
    pub links: Vec<String>,
    /// Base link and tip link.
    pub chains: Vec<[String; 2]>,
    pub subgroups: Vec<String>,
}

pub(super) struct SrdfState {
    pub name: String,
    pub group: String,
    pub positions: Vec<(String, Vec<f64>)>,
}

impl Srdf {
    pub fn read(text: &str) -> Result<Self, RobotError> {
        let document = parse("SRDF", text)?;
        let robot = document.root_element();
        let each = |tag| children(robot, tag).enumerate();
        let pair = |(node, item): (Node, &str)| {
            Ok([required(node, item, "link1")?.to_owned(), required(node, item, "link2")?.to_owned()])
        };
        Ok(Self {
            virtual_joints: each("virtual_joint")
                .map(|(i, n)| name_of(n, "virtual_joint", i))
                .collect::<Result<_, _>>()?,
            groups: each("group").map(|(i, node)| group(node, i)).collect::<Result<_, _>>()?,
            states: each("group_state").map(|(i, node)| state(node, i)).collect::<Result<_, _>>()?,
            quiet_links: each("disable_default_collisions")
                .map(|(_, node)| required(node, "disable_default_collisions", "link").map(str::to_owned))
                .collect::<Result<_, _>>()?,
            enabled: each("enable_collisions")
                .map(|(_, node)| pair((node, "enable_collisions")))
                .collect::<Result<_, RobotError>>()?,
            disabled: each("disable_collisions")
                .map(|(_, node)| {
                    let reason = node.attribute("reason").unwrap_or_default().to_owned();
                    Ok(DisabledPair { links: pair((node, "disable_collisions"))?, reason })
                })
                .collect::<Result<_, RobotError>>()?,
        })
    }
}

fn group(node: Node, ordinal: usize) -> Result<SrdfGroup, RobotError> {
    let name = name_of(node, "group", ordinal)?;
    let item = format!("group {name:?}");
    let names = |tag: &'static str| {
        children(node, tag)
            .map(|entry| required(entry, &item, "name").map(str::to_owned))
            .collect::<Result<Vec<_>, _>>()
    };
    let chain = |entry: Node| {
        Ok([required(entry, &item, "base_link")?.to_owned(), required(entry, &item, "tip_link")?.to_owned()])
    };
    let chains = children(node, "chain").map(chain).collect::<Result<_, RobotError>>()?;
    Ok(SrdfGroup { joints: names("joint")?, links: names("link")?, subgroups: names("group")?, chains, name })
}

fn state(node: Node, ordinal: usize) -> Result<SrdfState, RobotError> {
    let name = name_of(node, "group_state", ordinal)?;
    let item = format!("group_state {name:?}");
    let group = required(node, &item, "group")?.to_owned();
    let position = |entry: Node| {
        let joint = required(entry, &item, "name")?;
        let value = required(entry, &item, "value")?;
        let numbers = finite_numbers(value).ok_or_else(|| RobotError::BadNumber {
            item: format!("{item}, joint {joint:?}"),
            field: "value".to_owned(),
            expected: "finite numbers",
            found: value.to_owned(),
        })?;
        Ok((joint.to_owned(), numbers))
    };
    let positions = children(node, "joint").map(position).collect::<Result<_, RobotError>>()?;
    Ok(SrdfState { name, group, positions })
}
