//! Shapes of many numbers: terrain, point clouds and voxels. Counts are held against the caps before anything is copied.

use std::sync::Arc;

use super::Path;
use super::geometry::refused;
use crate::geometry::{Grid, HeightField, PointCloud, Shape, Vec3, Voxels};
use crate::limits::LimitExceeded;
use crate::service::{Library, ServiceError};
use crate::transports::wire::v1;

/// A cap on numbers, and how many of them make one of what it counts.
struct Cap {
    name: &'static str,
    most: usize,
    each: usize,
}

pub(super) fn height_field(path: &Path<'_>, field: &v1::HeightField, library: &Library) -> Result<Shape, ServiceError> {
    let cap = Cap { name: "max_height_samples", most: library.limits().max_height_samples, each: 1 };
    let samples = usize::try_from(u64::from(field.rows) * u64::from(field.columns)).unwrap_or(usize::MAX);
    LimitExceeded::check(cap.name, samples, cap.most)?;
    let grid = Grid { rows: field.rows, columns: field.columns, spacing: [field.spacing_x, field.spacing_y] };
    let floor = path.field("floor").required(field.floor)?;
    let heights = numbers(&path.field("heights"), field.heights.as_ref(), &cap, library)?;
    let field = HeightField::new(grid, heights, floor).map_err(|error| refused(path, &error))?;
    Ok(Shape::height_field(Arc::new(field)))
}

pub(super) fn point_cloud(path: &Path<'_>, cloud: &v1::PointCloud, library: &Library) -> Result<Shape, ServiceError> {
    let cap = Cap { name: "max_cloud_points", most: library.limits().max_cloud_points, each: 3 };
    let points = points(&path.field("points"), cloud.points.as_ref(), &cap, library)?;
    let made = PointCloud::new(&points).and_then(|points| Shape::point_cloud(Arc::new(points), cloud.radius));
    made.map_err(|error| refused(path, &error))
}

pub(super) fn voxels(path: &Path<'_>, voxels: &v1::Voxels, library: &Library) -> Result<Shape, ServiceError> {
    let most = library.limits().max_voxel_cells;
    let (cells, rest) = voxels.cells.as_chunks::<3>();
    if !rest.is_empty() {
        let problem = format!("has {} numbers, which is not a multiple of 3", voxels.cells.len());
        return Err(path.field("cells").invalid(problem));
    }
    LimitExceeded::check("max_voxel_cells", cells.len(), most)?;
    let points = match &voxels.points {
        Some(_) => inserted_points(&path.field("points"), voxels.points.as_ref(), library)?,
        None => Vec::new(),
    };
    let map = Voxels::new(voxels.resolution).and_then(|map| map.with_cells(cells)?.with_points(&points));
    let map = map.map_err(|error| refused(path, &error))?;
    LimitExceeded::check("max_voxel_cells", map.len(), most)?;
    Ok(Shape::voxels(map))
}

/// Points that are inserted into voxels.
pub(super) fn inserted_points(
    path: &Path<'_>,
    message: Option<&v1::Numbers>,
    library: &Library,
) -> Result<Vec<Vec3>, ServiceError> {
    let cap = Cap { name: "max_cloud_points", most: library.limits().max_cloud_points, each: 3 };
    points(path, message, &cap, library)
}

/// Triples of numbers.
fn points(
    path: &Path<'_>,
    message: Option<&v1::Numbers>,
    cap: &Cap,
    library: &Library,
) -> Result<Vec<Vec3>, ServiceError> {
    let numbers = numbers(path, message, cap, library)?;
    let (triples, rest) = numbers.as_chunks::<3>();
    if !rest.is_empty() {
        return Err(path.invalid(format!("has {} numbers, which is not a multiple of 3", numbers.len())));
    }
    Ok(triples.iter().map(|p| Vec3::from(*p)).collect())
}

fn numbers(
    path: &Path<'_>,
    message: Option<&v1::Numbers>,
    cap: &Cap,
    library: &Library,
) -> Result<Vec<f64>, ServiceError> {
    use v1::numbers::Form;
    let file = |name, hash: &str| {
        let hash = hash.parse().map_err(|error| path.field(name).invalid(error))?;
        library.assets().get(hash)
    };
    let (doubles, floats) = (f64::from_le_bytes, |bytes| f64::from(f32::from_le_bytes(bytes)));
    match path.required(message.and_then(|numbers| numbers.form.as_ref()))? {
        Form::Packed(packed) => {
            cap.check(packed.values.len())?;
            Ok(packed.values.clone())
        }
        Form::LittleEndian(bytes) => decoded(&path.field("little_endian"), bytes, cap, doubles),
        Form::LittleEndianF32(bytes) => decoded(&path.field("little_endian_f32"), bytes, cap, floats),
        Form::Sha256(hash) => decoded(&path.field("sha256"), &file("sha256", hash)?, cap, doubles),
        Form::Sha256F32(hash) => decoded(&path.field("sha256_f32"), &file("sha256_f32", hash)?, cap, floats),
    }
}

fn decoded<const SIZE: usize>(
    path: &Path<'_>,
    bytes: &[u8],
    cap: &Cap,
    number: impl Fn([u8; SIZE]) -> f64,
) -> Result<Vec<f64>, ServiceError> {
    let (numbers, rest) = bytes.as_chunks::<SIZE>();
    if !rest.is_empty() {
        return Err(path.invalid(format!("has {} bytes, which is not a multiple of {SIZE}", bytes.len())));
    }
    cap.check(numbers.len())?;
    Ok(numbers.iter().map(|bytes| number(*bytes)).collect())
}

impl Cap {
    fn check(&self, numbers: usize) -> Result<(), LimitExceeded> {
        LimitExceeded::check(self.name, numbers.div_ceil(self.each), self.most)
    }
}
