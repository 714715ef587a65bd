//! The narrow phase beside parry's on the same pairs in the same run: what a newcomer sees in a minute.
//!
//! `cargo bench --bench narrow_phase`. An iteration asks one question of 100 random pairs: half of them overlap, the others
//! are up to a few lengths apart. Ours answers with a proved bracket of relative width 1e-9. The full comparison, with
//! Coal, tails, errors and intervals, is `benches/peers/compare`.

use std::sync::Arc;
use std::time::Duration;

use clearance::geometry::{Placement, Pose, Quaternion, Shape, TriangleMesh, Vec3};
use clearance::narrow_phase::{Depth, Goal, Separation, separation};
use criterion::{BenchmarkGroup, BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use parry3d_f64::math::{Pose as ParryPose, Rotation, Vector};
use parry3d_f64::query;
use parry3d_f64::shape::{SharedShape, TriMesh};

const PAIRS: usize = 100;

/// Meshes are asked of fewer, for parry takes milliseconds for each.
const MESH_PAIRS: usize = 10;

/// Numbers in 0..1 from a linear congruential generator (Knuth's MMIX constants), the same in every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// In the cube from -1 to 1.
    fn vector(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next()) * 2.0 - Vec3::repeat(1.0)
    }

    fn rotation(&mut self) -> Quaternion {
        let v = self.vector();
        Quaternion { w: 2.0 * self.next() - 1.0, x: v.x, y: v.y, z: v.z }
    }
}

/// One shape for both libraries.
struct Both {
    ours: Shape,
    parrys: SharedShape,
}

fn cuboid(random: &mut Random) -> Both {
    let half = (random.vector() + Vec3::repeat(1.5)) * 0.4;
    Both { ours: Shape::cuboid(half).expect("sizes are positive"), parrys: SharedShape::cuboid(half.x, half.y, half.z) }
}

/// Points on an ellipsoid, all of them corners.
fn hull(random: &mut Random, count: usize) -> Both {
    let radii = (random.vector() + Vec3::repeat(2.0)) * 0.3;
    let points: Vec<Vec3> = (0..count).map(|_| random.vector().normalize().component_mul(&radii)).collect();
    let parrys = SharedShape::convex_hull(&points.iter().map(|p| for_parry(*p)).collect::<Vec<_>>());
    Both { ours: Shape::convex(&points).expect("points are finite"), parrys: parrys.expect("points span a volume") }
}

/// A sphere with bumps of a tenth of its radius, of `2 * around * (rows - 1)` triangles.
fn mesh(random: &mut Random, around: u32, rows: u32) -> Both {
    let waves = random.vector() * 6.0;
    let on_sphere = |row: u32, column: u32| {
        let (sin_polar, cos_polar) = libm::sincos(std::f64::consts::PI * f64::from(row) / f64::from(rows));
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(column) / f64::from(around));
        let out = Vec3::new(sin_polar * cos, sin_polar * sin, cos_polar);
        out * (0.7 + 0.07 * libm::sin(waves.dot(&out)))
    };
    // The poles are the first and the last vertex, the rings between them.
    let mut vertices = vec![on_sphere(0, 0)];
    vertices.extend((1..rows).flat_map(|row| (0..around).map(move |column| on_sphere(row, column))));
    vertices.push(on_sphere(rows, 0));
    let (last, at) = (vertices.len() as u32 - 1, |ring: u32, column: u32| 1 + ring * around + column % around);
    let mut triangles = Vec::new();
    for i in 0..around {
        triangles.push([0, at(0, i), at(0, i + 1)]);
        triangles.push([last, at(rows - 2, i + 1), at(rows - 2, i)]);
        for ring in 0..rows - 2 {
            triangles.push([at(ring, i), at(ring + 1, i), at(ring + 1, i + 1)]);
            triangles.push([at(ring, i), at(ring + 1, i + 1), at(ring, i + 1)]);
        }
    }
    let for_parry = vertices.iter().map(|v| for_parry(*v)).collect();
    let parrys = TriMesh::new(for_parry, triangles.clone()).expect("the mesh has triangles");
    let ours = TriangleMesh::surface(vertices, triangles).expect("indices are in range");
    Both { ours: Shape::mesh(Arc::new(ours)), parrys: SharedShape::new(parrys) }
}

fn for_parry(v: Vec3) -> Vector {
    Vector::new(v.x, v.y, v.z)
}

/// Where a body is, for both libraries.
struct Place {
    ours: Placement,
    parrys: ParryPose,
}

fn place(translation: Vec3, q: Quaternion) -> Place {
    let pose = Pose::new(translation, q).expect("numbers are finite");
    let rotation = Rotation::from_xyzw(q.x, q.y, q.z, q.w).normalize();
    Place { ours: pose.placement(), parrys: ParryPose::from_parts(for_parry(translation), rotation) }
}

struct Pair {
    a: Both,
    b: Both,
    at_a: Place,
    at_b: Place,
}

impl Pair {
    fn ours(&self, depth: Depth) -> Separation {
        let goal = Goal { depth, ..Goal::penetration() };
        separation(&self.a.ours, &self.b.ours, &self.at_a.ours, &self.at_b.ours, &goal).expect("both have bounds")
    }

    fn parrys_distance(&self) -> f64 {
        let found = query::distance(&self.at_a.parrys, &*self.a.parrys, &self.at_b.parrys, &*self.b.parrys);
        found.expect("parry knows these kinds").distance
    }

    fn parrys_verdict(&self) -> bool {
        let found = query::intersection_test(&self.at_a.parrys, &*self.a.parrys, &self.at_b.parrys, &*self.b.parrys);
        found.expect("parry knows these kinds").intersecting
    }

    fn parrys_depth(&self) -> Option<f64> {
        let found = query::contact(&self.at_a.parrys, &*self.a.parrys, &self.at_b.parrys, &*self.b.parrys, 0.0);
        found.expect("parry knows these kinds").map(|contact| contact.dist)
    }
}

/// Every other pair overlaps, the rest are apart.
fn pairs(count: usize, mut shape: impl FnMut(&mut Random) -> Both) -> Vec<Pair> {
    let mut random = Random(1);
    let mut found = Vec::new();
    while found.len() < count {
        let (a, b) = (shape(&mut random), shape(&mut random));
        let at_a = place(random.vector(), random.rotation());
        let at_b = place(random.vector() * 3.0, random.rotation());
        let pair = Pair { a, b, at_a, at_b };
        if (pair.ours(Depth::Distance).bracket.upper <= 0.0) == (found.len() % 2 == 1) {
            found.push(pair);
        }
    }
    found
}

fn group<'a>(c: &'a mut Criterion, name: &str, pairs: &[Pair]) -> BenchmarkGroup<'a, criterion::measurement::WallTime> {
    let mut group = c.benchmark_group(name);
    group.sample_size(10).warm_up_time(Duration::from_millis(200)).measurement_time(Duration::from_millis(800));
    group.throughput(Throughput::Elements(pairs.len() as u64));
    group
}

fn narrow_phase(c: &mut Criterion) {
    compare(c, "box-box", &pairs(PAIRS, cuboid), true);
    compare(c, "hull 8", &pairs(PAIRS, |random| hull(random, 8)), true);
    compare(c, "hull 250", &pairs(PAIRS, |random| hull(random, 250)), true);
    compare(c, "mesh 800", &pairs(MESH_PAIRS, |random| mesh(random, 20, 21)), false);
}

fn compare(c: &mut Criterion, kind: &str, pairs: &[Pair], convex: bool) {
    for pair in pairs {
        let (ours, parrys) = (pair.ours(Depth::Distance), pair.parrys_distance());
        assert!((ours.signed_distance.max(0.0) - parrys).abs() < 1e-3, "both are asked the same question");
        assert_eq!(ours.bracket.upper <= 0.0, pair.parrys_verdict(), "both are asked the same question");
    }
    let mut group = group(c, kind, pairs);
    group.bench_function(BenchmarkId::new("distance", "ours"), |b| {
        b.iter(|| pairs.iter().map(|pair| pair.ours(Depth::Distance).bracket.lower).sum::<f64>());
    });
    group.bench_function(BenchmarkId::new("distance", "parry"), |b| {
        b.iter(|| pairs.iter().map(Pair::parrys_distance).sum::<f64>());
    });
    group.bench_function(BenchmarkId::new("verdict", "ours"), |b| {
        b.iter(|| pairs.iter().filter(|pair| pair.ours(Depth::Verdict).bracket.upper <= 0.0).count());
    });
    group.bench_function(BenchmarkId::new("verdict", "parry"), |b| {
        b.iter(|| pairs.iter().filter(|pair| pair.parrys_verdict()).count());
    });
    if convex {
        group.bench_function(BenchmarkId::new("depth", "ours"), |b| {
            b.iter(|| pairs.iter().map(|pair| pair.ours(Depth::Penetration).bracket.lower).sum::<f64>());
        });
        group.bench_function(BenchmarkId::new("depth or nothing", "parry"), |b| {
            b.iter(|| pairs.iter().filter_map(Pair::parrys_depth).sum::<f64>());
        });
    }
}

criterion_group!(benches, narrow_phase);
criterion_main!(benches);
