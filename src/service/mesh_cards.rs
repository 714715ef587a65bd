//! The cost card of a mesh: what its hull, or its decomposition, would cost and how well it would fit.

use std::sync::Arc;
use std::time::{Duration, Instant};

use super::assets::ContentHash;
use super::library::{Library, MeshReading, UnusableMesh};
use crate::geometry::{
    Compound, ConvexHull, InvalidShape, Part, Pose, Shape, TriangleMesh, Vec3, decomposed, mesh_file,
};
use crate::limits::LimitExceeded;
use crate::query::MeshCard;
use crate::robot::MeshUse;

/// A card, and how long the pieces took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimedMeshCard {
    /// What was made.
    pub card: MeshCard,
    /// How long making the pieces took.
    pub build: Duration,
}

/// What a card is asked of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshCardRequest {
    /// The file.
    pub hash: ContentHash,
    /// How it becomes pieces: as a hull or decomposed.
    pub reading: MeshReading,
    /// How wide the brackets may be, metres; none: a thousandth of the mesh's longest side.
    pub accuracy: Option<f64>,
}

impl Library {
    /// Makes the pieces of a mesh file anew, and measures them.
    ///
    /// # Errors
    /// [`UnusableMesh`].
    pub(super) fn mesh_card(
        &self,
        request: &MeshCardRequest,
        stop: &dyn Fn() -> bool,
    ) -> Result<TimedMeshCard, UnusableMesh> {
        let MeshCardRequest { hash, reading: MeshReading { format, mode, scale }, accuracy } = *request;
        let bytes = self.assets().get(hash).map_err(|_| UnusableMesh::Missing(hash))?;
        let soup = mesh_file::read(&bytes, format)?;
        LimitExceeded::check("max_mesh_triangles", soup.triangles.len(), self.limits().max_mesh_triangles)?;
        LimitExceeded::check("max_hull_points", soup.vertices.len(), self.limits().max_hull_points)?;
        let vertices: Vec<Vec3> = soup.vertices.iter().map(|v| v.component_mul(&scale)).collect();
        let started = Instant::now();
        let pieces = Arc::new(if mode == MeshUse::Hull {
            one_hull(&vertices)?
        } else {
            decomposed(&vertices, &soup.triangles)?
        });
        let build = started.elapsed();
        // A mirrored mesh keeps facing outwards.
        let unscaled = TriangleMesh::surface(soup.vertices, soup.triangles)?;
        let mesh = Arc::new(if scale == Vec3::repeat(1.0) { unscaled } else { unscaled.scaled(scale)? });
        Ok(TimedMeshCard { card: MeshCard::of(&mesh, &pieces, accuracy, stop), build })
    }
}

fn one_hull(vertices: &[Vec3]) -> Result<Compound, InvalidShape> {
    let shape = Shape::hull(Arc::new(ConvexHull::new(vertices)?));
    Compound::new(vec![Part { shape, pose: Pose::identity() }])
}
