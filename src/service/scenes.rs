//! Which scenes are there? Names to scenes; looking one up waits for nobody.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{SystemTime, UNIX_EPOCH};

use arc_swap::ArcSwap;
use tokio::sync::watch;

use super::ServiceError;
use super::scene_cell::SceneCell;
use crate::limits::{LimitExceeded, Limits};
use crate::scene::{BroadPhaseKind, Epoch, Revision, SceneOptions};

/// One scene, in short.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneSummary {
    /// Unique in the daemon.
    pub name: String,
    /// When it began.
    pub epoch: Epoch,
    /// Its newest revision.
    pub revision: Revision,
    /// How many bodies.
    pub bodies: usize,
    /// How many robots.
    pub robots: usize,
    /// How bodies are found that meet.
    pub broad_phase: BroadPhaseKind,
}

/// What can be told of a scene without looking at all of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneFigures {
    /// In short.
    pub summary: SceneSummary,
    /// Revisions that can be asked.
    pub kept_revisions: usize,
    /// Changes that wait for their turn or are being made.
    pub waiting_changes: usize,
}

/// The scenes of the daemon.
#[derive(Debug)]
pub(super) struct Scenes {
    limits: Limits,
    by_name: ArcSwap<BTreeMap<String, Arc<SceneCell>>>,
    /// Held while the map is replaced.
    changing: Mutex<()>,
    next_epoch: AtomicU64,
    /// Sent to whenever scenes come or go.
    changed: watch::Sender<()>,
}

impl Scenes {
    /// Epochs begin at the microseconds since 1970, so that a daemon started again does not repeat them.
    pub fn new(limits: &Limits) -> Self {
        let since_1970 = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        Self {
            limits: limits.clone(),
            by_name: ArcSwap::default(),
            changing: Mutex::default(),
            next_epoch: AtomicU64::new(u64::try_from(since_1970.as_micros()).unwrap_or(1)),
            changed: watch::Sender::new(()),
        }
    }

    pub fn create(&self, name: &str, options: &SceneOptions) -> Result<SceneSummary, ServiceError> {
        if name.is_empty() {
            return Err(ServiceError::invalid("name", "is empty"));
        }
        LimitExceeded::check("max_name_bytes", name.len(), self.limits.max_name_bytes)?;
        let _changing = self.changing.lock().unwrap_or_else(PoisonError::into_inner);
        let mut by_name = BTreeMap::clone(&self.by_name.load());
        if by_name.contains_key(name) {
            return Err(ServiceError::AlreadyExists { what: "scene", name: name.to_owned() });
        }
        LimitExceeded::check("max_scenes", by_name.len() + 1, self.limits.max_scenes)?;
        let epoch = Epoch(self.next_epoch.fetch_add(1, Ordering::Relaxed));
        let cell = SceneCell::new(name.to_owned(), epoch, &self.limits, options);
        let summary = cell.summary();
        by_name.insert(name.to_owned(), Arc::new(cell));
        self.by_name.store(Arc::new(by_name));
        self.changed.send_replace(());
        Ok(summary)
    }

    pub fn get(&self, name: &str) -> Result<Arc<SceneCell>, ServiceError> {
        self.by_name.load().get(name).cloned().ok_or_else(|| not_found(name))
    }

    pub fn delete(&self, name: &str) -> Result<SceneSummary, ServiceError> {
        let _changing = self.changing.lock().unwrap_or_else(PoisonError::into_inner);
        let mut by_name = BTreeMap::clone(&self.by_name.load());
        let cell = by_name.remove(name).ok_or_else(|| not_found(name))?;
        self.by_name.store(Arc::new(by_name));
        cell.delete();
        self.changed.send_replace(());
        Ok(cell.summary())
    }

    /// Changes whenever scenes come or go.
    pub fn changed(&self) -> watch::Receiver<()> {
        self.changed.subscribe()
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.by_name.load().len()
    }

    /// Of the first `most` in the order of their names.
    pub fn figures(&self, most: usize) -> Vec<SceneFigures> {
        self.by_name.load().values().take(most).map(|cell| cell.figures()).collect()
    }

    /// In the order of their names.
    pub fn list(&self) -> Vec<SceneSummary> {
        self.by_name.load().values().map(|cell| cell.summary()).collect()
    }
}

fn not_found(name: &str) -> ServiceError {
    ServiceError::NotFound { what: "scene", name: name.to_owned() }
}
