//! The door of the oracle: which way leads to the truth about a pair.

use super::body::{Body, Core, Turned};
use super::difference::{Bounds, Difference, ROUNDING};
use super::double_double::Dd;
use super::expanding_polytope::expand;
use super::nearest_point::nearest_point;
use super::vector::{DdVector, Vector};

/// The signed distance is between these. Metres.
#[derive(Clone, Copy, Debug)]
pub struct Truth {
    pub lower: Dd,
    pub upper: Dd,
    /// The unit direction from A to B that proves `lower`, world axes.
    pub normal: [f64; 3],
    /// Sum of what the shapes reach and of the distance of their origins, at most doubled. Metres.
    pub size: f64,
}

impl Truth {
    pub fn width(&self) -> f64 {
        (self.upper - self.lower).hi
    }

    /// The nearest double to the middle.
    pub fn value(&self) -> f64 {
        ((self.upper + self.lower) * Dd::from(0.5)).hi
    }
}

/// The signed distance of two bodies of which at most one is unbounded, to `wanted` metres if double-doubles can tell, with
/// at most `most` vertices on the polytope of an overlap.
pub fn truth(a: &Body, b: &Body, wanted: f64, most: usize) -> Truth {
    match (&a.core, &b.core) {
        (_, Core::HalfSpace { normal, offset, thin }) => against_half_space(a, b, *normal, *offset, *thin),
        (Core::HalfSpace { normal, offset, thin }, _) => {
            let found = against_half_space(b, a, *normal, *offset, *thin);
            Truth { normal: found.normal.map(|c| -c), ..found }
        }
        _ => bounded(a, b, wanted, most),
    }
}

fn bounded(a: &Body, b: &Body, wanted: f64, most: usize) -> Truth {
    let difference = Difference::new(a, b);
    let scale = difference.scale;
    let wanted = (wanted * scale).max(8.0 * ROUNDING);
    let mut bounds = nearest_point(&difference, wanted);
    if bounds.width() > wanted {
        bounds = expand(&difference, bounds, wanted, most);
    }
    from_scaled(&bounds, a, b, scale)
}

fn from_scaled(bounds: &Bounds, a: &Body, b: &Body, scale: f64) -> Truth {
    let radii = a.swept_radius + b.swept_radius;
    let rounding = Dd::from(radii.hi * ROUNDING + f64::MIN_POSITIVE);
    let metres = |bound: Dd| Dd { hi: bound.hi / scale, lo: bound.lo / scale };
    Truth {
        lower: metres(bounds.lower) - radii - rounding,
        upper: metres(bounds.upper) - radii + rounding,
        normal: bounds.direction.to_doubles().map(|c| -c),
        size: 2.0 / scale + radii.hi,
    }
}

/// `n . a - offset/|normal|` at the lowest point of A, less the swept radii; from a plane, on the side A sticks out less.
fn against_half_space(a: &Body, b: &Body, normal: [f64; 3], offset: f64, thin: bool) -> Truth {
    // The plane's equation may be of any length: a power of two brings it near 1.
    let largest = normal.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
    let half = libm::exp2((-libm::log2(largest) / 2.0).floor());
    let local = DdVector::from_doubles(normal.map(|c| c * half * half));
    let offset = Dd::from(offset * half * half) / local.norm();
    let rows = super::body::rotation_matrix(b.rotation);
    let unit = local.unit().expect("a plane's normal is not zero");
    let up = Vector([rows[0].dot(&unit), rows[1].dot(&unit), rows[2].dot(&unit)]);
    let shift = Vector([0, 1, 2].map(|i| Dd::difference(a.translation[i], b.translation[i])));
    let turned = Turned::new(&a.core, a.rotation, 1.0);
    let height = |d: &DdVector| up.dot(&(turned.support(d) + shift)) - offset;
    let (below, above) = (height(&-up), -height(&up));
    let (value, towards_b) = if thin && above > below { (above, up) } else { (below, -up) };
    let radii = a.swept_radius + b.swept_radius;
    let size = a.core.reach() + shift.0.iter().map(|c| c.hi.abs()).sum::<f64>() + offset.hi.abs() + radii.hi;
    let rounding = Dd::from(size * ROUNDING);
    Truth { lower: value - radii - rounding, upper: value - radii + rounding, normal: towards_b.to_doubles(), size }
}
