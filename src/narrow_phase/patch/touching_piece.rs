//! The convex or unbounded piece of a shape that a separation names, seen from the witness point.

use std::borrow::Cow;

use super::super::trees::is_tree;
use super::contact_patch::NoPatch;
use crate::geometry::{Cells, Core, Mat3, Placement, Shape, Vec3, Voxels};

/// A core with its place. Lengths are metres.
pub(in super::super) struct TouchingPiece<'a> {
    pub core: Cow<'a, Core>,
    pub swept_radius: f64,
    /// From the core's axes to those of both placements.
    pub rotation: Mat3,
    /// From the witness point to the core's origin, in the axes of both placements.
    pub position: Vec3,
    /// Whether that is so: of a cloud's point only the number is known.
    pub is_placed: bool,
}

impl<'a> TouchingPiece<'a> {
    /// `number`: the subshape of the separation. Differences to the witness are taken before anything else, so that a pair far from the
    /// origin is as accurate as one near it.
    pub fn of(shape: &'a Shape, number: u32, at: &Placement, witness: Vec3) -> Result<Self, NoPatch> {
        let missing = || NoPatch::NotOnePiece { kind: shape.kind(), subshape: number };
        let origin = at.translation - witness;
        let is_placed = !matches!(shape.core(), Core::PointCloud(_));
        let alone =
            |core, swept_radius| Self { core, swept_radius, rotation: at.rotation, position: origin, is_placed };
        let Core::Compound(compound) = shape.core() else {
            return Ok(alone(leaf(shape.core(), number).ok_or_else(missing)?, shape.swept_radius()));
        };
        let part = compound.parts().get(number as usize).ok_or_else(missing)?;
        let core = Some(part.shape.core()).filter(|core| !is_tree(core)).ok_or_else(missing)?;
        let inner = part.pose.placement();
        Ok(Self {
            rotation: at.rotation * inner.rotation,
            position: at.direction(inner.translation) + origin,
            ..alone(Cow::Borrowed(core), part.shape.swept_radius() + shape.swept_radius())
        })
    }
}

/// Without bounds: flat everywhere.
pub(in super::super) fn is_wall(core: &Core) -> bool {
    matches!(core, Core::HalfSpace { .. } | Core::Plane { .. })
}

/// What is in the leaf with that number; none where there is no such leaf, and of compounds.
fn leaf(core: &Core, number: u32) -> Option<Cow<'_, Core>> {
    let index = number as usize;
    match core {
        Core::Mesh(mesh) => (index < mesh.triangles().len()).then(|| Cow::Owned(Core::Triangle(mesh.triangle(index)))),
        Core::HeightField(field) => {
            let grid = field.grid();
            let columns = 2 * u64::from(grid.rows - 1) * u64::from(grid.columns - 1);
            (u64::from(number) < columns).then(|| Cow::Owned(Core::Column(field.column(number))))
        }
        // To look for the point is not worth it: a ball touches at its witness.
        Core::PointCloud(cloud) => (index < cloud.len()).then_some(Cow::Owned(Core::Point)),
        Core::Voxels(map) => cell(map, number).map(|cell| Cow::Owned(Core::Block(map.box_of(cell)))),
        Core::Compound(_) => None,
        Core::Point
        | Core::Cuboid { .. }
        | Core::AxialSegment { .. }
        | Core::Cylinder { .. }
        | Core::Cone { .. }
        | Core::Ellipsoid { .. }
        | Core::Convex(_)
        | Core::Triangle(_)
        | Core::Segment(_)
        | Core::HalfSpace { .. }
        | Core::Plane { .. }
        | Core::Column(_)
        | Core::Block(_) => Some(Cow::Borrowed(core)),
    }
}

/// The cell with that number, found by halving the map.
fn cell(map: &Voxels, number: u32) -> Option<[i32; 3]> {
    let mut cells: Cells = map.root()?;
    while let Some([lower, upper]) = cells.halves() {
        cells = if number < upper.first().1 { lower } else { upper };
    }
    let (cell, found) = cells.first();
    (found == number).then_some(cell)
}
