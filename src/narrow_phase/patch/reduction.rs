//! A few corners of a polygon that stand for all of them, and where the polygon begins.

use arrayvec::ArrayVec;

use super::common_region::ROOM;
use super::flat_region::Flat;

/// A corner of what two faces have in common. Metres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub at: Flat,
    /// Of A's face along the normal, over the witness.
    pub height: f64,
    /// From A's face to B's, along the normal.
    pub gap: f64,
}

pub(super) type Places = ArrayVec<Place, ROOM>;

/// Areas and lengths that differ by less than this part of the greater are equal, and the corner that is earlier in the order counts: not
/// rounding decides which corners of a regular polygon are kept.
const ALIKE: f64 = 1e-9;

/// Leaves `most` corners: the first, which is the deepest, the one farthest from it, and then one by one the corner that adds most to the
/// area; of equals the one with the least `order`.
pub(super) fn reduce(places: &mut Places, most: usize, order: impl Fn(&Place) -> f64) {
    if places.len() <= most {
        return;
    }
    let mut kept = ArrayVec::<usize, ROOM>::new();
    if most > 0 {
        kept.push(0);
    }
    while kept.len() < most {
        // What a corner adds between its neighbours among those kept: twice the area; with only one kept the square of the distance.
        let gain = |i: usize| {
            let after = kept.iter().position(|k| *k > i).unwrap_or(kept.len());
            let [before, next] = [kept[after - 1], kept[after % kept.len()]].map(|k| places[k].at);
            let at = places[i].at;
            if kept.len() == 1 {
                return at.distance(before) * at.distance(before);
            }
            let [one, other] = [before, next].map(|from| Flat { x: at.x - from.x, y: at.y - from.y });
            other.cross(one)
        };
        let is_better = |(i, of_i): &(usize, f64), (best, of_best): &(usize, f64)| {
            of_i * (1.0 - ALIKE) > *of_best
                || (of_i * (1.0 + ALIKE) > *of_best && order(&places[*i]) < order(&places[*best]))
        };
        let others = (0..places.len()).filter(|i| !kept.contains(i)).map(|i| (i, gain(i)));
        let Some((best, _)) = others.reduce(|one, other| if is_better(&other, &one) { other } else { one }) else {
            break;
        };
        let after = kept.iter().position(|k| *k > best).unwrap_or(kept.len());
        kept.insert(after, best);
    }
    *places = kept.iter().map(|k| places[*k]).collect();
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(count: usize, radius: f64) -> Places {
        let corner = |k: usize| {
            let (y, x) = libm::sincos(std::f64::consts::TAU * k as f64 / count as f64);
            Place { at: Flat { x: x * radius, y: y * radius }, height: 0.0, gap: k as f64 }
        };
        (0..count).map(corner).collect()
    }

    fn area(places: &Places) -> f64 {
        let next = |i: usize| places[(i + 1) % places.len()].at;
        (0..places.len()).map(|i| places[i].at.cross(next(i))).sum::<f64>() / 2.0
    }

    #[test]
    fn four_of_sixteen_corners_are_a_square_that_begins_with_the_deepest() {
        let mut places = polygon(16, 2.0);
        reduce(&mut places, 4, |place| place.gap);
        let gaps: Vec<f64> = places.iter().map(|place| place.gap).collect();
        assert_eq!(gaps, [0.0, 4.0, 8.0, 12.0]);
        assert!((area(&places) - 8.0).abs() < 1e-12);
    }

    /// Oracle: all choices of that many corners with the first among them.
    #[test]
    fn what_is_kept_spans_nearly_the_largest_area() {
        for count in 5..10_usize {
            let mut places = polygon(count, 1.0);
            places.iter_mut().enumerate().for_each(|(k, place)| place.at.x *= 1.0 + k as f64);
            let best = (0..1_u32 << count).filter(|bits| bits & 1 == 1 && bits.count_ones() == 4).map(|bits| {
                area(&places.iter().enumerate().filter(|(k, _)| bits >> k & 1 == 1).map(|(_, place)| *place).collect())
            });
            let best = best.fold(0.0, f64::max);
            reduce(&mut places, 4, |place| place.gap);
            assert!(places.len() == 4 && places[0].gap == 0.0 && area(&places) > 0.8 * best, "{count}");
        }
    }

    #[test]
    fn few_corners_stay_and_none_can_be_asked_for() {
        let mut places = polygon(3, 1.0);
        reduce(&mut places, 3, |place| place.gap);
        assert_eq!(places.len(), 3);
        for most in [2, 1, 0] {
            reduce(&mut places, most, |place| place.gap);
            assert_eq!(places.len(), most);
        }
    }
}
