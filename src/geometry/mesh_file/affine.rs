//! Where a node of a scene graph puts the meshes below it.

use crate::geometry::{Mat3, Vec3};

/// The map `p -> linear * p + translation`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Affine {
    pub linear: Mat3,
    pub translation: Vec3,
}

impl Affine {
    pub fn identity() -> Self {
        Self::linear(Mat3::identity())
    }

    pub fn linear(linear: Mat3) -> Self {
        Self { linear, translation: Vec3::zeros() }
    }

    pub fn translation(translation: Vec3) -> Self {
        Self { linear: Mat3::identity(), translation }
    }

    /// First `inner`, then `self`.
    pub fn compose(&self, inner: &Self) -> Self {
        Self { linear: self.linear * inner.linear, translation: self.point(inner.translation) }
    }

    pub fn point(&self, p: Vec3) -> Vec3 {
        self.linear * p + self.translation
    }

    /// Whether it turns right hands into left ones, so that triangles have to be turned over.
    pub fn mirrors(&self) -> bool {
        self.linear.determinant() < 0.0
    }
}
