//! What is the true distance of a pair? A bracket that should be a thousand times narrower than what is held against it.
//!
//! Of polytopes and what is swept over them, exact arithmetic gives it with ends next to each other. Of ellipsoids, with or
//! without a ball, both ends are worked out here with twice the digits, from the best direction that doubles find: below by
//! the support values along it, above by the two points it leads to. Of anything else it is the narrowest bracket of
//! doubles, and `by` says so.

use crate::geometry::{Core, Mat3, Placement, Quaternion, Shape, Vec3};
use crate::narrow_phase::{Accuracy, Bracket, Goal, Solver, Termination, separation};

use super::double_double::{Double2, Vector, difference, dot, length, product, scaled, sum};
use super::families::Pair;

/// What is known of the true signed distance.
#[derive(Clone, Copy, Debug)]
pub(super) struct Truth {
    /// Its middle, metres.
    pub value: f64,
    /// Proved around it, rounded to doubles.
    pub bracket: Bracket,
    /// Half the width before rounding to doubles.
    pub half_width: f64,
    /// Who said so.
    pub by: &'static str,
}

/// A truth has to be so many times narrower than the tolerance that is held against it.
pub(super) const TIGHTER: f64 = 1000.0;

impl Truth {
    pub fn of(pair: &Pair) -> Option<Self> {
        let Pair { a, b, at_a, at_b, .. } = pair;
        if Solver::Exact.claims(a, b).is_ok() {
            let goal = Goal { solver: Solver::Exact, ..tightest() };
            let found = separation(a, b, at_a, at_b, &goal).ok()?;
            if found.termination == Termination::Exact {
                return Some(Self::between(found.bracket, "exact"));
            }
        }
        let found = separation(a, b, at_a, at_b, &tightest()).ok()?;
        if found.bracket.lower > 0.0
            && let Some((below, above)) = of_round(pair, found.normal.into())
        {
            let half_width = 0.5 * (above - below).high.max(0.0);
            let bracket = Bracket { lower: below.high.next_down(), upper: above.high.next_up() };
            return Some(Self { value: below.high, bracket, half_width, by: "double-double" });
        }
        Some(Self::between(found.bracket, "doubles"))
    }

    fn between(bracket: Bracket, by: &'static str) -> Self {
        let half_width = 0.5 * bracket.width();
        Self { value: bracket.lower + half_width, bracket, half_width, by }
    }

    /// Whether it is narrow enough to judge brackets of that width. Numbers that are nearer than doubles lie count as equal.
    pub fn judges(&self, width: f64) -> bool {
        2.0 * TIGHTER * self.half_width <= width
    }

    /// How far off an estimate is at most, as far as doubles tell.
    pub fn error_of(&self, estimate: f64) -> f64 {
        (estimate - self.value).abs()
    }

    /// Whether a bracket surely does not hold the truth.
    pub fn is_outside(&self, bracket: &Bracket) -> bool {
        bracket.lower > self.bracket.upper || bracket.upper < self.bracket.lower
    }
}

/// As narrow as rounding lets it be.
fn tightest() -> Goal<'static> {
    Goal { accuracy: Accuracy { absolute: 0.0, relative: 0.0 }, ..Goal::penetration() }
}

/// Semi-axes of an ellipsoid, and the radius swept over it. A ball is a point that is swept.
fn round(shape: &Shape) -> Option<([f64; 3], f64)> {
    match shape.core() {
        Core::Point => Some(([0.0; 3], shape.swept_radius())),
        Core::Ellipsoid { radii } => Some(((*radii).into(), shape.swept_radius())),
        Core::Cuboid { .. }
        | Core::AxialSegment { .. }
        | Core::Cylinder { .. }
        | Core::Cone { .. }
        | Core::Convex(_)
        | Core::Triangle(_)
        | Core::Segment(_)
        | Core::HalfSpace { .. }
        | Core::Plane { .. }
        | Core::Mesh(_)
        | Core::Compound(_)
        | Core::HeightField(_)
        | Core::PointCloud(_)
        | Core::Voxels(_)
        | Core::Column(_)
        | Core::Block(_) => None,
    }
}

/// A point of a turned ellipsoid that is farthest along a unit direction.
fn farthest(radii: [f64; 3], rotation: [Vector; 3], direction: Vector) -> Vector {
    let radii = radii.map(Double2::of);
    // Rows of the rotation times the direction would turn it; columns turn it back.
    let own = std::array::from_fn(|k| dot([rotation[0][k], rotation[1][k], rotation[2][k]], direction));
    let stretched = product(radii, own);
    let size = length(stretched);
    if size.high <= 0.0 {
        return Vector::default();
    }
    let point = scaled(product(radii, stretched), Double2::of(1.0).over(size));
    rotation.map(|row| dot(row, point))
}

/// R(q/|q|) by rows.
fn matrix(q: Quaternion) -> [Vector; 3] {
    let [w, x, y, z] = [q.w, q.x, q.y, q.z].map(Double2::of);
    let s = Double2::of(2.0).over(w * w + x * x + y * y + z * z);
    let one = Double2::of(1.0);
    [
        [one - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)],
        [s * (x * y + w * z), one - s * (x * x + z * z), s * (y * z - w * x)],
        [s * (x * z - w * y), s * (y * z + w * x), one - s * (x * x + y * y)],
    ]
}

/// Ends around the distance of two ellipsoids or balls that are apart, by a direction from A to B.
fn of_round(pair: &Pair, normal: [f64; 3]) -> Option<(Double2, Double2)> {
    let ((radii_a, swept_a), (radii_b, swept_b)) = (round(&pair.a)?, round(&pair.b)?);
    let turned = |at: &Placement| at.quaternion.map(matrix);
    let (turn_a, turn_b) = (turned(&pair.at_a)?, turned(&pair.at_b)?);
    let [from, to] = [&pair.at_a, &pair.at_b].map(|at| <[f64; 3]>::from(at.translation).map(Double2::of));
    let apart = difference(to, from);
    let mut normal: Vector = normal.map(Double2::of);
    let mut best: Option<(Double2, Double2)> = None;
    // Newton's method on the direction: its rest with twice the digits, its step in doubles. The best ends are kept.
    for _ in 0..5 {
        normal = scaled(normal, Double2::of(1.0).over(length(normal)));
        let on_a = farthest(radii_a, turn_a, normal);
        let on_b = farthest(radii_b, turn_b, scaled(normal, Double2::of(-1.0)));
        let between = difference(sum(apart, on_b), on_a);
        let (below, above) = (dot(normal, between), length(between));
        best = Some(best.map_or((below, above), |(low, high)| {
            (if below.high > low.high { below } else { low }, if above.high < high.high { above } else { high })
        }));
        let step = step(pair, [radii_a, radii_b], normal, between);
        normal = sum(normal, step.map(Double2::of));
    }
    // What rounding may have done, with much to spare: sums of a few dozen terms no larger than the extent.
    let slack = Double2::of(1e-28 * pair.extent);
    let radii = Double2::of(swept_a) + Double2::of(swept_b);
    best.map(|(below, above)| (below - radii - slack, above - radii + slack))
}

/// Where the lower end is greatest, the two points are one above the other: the step toward it from a unit direction. The
/// derivative of what is beside the direction is minus the curvatures of both bodies and the distance.
fn step(pair: &Pair, radii: [[f64; 3]; 2], normal: Vector, between: Vector) -> [f64; 3] {
    let along = dot(normal, between);
    let beside = difference(between, scaled(normal, along));
    let [n, beside] = [normal, beside].map(|v| Vec3::from(v.map(|x| x.high)));
    let mut slope = Mat3::identity() * along.high;
    for (radii, at) in radii.into_iter().zip([&pair.at_a, &pair.at_b]) {
        let squares = Mat3::from_diagonal(&Vec3::from(radii.map(|r| r * r)));
        let form = at.rotation * squares * at.rotation.transpose();
        let point = form * n;
        let height = n.dot(&point).sqrt();
        if height > 0.0 {
            slope += (form - point * point.transpose() / (height * height)) / height;
        }
    }
    slope.try_inverse().map_or([0.0; 3], |inverse| (inverse * beside).into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::families::{Family, placed};
    use crate::study::random::Random;

    #[test]
    fn ends_around_ellipsoids_hold_the_bracket_of_doubles_and_are_far_narrower() {
        let mut random = Random(5);
        let mut checked = 0;
        for gap in [1.0, 1e-2, 1e-3] {
            for pair in Family::Ellipsoid.pairs(gap, 10, &mut random) {
                let truth = Truth::of(&pair).unwrap();
                let found = separation(&pair.a, &pair.b, &pair.at_a, &pair.at_b, &tightest()).unwrap();
                assert_eq!(truth.by, "double-double");
                assert!(!truth.is_outside(&found.bracket), "{truth:?} {:?}", found.bracket);
                assert!(truth.judges(1e-12 * gap) && truth.half_width >= 0.0, "{truth:?}");
                checked += 1;
            }
        }
        assert_eq!(checked, 30);
    }

    #[test]
    fn spheroids_on_a_common_axis_are_as_far_apart_as_subtraction_says() {
        let at = |x: f64| placed(Vec3::new(x, 0.0, 0.0), Quaternion::IDENTITY).unwrap();
        let shape = |x: f64| Shape::ellipsoid(Vec3::new(x, 0.25, 0.25)).unwrap();
        let pair = Pair { a: shape(0.5), b: shape(0.25), at_a: at(0.0), at_b: at(1.0), before: at(1.0), extent: 2.0 };
        let truth = Truth::of(&pair).unwrap();
        assert!((truth.value - 0.25).abs() <= f64::EPSILON && truth.half_width < 1e-20, "{truth:?}");
    }
}
