//! Geometry in the plane across the normal: hulls of faces, and what two of them have in common.
//!
//! Sources: R. A. Jarvis 1973 for the hull, I. Sutherland and G. Hodgman 1974 for clipping, M. Cyrus and J. Beck 1978 for segments.

use arrayvec::ArrayVec;

/// Corners of a face at most.
pub(super) const MOST_CORNERS: usize = 32;

/// Corners of what two faces have in common at most: each edge of the one takes off corners of the other, but for one. And the cut-off makes one more.
pub(super) const ROOM: usize = 2 * MOST_CORNERS + 1;

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

    pub fn distance(self, other: Self) -> f64 {
        self.to(other).length()
    }

    /// The point at that part of the way to another.
    pub fn toward(self, other: Self, part: f64) -> Self {
        let way = self.to(other);
        Self { x: self.x + way.x * part, y: self.y + way.y * part }
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
fn sides(corners: &[Corner]) -> impl Iterator<Item = (Flat, Flat)> {
    (0..corners.len()).map(|i| (corners[i].at, corners[i].at.to(corners[(i + 1) % corners.len()].at)))
}

/// What two faces have in common, seen along the normal. A face that is a corner is opposite the other where it is, and edges that cross
/// share where they do. `tangent`: edges that are turned by less than this are parallel. `slack`: what is this near counts as in. `cuts` is
/// counted up.
pub(super) fn common(a: &[Corner], b: &[Corner], tangent: f64, slack: f64, cuts: &mut u64) -> ArrayVec<Flat, ROOM> {
    match (a, b) {
        ([], _) | (_, []) => ArrayVec::new(),
        // Of curved sides both are as near as the normal is known.
        ([one], [other]) => [one.at.toward(other.at, 0.5)].into_iter().collect(),
        ([only], _) | (_, [only]) => [only.at].into_iter().collect(),
        ([a, b], [c, d]) => of_segments([a.at, b.at], [c.at, d.at], tangent, slack, cuts),
        ([a, b], polygon) | (polygon, [a, b]) => segment_in([a.at, b.at], polygon, slack, cuts),
        (a, b) => clipped(a, b, slack, cuts),
    }
}

/// What two segments have in common: a stretch where they are parallel, or where they cross.
fn of_segments(one: [Flat; 2], other: [Flat; 2], tangent: f64, slack: f64, cuts: &mut u64) -> ArrayVec<Flat, ROOM> {
    *cuts += 4;
    let stretch = along(one, other, tangent, slack);
    if !stretch.is_empty() {
        return stretch;
    }
    let (way, back) = (one[0].to(one[1]), other[0].to(other[1]));
    let part = one[0].to(other[0]).cross(back) / way.cross(back);
    let crossing = part.is_finite().then(|| one[0].toward(one[1], part.clamp(0.0, 1.0)));
    crossing.into_iter().collect()
}

/// The part of two nearly parallel segments that lies side by side, half way between them. None where they are farther from one another
/// than two that cross at that angle.
fn along(one: [Flat; 2], other: [Flat; 2], tangent: f64, slack: f64) -> ArrayVec<Flat, ROOM> {
    let way = one[0].to(one[1]);
    let other = if way.dot(other[0].to(other[1])) < 0.0 { [other[1], other[0]] } else { other };
    let back = other[0].to(other[1]);
    let (length, of_other) = (way.length(), back.length());
    // The negation also catches what is not a number.
    if !(way.cross(back).abs() <= tangent * way.dot(back) + slack * (length + of_other)) {
        return ArrayVec::new();
    }
    // Places along the line between the two directions, twice as far as they are.
    let between = Flat { x: way.x / length + back.x / of_other, y: way.y / length + back.y / of_other };
    let spans = [one, other].map(|ends| ends.map(|end| between.dot(one[0].to(end))));
    let (low, high) = (spans[0][0].max(spans[1][0]), spans[0][1].min(spans[1][1]));
    if !(high - low > 2.0 * slack) {
        return ArrayVec::new();
    }
    let at = |ends: [Flat; 2], [start, end]: [f64; 2], place: f64| {
        ends[0].toward(ends[1], ((place - start) / (end - start)).clamp(0.0, 1.0))
    };
    let pairs = [low, high].map(|place| (at(one, spans[0], place), at(other, spans[1], place)));
    let reach = tangent * (length + of_other) + slack;
    if pairs.iter().any(|(p, q)| p.distance(*q) > reach) {
        return ArrayVec::new();
    }
    pairs.into_iter().map(|(p, q)| p.toward(q, 0.5)).collect()
}

/// The part of a segment that is in a convex polygon.
fn segment_in(segment: [Flat; 2], polygon: &[Corner], slack: f64, cuts: &mut u64) -> ArrayVec<Flat, ROOM> {
    let (mut low, mut high) = (0.0_f64, 1.0_f64);
    for (from, side) in sides(polygon) {
        *cuts += 2;
        let room = slack * side.length();
        let [one, other] = segment.map(|end| side.cross(from.to(end)));
        if one < -room && other < -room {
            return ArrayVec::new();
        }
        if one < -room {
            low = low.max(one / (one - other));
        } else if other < -room {
            high = high.min(one / (one - other));
        }
    }
    if !(low < high) {
        return ArrayVec::new();
    }
    [low, high].into_iter().map(|part| segment[0].toward(segment[1], part)).collect()
}

/// What two convex polygons have in common: the first, cut along each side of the second.
fn clipped(subject: &[Corner], by: &[Corner], slack: f64, cuts: &mut u64) -> ArrayVec<Flat, ROOM> {
    let mut rest: ArrayVec<Flat, ROOM> = subject.iter().map(|corner| corner.at).collect();
    for (from, side) in sides(by) {
        let room = slack * side.length();
        *cuts += rest.len() as u64;
        rest = cut(&rest, |p| side.cross(from.to(*p)), -room, |p, q, part| p.toward(*q, part));
        if rest.is_empty() {
            break;
        }
    }
    rest
}

/// The part of a convex polygon, or of a segment, where an affine value is not below `least`; sides are cut where it is zero.
pub(super) fn cut<P: Copy>(
    polygon: &[P],
    value: impl Fn(&P) -> f64,
    least: f64,
    between: impl Fn(&P, &P, f64) -> P,
) -> ArrayVec<P, ROOM> {
    let mut kept = ArrayVec::new();
    for (i, p) in polygon.iter().enumerate() {
        let q = &polygon[(i + 1) % polygon.len()];
        let (of_p, of_q) = (value(p), value(q));
        if of_p >= least {
            _ = kept.try_push(*p);
        }
        if (of_p >= least) != (of_q >= least) {
            _ = kept.try_push(between(p, q, (of_p / (of_p - of_q)).clamp(0.0, 1.0)));
        }
    }
    kept
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

    #[test]
    fn polygons_segments_and_parallel_edges_are_cut_where_they_end() {
        let mut cuts = 0;
        let moved: Corners = square(1.0).iter().map(|c| corner(c.at.x + 0.5, c.at.y + 0.25, 0.0)).collect();
        let both = common(&square(1.0), &moved, 0.0, 1e-15, &mut cuts);
        let bounds = both
            .iter()
            .fold([1.0_f64, -1.0, 1.0, -1.0], |[a, b, c, d], p| [a.min(p.x), b.max(p.x), c.min(p.y), d.max(p.y)]);
        assert_eq!((both.len(), bounds), (4, [-0.5, 1.0, -0.75, 1.0]));
        let through = [corner(-3.0, 0.5, 0.0), corner(3.0, 0.5, 0.0)];
        let inside = common(&through, &square(1.0), 0.0, 1e-15, &mut cuts);
        assert_eq!(&inside[..], [Flat { x: -1.0, y: 0.5 }, Flat { x: 1.0, y: 0.5 }]);
        let backwards = [corner(5.0, 0.52, 0.0), corner(1.0, 0.48, 0.0)];
        let beside = common(&through, &backwards, 0.02, 1e-15, &mut cuts);
        assert!(beside.len() == 2 && (beside[0].x - 1.0).abs() < 1e-2 && beside[1].x > 2.99, "{beside:?}");
        let crossing = common(&through, &backwards, 0.005, 1e-15, &mut cuts);
        assert!(crossing.len() == 1 && (crossing[0].x - 3.0).abs() < 1e-12, "turned by too much: {crossing:?}");
        assert!(cuts > 0);
    }
}
