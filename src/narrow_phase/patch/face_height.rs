//! How high a face is between its corners.

use super::face::Face;
use super::flat_region::{Corner, Flat, MOST_CORNERS};

/// A face with the plane that all its corners lie on, if they do.
pub(super) struct Relief {
    pub face: Face,
    plane: Option<Plane>,
}

impl Relief {
    pub fn of(face: Face, slack: f64) -> Self {
        Self { plane: Plane::through(&face.outline, &face.corners, slack), face }
    }

    /// Height at a place within the outline.
    pub fn height(&self, at: Flat, slack: f64) -> f64 {
        match &self.plane {
            Some(plane) => plane.height(at),
            None => height(&self.face.outline, &self.face.corners, at, slack),
        }
    }
}

/// A plane over the plane across the normal.
#[derive(Clone, Copy, Debug)]
struct Plane {
    through: Corner,
    /// How it rises along either axis.
    rise: Flat,
}

impl Plane {
    /// Through all corners of a face, if they lie on one.
    fn through(outline: &[Corner], all: &[Corner], slack: f64) -> Option<Self> {
        let count = outline.len();
        if count < 3 {
            return None;
        }
        let [p, q, r] = [outline[0], outline[count / 3], outline[2 * count / 3]];
        let (one, other) = (p.at.to(q.at), p.at.to(r.at));
        let (up, on, area) = (q.height - p.height, r.height - p.height, one.cross(other));
        let rise = Flat { x: (up * other.y - on * one.y) / area, y: (on * one.x - up * other.x) / area };
        let plane = Self { through: p, rise };
        all.iter().all(|corner| (corner.height - plane.height(corner.at)).abs() <= slack).then_some(plane)
    }

    fn height(&self, at: Flat) -> f64 {
        self.through.height + self.rise.dot(self.through.at.to(at))
    }
}

/// Height at a place of the hull of some corners, of which those of `outline` bound it; what is outside of it has the height of a place near by.
///
/// It is the height of the triangle over the place that no corner is above: found as in the simplex method, from a triangle of the outline on.
fn height(outline: &[Corner], all: &[Corner], at: Flat, slack: f64) -> f64 {
    match outline {
        [] => 0.0,
        [only] => only.height,
        [one, other] => height_of_line([one, other], all, at),
        [first, rest @ ..] => {
            let fan = rest.windows(2).map(|pair| Triangle::new([*first, pair[0], pair[1]], at));
            let Some(mut triangle) = fan.reduce(|one, other| if other.inside > one.inside { other } else { one })
            else {
                return first.height;
            };
            // Every round raises the height, but for places on a side.
            for _ in 0..MOST_CORNERS {
                let above = |corner: &Corner| corner.height - triangle.height_at(corner.at);
                let highest = all.iter().reduce(|one, other| if above(other) > above(one) { other } else { one });
                let Some(corner) = highest.filter(|corner| above(corner) > slack) else { break };
                triangle = triangle.replaced_by(*corner, at);
            }
            triangle.height()
        }
    }
}

/// The same of corners on a line: the highest of all lines from one before the place to one behind it.
fn height_of_line([one, other]: [&Corner; 2], all: &[Corner], at: Flat) -> f64 {
    let way = one.at.to(other.at);
    let along = |p: Flat| way.dot(one.at.to(p)) / way.dot(way);
    let place = along(at).clamp(0.0, 1.0);
    let between = |p: &Corner, q: &Corner| {
        let (from, to) = (along(p.at), along(q.at));
        let spans = from <= place && to > place;
        spans.then(|| p.height + (q.height - p.height) * (place - from) / (to - from))
    };
    let whole = one.height + (other.height - one.height) * place;
    all.iter().flat_map(|p| all.iter().filter_map(move |q| between(p, q))).fold(whole, f64::max)
}

/// Three corners, and the weights that mix a place from them.
struct Triangle {
    corners: [Corner; 3],
    weights: [f64; 3],
    /// The least of the weights: negative where the place is outside.
    inside: f64,
}

impl Triangle {
    fn new(corners: [Corner; 3], at: Flat) -> Self {
        let weights = weights(&corners, at);
        let least = weights[0].min(weights[1]).min(weights[2]);
        // A triangle without area holds nothing.
        Self { corners, weights, inside: if least.is_finite() { least } else { f64::NEG_INFINITY } }
    }

    fn height_at(&self, at: Flat) -> f64 {
        let [a, b, c] = weights(&self.corners, at);
        self.corners[0].height * a + self.corners[1].height * b + self.corners[2].height * c
    }

    /// Over the place, or over the nearest of its sides.
    fn height(&self) -> f64 {
        let [a, b, c] = self.weights.map(|weight| weight.max(0.0));
        (self.corners[0].height * a + self.corners[1].height * b + self.corners[2].height * c) / (a + b + c)
    }

    /// With a corner more and the one less that leaves the place inside. What leaves has a weight in the new corner, beyond
    /// rounding: else the new triangle would have no area.
    fn replaced_by(&self, corner: Corner, at: Flat) -> Self {
        let mix = weights(&self.corners, corner.at);
        let ratio = |i: usize| if mix[i] > 1e-9 { self.weights[i].max(0.0) / mix[i] } else { f64::INFINITY };
        let leaving = (0..3).reduce(|i, j| if ratio(j) < ratio(i) { j } else { i }).unwrap_or(0);
        let mut corners = self.corners;
        corners[leaving] = corner;
        Self::new(corners, at)
    }
}

/// Weights of three corners, of sum 1, that mix a place from them.
fn weights(corners: &[Corner; 3], at: Flat) -> [f64; 3] {
    let (a, b, c) = (at.to(corners[0].at), at.to(corners[1].at), at.to(corners[2].at));
    let (of_a, of_b, of_c) = (b.cross(c), c.cross(a), a.cross(b));
    let area = of_a + of_b + of_c;
    [of_a / area, of_b / area, of_c / area]
}

#[cfg(test)]
mod tests {
    use super::super::flat_region::{Corners, holds, hull};
    use super::*;

    fn corner(x: f64, y: f64, height: f64) -> Corner {
        Corner { at: Flat { x, y }, height }
    }

    #[test]
    fn heights_are_those_of_the_planes_through_the_corners() {
        let slope = |x: f64, y: f64| 0.5 - 0.2 * x + 0.1 * y;
        let square = [(2.0, 2.0), (-2.0, 2.0), (-2.0, -2.0), (2.0, -2.0)];
        let corners = square.map(|(x, y)| corner(x, y, slope(x, y)));
        for i in 0..200 {
            let t = f64::from(i);
            let at = Flat { x: 2.0 * libm::sin(t), y: 2.0 * libm::cos(1.7 * t) };
            assert!((height(&corners, &corners, at, 1e-15) - slope(at.x, at.y)).abs() < 1e-15);
        }
    }

    /// Oracle: the greatest height of all triangles over the place.
    #[test]
    fn heights_of_a_roof_are_those_of_its_highest_triangles() {
        let bump = |x: f64, y: f64| -0.1 * x * x - 0.2 * y * y;
        for round in 0..40_u32 {
            let random = |k: u32| libm::sin(f64::from(round * 131 + k) * 12.9898) * 43_758.547 % 1.0;
            let all: Corners =
                (0..12).map(|k| (random(2 * k), random(2 * k + 1))).map(|(x, y)| corner(x, y, bump(x, y))).collect();
            let outline = hull(&all, 1e-15);
            for k in 0..20 {
                let at = Flat { x: 0.5 * random(100 + k), y: 0.5 * random(200 + k) };
                if !holds(&outline, at, -1e-6) {
                    continue;
                }
                let mut best = f64::NEG_INFINITY;
                for (i, p) in all.iter().enumerate() {
                    for (j, q) in all[..i].iter().enumerate() {
                        for r in &all[..j] {
                            let triangle = Triangle::new([*p, *q, *r], at);
                            if triangle.inside >= 0.0 {
                                best = best.max(triangle.height_at(at));
                            }
                        }
                    }
                }
                assert!((height(&outline, &all, at, 1e-15) - best).abs() < 1e-12, "{at:?}");
            }
        }
        let profile = [(0.0, 0.0), (1.0, 0.5), (2.0, 0.5), (3.0, 0.0)].map(|(x, h)| corner(x, 0.0, h));
        let over = |x: f64| height(&[profile[0], profile[3]], &profile, Flat { x, y: 0.1 }, 1e-15);
        assert_eq!([-1.0, 0.5, 1.5, 3.0].map(over), [0.0, 0.25, 0.5, 0.0]);
    }
}
