//! Boxes turned to fit what is in them: what the tree of a mesh is made of.
//!
//! A patch of a surface is thin across its mean normal. A box that is turned with it is thinner than one along the axes by
//! the square of the patch's size, and nothing else decides as much how many nodes a query has to open
//! (`docs/meshes.md` has the measurements). The idea is Gottschalk's (OBBTree, 1996).

use super::tolerance::UNIT_ROUNDOFF;
use super::{Aabb, Mat3, TwinVec3, Vec3};

/// `center + axes * x` for all x with `|x_i| <= half_extents_i`. Metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrientedBox {
    /// Centre.
    pub center: Vec3,
    /// Unit vectors along the edges, as columns: orthonormal to [`MOST_SKEW`].
    pub axes: Mat3,
    /// Half the edges.
    pub half_extents: Vec3,
}

/// How far an entry of `axes^T axes` may be from that of the identity. What the fit yields is within half of this.
pub const MOST_SKEW: f64 = 16.0 * UNIT_ROUNDOFF;

impl OrientedBox {
    /// A box around triangles: along the frame axes or along their mean normal, whichever has the smaller surface. Every corner is
    /// inside to within a few roundings of its distance from the centre.
    #[must_use]
    pub fn around(triangles: &[[Vec3; 3]]) -> Self {
        let bounds = Aabb::around(triangles.iter().flatten().copied());
        let upright = Self::along(Mat3::identity(), bounds.center(), triangles);
        let size = bounds.half_extents().amax();
        // Shapes, not sizes, decide on the axes; products of extreme sizes would over- or underflow.
        let unscaled = |p: Vec3| (p - bounds.center()) / size;
        let Some(normal) = mean_normal(triangles, unscaled) else { return upright };
        let turned = |across: Option<Vec3>| {
            let frame = frame(normal, across?)?;
            Some(Self::along(frame, bounds.center(), triangles))
        };
        let main = turned(main_direction(triangles, unscaled, normal));
        let edges = if triangles.len() <= FEW { triangles } else { &[] };
        let along_edges = edges.iter().flat_map(|t| [t[1] - t[0], t[2] - t[1], t[0] - t[2]]);
        let candidates = main.into_iter().chain(along_edges.filter_map(|edge| turned(Some(edge / size))));
        candidates.fold(upright, |best, next| if next.surface(size) < best.surface(size) { next } else { best })
    }

    /// The box along the axes of the frame.
    #[must_use]
    pub fn upright(bounds: &Aabb) -> Self {
        Self { center: bounds.center(), axes: Mat3::identity(), half_extents: bounds.half_extents() }
    }

    fn along(axes: Mat3, near: Vec3, triangles: &[[Vec3; 3]]) -> Self {
        let corners = || triangles.iter().flatten();
        let range = Aabb::around(corners().map(|p| axes.tr_mul(&(p - near))));
        let center = near + axes * range.center();
        // Measured from the centre as it is stored.
        let half_extents = corners().fold(Vec3::zeros(), |half, p| half.sup(&axes.tr_mul(&(p - center)).abs()));
        Self { center, axes, half_extents }
    }

    /// A quarter of the surface, for a box of that `size` as the unit.
    fn surface(&self, size: f64) -> f64 {
        let h = self.half_extents / size;
        h.x * h.y + h.y * h.z + h.z * h.x
    }
}

/// Up to so many triangles, directions of edges are tried: a box along an edge fits one triangle best.
const FEW: usize = 2;

/// The mean normal, weighted by area. None where it vanishes, as on a closed surface.
fn mean_normal(triangles: &[[Vec3; 3]], unscaled: impl Fn(Vec3) -> Vec3) -> Option<Vec3> {
    let twice_area = |t: &[Vec3; 3]| {
        let [a, b, c] = t.map(&unscaled);
        (b - a).cross(&(c - a))
    };
    let (mut sum, mut total) = (Vec3::zeros(), 0.0);
    for t in triangles {
        let n = twice_area(t);
        sum += n;
        total += n.norm();
    }
    // Comparison order matters: NaN has no direction.
    (sum.norm() > 1e-3 * total && total > 0.0).then(|| sum.normalize())
}

/// The direction across `normal` in which the corners are spread most: the first eigenvector of their 2x2 covariance.
fn main_direction(triangles: &[[Vec3; 3]], unscaled: impl Fn(Vec3) -> Vec3, normal: Vec3) -> Option<Vec3> {
    let reference = if normal.x.abs() < 0.7 { Vec3::x() } else { Vec3::y() };
    let frame = frame(normal, reference)?;
    let (u, v) = (frame.column(0), frame.column(1));
    let flat = || triangles.iter().flatten().map(|p| unscaled(*p)).map(|p| (p.dot(&u), p.dot(&v)));
    let count = 3.0 * triangles.len() as f64;
    let (mean_u, mean_v) = flat().fold((0.0, 0.0), |(x, y), (pu, pv)| (x + pu / count, y + pv / count));
    let (mut uu, mut uv, mut vv) = (0.0, 0.0, 0.0);
    for (pu, pv) in flat() {
        let (x, y) = (pu - mean_u, pv - mean_v);
        uu += x * x;
        uv += x * y;
        vv += y * y;
    }
    // (uu uv; uv vv) has the eigenvector (d + r, 2 uv) with d = uu - vv, r = sqrt(d^2 + 4 uv^2); turned to keep d + r from cancelling.
    let difference = uu - vv;
    let root = (difference * difference + 4.0 * uv * uv).sqrt();
    let (x, y) = if difference >= 0.0 { (difference + root, 2.0 * uv) } else { (2.0 * uv, root - difference) };
    Some(u * x + v * y)
}

/// An orthonormal frame with `normal` as its third axis and the first along `across`; none where that is not possible.
fn frame(normal: Vec3, across: Vec3) -> Option<Mat3> {
    let within = across - normal * normal.dot(&across);
    // Twice is enough: the first round leaves an error relative to the part that was taken off.
    let first = (within - normal * normal.dot(&within)).try_normalize(1e-100)?;
    let frame = Mat3::from_columns(&[first, normal.cross(&first), normal]);
    let skew = (frame.tr_mul(&frame) - Mat3::identity()).amax();
    (skew <= MOST_SKEW).then_some(frame)
}

/// Two boxes side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwinBox {
    /// Centres.
    pub center: TwinVec3,
    /// First, second and third axis of both.
    pub axes: [TwinVec3; 3],
    /// Half the edges.
    pub half_extents: TwinVec3,
}

impl TwinBox {
    /// Two boxes, side by side.
    #[must_use]
    pub fn new(boxes: [&OrientedBox; 2]) -> Self {
        let axis = |k: usize| TwinVec3::new(boxes.map(|b| b.axes.column(k).into_owned()));
        Self {
            center: TwinVec3::new(boxes.map(|b| b.center)),
            axes: [axis(0), axis(1), axis(2)],
            half_extents: TwinVec3::new(boxes.map(|b| b.half_extents)),
        }
    }

    /// One of the two.
    #[inline(always)]
    #[must_use]
    pub fn lane(&self, lane: usize) -> OrientedBox {
        let [u, v, w] = &self.axes;
        OrientedBox {
            center: self.center.lane(lane),
            axes: Mat3::from_columns(&[u.lane(lane), v.lane(lane), w.lane(lane)]),
            half_extents: self.half_extents.lane(lane),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the definition, corner by corner.
    #[test]
    fn every_corner_is_inside_at_every_size_and_a_tilted_patch_gets_a_thin_box() {
        for size in [1e-150, 1e-9, 1.0, 1e150] {
            let point = |i: u32, j: u32| {
                let (x, y) = (f64::from(i) * 0.1, f64::from(j) * 0.07);
                Vec3::new(x + 0.3 * y, y - 0.2 * x, 0.8 * x + 0.6 * y + 0.01 * x * y) * size
            };
            let quad = |i, j| [[point(i, j), point(i + 1, j), point(i, j + 1)]];
            let patch: Vec<[Vec3; 3]> = (0..6).flat_map(|i| (0..9).flat_map(move |j| quad(i, j))).collect();
            for run in [&patch[..], &patch[..1], &patch[3..5]] {
                let fitted = OrientedBox::around(run);
                for p in run.iter().flatten() {
                    let inside = fitted.axes.tr_mul(&(p - fitted.center)).abs() - fitted.half_extents;
                    assert!(inside.max() <= 1e-14 * size, "{inside:?}");
                }
                assert!(fitted.half_extents.min() < 0.01 * size, "{fitted:?}");
            }
        }
    }

    #[test]
    fn what_has_no_normal_gets_an_upright_box() {
        let segment = [Vec3::zeros(), Vec3::new(1.0, 2.0, 3.0), Vec3::new(2.0, 4.0, 6.0)];
        for run in [segment, [Vec3::repeat(5.0); 3]] {
            assert_eq!(OrientedBox::around(&[run]).axes, Mat3::identity());
        }
    }
}
