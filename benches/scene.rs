//! What an edit costs in a scene of some size, beside copying the scene; and what the filter costs a pair.
//!
//! `cargo bench --bench scene`, well below a minute.

use std::collections::HashMap;
use std::hint::black_box;
use std::sync::Arc;
use std::time::Duration;

use clearance::geometry::{Pose, Quaternion, Shape, Vec3};
use clearance::limits::Limits;
use clearance::scene::{Body, BodyId, Edit, Epoch, NewBody, Party, Scene};
use criterion::{BenchmarkGroup, BenchmarkId, Criterion, criterion_group, criterion_main};

const SIZES: [usize; 4] = [100, 1_000, 10_000, 100_000];

/// A place in a cube of as many cubic metres as there are bodies.
fn place(i: usize, count: usize) -> Pose {
    let side = libm::cbrt(count as f64);
    // Fractional parts of multiples of irrational numbers fill the cube evenly.
    let along = |step: f64| side * (i as f64 * step).fract();
    let translation = Vec3::new(along(0.754_877_666_2), along(0.569_840_290_9), along(0.430_159_709_0));
    Pose::new(translation, Quaternion::IDENTITY).expect("finite numbers")
}

/// Balls of 0.3 m, in 16 groups.
fn scene_of(count: usize) -> Scene {
    let limits = Limits { max_bodies: usize::MAX, max_edits: usize::MAX, ..Limits::default() };
    let mut scene = Scene::with_limits(Epoch(1), limits);
    let shape = Arc::new(Shape::sphere(0.3).expect("a positive radius"));
    let body = |i: usize| NewBody {
        groups: vec![format!("group {}", i % 16)],
        ..NewBody::new(format!("body {i}"), Arc::clone(&shape), place(i, count))
    };
    let edits: Vec<Edit> = (0..count).map(|i| Edit::AddBody(body(i))).collect();
    scene.apply(&edits, None).expect("valid edits");
    scene
}

fn group<'a>(c: &'a mut Criterion, name: &str) -> BenchmarkGroup<'a, criterion::measurement::WallTime> {
    let mut group = c.benchmark_group(name);
    group.sample_size(10).warm_up_time(Duration::from_millis(200)).measurement_time(Duration::from_millis(500));
    group
}

fn edits(c: &mut Criterion) {
    let mut group = group(c, "apply");
    for count in SIZES {
        let mut scene = scene_of(count);
        let mut turn = 0;
        let mut next = || {
            turn = (turn + 7919) % count;
            turn
        };
        let move_one =
            |i: usize, to: usize| Edit::MoveBody { body: BodyId(i as u64 + 1).into(), pose: place(to, count) };
        group.bench_function(BenchmarkId::new("move_one", count), |b| {
            b.iter(|| scene.apply(&[move_one(next(), next())], None));
        });
        group.bench_function(BenchmarkId::new("move_100", count), |b| {
            b.iter(|| {
                let edits: Vec<Edit> = (0..100).map(|_| move_one(next(), next())).collect();
                scene.apply(&edits, None)
            });
        });
        group.bench_function(BenchmarkId::new("add_and_remove_one", count), |b| {
            let shape = Arc::new(Shape::sphere(0.3).expect("a positive radius"));
            b.iter(|| {
                let new = NewBody::new("one more", Arc::clone(&shape), place(next(), count));
                scene.apply(&[Edit::AddBody(new), Edit::RemoveBody { body: "one more".into() }], None)
            });
        });
        group.bench_function(BenchmarkId::new("copy_everything", count), |b| {
            let snapshot = scene.snapshot();
            b.iter(|| {
                let bodies: Vec<Body> = snapshot.bodies().map(|body| Body::clone(body)).collect();
                let names: HashMap<Arc<str>, BodyId> =
                    bodies.iter().map(|body| (Arc::clone(&body.name), body.id)).collect();
                let boxes: Vec<_> = snapshot.broad_phase().iter().collect();
                (bodies, names, boxes)
            });
        });
    }
}

fn filter(c: &mut Criterion) {
    let mut group = group(c, "admits_1000_pairs");
    let mut scene = scene_of(1_000);
    let of_group = |i: usize| Party::Group(format!("group {i}"));
    let allow = |a: Party, b: Party| Edit::SetAllowedCollision { a, b, allowed: Some(true) };
    let body = |id: u64| Party::Body(BodyId(id).into());
    let no_entries = scene.snapshot();
    let single: Vec<Edit> = (0..100).map(|i| allow(body(2 * i + 1), body(2 * i + 2))).collect();
    scene.apply(&single, None).expect("valid edits");
    let single_entries = scene.snapshot();
    scene.apply(&[allow(of_group(1), of_group(2)), allow(body(5), Party::Everything)], None).expect("valid edits");
    let all_kinds = scene.snapshot();
    for (name, snapshot) in [("no_entries", no_entries), ("100_single", single_entries), ("all_kinds", all_kinds)] {
        let bodies: Vec<&Arc<Body>> = snapshot.bodies().collect();
        group.bench_function(name, |b| {
            b.iter(|| (0..1000).filter(|i| snapshot.admits(bodies[*i], bodies[black_box(i * 7 + 1) % 1000])).count());
        });
    }
    let snapshot = scene.snapshot();
    group.bench_function("look_up_1000_bodies", |b| {
        b.iter(|| (1..=1000).filter(|id| snapshot.body(black_box(BodyId(*id))).is_some()).count());
    });
}

criterion_group!(benches, edits, filter);
criterion_main!(benches);
