//! Shapes and poses: from messages to checked values.

use std::sync::Arc;

use super::{Path, fields};
use crate::geometry::mesh_file::MeshFormat;
use crate::geometry::tolerance::LARGEST_LENGTH;
use crate::geometry::{
    Compound, ConvexHull, InvalidPose, InvalidShape, Part, Pose, Quaternion, Shape, TriangleMesh, Vec3, decomposed,
};
use crate::limits::{LimitExceeded, Limits};
use crate::robot::MeshUse;
use crate::service::{ContentHash, Library, MeshCardRequest, MeshReading, ServiceError, UnusableMesh};
use crate::transports::wire::v1;

/// A pose; absent parts mean no translation and no rotation.
///
/// # Errors
/// Numbers that are not finite, the zero quaternion.
pub fn pose(path: &Path<'_>, pose: Option<&v1::Pose>) -> Result<Pose, ServiceError> {
    let Some(pose) = pose else { return Ok(Pose::identity()) };
    let translation = pose.translation.as_ref().map_or_else(Vec3::zeros, vec3);
    let rotation =
        pose.rotation.as_ref().map_or(Quaternion::IDENTITY, |q| Quaternion { w: q.w, x: q.x, y: q.y, z: q.z });
    Pose::new(translation, rotation).map_err(|error| match error {
        InvalidPose::TranslationNotFinite => path.field("translation").invalid("is not finite"),
        InvalidPose::TranslationTooLarge => {
            path.field("translation").invalid(format!("has a component beyond {LARGEST_LENGTH:e} m"))
        }
        InvalidPose::RotationNotFinite => path.field("rotation").invalid("is not finite"),
        InvalidPose::ZeroQuaternion => path.field("rotation").invalid("is the zero quaternion"),
    })
}

/// A point or direction; the numbers are checked where they are used.
pub(super) fn vec3(v: &v1::Vec3) -> Vec3 {
    Vec3::new(v.x, v.y, v.z)
}

pub(super) fn required_vec3(path: &Path<'_>, v: Option<&v1::Vec3>) -> Result<Vec3, ServiceError> {
    path.required(v).map(vec3)
}

/// A shape that must be said. Mesh assets are looked up in `library`.
///
/// # Errors
/// A field that is missing or cannot be, an asset that is not here, a cap.
pub fn shape(path: &Path<'_>, shape: Option<&v1::Shape>, library: &Library) -> Result<Shape, ServiceError> {
    let shape = path.required(shape)?;
    let core = core(path, shape.core.as_ref(), library)?;
    if shape.swept_radius == 0.0 {
        return Ok(core);
    }
    core.swept(shape.swept_radius).map_err(|error| refused(path, &error))
}

fn core(path: &Path<'_>, core: Option<&v1::shape::Core>, library: &Library) -> Result<Shape, ServiceError> {
    use v1::shape::Core;
    let limits = library.limits();
    let (name, result) = match path.required(core)? {
        Core::Sphere(sphere) => ("sphere", Shape::sphere(sphere.radius)),
        Core::Box(cuboid) => {
            let path = path.field("box");
            ("box", Shape::cuboid(required_vec3(&path.field("half_extents"), cuboid.half_extents.as_ref())?))
        }
        Core::Capsule(capsule) => ("capsule", Shape::capsule(capsule.radius, capsule.half_length)),
        Core::Cylinder(cylinder) => ("cylinder", Shape::cylinder(cylinder.radius, cylinder.half_length)),
        Core::Cone(cone) => ("cone", Shape::cone(cone.radius, cone.half_length)),
        Core::Ellipsoid(ellipsoid) => {
            let path = path.field("ellipsoid");
            ("ellipsoid", Shape::ellipsoid(required_vec3(&path.field("radii"), ellipsoid.radii.as_ref())?))
        }
        Core::Convex(convex) => {
            LimitExceeded::check("max_hull_points", convex.points.len(), limits.max_hull_points)?;
            ("convex", Shape::convex(&convex.points.iter().map(vec3).collect::<Vec<_>>()))
        }
        Core::Mesh(mesh) => return inline_mesh(&path.field("mesh"), mesh, limits),
        Core::MeshAsset(asset) => return mesh_asset(&path.field("mesh_asset"), asset, library),
        Core::Compound(compound) => return self::compound(&path.field("compound"), compound, library),
        Core::HeightField(field) => return fields::height_field(&path.field("height_field"), field, library),
        Core::PointCloud(cloud) => return fields::point_cloud(&path.field("point_cloud"), cloud, library),
        Core::Voxels(voxels) => return fields::voxels(&path.field("voxels"), voxels, library),
        Core::Point(v1::Point {}) => return Ok(Shape::point()),
        Core::Segment(segment) => {
            let path = path.field("segment");
            let end = |name, v: &Option<v1::Vec3>| required_vec3(&path.field(name), v.as_ref());
            ("segment", Shape::segment(end("a", &segment.a)?, end("b", &segment.b)?))
        }
        Core::Triangle(triangle) => {
            let path = path.field("triangle");
            let corner = |name, v: &Option<v1::Vec3>| required_vec3(&path.field(name), v.as_ref());
            let (a, b, c) = (corner("a", &triangle.a)?, corner("b", &triangle.b)?, corner("c", &triangle.c)?);
            ("triangle", Shape::triangle(a, b, c))
        }
        Core::HalfSpace(half_space) => {
            let path = path.field("half_space");
            let normal = required_vec3(&path.field("normal"), half_space.normal.as_ref())?;
            ("half_space", Shape::half_space(normal, half_space.offset))
        }
        Core::Plane(plane) => {
            let path = path.field("plane");
            ("plane", Shape::plane(required_vec3(&path.field("normal"), plane.normal.as_ref())?, plane.offset))
        }
    };
    result.map_err(|error| refused(&path.field(name), &error))
}

fn inline_mesh(path: &Path<'_>, mesh: &v1::Mesh, limits: &Limits) -> Result<Shape, ServiceError> {
    let (corners, rest) = mesh.triangles.as_chunks::<3>();
    if !rest.is_empty() {
        let problem = format!("has {} indices, which is not a multiple of 3", mesh.triangles.len());
        return Err(path.field("triangles").invalid(problem));
    }
    LimitExceeded::check("max_mesh_triangles", corners.len(), limits.max_mesh_triangles)?;
    let vertices: Vec<Vec3> = mesh.vertices.iter().map(vec3).collect();
    let shape = match required_mesh_mode(&path.field("mode"), mesh.mode)? {
        MeshUse::Exact => TriangleMesh::surface(vertices, corners.to_vec()).map(|mesh| Shape::mesh(Arc::new(mesh))),
        MeshUse::Solid => TriangleMesh::solid(vertices, corners.to_vec()).map(|mesh| Shape::mesh(Arc::new(mesh))),
        MeshUse::Decompose => decomposed(&vertices, corners).map(|pieces| Shape::compound(Arc::new(pieces))),
        MeshUse::Hull => {
            LimitExceeded::check("max_hull_points", vertices.len(), limits.max_hull_points)?;
            ConvexHull::new(&vertices).map(|hull| Shape::hull(Arc::new(hull)))
        }
    };
    shape.map_err(|error| refused(path, &error))
}

fn mesh_asset(path: &Path<'_>, asset: &v1::MeshAsset, library: &Library) -> Result<Shape, ServiceError> {
    let (hash, reading) = mesh_reading(path, asset)?;
    library.mesh_shape(hash, &reading).map_err(|error| unusable(path, error))
}

/// Which file, and how it is read.
fn mesh_reading(path: &Path<'_>, asset: &v1::MeshAsset) -> Result<(ContentHash, MeshReading), ServiceError> {
    let hash = asset.sha256.parse().map_err(|error| path.field("sha256").invalid(error))?;
    let format = mesh_format(&path.field("format"), asset.format)?;
    let reading = MeshReading {
        format: path.field("format").required(format)?,
        mode: required_mesh_mode(&path.field("mode"), asset.mode)?,
        scale: asset.scale.as_ref().map_or_else(|| Vec3::repeat(1.0), vec3),
    };
    Ok((hash, reading))
}

/// What a mesh costs as convex pieces.
///
/// # Errors
/// A field that is missing or cannot be.
pub fn mesh_card_request(request: &v1::DescribeMeshRequest) -> Result<MeshCardRequest, ServiceError> {
    let path = Path::root("mesh");
    let (hash, reading) = mesh_reading(&path, path.required(request.mesh.as_ref())?)?;
    if !matches!(reading.mode, MeshUse::Hull | MeshUse::Decompose) {
        return Err(path.field("mode").invalid("makes no convex pieces: HULL and DECOMPOSE do"));
    }
    if let Some(accuracy) = request.accuracy.filter(|accuracy| !(accuracy.is_finite() && *accuracy > 0.0)) {
        return Err(Path::root("accuracy").invalid(format!("{accuracy} is not a positive number of metres")));
    }
    Ok(MeshCardRequest { hash, reading, accuracy: request.accuracy })
}

/// What is wrong with the mesh of a [`mesh_card_request`].
#[must_use]
pub fn unusable_mesh(error: UnusableMesh) -> ServiceError {
    unusable(&Path::root("mesh"), error)
}

fn unusable(path: &Path<'_>, error: UnusableMesh) -> ServiceError {
    match error {
        UnusableMesh::Missing(hash) => ServiceError::NotFound { what: "asset", name: hash.to_string() },
        UnusableMesh::TooLarge(exceeded) => ServiceError::Limit(exceeded),
        UnusableMesh::File(error) => path.field("sha256").invalid(error),
        UnusableMesh::Shape(error) => path.invalid(error),
    }
}

fn compound(path: &Path<'_>, compound: &v1::Compound, library: &Library) -> Result<Shape, ServiceError> {
    LimitExceeded::check("max_compound_parts", compound.parts.len(), library.limits().max_compound_parts)?;
    let part = |(index, part): (usize, &v1::Part)| {
        let path = path.item("parts", index);
        // Refused before it is decoded, so that nesting cannot run away.
        if matches!(part.shape.as_ref().and_then(|shape| shape.core.as_ref()), Some(v1::shape::Core::Compound(_))) {
            return Err(path.field("shape").invalid("is a compound, which cannot be part of a compound"));
        }
        let shape = shape(&path.field("shape"), part.shape.as_ref(), library)?;
        Ok(Part { shape, pose: pose(&path.field("pose"), part.pose.as_ref())? })
    };
    let parts = compound.parts.iter().enumerate().map(part).collect::<Result<_, ServiceError>>()?;
    let compound = Compound::new(parts).map_err(|error| refused(path, &error))?;
    Ok(Shape::compound(Arc::new(compound)))
}

/// What the triangles of a mesh stand for; none when it is not said.
///
/// # Errors
/// A number that stands for nothing.
pub fn mesh_mode(path: &Path<'_>, number: i32) -> Result<Option<MeshUse>, ServiceError> {
    match v1::MeshMode::try_from(number) {
        Ok(v1::MeshMode::Unspecified) => Ok(None),
        Ok(v1::MeshMode::Exact) => Ok(Some(MeshUse::Exact)),
        Ok(v1::MeshMode::Hull) => Ok(Some(MeshUse::Hull)),
        Ok(v1::MeshMode::Solid) => Ok(Some(MeshUse::Solid)),
        Ok(v1::MeshMode::Decompose) => Ok(Some(MeshUse::Decompose)),
        Err(_) => Err(path.invalid(format!("has the unknown value {number}"))),
    }
}

fn required_mesh_mode(path: &Path<'_>, number: i32) -> Result<MeshUse, ServiceError> {
    path.required(mesh_mode(path, number)?)
}

/// How the bytes of a mesh file are read; none when it is not said.
///
/// # Errors
/// A number that stands for nothing.
pub fn mesh_format(path: &Path<'_>, number: i32) -> Result<Option<MeshFormat>, ServiceError> {
    match v1::MeshFormat::try_from(number) {
        Ok(v1::MeshFormat::Unspecified) => Ok(None),
        Ok(v1::MeshFormat::Obj) => Ok(Some(MeshFormat::Obj)),
        Ok(v1::MeshFormat::Stl) => Ok(Some(MeshFormat::Stl)),
        Ok(v1::MeshFormat::Dae) => Ok(Some(MeshFormat::Collada)),
        Ok(v1::MeshFormat::Gltf) => Ok(Some(MeshFormat::Gltf)),
        Err(_) => Err(path.invalid(format!("has the unknown value {number}"))),
    }
}

/// Puts what a shape says of its own field behind the path of the shape.
pub(super) fn refused(path: &Path<'_>, error: &InvalidShape) -> ServiceError {
    let text = error.to_string();
    let inner = match error {
        InvalidShape::NotFinite { field }
        | InvalidShape::Negative { field, .. }
        | InvalidShape::TooLarge { field, .. }
        | InvalidShape::NotAllowed { field, .. }
        | InvalidShape::Pose { field, .. } => field.clone(),
        InvalidShape::Empty { field }
        | InvalidShape::NotPositive { field, .. }
        | InvalidShape::TooFew { field, .. }
        | InvalidShape::TooMany { field, .. }
        | InvalidShape::WrongCount { field, .. } => (*field).to_owned(),
        InvalidShape::UpsideDown { axis } => format!("min.{axis}"),
        InvalidShape::BelowFloor { sample, .. } => format!("heights[{sample}]"),
        InvalidShape::ZeroNormal => "normal".to_owned(),
        InvalidShape::BadIndex { triangle, .. } => format!("triangles[{triangle}]"),
        InvalidShape::Part { part, .. } => format!("parts[{part}]"),
        InvalidShape::NotClosed { .. } | InvalidShape::InsideOut { .. } | InvalidShape::NotDecomposed => {
            return path.invalid(text);
        }
    };
    // The texts begin with their field.
    let problem = text.strip_prefix(&inner).unwrap_or(&text).trim_start_matches([':', ' ']);
    ServiceError::invalid(format!("{path}.{inner}"), problem)
}
