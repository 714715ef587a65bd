//! How are the scenes? For the first of them in the order of their names, up to a cap, so that a daemon with many scenes does not
//! flood whoever watches it.

use std::fmt;
use std::sync::Arc;

use prometheus_client::collector::Collector;
use prometheus_client::encoding::DescriptorEncoder;

use super::exposition::Exposition;
use super::scene_checks::{SceneChecks, Seen};
use crate::scene::{BroadPhaseHealth, TreeHealth};
use crate::service::{SceneFigures, Service};

/// Figures of scenes.
#[derive(Debug)]
pub(super) struct SceneMetrics {
    service: Arc<Service>,
    checks: Arc<SceneChecks>,
    most: usize,
}

impl SceneMetrics {
    pub fn new(service: Arc<Service>, checks: Arc<SceneChecks>, most: usize) -> Self {
        Self { service, checks, most }
    }
}

type Figure<T> = (&'static str, &'static str, fn(&T) -> Option<f64>);

const FIGURES: [Figure<SceneFigures>; 5] = [
    ("clearance_scene_revision", "The newest revision", |scene| Some(scene.summary.revision.0 as f64)),
    ("clearance_scene_bodies", "Bodies", |scene| Some(scene.summary.bodies as f64)),
    ("clearance_scene_robots", "Robots", |scene| Some(scene.summary.robots as f64)),
    ("clearance_scene_kept_revisions", "Revisions that can be asked", |scene| Some(scene.kept_revisions as f64)),
    ("clearance_scene_waiting_changes", "Changes that wait for their turn or are being made", |scene| {
        Some(scene.waiting_changes as f64)
    }),
];

/// Worked out now and then; the age says how long ago.
const SEEN: [Figure<Seen>; 9] = [
    ("clearance_scene_check_age_seconds", "How long ago the figures below were worked out", |seen| {
        Some(seen.at.elapsed().as_secs_f64())
    }),
    ("clearance_scene_kept_bytes", "Bytes of all kept revisions, each byte once, without shapes", |seen| {
        Some(seen.health.kept_bytes as f64)
    }),
    ("clearance_scene_newest_bytes", "Bytes of the newest revision, without shapes", |seen| {
        Some(seen.health.memory.total() as f64)
    }),
    ("clearance_scene_tree_depth_nodes", "Nodes on the longest way through the tree", |seen| {
        tree(seen, |tree| f64::from(tree.depth))
    }),
    ("clearance_scene_tree_least_depth_nodes", "The least depth that a tree of so many entries can have", |seen| {
        tree(seen, |tree| f64::from(tree.least_depth))
    }),
    ("clearance_scene_tree_surface_cost_nodes", "Nodes that a random point visits on average", |seen| {
        tree(seen, |tree| tree.surface_cost)
    }),
    ("clearance_scene_tree_stale_ratio", "Share of leaves that moves have made worse by 15 % or more", |seen| {
        tree(seen, |tree| tree.stale)
    }),
    ("clearance_scene_tree_fill_ratio", "Share of the places in leaves that are taken", |seen| {
        tree(seen, |tree| tree.fill)
    }),
    ("clearance_scene_tree_debt_entries", "Things that upkeep still has to group anew", |seen| {
        tree(seen, |tree| tree.debt)
    }),
];

fn tree(seen: &Seen, figure: impl FnOnce(&TreeHealth) -> f64) -> Option<f64> {
    match &seen.health.broad_phase {
        BroadPhaseHealth::Tree(tree) => Some(figure(tree)),
        BroadPhaseHealth::SweepAndPrune(_) | BroadPhaseHealth::Exhaustive(_) => None,
    }
}

impl Collector for SceneMetrics {
    fn encode(&self, encoder: DescriptorEncoder) -> fmt::Result {
        let mut out = Exposition::new(encoder);
        let scenes = self.service.scene_figures(self.most);
        let untold = self.service.scene_count().saturating_sub(scenes.len());
        out.gauge("clearance_scenes_untold", "Scenes beyond those that have figures here", untold as f64)?;
        let named: Vec<_> = scenes.into_iter().map(|scene| (scene.summary.name.clone(), scene)).collect();
        write(&mut out, &FIGURES, &named)?;
        let seen: Vec<_> = named.iter().filter_map(|(name, _)| Some((name.clone(), self.checks.of(name)?))).collect();
        write(&mut out, &SEEN, &seen)
    }
}

/// Every figure of every scene.
fn write<T>(out: &mut Exposition<'_>, figures: &[Figure<T>], scenes: &[(String, T)]) -> fmt::Result {
    for (name, help, figure) in figures {
        let rows = scenes.iter().filter_map(|(scene, of)| Some(([("scene", scene.as_str())], figure(of)?)));
        let rows: Vec<_> = rows.collect();
        if !rows.is_empty() {
            out.gauges(name, help, rows)?;
        }
    }
    Ok(())
}
