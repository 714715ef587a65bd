//! What do two faces have in common, seen along the normal?
//!
//! Sources: I. Sutherland and G. Hodgman 1974 for clipping, M. Cyrus and J. Beck 1978 for segments.

use arrayvec::ArrayVec;

use super::flat_region::{Corner, Flat, MOST_CORNERS, sides};

/// Corners of what two faces have in common at most: each edge of the one takes off corners of the other, but for one. And the cut-off makes one more.
pub(super) const ROOM: usize = 2 * MOST_CORNERS + 1;

impl Flat {
    pub fn distance(self, other: Self) -> f64 {
        self.to(other).length()
    }

    /// The point at that part of the way to another.
    pub fn toward(self, other: Self, part: f64) -> Self {
        let way = self.to(other);
        Self { x: self.x + way.x * part, y: self.y + way.y * part }
    }
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
    use super::super::flat_region::{Corners, hull};
    use super::*;

    fn corner(x: f64, y: f64, height: f64) -> Corner {
        Corner { at: Flat { x, y }, height }
    }

    fn square(size: f64) -> Corners {
        hull(&[(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)].map(|(x, y)| corner(x * size, y * size, x)), 1e-15)
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
