//! Turned boxes and polytopes by themselves: does a bound hold its volume, a union both, and does no test of bounds leave
//! out what meets? References: points of the boxes, exact integers, and a search for a common point or a direction
//! between.

use super::Random;
use crate::broad_phase::kdop::DopBound;
use crate::broad_phase::obb::ObbBound;
use crate::broad_phase::{BoundingVolume, Dop18, Dop26, KDop, LANES};
use crate::geometry::{Mat3, OrientedBox, Vec3};

pub(super) fn corners(of: &OrientedBox) -> [Vec3; 8] {
    let sign = |i: usize, bit: usize| if i >> bit & 1 == 0 { -1.0 } else { 1.0 };
    std::array::from_fn(|i| {
        let x = Vec3::new(sign(i, 0), sign(i, 1), sign(i, 2));
        of.center + of.axes * of.half_extents.component_mul(&x)
    })
}

/// A volume that can be put around a box, and whose bound tells of points whether it holds them.
trait Tested: BoundingVolume {
    fn around(of: &OrientedBox) -> Self;
    fn inside(bound: &Self::Bound, p: Vec3) -> bool;
}

impl Tested for OrientedBox {
    fn around(of: &OrientedBox) -> Self {
        *of
    }

    fn inside(bound: &ObbBound, p: Vec3) -> bool {
        let vector = |x: [f32; 3]| Vec3::from(x.map(f64::from));
        let axes = Mat3::from_columns(&bound.axes.map(vector));
        let x = axes.try_inverse().unwrap() * (p - vector(bound.center));
        (0..3).all(|i| x[i].abs() <= f64::from(bound.half_extents[i]))
    }
}

impl<const PAIRS: usize> Tested for KDop<PAIRS> {
    fn around(of: &OrientedBox) -> Self {
        KDop::around(corners(of))
    }

    fn inside(bound: &DopBound<PAIRS>, p: Vec3) -> bool {
        let point = Self::around([p]);
        let low = (0..PAIRS).all(|i| f64::from(bound.low[i]) <= point.min[i]);
        low && (0..PAIRS).all(|i| point.max[i] <= -f64::from(bound.high[i]))
    }
}

/// Sizes and distances from the origin that differ by orders of magnitude, beyond single precision too.
fn some_box(random: &mut Random, scale: f64) -> OrientedBox {
    let far = [0.0, 0.0, 100.0, 1e5][random.below(4)];
    let center = (random.vector(4.0) + Vec3::repeat(far)) * scale;
    random.turned(center, scale)
}

fn bounds_and_unions_hold<V: Tested>() {
    let mut random = Random(31);
    let (mut strict, mut all) = (0, 0);
    for round in 0..3000 {
        let scale = [1.0, 1e-3, 1e4, 1e-42, 1e33, 1e38][round % 6];
        let boxes: Vec<OrientedBox> = (0..1 + random.below(9)).map(|_| some_box(&mut random, scale)).collect();
        let bounds: Vec<V::Bound> = boxes.iter().map(|of| V::around(of).bound()).collect();
        let mut joined = bounds[0];
        let mut steps = vec![joined];
        for bound in &bounds[1..] {
            joined = V::union(&joined, bound);
            steps.push(joined);
        }
        for (i, (of, bound)) in boxes.iter().zip(&bounds).enumerate() {
            assert!(corners(of).iter().all(|p| V::inside(bound, *p)), "{of:?} is not within {bound:?}");
            for outer in &steps[i..] {
                assert!(corners(of).iter().all(|p| V::inside(outer, *p)), "{of:?} is not within {outer:?}");
                assert!(V::holds(outer, bound), "{outer:?} is not known to hold {bound:?}");
                assert!(V::cost(outer) >= V::cost(bound) * 0.999 && V::cost(outer).is_finite());
            }
            assert!(V::centre(bound).iter().all(|x| x.is_finite()));
            all += 1;
            strict += usize::from(bounds.len() > 1 && !V::holds(bound, &joined));
        }
    }
    assert!(strict > all / 2, "holding means nothing: {strict} of {all}");
}

#[test]
fn bounds_hold_their_volumes_and_unions_hold_both() {
    bounds_and_unions_hold::<OrientedBox>();
    bounds_and_unions_hold::<Dop18>();
    bounds_and_unions_hold::<Dop26>();
}

/// Eight lanes, some of them empty, asked by a volume and by a bound of several.
fn no_meeting_is_missed<V: Tested>(nearly_parallel: bool) {
    let mut random = Random(37);
    let (mut met, mut surely, mut sure_by_bound, mut ruled_out, mut empty) = (0, 0, 0, 0, 0);
    for round in 0..4000 {
        let scale = [1.0, 1e-3, 1e-42, 1e33, 1e38][round % 5];
        let frame = random.frame();
        let mut some = || {
            let mut of = random.turned(Vec3::zeros(), scale);
            of.center = random.vector(2.5) * scale;
            if nearly_parallel {
                // Half a turn of the last digits of single and double precision, and centres in one plane.
                let skew = [0.0, 1e-15, 1e-8, 1e-6][random.below(4)];
                let (first, second) = (frame.column(0), frame.column(1));
                let first = (first + second * skew).normalize();
                let second = (second - first * first.dot(&second)).normalize();
                of.axes = Mat3::from_columns(&[first, second, first.cross(&second)]);
                of.half_extents = Vec3::repeat(0.5 * scale);
                of.center = frame * Vec3::new(random.below(3) as f64, random.next(), random.next()) * scale;
            }
            V::around(&of)
        };
        let volumes: [V; LANES] = std::array::from_fn(|_| some());
        let asked: [V; 4] = std::array::from_fn(|_| some());
        let mut lanes = V::no_lanes();
        let held = random.below(256) as u8;
        for lane in 0..LANES {
            V::put(&mut lanes, lane, &volumes[lane].bound());
            assert_eq!(V::get(&lanes, lane), volumes[lane].bound());
        }
        (0..LANES).filter(|lane| held >> lane & 1 == 0).for_each(|lane| V::clear(&mut lanes, lane));
        let union = asked[1..].iter().fold(asked[0].bound(), |all, next| V::union(&all, &next.bound()));
        let by_union = V::meeting(&lanes, &V::probe_of(&union)).maybe;
        assert_eq!(by_union & !held, 0);
        for query in &asked {
            let meeting = V::meeting(&lanes, &query.probe());
            let by_bound = V::meeting(&lanes, &V::probe_of(&query.bound()));
            for meeting in [&meeting, &by_bound] {
                assert_eq!((meeting.maybe & !held, meeting.surely & !meeting.maybe), (0, 0));
            }
            for lane in 0..LANES {
                if held >> lane & 1 == 0 {
                    empty += 1;
                    continue;
                }
                let overlap = volumes[lane].overlaps(query);
                assert_eq!(overlap, query.overlaps(&volumes[lane]), "the order matters");
                let [maybe, sure, by_union] =
                    [meeting.maybe, meeting.surely, by_union].map(|mask| mask >> lane & 1 != 0);
                assert!(!overlap || (maybe && by_union), "{query:?} and {:?}", volumes[lane]);
                assert!(!sure || overlap);
                assert!(by_bound.surely >> lane & 1 == 0 || overlap, "{query:?} and {:?}", volumes[lane]);
                assert!(!overlap || by_bound.maybe >> lane & 1 != 0);
                sure_by_bound += usize::from(by_bound.surely >> lane & 1 != 0);
                met += usize::from(overlap);
                surely += usize::from(sure);
                ruled_out += usize::from(!maybe);
            }
        }
    }
    for (regime, count) in [("met", met), ("ruled out", ruled_out), ("empty lane", empty)] {
        assert!(count > 1000, "{regime}: only {count}");
    }
    // Turned boxes are never sure, polytopes nearly always.
    let by_intervals = size_of::<V>() != size_of::<OrientedBox>();
    assert_eq!((surely > 0, sure_by_bound > 0), (by_intervals, by_intervals), "{surely}, {sure_by_bound}");
}

#[test]
fn lanes_never_leave_out_what_meets() {
    for nearly_parallel in [false, true] {
        no_meeting_is_missed::<OrientedBox>(nearly_parallel);
        no_meeting_is_missed::<Dop18>(nearly_parallel);
        no_meeting_is_missed::<Dop26>(nearly_parallel);
    }
}

fn nearest(of: &OrientedBox, p: Vec3) -> Vec3 {
    let x = of.axes.tr_mul(&(p - of.center));
    of.center + of.axes * x.sup(&-of.half_extents).inf(&of.half_extents)
}

/// The gap along a direction, negative if there is none.
fn gap(a: &OrientedBox, b: &OrientedBox, along: Vec3) -> f64 {
    let reach = |of: &OrientedBox| of.axes.tr_mul(&along).abs().dot(&of.half_extents);
    (along.dot(&(b.center - a.center)).abs() - reach(a) - reach(b)) / along.norm()
}

/// Alternating projections find either a common point or, in the limit, the direction between.
#[test]
fn turned_boxes_meet_exactly_if_they_have_a_point_in_common() {
    let mut random = Random(41);
    let (mut shared, mut apart, mut by_edges, mut undecided) = (0, 0, 0, 0);
    for _ in 0..20_000 {
        let center = random.vector(1.2);
        let [a, b] = [random.turned(Vec3::zeros(), 1.5), random.turned(center, 1.5)];
        let (mut p, mut q) = (a.center, b.center);
        for _ in 0..200 {
            p = nearest(&a, q);
            q = nearest(&b, p);
        }
        let meet = a.overlaps(&b);
        let mut lanes = OrientedBox::no_lanes();
        OrientedBox::put(&mut lanes, 3, &a.bound());
        let maybe = OrientedBox::meeting(&lanes, &b.probe()).maybe != 0;
        if (p - q).norm() < 1e-14 {
            assert!(meet && maybe, "{a:?} and {b:?} share {p}");
            shared += 1;
        } else if gap(&a, &b, p - q) > 1e-9 {
            assert!(!meet, "between {a:?} and {b:?} is {}", p - q);
            // Not lost in slack: a gap of a hundredth shows in single precision.
            assert!(!maybe || gap(&a, &b, p - q) < 0.01, "{a:?} and {b:?}");
            let faces = a.axes.column_iter().chain(b.axes.column_iter());
            by_edges += usize::from(faces.map(|face| gap(&a, &b, face.into_owned())).fold(-1.0, f64::max) < 0.0);
            apart += 1;
        } else {
            undecided += 1;
        }
    }
    let counts = format!("{shared} share a point, {apart} apart, {by_edges} by edges alone, {undecided} undecided");
    assert!(shared > 1000 && apart > 5000 && by_edges > 100 && undecided < 1000, "{counts}");
}

#[test]
fn closed_boxes_that_touch_meet() {
    let at = |center: Vec3, axes: Mat3| OrientedBox { center, axes, half_extents: Vec3::repeat(1.0) };
    let still = at(Vec3::zeros(), Mat3::identity());
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let eighth = Mat3::new(half, -half, 0.0, half, half, 0.0, 0.0, 0.0, 1.0);
    for (name, axes, reach) in [("face", Mat3::identity(), 1.0), ("edge", eighth, 2.0 * half)] {
        for (beyond, meets) in [(0.0, true), (1e-9, false), (-1e-9, true)] {
            let other = at(Vec3::new(1.0 + reach + beyond, 0.3, 0.2), axes);
            assert_eq!(still.overlaps(&other), meets, "{name} by {beyond}");
        }
    }
}

/// Truth by integers: coordinates are whole multiples of 2^-60, so that their sums and differences are, too.
#[test]
fn intervals_along_diagonals_hold_their_points_exactly() {
    const UNIT: f64 = (1_u64 << 60) as f64;
    let mut random = Random(43);
    let (mut inexact, mut cancelled) = (0, 0);
    for _ in 0..20_000 {
        let mut coordinate = || {
            let steps = ((random.next() - 0.5) * (1_u64 << 53) as f64).round();
            steps * libm::ldexp(1.0, -40 + random.below(40) as i32)
        };
        let p = Vec3::new(coordinate(), coordinate(), coordinate());
        let p = if random.below(4) == 0 { Vec3::new(p.x, -p.x * (1.0 + f64::EPSILON), p.x / 4.0) } else { p };
        let whole = |x: f64| (x * UNIT).floor() as i128;
        let [x, y, z] = [p.x, p.y, p.z].map(whole);
        let exact = [x, y, z, y + z, y - z, x + z, z - x, x + y, x - y, x + y + z, x + y - z, x - y + z, y + z - x];
        let dop = Dop26::around([p]);
        for (pair, exact) in exact.iter().enumerate() {
            assert!(whole(dop.min[pair]) <= *exact && -whole(-dop.max[pair]) >= *exact, "{p:?} along {pair}");
            inexact += usize::from((*exact as f64) as i128 != *exact);
            cancelled += usize::from(exact.abs() < (x.abs() + y.abs()) >> 40);
        }
    }
    assert!(inexact > 1000 && cancelled > 1000, "{inexact} {cancelled}");
}
