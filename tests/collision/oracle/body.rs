//! A shape and its pose as the numbers that define it, apart from the library's own types: what the oracles read.

use super::double_double::Dd;
use super::vector::{DdVector, Vector};

/// The convex kinds, before a ball is swept over them. Lengths in metres, frame of the shape; axes along z, centred.
#[derive(Clone, Debug)]
pub enum Core {
    /// Half extents of a box.
    Cuboid([f64; 3]),
    Cylinder {
        radius: f64,
        half_length: f64,
    },
    /// Apex at `+half_length`.
    Cone {
        radius: f64,
        half_length: f64,
    },
    /// Semi-axes.
    Ellipsoid([f64; 3]),
    /// The convex hull of one or more points: a point, a segment, a triangle, a hull.
    Hull(Vec<[f64; 3]>),
    /// `{ x : normal . x <= offset }`, or its boundary alone.
    HalfSpace {
        normal: [f64; 3],
        offset: f64,
        thin: bool,
    },
}

/// A core with a ball swept over it, in its place: the point p is at `translation + R(q/|q|) p`, q = (w, x, y, z).
#[derive(Clone, Debug)]
pub struct Body {
    pub core: Core,
    /// Exactly the sum of a shape's own radius and what was added to it.
    pub swept_radius: Dd,
    pub translation: [f64; 3],
    pub rotation: [f64; 4],
}

impl Core {
    pub fn is_bounded(&self) -> bool {
        !matches!(self, Self::HalfSpace { .. })
    }

    /// The corners, if it is a polytope.
    pub fn corners(&self) -> Option<Vec<[f64; 3]>> {
        match self {
            Self::Cuboid([x, y, z]) => {
                let sign = |bit: usize, size: f64| if bit & 1 == 1 { size } else { -size };
                Some((0..8).map(|i| [sign(i, *x), sign(i >> 1, *y), sign(i >> 2, *z)]).collect())
            }
            Self::Hull(points) => Some(points.clone()),
            Self::Cylinder { .. } | Self::Cone { .. } | Self::Ellipsoid(_) | Self::HalfSpace { .. } => None,
        }
    }

    /// Upper bound of the distance of its points from its own origin, within a factor of two. Metres.
    pub fn reach(&self) -> f64 {
        let largest = |v: &[f64; 3]| v.iter().map(|c| c.abs()).sum();
        match self {
            Self::Cuboid(half) => largest(half),
            Self::Cylinder { radius, half_length } | Self::Cone { radius, half_length } => radius + half_length,
            Self::Ellipsoid(radii) => radii.iter().copied().fold(0.0, f64::max),
            Self::Hull(points) => points.iter().map(largest).fold(0.0, f64::max),
            Self::HalfSpace { .. } => 0.0,
        }
    }
}

/// R(q/|q|) by rows, to about 1e-31: quotients of quadratic forms in q, which is first brought near norm 1 by a power
/// of two.
pub fn rotation_matrix(q: [f64; 4]) -> [DdVector; 3] {
    let largest = q.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
    // In two steps, because the power may be beyond the doubles.
    let half = libm::exp2((-libm::log2(largest) / 2.0).floor());
    let [w, x, y, z] = q.map(|c| Dd::from(c * half * half));
    let norm = w * w + x * x + y * y + z * z;
    let two = Dd::from(2.0);
    let row = |c: [Dd; 3]| Vector(c.map(|c| c / norm));
    [
        row([w * w + x * x - y * y - z * z, two * (x * y - w * z), two * (x * z + w * y)]),
        row([two * (x * y + w * z), w * w - x * x + y * y - z * z, two * (y * z - w * x)]),
        row([two * (x * z - w * y), two * (y * z + w * x), w * w - x * x - y * y + z * z]),
    ]
}

/// A bounded core turned into world axes and scaled, still about its own origin.
pub struct Turned {
    rows: [DdVector; 3],
    columns: [DdVector; 3],
    form: Form,
}

enum Form {
    Points { exact: Vec<DdVector>, rounded: Vec<[f64; 3]>, reach: f64 },
    Cylinder { radius: Dd, half_length: Dd },
    Cone { radius: Dd, half_length: Dd },
    Ellipsoid([Dd; 3]),
}

impl Turned {
    /// `scale` is a power of two.
    pub fn new(core: &Core, rotation: [f64; 4], scale: f64) -> Self {
        let rows = rotation_matrix(rotation);
        let columns = [0, 1, 2].map(|i| Vector([rows[0].0[i], rows[1].0[i], rows[2].0[i]]));
        let scaled = |x: f64| Dd::from(x * scale);
        let form = match core {
            Core::Cylinder { radius, half_length } => {
                Form::Cylinder { radius: scaled(*radius), half_length: scaled(*half_length) }
            }
            Core::Cone { radius, half_length } => {
                Form::Cone { radius: scaled(*radius), half_length: scaled(*half_length) }
            }
            Core::Ellipsoid(radii) => Form::Ellipsoid(radii.map(scaled)),
            Core::Cuboid(_) | Core::Hull(_) => {
                let corners = core.corners().expect("a polytope has corners");
                let turn = |p: &[f64; 3]| {
                    let p = Vector(p.map(scaled));
                    Vector([rows[0].dot(&p), rows[1].dot(&p), rows[2].dot(&p)])
                };
                let exact: Vec<DdVector> = corners.iter().map(turn).collect();
                let rounded = exact.iter().map(|p| p.to_doubles()).collect();
                Form::Points { exact, rounded, reach: core.reach() * scale }
            }
            Core::HalfSpace { .. } => unreachable!("a half-space has no support points"),
        };
        Self { rows, columns, form }
    }

    /// A point of the core where `d . x` is greatest. |d| is about 1.
    pub fn support(&self, d: &DdVector) -> DdVector {
        let local = || [0, 1, 2].map(|i| self.columns[i].dot(d));
        let world = |p: [Dd; 3]| {
            let p = Vector(p);
            Vector([self.rows[0].dot(&p), self.rows[1].dot(&p), self.rows[2].dot(&p)])
        };
        match &self.form {
            Form::Points { exact, rounded, reach } => farthest(exact, rounded, *reach, d),
            Form::Cylinder { radius, half_length } => {
                let l = local();
                let [x, y] = rim(*radius, l);
                world([x, y, if l[2] < Dd::ZERO { -*half_length } else { *half_length }])
            }
            Form::Cone { radius, half_length } => {
                let l = local();
                let [x, y] = rim(*radius, l);
                // The apex has the value h d_z, the rim r |d_xy| - h d_z.
                let on_rim = l[0] * x + l[1] * y - *half_length * l[2];
                if *half_length * l[2] >= on_rim {
                    world([Dd::ZERO, Dd::ZERO, *half_length])
                } else {
                    world([x, y, -*half_length])
                }
            }
            Form::Ellipsoid(radii) => {
                let l = local();
                let stretched = Vector([0, 1, 2].map(|i| radii[i] * l[i]));
                match stretched.unit() {
                    Some(u) => world([0, 1, 2].map(|i| radii[i] * u.0[i])),
                    None => DdVector::ZERO,
                }
            }
        }
    }
}

/// The point of the circle of that radius farthest along the direction.
fn rim(radius: Dd, [x, y, _]: [Dd; 3]) -> [Dd; 2] {
    match Vector([x, y, Dd::ZERO]).unit() {
        Some(u) => [radius * u.0[0], radius * u.0[1]],
        None => [Dd::ZERO; 2],
    }
}

/// Looks at every point: in doubles at all of them, in double-doubles at those that doubles cannot tell from the best.
fn farthest(exact: &[DdVector], rounded: &[[f64; 3]], reach: f64, d: &DdVector) -> DdVector {
    let [x, y, z] = d.to_doubles();
    let value = |p: &[f64; 3]| p[0] * x + p[1] * y + p[2] * z;
    let greatest = rounded.iter().map(value).fold(f64::NEG_INFINITY, f64::max);
    let least = greatest - 64.0 * f64::EPSILON * reach;
    let mut best: Option<(Dd, &DdVector)> = None;
    for (p, rounded) in exact.iter().zip(rounded) {
        if value(rounded) >= least {
            let found = d.dot(p);
            if best.is_none_or(|(most, _)| found > most) {
                best = Some((found, p));
            }
        }
    }
    best.map_or(exact[0], |(_, p)| *p)
}
