//! Why a mesh file was refused.

use super::MOST_TRIANGLES;

/// Why a file was refused. `place` is a line, an element or an array entry of the file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MeshFileError {
    /// The ending says nothing that is known.
    #[error("{name:?} does not end in .obj, .stl, .dae, .gltf or .glb")]
    UnknownFormat {
        /// The name.
        name: String,
    },
    /// A text format with bytes that are not UTF-8.
    #[error("byte {position} is not UTF-8 text")]
    NotText {
        /// Of the first bad byte.
        position: usize,
    },
    /// Not the format it is said to be.
    #[error("{place}: {problem}")]
    Syntax {
        /// Where.
        place: String,
        /// What.
        problem: String,
    },
    /// The file ends before what it announces.
    #[error("{place} needs {needed} bytes, but there are {available}")]
    Truncated {
        /// Where.
        place: String,
        /// Announced.
        needed: u64,
        /// Present.
        available: usize,
    },
    /// Text where a number is needed, or NaN, or an infinity.
    #[error("{place}: {text:?} is not a finite number")]
    BadNumber {
        /// Where.
        place: String,
        /// What is there.
        text: String,
    },
    /// A reference to an entry that is not there.
    #[error("{place} names {what} {index}, but there are {available}")]
    BadIndex {
        /// Where.
        place: String,
        /// What it refers to.
        what: &'static str,
        /// Which.
        index: i64,
        /// How many there are.
        available: usize,
    },
    /// Something the format demands is absent.
    #[error("{place} has no {what}")]
    Missing {
        /// Where.
        place: String,
        /// What.
        what: &'static str,
    },
    /// Valid, but not read here; leaving it out could hide a collision.
    #[error("{place}: {what} is not supported")]
    Unsupported {
        /// Where.
        place: String,
        /// What.
        what: String,
    },
    /// glTF that keeps its numbers in another file.
    #[error("buffers[{buffer}] is in another file, {uri:?}; pack it into a .glb or a data: URI")]
    ExternalBuffer {
        /// Which buffer.
        buffer: usize,
        /// Its URI.
        uri: String,
    },
    /// More than [`MOST_TRIANGLES`].
    #[error("the file expands to more than {MOST_TRIANGLES} triangles")]
    TooManyTriangles,
    /// A file without a single triangle.
    #[error("the file has no triangles")]
    NoTriangles,
}
