//! Links and the shapes that collide for them.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::RobotError;
use super::options::{LinkOptions, MeshUse, ModelOptions};
use super::urdf::{Geometry, Urdf, collision_item};
use crate::geometry::mesh_file::{self, MeshFormat, MeshSoup};
use crate::geometry::{Ball, InvalidShape, Pose, Shape, TriangleMesh, Vec3, decomposed};

/// A rigid part of a robot.
#[derive(Clone, Debug)]
pub struct Link {
    /// Unique among the robot's links.
    pub name: String,
    /// What collides, in the order of the URDF; often nothing.
    pub shapes: Vec<LinkShape>,
}

/// A shape that moves with its link.
#[derive(Clone, Debug)]
pub struct LinkShape {
    /// The shape's frame in the link's.
    pub pose: Pose,
    /// Scale and padding applied. Shared with other links that use the same mesh in the same way.
    pub shape: Arc<Shape>,
    /// Holds the shape; in the shape's frame, metres.
    pub ball: Ball,
}

impl LinkShape {
    fn new(pose: Pose, shape: Arc<Shape>) -> Self {
        let ball = Ball::around(&shape).expect("what a URDF can say has bounds");
        Self { pose, shape, ball }
    }
}

/// A mesh that is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeshRequest<'a> {
    /// As the URDF writes it: a path, `package://...`, `file://...`. Its ending tells the format.
    pub filename: &'a str,
    /// The link that wants it first.
    pub link: &'a str,
}

/// Finds the bytes of a mesh file, or says why there are none. It is asked once for each filename.
pub type MeshResolver<'a> = dyn FnMut(&MeshRequest) -> Result<Arc<[u8]>, String> + 'a;

/// All links, in the URDF's order.
pub(super) fn build(urdf: &Urdf, options: &ModelOptions, resolver: &mut MeshResolver) -> Result<Vec<Link>, RobotError> {
    let mut meshes = Meshes { resolver, files: BTreeMap::new(), shapes: BTreeMap::new() };
    let mut links = Vec::with_capacity(urdf.links.len());
    for link in &urdf.links {
        let chosen = options.of(&link.name);
        let mut shapes = Vec::with_capacity(link.collisions.len());
        for (i, collision) in link.collisions.iter().enumerate() {
            let item = collision_item(&link.name, i);
            let primitive = match &collision.geometry {
                Geometry::Mesh { filename, scale } => {
                    let request = MeshRequest { filename, link: &link.name };
                    let shape = meshes.shape(&request, *scale, &chosen, &item)?;
                    shapes.push(LinkShape::new(collision.origin, shape));
                    continue;
                }
                Geometry::Box { size } => Shape::cuboid(0.5 * size),
                Geometry::Sphere { radius } => Shape::sphere(*radius),
                Geometry::Cylinder { radius, length } => Shape::cylinder(*radius, 0.5 * length),
                Geometry::Capsule { radius, length } => Shape::capsule(*radius, 0.5 * length),
            };
            let shape = inflated(primitive, &chosen).map_err(|source| RobotError::Shape { item, source })?;
            shapes.push(LinkShape::new(collision.origin, Arc::new(shape)));
        }
        links.push(Link { name: link.name.clone(), shapes });
    }
    Ok(links)
}

/// Scale first, then padding.
fn inflated(shape: Result<Shape, InvalidShape>, chosen: &LinkOptions) -> Result<Shape, InvalidShape> {
    let shape = shape?;
    let scaled = if chosen.scale == 1.0 { shape } else { shape.scaled(chosen.scale)? };
    scaled.swept(chosen.padding)
}

/// What tells the shapes of meshes apart; numbers by their bits.
type ShapeKey = (String, [u64; 3], MeshUse, u64, u64);

/// Mesh files read so far, and the shapes made of them.
struct Meshes<'a, 'r> {
    resolver: &'a mut MeshResolver<'r>,
    files: BTreeMap<String, MeshSoup>,
    shapes: BTreeMap<ShapeKey, Arc<Shape>>,
}

impl Meshes<'_, '_> {
    fn shape(
        &mut self,
        request: &MeshRequest,
        axis_scale: Vec3,
        chosen: &LinkOptions,
        item: &str,
    ) -> Result<Arc<Shape>, RobotError> {
        let key = (
            request.filename.to_owned(),
            [axis_scale.x, axis_scale.y, axis_scale.z].map(f64::to_bits),
            chosen.mesh,
            chosen.scale.to_bits(),
            chosen.padding.to_bits(),
        );
        if let Some(shape) = self.shapes.get(&key) {
            return Ok(Arc::clone(shape));
        }
        let soup = self.file(request, item)?;
        let shape = inflated(from_soup(soup, axis_scale, chosen.mesh), chosen);
        let shape = Arc::new(shape.map_err(|source| RobotError::Shape { item: item.to_owned(), source })?);
        self.shapes.insert(key, Arc::clone(&shape));
        Ok(shape)
    }

    fn file(&mut self, request: &MeshRequest, item: &str) -> Result<&MeshSoup, RobotError> {
        let filename = request.filename.to_owned();
        if !self.files.contains_key(&filename) {
            let bytes = (self.resolver)(request).map_err(|reason| {
                let (item, filename) = (item.to_owned(), filename.clone());
                RobotError::MeshUnavailable { item, filename, reason }
            })?;
            let soup = MeshFormat::from_name(&filename).and_then(|format| mesh_file::read(&bytes, format));
            let soup = soup.map_err(|source| {
                let (item, filename) = (item.to_owned(), filename.clone());
                RobotError::Mesh { item, filename, source }
            })?;
            self.files.insert(filename.clone(), soup);
        }
        Ok(&self.files[&filename])
    }
}

fn from_soup(soup: &MeshSoup, axis_scale: Vec3, mesh: MeshUse) -> Result<Shape, InvalidShape> {
    let unscaled = axis_scale == Vec3::repeat(1.0);
    let made = match mesh {
        MeshUse::Hull => {
            let scaled: Vec<Vec3> = soup.vertices.iter().map(|v| v.component_mul(&axis_scale)).collect();
            return Shape::convex(&scaled);
        }
        MeshUse::Decompose => {
            let scaled: Vec<Vec3> = soup.vertices.iter().map(|v| v.component_mul(&axis_scale)).collect();
            return Ok(Shape::compound(Arc::new(decomposed(&scaled, &soup.triangles)?)));
        }
        MeshUse::Exact => TriangleMesh::surface(soup.vertices.clone(), soup.triangles.clone())?,
        MeshUse::Solid => TriangleMesh::solid(soup.vertices.clone(), soup.triangles.clone())?,
    };
    let placed = if unscaled { made } else { made.scaled(axis_scale)? };
    Ok(Shape::mesh(Arc::new(placed)))
}
