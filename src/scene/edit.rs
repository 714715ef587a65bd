//! Every way a scene can change.

use std::sync::Arc;

use super::{BodyId, Effects, Party};
use crate::geometry::{Aabb, Pose, Shape, Vec3};
use crate::robot::RobotModel;

/// One change. The edits of a list are made in order, and each sees what the earlier ones did.
#[derive(Clone, Debug)]
pub enum Edit {
    /// A body enters the scene.
    AddBody(NewBody),
    /// A body leaves the scene, with the entries for pairs that name it.
    RemoveBody {
        /// Which.
        body: BodyRef,
    },
    /// A body is somewhere else from now on.
    MoveBody {
        /// Which.
        body: BodyRef,
        /// Its frame in the world, metres.
        pose: Pose,
    },
    /// A body gets another shape. Its id, pose, groups and layers stay.
    ReplaceShape {
        /// Which.
        body: BodyRef,
        /// In the body's frame.
        shape: Arc<Shape>,
        /// Factor of all lengths of the shape, positive.
        scale: f64,
        /// Added to the swept radius after scaling; metres, not negative.
        padding: f64,
    },
    /// A body whose shape is voxels gets the cells of these points too.
    InsertPoints {
        /// Which.
        body: BodyRef,
        /// Metres, in the body's frame.
        points: Arc<[Vec3]>,
    },
    /// A body whose shape is voxels loses the cells that points of a box belong to.
    ClearBox {
        /// Which.
        body: BodyRef,
        /// Closed, in the body's frame, metres.
        bounds: Aabb,
    },
    /// A body is in these groups from now on, and in no others.
    SetGroups {
        /// Which.
        body: BodyRef,
        /// Names, in any order.
        groups: Vec<String>,
    },
    /// A body is in these layers and collides with these from now on.
    SetLayers {
        /// Which.
        body: BodyRef,
        /// The layers it is in, one bit each.
        layers: u32,
        /// The layers it collides with, one bit each.
        mask: u32,
    },
    /// A body takes part, or stays in the scene without being seen by any question.
    SetEnabled {
        /// Which.
        body: BodyRef,
        /// Whether it takes part.
        enabled: bool,
    },
    /// A robot stands in the scene from now on.
    AddRobot {
        /// UTF-8, not empty, without `/`, unique among the scene's bodies and robots.
        name: String,
        /// What it is.
        model: Arc<RobotModel>,
        /// The root link's frame in the world, metres.
        base: Pose,
    },
    /// A robot's base is somewhere else from now on.
    MoveRobot {
        /// The robot's name in the scene.
        robot: String,
        /// The root link's frame in the world, metres.
        base: Pose,
    },
    /// A robot leaves the scene, with the entries for pairs that name it or its links.
    RemoveRobot {
        /// The robot's name in the scene.
        robot: String,
    },
    /// An entry of the allowed-collision matrix. It replaces an earlier one of the same two parties, whichever comes
    /// first.
    SetAllowedCollision {
        /// One side.
        a: Party,
        /// The other side.
        b: Party,
        /// `Some(true)`: the pair is not looked at. `Some(false)`: it is, whatever less specific entries say. `None`:
        /// the entry is taken back; taking back what is not there changes nothing.
        allowed: Option<bool>,
    },
    /// An entry of the table of margins. It replaces an earlier one of the same two parties, whichever comes first.
    SetPairMargin {
        /// One side.
        a: Party,
        /// The other side.
        b: Party,
        /// Metres, not negative: takes the place of the question's margin for this pair. `None`: the entry is taken
        /// back; taking back what is not there changes nothing.
        margin: Option<f64>,
    },
    /// What may be asked of a pair. It replaces an earlier declaration of the same two parties, whichever comes first.
    DeclareEffects {
        /// One side.
        a: Party,
        /// The other side.
        b: Party,
        /// Of none the pair is not looked at. `None`: the declaration is taken back; taking back what is not there changes
        /// nothing.
        effects: Option<Effects>,
    },
}

/// A body of the scene, by id or by name.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum BodyRef {
    /// As the scene gave it.
    Id(BodyId),
    /// The only way to name a body that an earlier edit of the same list added.
    Name(String),
}

impl From<BodyId> for BodyRef {
    fn from(id: BodyId) -> Self {
        Self::Id(id)
    }
}

impl From<&str> for BodyRef {
    fn from(name: &str) -> Self {
        Self::Name(name.to_owned())
    }
}

/// A body that is to enter a scene.
#[derive(Clone, Debug)]
pub struct NewBody {
    /// UTF-8, not empty, unique among the scene's bodies and robots.
    pub name: String,
    /// In the body's frame.
    pub shape: Arc<Shape>,
    /// Factor of all lengths of the shape, positive.
    pub scale: f64,
    /// Added to the swept radius after scaling; metres, not negative.
    pub padding: f64,
    /// The body's frame in the world, metres.
    pub pose: Pose,
    /// Names of groups, in any order.
    pub groups: Vec<String>,
    /// The layers it is in, one bit each.
    pub layers: u32,
    /// The layers it collides with, one bit each.
    pub mask: u32,
}

impl NewBody {
    /// A body as given: neither scaled nor padded, in no group, in all layers and colliding with all.
    #[must_use]
    pub fn new(name: impl Into<String>, shape: Arc<Shape>, pose: Pose) -> Self {
        let name = name.into();
        Self { name, shape, scale: 1.0, padding: 0.0, pose, groups: Vec::new(), layers: u32::MAX, mask: u32::MAX }
    }
}
