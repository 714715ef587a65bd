//! Scenes that are followed. Oracle: a copy led by what is told has every body where the scene has it, whatever was missed.

use std::collections::BTreeMap;
use std::sync::atomic::Ordering;
use std::time::Duration;

use clearance::limits::Limits;
use clearance::transports::wire::v1;
use clearance::transports::zenoh::{Client, ClientError, Follower};
use prost::Message;

use super::{get_scene, moved, with_balls};
use crate::support::door::Door;
use crate::support::messages::*;
use crate::support::network::Network;
use crate::support::watchdog::watched;
use crate::support::zenoh_door::{PREFIX, Zenoh};

/// Where bodies are, by name, as far as it was told.
#[derive(Debug, Default)]
struct Copy {
    revision: u64,
    ids: BTreeMap<u64, String>,
    places: BTreeMap<String, f64>,
    /// Messages that led it from nothing, and those that led it on.
    whole: usize,
    steps: usize,
}

fn x(pose: Option<v1::Pose>) -> f64 {
    pose.unwrap().translation.unwrap().x
}

impl Copy {
    fn follow(&mut self, message: v1::WatchResponse) {
        match message.from_revision {
            None if self.whole == 0 || message.compacted => {
                *self = Self { whole: self.whole + 1, steps: self.steps, ..Self::default() };
            }
            None => {}
            Some(from) => {
                assert_eq!(from, self.revision, "it leads on from where the copy is");
                self.steps += 1;
            }
        }
        for id in message.removed_bodies {
            let name = self.ids.remove(&id).unwrap();
            self.places.remove(&name);
        }
        for watched in message.bodies {
            let body = watched.body.unwrap();
            self.places.insert(body.name.clone(), x(body.pose));
            self.ids.insert(body.id, body.name);
        }
        for one in message.moved {
            self.places.insert(self.ids[&one.id].clone(), x(one.pose));
        }
        if !message.more {
            self.revision = message.revision;
        }
    }

    /// Follows until it is at a revision.
    async fn reach(&mut self, follower: &mut Follower<'_>, revision: u64) {
        while self.revision < revision {
            self.follow(watched("a step", follower.next()).await.unwrap());
        }
    }
}

async fn is_the_scene(door: &Zenoh, copy: &Copy) {
    let contents = door.get_scene(get_scene()).await.unwrap();
    let places: BTreeMap<_, _> = contents.bodies.into_iter().map(|body| (body.name, x(body.pose))).collect();
    assert_eq!((copy.revision, &copy.places), (contents.revision, &places));
}

#[tokio::test(flavor = "multi_thread")]
async fn a_copy_is_led_by_what_is_published() {
    let door = with_balls(Limits::default(), 3).await;
    let (mut follower, mut copy) = (door.client.follow(SCENE).await.unwrap(), Copy::default());
    copy.reach(&mut follower, 1).await;
    is_the_scene(&door, &copy).await;
    for i in 2..=40_u32 {
        let edits = match i % 4 {
            0 => vec![add(&format!("new {i}"), sphere(0.2), at(f64::from(i), 0.0, 0.0))],
            1 if i > 4 => vec![remove(named(&format!("new {}", i - 1)))],
            _ => vec![move_to(named("ball 1"), at(f64::from(i), 0.0, 0.0))],
        };
        door.apply(apply(edits)).await.unwrap();
    }
    copy.reach(&mut follower, 40).await;
    is_the_scene(&door, &copy).await;
    assert_eq!(copy.whole, 1);
    // Without anybody who follows, nothing is published.
    assert_eq!(door.daemon.service.watchers(), 1);
}

#[tokio::test(flavor = "multi_thread")]
async fn nothing_is_published_for_nobody() {
    let door = with_balls(Limits::default(), 1).await;
    door.apply(moved(1.0)).await.unwrap();
    tokio::time::sleep(Duration::from_millis(200)).await;
    assert_eq!(door.daemon.service.watchers(), 0);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_scene_that_is_deleted_ends_what_follows_it_and_one_of_the_same_name_is_followed_anew() {
    let door = with_balls(Limits::default(), 1).await;
    let mut follower = door.client.follow(SCENE).await.unwrap();
    watched("content", follower.next()).await.unwrap();
    door.delete_scene(SCENE).await.unwrap();
    door.create_scene(SCENE).await.unwrap();
    door.apply(apply(vec![add("other", sphere(0.1), at(5.0, 0.0, 0.0))])).await.unwrap();
    // The next life of the scene tells on the same key, and everything comes anew.
    let message = watched("the next life", async {
        loop {
            let message = follower.next().await.unwrap();
            if message.bodies.iter().any(|body| body.body.as_ref().unwrap().name == "other") {
                return message;
            }
        }
    });
    assert_eq!(message.await.from_revision, None);
    let mut nowhere = door.client.follow("nowhere").await.unwrap();
    let ClientError::Refused(refusal) = watched("a refusal", nowhere.next()).await.unwrap_err() else { panic!() };
    assert_eq!(refusal.reason, "NOT_FOUND");
}

/// Cuts the cable, changes the scene so often, heals it: the copy is the scene again.
async fn cut_and_healed(edits: u32, limits: Limits) -> Copy {
    let door = with_balls(limits, 2).await;
    let network = Network::to(door.endpoint.strip_prefix("tcp/").unwrap()).await;
    let far = Client::connect(&format!("tcp/{}", network.address), PREFIX).await.unwrap();
    let (mut follower, mut copy) = (far.follow(SCENE).await.unwrap(), Copy::default());
    copy.reach(&mut follower, 1).await;
    door.apply(moved(0.5)).await.unwrap();
    copy.reach(&mut follower, 2).await;
    network.state.cut.store(true, Ordering::Release);
    // The connection is gone for both sides.
    let cut = async { while far.call("Server/GetServerInfo", [], Duration::from_millis(300)).await.is_ok() {} };
    watched("the cut", cut).await;
    for i in 0..edits {
        door.apply(moved(f64::from(i))).await.unwrap();
    }
    network.state.cut.store(false, Ordering::Release);
    copy.reach(&mut follower, 2 + u64::from(edits)).await;
    is_the_scene(&door, &copy).await;
    copy
}

#[tokio::test(flavor = "multi_thread")]
async fn what_a_cut_connection_missed_is_told_when_it_heals() {
    let copy = cut_and_healed(20, Limits::default()).await;
    assert_eq!(copy.whole, 1);
    assert!(copy.steps > 1);
}

/// The publisher keeps less than was missed: the scene's log leads on.
#[tokio::test(flavor = "multi_thread")]
async fn beyond_the_cache_the_log_of_the_scene_leads_on() {
    let limits = Limits { max_zenoh_cache: 2, snapshots_kept: 100, ..Limits::default() };
    let copy = cut_and_healed(60, limits).await;
    assert_eq!(copy.whole, 1);
}

/// Neither reaches back: the whole content comes again.
#[tokio::test(flavor = "multi_thread")]
async fn beyond_the_log_everything_is_told_anew() {
    let limits = Limits { max_zenoh_cache: 2, snapshots_kept: 3, ..Limits::default() };
    let copy = cut_and_healed(60, limits).await;
    assert_eq!(copy.whole, 2);
}

/// What is published is numbered and kept: a subscriber that comes late is given the last steps without asking for them.
#[tokio::test(flavor = "multi_thread")]
async fn a_late_subscriber_is_given_what_is_kept() {
    use zenoh_ext::{AdvancedSubscriberBuilderExt, HistoryConfig};
    let door = with_balls(Limits::default(), 1).await;
    let mut follower = door.client.follow(SCENE).await.unwrap();
    let mut copy = Copy::default();
    for i in 2..=6_u64 {
        door.apply(moved(i as f64)).await.unwrap();
        copy.reach(&mut follower, i).await;
    }
    let late = Client::connect(&door.endpoint, PREFIX).await.unwrap();
    let history = HistoryConfig::default();
    let subscriber = late.session().declare_subscriber(late.keys().changes(SCENE)).history(history).await.unwrap();
    let mut last = 0;
    while last < 6 {
        let sample = watched("a step that is kept", subscriber.recv_async()).await.unwrap();
        let message = v1::WatchResponse::decode(&*sample.payload().to_bytes()).unwrap();
        assert!(message.revision >= last, "in order");
        last = message.revision;
    }
}
