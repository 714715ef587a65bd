//! Does a reader feel the writer? One thread asks box and distance questions of the newest snapshot of a scene of 100 000
//! bodies; in every second window another moves one body in a hundred, a hundred times a second, and publishes.
//!
//! `cargo bench --no-default-features --bench readers_writer`, half a minute. Each thread is bound to a core of its own where
//! there are two. It prints the 99th percentile with and without the writer in each pair of windows, and the median of
//! their ratios. Snapshots change hands as in the daemon, through arc-swap: the reader loads, it takes no lock.

use std::hint::black_box;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use arc_swap::ArcSwap;
use clearance::geometry::{Aabb, Pose, Quaternion, Shape, Vec3};
use clearance::limits::Limits;
use clearance::query::{Context, Mode, PairQuery, Prepared, Subject, Wants};
use clearance::scene::{BodyId, Edit, Epoch, NewBody, Scene, Snapshot};

const BODIES: usize = 100_000;
const WINDOW: Duration = Duration::from_millis(1_000);
const PAIRS_OF_WINDOWS: usize = 11;
const PERIOD: Duration = Duration::from_millis(10);

fn side() -> f64 {
    1.6 * libm::cbrt(BODIES as f64)
}

/// A point of the cube; fractional parts of multiples of irrational numbers fill it evenly.
fn place(i: usize) -> Vec3 {
    let along = |step: f64| side() * (i as f64 * step).fract();
    Vec3::new(along(0.754_877_666_2), along(0.569_840_290_9), along(0.430_159_709_0))
}

fn pose(at: Vec3) -> Pose {
    Pose::new(at, Quaternion::IDENTITY).expect("finite numbers")
}

fn scene() -> Scene {
    let limits = Limits { max_bodies: BODIES, max_edits: BODIES, ..Limits::default() };
    let mut scene = Scene::with_limits(Epoch(1), limits);
    let shape = Arc::new(Shape::cuboid(Vec3::repeat(0.5)).expect("positive"));
    let body = |i: usize| Edit::AddBody(NewBody::new(format!("body {i}"), Arc::clone(&shape), pose(place(i))));
    scene.apply(&(0..BODIES).map(body).collect::<Vec<_>>(), None).expect("valid edits");
    scene
}

/// Binds the calling thread to a core of its own, if there is one.
fn pin(core: usize) -> bool {
    let cores = core_affinity::get_core_ids().unwrap_or_default();
    cores.get(core).is_some_and(|core| core_affinity::set_for_current(*core))
}

/// One question of each kind; returns their times in nanoseconds.
fn ask(snapshot: &Snapshot, i: usize, probe: &Shape) -> [u64; 2] {
    let at = place(i * 31 + 7);
    let begun = Instant::now();
    let mut met = 0;
    snapshot.broad_phase().overlap(&Aabb::centred(at, Vec3::repeat(0.5)), |_| {
        met += 1;
        ControlFlow::Continue(())
    });
    let boxed = begun.elapsed();
    let items = vec![Subject::Shape { shape: probe.clone(), pose: pose(at) }];
    let context = Context { wants: Wants { distance: true, ..Wants::VERDICT }, ..Context::default() };
    let question = PairQuery { items, mode: Mode::All, context };
    let begun = Instant::now();
    let answer = Prepared::distance(snapshot, &question).expect("a valid question").answer(&|| false);
    let distance = begun.elapsed();
    black_box((met, answer));
    [boxed, distance].map(|time| time.as_nanos() as u64)
}

fn percentile(times: &mut [u64], share: f64) -> f64 {
    times.sort_unstable();
    times[((times.len() - 1) as f64 * share) as usize] as f64 / 1e3
}

fn main() {
    let mut scene = scene();
    let published = ArcSwap::new(scene.snapshot());
    let (writing, done, revisions) = (AtomicBool::new(false), AtomicBool::new(false), AtomicUsize::new(0));
    let mut ratios = [Vec::new(), Vec::new()];
    thread::scope(|scope| {
        scope.spawn(|| {
            let pinned = pin(1);
            let mut round = 0;
            let mut due = Instant::now();
            while !done.load(Ordering::Acquire) {
                due = (due + PERIOD).max(Instant::now());
                if writing.load(Ordering::Acquire) {
                    let moved = |k: usize| {
                        let i = (round * 7919 + k * 101) % BODIES;
                        let by = 0.05 * ((i * 31 + round * 17) % 97) as f64 / 97.0;
                        Edit::MoveBody { body: BodyId(i as u64 + 1).into(), pose: pose(place(i) + Vec3::repeat(by)) }
                    };
                    scene.apply(&(0..BODIES / 100).map(moved).collect::<Vec<_>>(), None).expect("valid edits");
                    published.store(scene.snapshot());
                    revisions.fetch_add(1, Ordering::Relaxed);
                    round += 1;
                }
                thread::sleep(due.saturating_duration_since(Instant::now()));
            }
            println!("writer bound to a core of its own: {pinned}; revisions: {}", revisions.load(Ordering::Relaxed));
        });
        println!("reader bound to a core of its own: {}\n", pin(0));
        println!("| window | box query p99 without, with (us) | ratio | distance p99 without, with (us) | ratio |");
        println!("| --- | --- | --- | --- | --- |");
        let probe = Shape::sphere(0.3).expect("positive");
        let mut i = 0;
        for window in 0..PAIRS_OF_WINDOWS {
            let mut p99 = [[0.0; 2]; 2];
            for with in [false, true] {
                writing.store(with, Ordering::Release);
                thread::sleep(2 * PERIOD);
                let mut times = [Vec::new(), Vec::new()];
                let begun = Instant::now();
                while begun.elapsed() < WINDOW {
                    let took = ask(&published.load(), i, &probe);
                    times.iter_mut().zip(took).for_each(|(times, took)| times.push(took));
                    i += 1;
                }
                p99[usize::from(with)] = times.each_mut().map(|times| percentile(times, 0.99));
            }
            let [without, with] = p99;
            let ratio = [with[0] / without[0], with[1] / without[1]];
            ratios.iter_mut().zip(ratio).for_each(|(ratios, ratio)| ratios.push(ratio));
            println!(
                "| {window} | {:.2}, {:.2} | {:.2} | {:.2}, {:.2} | {:.2} |",
                without[0], with[0], ratio[0], without[1], with[1], ratio[1]
            );
        }
        done.store(true, Ordering::Release);
    });
    let medians = ratios.map(|mut ratios| {
        ratios.sort_unstable_by(f64::total_cmp);
        ratios[ratios.len() / 2]
    });
    println!("\nmedian of the ratios: box query {:.2}, distance {:.2} (target: at most 1.5)", medians[0], medians[1]);
}
