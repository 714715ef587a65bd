//! What the dynamic tree costs, beside a sweep along one axis and parry's `Bvh` on the same boxes in the same run.
//!
//! Unit boxes at random in a cube, about 1.15 overlaps a box; where they move, all move by up to 0.1 in each axis.
//! `cargo bench --bench broad_phase`, about a minute.

use std::hint::black_box;
use std::ops::ControlFlow;
use std::time::Duration;

use clearance::broad_phase::{DynamicTree, ProxyId};
use clearance::geometry::{Aabb, Vec3};
use criterion::{BatchSize, BenchmarkGroup, BenchmarkId, Criterion, criterion_group, criterion_main};
use parry3d_f64::bounding_volume::Aabb as ParryAabb;
use parry3d_f64::math::Vector;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhWorkspace};

const SIZES: [usize; 3] = [1_000, 10_000, 100_000];

/// Numbers in 0..1 from a linear congruential generator (Knuth's MMIX constants), the same in every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn vector(&mut self, side: f64) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next()) * side
    }
}

/// Side of the cube in which `count` unit boxes have about 1.15 overlaps each.
fn side(count: usize) -> f64 {
    2.0 * libm::cbrt(count as f64 / 2.3)
}

fn boxes(count: usize, seed: u64) -> Vec<Aabb> {
    let mut random = Random(seed);
    (0..count).map(|_| Aabb::centred(random.vector(side(count)), Vec3::repeat(0.5))).collect()
}

fn moved(boxes: &[Aabb]) -> Vec<Aabb> {
    let mut random = Random(7);
    let by = |aabb: &Aabb, step: Vec3| Aabb { min: aabb.min + step, max: aabb.max + step };
    boxes.iter().map(|aabb| by(aabb, random.vector(0.2) - Vec3::repeat(0.1))).collect()
}

fn tree_of(boxes: &[Aabb]) -> (DynamicTree, Vec<ProxyId>) {
    let mut tree = DynamicTree::new();
    let mut insert = |(i, aabb): (u64, &Aabb)| {
        let name = tree.insert(*aabb, i);
        tree.settle();
        name
    };
    let proxies = (0..).zip(boxes).map(&mut insert).collect();
    (tree, proxies)
}

fn for_parry(aabb: &Aabb) -> ParryAabb {
    let vector = |v: Vec3| Vector::new(v.x, v.y, v.z);
    ParryAabb::new(vector(aabb.min), vector(aabb.max))
}

fn parry_of(boxes: &[Aabb]) -> Bvh {
    Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes.iter().map(for_parry).collect::<Vec<_>>())
}

/// Pairs by a sweep along x: the floor that a tree has to be better than.
fn sweep(boxes: &[Aabb]) -> usize {
    let mut sorted: Vec<&Aabb> = boxes.iter().collect();
    sorted.sort_unstable_by(|a, b| a.min.x.total_cmp(&b.min.x));
    let after = |(i, a): (usize, &&Aabb)| {
        let near = sorted[i + 1..].iter().take_while(|b| b.min.x <= a.max.x);
        near.filter(|b| b.overlaps(a)).count()
    };
    sorted.iter().enumerate().map(after).sum()
}

fn group<'a>(c: &'a mut Criterion, name: &str) -> BenchmarkGroup<'a, criterion::measurement::WallTime> {
    let mut group = c.benchmark_group(name);
    group.sample_size(10).warm_up_time(Duration::from_millis(100)).measurement_time(Duration::from_millis(500));
    group
}

fn build(c: &mut Criterion) {
    let mut group = group(c, "build");
    for count in SIZES {
        let boxes = boxes(count, 1);
        group.bench_function(BenchmarkId::new("at_once", count), |b| {
            b.iter(|| DynamicTree::build(boxes.iter().copied().zip(0..)));
        });
        group.bench_function(BenchmarkId::new("one_by_one", count), |b| b.iter(|| tree_of(&boxes)));
        group.bench_function(BenchmarkId::new("parry_at_once", count), |b| b.iter(|| parry_of(&boxes)));
        group.bench_function(BenchmarkId::new("parry_one_by_one", count), |b| {
            b.iter(|| {
                let mut bvh = Bvh::new();
                (0..).zip(&boxes).for_each(|(i, aabb)| bvh.insert(for_parry(aabb), i));
                bvh
            });
        });
    }
}

fn all_pairs(c: &mut Criterion) {
    let mut group = group(c, "all_pairs");
    for count in SIZES {
        let boxes = boxes(count, 1);
        let (tree, _) = tree_of(&boxes);
        let bvh = parry_of(&boxes);
        let mut workspace = BvhWorkspace::default();
        let pairs = sweep(&boxes);
        group.throughput(criterion::Throughput::Elements(pairs as u64));
        group.bench_function(BenchmarkId::new("tree", count), |b| {
            b.iter(|| {
                let mut found = 0;
                tree.self_pairs(|_, _| {
                    found += 1;
                    ControlFlow::Continue(())
                });
                assert_eq!(found, pairs);
            });
        });
        group.bench_function(BenchmarkId::new("parry", count), |b| {
            b.iter(|| {
                let mut found = 0;
                bvh.traverse_bvtt_single_tree::<false>(&mut workspace, &mut |_, _| found += 1);
                assert_eq!(found, pairs);
            });
        });
        group.bench_function(BenchmarkId::new("sweep", count), |b| b.iter(|| sweep(&boxes)));
    }
}

fn overlap(c: &mut Criterion) {
    let mut group = group(c, "overlap_1000_queries");
    for count in SIZES {
        let stored = boxes(count, 1);
        let mut random = Random(2);
        let queries: Vec<Aabb> =
            (0..1000).map(|_| Aabb::centred(random.vector(side(count)), Vec3::repeat(1.0))).collect();
        let (tree, _) = tree_of(&stored);
        let bvh = parry_of(&stored);
        let expected: usize = queries.iter().map(|query| stored.iter().filter(|b| b.overlaps(query)).count()).sum();
        group.bench_function(BenchmarkId::new("tree", count), |b| {
            b.iter(|| {
                let mut found = 0;
                for query in &queries {
                    tree.overlap(query, |_| {
                        found += 1;
                        ControlFlow::Continue(())
                    });
                }
                assert_eq!(found, expected);
            });
        });
        group.bench_function(BenchmarkId::new("parry", count), |b| {
            b.iter(|| {
                let found: usize = queries.iter().map(|query| bvh.intersect_aabb(&for_parry(query)).count()).sum();
                assert_eq!(found, expected);
            });
        });
        group.bench_function(BenchmarkId::new("nearest_by_tree", count), |b| {
            b.iter(|| {
                let mut sum = 0.0;
                for query in &queries {
                    tree.nearest(query, f64::INFINITY, |_, distance| {
                        sum += distance;
                        distance
                    });
                }
                black_box(sum)
            });
        });
    }
}

fn move_all(c: &mut Criterion) {
    let mut group = group(c, "move_all");
    for count in SIZES {
        let before = boxes(count, 1);
        let after = moved(&before);
        let (tree, proxies) = tree_of(&before);
        let move_all = |mut tree: DynamicTree| {
            for (proxy, aabb) in proxies.iter().zip(&after) {
                tree.move_to(*proxy, *aabb);
            }
            tree.settle();
            tree
        };
        group.bench_function(BenchmarkId::new("tree", count), |b| {
            // The copy owns its pages, as the tree of a writer without readers does.
            let own = || tree_of(&before).0;
            b.iter_batched(own, move_all, BatchSize::LargeInput);
        });
        group.bench_function(BenchmarkId::new("tree_with_a_reader", count), |b| {
            b.iter_batched(|| tree.clone(), move_all, BatchSize::LargeInput);
        });
        let bvh = parry_of(&before);
        group.bench_function(BenchmarkId::new("parry_update_refit_optimise", count), |b| {
            b.iter_batched(
                || (bvh.clone(), BvhWorkspace::default()),
                |(mut bvh, mut workspace)| {
                    for (i, aabb) in (0..).zip(&after) {
                        bvh.insert_or_update_partially(for_parry(aabb), i, 0.0);
                    }
                    bvh.refit(&mut workspace);
                    bvh.optimize_incremental(&mut workspace);
                    bvh
                },
                BatchSize::LargeInput,
            );
        });
        group.bench_function(BenchmarkId::new("clone_and_move_one", count), |b| {
            let mut turn = 0;
            b.iter(|| {
                turn = (turn + 7919) % count;
                let mut next = tree.clone();
                next.move_to(proxies[turn], after[turn]);
                next.settle();
                next
            });
        });
    }
}

criterion_group!(benches, build, all_pairs, overlap, move_all);
criterion_main!(benches);
