//! Runs one hot kernel over fixed inputs, for callgrind to count: `instructions KERNEL`, or without a name lists them all. With
//! `--allocations` after the name it counts what the kernel allocates itself: how often, and how many bytes.
//!
//! Only what runs below [`measured`] is counted; it makes [`CALLS`] calls.

mod inputs;

use std::env;
use std::hint::black_box;
use std::process::ExitCode;

use clearance::geometry::{Shape, Vec3};
use clearance::narrow_phase::{Accuracy, Depth, Goal, separation};
use clearance::query::{
    CastMode, CastRays, Context, ItemBatch, Mode, NearestBodies, Neighbours, PairQuery, Prepared, Rays, Subject, Wants,
};
use clearance::scene::BodyId;
use inputs::{Lie, Pair, Random, cuboid, ellipsoid, heap, hull, mesh, pairs};

const CALLS: usize = 100;
/// One in ten, each called ten times: a mesh takes a while to build under callgrind.
const MESHES: usize = 10;

/// Its inputs are made before the count begins.
type Kernel = Box<dyn FnMut(usize)>;

/// A relative tolerance that no curved pair reaches by luck.
const TOLERANCE: f64 = 1e-6;

fn kernels() -> Vec<(String, fn() -> Kernel)> {
    let mut all: Vec<(String, fn() -> Kernel)> = Vec::new();
    let mut add = |name: &str, make: fn() -> Kernel| all.push((name.to_owned(), make));
    add("support, hull 8", || support(8));
    add("support, hull 40", || support(40));
    add("support, hull 250", || support(250));
    add("support, hull 940", || support(940));
    add("distance near, box-box", || ask(Depth::Distance, pairs(CALLS, Lie::Near, cuboid)));
    add("distance near, hull 8", || ask(Depth::Distance, pairs(CALLS, Lie::Near, |r| Shape::hull(hull(r, 8)))));
    add("distance near, hull 250", || ask(Depth::Distance, pairs(CALLS, Lie::Near, |r| Shape::hull(hull(r, 250)))));
    add("distance near, hull 940", || ask(Depth::Distance, pairs(CALLS, Lie::Near, |r| Shape::hull(hull(r, 940)))));
    add("distance near, ellipsoids", || ask(Depth::Distance, pairs(CALLS, Lie::Near, ellipsoid)));
    add("distance apart, hull 250", || ask(Depth::Distance, pairs(CALLS, Lie::Apart, |r| Shape::hull(hull(r, 250)))));
    add("verdict near, hull 250", || ask(Depth::Verdict, pairs(CALLS, Lie::Near, |r| Shape::hull(hull(r, 250)))));
    add("depth, box-box", || ask(Depth::Penetration, pairs(CALLS, Lie::Overlapping, cuboid)));
    add("depth, hull 8", || ask(Depth::Penetration, pairs(CALLS, Lie::Overlapping, |r| Shape::hull(hull(r, 8)))));
    add("depth, hull 250", || ask(Depth::Penetration, pairs(CALLS, Lie::Overlapping, |r| Shape::hull(hull(r, 250)))));
    add("depth, hull 940", || ask(Depth::Penetration, pairs(CALLS, Lie::Overlapping, |r| Shape::hull(hull(r, 940)))));
    add("question, verdicts", || question(Wants::VERDICT));
    add("question, distances", || question(Wants { distance: true, ..Wants::VERDICT }));
    add("question, witnesses and depths", || question(Wants { patch: false, derivatives: false, ..Wants::ALL }));
    add("question, nearest bodies", nearest_bodies);
    add("question, rays", rays);
    add("distance apart, mesh 800", || ask(Depth::Distance, pairs(MESHES, Lie::Apart, |r| mesh(r, 20, 21))));
    all
}

/// Directions that have nothing to do with one another, each from the first point as a guess.
fn support(points: usize) -> Kernel {
    let mut random = Random(2);
    let hull = hull(&mut random, points);
    let directions: Vec<Vec3> = (0..CALLS).map(|_| random.vector()).collect();
    Box::new(move |i| {
        black_box(hull.farthest(directions[i], 0));
    })
}

/// What meets each body of a heap, one after the other: the whole way of a question below the service.
fn question(wants: Wants) -> Kernel {
    let snapshot = heap(CALLS);
    let ids: Vec<BodyId> = snapshot.bodies().map(|body| body.id).collect();
    Box::new(move |i| {
        let context = Context { wants, margin: 0.01, ..Context::default() };
        let query = PairQuery { items: vec![Subject::Body(ids[i % ids.len()])], mode: Mode::All, context };
        let prepared = Prepared::collide(&*snapshot, &query).expect("nothing in the question is refused");
        black_box(prepared.answer(&|| false));
    })
}

/// The three nearest of each body of a heap.
fn nearest_bodies() -> Kernel {
    let snapshot = heap(CALLS);
    let ids: Vec<BodyId> = snapshot.bodies().map(|body| body.id).collect();
    Box::new(move |i| {
        let items = vec![Subject::Body(ids[i % ids.len()])];
        let request = NearestBodies { items, count: 3, context: Context { margin: 0.01, ..Context::default() } };
        let batch = Neighbours::new(&snapshot, &request).expect("nothing in the question is refused");
        black_box(batch.answer_all(&|| false));
    })
}

/// Rays through a heap, to what they meet first.
fn rays() -> Kernel {
    let snapshot = heap(CALLS);
    let mut random = Random(4);
    let rays: Vec<[Vec3; 2]> = (0..CALLS).map(|_| [random.vector() * 5.0, random.vector()]).collect();
    Box::new(move |i| {
        let [origin, direction] = rays[i % rays.len()].map(|vector| vector.as_slice().to_vec());
        let lengths = vec![10.0];
        let context = Context::default();
        let request = CastRays { origins: origin, directions: direction, lengths, mode: CastMode::First, context };
        let batch = Rays::new(&snapshot, &request).expect("nothing in the question is refused");
        black_box(batch.answer_all(&|| false));
    })
}

fn ask(depth: Depth, pairs: Vec<Pair>) -> Kernel {
    let accuracy = Accuracy { relative: TOLERANCE, ..Accuracy::default() };
    Box::new(move |i| {
        let goal = Goal { depth, accuracy, ..Goal::penetration() };
        let Pair { a, b, at_a, at_b } = &pairs[i % pairs.len()];
        black_box(separation(a, b, at_a, at_b, &goal).is_ok());
    })
}

#[inline(never)]
fn measured(kernel: &mut Kernel) {
    for i in 0..CALLS {
        kernel(i);
    }
}

fn main() -> ExitCode {
    let all = kernels();
    let Some(wanted) = env::args().nth(1) else {
        all.iter().for_each(|(name, _)| println!("{name}"));
        return ExitCode::SUCCESS;
    };
    let Some((_, make)) = all.into_iter().find(|(name, _)| *name == wanted) else {
        eprintln!("no kernel {wanted}");
        return ExitCode::FAILURE;
    };
    let mut kernel = make();
    if env::args().nth(2).as_deref() == Some("--allocations") {
        let counted = allocation_counter::measure(|| measured(&mut kernel));
        println!("{} {}", counted.count_total, counted.bytes_total);
        return ExitCode::SUCCESS;
    }
    measured(&mut kernel);
    println!("{CALLS}");
    ExitCode::SUCCESS
}
