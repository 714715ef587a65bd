//! Moving pairs: the time of impact is never later than the contact, and what is called clear is.
//!
//! Oracles: closed forms for balls, boxes and walls; for everything else dense sampling of the motion, each sample measured by
//! [`crate::oracle`] in double-doubles at a pose that is worked out here by another formula (Rodrigues' on the axes). A
//! sample is trusted to `tolerance`: what doubles leave of a pose that is far from the origin or turns many times. Sampling sees no
//! contact between samples, so that samples are set close to the end of the proved stretch, where one would be.

use std::collections::BTreeMap;

use clearance::geometry::{Pose, Quaternion, RigidMotion, Shape, Vec3};
use clearance::narrow_phase::{Impact, ImpactGoal, Outcome, Termination, impact};

use crate::oracle::truth;
use crate::random_pairs::{KINDS, random_pair};
use crate::samples::Random;
use crate::specimen::Specimen;

/// A specimen on its way.
struct Traveller {
    /// As it is at the start.
    start: Specimen,
    motion: RigidMotion,
}

impl Traveller {
    /// A motion on which the specimen is where it was given, or nearly, at `time`.
    fn through(specimen: &Specimen, time: f64, random: &mut Random, size: f64) -> Self {
        let displacement =
            if random.one_in(4) { Vec3::zeros() } else { random.direction() * (size * random.magnitude(-3.0, 1.5)) };
        let turn = match random.index(4) {
            0 => random.direction() * random.magnitude(-6.0, 0.5),
            1 => random.direction() * random.between(1.0, 12.0),
            _ => Vec3::zeros(),
        };
        let at = specimen.pose.translation() - displacement * time;
        let back = turned(specimen.pose.rotation(), turn * -time);
        let rotation = if turn == Vec3::zeros() { specimen.pose.rotation() } else { back };
        let pose = Pose::new(at, rotation).unwrap();
        let motion = if random.one_in(3) && turn.norm() < 3.0 {
            let end = Pose::new(at + displacement, turned(rotation, turn)).unwrap();
            RigidMotion::between(pose, if turn == Vec3::zeros() { with_rotation(&end, rotation) } else { end })
        } else {
            RigidMotion::by(pose, displacement, turn).unwrap()
        };
        Self { start: placed(specimen, &pose), motion }
    }

    fn at(&self, time: f64) -> Specimen {
        let pose = self.motion.start();
        let rotation =
            if self.motion.turns() { turned(pose.rotation(), self.motion.turn() * time) } else { pose.rotation() };
        let there = pose.translation() + self.motion.displacement() * time;
        placed(&self.start, &Pose::new(there, rotation).unwrap())
    }
}

fn with_rotation(pose: &Pose, rotation: Quaternion) -> Pose {
    Pose::new(pose.translation(), rotation).unwrap()
}

fn placed(specimen: &Specimen, pose: &Pose) -> Specimen {
    let (t, q) = (pose.translation(), pose.rotation());
    let mut body = specimen.body.clone();
    (body.translation, body.rotation) = ([t.x, t.y, t.z], [q.w, q.x, q.y, q.z]);
    Specimen { shape: specimen.shape.clone(), pose: *pose, body }
}

/// A rotation turned further by a vector in the outer axes: each axis of the body by Rodrigues' formula, and back to a quaternion by
/// the trace (Shepperd 1978).
fn turned(q: Quaternion, by: Vec3) -> Quaternion {
    let angle = by.norm();
    if angle == 0.0 {
        return q;
    }
    let axis = by / angle;
    let (sin, cos) = libm::sincos(angle);
    let matrix = q.matrix();
    let axes = [0, 1, 2].map(|i| {
        let v: Vec3 = matrix.column(i).into();
        v * cos + axis.cross(&v) * sin + axis * (axis.dot(&v) * (1.0 - cos))
    });
    let m = |row: usize, column: usize| axes[column][row];
    let squares = [
        1.0 + m(0, 0) + m(1, 1) + m(2, 2),
        1.0 + m(0, 0) - m(1, 1) - m(2, 2),
        1.0 - m(0, 0) + m(1, 1) - m(2, 2),
        1.0 - m(0, 0) - m(1, 1) + m(2, 2),
    ];
    let largest = (0..4).max_by(|i, j| squares[*i].total_cmp(&squares[*j])).unwrap();
    let [w, x, y, z] = match largest {
        0 => [squares[0], m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1)],
        1 => [m(2, 1) - m(1, 2), squares[1], m(0, 1) + m(1, 0), m(0, 2) + m(2, 0)],
        2 => [m(0, 2) - m(2, 0), m(0, 1) + m(1, 0), squares[2], m(1, 2) + m(2, 1)],
        _ => [m(1, 0) - m(0, 1), m(0, 2) + m(2, 0), m(1, 2) + m(2, 1), squares[3]],
    };
    Quaternion { w, x, y, z }
}

fn ask(a: &Traveller, b: &Traveller, goal: &ImpactGoal) -> Impact {
    impact(&a.start.shape, &b.start.shape, &a.motion, &b.motion, goal).expect("one of them has bounds")
}

/// What a sweep has seen.
#[derive(Default)]
struct Tally {
    motions: usize,
    samples: usize,
    kinds: BTreeMap<&'static str, usize>,
    regimes: BTreeMap<&'static str, usize>,
    supports: u64,
    violations: Vec<String>,
}

impl Tally {
    fn add(&mut self, other: Self) {
        (self.motions, self.samples) = (self.motions + other.motions, self.samples + other.samples);
        self.supports += other.supports;
        for (mine, theirs) in [(&mut self.kinds, other.kinds), (&mut self.regimes, other.regimes)] {
            theirs.into_iter().for_each(|(name, count)| *mine.entry(name).or_default() += count);
        }
        self.violations.extend(other.violations);
    }
}

/// Which way a motion went.
const REGIMES: [&str; 10] = [
    "clear",
    "hit",
    "hit at the start",
    "undecided",
    "narrow bracket",
    "turning",
    "both moving",
    "far from the origin",
    "with a margin",
    "half-space or plane",
];

fn check(random: &mut Random, tally: &mut Tally) {
    let pair = random_pair(random);
    let size = pair.a.body.core.reach().max(pair.b.body.core.reach()).max(1e-9)
        + pair.a.body.swept_radius.hi
        + pair.b.body.swept_radius.hi;
    let time = match random.index(6) {
        0 => 0.0,
        1 => 1.0,
        _ => random.between(0.05, 0.95),
    };
    let (a, b) = (Traveller::through(&pair.a, time, random, size), Traveller::through(&pair.b, time, random, size));
    let margin = if random.one_in(4) { size * random.magnitude(-4.0, 0.0) } else { 0.0 };
    let goal = ImpactGoal { margin, ..ImpactGoal::touch() };
    let found = ask(&a, &b, &goal);

    tally.motions += 1;
    tally.supports += found.cost.supports;
    *tally.kinds.entry(pair.a.shape.kind()).or_default() += 1;
    *tally.kinds.entry(pair.b.shape.kind()).or_default() += 1;
    let mut seen = |name: &'static str, is: bool| *tally.regimes.entry(name).or_default() += usize::from(is);
    let travelled = [&a, &b].map(|t| t.motion.displacement().norm() + t.motion.start().translation().norm());
    seen("clear", found.outcome == Outcome::Clear);
    seen("hit", found.outcome == Outcome::Hit && !found.starts_touching);
    seen("hit at the start", found.starts_touching);
    seen("undecided", found.outcome == Outcome::Undecided);
    let width = found.touching_at.map_or(1.0, |t| t - found.free_until);
    seen("narrow bracket", width < 1e-9 && !found.starts_touching);
    seen("turning", a.motion.turns() || b.motion.turns());
    seen("both moving", travelled_at_all(&a) && travelled_at_all(&b));
    seen("far from the origin", travelled.iter().any(|way| *way > 1e3 * size));
    seen("with a margin", margin > 0.0);
    seen("half-space or plane", pair.a.shape.bounds().is_none() || pair.b.shape.bounds().is_none());

    let reach = 2.0 * size + travelled[0] + travelled[1];
    let turns = a.motion.turn().norm() + b.motion.turn().norm();
    let offset = [&pair.a, &pair.b].map(|s| if s.shape.bounds().is_none() { reach } else { size });
    let tolerance = 1e-14 * (1.0 + turns) * (reach + offset[0] + offset[1]) + 1e-13 * margin;
    let mut complain = |what: String| {
        tally.violations.push(format!(
            "{what}\n  {found:?}\n  margin {margin:e}\n  a: {:?} {:?}\n  b: {:?} {:?}",
            a.start.shape, a.motion, b.start.shape, b.motion
        ));
    };
    if !(0.0..=1.0).contains(&found.free_until)
        || found.touching_at.is_some_and(|t| !(found.free_until..=1.0).contains(&t))
    {
        complain("times out of order".to_owned());
    }
    let signed_distance = |t: f64| truth(&a.at(t).body, &b.at(t).body, 1e-6 * tolerance, 60);
    let free = found.free_until;
    for t in
        [free * 0.5, free * random.between(0.0, 1.0), free * (1.0 - 1e-3), free * (1.0 - 1e-7), free * (1.0 - 1e-12)]
    {
        let there = signed_distance(t);
        tally.samples += 1;
        if free > 0.0 && there.upper.hi < margin - tolerance {
            complain(format!(
                "called free at {t}, where the distance is {:e}, tolerance {tolerance:e}",
                there.upper.hi
            ));
        }
    }
    if let Some(t) = found.touching_at {
        let there = signed_distance(t);
        if there.lower.hi > margin + tolerance {
            complain(format!(
                "called touching at {t}, where the distance is {:e}, tolerance {tolerance:e}",
                there.lower.hi
            ));
        }
    }
    let swapped = ask(&b, &a, &goal);
    let apart = |one: &Impact, two: &Impact| one.touching_at.is_some_and(|t| t < two.free_until - 1e-12);
    if apart(&found, &swapped) || apart(&swapped, &found) {
        complain(format!("contradicts the same pair the other way around: {swapped:?}"));
    }
}

fn travelled_at_all(t: &Traveller) -> bool {
    t.motion.turns() || t.motion.displacement() != Vec3::zeros()
}

fn sweep(motions: usize, seed: u64) -> Tally {
    let mut random = Random::new(seed);
    let mut tally = Tally::default();
    for _ in 0..motions {
        check(&mut random, &mut tally);
    }
    tally
}

fn hold(tally: &Tally) {
    let Tally { motions, samples, kinds, regimes, supports, violations } = tally;
    let wrong = violations.len();
    println!("{motions} motions, {samples} samples, {supports} supports, {wrong} violations\n{kinds:?}\n{regimes:?}");
    assert!(violations.is_empty(), "{wrong} violations, the first of them:\n{}", violations[..wrong.min(3)].join("\n"));
    let enough = |count: Option<&usize>| *count.unwrap_or(&0) >= motions / 500;
    for kind in KINDS {
        assert!(enough(kinds.get(kind)), "too few of kind {kind}");
    }
    for regime in REGIMES {
        assert!(enough(regimes.get(regime)), "too few motions: {regime}");
    }
}

#[test]
fn no_motion_is_called_free_where_samples_find_a_contact() {
    hold(&sweep(2000, 1));
}

#[test]
#[ignore = "minutes; ./test long runs it"]
fn a_million_motions_are_never_called_free_where_samples_find_a_contact() {
    let motions: usize = std::env::var("SOUNDNESS_MOTIONS").ok().and_then(|n| n.parse().ok()).unwrap_or(1_000_000);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let mut whole = Tally::default();
    std::thread::scope(|scope| {
        let part = |i: usize| scope.spawn(move || sweep(motions.div_ceil(threads), 100 + i as u64));
        let parts: Vec<_> = (0..threads).map(part).collect();
        parts.into_iter().for_each(|part| whole.add(part.join().unwrap()));
    });
    hold(&whole);
}

fn straight(at: Vec3, displacement: Vec3) -> RigidMotion {
    RigidMotion::by(Pose::new(at, Quaternion::IDENTITY).unwrap(), displacement, Vec3::zeros()).unwrap()
}

fn still(at: Vec3) -> RigidMotion {
    RigidMotion::still(Pose::new(at, Quaternion::IDENTITY).unwrap())
}

/// Holds a hit against its time by a formula.
fn check_time(
    a: &Shape,
    b: &Shape,
    motion_a: &RigidMotion,
    motion_b: &RigidMotion,
    margin: f64,
    expected: f64,
) -> Impact {
    let found = impact(a, b, motion_a, motion_b, &ImpactGoal { margin, ..ImpactGoal::touch() }).unwrap();
    let touching_at = found.touching_at.unwrap_or_else(|| panic!("{expected}: {found:?}"));
    let rounding = 4.0 * f64::EPSILON;
    assert!(found.free_until <= expected + rounding && expected <= touching_at + rounding, "{expected}: {found:?}");
    assert!(touching_at - found.free_until <= 1.000001e-9, "{expected}: {found:?}");
    found
}

#[test]
fn balls_meet_when_the_formula_says() {
    let (one, two) = (Shape::sphere(0.5).unwrap(), Shape::sphere(0.25).unwrap());
    for (offset, gap) in [(0.0, 4.0), (0.3, 4.0), (0.7, 10.0), (0.749, 2.0), (0.0, 1e6)] {
        // Along x at a distance of `offset`: they touch where the centres are 0.75 apart.
        let way = 2.0 * gap;
        let expected = (gap - (0.75_f64 * 0.75 - offset * offset).sqrt()) / way;
        let there = Vec3::new(gap, offset, 0.0);
        let found = check_time(&one, &two, &straight(Vec3::zeros(), Vec3::x() * way), &still(there), 0.0, expected);
        let normal = (there - Vec3::x() * (way * expected)) / 0.75;
        assert!((found.place.unwrap().normal - normal).norm() < 1e-6, "{found:?}");
        // Both moving at half the speed; and far away together.
        let home = Vec3::new(3e7, -2e7, 1e7);
        let (a, b) = (straight(home, Vec3::x() * (0.5 * way)), straight(home + there, Vec3::x() * (-0.5 * way)));
        if gap < 1e3 {
            let expected = {
                let gap = ((home + there) - home).x;
                let offset = ((home + there) - home).y;
                (gap - (0.75_f64 * 0.75 - offset * offset).sqrt()) / way
            };
            check_time(&one, &two, &a, &b, 0.0, expected);
        }
        let margin = 0.125;
        let expected = (gap - (0.875_f64 * 0.875 - offset * offset).sqrt()) / way;
        check_time(&one, &two, &straight(Vec3::zeros(), Vec3::x() * way), &still(there), margin, expected);
    }
}

#[test]
fn balls_that_pass_are_clear_by_a_hair_and_undecided_without_one() {
    let ball = Shape::sphere(0.5).unwrap();
    let pass = |offset: f64| {
        let (a, b) = (straight(Vec3::new(-2.0, 0.0, 0.0), Vec3::x() * 4.0), still(Vec3::new(0.0, offset, 0.0)));
        impact(&ball, &ball, &a, &b, &ImpactGoal::touch()).unwrap()
    };
    let clear = pass(1.0 + 1e-11);
    assert_eq!((clear.outcome, clear.free_until), (Outcome::Clear, 1.0));
    let touching = pass(1.0 - 1e-11);
    assert_eq!(touching.outcome, Outcome::Hit, "{touching:?}");
    let grazing = pass(1.0);
    // They touch in one point at one time: no double shows it.
    assert_eq!(grazing.outcome, Outcome::Undecided, "{grazing:?}");
    let (from, to) = (grazing.free_until, grazing.open_until.unwrap());
    assert!(from <= 0.5 && to >= 0.5 && to - from < 1e-6, "{grazing:?}");
}

#[test]
fn a_box_falls_on_a_floor_and_a_rod_swings_into_a_wall() {
    let floor = Shape::half_space(Vec3::z(), 0.0).unwrap();
    let cube = Shape::cuboid(Vec3::new(0.5, 0.5, 0.5)).unwrap();
    let found =
        check_time(&cube, &floor, &straight(Vec3::z() * 2.5, Vec3::z() * -4.0), &still(Vec3::zeros()), 0.0, 0.5);
    assert!((found.place.unwrap().normal + Vec3::z()).norm() < 1e-12);
    // The floor comes up; and a plane is met from either side.
    check_time(&floor, &cube, &straight(Vec3::zeros(), Vec3::z() * 4.0), &still(Vec3::z() * 2.5), 0.0, 0.5);
    let plane = Shape::plane(Vec3::z(), 0.0).unwrap();
    check_time(&cube, &plane, &straight(Vec3::z() * -2.5, Vec3::z() * 4.0), &still(Vec3::zeros()), 0.0, 0.5);

    // A rod of length 1 with its foot at the origin, turned about z by 120 degrees, meets the wall y = 0.6 where sin = 0.6.
    let rod = Shape::segment(Vec3::zeros(), Vec3::x()).unwrap();
    let wall = Shape::half_space(-Vec3::y(), -0.6).unwrap();
    let angle = 2.0 * std::f64::consts::FRAC_PI_3;
    let swing = RigidMotion::by(Pose::identity(), Vec3::zeros(), Vec3::z() * angle).unwrap();
    let expected = libm::asin(0.6) / angle;
    check_time(&rod, &wall, &swing, &still(Vec3::zeros()), 0.0, expected);
    // The same as seen from the rod: the wall turns back.
    let back = RigidMotion::by(Pose::identity(), Vec3::zeros(), Vec3::z() * -angle).unwrap();
    check_time(&wall, &rod, &back, &still(Vec3::zeros()), 0.0, expected);
}

#[test]
fn what_touches_at_the_start_or_at_the_end_says_so() {
    let cube = Shape::cuboid(Vec3::new(0.5, 0.5, 0.5)).unwrap();
    let ask = |at: Vec3, displacement: Vec3| {
        impact(&cube, &cube, &straight(at, displacement), &still(Vec3::zeros()), &ImpactGoal::touch()).unwrap()
    };
    let touching = ask(Vec3::x(), Vec3::x());
    assert!(
        touching.starts_touching && touching.free_until == 0.0 && touching.touching_at == Some(0.0),
        "{touching:?}"
    );
    let inside = ask(Vec3::x() * 0.1, Vec3::x());
    assert!(inside.starts_touching, "{inside:?}");
    // It arrives exactly, and that is exactly known only where the end was given.
    let end = |x: f64| Pose::new(Vec3::x() * x, Quaternion::IDENTITY).unwrap();
    let arriving = RigidMotion::between(end(3.0), end(1.0));
    let found = impact(&cube, &cube, &arriving, &still(Vec3::zeros()), &ImpactGoal::touch()).unwrap();
    assert_eq!((found.outcome, found.touching_at), (Outcome::Hit, Some(1.0)), "{found:?}");
    assert!(found.free_until > 1.0 - 1e-12);
    let short = impact(
        &cube,
        &cube,
        &RigidMotion::between(end(3.0), end(1.0 + 1e-12)),
        &still(Vec3::zeros()),
        &ImpactGoal::touch(),
    );
    assert_eq!(short.unwrap().outcome, Outcome::Clear);
    // Nobody moves.
    let apart = impact(&cube, &cube, &still(Vec3::x() * 2.0), &still(Vec3::zeros()), &ImpactGoal::touch()).unwrap();
    assert_eq!((apart.outcome, apart.place), (Outcome::Clear, None));
}

#[test]
fn a_limit_ends_the_work_and_what_was_proved_stays() {
    let ball = Shape::sphere(0.5).unwrap();
    let (a, b) = (straight(Vec3::zeros(), Vec3::x() * 4.0), still(Vec3::x() * 3.0));
    let stopped = impact(&ball, &ball, &a, &b, &ImpactGoal { stop: &|| true, ..ImpactGoal::touch() }).unwrap();
    assert_eq!((stopped.outcome, stopped.termination), (Outcome::Undecided, Termination::TimeLimit));
    assert!(stopped.free_until <= 0.5);
    let until = impact(&ball, &ball, &a, &b, &ImpactGoal { until: 0.4, ..ImpactGoal::touch() }).unwrap();
    assert_eq!((until.outcome, until.free_until), (Outcome::Clear, 0.4));
    let wall = Shape::plane(Vec3::x(), 0.0).unwrap();
    let refused = impact(&wall, &wall, &a, &b, &ImpactGoal::touch()).unwrap_err();
    assert_eq!(refused.to_string(), "a plane and a plane are both unbounded, so they have no time of impact");
}
