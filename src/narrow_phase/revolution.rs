//! The depth of two bodies of revolution about parallel axes: a problem in the plane of a meridian.
//!
//! Bodies of revolution about one axis have a whole circle of deepest directions, or nearly so, and no polytope of EPA's size
//! comes close to a circle everywhere. But their difference is known: with axes along z, B shifted by t, and a direction n
//! at angle theta from the axis,
//!
//!   `max over C of n . c = h_A(theta) + h_B(pi - theta) - t . n`,
//!
//! and for given theta the least of that over all meridians is h_A + h_B - |t_xy| sin(theta) - t_z cos(theta). What is left is the
//! least value over theta, found between the points of a polygon in the half-plane that grows where it is nearest. Axes that are
//! off by an angle cost at most that angle times the smaller body's radius. Derived in `docs/derivations/escalation.md`.

use arrayvec::ArrayVec;

use super::convex::Convex;
use super::goal::Goal;
use super::outcome::{Bracket, Separation, Termination};
use super::support::{radius, support};
use super::witness;
use crate::geometry::tolerance::{SUPPORT_ERROR_ULPS, UNIT_ROUNDOFF};
use crate::geometry::{Core, Placement, Vec3, length};

/// Sine of the largest angle between axes that are looked at.
const MOST_TILT: f64 = 1e-3;

/// Points of the polygon at most. Straight profiles need a handful, curved ones some 30.
const MOST_POINTS: usize = 96;

/// Extents beyond which products could leave the doubles; such pairs are left as they are.
const EXTENTS: std::ops::RangeInclusive<f64> = 1e-100..=1e100;

/// `found`, an overlap that met EPA's cap, with what the meridian says of it.
pub(super) fn narrowed(a: &Convex, b: &Convex, goal: &Goal, found: Separation) -> Separation {
    let (Some(profile_a), Some(profile_b)) = (Profile::of(a.core), Profile::of(b.core)) else { return found };
    let b_in_a = Placement::relative(a.at, b.at);
    let (radius_a, radius_b) = (radius(a.core), radius(b.core));
    let extent = radius_a + radius_b + length(b_in_a.translation);
    let axis = b_in_a.direction(Vec3::z());
    let tilt = libm::hypot(axis.x, axis.y);
    if tilt > MOST_TILT || !EXTENTS.contains(&extent) {
        return found;
    }
    // As seen along the axis of the larger body, so that it is the smaller one that is tilted. `up`: that axis in A's frame.
    let up = if radius_a >= radius_b { Vec3::z() } else { axis.normalize() * axis.z.signum() };
    let along = up.dot(&b_in_a.translation);
    let across = b_in_a.translation - up * along;
    let meridian = Meridian { a: profile_a, b: profile_b, flip: -axis.z.signum(), across: length(across), along };
    let error = SUPPORT_ERROR_ULPS * UNIT_ROUNDOFF * extent + a.placement_error + b.placement_error;
    let Some((least, [sin, cos])) = meridian.least(0.25 * error) else { return found };
    // The chord between the two directions is the sine of the angle to a millionth; the sine is off by as much as the place is.
    let depth_at_least = least - 1.001 * tilt * radius_a.min(radius_b) - 2.0 * error;

    let outward = if across == Vec3::zeros() { perpendicular(up) } else { across / length(across) };
    // Where the axes nearly meet, `across` is what rounding left over, and need not be perpendicular to the axis.
    let normal = (outward * sin + up * cos).normalize();
    let on_a = support(a.core, normal);
    let on_b = b_in_a.point(support(b.core, b_in_a.direction_into(-normal)));
    let depth = normal.dot(&(on_a - on_b));

    let radii = a.swept_radius + b.swept_radius;
    let slack = 4.0 * UNIT_ROUNDOFF * (extent + radii);
    let known = Bracket { lower: -depth - error - radii - slack, upper: -depth_at_least - radii + slack };
    let bracket = known.intersection(&found.bracket);
    let termination = if goal.is_met(&bracket) {
        Termination::Converged
    } else if bracket.width() <= 4.0 * (error + slack) {
        Termination::RoundingFloor
    } else {
        found.termination
    };
    if known.lower < found.bracket.lower {
        return Separation { termination, ..found.within(bracket) };
    }
    let signed_distance = (-depth - radii).clamp(bracket.lower, bracket.upper);
    let normal = a.at.direction(normal);
    let point_on_a = a.at.point(on_a) + normal * a.swept_radius;
    let point_on_b = point_on_a + normal * signed_distance;
    // The lowest points of the two bodies need not be opposite to one another.
    let beside = length(on_a - on_b - normal * depth);
    let point_error = beside + witness::rounding_of_points(a, b, signed_distance);
    Separation { bracket, signed_distance, normal, point_on_a, point_on_b, point_error, termination, ..found }
}

fn perpendicular(up: Vec3) -> Vec3 {
    let side = if up.x.abs() < 0.5 { Vec3::x() } else { Vec3::y() };
    side.cross(&up).normalize().cross(&up)
}

/// Half of a body's section through its axis: distances from the axis and along it.
#[derive(Clone, Copy)]
enum Profile {
    Point,
    Segment { half_length: f64 },
    Cylinder { radius: f64, half_length: f64 },
    Cone { radius: f64, half_length: f64 },
    Spheroid { radius: f64, half_length: f64 },
}

impl Profile {
    fn of(core: &Core) -> Option<Self> {
        match core {
            Core::Point => Some(Self::Point),
            Core::AxialSegment { half_length } => Some(Self::Segment { half_length: *half_length }),
            Core::Cylinder { radius, half_length } => {
                Some(Self::Cylinder { radius: *radius, half_length: *half_length })
            }
            Core::Cone { radius, half_length } => Some(Self::Cone { radius: *radius, half_length: *half_length }),
            Core::Ellipsoid { radii } if radii.x == radii.y => {
                Some(Self::Spheroid { radius: radii.x, half_length: radii.z })
            }
            Core::Ellipsoid { .. }
            | Core::Cuboid { .. }
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

    /// The point farthest in the direction `(sin, cos)`, sin >= 0.
    fn farthest(self, [sin, cos]: [f64; 2]) -> [f64; 2] {
        match self {
            Self::Point => [0.0, 0.0],
            Self::Segment { half_length } => [0.0, half_length.copysign(cos)],
            Self::Cylinder { radius, half_length } => [radius, half_length.copysign(cos)],
            Self::Cone { radius, half_length } => {
                let base_is_farther = radius * sin - half_length * cos > half_length * cos;
                if base_is_farther { [radius, -half_length] } else { [0.0, half_length] }
            }
            Self::Spheroid { radius, half_length } => {
                let (x, z) = (radius * sin, half_length * cos);
                let norm = libm::hypot(x, z);
                if norm > 0.0 { [radius * (x / norm), half_length * (z / norm)] } else { [0.0, 0.0] }
            }
        }
    }
}

/// The half-plane through the axis in which the difference is least thick.
struct Meridian {
    a: Profile,
    b: Profile,
    /// 1 where B's axis is opposite to A's, else -1: by it the profile of -B is that of B.
    flip: f64,
    /// How far B is off A's axis, and along it.
    across: f64,
    along: f64,
}

/// A part of the half circle of directions: its ends, and the farthest points in them.
#[derive(Clone, Copy)]
struct Arc {
    from: Support,
    to: Support,
    /// The direction between in which both points are equally far.
    middle: [f64; 2],
    /// And how far: in no direction of the arc is the difference thinner, unless it is at an end.
    bound: f64,
}

#[derive(Clone, Copy)]
struct Support {
    direction: [f64; 2],
    point: [f64; 2],
    height: f64,
}

fn dot(p: [f64; 2], q: [f64; 2]) -> f64 {
    p[0] * q[0] + p[1] * q[1]
}

impl Arc {
    /// The values at the ends are of a sinusoid each, that is concave where it is positive: between an end and the middle
    /// it is nowhere less than at both. None where it is not positive.
    fn new(from: Support, to: Support) -> Option<Self> {
        let edge = [to.point[0] - from.point[0], to.point[1] - from.point[1]];
        let norm = libm::hypot(edge[0], edge[1]);
        // From the axis downwards along the profile; its normal points outwards.
        let normal = [-edge[1] / norm, edge[0] / norm];
        let is_between = norm > 0.0 && normal[0] >= 0.0;
        let middle = if is_between { normal } else { from.direction };
        let bound = dot(from.point, middle).min(dot(to.point, middle));
        (bound > 0.0).then_some(Self { from, to, middle, bound })
    }
}

impl Meridian {
    fn support(&self, direction: [f64; 2]) -> Support {
        let a = self.a.farthest(direction);
        let b = self.b.farthest([direction[0], self.flip * direction[1]]);
        let point = [a[0] + b[0] - self.across, a[1] + self.flip * b[1] - self.along];
        Support { direction, point, height: dot(point, direction) }
    }

    /// A lower bound of the thickness over all directions, within `tolerance` of the least if the points suffice, and the best
    /// direction. None when the bodies' axes do not surely meet the other body: then there is no depth.
    fn least(&self, tolerance: f64) -> Option<(f64, [f64; 2])> {
        let ends = [[0.0, 1.0], [1.0, 0.0], [0.0, -1.0]].map(|direction| self.support(direction));
        let mut best = ends.into_iter().reduce(|p, q| if q.height < p.height { q } else { p })?;
        let mut arcs: ArrayVec<Arc, MOST_POINTS> = ArrayVec::new();
        arcs.push(Arc::new(ends[0], ends[1])?);
        arcs.push(Arc::new(ends[1], ends[2])?);
        loop {
            let nearest = (0..arcs.len()).min_by(|&i, &j| arcs[i].bound.total_cmp(&arcs[j].bound))?;
            let Arc { from, to, middle, bound } = arcs[nearest];
            if bound >= best.height - tolerance || arcs.is_full() {
                return (best.height > 0.0).then_some((bound.min(best.height), best.direction));
            }
            let new = self.support(middle);
            if new.height < best.height {
                best = new;
            }
            arcs[nearest] = Arc::new(from, new)?;
            arcs.push(Arc::new(new, to)?);
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::geometry::{Placement, Pose, Quaternion, Shape, Vec3};
    use crate::narrow_phase::{Goal, Separation, separation};

    fn at(translation: Vec3, rotation: Quaternion) -> Placement {
        Pose::new(translation, rotation).unwrap().placement()
    }

    const CROOKED: Quaternion = Quaternion { w: 0.3, x: -0.8, y: 0.1, z: 0.55 };

    /// Both turned alike, B shifted in the turned frame; the bracket is narrow and holds the depth.
    fn assert_depth(a: &Shape, b: &Shape, shift: Vec3, depth: f64) -> Separation {
        let at_a = at(Vec3::new(1.0, 2.0, -3.0), CROOKED);
        let at_b = at(at_a.point(shift), CROOKED);
        let found = separation(a, b, &at_a, &at_b, &Goal::penetration()).unwrap();
        let (lower, upper) = (found.bracket.lower, found.bracket.upper);
        // B's place rounds.
        assert!(lower - 2e-15 <= -depth && -depth <= upper + 2e-15, "[{lower}, {upper}] of {depth}");
        assert!(upper - lower <= 1e-9 * depth + 1e-12, "[{lower}, {upper}] for {shift:?}");
        let apart = found.point_on_b - found.point_on_a - found.normal * found.signed_distance;
        assert!(apart.norm() < 1e-14 && (found.normal.norm() - 1.0).abs() < 1e-14);
        found
    }

    #[test]
    fn cylinders_about_parallel_axes_are_as_deep_as_their_sum() {
        for across in [0.0_f64, 1e-13, 1e-9, 1e-5, 0.1] {
            for (half_length, along) in [(0.9_f64, 0.0_f64), (0.9, -0.3), (0.2, 0.1)] {
                let (a, b) = (Shape::cylinder(0.3, 0.7).unwrap(), Shape::cylinder(0.25, half_length).unwrap());
                let depth = f64::min(0.55 - across, 0.7 + half_length - f64::abs(along));
                assert_depth(&a, &b, Vec3::new(across, 0.0, along), depth);
            }
        }
    }

    #[test]
    fn balls_on_the_axis_of_a_cone_are_as_deep_as_wall_or_base() {
        for z in [-0.6, 0.0, 0.5] {
            let (cone, ball) = (Shape::cone(0.3, 0.7).unwrap(), Shape::sphere(0.125).unwrap());
            let wall = (0.7 - z) * 0.3 / f64::sqrt(0.3 * 0.3 + 1.4 * 1.4);
            assert_depth(&cone, &ball, Vec3::new(0.0, 0.0, z), wall.min(0.7 + z) + 0.125);
            assert_depth(&ball, &cone, Vec3::new(0.0, 0.0, -z), wall.min(0.7 + z) + 0.125);
        }
    }

    #[test]
    fn spheroids_about_one_axis_are_as_deep_as_their_waists() {
        let (a, b) = (Vec3::new(0.3, 0.3, 0.8), Vec3::new(0.2, 0.2, 0.5));
        let (a, b) = (Shape::ellipsoid(a).unwrap(), Shape::ellipsoid(b).unwrap());
        assert_depth(&a, &b, Vec3::zeros(), 0.5);
        let cylinder = Shape::cylinder(0.125, 0.9).unwrap();
        assert_depth(&a, &cylinder, Vec3::zeros(), 0.425);
        assert_depth(&cylinder, &a, Vec3::new(1e-9, 0.0, 0.0), 0.425 - 1e-9);
    }

    /// A support value in any direction bounds the depth from above.
    #[test]
    fn crooked_axes_stay_bracketed_and_narrow() {
        let (a, b) = (Shape::cylinder(0.3, 0.7).unwrap(), Shape::cone(0.5, 0.9).unwrap());
        for angle in [1e-9, 1e-12, 3e-10] {
            let turn = Quaternion::about_axis(Vec3::x(), angle);
            let (at_a, at_b) = (at(Vec3::zeros(), Quaternion::IDENTITY), at(Vec3::new(1e-9, 0.0, -0.2), turn));
            let found = separation(&a, &b, &at_a, &at_b, &Goal::penetration()).unwrap();
            assert!(found.bracket.width() < 1.2 * angle + 1e-12, "{:?}", found.bracket);
            let (mut least, axis_b) = (f64::INFINITY, at_b.direction(Vec3::z()));
            for i in 0..20_000 {
                let (phi, height) = (0.01 * f64::from(i), libm::sin(0.37 * f64::from(i)));
                let around = f64::sqrt(1.0 - height * height);
                let n = Vec3::new(around * libm::cos(phi), around * libm::sin(phi), height);
                let of_a = 0.3 * around + 0.7 * height.abs();
                let of_axis = -n.dot(&axis_b);
                let of_b = (0.9 * of_axis).max(0.5 * f64::sqrt(1.0 - of_axis * of_axis) - 0.9 * of_axis);
                least = least.min(of_a + of_b - n.dot(&at_b.translation));
            }
            assert!(-found.bracket.upper <= least + 1e-14, "{:?} against {least}", found.bracket);
        }
    }
}
