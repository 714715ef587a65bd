//! A shape made of placed shapes.

use super::shape::Shape;
use super::{Aabb, Core, InvalidShape, Pose};

/// One part of a compound.
#[derive(Clone, Debug)]
pub struct Part {
    /// Bounded, and not itself a compound.
    pub shape: Shape,
    /// The part's frame in the compound's.
    pub pose: Pose,
}

/// The union of its parts. Distances to it are minima over the parts, so that depth in an overlap is the deepest
/// part's, not the length of a translation that frees the whole.
#[derive(Clone, Debug)]
pub struct Compound {
    parts: Vec<Part>,
    bounds: Aabb,
}

impl Compound {
    /// # Errors
    /// No parts; a part that is unbounded or a compound (write its parts out instead).
    pub fn new(parts: Vec<Part>) -> Result<Self, InvalidShape> {
        if parts.is_empty() {
            return Err(InvalidShape::Empty { field: "parts" });
        }
        let mut bounds = Aabb::empty();
        for (i, part) in parts.iter().enumerate() {
            if part.shape.is_empty() {
                let source = Box::new(InvalidShape::Empty { field: part.shape.kind() });
                return Err(InvalidShape::Part { part: i, source });
            }
            let placed = part.shape.placed_bounds(&part.pose.placement());
            let nested = matches!(part.shape.core(), Core::Compound(_));
            let (Some(placed), false) = (placed, nested) else {
                return Err(InvalidShape::NotAllowed {
                    field: format!("parts[{i}]"),
                    kind: part.shape.kind(),
                    role: "part of a compound",
                });
            };
            bounds = bounds.union(&placed);
        }
        Ok(Self { parts, bounds })
    }

    /// The parts, in the order given.
    #[must_use]
    pub fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// Bounds in the compound's frame.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Bytes on the heap, those of hulls included; meshes and other shared parts are not counted.
    #[must_use]
    pub fn memory(&self) -> usize {
        let hull = |part: &Part| if let Core::Convex(hull) = part.shape.core() { hull.memory() } else { 0 };
        size_of_val(&*self.parts) + self.parts.iter().map(hull).sum::<usize>()
    }

    /// Every length multiplied by `factor`.
    pub(super) fn scaled(&self, factor: f64) -> Result<Self, InvalidShape> {
        let part = |(i, p): (usize, &Part)| {
            let shape = p.shape.scaled(factor).map_err(|e| InvalidShape::Part { part: i, source: Box::new(e) })?;
            let pose = Pose::new(p.pose.translation() * factor, p.pose.rotation())
                .map_err(|source| InvalidShape::Pose { field: format!("parts[{i}].pose"), source })?;
            Ok(Part { shape, pose })
        };
        Self::new(self.parts.iter().enumerate().map(part).collect::<Result<_, InvalidShape>>()?)
    }
}
