//! Collada (`.dae`): the triangles of the scene that the file instances, in metres.
//!
//! Read are `triangles`, `polylist`, `polygons`, `trifans` and `tristrips` of the geometries that the visual scene's
//! nodes instance, through the nodes' transforms, times `<unit meter>`. A file without a visual scene gives its
//! geometries as they stand. Polygons are cut into fans about their first corner. Lines are not surfaces and are left
//! out. Nodes instanced from a library, skins, holes, `lookat` and `skew` are refused by name: leaving them out would
//! lose surface.

mod elements;
mod library;
mod primitives;

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use roxmltree::{Document, Node};

use super::affine::Affine;
use super::soup::Expansion;
use super::text::finite_number;
use super::{MeshFileError, MeshSoup};
use crate::geometry::{Mat3, Quaternion, Vec3};
use elements::{child, children, missing, numbers, place_of, unsupported};
use library::{Geometry, Library};

pub(super) fn read(text: &str) -> Result<MeshSoup, MeshFileError> {
    let document = Document::parse(text)
        .map_err(|e| MeshFileError::Syntax { place: "Collada".to_owned(), problem: e.to_string() })?;
    let library = Library::new(&document);
    let root = document.root_element();
    let unit = Affine::linear(Mat3::identity() * metres_per_unit(root)?);
    let mut geometries = BTreeMap::new();
    let mut expansion = Expansion::default();
    let Some(scene) = library.visual_scene(root)? else {
        for element in children(root, "library_geometries").flat_map(|shelf| children(shelf, "geometry")) {
            place(&mut expansion, &library.geometry(element)?, &unit)?;
        }
        return Ok(expansion.soup);
    };
    // A stack of our own: files may nest deeper than ours is.
    let mut nodes: Vec<(Node, Affine)> = children(scene, "node").map(|node| (node, unit)).collect();
    nodes.reverse();
    while let Some((node, outer)) = nodes.pop() {
        let here = outer.compose(&transform(node)?);
        for instance in children(node, "instance_geometry") {
            let element = library.referenced(instance, "url", "geometry")?;
            let geometry = match geometries.entry(element.range().start) {
                Entry::Occupied(read) => read.into_mut(),
                Entry::Vacant(unread) => unread.insert(library.geometry(element)?),
            };
            place(&mut expansion, geometry, &here)?;
        }
        for name in ["instance_node", "instance_controller"] {
            if let Some(element) = children(node, name).next() {
                return Err(unsupported(node, element.tag_name().name()));
            }
        }
        let below = nodes.len();
        nodes.extend(children(node, "node").map(|child| (child, here)));
        nodes[below..].reverse();
    }
    Ok(expansion.soup)
}

fn place(expansion: &mut Expansion, geometry: &Geometry, at: &Affine) -> Result<(), MeshFileError> {
    let placed: Vec<Vec3> = geometry.vertices.iter().map(|&p| at.point(p)).collect();
    if let Some(i) = placed.iter().position(|p| !p.iter().all(|c| c.is_finite())) {
        return Err(MeshFileError::BadNumber { place: format!("placed vertex {i}"), text: format!("{:?}", placed[i]) });
    }
    let turned: Vec<[u32; 3]>;
    let triangles = if at.mirrors() {
        turned = geometry.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
        &turned
    } else {
        &geometry.triangles
    };
    expansion.append(&placed, triangles)
}

/// The product of a node's transforms, in the order they are written.
fn transform(node: Node) -> Result<Affine, MeshFileError> {
    let mut product = Affine::identity();
    for element in node.children().filter(Node::is_element) {
        let step = match element.tag_name().name() {
            "matrix" => {
                let m = numbers::<16>(element)?;
                let linear = Mat3::new(m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]);
                Affine { linear, translation: Vec3::new(m[3], m[7], m[11]) }
            }
            "translate" => Affine::translation(Vec3::from(numbers::<3>(element)?)),
            "scale" => Affine::linear(Mat3::from_diagonal(&Vec3::from(numbers::<3>(element)?))),
            "rotate" => {
                let [x, y, z, degrees] = numbers::<4>(element)?;
                let axis = Vec3::new(x, y, z).try_normalize(0.0).ok_or_else(|| missing(element, "axis"))?;
                Affine::linear(Quaternion::about_axis(axis, degrees.to_radians()).matrix())
            }
            name @ ("lookat" | "skew") => return Err(unsupported(node, name)),
            _ => continue,
        };
        product = product.compose(&step);
    }
    Ok(product)
}

fn metres_per_unit(root: Node) -> Result<f64, MeshFileError> {
    let unit = child(root, "asset").and_then(|asset| child(asset, "unit"));
    let Some((unit, metres)) = unit.and_then(|unit| unit.attribute("meter").map(|metres| (unit, metres))) else {
        return Ok(1.0);
    };
    let value = finite_number(metres.trim(), || place_of(unit))?;
    if value <= 0.0 {
        return Err(MeshFileError::Syntax { place: place_of(unit), problem: "meter is not positive".to_owned() });
    }
    Ok(value)
}
