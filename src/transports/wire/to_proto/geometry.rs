//! Shapes and poses.

use super::little_endian;
use crate::geometry::{Aabb, Core, HeightField, Part, Pose, Shape, TriangleMesh, Vec3};
use crate::transports::wire::v1;

pub(super) fn vec3(v: Vec3) -> v1::Vec3 {
    v1::Vec3 { x: v.x, y: v.y, z: v.z }
}

pub(super) fn aabb(bounds: &Aabb) -> v1::Aabb {
    v1::Aabb { min: Some(vec3(bounds.min)), max: Some(vec3(bounds.max)) }
}

/// A pose.
#[must_use]
pub fn pose(pose: &Pose) -> v1::Pose {
    let q = pose.rotation();
    v1::Pose {
        translation: Some(vec3(pose.translation())),
        rotation: Some(v1::Quaternion { w: q.w, x: q.x, y: q.y, z: q.z }),
    }
}

/// A shape with all its points and triangles.
#[must_use]
pub fn shape(shape: &Shape) -> v1::Shape {
    use v1::shape::Core as Wire;
    let swept_radius = shape.swept_radius();
    let core = match shape.core() {
        Core::Point => Wire::Point(v1::Point {}),
        Core::Cuboid { half_extents } => Wire::Box(v1::Box { half_extents: Some(vec3(*half_extents)) }),
        // The ball of a capsule is its swept radius.
        &Core::AxialSegment { half_length } => Wire::Capsule(v1::Capsule { radius: 0.0, half_length }),
        &Core::Cylinder { radius, half_length } => Wire::Cylinder(v1::Cylinder { radius, half_length }),
        &Core::Cone { radius, half_length } => Wire::Cone(v1::Cone { radius, half_length }),
        Core::Ellipsoid { radii } => Wire::Ellipsoid(v1::Ellipsoid { radii: Some(vec3(*radii)) }),
        Core::Convex(hull) => Wire::Convex(v1::Convex { points: hull.points().iter().copied().map(vec3).collect() }),
        Core::Triangle([a, b, c]) => {
            Wire::Triangle(v1::Triangle { a: Some(vec3(*a)), b: Some(vec3(*b)), c: Some(vec3(*c)) })
        }
        Core::Segment([a, b]) => Wire::Segment(v1::Segment { a: Some(vec3(*a)), b: Some(vec3(*b)) }),
        Core::HalfSpace { normal, offset } => {
            Wire::HalfSpace(v1::HalfSpace { normal: Some(vec3(*normal)), offset: *offset })
        }
        Core::Plane { normal, offset } => Wire::Plane(v1::Plane { normal: Some(vec3(*normal)), offset: *offset }),
        Core::Mesh(mesh) => Wire::Mesh(self::mesh(mesh)),
        Core::Compound(compound) => {
            let part = |part: &Part| v1::Part { shape: Some(self::shape(&part.shape)), pose: Some(pose(&part.pose)) };
            Wire::Compound(v1::Compound { parts: compound.parts().iter().map(part).collect() })
        }
        Core::HeightField(field) => Wire::HeightField(height_field(field)),
        // The balls of a cloud are its swept radius.
        Core::PointCloud(cloud) => {
            let points = numbers(cloud.as_given().iter().flatten());
            Wire::PointCloud(v1::PointCloud { points: Some(points), radius: 0.0 })
        }
        Core::Voxels(map) => {
            let cells = map.cells().into_iter().flatten().collect();
            Wire::Voxels(v1::Voxels { resolution: map.resolution(), points: None, cells })
        }
        Core::Block(block) => Wire::Convex(v1::Convex { points: block.corners().map(vec3).into() }),
        Core::Column(column) => Wire::Convex(v1::Convex { points: column.corners().map(vec3).into() }),
    };
    v1::Shape { swept_radius, core: Some(core) }
}

fn height_field(field: &HeightField) -> v1::HeightField {
    let grid = field.grid();
    let [spacing_x, spacing_y] = grid.spacing;
    v1::HeightField {
        rows: grid.rows,
        columns: grid.columns,
        spacing_x,
        spacing_y,
        heights: Some(numbers(field.heights())),
        floor: Some(field.floor()),
    }
}

fn numbers<'a>(numbers: impl IntoIterator<Item = &'a f64>) -> v1::Numbers {
    let bytes = little_endian(numbers.into_iter().copied());
    v1::Numbers { form: Some(v1::numbers::Form::LittleEndian(bytes)) }
}

fn mesh(mesh: &TriangleMesh) -> v1::Mesh {
    let mode = if mesh.is_solid() { v1::MeshMode::Solid } else { v1::MeshMode::Exact };
    v1::Mesh {
        vertices: mesh.vertices().iter().copied().map(vec3).collect(),
        triangles: mesh.triangles().iter().flatten().copied().collect(),
        mode: mode.into(),
    }
}
