//! What must hold between answers to related questions, whatever the truth is.
//!
//! Oracle: the library itself, asked again in another way; brackets of equal quantities must overlap, with no slack beyond
//! what rounding did to the numbers of the second question. The laws can all hold in a library that is wrong in a consistent
//! way, so `soundness` has the truth. Random pairs of every kind and scale, `PROPTEST_CASES` of them a law (default 400).

use clearance::geometry::{Pose, Quaternion, Shape, Vec3};
use clearance::narrow_phase::{Bracket, Goal, Separation};

use crate::oracle::Core;
use crate::oracle::double_double::Dd;
use crate::random_pairs::{Pair, random_pair};
use crate::samples::Random;
use crate::specimen::{Form, Specimen, ask};

/// Relative rounding of a sum or product or two.
const ROUNDINGS: f64 = 4.0 * f64::EPSILON;

/// Calls `check`, which says whether the law had something to say about the pair, until it had `PROPTEST_CASES` times.
fn for_random_pairs(seed: u64, mut check: impl FnMut(&mut Random, &Pair) -> bool) {
    let cases = std::env::var("PROPTEST_CASES").map_or(400, |text| text.parse().expect("a whole number"));
    let mut random = Random::new(seed);
    let mut checked = 0;
    for _ in 0..60 * cases {
        let pair = random_pair(&mut random);
        checked += usize::from(check(&mut random, &pair));
        if checked == cases {
            return;
        }
    }
    panic!("the law applied only {checked} times of {cases}");
}

fn measure(a: &Specimen, b: &Specimen) -> Separation {
    ask(a, b, &Goal::penetration())
}

fn assert_overlap(one: Bracket, other: Bracket, pair: &Pair) {
    let overlap = one.lower <= other.upper && other.lower <= one.upper;
    assert!(overlap, "{one:?}\n{other:?}\n  A {:?}\n  B {:?}", pair.a.body, pair.b.body);
}

fn with_pose(specimen: &Specimen, pose: Pose) -> Specimen {
    let Quaternion { w, x, y, z } = pose.rotation();
    let body =
        crate::oracle::Body { translation: pose.translation().into(), rotation: [w, x, y, z], ..specimen.body.clone() };
    Specimen { shape: specimen.shape.clone(), pose, body }
}

/// The same place, another shape.
fn with_form(specimen: &Specimen, form: Form) -> Specimen {
    form.placed(specimen.body.translation, specimen.body.rotation).expect("the place was good before")
}

#[test]
fn swapping_the_sides_leaves_the_distance() {
    for_random_pairs(201, |_, pair| {
        let (one, other) = (measure(&pair.a, &pair.b), measure(&pair.b, &pair.a));
        assert_overlap(one.bracket, other.bracket, pair);
        true
    });
}

/// Where the sums are exact, the question is the same to the last bit, and so must be the answer but for the place.
#[test]
fn an_exact_common_shift_changes_no_bit_of_distance_and_normal() {
    for_random_pairs(202, |random, pair| {
        let shift = [0; 3].map(|_| libm::exp2(random.between(-8.0, 8.0).floor()));
        let shifted = |s: &Specimen| -> Option<Specimen> {
            let t = s.body.translation;
            let sums = [0, 1, 2].map(|i| Dd::difference(t[i], -shift[i]));
            sums.iter().all(|sum| sum.lo == 0.0).then(|| s.moved_to(sums.map(|sum| sum.hi)))
        };
        let (Some(a), Some(b)) = (shifted(&pair.a), shifted(&pair.b)) else { return false };
        let (one, other) = (measure(&pair.a, &pair.b), measure(&a, &b));
        let what = |s: &Separation| (s.bracket, s.signed_distance, s.normal, s.termination, s.cost);
        assert_eq!(what(&one), what(&other), "A {:?}\nB {:?}", pair.a.body, pair.b.body);
        true
    });
}

/// Half turns about the axes only change signs and places of numbers; in other motions they round, by no more than `slack`.
#[test]
fn a_common_motion_leaves_the_distance() {
    let mut half_turns = 0;
    for_random_pairs(203, |random, pair| {
        let exact = random.one_in(2);
        half_turns += usize::from(exact);
        let far = |s: &Specimen| s.body.translation.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
        let away = if exact { 0.0 } else { far(&pair.a).max(far(&pair.b)) };
        let turn = [[0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]][random.index(3)];
        let [w, x, y, z] = if exact { turn } else { [0; 4].map(|_| random.between(-1.0, 1.0)) };
        let motion = Pose::new(random.vector(1.0) * away, Quaternion { w, x, y, z }).expect("a motion");
        let moved = |s: &Specimen| with_pose(s, motion.compose(&s.pose));
        let (one, other) = (measure(&pair.a, &pair.b), measure(&moved(&pair.a), &moved(&pair.b)));
        // Composing turns a rotation by some 20 roundings, and moves a place by as many of the distances involved. A
        // half turn does neither to quaternions that compose without being reduced to norm 1.
        let norm = |s: &Specimen| s.body.rotation.iter().map(|c| c * c).sum::<f64>();
        let reduced = [&pair.a, &pair.b].iter().any(|s| !(0.25..=4.0).contains(&norm(s)));
        // A turned half-space moves as far as the other shape is away from its own origin.
        let reach = |s: &Specimen| {
            if let Core::HalfSpace { offset, normal, .. } = &s.body.core {
                return offset.abs() / Vec3::from(*normal).norm();
            }
            s.body.core.reach()
        };
        let separation = (pair.a.pose.translation() - pair.b.pose.translation()).norm();
        let size = reach(&pair.a) + reach(&pair.b) + separation;
        let slack = if exact && !reduced { 0.0 } else { 20.0 * f64::EPSILON * (size + 4.0 * away) };
        let Bracket { lower, upper } = other.bracket;
        assert_overlap(one.bracket, Bracket { lower: lower - slack, upper: upper + slack }, pair);
        true
    });
    assert!(half_turns > 100, "{half_turns} half turns");
}

#[test]
fn a_power_of_two_scales_every_output_bit_for_bit() {
    for_random_pairs(204, |random, pair| {
        let factor = libm::exp2(random.between(-16.0, 16.0).floor());
        let scaled = |s: &Specimen| {
            let pose = Pose::new(s.pose.translation() * factor, s.pose.rotation()).expect("a finite place");
            let shape = s.shape.scaled(factor).expect("a size in reach");
            Specimen { shape, pose, body: s.body.clone() }
        };
        let (one, other) = (measure(&pair.a, &pair.b), measure(&scaled(&pair.a), &scaled(&pair.b)));
        let Bracket { lower, upper } = one.bracket;
        let expected = Separation {
            bracket: Bracket { lower: lower * factor, upper: upper * factor },
            signed_distance: one.signed_distance * factor,
            point_on_a: one.point_on_a * factor,
            point_on_b: one.point_on_b * factor,
            point_error: one.point_error * factor,
            ..one
        };
        assert_eq!(expected, other, "times {factor}\n  A {:?}\n  B {:?}", pair.a.body, pair.b.body);
        true
    });
}

/// Beyond 1e20 m the library scales on its own, with an allowance for what underflows: overlap is what is left.
#[test]
fn a_power_of_two_beyond_all_use_scales_the_bracket() {
    for_random_pairs(213, |random, pair| {
        let factor = libm::exp2(random.between(90.0, 400.0).floor() * if random.one_in(2) { 1.0 } else { -1.0 });
        let scaled = |s: &Specimen| {
            let pose = Pose::new(s.pose.translation() * factor, s.pose.rotation()).ok()?;
            Some(Specimen { shape: s.shape.scaled(factor).ok()?, pose, body: s.body.clone() })
        };
        let (Some(a), Some(b)) = (scaled(&pair.a), scaled(&pair.b)) else { return false };
        let Bracket { lower, upper } = measure(&pair.a, &pair.b).bracket;
        let expected = Bracket { lower: lower * factor, upper: upper * factor };
        assert_overlap(expected, measure(&a, &b).bracket, pair);
        true
    });
}

/// Whether the swept radius is a double, so that another shape can be swept by the same.
fn has_double_radius(specimen: &Specimen) -> bool {
    specimen.shape.swept_radius_unrounded()[1..] == [0.0; 2]
}

fn hull_points(specimen: &Specimen) -> Option<Vec<[f64; 3]>> {
    let Core::Hull(points) = &specimen.body.core else { return None };
    (points.len() > 3 && has_double_radius(specimen)).then(|| points.clone())
}

fn with_points(specimen: &Specimen, points: &[[f64; 3]]) -> Specimen {
    let form = Form::convex(points).and_then(|form| form.swept(specimen.shape.swept_radius()));
    with_form(specimen, form.expect("points as good as before"))
}

#[test]
fn the_order_of_a_hulls_points_does_not_matter() {
    for_random_pairs(205, |random, pair| {
        let Some(mut points) = hull_points(&pair.a) else { return false };
        for i in (1..points.len()).rev() {
            points.swap(i, random.index(i + 1));
        }
        let other = measure(&with_points(&pair.a, &points), &pair.b);
        assert_overlap(measure(&pair.a, &pair.b).bracket, other.bracket, pair);
        true
    });
}

/// Midpoints that are exact are in the hull exactly.
#[test]
fn duplicates_and_points_inside_change_no_hull() {
    for_random_pairs(206, |random, pair| {
        let Some(mut points) = hull_points(&pair.a) else { return false };
        let given = points.len();
        for _ in 0..3 * given {
            let (p, q) = (points[random.index(points.len())], points[random.index(given)]);
            let sums = [0, 1, 2].map(|i| Dd::difference(p[i], -q[i]));
            if sums.iter().all(|sum| sum.lo == 0.0) {
                points.push(sums.map(|sum| 0.5 * sum.hi));
            }
        }
        if points.len() < given + 3 {
            return false;
        }
        let other = measure(&with_points(&pair.a, &points), &pair.b);
        assert_overlap(measure(&pair.a, &pair.b).bracket, other.bracket, pair);
        true
    });
}

/// A push of B along the normal by s adds s: no more because the distance is 1-Lipschitz, no less because the plane that
/// proves `lower` is pushed along.
#[test]
fn a_push_along_the_normal_adds_its_length() {
    let mut meeting = 0;
    for_random_pairs(207, |random, pair| {
        let one = measure(&pair.a, &pair.b);
        let size = one.bracket.upper.abs() + pair.a.body.core.reach().min(pair.b.body.core.reach());
        let push = one.normal * (size * random.magnitude(-6.0, 1.0));
        let place = pair.b.pose.translation();
        let pushed = pair.b.moved_to((place + push).into());
        // As it came out in numbers, and how much of it is along the normal.
        let real = pushed.pose.translation() - place;
        let (length, along) = (real.norm(), real.dot(&one.normal));
        if !(along > 0.9 * length) {
            return false; // Lost in the rounding of a place far away.
        }
        meeting += usize::from(one.bracket.upper < 0.0);
        let rounding = ROUNDINGS * (length + size) + f64::EPSILON * (place.amax() + length);
        let Bracket { lower, upper } = one.bracket;
        let expected = Bracket { lower: lower + along - rounding, upper: upper + length + rounding };
        assert_overlap(expected, measure(&pair.a, &pushed).bracket, pair);
        true
    });
    assert!(meeting > 40, "only {meeting} of them met");
}

/// Shapes in which the given one is contained, number by number.
fn larger(random: &mut Random, specimen: &Specimen) -> Option<Specimen> {
    if !has_double_radius(specimen) {
        return None;
    }
    let mut more = |x: f64| if random.one_in(2) { x } else { x * random.between(1.0, 3.0) };
    let form = match &specimen.body.core {
        Core::Cuboid(half) => Form::cuboid(half.map(&mut more)),
        Core::Cylinder { radius, half_length } => Form::cylinder(more(*radius), more(*half_length)),
        Core::Cone { radius, half_length } => Form::cone(more(*radius), *half_length),
        Core::Ellipsoid(radii) => Form::ellipsoid(radii.map(&mut more)),
        Core::Hull(points) => {
            let mut points = points.clone();
            points.push(points[0].map(|c| more(-c)));
            Form::convex(&points)
        }
        Core::HalfSpace { normal, offset, thin: false } => Form::half_space(*normal, offset + more(1.0) * offset.abs()),
        Core::HalfSpace { normal, offset, thin: true } => Form::half_space(*normal, *offset),
    }?;
    let form = form.swept(more(specimen.shape.swept_radius()))?;
    Some(with_form(specimen, form))
}

#[test]
fn a_larger_shape_is_never_farther() {
    for_random_pairs(208, |random, pair| {
        let Some(large) = larger(random, &pair.a) else { return false };
        if !large.body.core.is_bounded() && !pair.b.body.core.is_bounded() {
            return false;
        }
        let (one, other) = (measure(&pair.a, &pair.b).bracket, measure(&large, &pair.b).bracket);
        assert!(other.lower <= one.upper, "{one:?}\n{other:?}\n  A {:?}\n  B {:?}", large.body, pair.b.body);
        true
    });
}

/// By way of any point: sd(A, B) <= sd(A, p) + sd(p, B), inside and outside alike, for a ball around p of the depth of p is in
/// the shape.
#[test]
fn no_detour_through_a_point_is_shorter() {
    let (mut inside, mut outside) = (0, 0);
    for_random_pairs(209, |random, pair| {
        let one = measure(&pair.a, &pair.b);
        let size = one.bracket.upper.abs() + pair.a.body.core.reach().min(pair.b.body.core.reach());
        let place = one.point_on_a + random.vector(1.0) * size * random.magnitude(-9.0, 0.0);
        let point = Form::point().and_then(|form| form.placed(place.into(), [1.0, 0.0, 0.0, 0.0])).expect("a point");
        let (first, second) = (measure(&pair.a, &point).bracket.upper, measure(&point, &pair.b).bracket.upper);
        if first < 0.0 {
            inside += 1
        } else {
            outside += 1
        }
        let detour = first + second + ROUNDINGS * (first.abs() + second.abs());
        let bracket = one.bracket;
        assert!(
            bracket.lower <= detour,
            "{bracket:?}, {first} + {second}\n  A {:?}\n  B {:?}",
            pair.a.body,
            pair.b.body
        );
        true
    });
    assert!(inside > 40 && outside > 40, "{inside} from inside, {outside} from outside");
}

#[test]
fn sweeping_by_a_radius_subtracts_it() {
    for_random_pairs(210, |random, pair| {
        let one = measure(&pair.a, &pair.b).bracket;
        let size = one.upper.abs() + pair.a.body.core.reach();
        let radius = size * random.magnitude(-6.0, 1.0);
        let shape = pair.a.shape.swept(radius).expect("a finite radius");
        let added = Dd::from(radius);
        let other = measure(&Specimen { shape, ..pair.a.clone() }, &pair.b).bracket;
        let below = |bound: f64| Dd::from(bound) - added;
        let overlap = below(one.lower) <= Dd::from(other.upper) && Dd::from(other.lower) <= below(one.upper);
        assert!(overlap, "swept by {radius}: {one:?}\n{other:?}\n  A {:?}\n  B {:?}", pair.a.body, pair.b.body);
        true
    });
}

/// A point, a segment and a triangle are hulls too, a capsule is a swept segment, a sphere a swept point.
#[test]
fn equal_sets_of_other_kinds_are_equally_far() {
    for_random_pairs(211, |_, pair| {
        let (core, radius) = (&pair.a.body.core, pair.a.shape.swept_radius());
        if !has_double_radius(&pair.a) {
            return false;
        }
        let Some(corners) = core.corners().filter(|_| !matches!(core, Core::Hull(points) if points.len() > 3)) else {
            return false;
        };
        let points: Vec<Vec3> = corners.iter().map(|p| Vec3::from(*p)).collect();
        let hull = Shape::convex(&points).and_then(|hull| hull.swept(radius)).expect("points of a valid shape");
        let other = measure(&Specimen { shape: hull, ..pair.a.clone() }, &pair.b);
        assert_overlap(measure(&pair.a, &pair.b).bracket, other.bracket, pair);
        true
    });
}

/// No state survives a question: the same bytes at once, after thousands of others, in another order, on another thread.
#[test]
fn the_same_question_gets_the_same_bytes_on_any_thread() {
    let mut random = Random::new(212);
    let pairs: Vec<Pair> = (0..600).map(|_| random_pair(&mut random)).collect();
    // Debug output of a double is exact, and tells -0 from 0.
    let answer = |pair: &Pair| {
        let goals = [Goal::penetration(), Goal::verdict()];
        goals.map(|goal| format!("{:?}", ask(&pair.a, &pair.b, &goal)))
    };
    let here: Vec<_> = pairs.iter().map(answer).collect();
    let (there, backwards) = std::thread::scope(|scope| {
        let there = scope.spawn(|| pairs.iter().map(answer).collect::<Vec<_>>());
        let backwards = scope.spawn(|| pairs.iter().rev().map(answer).collect::<Vec<_>>());
        (there.join().expect("no panic"), backwards.join().expect("no panic"))
    });
    assert_eq!(here, there);
    assert!(here.iter().eq(backwards.iter().rev()), "the order of questions changes answers");
}
