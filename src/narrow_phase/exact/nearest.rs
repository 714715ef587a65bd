//! The point of a Minkowski difference nearest the origin, exactly: the Gilbert-Johnson-Keerthi algorithm on integers.
//!
//! Nothing is rounded, so each round comes strictly nearer, a simplex never repeats, and the end is proved: no corner is lower
//! in the direction of the nearest point than that point itself.

use dashu_int::IBig;

use super::pair::{Corner, Pair};
use super::root::{Root, compare};
use super::vector::Vector;

/// What the origin is to the difference.
pub(super) enum Nearest {
    /// Outside: the nearest feature.
    Outside(Feature),
    /// In it, possibly on its boundary: corners whose hull holds the origin.
    Inside(Vec<Corner>),
}

/// One to three corners, all needed to mix the point of their hull nearest the origin.
pub(super) struct Feature {
    pub corners: Vec<Corner>,
    /// Positive; the nearest point is `sum(weight * corner) / sum(weight)`.
    pub weights: Vec<IBig>,
    /// From the origin towards the nearest point, of any length; zero when the origin is on the feature.
    pub direction: Vector,
}

/// Rounds at most: convergence is finite but has no small bound. Hulls of a thousand corners take some twenty.
const MAX_ROUNDS: u32 = 200;

/// None when the rounds ran out or `stop` said so. `toward`: a guess of the direction from the origin to the difference.
pub(super) fn nearest(pair: &mut Pair, toward: &Vector, stop: &dyn Fn() -> bool) -> Option<Nearest> {
    let mut feature = Feature::corner(pair.lowest(toward));
    for _ in 0..MAX_ROUNDS {
        if feature.direction.is_zero() {
            return Some(Nearest::Inside(feature.corners));
        }
        if stop() {
            return None;
        }
        let lowest = pair.lowest(&feature.direction);
        let here = feature.direction.dot(&feature.corners[0].w);
        if feature.direction.dot(&lowest.w) >= here {
            return Some(Nearest::Outside(feature));
        }
        feature = match reduced(feature.corners, lowest) {
            Ok(feature) => feature,
            Err(enclosing) => return Some(Nearest::Inside(enclosing)),
        };
    }
    None
}

/// The nearest feature of some corners and a new one that is strictly lower; the four corners when they enclose the origin.
fn reduced(corners: Vec<Corner>, new: Corner) -> Result<Feature, Vec<Corner>> {
    match corners.as_slice() {
        [a] => Ok(segment(a, &new)),
        [a, b] => Ok(triangle(a, b, &new)),
        [a, b, c] => tetrahedron(a, b, c, &new).ok_or_else(|| vec![a.clone(), b.clone(), c.clone(), new.clone()]),
        _ => Err(corners), // A feature has one to three corners.
    }
}

impl Feature {
    fn corner(corner: Corner) -> Self {
        let direction = corner.w.clone();
        Self { corners: vec![corner], weights: vec![IBig::ONE], direction }
    }

    /// Distance of the feature from the origin, in integer lengths.
    pub fn distance(&self) -> Root {
        let (numerator, denominator) = match self.corners.as_slice() {
            [a] => (a.w.square(), IBig::ONE),
            [a, b] => (a.w.cross(&b.w).square(), b.w.minus(&a.w).square()),
            // The direction is the normal.
            [a, ..] => {
                let height = self.direction.dot(&a.w);
                (&height * &height, self.direction.square())
            }
            [] => (IBig::ZERO, IBig::ONE),
        };
        Root { negative: false, numerator, denominator, exponent: 0 }
    }
}

/// Weights, not negative, that mix the origin from corners whose hull holds it.
pub(super) fn weights_of_origin(corners: &[Corner]) -> Vec<IBig> {
    match corners {
        [a, b] => segment(a, b).weights,
        [a, b, c] => triangle(a, b, c).weights,
        [a, b, c, d] => {
            let volume = |p: &Corner, q: &Corner, r: &Corner| p.w.dot(&q.w.cross(&r.w));
            let volumes = [volume(b, c, d), -volume(a, c, d), volume(a, b, d), -volume(a, b, c)];
            volumes.into_iter().map(|v| if v < IBig::ZERO { -v } else { v }).collect()
        }
        _ => vec![IBig::ONE; corners.len()],
    }
}

fn segment(a: &Corner, b: &Corner) -> Feature {
    let along = b.w.minus(&a.w);
    // How far the foot of the origin is from either end.
    let (from_a, from_b) = (-a.w.dot(&along), b.w.dot(&along));
    if from_a <= IBig::ZERO {
        return Feature::corner(a.clone());
    }
    if from_b <= IBig::ZERO {
        return Feature::corner(b.clone());
    }
    let direction = a.w.times(&from_b).plus(&b.w.times(&from_a));
    Feature { corners: vec![a.clone(), b.clone()], weights: vec![from_b, from_a], direction }
}

fn triangle(a: &Corner, b: &Corner, c: &Corner) -> Feature {
    let normal = b.w.minus(&a.w).cross(&c.w.minus(&a.w));
    // Areas between the edges and the foot of the origin.
    let weights = [(b, c), (c, a), (a, b)].map(|(p, q)| normal.dot(&p.w.cross(&q.w)));
    if weights.iter().all(|w| *w > IBig::ZERO) {
        let direction = match normal.dot(&a.w) {
            height if height.is_zero() => Vector::zero(),
            height if height < IBig::ZERO => normal.negated(),
            _ => normal,
        };
        return Feature { corners: vec![a.clone(), b.clone(), c.clone()], weights: weights.into(), direction };
    }
    nearer(segment(a, b), nearer(segment(b, c), segment(c, a)))
}

/// None when the origin is strictly inside. The tetrahedron has volume: the last corner is off the plane of the others.
fn tetrahedron(a: &Corner, b: &Corner, c: &Corner, d: &Corner) -> Option<Feature> {
    let mut best: Option<Feature> = None;
    for (p, q, r, opposite) in [(a, b, c, d), (a, b, d, c), (a, c, d, b), (b, c, d, a)] {
        let normal = q.w.minus(&p.w).cross(&r.w.minus(&p.w));
        let origin = -normal.dot(&p.w);
        let inner = normal.dot(&opposite.w.minus(&p.w));
        // The origin is in the plane of the face, or on the other side of it than the fourth corner.
        if origin.is_zero() || (origin > IBig::ZERO) != (inner > IBig::ZERO) {
            let feature = triangle(p, q, r);
            best = Some(match best {
                Some(found) => nearer(found, feature),
                None => feature,
            });
        }
    }
    best
}

fn nearer(one: Feature, other: Feature) -> Feature {
    if compare(&other.distance(), &one.distance()).is_lt() { other } else { one }
}
