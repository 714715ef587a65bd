//! glTF 2.0 (`.gltf`, `.glb`): the triangles of the default scene, in metres.
//!
//! Read are positions and indices of triangles, strips and fans, through the transforms of the nodes. Points and lines
//! are not surfaces and are left out. Numbers come from the binary chunk of a `.glb` or from `data:` URIs, never from
//! another file. Sparse accessors, skins, and required extensions that change where triangles are, are refused by name.
//! Chapters named below are of the glTF 2.0 specification (Khronos).

mod buffers;
mod container;

use serde::Deserialize;

use super::affine::Affine;
use super::soup::Expansion;
use super::{MeshFileError, MeshSoup};
use crate::geometry::{Mat3, Quaternion, Vec3};
use buffers::Buffers;

#[derive(Deserialize, Default)]
#[serde(default, rename_all = "camelCase")]
struct Root {
    scene: Option<usize>,
    scenes: Vec<Scene>,
    nodes: Vec<Node>,
    meshes: Vec<Mesh>,
    accessors: Vec<Accessor>,
    buffer_views: Vec<BufferView>,
    buffers: Vec<Buffer>,
    extensions_required: Vec<String>,
}

#[derive(Deserialize)]
struct Scene {
    #[serde(default)]
    nodes: Vec<usize>,
}

#[derive(Deserialize, Default)]
#[serde(default)]
struct Node {
    children: Vec<usize>,
    mesh: Option<usize>,
    skin: Option<usize>,
    matrix: Option<[f64; 16]>,
    translation: Option<[f64; 3]>,
    rotation: Option<[f64; 4]>,
    scale: Option<[f64; 3]>,
}

#[derive(Deserialize)]
struct Mesh {
    primitives: Vec<Primitive>,
}

#[derive(Deserialize)]
struct Primitive {
    attributes: Attributes,
    indices: Option<usize>,
    mode: Option<u32>,
}

#[derive(Deserialize)]
struct Attributes {
    #[serde(rename = "POSITION")]
    position: Option<usize>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Accessor {
    buffer_view: Option<usize>,
    #[serde(default)]
    byte_offset: u64,
    component_type: u32,
    #[serde(rename = "type")]
    kind: String,
    count: u64,
    sparse: Option<serde::de::IgnoredAny>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct BufferView {
    buffer: usize,
    #[serde(default)]
    byte_offset: u64,
    byte_length: u64,
    byte_stride: Option<u64>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Buffer {
    uri: Option<String>,
    byte_length: u64,
}

pub(super) fn read(bytes: &[u8]) -> Result<MeshSoup, MeshFileError> {
    let (json, binary) = container::split(bytes)?;
    let root: Root = serde_json::from_slice(json)
        .map_err(|e| MeshFileError::Syntax { place: "glTF JSON".to_owned(), problem: e.to_string() })?;
    refuse_extensions(&root.extensions_required)?;
    let buffers = Buffers::open(&root, binary)?;
    let mut expansion = Expansion::default();
    let mut seen = vec![false; root.nodes.len()];
    let mut stack: Vec<(usize, Affine)> =
        top_nodes(&root)?.into_iter().rev().map(|node| (node, Affine::identity())).collect();
    while let Some((index, outer)) = stack.pop() {
        let node = entry(&root.nodes, index, "nodes", "node")?;
        // Nodes form trees (3.5.1): one that is met again would make a cycle, or count twice.
        if std::mem::replace(&mut seen[index], true) {
            let (place, problem) = (format!("nodes[{index}]"), "has two parents, or is its own ancestor".to_owned());
            return Err(MeshFileError::Syntax { place, problem });
        }
        if node.skin.is_some() {
            return Err(MeshFileError::Unsupported { place: format!("nodes[{index}]"), what: "a skin".to_owned() });
        }
        let here = outer.compose(&node.transform(index)?);
        if let Some(mesh) = node.mesh {
            for (k, primitive) in entry(&root.meshes, mesh, "nodes", "mesh")?.primitives.iter().enumerate() {
                let place = format!("meshes[{mesh}].primitives[{k}]");
                append(&mut expansion, &buffers, primitive, &here, &place)?;
            }
        }
        stack.extend(node.children.iter().rev().map(|&child| (child, here)));
    }
    Ok(expansion.soup)
}

/// Required extensions (3.12) that only say how surfaces look are harmless; any other may say where they are.
fn refuse_extensions(required: &[String]) -> Result<(), MeshFileError> {
    const LOOKS: [&str; 5] = ["KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_", "EXT_lights_"];
    match required.iter().find(|name| !LOOKS.iter().any(|prefix| name.starts_with(prefix))) {
        Some(name) => {
            Err(MeshFileError::Unsupported { place: "extensionsRequired".to_owned(), what: format!("{name:?}") })
        }
        None => Ok(()),
    }
}

/// The nodes of the default scene, else of the first; of a file without scenes, those that are nobody's children.
fn top_nodes(root: &Root) -> Result<Vec<usize>, MeshFileError> {
    if root.scenes.is_empty() {
        let mut is_child = vec![false; root.nodes.len()];
        for &child in root.nodes.iter().flat_map(|node| &node.children) {
            entry(&root.nodes, child, "nodes", "node")?;
            is_child[child] = true;
        }
        return Ok((0..root.nodes.len()).filter(|&node| !is_child[node]).collect());
    }
    Ok(entry(&root.scenes, root.scene.unwrap_or(0), "scene", "scene")?.nodes.clone())
}

impl Node {
    /// A matrix by columns, or translation * rotation * scale (3.5.2).
    fn transform(&self, index: usize) -> Result<Affine, MeshFileError> {
        if let Some(m) = self.matrix {
            let linear = Mat3::new(m[0], m[4], m[8], m[1], m[5], m[9], m[2], m[6], m[10]);
            return Ok(Affine { linear, translation: Vec3::new(m[12], m[13], m[14]) });
        }
        let [x, y, z, w] = self.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]);
        if [x, y, z, w] == [0.0; 4] {
            let (place, problem) = (format!("nodes[{index}].rotation"), "is the zero quaternion".to_owned());
            return Err(MeshFileError::Syntax { place, problem });
        }
        let rotation = Quaternion { w, x, y, z }.matrix();
        let scale = Mat3::from_diagonal(&Vec3::from(self.scale.unwrap_or([1.0; 3])));
        Ok(Affine { linear: rotation * scale, translation: Vec3::from(self.translation.unwrap_or([0.0; 3])) })
    }
}

fn append(
    expansion: &mut Expansion,
    buffers: &Buffers,
    primitive: &Primitive,
    at: &Affine,
    place: &str,
) -> Result<(), MeshFileError> {
    // Topologies (3.7.2.1): 0 to 3 are points and lines.
    let mode = primitive.mode.unwrap_or(4);
    match mode {
        0..=3 => return Ok(()),
        4..=6 => {}
        _ => return Err(MeshFileError::Unsupported { place: place.to_owned(), what: format!("mode {mode}") }),
    }
    let position = primitive.attributes.position;
    let position = position.ok_or_else(|| MeshFileError::Missing { place: place.to_owned(), what: "POSITION" })?;
    let mut vertices = buffers.positions(position)?;
    for (i, p) in vertices.iter_mut().enumerate() {
        *p = at.point(*p);
        if let Some(bad) = p.iter().find(|c| !c.is_finite()) {
            let place = format!("{place}: vertex {i} of accessors[{position}]");
            return Err(MeshFileError::BadNumber { place, text: bad.to_string() });
        }
    }
    let corners = match primitive.indices {
        Some(accessor) => buffers.indices(accessor, vertices.len())?,
        None => (0..vertices.len() as u32).collect(),
    };
    let mut triangles: Vec<[u32; 3]> = match mode {
        4 => corners.as_chunks::<3>().0.to_vec(),
        5 => corners.windows(3).enumerate().map(|(i, w)| [w[0], w[1 + i % 2], w[2 - i % 2]]).collect(),
        _ => corners.get(1..).unwrap_or_default().windows(2).map(|w| [w[0], w[1], corners[0]]).collect(),
    };
    if mode == 4 && corners.len() % 3 != 0 {
        let problem = format!("{} corners do not make whole triangles", corners.len());
        return Err(MeshFileError::Syntax { place: place.to_owned(), problem });
    }
    if at.mirrors() {
        triangles.iter_mut().for_each(|t| t.swap(1, 2));
    }
    expansion.append(&vertices, &triangles)
}

/// `list[index]`, or an error that says who asked.
fn entry<'a, T>(list: &'a [T], index: usize, place: &str, what: &'static str) -> Result<&'a T, MeshFileError> {
    list.get(index).ok_or_else(|| MeshFileError::BadIndex {
        place: place.to_owned(),
        what,
        index: i64::try_from(index).unwrap_or(i64::MAX),
        available: list.len(),
    })
}
