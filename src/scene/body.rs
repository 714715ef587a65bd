//! What stands in a scene: a shape at a pose, and what it is held against.

use std::sync::Arc;

use super::BodyId;
use super::party::{Member, PartyKey};
use crate::broad_phase::ProxyId;
use crate::geometry::{Aabb, Placement, Pose, Shape};

/// A rigid body of a snapshot.
#[derive(Clone, Debug)]
pub struct Body {
    /// Its number in the scene.
    pub id: BodyId,
    /// Unique in the scene.
    pub name: Arc<str>,
    /// What it is held against others as: scaled and padded already.
    pub shape: Arc<Shape>,
    /// Factor that the lengths of the given shape were multiplied by.
    pub scale: f64,
    /// What was added to the swept radius after scaling, metres.
    pub padding: f64,
    /// The body's frame in the world, metres.
    pub pose: Pose,
    /// The same with the rotation written out.
    pub placement: Placement,
    /// A box in the world that surely holds the body, metres; none when the shape is unbounded, or voxels without a cell.
    pub bounds: Option<Aabb>,
    /// The groups it is in, sorted.
    pub groups: Arc<[Arc<str>]>,
    /// The layers it is in, one bit each.
    pub layers: u32,
    /// The layers it collides with, one bit each.
    pub mask: u32,
    /// A body that is not enabled stays in the scene, but no question sees it.
    pub enabled: bool,
    /// Keys of the groups, in the order of the numbers.
    pub(super) group_keys: Arc<[PartyKey]>,
    /// Its entry in the broad phase: of an enabled body with bounds.
    pub(super) proxy: Option<ProxyId>,
}

impl Body {
    /// The body as entries for pairs are looked up by.
    #[must_use]
    pub fn member(&self) -> Member<'_> {
        Member { one: PartyKey::body(self.id), many: &self.group_keys }
    }

    /// Whether the body takes part, and is in a layer that `mask` has, and collides with one of `layers`.
    #[must_use]
    pub fn meets(&self, layers: u32, mask: u32) -> bool {
        self.enabled && self.layers & mask != 0 && layers & self.mask != 0
    }

    /// Whether it takes part and has no end: then it is looked at by every question.
    pub(super) fn is_unbounded(&self) -> bool {
        self.enabled && self.bounds.is_none() && !self.shape.is_empty()
    }

    /// Whether it is in the group.
    #[must_use]
    pub fn is_in(&self, group: &str) -> bool {
        self.groups.binary_search_by(|own| (**own).cmp(group)).is_ok()
    }
}
