//! Which pairs of a robot's links are looked at for self-collision, and why are the others not?
//!
//! All pairs of links that have shapes, except
//! 1. links joined by one joint: they meet there by construction;
//! 2. pairs that the SRDF disables;
//! 3. without an SRDF only: links that are rigidly joined, and links of two rigid bodies that one moving joint joins.
//!
//! An SRDF is a statement about every pair, so with one no further guess is made: rigid pairs it does not list are
//! looked at, like any other. Its `enable_collisions` overrides rules 1 and `disable_default_collisions`; its
//! `disable_collisions` overrides everything.

use std::collections::BTreeMap;
use std::fmt;

use super::RobotError;
use super::kinematics::Parent;
use super::link::Link;
use super::srdf::Srdf;

/// A pair that is not looked at.
#[derive(Clone, Debug, PartialEq)]
pub struct ExcludedPair {
    /// Indices of links, the lower first.
    pub links: (u32, u32),
    /// Why.
    pub reason: Exclusion,
}

/// Why a pair of links is not looked at.
#[derive(Clone, Debug, PartialEq)]
pub enum Exclusion {
    /// One joint joins them.
    Adjacent,
    /// Fixed joints join them, so that their distance never changes; assumed where no SRDF decides.
    RigidlyJoined,
    /// They belong to rigid bodies that one moving joint joins; assumed where no SRDF decides.
    AdjacentBodies,
    /// The SRDF disables the pair, for the reason it gives (`Adjacent`, `Never`, `Default`, `User` ...).
    Srdf(String),
    /// The SRDF disables all pairs of this link that it does not enable.
    SrdfDefault {
        /// Name of the link.
        link: String,
    },
}

impl fmt::Display for Exclusion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Adjacent => f.write_str("joined by a joint"),
            Self::RigidlyJoined => f.write_str("rigidly joined"),
            Self::AdjacentBodies => f.write_str("rigid bodies joined by a joint"),
            Self::Srdf(reason) if reason.is_empty() => f.write_str("disabled by the SRDF"),
            Self::Srdf(reason) => write!(f, "disabled by the SRDF: {reason}"),
            Self::SrdfDefault { link } => write!(f, "disabled by the SRDF for all pairs of {link:?}"),
        }
    }
}

/// Pairs to look at and pairs left out, each sorted by link.
pub(super) struct CollisionPairs {
    pub tested: Vec<(u32, u32)>,
    pub excluded: Vec<ExcludedPair>,
}

impl CollisionPairs {
    pub fn new(
        links: &[Link],
        parents: &[Option<Parent>],
        srdf: Option<&Srdf>,
        index_of: &BTreeMap<&str, u32>,
    ) -> Result<Self, RobotError> {
        let rules = Rules::read(links, srdf, index_of)?;
        let bodies = rigid_bodies(parents);
        let joined = |a: u32, b: u32| {
            let leads = |from: u32, to: u32| parents[to as usize].is_some_and(|parent| parent.link == from);
            leads(a, b) || leads(b, a)
        };
        let adjacent_bodies = |a: u32, b: u32| {
            let moved_from = |body: u32| parents[body as usize].map(|parent| bodies[parent.link as usize]);
            let (a, b) = (bodies[a as usize], bodies[b as usize]);
            moved_from(a) == Some(b) || moved_from(b) == Some(a)
        };
        let with_shapes: Vec<u32> =
            (0u32..).zip(links).filter(|(_, link)| !link.shapes.is_empty()).map(|(i, _)| i).collect();
        let mut pairs = Self { tested: Vec::new(), excluded: Vec::new() };
        for (i, &a) in with_shapes.iter().enumerate() {
            for &b in &with_shapes[i + 1..] {
                let reason = match rules.of(a, b) {
                    Some(Rule::Look) => None,
                    Some(Rule::Leave(reason)) => Some(reason.clone()),
                    None if joined(a, b) => Some(Exclusion::Adjacent),
                    None if srdf.is_some() => None,
                    None if bodies[a as usize] == bodies[b as usize] => Some(Exclusion::RigidlyJoined),
                    None if adjacent_bodies(a, b) => Some(Exclusion::AdjacentBodies),
                    None => None,
                };
                match reason {
                    Some(reason) => pairs.excluded.push(ExcludedPair { links: (a, b), reason }),
                    None => pairs.tested.push((a, b)),
                }
            }
        }
        Ok(pairs)
    }
}

/// For each link, the topmost link that it is rigidly joined to.
fn rigid_bodies(parents: &[Option<Parent>]) -> Vec<u32> {
    let top = |mut link: u32| {
        while let Some(parent) = parents[link as usize].filter(|parent| parent.fixed) {
            link = parent.link;
        }
        link
    };
    (0u32..).zip(parents).map(|(link, _)| top(link)).collect()
}

enum Rule {
    Look,
    Leave(Exclusion),
}

/// What an SRDF says about pairs.
struct Rules {
    of_pairs: BTreeMap<(u32, u32), Rule>,
    of_links: BTreeMap<u32, Rule>,
}

impl Rules {
    fn read(links: &[Link], srdf: Option<&Srdf>, index_of: &BTreeMap<&str, u32>) -> Result<Self, RobotError> {
        let mut rules = Self { of_pairs: BTreeMap::new(), of_links: BTreeMap::new() };
        let Some(srdf) = srdf else { return Ok(rules) };
        let find = |item: &str, field: &str, name: &str| {
            index_of.get(name).copied().ok_or_else(|| RobotError::Unknown {
                item: item.to_owned(),
                field: field.to_owned(),
                kind: "link",
                name: name.to_owned(),
            })
        };
        let pair = |item: &str, [a, b]: &[String; 2]| {
            let (a, b) = (find(item, "link1", a)?, find(item, "link2", b)?);
            Ok((a.min(b), a.max(b)))
        };
        for name in &srdf.quiet_links {
            let link = find("disable_default_collisions", "link", name)?;
            let reason = Exclusion::SrdfDefault { link: links[link as usize].name.clone() };
            rules.of_links.insert(link, Rule::Leave(reason));
        }
        for names in &srdf.enabled {
            rules.of_pairs.insert(pair("enable_collisions", names)?, Rule::Look);
        }
        for disabled in &srdf.disabled {
            let reason = Exclusion::Srdf(disabled.reason.clone());
            rules.of_pairs.insert(pair("disable_collisions", &disabled.links)?, Rule::Leave(reason));
        }
        Ok(rules)
    }

    fn of(&self, a: u32, b: u32) -> Option<&Rule> {
        self.of_pairs.get(&(a, b)).or_else(|| self.of_links.get(&a)).or_else(|| self.of_links.get(&b))
    }
}
