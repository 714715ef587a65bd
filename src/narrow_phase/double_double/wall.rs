//! A convex body against a half-space or a plane: its support values in double-doubles.

use super::frames::Frames;
use super::number::{DoubleDouble, ROUNDOFF};
use super::support::support;
use super::vector::Vector;
use crate::narrow_phase::convex::Convex;
use crate::narrow_phase::outcome::Bracket;
use crate::narrow_phase::support::radius;
use crate::narrow_phase::unbounded::{Height, Unbounded};

/// The height of the body's lowest point. None where a placement is not known exactly.
pub(in crate::narrow_phase) fn height(a: &Convex, wall: &Unbounded) -> Option<Height> {
    // Normal and offset over the largest component, by a power of two: that rounds nothing.
    let shrink = libm::exp2(-libm::log2(wall.normal.amax()).floor().clamp(-1000.0, 1000.0));
    let normal = Vector::from(wall.normal * shrink);
    let norm = normal.norm();
    let up = normal.unit()?;
    let (_, offset) = wall.upright();
    let frames = Frames::new(&wall.given, &a.given, radius(a.core) + offset.abs())?;
    let offset = DoubleDouble::from(wall.offset * shrink * frames.scale) / norm;
    let into_body = frames.rotation.apply_transposed(up);
    let above = |p: Vector| up.dot(frames.translation) + into_body.dot(p) - offset;
    let lowest = support(a.core, -into_body, frames.scale);
    let (mut best, mut point, mut side) = (above(lowest), lowest, 1.0);
    if wall.thin {
        let highest = support(a.core, into_body, frames.scale);
        let below = -above(highest);
        if best < below {
            (best, point, side) = (below, highest, -1.0);
        }
    }
    let radii = [a.given.radii(), wall.given.radii()];
    let bracket = bracket(&frames, best, best, &radii);
    Some(Height { bracket, point: point.rounded() / frames.scale, side })
}

/// The bracket of the shapes, metres, around bounds on the scaled cores that are off by the frames' error: less the radii,
/// rounded outwards.
pub(super) fn bracket(frames: &Frames, lower: DoubleDouble, upper: DoubleDouble, radii: &[[f64; 6]; 2]) -> Bracket {
    let sum = radii.iter().flatten().fold(DoubleDouble::ZERO, |sum, r| sum + DoubleDouble::from(r * frames.scale));
    // Sums and differences of up to fourteen numbers.
    let size = lower.abs().max(upper.abs()) + sum;
    let slack = DoubleDouble::from(frames.error + 32.0 * ROUNDOFF * size.to_f64());
    let (lower, upper) = ((lower - sum - slack).floor(), (upper - sum + slack).ceil());
    let unscaled = |x: f64| x / frames.scale;
    // Dividing by a power of two rounds only below the normal numbers.
    let is_tiny = |x: f64| x.abs() < f64::MIN_POSITIVE;
    let (lower, upper) = (unscaled(lower), unscaled(upper));
    Bracket {
        lower: if is_tiny(lower) { lower.next_down() } else { lower },
        upper: if is_tiny(upper) { upper.next_up() } else { upper },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Pose, Quaternion, Shape, Vec3};
    use crate::narrow_phase::given::Given;

    /// A cylinder standing on a wall, far out along it: its height is that of its base.
    #[test]
    fn far_out_along_the_wall_no_digit_is_lost() {
        let (cylinder, wall) = (Shape::cylinder(0.3, 0.25).unwrap(), Shape::half_space(Vec3::z() * 3.0, -1.5).unwrap());
        let at = Pose::new(Vec3::new(1e12, -1e12, 0.75), Quaternion::IDENTITY).unwrap().placement();
        let origin = Pose::identity().placement();
        let body = Convex {
            core: cylinder.core(),
            swept_radius: 0.0,
            at: &at,
            placement_error: 0.0,
            given: Given::alone(&cylinder, &at),
        };
        let wall = Unbounded {
            normal: Vec3::z() * 3.0,
            offset: -1.5,
            thin: false,
            swept_radius: 0.0,
            at: &origin,
            placement_error: 0.0,
            given: Given::alone(&wall, &origin),
        };
        let Bracket { lower, upper } = height(&body, &wall).unwrap().bracket;
        assert!(lower <= 1.0 && 1.0 <= upper && upper - lower < 1e-15, "{lower} {upper}");
    }
}
