//! How robots come, go and change.

use std::sync::Arc;

use super::body_changes::same_bits;
use super::change::Fault;
use super::{ChangeKinds, Reason, RobotInScene, Snapshot};
use crate::geometry::Pose;
use crate::limits::{LimitExceeded, Limits};
use crate::robot::RobotModel;

impl Snapshot {
    pub(super) fn add_robot(
        &mut self,
        name: &str,
        model: &Arc<RobotModel>,
        base: &Pose,
        limits: &Limits,
    ) -> Result<(), Fault> {
        self.check_new_name(name, limits)?;
        if name.contains('/') {
            return Err(Reason::NameWithSlash { name: name.to_owned() }.of("name"));
        }
        LimitExceeded::check("max_robots_in_scene", self.robots.len() + 1, limits.max_robots_in_scene)
            .map_err(|limit| Reason::Limit(limit).of("name"))?;
        let mut robot = RobotInScene::new(name.into(), Arc::clone(model), *base, self.next_link);
        robot.self_pairs = robot.self_pairs_under(&self.allowed, &self.effects);
        self.next_link += model.links().len() as u64;
        self.changes.robot(&robot.name, ChangeKinds::ADDED);
        let place = self.robots.partition_point(|other| *other.name < *name);
        Arc::make_mut(&mut self.robots).insert(place, Arc::new(robot));
        Ok(())
    }

    pub(super) fn move_robot(&mut self, name: &str, base: &Pose) -> Result<(), Fault> {
        let place = self.place_of_robot(name, "robot")?;
        let robot = &self.robots[place];
        if !same_bits(&robot.base, base) {
            self.changes.robot(&robot.name, ChangeKinds::MOVED);
            Arc::make_mut(&mut Arc::make_mut(&mut self.robots)[place]).base = *base;
        }
        Ok(())
    }

    pub(super) fn remove_robot(&mut self, name: &str) -> Result<(), Fault> {
        let place = self.place_of_robot(name, "robot")?;
        let robot = Arc::make_mut(&mut self.robots).remove(place);
        self.changes.robot(&robot.name, ChangeKinds::REMOVED);
        robot.link_keys().chain(robot.key).for_each(|party| self.forget_entries_of(party));
        Ok(())
    }

    /// Where the robot of that name is in the list.
    pub(super) fn place_of_robot(&self, name: &str, field: &'static str) -> Result<usize, Fault> {
        let place = self.robots.binary_search_by(|robot| (*robot.name).cmp(name));
        place.map_err(|_| Reason::UnknownRobot { name: name.to_owned() }.of(field))
    }

    /// Works out the self-collision pairs anew, for a matrix that has changed.
    pub(super) fn settle_self_pairs(&mut self) {
        for place in 0..self.robots.len() {
            let robot = &self.robots[place];
            let pairs = robot.self_pairs_under(&self.allowed, &self.effects);
            if pairs != robot.self_pairs {
                Arc::make_mut(&mut Arc::make_mut(&mut self.robots)[place]).self_pairs = pairs;
            }
        }
    }
}
