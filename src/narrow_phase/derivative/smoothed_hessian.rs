//! One side of a pair, with a smoothed Hessian of its support function in place of none.
//!
//! With s the support function and S its support point, let directions d across the normal be noisy, `s_e(d) = E s(d + e z)`, z two independent
//! normal numbers in the plane across d. The gradient of s is S, and moving the derivative onto the density (Stein 1981), its Hessian is
//!
//! ```text
//! H_e(d) = E [ S(d + e z) z^T ] / e = E [ (S(d + e z) - S(d - e z)) z^T ] / (2 e),
//! ```
//!
//! projected on the plane and made symmetric, which the mean is by itself. Noise along d tells nothing: s is homogeneous, so S(d + e z) is that
//! of its own direction, and noise of three numbers is one across d whose reach differs a little from sample to sample.
//!
//! A swept ball of radius r adds `r |d|` to the support function, whose Hessian across d is r: exactly, and it is not sampled.

use arrayvec::ArrayVec;
use nalgebra::Vector3;

use super::super::goal::Goal;
use super::super::patch::{TouchingPiece, is_wall};
use super::super::support::{NO_HINT, farthest};
use super::counter_random::CounterRandom;
use super::derivatives::{DerivativeCost, DerivativeMethod, NoDerivatives};
use super::moments::Moments;
use super::moved_pair::core_radius;
use super::side::{Mat2, Side};
use super::softmax::softmax_hessian;
use crate::geometry::{Core, Vec3};

/// Samples between two looks at the caller's stop.
const UNSTOPPED: u32 = 256;

/// How a side is smoothed.
pub(super) struct Smoothing<'a> {
    pub method: DerivativeMethod,
    pub epsilon: f64,
    pub samples: u32,
    pub random: CounterRandom,
    pub again: &'a Goal<'a>,
}

/// A side, and how well it is known.
pub(super) struct SmoothedSide {
    pub side: Side,
    /// Standard error of the largest entry of its tensor, or a bound of what was left out of it; metres.
    pub error: f64,
    pub is_sampled: bool,
}

impl Smoothing<'_> {
    /// `axes` as in [`Side::of`]. `number` of the side: sides have numbers of their own.
    pub fn side(
        &self,
        piece: &TouchingPiece,
        axes: [Vec3; 3],
        number: u32,
        cost: &mut DerivativeCost,
    ) -> Result<SmoothedSide, NoDerivatives> {
        let known = |side| Ok(SmoothedSide { side, error: 0.0, is_sampled: false });
        if is_wall(&piece.core) {
            return known(Side::of(piece, axes, 0.0, cost)); // Flat everywhere, also in the mean.
        }
        let swept = Mat2::identity() * piece.swept_radius;
        if matches!(*piece.core, Core::Point) {
            return known(bent(swept));
        }
        let in_core = axes.map(|axis| piece.rotation.tr_mul(&axis));
        if self.method == DerivativeMethod::Smoothed1Gumbel {
            let radius = core_radius(piece).unwrap_or(0.0);
            if let Some(found) = softmax_hessian(&piece.core, radius, &in_core, self.epsilon) {
                cost.supports += 1;
                cost.corners += found.corners;
                return Ok(SmoothedSide {
                    side: bent(found.hessian + swept),
                    error: found.left_out,
                    is_sampled: false,
                });
            }
            if matches!(*piece.core, Core::Ellipsoid { radii } if radii.min() > 0.0) {
                return known(Side::of(piece, axes, 0.0, cost));
            }
        }
        let (hessian, error) = self.sampled(&piece.core, &in_core, number)?;
        cost.supports += 2 * u64::from(self.samples);
        Ok(SmoothedSide { side: bent(hessian + swept), error, is_sampled: true })
    }

    /// The mean over directions turned at random, and its standard error.
    fn sampled(&self, core: &Core, [x, y, up]: &[Vec3; 3], number: u32) -> Result<(Mat2, f64), NoDerivatives> {
        // Entries xx, xy, yy.
        let mut moments = Moments::<3, 1>::new();
        let (mut corner_there, mut corner_back) = (NO_HINT, NO_HINT);
        for sample in 0..self.samples {
            if sample % UNSTOPPED == UNSTOPPED - 1 && (self.again.stop)() {
                return Err(NoDerivatives::Stopped);
            }
            let z = self.random.normals(sample, number);
            let turn = x * z[0] + y * z[1];
            let (there, back);
            (there, corner_there) = farthest(core, up + turn * self.epsilon, corner_there);
            (back, corner_back) = farthest(core, up - turn * self.epsilon, corner_back);
            let half = (there - back) / (2.0 * self.epsilon);
            let (along_x, along_y) = (x.dot(&half), y.dot(&half));
            moments.add(&Vector3::new(along_x * z[0], (along_x * z[1] + along_y * z[0]) / 2.0, along_y * z[1]));
        }
        let [xx, xy, yy] = (*moments.mean()).into();
        Ok((Mat2::new(xx, xy, xy, yy), moments.standard_error()))
    }
}

/// Nothing flat, and no border: the mean over both sides of one is what is asked for.
fn bent(radii: Mat2) -> Side {
    Side { flat: ArrayVec::new(), radii, on_border: false }
}
