//! What was uploaded, and what was made of it? Files, the shapes read from them, and robot models.
//!
//! A shape that several bodies or links use is made once and shared: it is found again as long as somebody uses it.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError, Weak};

use super::admission::Admission;
use super::assets::{Assets, ContentHash};
use crate::geometry::mesh_file::{self, MeshFileError, MeshFormat};
use crate::geometry::{Compound, ConvexHull, InvalidShape, Shape, TriangleMesh, Vec3, decomposed};
use crate::limits::{LimitExceeded, Limits};
use crate::robot::MeshUse;

/// How a mesh file becomes a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshReading {
    /// How its bytes are read.
    pub format: MeshFormat,
    /// What its triangles stand for.
    pub mode: MeshUse,
    /// Factors along the axes.
    pub scale: Vec3,
}

/// Why a mesh file cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum UnusableMesh {
    /// It was never uploaded.
    #[error("no asset {0}")]
    Missing(ContentHash),
    /// A cap.
    #[error(transparent)]
    TooLarge(#[from] LimitExceeded),
    /// Its bytes are not a mesh.
    #[error(transparent)]
    File(#[from] MeshFileError),
    /// Its triangles are not a shape.
    #[error(transparent)]
    Shape(#[from] InvalidShape),
}

/// The files and shapes of the daemon.
#[derive(Debug)]
pub struct Library {
    limits: Limits,
    assets: Arc<Assets>,
    made: Mutex<BTreeMap<MeshKey, SharedMesh>>,
}

/// File, format, mode, and the bits of the three scale factors.
type MeshKey = (ContentHash, u8, MeshUse, [u64; 3]);

#[derive(Debug)]
enum SharedMesh {
    Hull(Weak<ConvexHull>),
    Mesh(Weak<TriangleMesh>),
    Pieces(Weak<Compound>),
}

impl SharedMesh {
    fn shape(&self) -> Option<Shape> {
        match self {
            Self::Hull(hull) => hull.upgrade().map(Shape::hull),
            Self::Mesh(mesh) => mesh.upgrade().map(Shape::mesh),
            Self::Pieces(pieces) => pieces.upgrade().map(Shape::compound),
        }
    }

    fn is_used(&self) -> bool {
        match self {
            Self::Hull(hull) => hull.strong_count() > 0,
            Self::Mesh(mesh) => mesh.strong_count() > 0,
            Self::Pieces(pieces) => pieces.strong_count() > 0,
        }
    }
}

impl Library {
    /// An empty library; `uploads` admits uploads.
    #[must_use]
    pub fn new(limits: &Limits, uploads: Admission) -> Self {
        Self { limits: limits.clone(), assets: Arc::new(Assets::new(limits, uploads)), made: Mutex::default() }
    }

    /// The caps that shapes are held against.
    #[must_use]
    pub fn limits(&self) -> &Limits {
        &self.limits
    }

    /// The files.
    #[must_use]
    pub fn assets(&self) -> &Arc<Assets> {
        &self.assets
    }

    /// The shape of a mesh file. The first use reads the file, which takes milliseconds to seconds.
    ///
    /// # Errors
    /// [`UnusableMesh`].
    pub fn mesh_shape(&self, hash: ContentHash, reading: &MeshReading) -> Result<Shape, UnusableMesh> {
        let MeshReading { format, mode, scale } = *reading;
        let key = (hash, format as u8, mode, [scale.x, scale.y, scale.z].map(f64::to_bits));
        if let Some(shape) = self.made().get(&key).and_then(SharedMesh::shape) {
            return Ok(shape);
        }
        let bytes = self.assets.get(hash).map_err(|_| UnusableMesh::Missing(hash))?;
        let soup = mesh_file::read(&bytes, format)?;
        LimitExceeded::check("max_mesh_triangles", soup.triangles.len(), self.limits.max_mesh_triangles)?;
        let (shape, shared) = match mode {
            MeshUse::Hull => {
                LimitExceeded::check("max_hull_points", soup.vertices.len(), self.limits.max_hull_points)?;
                let points: Vec<Vec3> = soup.vertices.iter().map(|v| v.component_mul(&scale)).collect();
                let hull = Arc::new(ConvexHull::new(&points)?);
                (Shape::hull(Arc::clone(&hull)), SharedMesh::Hull(Arc::downgrade(&hull)))
            }
            MeshUse::Decompose => {
                let vertices: Vec<Vec3> = soup.vertices.iter().map(|v| v.component_mul(&scale)).collect();
                let pieces = Arc::new(decomposed(&vertices, &soup.triangles)?);
                (Shape::compound(Arc::clone(&pieces)), SharedMesh::Pieces(Arc::downgrade(&pieces)))
            }
            MeshUse::Exact | MeshUse::Solid => {
                let mesh = match mode {
                    MeshUse::Solid => TriangleMesh::solid(soup.vertices, soup.triangles)?,
                    MeshUse::Exact | MeshUse::Hull | MeshUse::Decompose => {
                        TriangleMesh::surface(soup.vertices, soup.triangles)?
                    }
                };
                let mesh = Arc::new(if scale == Vec3::repeat(1.0) { mesh } else { mesh.scaled(scale)? });
                (Shape::mesh(Arc::clone(&mesh)), SharedMesh::Mesh(Arc::downgrade(&mesh)))
            }
        };
        let mut made = self.made();
        made.retain(|_, shared| shared.is_used());
        made.insert(key, shared);
        Ok(shape)
    }

    /// The map is whole after every statement, so a poisoned lock guards a sound one.
    fn made(&self) -> std::sync::MutexGuard<'_, BTreeMap<MeshKey, SharedMesh>> {
        self.made.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Core;

    #[test]
    fn a_mesh_that_is_in_use_is_made_once_for_each_way_to_use_it() {
        let library = Library::new(&Limits::default(), Admission::new("max_uploads_in_flight", 1));
        let file = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        let hash = ContentHash::of(file);
        let mut upload = library.assets().begin_upload(hash, file.len() as u64).unwrap();
        upload.push(file).unwrap();
        upload.finish().unwrap();
        let hull = |scale: f64| {
            let reading = MeshReading { format: MeshFormat::Obj, mode: MeshUse::Hull, scale: Vec3::repeat(scale) };
            let shape = library.mesh_shape(hash, &reading).unwrap();
            let Core::Convex(hull) = shape.core() else { panic!("{shape:?}") };
            Arc::clone(hull)
        };
        let first = hull(1.0);
        assert!(Arc::ptr_eq(&first, &hull(1.0)));
        assert!(!Arc::ptr_eq(&first, &hull(2.0)));
        drop(first);
        hull(3.0);
        assert_eq!(library.made().len(), 1, "what nobody uses is forgotten");
    }
}
