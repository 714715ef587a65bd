//! One placed shape twice: as the library takes it, and as the numbers the oracle reads.

use clearance::geometry::{Placement, Pose, Quaternion, Shape, Vec3};
use clearance::narrow_phase::{Goal, PairCache, Separation, separation, separation_again};

use crate::oracle::double_double::Dd;
use crate::oracle::{Body, Core};

#[derive(Clone, Debug)]
pub struct Specimen {
    pub shape: Shape,
    pub pose: Pose,
    pub body: Body,
}

/// A shape that is not placed yet.
#[derive(Clone, Debug)]
pub struct Form {
    pub shape: Shape,
    pub core: Core,
    pub swept_radius: Dd,
}

fn vector(p: [f64; 3]) -> Vec3 {
    Vec3::from(p)
}

/// Every constructor takes what the library's constructor of that name takes; `None` where that refuses it.
impl Form {
    fn new(shape: Shape, core: Core, radius: f64) -> Option<Self> {
        Some(Self { shape, core, swept_radius: Dd::from(radius) })
    }

    pub fn sphere(radius: f64) -> Option<Self> {
        Self::new(Shape::sphere(radius).ok()?, Core::Hull(vec![[0.0; 3]]), radius)
    }

    pub fn point() -> Option<Self> {
        Self::new(Shape::point(), Core::Hull(vec![[0.0; 3]]), 0.0)
    }

    pub fn cuboid(half: [f64; 3]) -> Option<Self> {
        Self::new(Shape::cuboid(vector(half)).ok()?, Core::Cuboid(half), 0.0)
    }

    pub fn capsule(radius: f64, half_length: f64) -> Option<Self> {
        let ends = vec![[0.0, 0.0, -half_length], [0.0, 0.0, half_length]];
        Self::new(Shape::capsule(radius, half_length).ok()?, Core::Hull(ends), radius)
    }

    pub fn cylinder(radius: f64, half_length: f64) -> Option<Self> {
        Self::new(Shape::cylinder(radius, half_length).ok()?, Core::Cylinder { radius, half_length }, 0.0)
    }

    pub fn cone(radius: f64, half_length: f64) -> Option<Self> {
        Self::new(Shape::cone(radius, half_length).ok()?, Core::Cone { radius, half_length }, 0.0)
    }

    pub fn ellipsoid(radii: [f64; 3]) -> Option<Self> {
        Self::new(Shape::ellipsoid(vector(radii)).ok()?, Core::Ellipsoid(radii), 0.0)
    }

    pub fn convex(points: &[[f64; 3]]) -> Option<Self> {
        let cloud: Vec<Vec3> = points.iter().copied().map(vector).collect();
        Self::new(Shape::convex(&cloud).ok()?, Core::Hull(points.to_vec()), 0.0)
    }

    pub fn triangle(corners: [[f64; 3]; 3]) -> Option<Self> {
        let [a, b, c] = corners.map(vector);
        Self::new(Shape::triangle(a, b, c).ok()?, Core::Hull(corners.to_vec()), 0.0)
    }

    pub fn segment(ends: [[f64; 3]; 2]) -> Option<Self> {
        let [a, b] = ends.map(vector);
        Self::new(Shape::segment(a, b).ok()?, Core::Hull(ends.to_vec()), 0.0)
    }

    pub fn half_space(normal: [f64; 3], offset: f64) -> Option<Self> {
        let core = Core::HalfSpace { normal, offset, thin: false };
        Self::new(Shape::half_space(vector(normal), offset).ok()?, core, 0.0)
    }

    pub fn plane(normal: [f64; 3], offset: f64) -> Option<Self> {
        let core = Core::HalfSpace { normal, offset, thin: true };
        Self::new(Shape::plane(vector(normal), offset).ok()?, core, 0.0)
    }

    pub fn swept(self, extra: f64) -> Option<Self> {
        let shape = self.shape.swept(extra).ok()?;
        Some(Self { shape, swept_radius: self.swept_radius + Dd::from(extra), ..self })
    }

    /// At `translation + R(q/|q|) p`, q = (w, x, y, z).
    pub fn placed(self, translation: [f64; 3], rotation: [f64; 4]) -> Option<Specimen> {
        let [w, x, y, z] = rotation;
        let pose = Pose::new(vector(translation), Quaternion { w, x, y, z }).ok()?;
        let body = Body { core: self.core, swept_radius: self.swept_radius, translation, rotation };
        Some(Specimen { shape: self.shape, pose, body })
    }
}

impl Specimen {
    pub fn placement(&self) -> Placement {
        self.pose.placement()
    }

    /// The same shape elsewhere, turned as before.
    pub fn moved_to(&self, translation: [f64; 3]) -> Self {
        let pose = Pose::new(vector(translation), self.pose.rotation()).expect("a finite place");
        Self { pose, body: Body { translation, ..self.body.clone() }, shape: self.shape.clone() }
    }
}

/// What the library says of a pair that is not two unbounded shapes.
pub fn ask(a: &Specimen, b: &Specimen, goal: &Goal) -> Separation {
    separation(&a.shape, &b.shape, &a.placement(), &b.placement(), goal).expect("one of them has bounds")
}

/// The same from where `cache` was left.
pub fn ask_again(a: &Specimen, b: &Specimen, goal: &Goal, cache: &mut PairCache) -> Separation {
    separation_again(&a.shape, &b.shape, &a.placement(), &b.placement(), goal, cache).expect("one of them has bounds")
}
