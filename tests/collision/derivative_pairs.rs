//! Pairs that tests of derivatives are about, and how their numbers are read.

use std::sync::Arc;

use clearance::geometry::{Compound, Part, Placement, Pose, Quaternion, Shape, TriangleMesh, Vec3};
use clearance::narrow_phase::{
    Accuracy, DerivativeGoal, DerivativeMethod, Derivatives, Goal, Separation, TwistMatrix, derivatives, separation,
};

/// SplitMix64 (Steele, Lea, Flood 2014).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    pub fn vector(&mut self, size: f64) -> Vec3 {
        Vec3::new(self.within(-size, size), self.within(-size, size), self.within(-size, size))
    }

    pub fn direction(&mut self) -> Vec3 {
        loop {
            let v = self.vector(1.0);
            if (0.01..=1.0).contains(&v.norm()) {
                return v.normalize();
            }
        }
    }

    pub fn rotation(&mut self) -> Quaternion {
        let v = [(); 4].map(|()| self.within(-1.0, 1.0));
        Quaternion { w: v[0] + 0.01, x: v[1], y: v[2], z: v[3] }
    }

    /// Standard normal, as the sum of twelve uniform numbers: other than the code's own.
    pub fn nearly_normal(&mut self) -> f64 {
        (0..12).map(|_| self.next()).sum::<f64>() - 6.0
    }
}

/// Kinds of shapes, some half a metre in size.
pub const KINDS: [&str; 15] = [
    "sphere",
    "ellipsoid",
    "swept ellipsoid",
    "box",
    "swept box",
    "hull",
    "swept hull",
    "capsule",
    "cylinder",
    "cone",
    "triangle",
    "mesh",
    "compound",
    "half-space",
    "plane",
];

pub fn is_wall(kind: usize) -> bool {
    kind >= 13
}

pub fn shape(kind: usize, random: &mut Random) -> Shape {
    let mut length = || random.within(0.2, 0.6);
    let (a, b, c) = (length(), length(), length());
    match KINDS[kind] {
        "sphere" => Shape::sphere(a).unwrap(),
        "ellipsoid" => Shape::ellipsoid(Vec3::new(a, b, c)).unwrap(),
        "swept ellipsoid" => Shape::ellipsoid(Vec3::new(a, b, c)).unwrap().swept(0.05).unwrap(),
        "box" => Shape::cuboid(Vec3::new(a, b, c)).unwrap(),
        "swept box" => Shape::cuboid(Vec3::new(a, b, c)).unwrap().swept(0.05).unwrap(),
        "hull" => hull(random, 40),
        "swept hull" => hull(random, 20).swept(0.05).unwrap(),
        "capsule" => Shape::capsule(a, b).unwrap(),
        "cylinder" => Shape::cylinder(a, b).unwrap(),
        "cone" => Shape::cone(a, b).unwrap(),
        "triangle" => Shape::triangle(random.vector(0.5), random.vector(0.5), random.vector(0.5)).unwrap(),
        "mesh" => octahedron(a, b, c),
        "compound" => {
            let at = |x: f64| Pose::new(Vec3::new(x, 0.0, 0.0), Quaternion::IDENTITY).unwrap();
            let ball = Part { pose: at(-a), shape: Shape::sphere(0.3).unwrap() };
            let block = Part { pose: at(a), shape: Shape::cuboid(Vec3::new(0.2, b, c)).unwrap() };
            Shape::compound(Arc::new(Compound::new(vec![ball, block]).unwrap()))
        }
        "half-space" => Shape::half_space(random.direction(), a).unwrap(),
        _ => Shape::plane(random.direction(), a).unwrap(),
    }
}

/// Corners on a sphere of half a metre.
pub fn hull(random: &mut Random, corners: usize) -> Shape {
    let points: Vec<Vec3> = (0..corners).map(|_| random.direction() * 0.5).collect();
    Shape::convex(&points).unwrap()
}

fn octahedron(a: f64, b: f64, c: f64) -> Shape {
    let (x, y, z) = (Vec3::x() * a, Vec3::y() * b, Vec3::z() * c);
    let ring = [x, y, -x, -y];
    let mut vertices = ring.to_vec();
    vertices.extend([z, -z]);
    let faces = (0..4).flat_map(|i| [[i, (i + 1) % 4, 4], [(i + 1) % 4, i, 5]]).collect();
    Shape::mesh(Arc::new(TriangleMesh::solid(vertices, faces).unwrap()))
}

/// As narrow as rounding lets brackets be.
pub fn goal() -> Goal<'static> {
    Goal { accuracy: Accuracy { absolute: 0.0, relative: 0.0 }, ..Goal::penetration() }
}

/// Two shapes in their places.
#[derive(Clone)]
pub struct Placed {
    pub shapes: [Shape; 2],
    pub at: [Placement; 2],
}

impl Placed {
    /// With a signed distance of about `gap`: moved along the normal until it is so; none where that does not lead there.
    pub fn new(random: &mut Random, shapes: [Shape; 2], gap: f64) -> Option<Self> {
        let at_a = Pose::new(random.vector(0.3), random.rotation()).unwrap().placement();
        let at_b = Pose::new(at_a.translation + random.vector(1.0), random.rotation()).unwrap().placement();
        let mut pair = Self { shapes, at: [at_a, at_b] };
        for _ in 0..40 {
            let found = pair.separation()?;
            let left = gap - found.signed_distance;
            if left.abs() < 1e-9 + 1e-3 * gap.abs() {
                return Some(pair);
            }
            pair.at[1].translation += found.normal * left;
            pair.at[1] = without_pose(pair.at[1]);
        }
        None
    }

    pub fn separation(&self) -> Option<Separation> {
        separation(&self.shapes[0], &self.shapes[1], &self.at[0], &self.at[1], &goal()).ok()
    }

    pub fn derivatives(&self, goal_: &DerivativeGoal) -> Derivatives {
        let found = self.separation().unwrap();
        derivatives(&self.shapes[0], &self.shapes[1], &self.at[0], &self.at[1], &found, goal_, &goal()).unwrap()
    }

    pub fn by(&self, method: DerivativeMethod) -> Derivatives {
        self.derivatives(&DerivativeGoal { method, ..DerivativeGoal::default() })
    }

    pub fn swapped(&self) -> Self {
        let ([a, b], [at_a, at_b]) = (self.shapes.clone(), self.at);
        Self { shapes: [b, a], at: [at_b, at_a] }
    }
}

/// Its translation was computed.
fn without_pose(at: Placement) -> Placement {
    Placement::computed(at.rotation, at.translation)
}

/// All numbers that derivatives are: 2 bodies, 6 columns, 10 quantities.
pub fn numbers(derivatives: &Derivatives) -> Vec<f64> {
    let column = |body: usize, column: usize| {
        let of = |m: &[TwistMatrix; 2]| m[body].column(column).iter().copied().collect::<Vec<f64>>();
        let mut all = vec![derivatives.signed_distance[body][column]];
        all.extend([&derivatives.normal, &derivatives.point_on_a, &derivatives.point_on_b].into_iter().flat_map(of));
        all
    };
    (0..12).flat_map(|n| column(n / 6, n % 6)).collect()
}

/// The largest difference of two lists.
pub fn difference(one: &[f64], other: &[f64]) -> f64 {
    one.iter()
        .zip(other)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, |most: f64, d| if d > most || d.is_nan() { d } else { most })
}
