//! Random pairs of placed shapes that go where narrow phases fail: every convex kind, sizes from 1e-6 to 1e6 m, alike or
//! mixed, flat and needle-like ones, dyadic numbers that touch exactly, parallel and nearly parallel faces, coinciding
//! centres, quaternions of any norm, places up to 1e8 m from the origin, gaps from deep overlap through a few units in the last
//! place to far apart.

use crate::oracle::truth;
use crate::samples::Random;
use crate::specimen::{Form, Specimen};

/// The kinds, by the names the library gives them. Swept variants come on top.
pub const KINDS: [&str; 12] = [
    "point",
    "sphere",
    "box",
    "capsule",
    "cylinder",
    "cone",
    "ellipsoid",
    "convex",
    "triangle",
    "segment",
    "half_space",
    "plane",
];

pub struct Pair {
    pub a: Specimen,
    pub b: Specimen,
}

/// Any pair of which one at least is bounded.
pub fn random_pair(random: &mut Random) -> Pair {
    loop {
        let size = random.magnitude(-6.0, 6.0);
        let other = if random.one_in(3) { random.magnitude(-6.0, 6.0) } else { size * random.magnitude(-1.0, 1.0) };
        // Numbers with few bits can touch exactly.
        let dyadic = random.one_in(4);
        let (kind_a, kind_b) = (random.index(KINDS.len()), random.index(KINDS.len()));
        let (Some(a), Some(b)) =
            (form(random, KINDS[kind_a], size, dyadic), form(random, KINDS[kind_b], other, dyadic))
        else {
            continue;
        };
        let bounded = a.core.is_bounded() || b.core.is_bounded();
        if bounded && let Some(pair) = place(random, a, b, dyadic) {
            return pair;
        }
    }
}

/// A shape of that kind, about `size` metres. None where the library refuses the numbers.
fn form(random: &mut Random, kind: &str, size: f64, dyadic: bool) -> Option<Form> {
    let degenerate = random.one_in(8);
    let unit = libm::exp2(libm::log2(size).floor() - 3.0);
    let length = |random: &mut Random| {
        if degenerate && random.one_in(3) {
            return 0.0;
        }
        let flat = if degenerate && random.one_in(3) { random.magnitude(-9.0, -2.0) } else { 1.0 };
        if dyadic { unit * (1 + random.index(12)) as f64 } else { size * flat * random.between(0.2, 1.0) }
    };
    let position = |random: &mut Random| {
        let coordinate = |random: &mut Random| {
            if dyadic { unit * (random.index(17) as f64 - 8.0) } else { size * random.between(-1.0, 1.0) }
        };
        [coordinate(random), coordinate(random), coordinate(random)]
    };
    let made = match kind {
        "point" => Form::point(),
        "sphere" => Form::sphere(length(random)),
        "box" => Form::cuboid([length(random), length(random), length(random)]),
        "capsule" => Form::capsule(length(random), length(random)),
        "cylinder" => Form::cylinder(length(random), length(random)),
        "cone" => Form::cone(length(random), length(random)),
        "ellipsoid" => Form::ellipsoid([length(random), length(random), length(random)]),
        "convex" => Form::convex(&cloud(random, degenerate, position)),
        "triangle" => {
            let (a, b) = (position(random), position(random));
            let c = if degenerate { between(random, a, b) } else { position(random) };
            Form::triangle([a, b, c])
        }
        "segment" => {
            let a = position(random);
            let b = if degenerate { a } else { position(random) };
            Form::segment([a, b])
        }
        "half_space" => Form::half_space(plane_normal(random), length(random)),
        "plane" => Form::plane(plane_normal(random), length(random)),
        other => unreachable!("no kind is called {other}"),
    }?;
    if random.one_in(4) { made.swept(length(random)) } else { Some(made) }
}

/// A point of the segment, rounded; an end now and then.
fn between(random: &mut Random, a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    let t = if random.one_in(4) { 0.0 } else { random.between(0.0, 1.0) };
    [0, 1, 2].map(|i| a[i] + t * (b[i] - a[i]))
}

/// 4 to 64 points; when degenerate: flat or a needle, with inner points and duplicates.
fn cloud(random: &mut Random, degenerate: bool, position: impl Fn(&mut Random) -> [f64; 3]) -> Vec<[f64; 3]> {
    let count = random.magnitude(0.61, 1.82) as usize; // 4 to 64
    let mut points: Vec<[f64; 3]> = (0..count).map(|_| position(random)).collect();
    if random.one_in(2) {
        // On a ball, so that all of them are corners.
        let largest = points.iter().flatten().fold(0.0, |m: f64, c| m.max(c.abs()));
        for p in &mut points {
            let d = random.direction();
            *p = [d.x * largest, d.y * largest, d.z * largest];
        }
    }
    if degenerate {
        let flat = if random.one_in(2) { 0.0 } else { random.magnitude(-12.0, -2.0) };
        let axes = 1 + random.index(2);
        points.iter_mut().for_each(|p| p[..axes].iter_mut().for_each(|c| *c *= flat));
        let (first, second) = (points[0], points[count / 2]);
        points.push(between(random, first, second));
        points.push(first);
    }
    points
}

fn plane_normal(random: &mut Random) -> [f64; 3] {
    let mut normal = [0.0; 3];
    if random.one_in(2) {
        normal[random.index(3)] = if random.one_in(2) { 1.0 } else { -1.0 };
    } else {
        let (d, length) = (random.direction(), random.magnitude(-3.0, 3.0));
        normal = [d.x * length, d.y * length, d.z * length];
    }
    normal
}

/// Quaternion (w, x, y, z) of any norm.
fn rotation(random: &mut Random, near: Option<[f64; 4]>) -> [f64; 4] {
    let axis_aligned: [[f64; 4]; 6] = [
        [1.0, 0.0, 0.0, 0.0],
        [1.0, 1.0, 0.0, 0.0],
        [1.0, 0.0, -1.0, 0.0],
        [0.0, 0.0, 0.0, 1.0],
        [1.0, 1.0, 1.0, 1.0],
        [0.0, 1.0, -1.0, 0.0],
    ];
    let mut q = match (near, random.index(4)) {
        (Some(q), 0) => q,
        // Parallel but for a hair.
        (Some(q), 1) => {
            let tilt = random.magnitude(-17.0, -2.0) * q.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
            q.map(|c| c + random.between(-tilt, tilt))
        }
        (_, 0 | 2) => axis_aligned[random.index(axis_aligned.len())],
        _ => [0; 4].map(|_| random.between(-1.0, 1.0)),
    };
    if random.one_in(2) {
        let norm = if random.one_in(20) { random.magnitude(-140.0, 140.0) } else { random.magnitude(-3.0, 3.0) };
        q = q.map(|c| c * norm);
    }
    q
}

fn place(random: &mut Random, a: Form, b: Form, dyadic: bool) -> Option<Pair> {
    let rotation_a = rotation(random, None);
    let rotation_b = rotation(random, Some(rotation_a));
    let reach = a.core.reach() + b.core.reach() + a.swept_radius.hi + b.swept_radius.hi;
    let reach = if reach > 0.0 { reach } else { 1.0 };
    let mut direction = random.direction();
    if dyadic || random.one_in(4) {
        let axis = direction.iamax();
        direction = clearance::geometry::Vec3::ith(axis, direction[axis].signum());
    }
    let along = |length: f64| [direction.x * length, direction.y * length, direction.z * length];
    let bounded = a.core.is_bounded() && b.core.is_bounded();
    let a = a.placed([0.0; 3], rotation_a)?;
    let offset = match random.index(8) {
        0 => along(reach * random.between(0.0, 0.7)),
        1 if random.one_in(2) => [0.0; 3],
        choice => {
            let gap = match choice {
                1 | 2 => reach * random.magnitude(-1.0, 3.0),
                3 | 4 => reach * random.magnitude(-14.0, -1.0),
                5 => 0.0,
                6 => reach * random.between(-4e-15, 4e-15),
                _ => -reach * random.magnitude(-14.0, -1.0),
            };
            // From far apart, by as much as the distance exceeds the gap, along the normal.
            let start = if bounded { along(4.0 * reach) } else { [0.0; 3] };
            let far = b.clone().placed(start, rotation_b)?;
            let found = truth(&a.body, &far.body, 1e-18 * reach, 100);
            let travel = found.value() - gap;
            [0, 1, 2].map(|i| start[i] - found.normal[i] * travel)
        }
    };
    let b = b.placed(offset, rotation_b)?;
    let (a, b) = if random.one_in(2) { (b, a) } else { (a, b) };
    if random.one_in(2) {
        return Some(Pair { a, b });
    }
    // Far from the origin, rounding and all: the question is about the rounded numbers.
    let (home, distance) = (random.direction(), random.magnitude(-3.0, 8.0));
    let home = [home.x * distance, home.y * distance, home.z * distance];
    let moved = |s: &Specimen| s.moved_to([0, 1, 2].map(|i| s.body.translation[i] + home[i]));
    Some(Pair { a: moved(&a), b: moved(&b) })
}
