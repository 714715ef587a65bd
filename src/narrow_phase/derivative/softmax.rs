//! What is the Hessian of a polytope's support function when the heights of its corners are noisy?
//!
//! The support function is the greatest height of a corner, `s(d) = max d . v_i`. Add to each height independent Gumbel noise of scale t (with mean
//! zero); the greatest then has the mean
//!
//! ```text
//! s_t(d) = t ln sum exp(d . v_i / t),         0 <= s_t - s <= t ln n,
//! ```
//!
//! as the sum is between its largest term and n times that. It is smooth, and with weights `a_i = exp((d . v_i - s_t) / t)` its gradient is the
//! weighted mean of the corners and its Hessian their weighted covariance by t. (Gumbel 1954; its use for shapes: Montaut and others, ICRA 2023.)
//!
//! Corners whose weight is below `exp(-c)` of the highest one's are left out, c = ln(n / LEFT_OUT), so that all of them together weigh
//! q <= LEFT_OUT of what is kept. With L left out and K kept, `Cov = (1-q) Cov_K + q Cov_L + q (1-q) (m_K - m_L)(m_K - m_L)^T`, and corners within a
//! ball of radius R have covariances of norm R^2 at most and means no farther than 2 R from each other: leaving L out changes Cov by at
//! most 5 q R^2. R^2 is at most 3 r^2, r half the longest side of the box. That bound is told.
//!
//! Of a mesh the piece is a triangle, whose three corners are all that is smoothed: what lies beyond its edges is not seen.

use super::super::support::{NO_HINT, corner, farthest};
use super::side::Mat2;
use crate::geometry::{ConvexHull, Core, CornerSums, CornerWeights, HullSurface, Vec3};

/// What all corners that are left out weigh at most, as a part of the others.
const LEFT_OUT: f64 = 1e-12;

/// From this many corners on a hull with a proved surface is climbed down from its top; of fewer all are looked at, which is faster.
const CLIMBED: usize = 1024;

/// Below it exponents would overflow.
const LEAST_EPSILON: f64 = 1e-300;

/// The corners of these cores have at most so many numbers.
const FEW: u32 = 8;

/// A smoothed Hessian, across the direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SmoothedHessian {
    pub hessian: Mat2,
    /// By how much it is off at most because of corners that were left out; metres.
    pub left_out: f64,
    /// Corners that were looked at.
    pub corners: u64,
}

/// Of a core with corners, of that radius (half the longest side of its box), for heights with noise of `epsilon` times that. The axes are
/// x and y of the plane and the direction, in the core's frame. None for cores without corners.
pub(super) fn softmax_hessian(core: &Core, radius: f64, axes: &[Vec3; 3], epsilon: f64) -> Option<SmoothedHessian> {
    corner(core, 0)?;
    let (top, number) = farthest(core, axes[2], NO_HINT);
    let hull = as_hull(core);
    let count = hull.map_or_else(|| few(core).count(), |hull| hull.points().len());
    let lowest = libm::log(LEFT_OUT / count as f64);
    let weights = CornerWeights { axes: *axes, top, temperature: epsilon * radius, lowest };
    if epsilon < LEAST_EPSILON || weights.temperature < f64::MIN_POSITIVE {
        // The highest corner alone, or all of them in one place.
        return Some(SmoothedHessian { hessian: Mat2::zeros(), left_out: 0.0, corners: 0 });
    }
    let (sums, looked_at) = match hull {
        None => of_some(&weights, few(core)),
        Some(hull) => match hull.surface().filter(|_| count >= CLIMBED) {
            None => (hull.weighted(&weights), count),
            Some(surface) => of_some(&weights, Descent::new(hull.points(), surface, number, &weights)),
        },
    };
    let light = (count - sums.kept) as f64 / count as f64;
    let left_out = 15.0 * LEFT_OUT * light * radius / epsilon;
    let hessian = covariance(&sums) / weights.temperature;
    Some(SmoothedHessian { hessian, left_out, corners: looked_at as u64 })
}

/// The corners of a core that has but a few.
fn few(core: &Core) -> impl Iterator<Item = Vec3> {
    (0..FEW).map_while(|number| corner(core, number))
}

fn as_hull(core: &Core) -> Option<&ConvexHull> {
    match core {
        Core::Convex(hull) => Some(hull),
        Core::Point
        | Core::Cuboid { .. }
        | Core::AxialSegment { .. }
        | Core::Cylinder { .. }
        | Core::Cone { .. }
        | Core::Ellipsoid { .. }
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

/// The exponent of a corner's weight.
fn exponent(weights: &CornerWeights, corner: Vec3) -> f64 {
    weights.axes[2].dot(&(corner - weights.top)) / weights.temperature
}

/// Sums over a few corners, and how many were looked at.
fn of_some(weights: &CornerWeights, corners: impl Iterator<Item = Vec3>) -> (CornerSums, usize) {
    let mut sums = CornerSums::default();
    let mut looked_at = 0;
    for corner in corners {
        looked_at += 1;
        let exponent = exponent(weights, corner);
        if exponent < weights.lowest {
            continue;
        }
        let weight = libm::exp(exponent);
        let [x, y, _] = weights.axes.map(|axis| axis.dot(&(corner - weights.top)));
        sums.kept += 1;
        sums.weight += weight;
        for (sum, product) in sums.moments.iter_mut().zip([x, y, x * x, x * y, y * y]) {
            *sum += weight * product;
        }
    }
    (sums, looked_at)
}

fn covariance(sums: &CornerSums) -> Mat2 {
    if sums.kept < 2 {
        return Mat2::zeros(); // A corner.
    }
    let [x, y, xx, xy, yy] = sums.moments.map(|sum| sum / sums.weight);
    Mat2::new(xx - x * x, xy - x * y, xy - x * y, yy - y * y)
}

/// The corners of a large hull from its top down along edges, as far as they weigh enough, and those next to them.
///
/// The corners of a convex surface above any height hang together, as from each of them edges lead higher up to the top. So whatever is heavy
/// enough is reached over corners that are. (Heights that round could hide only what is within a rounding of the bound.)
struct Descent<'a> {
    points: &'a [Vec3],
    surface: &'a HullSurface,
    weights: &'a CornerWeights,
    seen: Vec<bool>,
    open: Vec<u32>,
}

impl<'a> Descent<'a> {
    fn new(points: &'a [Vec3], surface: &'a HullSurface, top: u32, weights: &'a CornerWeights) -> Self {
        let mut seen = vec![false; points.len()];
        seen[top as usize] = true;
        Self { points, surface, weights, seen, open: vec![top] }
    }
}

impl Iterator for Descent<'_> {
    type Item = Vec3;

    fn next(&mut self) -> Option<Vec3> {
        let number = self.open.pop()?;
        let corner = self.points[number as usize];
        if !(exponent(self.weights, corner) < self.weights.lowest) {
            for &next in self.surface.neighbours(number) {
                if !std::mem::replace(&mut self.seen[next as usize], true) {
                    self.open.push(next);
                }
            }
        }
        Some(corner)
    }
}
