//! Scenes as others follow them: a token for each, and a publication of its steps that lasts as long as somebody listens.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;

use prost::Message;
use tokio::runtime::Handle;
use tokio::sync::watch;
use tokio::task::{AbortHandle, JoinSet};
use zenoh::bytes::Encoding;
use zenoh::liveliness::LivelinessToken;
use zenoh::qos::CongestionControl;
use zenoh::{Result, Session, Wait};
use zenoh_ext::{AdvancedPublisher, AdvancedPublisherBuilderExt, CacheConfig, MissDetectionConfig};

use super::callers::token;
use super::calls::Desk;
use crate::scene::Epoch;
use crate::service::{SceneSummary, ServiceError};
use crate::transports::requests;
use crate::transports::wire::v1;

/// A publication goes on so long without anybody who listens: a connection that is cut and healed misses nothing that is kept.
const GRACE: Duration = Duration::from_secs(60);
/// Subscribers are told this often at least how far the publication is, while it is new; less often when nothing happens.
const HEARTBEAT: Duration = Duration::from_millis(500);
/// When all places for watchers are taken, the next try is after so long.
const AGAIN: Duration = Duration::from_secs(1);

/// The scenes that others know of.
#[derive(Debug)]
pub(super) struct Scenes {
    desk: Arc<Desk>,
    session: Session,
    by_name: BTreeMap<String, Told>,
    publications: JoinSet<()>,
}

/// One scene.
#[derive(Debug)]
struct Told {
    epoch: Epoch,
    publication: AbortHandle,
    _token: LivelinessToken,
}

impl Drop for Told {
    fn drop(&mut self) {
        self.publication.abort();
    }
}

impl Scenes {
    pub fn new(session: &Session, desk: &Arc<Desk>) -> Self {
        let (desk, session) = (Arc::clone(desk), session.clone());
        Self { desk, session, by_name: BTreeMap::new(), publications: JoinSet::new() }
    }

    /// Follows scenes as they come and go, until it is dropped; publications end with it.
    pub async fn run(mut self) {
        let mut changed = self.desk.service.scenes_changed();
        loop {
            if let Err(error) = self.follow().await {
                tracing::warn!("scenes cannot be told of through zenoh: {error}");
                return;
            }
            tokio::select! {
                // The service lasts as long as its doors.
                Ok(()) = changed.changed() => {}
                Some(_) = self.publications.join_next() => {}
            }
        }
    }

    async fn follow(&mut self) -> Result<()> {
        let scenes: BTreeMap<String, SceneSummary> =
            self.desk.service.scenes().into_iter().map(|scene| (scene.name.clone(), scene)).collect();
        self.by_name.retain(|name, told| scenes.get(name).is_some_and(|scene| scene.epoch == told.epoch));
        for (name, scene) in scenes {
            if self.by_name.contains_key(&name) {
                continue;
            }
            let keys = &self.desk.keys;
            let publisher = self
                .session
                .declare_publisher(keys.changes(&name))
                .encoding(Encoding::APPLICATION_PROTOBUF)
                // Nobody waits for a slow reader: what it misses it finds out, and asks for.
                .congestion_control(CongestionControl::Drop)
                .cache(CacheConfig::default().max_samples(self.desk.service.limits().max_zenoh_cache))
                .sample_miss_detection(MissDetectionConfig::default().sporadic_heartbeat(HEARTBEAT))
                .publisher_detection()
                .await?;
            let publication =
                Publication { desk: Arc::clone(&self.desk), scene: name.clone(), epoch: scene.epoch, publisher };
            // On a handle of our own: a runtime that ends drops the task at once, and zenoh's publisher, as it goes, enters a
            // runtime, which panics while `spawn` itself looks at the current one.
            let publication = self.publications.spawn_on(publication.run(), &Handle::current());
            let _token = token(&self.session, keys.scene_alive(&name)).await?;
            self.by_name.insert(name, Told { epoch: scene.epoch, publication, _token });
        }
        Ok(())
    }
}

/// The steps of one scene.
struct Publication {
    desk: Arc<Desk>,
    scene: String,
    epoch: Epoch,
    publisher: AdvancedPublisher<'static>,
}

impl Publication {
    /// Tells steps whenever somebody listens, until the scene is gone.
    async fn run(self) {
        let Ok(mut heard) = self.listeners().await else { return };
        while heard.wait_for(|heard| *heard).await.is_ok() {
            let over = tokio::select! {
                over = self.steps() => over,
                () = unheard(heard.clone()) => continue,
            };
            if let ServiceError::Limit(full) = over {
                tracing::warn!(scene = self.scene, "steps are not told through zenoh: {full}");
                tokio::time::sleep(AGAIN).await;
            } else {
                tracing::debug!(scene = self.scene, "steps are not told through zenoh any more: {over}");
                return;
            }
        }
    }

    /// Whether somebody listens, as it changes.
    async fn listeners(&self) -> Result<watch::Receiver<bool>> {
        let (told, heard) = watch::channel(false);
        let told = Arc::new(told);
        let tells = Arc::clone(&told);
        let listener = self.publisher.matching_listener();
        listener.callback(move |status| _ = tells.send_replace(status.matching())).background().await?;
        if self.publisher.matching_status().await?.matching() {
            told.send_replace(true);
        }
        Ok(heard)
    }

    /// Tells steps from the newest revision on; returns why there are no more.
    async fn steps(&self) -> ServiceError {
        let newest = self.desk.service.scenes().into_iter().find(|scene| scene.name == self.scene);
        let request = v1::WatchRequest {
            scene: self.scene.clone(),
            epoch: Some(self.epoch.0),
            from_revision: newest.map(|scene| scene.revision.0),
            shapes: true,
        };
        let mut steps = match requests::watch(&self.desk.service, &request, None) {
            Ok(steps) => steps,
            Err(error) => return error,
        };
        loop {
            let message = match steps.next().await {
                Ok(message) => message.encode_to_vec(),
                Err(error) => return error,
            };
            self.desk.sent(message.len());
            // Where a subscriber does not read, this waits a while before the step is dropped.
            let put = || self.publisher.put(message).wait();
            if let Err(error) = tokio::task::block_in_place(put) {
                tracing::debug!(scene = self.scene, "a step was not told through zenoh: {error}");
            }
        }
    }
}

/// Waits until nobody has listened for the time of grace.
async fn unheard(mut heard: watch::Receiver<bool>) {
    while heard.wait_for(|heard| !heard).await.is_ok() {
        tokio::select! {
            () = tokio::time::sleep(GRACE) => return,
            _ = heard.wait_for(|heard| *heard) => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc;

    use tokio::runtime::Builder;

    use super::super::config::Config;
    use super::*;
    use crate::limits::Limits;
    use crate::scene::SceneOptions;
    use crate::service::Service;

    /// Whether the runtime drops what it is given.
    fn takes_no_tasks() -> bool {
        let (alive, gone) = mpsc::channel::<()>();
        let task = Handle::current().spawn(async move {
            std::future::pending::<()>().await;
            drop(alive);
        });
        let is_gone = gone.try_recv() == Err(mpsc::TryRecvError::Disconnected);
        task.abort();
        is_gone
    }

    #[test]
    fn a_scene_that_comes_while_the_runtime_ends_is_let_go_in_peace() {
        let runtime = Builder::new_multi_thread().worker_threads(2).enable_all().build().unwrap();
        let (ready, is_ready) = mpsc::channel();
        let (told, followed) = mpsc::channel();
        runtime.spawn(async move {
            let service = Service::new(&crate::service::Config { threads: 1, ..Default::default() }).unwrap();
            let config = Config::on_loopback("ends");
            let session = zenoh::open(config.of_zenoh(&Limits::default()).unwrap()).await.unwrap();
            let desk = Desk::new(&session, &service, &config.keys().unwrap()).await.unwrap();
            let mut scenes = Scenes::new(&session, &desk);
            desk.service.create_scene("late", &SceneOptions::default()).unwrap();
            ready.send(()).unwrap();
            while !takes_no_tasks() {
                std::thread::sleep(Duration::from_millis(1));
            }
            told.send(scenes.follow().await.is_ok()).unwrap();
        });
        is_ready.recv().unwrap();
        runtime.shutdown_background();
        // It went through to the end, and did not panic.
        assert_eq!(followed.recv(), Ok(true));
    }
}
