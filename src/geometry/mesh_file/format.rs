//! Which format is it, and who reads it?

use super::soup::without_unused_vertices;
use super::text::utf8;
use super::{MeshFileError, MeshSoup, collada, gltf, obj, stl};

/// The formats that are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshFormat {
    /// Wavefront OBJ: `v` and `f` lines.
    Obj,
    /// STL, text or binary, told apart by content.
    Stl,
    /// Collada, `.dae`.
    Collada,
    /// glTF 2.0, as `.gltf` or as binary `.glb`, told apart by content.
    Gltf,
}

impl MeshFormat {
    /// The format by a file name's ending, in either case.
    ///
    /// # Errors
    /// [`MeshFileError::UnknownFormat`].
    pub fn from_name(name: &str) -> Result<Self, MeshFileError> {
        let ending = name.rsplit_once('.').map(|(_, ending)| ending.to_ascii_lowercase());
        match ending.as_deref() {
            Some("obj") => Ok(Self::Obj),
            Some("stl") => Ok(Self::Stl),
            Some("dae") => Ok(Self::Collada),
            Some("gltf" | "glb") => Ok(Self::Gltf),
            _ => Err(MeshFileError::UnknownFormat { name: name.to_owned() }),
        }
    }
}

/// Reads a mesh file.
///
/// # Errors
/// [`MeshFileError`], naming the place.
pub fn read(bytes: &[u8], format: MeshFormat) -> Result<MeshSoup, MeshFileError> {
    let soup = match format {
        MeshFormat::Obj => obj::read(utf8(bytes)?)?,
        MeshFormat::Stl => stl::read(bytes)?,
        MeshFormat::Collada => collada::read(utf8(bytes)?)?,
        MeshFormat::Gltf => gltf::read(bytes)?,
    };
    if soup.triangles.is_empty() {
        return Err(MeshFileError::NoTriangles);
    }
    Ok(without_unused_vertices(soup))
}
