//! Rays and shape casts a second against a scene, beside parry's on the same bodies in the same run.
//!
//! Scenes: `count` boxes, balls, cylinders, capsules and hulls in a cube, as dense as one body in 3 m^3; and a terrain of triangles. Both sides answer the
//! first hit of every ray or motion with a normal, one thread. Ours proves each answer, parry's is an estimate; where both are sure
//! they have to agree. They take turns, and the least of the rounds counts, so that a busy machine slows both alike.
//! `cargo bench --no-default-features --features effect-motion --bench casts`, about a minute.

use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use clearance::geometry::{Pose, Quaternion, Shape, TriangleMesh, Vec3};
use clearance::query::{
    CastMode, CastRays, CastShapes, CastVerdict, Casts, Context, DEFAULT_RESOLUTION, ItemBatch, Moved, Mover, Rays, Way,
};
use clearance::scene::{Edit, Epoch, NewBody, Scene, Snapshot};
use parry3d_f64::math::{Pose as ParryPose, Rotation, Vector};
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy};
use parry3d_f64::query::{Ray, ShapeCastOptions, cast_shapes};
use parry3d_f64::shape::SharedShape;

const ROUNDS: usize = 7;
const RAYS: usize = 10_000;
const MOTIONS: usize = 2_000;
const LENGTH: f64 = 50.0;

/// Numbers in -1..1 from a linear congruential generator (Knuth's MMIX constants), the same in every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self, size: f64) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next()) * size
    }

    fn pose(&mut self, size: f64) -> Pose {
        let q = Quaternion { w: self.next(), x: self.next(), y: self.next(), z: self.next() };
        Pose::new(self.vector(size), q).expect("finite numbers")
    }
}

/// A body twice: ours and parry's.
struct Body {
    ours: Arc<Shape>,
    theirs: SharedShape,
    pose: Pose,
    /// Its cylinders and capsules stand along y, ours along z.
    upright: bool,
}

fn vector(v: Vec3) -> Vector {
    Vector::new(v.x, v.y, v.z)
}

fn placed(body: &Body) -> ParryPose {
    let q = body.pose.rotation();
    let rotation = Rotation::from_xyzw(q.x, q.y, q.z, q.w).normalize();
    let turned =
        if body.upright { rotation * Rotation::from_rotation_x(std::f64::consts::FRAC_PI_2) } else { rotation };
    ParryPose::from_parts(vector(body.pose.translation()), turned)
}

fn bodies(count: usize, kinds: &[usize]) -> Vec<Body> {
    let mut random = Random(1);
    let cloud: Vec<Vec3> = (0..32).map(|_| random.vector(1.0).normalize() * 0.5).collect();
    let hull =
        SharedShape::convex_hull(&cloud.iter().copied().map(vector).collect::<Vec<_>>()).expect("a ball of points");
    let shapes = [
        (Shape::cuboid(Vec3::new(0.3, 0.4, 0.5)).expect("a box"), SharedShape::cuboid(0.3, 0.4, 0.5), false),
        (Shape::sphere(0.4).expect("a ball"), SharedShape::ball(0.4), false),
        (Shape::cylinder(0.3, 0.4).expect("a cylinder"), SharedShape::cylinder(0.4, 0.3), true),
        (Shape::capsule(0.2, 0.4).expect("a capsule"), SharedShape::capsule_y(0.4, 0.2), true),
        (Shape::convex(&cloud).expect("a hull"), hull, false),
    ]
    .map(|(ours, theirs, upright)| (Arc::new(ours), theirs, upright));
    let side = 0.5 * libm::cbrt(3.0 * count as f64);
    (0..count)
        .map(|i| {
            let (ours, theirs, upright) = &shapes[kinds[i % kinds.len()]];
            Body { ours: Arc::clone(ours), theirs: theirs.clone(), pose: random.pose(side), upright: *upright }
        })
        .collect()
}

/// Rolling ground of `n` by `n` cells of 0.25 m, and a few boxes on it.
fn terrain(n: u32) -> Vec<Body> {
    let height = |i: u32, j: u32| libm::sin(0.11 * f64::from(i)) + libm::cos(0.17 * f64::from(j));
    let half = 0.125 * f64::from(n);
    let vertex = |k: u32| {
        let (i, j) = (k / (n + 1), k % (n + 1));
        Vec3::new(0.25 * f64::from(i) - half, 0.25 * f64::from(j) - half, height(i, j) - 4.0)
    };
    let vertices: Vec<Vec3> = (0..(n + 1) * (n + 1)).map(vertex).collect();
    let cell = |k: u32| {
        let corner = k / n * (n + 1) + k % n;
        let across = corner + n + 1;
        [[corner, across, corner + 1], [across, across + 1, corner + 1]]
    };
    let triangles: Vec<[u32; 3]> = (0..n * n).flat_map(cell).collect();
    let theirs =
        SharedShape::trimesh(vertices.iter().copied().map(vector).collect(), triangles.clone()).expect("a mesh");
    let ours = TriangleMesh::surface(vertices, triangles).expect("a mesh");
    let ground = Body { ours: Arc::new(Shape::mesh(Arc::new(ours))), theirs, pose: Pose::identity(), upright: false };
    std::iter::once(ground).chain(bodies(100, &[0])).collect()
}

fn snapshot(bodies: &[Body]) -> Arc<Snapshot> {
    let edit =
        |(i, body): (usize, &Body)| Edit::AddBody(NewBody::new(format!("{i}"), Arc::clone(&body.ours), body.pose));
    let mut scene = Scene::new(Epoch(1));
    let edits: Vec<Edit> = bodies.iter().enumerate().map(edit).collect();
    edits.chunks(5_000).for_each(|edits| drop(scene.apply(edits, None).expect("bodies that can be")));
    scene.snapshot()
}

/// Seconds of the quickest of some rounds, in turns.
fn race(mut ours: impl FnMut(), mut theirs: impl FnMut()) -> (f64, f64) {
    let mut best = (f64::INFINITY, f64::INFINITY);
    for _ in 0..ROUNDS {
        let start = Instant::now();
        ours();
        let middle = Instant::now();
        theirs();
        best = (best.0.min((middle - start).as_secs_f64()), best.1.min(middle.elapsed().as_secs_f64()));
    }
    best
}

fn rays(name: &str, bodies: &[Body]) {
    let mut random = Random(2);
    let side = 0.5 * libm::cbrt(3.0 * bodies.len().min(10_000) as f64);
    let starts: Vec<(Vec3, Vec3)> = (0..RAYS).map(|_| (random.vector(side), random.vector(1.0).normalize())).collect();
    let numbers = |of: fn(&(Vec3, Vec3)) -> Vec3| starts.iter().flat_map(|ray| <[f64; 3]>::from(of(ray))).collect();
    let question = CastRays {
        origins: numbers(|ray| ray.0),
        directions: numbers(|ray| ray.1),
        lengths: vec![LENGTH],
        mode: CastMode::First,
        context: Context::default(),
    };
    let snapshot = snapshot(bodies);
    let batch = Rays::new(&snapshot, &question).expect("a question that can be asked");
    let places: Vec<ParryPose> = bodies.iter().map(placed).collect();
    let boxes: Vec<_> = bodies.iter().zip(&places).map(|(body, at)| body.theirs.compute_aabb(at)).collect();
    let bvh = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
    let theirs = |(origin, direction): &(Vec3, Vec3)| {
        let ray = Ray::new(vector(*origin), vector(*direction));
        let first = bvh.cast_ray(&ray, LENGTH, |leaf, best| {
            let leaf = leaf as usize;
            bodies[leaf].theirs.cast_ray(&places[leaf], &ray, best, true)
        });
        first.map(|(leaf, _)| {
            let leaf = leaf as usize;
            bodies[leaf].theirs.cast_ray_and_get_normal(&places[leaf], &ray, LENGTH, true)
        })
    };
    let answers = batch.answer_all(&|| false);
    let (mut open, mut apart) = (0, 0);
    for (item, ray) in answers.items.iter().zip(&starts) {
        let other = theirs(ray).flatten().map(|hit| hit.time_of_impact);
        match (item.verdict, item.hits.first(), other) {
            (CastVerdict::Hit, Some(hit), Some(t)) if (t - hit.lower).abs() < 1e-6 || (t - hit.upper).abs() < 1e-6 => {}
            (CastVerdict::Clear, None, None) => {}
            (CastVerdict::Indeterminate(_), _, _) => open += 1,
            _ => apart += 1,
        }
    }
    let (ours, parry) = race(
        || drop(black_box(batch.answer_all(&|| false))),
        || {
            starts.iter().for_each(|ray| {
                black_box(theirs(ray));
            })
        },
    );
    let per_second = |seconds: f64| RAYS as f64 / seconds;
    println!(
        "rays, {name}: ours {:.0}/s, parry {:.0}/s, ratio {:.2}; {open} undecided, {apart} differ of {RAYS}",
        per_second(ours),
        per_second(parry),
        parry / ours
    );
}

fn motions(name: &str, bodies: &[Body], turning: bool) {
    let mut random = Random(3);
    let side = 0.5 * libm::cbrt(3.0 * bodies.len() as f64);
    let shape = Shape::cuboid(Vec3::new(0.2, 0.3, 0.1)).expect("a box");
    let moved = SharedShape::cuboid(0.2, 0.3, 0.1);
    let ways: Vec<(Pose, Vec3, Vec3)> = (0..MOTIONS)
        .map(|_| (random.pose(side), random.vector(5.0), random.vector(if turning { 1.5 } else { 0.0 })))
        .collect();
    let mover = |(start, displacement, turn): &(Pose, Vec3, Vec3)| Mover {
        moved: Moved::Shape(shape.clone()),
        start: Some(*start),
        way: Way::By { displacement: *displacement, turn: *turn },
    };
    let question = CastShapes {
        items: ways.iter().map(mover).collect(),
        mode: CastMode::First,
        resolution: DEFAULT_RESOLUTION,
        context: Context::default(),
    };
    let snapshot = snapshot(bodies);
    let batch = Casts::new(&snapshot, &question).expect("a question that can be asked");
    let places: Vec<ParryPose> = bodies.iter().map(placed).collect();
    let boxes: Vec<_> = bodies.iter().zip(&places).map(|(body, at)| body.theirs.compute_aabb(at)).collect();
    let bvh = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
    // parry casts shapes along a line only.
    let theirs = |(start, displacement, _): &(Pose, Vec3, Vec3)| {
        let own = Body { ours: Arc::new(shape.clone()), theirs: moved.clone(), pose: *start, upright: false };
        let at = placed(&own);
        let swept =
            moved.compute_swept_aabb(&at, &ParryPose::from_parts(at.translation + vector(*displacement), at.rotation));
        let mut best: Option<f64> = None;
        for leaf in bvh.intersect_aabb(&swept) {
            let leaf = leaf as usize;
            let options = ShapeCastOptions { max_time_of_impact: best.unwrap_or(1.0), ..ShapeCastOptions::default() };
            let zero = Vector::new(0.0, 0.0, 0.0);
            let hit =
                cast_shapes(&at, vector(*displacement), &*moved, &places[leaf], zero, &*bodies[leaf].theirs, options);
            if let Ok(Some(hit)) = hit {
                best = Some(best.map_or(hit.time_of_impact, |t| t.min(hit.time_of_impact)));
            }
        }
        best
    };
    let answers = batch.answer_all(&|| false);
    let hits = answers.items.iter().filter(|item| item.verdict == CastVerdict::Hit).count();
    let open = answers.items.iter().filter(|item| matches!(item.verdict, CastVerdict::Indeterminate(_))).count();
    let pairs: u64 = answers.items.iter().map(|item| item.cost.pairs).sum();
    let (ours, parry) = race(
        || drop(black_box(batch.answer_all(&|| false))),
        || {
            if !turning {
                ways.iter().for_each(|way| {
                    black_box(theirs(way));
                });
            }
        },
    );
    let per_second = |seconds: f64| MOTIONS as f64 / seconds;
    let beside = if turning {
        "parry has none".to_owned()
    } else {
        format!("parry {:.0}/s, ratio {:.2}", per_second(parry), parry / ours)
    };
    println!(
        "motions, {name}: ours {:.0}/s, {beside}; {hits} hits, {open} undecided of {MOTIONS}, {:.1} measurements each",
        per_second(ours),
        pairs as f64 / MOTIONS as f64
    );
}

fn main() {
    let all = [0, 1, 2, 3, 4];
    for (name, bodies) in [
        ("1e3 balls", bodies(1_000, &[1])),
        ("1e3 boxes", bodies(1_000, &[0])),
        ("1e3 of five kinds", bodies(1_000, &all)),
        ("1e5 boxes", bodies(100_000, &[0])),
        ("terrain of 8e4 triangles", terrain(200)),
    ] {
        rays(name, &bodies);
    }
    let clutter = bodies(1_000, &all);
    motions("1e3 of five kinds, straight", &clutter, false);
    motions("1e3 of five kinds, turning", &clutter, true);
}
