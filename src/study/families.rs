//! Which pairs of shapes? Families of them, turned at random, a given distance apart on a random line of approach.

use crate::geometry::{InvalidShape, Placement, Pose, Quaternion, Shape, Vec3};
use crate::narrow_phase::{Goal, separation};

use super::random::Random;

/// A kind of pair, bodies of about a metre.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Family {
    Box,
    Hull(usize),
    Capsule,
    Ellipsoid,
    BallAndHull,
    CylinderAndCone,
}

/// Two placed shapes.
#[derive(Clone, Debug)]
pub(super) struct Pair {
    pub a: Shape,
    pub b: Shape,
    pub at_a: Placement,
    pub at_b: Placement,
    /// Where B was a moment ago: turned by half a degree, and farther by a hundredth of what it is apart.
    pub before: Placement,
    /// Sizes of both and the distance of their origins, metres: what rounding errors grow with.
    pub extent: f64,
}

impl Family {
    pub const ALL: [Self; 9] = [
        Self::Box,
        Self::Hull(8),
        Self::Hull(64),
        Self::Hull(250),
        Self::Hull(940),
        Self::BallAndHull,
        Self::Capsule,
        Self::CylinderAndCone,
        Self::Ellipsoid,
    ];

    pub fn name(self) -> String {
        match self {
            Self::Box => "boxes".to_owned(),
            Self::Hull(corners) => format!("hulls of {corners}"),
            Self::Capsule => "capsules".to_owned(),
            Self::Ellipsoid => "ellipsoids".to_owned(),
            Self::BallAndHull => "ball and hull of 250".to_owned(),
            Self::CylinderAndCone => "cylinder and cone".to_owned(),
        }
    }

    /// Corners of each, where it has many.
    pub fn corners(self) -> usize {
        match self {
            Self::Hull(corners) => corners,
            Self::BallAndHull => 250,
            Self::Box | Self::Capsule | Self::Ellipsoid | Self::CylinderAndCone => 8,
        }
    }

    fn shapes(self, random: &mut Random) -> Result<[Shape; 2], InvalidShape> {
        Ok(match self {
            Self::Box => [Shape::cuboid(random.radii())?, Shape::cuboid(random.radii())?],
            Self::Ellipsoid => [Shape::ellipsoid(random.radii())?, Shape::ellipsoid(random.radii())?],
            Self::Hull(corners) => [hull(corners, random)?, hull(corners, random)?],
            Self::BallAndHull => [Shape::sphere(random.between(0.3, 1.0))?, hull(250, random)?],
            Self::Capsule => {
                let [a, b] = [random.radii(), random.radii()];
                [Shape::capsule(0.3 * a.x, a.y)?, Shape::capsule(0.3 * b.x, b.y)?]
            }
            Self::CylinderAndCone => {
                let [a, b] = [random.radii(), random.radii()];
                [Shape::cylinder(a.x, a.y)?, Shape::cone(b.x, b.y)?]
            }
        })
    }

    /// Pairs whose signed distance is `gap` metres, to a billionth.
    pub fn pairs(self, gap: f64, count: usize, random: &mut Random) -> Vec<Pair> {
        let tries = std::iter::repeat_with(|| self.pair(gap, random));
        // One line of approach in a few passes by; a bound all the same, so that this ends whatever happens.
        tries.take(100 * count).flatten().take(count).collect()
    }

    /// None when the line of approach passes by.
    fn pair(self, gap: f64, random: &mut Random) -> Option<Pair> {
        let [a, b] = self.shapes(random).ok()?;
        let at_a = placed(Vec3::zeros(), random.rotation())?;
        let (turn, approach) = (random.rotation(), random.direction());
        let mut far = 4.0;
        // Newton's method: along a line the signed distance is convex, and its slope is the normal's share of the line.
        for _ in 0..40 {
            let at_b = placed(approach * far, turn)?;
            let found = separation(&a, &b, &at_a, &at_b, &Goal::penetration()).ok()?;
            let step = (found.signed_distance - gap) / found.normal.dot(&approach);
            if step.abs() < 1e-9 {
                let slightly = Quaternion::about_axis(approach, 0.5_f64.to_radians());
                let before = placed(approach * (far + 0.01 * gap.abs()), slightly.compose(turn))?;
                let extent = radius(&a) + radius(&b) + far;
                return Some(Pair { a, b, at_a, at_b, before, extent });
            }
            far -= step;
            if !(0.0..4.0).contains(&far) {
                return None;
            }
        }
        None
    }
}

/// A pose as a placement; none for numbers that are no pose.
pub(super) fn placed(translation: Vec3, rotation: Quaternion) -> Option<Placement> {
    Pose::new(translation, rotation).ok().map(|pose| pose.placement())
}

/// Of a ball about the origin that holds the shape.
pub(super) fn radius(shape: &Shape) -> f64 {
    shape.bounds().map_or(0.0, |bounds| bounds.corners().iter().map(Vec3::norm).fold(0.0, f64::max))
}

/// The hull of so many points on an ellipsoid.
pub(super) fn hull(corners: usize, random: &mut Random) -> Result<Shape, InvalidShape> {
    let radii = random.radii();
    let points: Vec<Vec3> = (0..corners).map(|_| random.direction().component_mul(&radii)).collect();
    Shape::convex(&points)
}
