//! A rounded polytope against a half-space or a plane, exactly: the height of its lowest corner.

use dashu_int::IBig;

use super::integers::{Span, integer};
use super::pair::{Frames, MOST_BITS};
use super::polytope::Polytope;
use super::root::{Root, compare};
use super::vector::Vector;
use crate::narrow_phase::convex::Convex;
use crate::narrow_phase::unbounded::{Height, Unbounded};

/// None where no rational answer is to be had, as for [`super::separation`].
pub(in crate::narrow_phase) fn height(a: &Convex, wall: &Unbounded) -> Option<Height> {
    let (body, radius) = Polytope::of(a.core)?;
    let frames = Frames::new(&wall.given, &a.given, body.span)?;
    let of_normal = Span::of(wall.normal.iter().copied());
    let of_offset = Span::of([wall.offset]);
    if of_normal.bits() > MOST_BITS / 4 {
        return None;
    }
    let normal = Vector([wall.normal.x, wall.normal.y, wall.normal.z].map(|c| integer(c, of_normal.lowest)));
    // The products of normal and coordinates, and the offset, in one unit.
    let of_product = of_normal.lowest + frames.exponent;
    let unit = of_product.min(of_offset.lowest);
    if usize::try_from(of_product.max(of_offset.highest.saturating_sub(1)) - unit).is_ok_and(|bits| bits > MOST_BITS) {
        return None;
    }
    let offset = integer(wall.offset, unit) * &frames.factor;
    let (up, exponent) = (frames.direction_into_b(&normal), frames.exponent);
    let denominator = normal.square() * &frames.factor * &frames.factor;
    let above = |index: usize| -> IBig {
        let corner = frames.point_of_b(&body.integer_corner(index, exponent));
        (normal.dot(&corner) << usize::try_from(of_product - unit).unwrap_or(0)) - &offset
    };
    let root = |height: IBig| Root {
        negative: height < IBig::ZERO,
        numerator: &height * &height,
        denominator: denominator.clone(),
        exponent: unit - of_normal.lowest,
    };
    let lowest = body.lowest(&up, exponent);
    let (mut best, mut corner, mut side) = (root(above(lowest)), lowest, 1.0);
    if wall.thin {
        let highest = body.lowest(&up.negated(), exponent);
        let below = root(-above(highest));
        if compare(&below, &best).is_gt() {
            (best, corner, side) = (below, highest, -1.0);
        }
    }
    let radii = [&a.given.radii()[..], &wall.given.radii(), &[radius]].concat();
    Some(Height { bracket: best.less(&radii), point: body.corner(corner), side })
}
