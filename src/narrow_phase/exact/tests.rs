//! The exact solver against enumeration, and one-ulp sweeps across contact through the narrow phase's own door.
//!
//! Oracle: for small integer coordinates the Minkowski difference is written out point by point in `i128`; its distance from
//! the origin is the least over all points, segments and triangles, its depth the least height over all planes through
//! three points that have no point above them. Nothing is rounded and nothing is shared with the solver.

use dashu_int::IBig;

use super::integers::{Span, integer};
use crate::geometry::{Compound, Part, Placement, Pose, Quaternion, Shape, Vec3};
use crate::narrow_phase::{self, Bracket, Depth, Goal, Separation, Termination};
use std::sync::Arc;

type Point = [i128; 3];

fn minus(a: Point, b: Point) -> Point {
    [0, 1, 2].map(|i| a[i] - b[i])
}

fn dot(a: Point, b: Point) -> i128 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Squared distance of the origin from the hull of the points as numerator and denominator; negative: squared depth.
fn enumerated(points: &[Point]) -> (i128, i128) {
    let mut best = (i128::MAX, 1);
    let mut consider = |n: i128, d: i128| {
        // No overflow: small coordinates, and fractions are compared by their integer parts first.
        let (q, r) = (n / d, n % d);
        let (bq, br) = (best.0 / best.1, best.0 % best.1);
        if (q, 0) < (bq, 0) || (q == bq && r * best.1 < br * d) {
            best = (n, d);
        }
    };
    let mut faces = Vec::new();
    for (i, &a) in points.iter().enumerate() {
        consider(dot(a, a), 1);
        for (j, &b) in points.iter().enumerate().skip(i + 1) {
            let ab = minus(b, a);
            let (length, t) = (dot(ab, ab), -dot(a, ab));
            if 0 < t && t < length {
                let n = cross(a, b);
                consider(dot(n, n), length);
            }
            for &c in points.iter().skip(j + 1) {
                let normal = cross(ab, minus(c, a));
                let square = dot(normal, normal);
                if square == 0 {
                    continue;
                }
                let height = dot(normal, a);
                if [(b, c), (c, a), (a, b)].iter().all(|&(p, q)| dot(normal, cross(p, q)) >= 0) {
                    consider(height * height, square);
                }
                let heights = points.iter().map(|&p| dot(normal, p) - height);
                let (least, most) = heights.fold((0, 0), |(l, m), h| (l.min(h), m.max(h)));
                if least == 0 || most == 0 {
                    faces.push((if least == 0 { -height } else { height }, square, least == most));
                }
            }
        }
    }
    // In the hull exactly when below every face; a flat hull holds it when it is in one of its triangles.
    let solid = faces.iter().any(|(_, _, flat)| !flat);
    if best.0 == 0 && !(solid && faces.iter().all(|(height, _, flat)| *flat || *height > 0)) {
        return (0, 1);
    }
    if solid && faces.iter().all(|(height, _, flat)| *flat || *height >= 0) {
        let deepest = faces.iter().filter(|(_, _, flat)| !flat).map(|&(h, s, _)| (h * h, s));
        let least = deepest.reduce(|a, b| if b.0 * a.1 < a.0 * b.1 { b } else { a }).unwrap();
        return (-least.0, least.1);
    }
    best
}

/// Whether `sign * sqrt(square)` is in the bracket, and that two units in the last place wide at most.
fn assert_holds(bracket: Bracket, (numerator, denominator): (i128, i128), context: &str) {
    let truth_above = |x: f64| {
        // truth >= x, by squares.
        let unit = Span::of([x]).lowest.min(0);
        let x_square = integer(x, unit) * integer(x, unit) * IBig::from(denominator);
        let truth_square = IBig::from(numerator.abs()) << usize::try_from(-2 * unit).unwrap();
        match (numerator >= 0, x > 0.0) {
            (true, true) => truth_square >= x_square,
            (true, false) => true,
            (false, true) => false,
            (false, false) => truth_square <= x_square,
        }
    };
    let Bracket { lower, upper } = bracket;
    assert!(truth_above(lower), "{lower} is above {numerator}/{denominator}: {context}");
    assert!(!truth_above(upper.next_up()), "{upper} is below {numerator}/{denominator}: {context}");
    assert!(upper <= lower.next_up(), "{bracket:?}: {context}");
}

/// Small numbers without an order that matters.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, n: u64) -> i128 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        i128::from((self.0 >> 33) % n)
    }

    fn points(&mut self, count: usize, reach: u64) -> Vec<Point> {
        let middle = i128::from(reach / 2);
        (0..count).map(|_| [0; 3].map(|_: i128| self.below(reach) - middle)).collect()
    }
}

fn real(p: Point) -> Vec3 {
    Vec3::new(p[0] as f64, p[1] as f64, p[2] as f64)
}

fn hull(points: &[Point]) -> Shape {
    Shape::convex(&points.iter().map(|p| real(*p)).collect::<Vec<_>>()).unwrap()
}

fn at(translation: Vec3, rotation: Quaternion) -> Placement {
    Pose::new(translation, rotation).unwrap().placement()
}

fn upright(x: f64, y: f64, z: f64) -> Placement {
    at(Vec3::new(x, y, z), Quaternion::IDENTITY)
}

/// The exact solver alone.
fn exactly(a: &Shape, b: &Shape, at_a: &Placement, at_b: &Placement) -> Separation {
    use crate::narrow_phase::convex::Convex;
    use crate::narrow_phase::given::Given;
    let convex = |shape, at| Convex {
        core: Shape::core(shape),
        swept_radius: Shape::swept_radius(shape),
        at,
        placement_error: 0.0,
        given: Given::alone(shape, at),
    };
    super::separation(&convex(a, at_a), &convex(b, at_b), Vec3::new(0.3, -0.2, 0.5), &Goal::penetration()).unwrap()
}

#[test]
fn small_polytopes_agree_with_enumeration() {
    let mut numbers = Numbers(7);
    let (mut apart, mut touching, mut deep, mut flat) = (0, 0, 0, 0);
    for round in 0..600 {
        let sizes = [1 + round % 5, 1 + round / 5 % 5];
        let reach = if round / 25 % 3 == 0 { 3 } else { 9 };
        let (a, b) = (numbers.points(sizes[0], reach), numbers.points(sizes[1], reach));
        // A quaternion of small integers: its matrix times its square is one of integers.
        let [w, x, y, z] = [0; 4].map(|_: i128| numbers.below(5) - 2);
        let n = w * w + x * x + y * y + z * z;
        let turned = n != 0 && round % 2 == 0;
        let [w, x, y, z] = if turned { [w, x, y, z] } else { [1, 0, 0, 0] };
        let n = if turned { n } else { 1 };
        let rotated = |p: Point| {
            [
                (w * w + x * x - y * y - z * z) * p[0] + 2 * (x * y - w * z) * p[1] + 2 * (x * z + w * y) * p[2],
                2 * (x * y + w * z) * p[0] + (w * w - x * x + y * y - z * z) * p[1] + 2 * (y * z - w * x) * p[2],
                2 * (x * z - w * y) * p[0] + 2 * (y * z + w * x) * p[1] + (w * w - x * x - y * y + z * z) * p[2],
            ]
        };
        let shift = numbers.points(1, if reach == 3 { 3 } else { 7 })[0];
        let of_b = |p: Point| {
            let p = rotated(p);
            [0, 1, 2].map(|i| p[i] + n * shift[i])
        };
        let difference: Vec<Point> =
            a.iter().flat_map(|p| b.iter().map(|q| minus(p.map(|c| n * c), of_b(*q)))).collect();
        let (numerator, denominator) = enumerated(&difference);
        let truth = (numerator, denominator * n * n);
        let q = Quaternion { w: w as f64, x: x as f64, y: y as f64, z: z as f64 };
        let found = exactly(&hull(&a), &hull(&b), &upright(0.0, 0.0, 0.0), &at(real(shift), q));
        assert_holds(found.bracket, truth, &format!("round {round}: {a:?} {b:?} {q:?} {shift:?}"));
        assert_eq!(found.termination, Termination::Exact);
        let along = (found.point_on_b - found.point_on_a) - found.normal * found.signed_distance;
        assert!(along.norm() < 1e-12 && (found.normal.norm() - 1.0).abs() < 1e-12);
        match numerator {
            0 => touching += 1,
            1.. => apart += 1,
            _ => deep += 1,
        }
        flat += usize::from(sizes.iter().sum::<usize>() < 5);
    }
    assert!(apart > 100 && touching > 20 && deep > 50 && flat > 50, "{apart} {touching} {deep} {flat}");
}

#[test]
fn witnesses_of_overlaps_are_on_the_boundary() {
    // One box over another by 1/4 in z.
    let cube = Shape::cuboid(Vec3::repeat(1.0)).unwrap();
    let found = exactly(&cube, &cube, &upright(0.0, 0.0, 0.0), &upright(0.25, 0.5, 1.75));
    assert_eq!(found.bracket, Bracket { lower: -0.25, upper: -0.25 });
    assert_eq!((found.normal, found.point_on_a.z, found.point_on_b.z), (Vec3::z(), 1.0, 0.75));
    assert!((found.point_on_a - Vec3::new(0.125, 0.25, 1.0)).amax() <= 1.0, "{:?}", found.point_on_a);
}

/// `place` puts B where the two touch exactly at step 0; one step is one unit in the last place of a coordinate.
fn verdict_flips_at_contact(a: &Shape, b: &Shape, place: impl Fn(f64) -> (Placement, Placement), contact: f64) {
    let mut x = contact;
    (0..20).for_each(|_| x = x.next_down());
    for _ in 0..40 {
        let (at_a, at_b) = place(x);
        for goal in [Goal::verdict(), Goal::penetration(), Goal { depth: Depth::Distance, ..Goal::penetration() }] {
            let found = narrow_phase::separation(a, b, &at_a, &at_b, &goal).unwrap();
            let swapped = narrow_phase::separation(b, a, &at_b, &at_a, &goal).unwrap();
            for Bracket { lower, upper } in [found.bracket, swapped.bracket] {
                if x > contact {
                    assert!(lower > 0.0, "{x:e} is beyond {contact:e}: [{lower:e}, {upper:e}]");
                } else {
                    assert!(upper <= 0.0, "{x:e} is not beyond {contact:e}: [{lower:e}, {upper:e}]");
                }
                if x == contact && goal.depth == Depth::Penetration {
                    assert!((lower, upper) == (0.0, 0.0), "[{lower:e}, {upper:e}]");
                }
            }
        }
        x = x.next_up();
    }
}

#[test]
fn boxes_part_at_the_last_bit() {
    let (a, b) = (Shape::cuboid(Vec3::new(0.3, 0.7, 0.1)).unwrap(), Shape::cuboid(Vec3::new(0.7, 0.2, 0.9)).unwrap());
    // 0.3 + 0.7 of the doubles is a double; in the frame of a, turned by a right angle of a crooked norm.
    assert_eq!(0.3 + 0.7, 1.0);
    let (span, sum) = (Span::of([0.3, 0.7]), [0.3, 0.7]);
    let exact = sum.iter().fold(IBig::ZERO, |s, x| s + integer(*x, span.lowest));
    let contact = super::integers::floor(&exact, span.lowest);
    let exceeds = integer(contact, span.lowest) < exact;
    assert!(!exceeds || contact < 1.0, "the sum of the doubles is {contact:e} and a little more");
    let turn = Quaternion { w: 0.1, x: 0.0, y: 0.0, z: 0.1 };
    verdict_flips_at_contact_or_below(&a, &b, |x| (upright(0.0, 0.0, 0.0), upright(x, 0.05, 0.1)), contact, exceeds);
    verdict_flips_at_contact_or_below(
        &a,
        &b,
        |x| (at(Vec3::zeros(), turn), at(Vec3::new(0.1, x, 0.0), turn)),
        contact,
        exceeds,
    );
}

/// As above where contact is between two doubles, of which `below` is the lower one.
fn verdict_flips_at_contact_or_below(
    a: &Shape,
    b: &Shape,
    place: impl Fn(f64) -> (Placement, Placement),
    below: f64,
    is_between: bool,
) {
    if is_between {
        for (x, collides) in [(below, true), (below.next_up(), false)] {
            let (at_a, at_b) = place(x);
            let found = narrow_phase::separation(a, b, &at_a, &at_b, &Goal::penetration()).unwrap();
            assert!(if collides { found.bracket.upper < 0.0 } else { found.bracket.lower > 0.0 }, "{x:e} {found:?}");
        }
    } else {
        verdict_flips_at_contact(a, b, place, below);
    }
}

#[test]
fn balls_and_capsules_part_at_the_last_bit() {
    let ball = |r| Shape::sphere(r).unwrap();
    // 3, 4, 5: apart by 5 exactly.
    verdict_flips_at_contact(&ball(2.25), &ball(2.75), |y| (upright(0.0, 0.0, 1.0), upright(3.0, y, 1.0)), 4.0);
    verdict_flips_at_contact(
        &ball(0.5),
        &Shape::cuboid(Vec3::repeat(1.0)).unwrap(),
        |x| (upright(x, 0.3, -0.2), upright(0.0, 0.0, 0.0)),
        1.5,
    );
    let capsule = Shape::capsule(0.25, 1.0).unwrap().swept(0.125).unwrap();
    verdict_flips_at_contact(&capsule, &ball(0.625), |x| (upright(0.0, 0.0, 0.0), upright(x, 0.0, 0.7)), 1.0);
    // An ellipsoid that is a ball.
    let round = Shape::ellipsoid(Vec3::repeat(0.625)).unwrap();
    verdict_flips_at_contact(&capsule, &round, |x| (upright(0.0, 0.0, 0.0), upright(x, 0.0, 0.7)), 1.0);
}

#[test]
fn turned_hulls_part_at_the_last_bit() {
    // The quaternion (1, 2, 2, 4) turns by a matrix of fractions over 25.
    let turn = Quaternion { w: 1.0, x: 2.0, y: 2.0, z: 4.0 };
    let octahedron = hull(&[[25, 0, 0], [-25, 0, 0], [0, 25, 0], [0, -25, 0], [0, 0, 25], [0, 0, -25]]);
    // Its corners land on integers: (-15, 20, 0) is one of them, the farthest along y.
    let rows = at(Vec3::zeros(), turn).rotation * 25.0;
    let farthest = (0..3).map(|j| rows[(1, j)].abs()).fold(0.0, f64::max).round();
    let slab = Shape::cuboid(Vec3::new(100.0, 1.0, 100.0)).unwrap();
    verdict_flips_at_contact(&octahedron, &slab, |y| (at(Vec3::zeros(), turn), upright(0.0, y, 0.0)), farthest + 1.0);
}

#[test]
fn parts_of_compounds_are_placed_without_rounding() {
    let turn = Quaternion { w: 0.1, x: 0.1, y: 0.1, z: 0.1 }; // a third of a turn
    let pose = Pose::new(Vec3::new(0.0, 0.0, 2.0), turn).unwrap();
    let cube = Shape::cuboid(Vec3::repeat(0.5)).unwrap();
    let part = Part { shape: cube.swept(0.25).unwrap(), pose };
    let compound = Shape::compound(Arc::new(Compound::new(vec![part]).unwrap())).swept(0.125).unwrap();
    // The part's centre is 2 along the compound's z, which is turned onto x.
    verdict_flips_at_contact(
        &compound,
        &Shape::sphere(0.125).unwrap(),
        |x| (at(Vec3::zeros(), turn), upright(x, 0.2, 0.1)),
        3.0,
    );
}

#[test]
fn walls_part_at_the_last_bit() {
    let cube = Shape::cuboid(Vec3::repeat(0.5)).unwrap();
    // |(2, 1, 2)| = 3; the corner of the cube that is lowest is at 2x - 2.5 in units of the normal.
    let wall = |offset| Shape::half_space(Vec3::new(2.0, 1.0, 2.0), offset).unwrap();
    let plane = |offset| Shape::plane(Vec3::new(2.0, 1.0, 2.0), offset).unwrap();
    verdict_flips_at_contact(&cube, &wall(-0.5), |x| (upright(x, 0.0, 0.0), upright(0.0, 0.0, 0.0)), 1.0);
    verdict_flips_at_contact(&cube, &plane(-0.5), |x| (upright(x, 0.0, 0.0), upright(0.0, 0.0, 0.0)), 1.0);
    let ball = Shape::sphere(2.0).unwrap();
    verdict_flips_at_contact(&ball, &wall(-4.0), |x| (upright(x, 0.0, 0.0), upright(0.0, 0.0, 0.0)), 1.0);
    // Far away along the wall.
    let far = 1e8;
    verdict_flips_at_contact(&ball, &wall(-6.0), |x| (upright(x, far, -1.5 * far), upright(0.0, 0.0, 0.0)), far);
}

#[test]
fn hostile_numbers_are_refused_quickly_or_answered_exactly() {
    let cube = Shape::cuboid(Vec3::new(1e-300, 1.0, 1e150)).unwrap();
    let crooked = Quaternion { w: 1.0, x: 1e-300, y: 0.0, z: 0.0 };
    let touching = upright(2e-300, 0.0, 0.0);
    let exact = exactly(&cube, &cube, &upright(0.0, 0.0, 0.0), &touching);
    assert_eq!(exact.bracket, Bracket { lower: 0.0, upper: 0.0 });
    let found = narrow_phase::separation(
        &cube,
        &cube,
        &upright(0.0, 0.0, 0.0),
        &at(Vec3::zeros(), crooked),
        &Goal::penetration(),
    );
    assert!(found.unwrap().bracket.lower <= 0.0);
}
