//! Which shape is a side of a pair, and where is it? For what is made of pairs after the search for them is over.

#[cfg(feature = "effect-derivatives")]
use super::answer::Side;
use super::robot_parts::{Placed, RobotParts};
use crate::geometry::{Placement, Shape};
use crate::scene::Snapshot;

/// What an item is asked of.
#[cfg_attr(not(feature = "effect-derivatives"), expect(dead_code, reason = "only derivatives ask for it"))]
pub(super) struct Stage<'a> {
    /// Its number in the question.
    pub item: usize,
    pub snapshot: &'a Snapshot,
    /// A bare shape of the question.
    pub shape: Option<(&'a Shape, Placement)>,
    /// The robot that is asked about.
    pub robot: Option<Standing<'a>>,
}

/// A robot in one state.
#[cfg_attr(not(feature = "effect-derivatives"), expect(dead_code, reason = "only derivatives ask for it"))]
pub(super) struct Standing<'a> {
    pub parts: &'a RobotParts<'a>,
    pub positions: &'a [f64],
    pub placed: &'a Placed,
}

/// One side of a pair.
#[cfg(feature = "effect-derivatives")]
pub(super) struct OnStage<'a> {
    pub shape: &'a Shape,
    pub at: Placement,
    /// The link that it is a shape of, or that holds it.
    pub link: Option<u32>,
}

#[cfg(feature = "effect-derivatives")]
impl<'a> Stage<'a> {
    /// None for a side of another question.
    pub fn side(&self, side: &Side) -> Option<OnStage<'a>> {
        if let Some(standing) = &self.robot
            && let Some(index) = standing.parts.part_of(side)
        {
            let part = &standing.parts.parts[index];
            return Some(OnStage { shape: part.shape, at: standing.placed.placements[index], link: Some(part.link) });
        }
        match side {
            Side::Link { .. } => None,
            Side::Query { .. } => self.shape.map(|(shape, at)| OnStage { shape, at, link: None }),
            Side::Body { id, .. } => {
                let body = self.snapshot.body(*id)?;
                Some(OnStage { shape: &body.shape, at: body.placement, link: None })
            }
        }
    }
}
