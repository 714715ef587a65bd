//! What it costs to lead contacts on when some bodies have moved, beside measuring all pairs anew; and the pairs that changed.
//!
//! `cargo bench --no-default-features --bench contacts`, below a minute. Boxes of 0.3 to 0.5 m fill a cube so that a tenth of them touch.

use std::sync::Arc;
use std::time::{Duration, Instant};

use clearance::geometry::{Pose, Quaternion, Shape, Vec3};
use clearance::limits::Limits;
use clearance::query::{ContactQuestion, ContactTracker, Context, Mode, PairQuery, Prepared, Subject};
use clearance::scene::{BodyId, Edit, Epoch, NewBody, Scene, Snapshot};

/// A place in a cube of as many cubic metres as there are bodies; fractional parts of multiples of irrational numbers
/// fill it evenly.
fn place(i: usize, count: usize) -> Pose {
    let side = libm::cbrt(count as f64);
    let along = |step: f64| side * (i as f64 * step).fract();
    let translation = Vec3::new(along(0.754_877_666_2), along(0.569_840_290_9), along(0.430_159_709_0));
    let turned = Quaternion { w: 1.0, x: along(0.1) / side, y: 0.2, z: 0.0 };
    Pose::new(translation, turned).expect("finite numbers")
}

fn scene_of(count: usize) -> Scene {
    let limits = Limits { max_bodies: usize::MAX, max_edits: usize::MAX, ..Limits::default() };
    let mut scene = Scene::with_limits(Epoch(1), limits);
    let shapes = [0.15, 0.2, 0.25].map(|half| Arc::new(Shape::cuboid(Vec3::repeat(half)).expect("positive lengths")));
    let body = |i: usize| NewBody::new(format!("body {i}"), Arc::clone(&shapes[i % 3]), place(i, count));
    let edits: Vec<Edit> = (0..count).map(|i| Edit::AddBody(body(i))).collect();
    scene.apply(&edits, None).expect("valid edits");
    scene
}

fn collide(snapshot: &Snapshot, subject: Subject) -> usize {
    let context = Context { max_pairs: 1_000_000, ..Context::default() };
    let query = PairQuery { items: vec![subject], mode: Mode::All, context };
    let prepared = Prepared::collide(snapshot, &query).expect("a valid question");
    prepared.answer(&|| false).items[0].pairs.len()
}

fn timed<T>(least: &mut Duration, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    *least = (*least).min(start.elapsed());
    result
}

fn main() {
    const ROUNDS: usize = 7;
    println!("least of {ROUNDS} interleaved rounds, milliseconds");
    println!("bodies, moved, contacts, events, advance, changed pairs, all pairs, all / advance");
    for count in [1_000, 10_000, 100_000] {
        let mut scene = scene_of(count);
        for moved in [count / 1000, count / 100, count / 10, count] {
            let mut tracker =
                ContactTracker::new(ContactQuestion { max_contacts: usize::MAX >> 1, ..ContactQuestion::default() });
            tracker.advance(&scene.snapshot(), &|| false).expect("a valid question");
            let [mut advance, mut changed, mut all] = [Duration::MAX; 3];
            let (mut events, mut contacts) = (0, 0);
            for round in 0..ROUNDS {
                let before = scene.snapshot().revision();
                let edits: Vec<Edit> = (0..moved)
                    .map(|k| {
                        let i = (k * (count / moved) + round * 7) % count;
                        let pose = place(i, count);
                        let shift = Vec3::new(0.05 * (round + 1) as f64, 0.03, -0.02 * round as f64);
                        let pose = Pose::new(pose.translation() + shift, pose.rotation()).expect("finite numbers");
                        Edit::MoveBody { body: BodyId(i as u64 + 1).into(), pose }
                    })
                    .collect();
                scene.apply(&edits, None).expect("valid edits");
                let snapshot = scene.snapshot();
                let led = timed(&mut advance, || tracker.advance(&snapshot, &|| false)).expect("a later revision");
                (events, contacts) = (led.events.len(), led.contacts);
                timed(&mut changed, || collide(&snapshot, Subject::ChangedSince(before)));
                timed(&mut all, || collide(&snapshot, Subject::All));
            }
            let [advance, changed, all] = [advance, changed, all].map(|least| least.as_secs_f64() * 1e3);
            let ratio = all / advance;
            println!("{count}, {moved}, {contacts}, {events}, {advance:.3}, {changed:.3}, {all:.2}, {ratio:.1}");
        }
    }
}
