//! Runs one hot kernel over fixed inputs, for callgrind to count: `instructions KERNEL`, or without a name lists them all.
//!
//! Only what runs below [`measured`] is counted; it makes [`CALLS`] calls.

mod inputs;

use std::env;
use std::hint::black_box;
use std::process::ExitCode;

use clearance::geometry::{Shape, Vec3};
use clearance::narrow_phase::{Accuracy, Depth, Goal, separation};
use inputs::{Lie, Pair, Random, cuboid, ellipsoid, hull, mesh, pairs};

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
    measured(&mut make());
    println!("{CALLS}");
    ExitCode::SUCCESS
}
