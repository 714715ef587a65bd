//! Which triangles does a mesh file hold?
//!
//! Bytes in, vertices and triangles out: no paths, no other files, no materials. Every number of a text format is read
//! to the nearest `f64`. A file is not trusted: whatever its bytes, the answer is triangles or a named error, and memory
//! stays in proportion to the file (or to [`MOST_TRIANGLES`], where a scene graph may repeat a mesh).
//!
//! Axes are taken as written. Collada's `up_axis` and glTF's y-up say how a viewer is to turn the picture; the tools
//! that robots are described with (RViz, MoveIt, Coal) do not turn collision meshes by it, so neither do we: a vertex of
//! the file is a point of the link's frame. Units are metres; Collada's `<unit meter>` is applied, glTF is in metres, and
//! OBJ and STL have no unit but the scale the URDF gives them.

mod affine;
mod collada;
mod format;
mod gltf;
mod mesh_file_error;
mod obj;
mod soup;
mod stl;
mod text;

pub use format::{MeshFormat, read};
pub use mesh_file_error::MeshFileError;
pub use soup::{MOST_TRIANGLES, MeshSoup};
