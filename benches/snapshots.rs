//! Does an edit cost what it changes, or what the scene holds? Edits through `Scene::apply`, each making a revision, in
//! scenes from a thousand bodies to a million; and what the kept revisions hold.
//!
//! `cargo bench --no-default-features --bench snapshots`, about a minute. A number after `--` is the largest N.

use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use clearance::geometry::{Pose, Quaternion, Shape, Vec3};
use clearance::limits::Limits;
use clearance::scene::{BodyId, BroadPhaseKind, Edit, Epoch, NewBody, Party, Scene, SceneOptions};

/// A place in a cube with about half a pair a body, and a little off it.
fn place(i: usize, count: usize, off: f64) -> Pose {
    let side = 1.6 * libm::cbrt(count as f64);
    let along = |step: f64| side * (i as f64 * step).fract() + off;
    let translation = Vec3::new(along(0.754_877_666_2), along(0.569_840_290_9), along(0.430_159_709_0));
    Pose::new(translation, Quaternion::IDENTITY).expect("finite numbers")
}

fn nearby(i: usize, count: usize, round: usize) -> Pose {
    place(i, count, 0.05 * ((i * 31 + round * 17) % 97) as f64 / 97.0)
}

fn scene_of(count: usize, broad_phase: BroadPhaseKind) -> (Scene, f64) {
    let limits = Limits { max_bodies: usize::MAX, max_edits: usize::MAX, ..Limits::default() };
    let mut scene = Scene::with_options(Epoch(1), limits, &SceneOptions { broad_phase });
    let shape = Arc::new(Shape::cuboid(Vec3::repeat(0.5)).expect("positive"));
    let body = |i: usize| NewBody {
        groups: vec![format!("group {}", i % 16)],
        ..NewBody::new(format!("body {i}"), Arc::clone(&shape), place(i, count, 0.0))
    };
    let edits: Vec<Edit> = (0..count).map(|i| Edit::AddBody(body(i))).collect();
    let begun = Instant::now();
    scene.apply(&edits, None).expect("valid edits");
    (scene, begun.elapsed().as_secs_f64() * 1e3)
}

fn move_one(i: usize, count: usize, round: usize) -> Edit {
    Edit::MoveBody { body: BodyId(i as u64 + 1).into(), pose: nearby(i, count, round) }
}

/// Median of the rounds, microseconds. Edits are made before the clock starts.
fn measured(rounds: usize, scene: &mut Scene, mut edits: impl FnMut(usize) -> Vec<Edit>) -> f64 {
    let mut times: Vec<f64> = (0..rounds)
        .map(|round| {
            let edits = edits(round);
            let begun = Instant::now();
            black_box(scene.apply(&edits, None)).expect("valid edits");
            begun.elapsed().as_secs_f64() * 1e6
        })
        .collect();
    times.sort_unstable_by(f64::total_cmp);
    times[rounds / 2]
}

/// The same for edits that are only supposed, on the scene's newest revision. Letting the hypothesis go counts.
fn supposed(rounds: usize, scene: &Scene, mut edits: impl FnMut(usize) -> Vec<Edit>) -> f64 {
    let (snapshot, limits) = (scene.snapshot(), Limits::default());
    let mut times: Vec<f64> = (0..rounds)
        .map(|round| {
            let edits = edits(round);
            let begun = Instant::now();
            drop(black_box(snapshot.suppose(&edits, &limits)).expect("valid edits"));
            begun.elapsed().as_secs_f64() * 1e6
        })
        .collect();
    times.sort_unstable_by(f64::total_cmp);
    times[rounds / 2]
}

fn main() {
    let largest = std::env::args().filter_map(|argument| argument.parse::<usize>().ok()).next().unwrap_or(1_000_000);
    println!("Microseconds an Apply, a revision published with each.\n");
    println!(
        "| N | broad phase | built (ms) | nothing | move 1 | add and remove 1 | allow 1 pair | what if 1 moved | what if 10 moved | move 1 % | the same, each | bytes a body, written by 1 % |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    for count in [1_000, 10_000, 100_000, 1_000_000].into_iter().filter(|count| *count <= largest) {
        for kind in [BroadPhaseKind::Tree, BroadPhaseKind::SweepAndPrune, BroadPhaseKind::Exhaustive] {
            row(count, kind);
        }
    }
}

fn row(count: usize, kind: BroadPhaseKind) {
    let (mut scene, built) = scene_of(count, kind);
    let some = |round: usize| (round * 7919) % count;
    let nothing = measured(101, &mut scene, |_| Vec::new());
    let one = measured(301, &mut scene, |round| vec![move_one(some(round), count, round)]);
    let shape = Arc::new(Shape::sphere(0.3).expect("positive"));
    let in_and_out = measured(101, &mut scene, |round| {
        let new = NewBody::new("one more", Arc::clone(&shape), place(some(round), count, 0.0));
        vec![Edit::AddBody(new), Edit::RemoveBody { body: "one more".into() }]
    });
    let allow = measured(101, &mut scene, |round| {
        let party = |i: usize| Party::Body(BodyId(i as u64 + 1).into());
        vec![Edit::SetAllowedCollision { a: party(some(round)), b: party(some(round + 1)), allowed: Some(true) }]
    });
    // Elsewhere than the moves above have led to: a move to where a body is costs nothing.
    let what_if = supposed(301, &scene, |round| vec![move_one(some(round), count, round + 50)]);
    let what_if_ten =
        supposed(101, &scene, |round| (0..10).map(|i| move_one(some(10 * round + i), count, round + 50)).collect());
    let hundredth = count / 100;
    let percent = measured(41, &mut scene, |round| {
        (0..hundredth).map(|i| move_one(some(round * hundredth + i), count, round)).collect()
    });
    let each = percent / hundredth as f64;
    let snapshot = scene.snapshot();
    let (bytes, written) = (snapshot.memory().total() / count, snapshot.written() / hundredth);
    println!(
        "| {count} | {kind:?} | {built:.1} | {nothing:.2} | {one:.1} | {in_and_out:.1} | {allow:.1} | {what_if:.1} | {what_if_ten:.1} | {percent:.0} | {each:.2} | {bytes}, {written} each |"
    );
}
