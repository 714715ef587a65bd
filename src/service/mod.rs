//! One writer for each scene, readers on a pool of threads, and everything a caller may run into: caps, deadlines,
//! revisions that are gone or still to come.
//!
//! [`Service`] is what the doors call. It knows neither protobuf nor sockets.

mod admission;
mod answered;
mod assets;
mod call;
mod call_notes;
mod contact_watch;
mod deadline;
mod error;
mod estimate;
mod library;
mod measured;
mod mesh_cards;
mod observer;
mod pose_feed;
mod prices;
mod published;
mod remembered_keys;
mod revision_rule;
mod robots;
mod scene_cell;
mod scene_health;
mod scene_watch;
mod scenes;
mod seldom;
#[expect(clippy::module_inception, reason = "the service of the floor `service`")]
mod service;
mod traffic;
mod view;
mod workers;

pub use admission::Permit;
pub use answered::{Answered, CountedItem, Question, Verdicts};
pub use assets::{ContentHash, NotAHash, Stored, Upload};
pub use call::Call;
pub use call_notes::{Asker, CallNotes, Rpc};
pub use contact_watch::ContactWatch;
pub use deadline::{Patience, Waiting};
pub use error::ServiceError;
pub use estimate::{Estimate, EstimateEnd, Estimated, LADDER, MOTION_LADDER};
pub use library::{Library, MeshReading, UnusableMesh};
pub use mesh_cards::{MeshCardRequest, TimedMeshCard};
pub use observer::{Ending, Observer, Outcome};
pub use pose_feed::{NewPose, PoseFeed, PoseOf, PosesMade, RefusedPose};
pub use prices::{MeanCost, Price, Times, Widths};
pub use remembered_keys::IdempotencyKey;
pub use revision_rule::{RevisionRule, Rule};
pub use robots::{LoadedRobot, RobotDescription, Robots};
pub use scene_cell::Change;
pub use scene_health::{KeptRevision, SceneHealth};
pub use scene_watch::{SceneStep, SceneWatch};
pub use scenes::{SceneFigures, SceneSummary};
pub use seldom::Seldom;
pub use service::{Changed, Config, Door, FEW_ITEMS, Service, Target};
pub use traffic::{Count, Traffic};
pub use view::View;
