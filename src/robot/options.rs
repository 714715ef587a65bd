//! What a caller may choose about a robot's collision shapes.

use std::collections::BTreeMap;

/// What becomes of a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum MeshUse {
    /// Its triangles, as a surface without interior.
    #[default]
    Exact,
    /// Its triangles, as a body with an interior. The mesh has to be closed and face outwards.
    Solid,
    /// The convex hull of its vertices.
    Hull,
    /// A few convex hulls that together are nearly the mesh.
    Decompose,
}

/// Choices for a link. Scale comes first, then padding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkOptions {
    /// What becomes of meshes.
    pub mesh: MeshUse,
    /// Factor of every length of each collision shape, about the shape's own origin (the `<origin>` of its `<collision>`;
    /// for a mesh, the origin of its file's coordinates). Where the shape stands in its link does not change. Not negative.
    pub scale: f64,
    /// Metres added to the swept radius of each collision shape. Not negative.
    pub padding: f64,
}

impl Default for LinkOptions {
    fn default() -> Self {
        Self { mesh: MeshUse::default(), scale: 1.0, padding: 0.0 }
    }
}

/// Choices that differ for one link; `None`: as for all.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LinkOverride {
    /// See [`LinkOptions::mesh`].
    pub mesh: Option<MeshUse>,
    /// See [`LinkOptions::scale`].
    pub scale: Option<f64>,
    /// See [`LinkOptions::padding`].
    pub padding: Option<f64>,
}

/// Choices for a robot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ModelOptions {
    /// For all links.
    pub all: LinkOptions,
    /// For links by name.
    pub links: BTreeMap<String, LinkOverride>,
}

impl ModelOptions {
    /// The choices for all links.
    #[must_use]
    pub fn uniform(all: LinkOptions) -> Self {
        Self { all, links: BTreeMap::new() }
    }

    /// The choices for the link of that name.
    #[must_use]
    pub fn of(&self, link: &str) -> LinkOptions {
        let own = self.links.get(link).copied().unwrap_or_default();
        LinkOptions {
            mesh: own.mesh.unwrap_or(self.all.mesh),
            scale: own.scale.unwrap_or(self.all.scale),
            padding: own.padding.unwrap_or(self.all.padding),
        }
    }
}
