//! How good are the scenes' trees? Looking at a whole scene takes milliseconds, so no scrape does it: one thread at a time looks
//! at the scenes that changed, one after the other, and rests in between, so that it takes a small share of one core.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use tokio::task::spawn_blocking;
use tokio::time::sleep;

use crate::service::{SceneHealth, Service};

/// After looking at a scene for a time, this many times as long nothing is looked at: two parts in a hundred of one core.
const REST: u32 = 50;
/// Between two rounds through all scenes, at the least.
const PAUSE: Duration = Duration::from_secs(5);

/// What was seen last of each scene.
#[derive(Debug, Default)]
pub(super) struct SceneChecks {
    seen: Mutex<BTreeMap<String, Seen>>,
}

/// A scene as it was.
#[derive(Clone, Debug)]
pub(super) struct Seen {
    pub health: SceneHealth,
    pub at: Instant,
}

impl SceneChecks {
    /// What was seen last of a scene.
    pub fn of(&self, scene: &str) -> Option<Seen> {
        self.lock().get(scene).cloned()
    }

    /// Looks at the first `most` scenes, round after round, until it is dropped.
    pub async fn look(self: Arc<Self>, service: Arc<Service>, most: usize) {
        loop {
            self.round(&service, most).await;
            sleep(PAUSE).await;
        }
    }

    async fn round(self: &Arc<Self>, service: &Arc<Service>, most: usize) {
        let scenes = service.scene_figures(most);
        let is_there = |name: &String| scenes.iter().any(|scene| scene.summary.name == *name);
        self.lock().retain(|name, _| is_there(name));
        for scene in scenes {
            let now = scene.summary;
            let known = self.of(&now.name);
            if known.is_some_and(|seen| (seen.health.epoch, seen.health.revision) == (now.epoch, now.revision)) {
                continue;
            }
            let (service, begun) = (Arc::clone(service), Instant::now());
            let looked = spawn_blocking(move || service.scene_health_here(&now.name)).await;
            // A defect while looking is in the log; the daemon goes on, and so does the next round.
            if let Ok(Some(health)) = looked {
                self.lock().insert(health.name.clone(), Seen { health, at: Instant::now() });
            }
            sleep(begun.elapsed() * REST).await;
        }
    }

    /// The map is whole after every statement.
    fn lock(&self) -> std::sync::MutexGuard<'_, BTreeMap<String, Seen>> {
        self.seen.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::service::Config;

    #[tokio::test]
    async fn scenes_are_looked_at_once_for_each_revision_and_forgotten_when_they_are_gone() {
        let service = Service::new(&Config { threads: 1, ..Config::default() }).unwrap();
        for name in ["a", "b", "c"] {
            service.create_scene(name, &Default::default()).unwrap();
        }
        let checks = Arc::new(SceneChecks::default());
        checks.round(&service, 2).await;
        let first = checks.of("a").unwrap().at;
        assert!(checks.of("b").is_some() && checks.of("c").is_none(), "only so many are looked at");
        checks.round(&service, 2).await;
        assert_eq!(checks.of("a").unwrap().at, first, "nothing changed");
        service.delete_scene("a").unwrap();
        checks.round(&service, 2).await;
        assert!(checks.of("a").is_none() && checks.of("c").is_some());
    }
}
