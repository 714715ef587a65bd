//! Geometry in the plane across the normal: the outline of a face, and what is within it.
//!
//! Source of the hull: R. A. Jarvis 1973.

use arrayvec::ArrayVec;

/// Corners of a face at most.
pub(super) const MOST_CORNERS: usize = 32;

/// A point in the plane across the normal, metres from the witness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in super::super) struct Flat {
    pub x: f64,
    pub y: f64,
}

impl Flat {
    pub fn to(self, other: Self) -> Self {
        Self { x: other.x - self.x, y: other.y - self.y }
    }

    pub fn dot(self, other: Self) -> f64 {
        self.x * other.x + self.y * other.y
    }

    /// The part of `other` to the left of this, times the length of this.
    pub fn cross(self, other: Self) -> f64 {
        self.x * other.y - self.y * other.x
    }

    pub fn length(self) -> f64 {
        self.dot(self).sqrt()
    }

    /// Of the distance.
    pub fn square_to(self, other: Self) -> f64 {
        let way = self.to(other);
        way.dot(way)
    }
}

/// A corner of a face: a place in the plane, and a height above it towards the other shape; metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in super::super) struct Corner {
    pub at: Flat,
    pub height: f64,
}

pub(in super::super) type Corners = ArrayVec<Corner, MOST_CORNERS>;

/// The corners of the convex hull, counter-clockwise. What is nearer than `slack` to a side is no corner; of several in one place the highest is.
///
/// From a corner on the next one is that which all others are to the left of, and of several in line the farthest: an order of places
/// along an axis, as faster ways need, is no more than rounding where sides are across that axis.
pub(super) fn hull(corners: &[Corner], slack: f64) -> Corners {
    let mut distinct = Corners::new();
    for &corner in corners {
        match distinct.iter_mut().find(|kept| kept.at.square_to(corner.at) <= slack * slack) {
            Some(kept) if kept.height >= corner.height => {}
            Some(kept) => *kept = corner,
            None => distinct.push(corner),
        }
    }
    if distinct.len() < 3 {
        return distinct;
    }
    let from = distinct[0].at;
    let start = (0..distinct.len())
        .fold(0, |q, r| if distinct[r].at.square_to(from) > distinct[q].at.square_to(from) { r } else { q });
    let mut around = ArrayVec::<usize, MOST_CORNERS>::from_iter([start]);
    loop {
        let next = next_around(&distinct, around[around.len() - 1], slack);
        if around.contains(&next) {
            break;
        }
        around.push(next);
    }
    around.into_iter().map(|i| distinct[i]).collect()
}

/// The corner of the hull that follows the corner `from`.
fn next_around(corners: &[Corner], from: usize, slack: f64) -> usize {
    let p = corners[from].at;
    let mut best = usize::from(from == 0);
    let mut to_best = p.to(corners[best].at);
    let mut square = to_best.dot(to_best);
    for (i, corner) in corners.iter().enumerate() {
        if i == from || i == best {
            continue;
        }
        let way = p.to(corner.at);
        let (turn, far) = (to_best.cross(way), way.dot(way));
        let is_next = if turn * turn <= slack * slack * far.max(square) { far > square } else { turn < 0.0 };
        if is_next {
            (best, to_best, square) = (i, way, far);
        }
    }
    best
}

/// Whether a place is in a convex polygon, or no farther outside than `slack`.
pub(super) fn holds(corners: &[Corner], at: Flat, slack: f64) -> bool {
    sides(corners).all(|(from, side)| side.cross(from.to(at)) >= -slack * side.length())
}

/// From where each side of a polygon leads, and how.
pub(super) fn sides(corners: &[Corner]) -> impl Iterator<Item = (Flat, Flat)> {
    (0..corners.len()).map(|i| (corners[i].at, corners[i].at.to(corners[(i + 1) % corners.len()].at)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner(x: f64, y: f64, height: f64) -> Corner {
        Corner { at: Flat { x, y }, height }
    }

    fn square(size: f64) -> Corners {
        hull(&[(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)].map(|(x, y)| corner(x * size, y * size, x)), 1e-15)
    }

    #[test]
    fn a_hull_turns_left_and_leaves_out_what_is_on_its_sides() {
        let mut points: Corners = square(1.0).into_iter().collect();
        points.extend([
            corner(0.0, 0.0, 0.0),
            corner(1.0, 0.3, 0.0),
            corner(1.0, 1.0, 7.0),
            corner(-1.0 + 1e-17, 0.1, 0.0),
        ]);
        let found = hull(&points, 1e-15);
        assert_eq!(found.len(), 4);
        assert!(sides(&found).zip(sides(&found).skip(1)).all(|((_, one), (_, next))| one.cross(next) > 0.0));
        assert_eq!(found.iter().filter(|c| c.height == 7.0).count(), 1, "the higher of two in one place");
        // Sides along an axis, but for rounding.
        let noise = [0.0, 1e-16, -1e-16, 2e-16, 0.0, -1e-16];
        let sheet = [(1.0, 0.0), (1.0, 0.5), (1.0, -0.5), (-1.0, 0.5), (-1.0, -0.5), (-1.0, 0.0)];
        for shift in 0..6 {
            let noisy = |k: usize| corner(sheet[k].0 * (1.0 + noise[(k + shift) % 6]), sheet[k].1, 0.0);
            assert_eq!(hull(&[0, 1, 2, 3, 4, 5].map(noisy), 1e-15).len(), 4);
        }
        let line: Corners = (0..9).map(|i| corner(f64::from(i), f64::from(2 * i), 0.0)).collect();
        let mut ends: Vec<f64> = hull(&line, 1e-15).iter().map(|c| c.at.x).collect();
        ends.sort_by(f64::total_cmp);
        assert_eq!(ends, [0.0, 8.0]);
        assert_eq!(hull(&[corner(0.0, 0.0, 1.0), corner(1e-17, 0.0, 2.0)], 1e-15).len(), 1);
    }
}
