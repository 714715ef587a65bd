//! Bounding volumes, and lower bounds of the distance of what is in two of them. No rounding is taken off: they are here to be
//! compared, not to prove.

use clearance::geometry::{Aabb, Mat3, OrientedBox, Placement, Vec3};

/// How the two meshes lie, and what is known of them so far.
pub struct Relation {
    /// B in A.
    pub place: Placement,
    /// From A to B at the nearest pair so far, in both frames.
    pub normal: Option<(Vec3, Vec3)>,
    /// Bounds above this are as good as any.
    pub threshold: f64,
}

pub trait Volume {
    const NAME: &'static str;
    type Context;
    fn context(place: &Placement) -> Self::Context;
    fn around(triangles: &[[Vec3; 3]]) -> Self;
    fn size(&self) -> f64;
    fn lower(a: &Self, b: &Self, relation: &Relation, context: &Self::Context) -> f64;
}

/// Boxes along the axes of the mesh, held against each other in both frames.
pub struct Upright {
    center: Vec3,
    half: Vec3,
}

impl Volume for Upright {
    const NAME: &'static str = "AABB";
    type Context = Mat3;

    fn context(place: &Placement) -> Mat3 {
        place.rotation.abs()
    }

    fn around(triangles: &[[Vec3; 3]]) -> Self {
        let bounds = Aabb::around(triangles.iter().flatten().copied());
        Self { center: bounds.center(), half: bounds.half_extents() }
    }

    fn size(&self) -> f64 {
        self.half.max()
    }

    fn lower(a: &Self, b: &Self, relation: &Relation, abs: &Mat3) -> f64 {
        let offset = relation.place.point(b.center) - a.center;
        let in_a = offset.abs() - a.half - abs * b.half;
        let in_b = relation.place.direction_into(offset).abs() - b.half - abs.tr_mul(&a.half);
        let bound = |gap: Vec3| if gap.max() <= 0.0 { gap.max() } else { gap.sup(&Vec3::zeros()).norm() };
        bound(in_a).max(bound(in_b))
    }
}

/// Along the face normals of both boxes; and `EDGES`: along the products of their edges, too.
fn along_axes<const EDGES: bool>(a: &OrientedBox, b: &OrientedBox, relation: &Relation) -> f64 {
    let turned = relation.place.rotation * b.axes;
    let offset = relation.place.point(b.center) - a.center;
    let r = a.axes.tr_mul(&turned);
    let (size, t) = (r.abs(), a.axes.tr_mul(&offset));
    let (h, g) = (a.half_extents, b.half_extents);
    let of_a = (t.abs() - h - size * g).max();
    let best = of_a.max((turned.tr_mul(&offset).abs() - g - size.tr_mul(&h)).max());
    if !EDGES || best > relation.threshold {
        return best;
    }
    let mut best = best;
    for i in 0..3 {
        let (i1, i2) = ((i + 1) % 3, (i + 2) % 3);
        for j in 0..3 {
            let (j1, j2) = ((j + 1) % 3, (j + 2) % 3);
            let square = 1.0 - r[(i, j)] * r[(i, j)];
            if square > 1e-9 {
                let reach =
                    h[i1] * size[(i2, j)] + h[i2] * size[(i1, j)] + g[j1] * size[(i, j2)] + g[j2] * size[(i, j1)];
                best = best.max(((t[i2] * r[(i1, j)] - t[i1] * r[(i2, j)]).abs() - reach) / square.sqrt());
            }
        }
    }
    best
}

/// Along a direction given in both frames.
fn along(a: &OrientedBox, b: &OrientedBox, relation: &Relation, (in_a, in_b): (Vec3, Vec3)) -> f64 {
    let offset = relation.place.point(b.center) - a.center;
    let reach = |b: &OrientedBox, n: Vec3| b.axes.tr_mul(&n).abs().dot(&b.half_extents);
    offset.dot(&in_a) - reach(a, in_a) - reach(b, in_b)
}

macro_rules! turned_box {
    ($name:ident, $text:literal, $lower:expr) => {
        pub struct $name(OrientedBox);

        impl Volume for $name {
            const NAME: &'static str = $text;
            type Context = ();

            fn context(_: &Placement) {}

            fn around(triangles: &[[Vec3; 3]]) -> Self {
                Self(OrientedBox::around(triangles))
            }

            fn size(&self) -> f64 {
                self.0.half_extents.max()
            }

            fn lower(a: &Self, b: &Self, relation: &Relation, (): &()) -> f64 {
                $lower(&a.0, &b.0, relation)
            }
        }
    };
}

turned_box!(Box6, "OBB, 6 axes", along_axes::<false>);
turned_box!(Box15, "OBB, 15 axes", along_axes::<true>);
turned_box!(BoxNear, "OBB, near points", near_points_then_axes);

/// Along the best normal so far, along the line between two near points, and only for boxes that may meet along the axes.
fn near_points_then_axes(a: &OrientedBox, b: &OrientedBox, relation: &Relation) -> f64 {
    if relation.threshold <= 0.0 {
        return along_axes::<false>(a, b, relation);
    }
    let by_normal = relation.normal.map_or(f64::NEG_INFINITY, |normal| along(a, b, relation, normal));
    if by_normal > relation.threshold {
        return by_normal;
    }
    let offset = relation.place.point(b.center) - a.center;
    let clamped = |x: Vec3, half: Vec3| x.sup(&-half).inf(&half);
    let on_a = a.axes * clamped(a.axes.tr_mul(&offset), a.half_extents);
    let from_b = b.axes.tr_mul(&relation.place.direction_into(on_a - offset));
    let across = b.axes * (clamped(from_b, b.half_extents) - from_b);
    let gap = match across.try_normalize(1e-100) {
        Some(n) => by_normal.max(along(a, b, relation, (relation.place.direction(n), n))),
        None => by_normal,
    };
    if gap > 0.0 { gap } else { gap.max(along_axes::<false>(a, b, relation)) }
}

/// A rectangle swept by a ball (Larsen, Gottschalk, Lin, Manocha 1999), with the same two directions as the boxes.
pub struct Rss {
    center: Vec3,
    sides: [Vec3; 2],
    half: [f64; 2],
    radius: f64,
}

impl Rss {
    fn reach(&self, n: Vec3) -> f64 {
        self.sides[0].dot(&n).abs() * self.half[0] + self.sides[1].dot(&n).abs() * self.half[1] + self.radius
    }

    /// The point of the rectangle nearest `offset`, both from its centre.
    fn nearest(&self, offset: Vec3) -> Vec3 {
        let along = |k: usize| self.sides[k] * offset.dot(&self.sides[k]).clamp(-self.half[k], self.half[k]);
        along(0) + along(1)
    }
}

impl Volume for Rss {
    const NAME: &'static str = "RSS";
    type Context = ();

    fn context(_: &Placement) {}

    fn around(triangles: &[[Vec3; 3]]) -> Self {
        // The box's thinnest axis is across the rectangle, which shrinks as far as the ball covers what sticks out.
        let bounds = OrientedBox::around(triangles);
        let thin = bounds.half_extents.imin();
        let sides = [1, 2].map(|k| bounds.axes.column((thin + k) % 3).into_owned());
        let radius = bounds.half_extents[thin];
        let full = [1, 2].map(|k| bounds.half_extents[(thin + k) % 3]);
        let offsets = || triangles.iter().flatten().map(|p| p - bounds.center);
        let mut half = [0, 1].map(|k: usize| {
            let needed = |p: Vec3| {
                let height = p.dot(&bounds.axes.column(thin));
                p.dot(&sides[k]).abs() - (radius * radius - height * height).max(0.0).sqrt()
            };
            offsets().map(needed).fold(0.0, f64::max).min(full[k])
        });
        loop {
            let volume = Self { center: bounds.center, sides, half, radius };
            if half == full || offsets().all(|p| (p - volume.nearest(p)).norm() <= radius) {
                return volume;
            }
            // Corners of the surface outside both slabs need more room.
            half = [0, 1].map(|k: usize| (half[k] + 0.02 * (radius + full[k])).min(full[k]));
        }
    }

    fn size(&self) -> f64 {
        self.half[0].max(self.half[1]) + self.radius
    }

    fn lower(a: &Self, b: &Self, relation: &Relation, (): &()) -> f64 {
        let offset = relation.place.point(b.center) - a.center;
        let along = |in_a: Vec3, in_b: Vec3| offset.dot(&in_a) - a.reach(in_a) - b.reach(in_b);
        let by_normal = relation.normal.map_or(f64::NEG_INFINITY, |(in_a, in_b)| along(in_a, in_b));
        if by_normal > relation.threshold {
            return by_normal;
        }
        let from_b = relation.place.direction_into(a.nearest(offset) - offset);
        let across = b.nearest(from_b) - from_b;
        across.try_normalize(1e-100).map_or(by_normal, |n| by_normal.max(along(relation.place.direction(n), n)))
    }
}

/// Polytopes of nine fixed pairs of faces (Klosowski et al. 1998): along axes and diagonals of squares.
pub struct Dop18 {
    low: [f64; 9],
    high: [f64; 9],
}

/// Up to three faces and weights: a direction of the other frame as their sum.
type Faces = [(usize, f64); 3];

/// What a pair of frames comes to: each direction of one frame by faces of the other.
pub struct Turned {
    /// B's reach along A's directions and against them, and A's along B's.
    of_b: [[Faces; 2]; 9],
    of_a: [[Faces; 2]; 9],
    offset_in_a: [f64; 9],
    offset_in_b: [f64; 9],
}

fn direction(k: usize) -> Vec3 {
    let [x, y, z] =
        [[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 0], [1, -1, 0], [1, 0, 1], [1, 0, -1], [0, 1, 1], [0, 1, -1]][k];
    Vec3::new(f64::from(x), f64::from(y), f64::from(z)).normalize()
}

/// Of all threes of faces around `d` the one with the least weights.
fn faces_around(d: Vec3) -> Faces {
    let face = |i: usize| if i.is_multiple_of(2) { direction(i / 2) } else { -direction(i / 2) };
    let mut best = ([(0, 0.0); 3], f64::INFINITY);
    for i in 0..18 {
        for j in 0..i {
            for k in 0..j {
                let Some(inverse) = Mat3::from_columns(&[face(i), face(j), face(k)]).try_inverse() else { continue };
                let w = inverse * d;
                if w.min() > -1e-12 && w.sum() < best.1 {
                    best = ([(i, w.x), (j, w.y), (k, w.z)], w.sum());
                }
            }
        }
    }
    best.0
}

impl Dop18 {
    fn reach(&self, faces: &Faces) -> f64 {
        let face = |i: usize| if i.is_multiple_of(2) { self.high[i / 2] } else { -self.low[i / 2] };
        faces.iter().map(|(i, weight)| face(*i) * weight).sum()
    }
}

impl Volume for Dop18 {
    const NAME: &'static str = "18-DOP";
    type Context = Turned;

    fn context(place: &Placement) -> Turned {
        let both = |d: Vec3| [faces_around(d), faces_around(-d)];
        Turned {
            of_b: std::array::from_fn(|k| both(place.direction_into(direction(k)))),
            of_a: std::array::from_fn(|k| both(place.direction(direction(k)))),
            offset_in_a: std::array::from_fn(|k| direction(k).dot(&place.translation)),
            offset_in_b: std::array::from_fn(|k| place.direction(direction(k)).dot(&place.translation)),
        }
    }

    fn around(triangles: &[[Vec3; 3]]) -> Self {
        let heights = |k: usize| triangles.iter().flatten().map(move |p| p.dot(&direction(k)));
        Self {
            low: std::array::from_fn(|k| heights(k).fold(f64::INFINITY, f64::min)),
            high: std::array::from_fn(|k| heights(k).fold(f64::NEG_INFINITY, f64::max)),
        }
    }

    fn size(&self) -> f64 {
        (0..3).map(|k| self.high[k] - self.low[k]).fold(0.0, f64::max)
    }

    fn lower(a: &Self, b: &Self, relation: &Relation, x: &Turned) -> f64 {
        let mut best = f64::NEG_INFINITY;
        for k in 0..9 {
            let [forth, back] = &x.of_b[k];
            best = best.max(x.offset_in_a[k] - b.reach(back) - a.high[k]);
            best = best.max(a.low[k] - x.offset_in_a[k] - b.reach(forth));
            let [forth, back] = &x.of_a[k];
            best = best.max(b.low[k] + x.offset_in_b[k] - a.reach(forth));
            best = best.max(-a.reach(back) - x.offset_in_b[k] - b.high[k]);
            if best > relation.threshold {
                break;
            }
        }
        best
    }
}
