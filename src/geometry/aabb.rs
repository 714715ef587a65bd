//! Axis-aligned boxes: what the trees are made of.

use super::Vec3;

/// The closed box `min..=max`, metres. A box with `min > max` in some axis holds nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Least corner.
    pub min: Vec3,
    /// Greatest corner.
    pub max: Vec3,
}

impl Aabb {
    /// The box that holds nothing: the neutral element of [`Aabb::union`].
    #[must_use]
    pub fn empty() -> Self {
        Self { min: Vec3::repeat(f64::INFINITY), max: Vec3::repeat(f64::NEG_INFINITY) }
    }

    /// The least box that holds all `points`.
    #[must_use]
    pub fn around(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::empty(), |aabb, p| Self { min: aabb.min.inf(&p), max: aabb.max.sup(&p) })
    }

    /// The box of that centre and half extents.
    #[must_use]
    pub fn centred(center: Vec3, half_extents: Vec3) -> Self {
        Self { min: center - half_extents, max: center + half_extents }
    }

    /// The least box that holds both.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self { min: self.min.inf(&other.min), max: self.max.sup(&other.max) }
    }

    /// Whether the closed boxes have a point in common.
    #[must_use]
    pub fn overlaps(&self, other: &Self) -> bool {
        self.min.x <= other.max.x
            && other.min.x <= self.max.x
            && self.min.y <= other.max.y
            && other.min.y <= self.max.y
            && self.min.z <= other.max.z
            && other.min.z <= self.max.z
    }

    /// Whether every point of `other` is in this box.
    #[must_use]
    pub fn contains(&self, other: &Self) -> bool {
        self.min.x <= other.min.x
            && self.min.y <= other.min.y
            && self.min.z <= other.min.z
            && other.max.x <= self.max.x
            && other.max.y <= self.max.y
            && other.max.z <= self.max.z
    }

    /// The box grown by `distance` metres on every side.
    #[must_use]
    pub fn grown(&self, distance: f64) -> Self {
        Self { min: self.min.add_scalar(-distance), max: self.max.add_scalar(distance) }
    }

    /// Its eight corners: the greatest coordinate where bit 0 (x), 1 (y) or 2 (z) of the place is set.
    #[must_use]
    pub fn corners(&self) -> [Vec3; 8] {
        std::array::from_fn(|i| {
            let pick = |axis: usize| if i >> axis & 1 == 1 { self.max[axis] } else { self.min[axis] };
            Vec3::new(pick(0), pick(1), pick(2))
        })
    }

    /// Centre, metres.
    #[must_use]
    pub fn center(&self) -> Vec3 {
        0.5 * self.min + 0.5 * self.max
    }

    /// Half the side lengths, metres.
    #[must_use]
    pub fn half_extents(&self) -> Vec3 {
        0.5 * self.max - 0.5 * self.min
    }

    /// Half the surface: the cost measure of the surface-area heuristic.
    #[must_use]
    pub fn half_area(&self) -> f64 {
        let d = self.max - self.min;
        d.x * d.y + d.y * d.z + d.z * d.x
    }

    /// Distance between the closed boxes, metres; zero when they overlap.
    #[must_use]
    pub fn distance(&self, other: &Self) -> f64 {
        let gap = (self.min - other.max).sup(&(other.min - self.max)).sup(&Vec3::zeros());
        gap.norm()
    }
}
