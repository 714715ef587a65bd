//! Where B is in A's frame, composed in double-doubles from the poses as given.

use super::number::{DoubleDouble, ROUNDOFF};
use super::vector::{Matrix, Vector};
use crate::geometry::{Quaternion, Vec3, length};
use crate::narrow_phase::given::Given;

/// B in A, all lengths times a power of two that brings the extent of the pair near 1.
pub(super) struct Frames {
    pub rotation: Matrix,
    pub translation: Vector,
    /// The power of two.
    pub scale: f64,
    /// A support value or a point of the difference is off by no more than this, in scaled metres.
    pub error: f64,
}

/// E = 256 times [`ROUNDOFF`] times the extent, of which `docs/derivations/escalation.md` needs 203.
const ERROR_ROUNDOFFS: f64 = 256.0;

impl Frames {
    /// `reach`: the sum of the cores' radii, metres. None where a placement is not known exactly.
    pub fn new(a: &Given, b: &Given, reach: f64) -> Option<Self> {
        let (outer_a, outer_b) = (matrix(a.at.quaternion?), matrix(b.at.quaternion?));
        let inner = |given: &Given| given.part.map(|part| (matrix(part.pose.rotation()), part.pose.translation()));
        let (inner_a, inner_b) = (inner(a), inner(b));
        let within = |inner: &Option<(Matrix, Vec3)>| inner.map_or(0.0, |(_, place)| length(place));
        let apart = length(b.at.translation - a.at.translation);
        let extent = reach + within(&inner_a) + within(&inner_b) + apart;
        let scale = if extent == 0.0 { 1.0 } else { libm::exp2(-libm::log2(extent).floor().clamp(-1000.0, 1000.0)) };

        let whole = |outer: &Matrix, inner: &Option<(Matrix, Vec3)>| match inner {
            Some((rotation, _)) => outer.after(rotation),
            None => *outer,
        };
        let (whole_a, whole_b) = (whole(&outer_a, &inner_a), whole(&outer_b, &inner_b));
        let mut between = Vector::difference(b.at.translation, a.at.translation).scaled(scale);
        if let Some((_, place)) = inner_b {
            between = between + outer_b.apply(Vector::from(place).scaled(scale));
        }
        if let Some((_, place)) = inner_a {
            between = between - outer_a.apply(Vector::from(place).scaled(scale));
        }
        Some(Self {
            rotation: whole_a.transposed().after(&whole_b),
            translation: whole_a.apply_transposed(between),
            scale,
            // What underflows in products of scaled numbers is far below.
            error: ERROR_ROUNDOFFS * ROUNDOFF * extent * scale,
        })
    }
}

/// R(q/|q|) written out, as `Quaternion::matrix` does it.
fn matrix(q: Quaternion) -> Matrix {
    let largest = q.w.abs().max(q.x.abs()).max(q.y.abs()).max(q.z.abs());
    // By a power of two, in two steps because one factor may not be a double.
    let exponent = libm::log2(largest).floor();
    let (one, other) = (libm::exp2(-(0.5 * exponent).floor()), libm::exp2(-(exponent - (0.5 * exponent).floor())));
    let [w, x, y, z] = [q.w, q.x, q.y, q.z].map(|c| DoubleDouble::from(c * one * other));
    let two = DoubleDouble::from(2.0);
    let s = two / (w * w + x * x + y * y + z * z);
    let diagonal = |p: DoubleDouble, q: DoubleDouble| DoubleDouble::ONE - s * (p * p + q * q);
    Matrix([
        Vector([diagonal(y, z), s * (x * y - w * z), s * (x * z + w * y)]),
        Vector([s * (x * y + w * z), diagonal(x, z), s * (y * z - w * x)]),
        Vector([s * (x * z - w * y), s * (y * z + w * x), diagonal(x, y)]),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Pose, Shape};

    #[test]
    fn a_frame_in_itself_is_the_identity_at_any_scale_and_norm() {
        let q = Quaternion { w: 1e-170, x: -3e-170, y: 2.2e-170, z: 0.4e-170 };
        let shape = Shape::sphere(1.0).unwrap();
        for place in [Vec3::zeros(), Vec3::new(1e-200, 3.0, 1e120)] {
            let at = Pose::new(place, q).unwrap().placement();
            let given = Given::alone(&shape, &at);
            let frames = Frames::new(&given, &given, 1e-30).unwrap();
            for i in 0..3 {
                for j in 0..3 {
                    let off = frames.rotation.0[i].0[j] - DoubleDouble::from(if i == j { 1.0 } else { 0.0 });
                    assert!(off.abs().to_f64() < 1e-30, "{off:?}");
                }
            }
            assert_eq!(frames.translation.rounded(), Vec3::zeros());
            assert!((0.5..=1.0).contains(&(1e-30 * frames.scale / 2.0)));
        }
    }
}
