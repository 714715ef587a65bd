//! A robot and the scenes that it plans in, for experiments with its states and motions.

use std::sync::Arc;

use crate::geometry::Pose;
use crate::robot::RobotModel;
use crate::scene::{Edit, NewBody};

/// The robot's name in its scenes.
pub(super) const ROBOT: &str = "robot";

/// Bodies around a robot, and states of it.
#[derive(Clone, Debug)]
pub struct PlannerScene {
    /// What it is called.
    pub name: String,
    /// All bodies.
    pub bodies: Vec<NewBody>,
    /// Joint positions.
    pub states: Vec<Vec<f64>>,
}

/// A robot with the scenes it plans in.
#[derive(Clone, Debug)]
pub struct Planner {
    /// What it is called.
    pub name: String,
    /// The robot.
    pub robot: Arc<RobotModel>,
    /// Where it stands.
    pub scenes: Vec<PlannerScene>,
}

impl Planner {
    /// The edits that make a scene with the robot in it.
    pub(super) fn edits(&self, scene: &PlannerScene) -> Vec<Edit> {
        let robot = Edit::AddRobot { name: ROBOT.to_owned(), model: Arc::clone(&self.robot), base: Pose::identity() };
        scene.bodies.iter().cloned().map(Edit::AddBody).chain([robot]).collect()
    }
}
