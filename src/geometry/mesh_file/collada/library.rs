//! What a Collada document keeps under ids: scenes, geometries, and the numbers behind them.

use std::collections::BTreeMap;

use roxmltree::{Document, Node};

use super::super::text::finite_number;
use super::super::{MOST_TRIANGLES, MeshFileError};
use super::elements::{child, children, missing, place_of, unsupported, whole, words_of};
use super::primitives::{Inputs, Layout};
use crate::geometry::Vec3;

/// Vertices and triangles of one geometry, in its own indices and frame.
pub(super) struct Geometry {
    pub vertices: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
}

/// The document's elements by id.
pub(super) struct Library<'a, 'input> {
    ids: BTreeMap<&'a str, Node<'a, 'input>>,
}

impl<'a, 'input> Library<'a, 'input> {
    pub fn new(document: &'a Document<'input>) -> Self {
        let with_id = |node: Node<'a, 'input>| node.attribute("id").map(|id| (id, node));
        Self { ids: document.descendants().filter_map(with_id).collect() }
    }

    /// The element that `attribute` of `from` refers to as `#id`.
    pub fn referenced(
        &self,
        from: Node<'a, 'input>,
        attribute: &'static str,
        tag: &'static str,
    ) -> Result<Node<'a, 'input>, MeshFileError> {
        let url = from.attribute(attribute).ok_or_else(|| missing(from, attribute))?;
        let target = url.strip_prefix('#').and_then(|id| self.ids.get(id)).filter(|node| node.tag_name().name() == tag);
        target.copied().ok_or_else(|| MeshFileError::Syntax {
            place: place_of(from),
            problem: format!("{attribute}={url:?} is not a <{tag}> of this file"),
        })
    }

    pub fn visual_scene(&self, root: Node<'a, 'input>) -> Result<Option<Node<'a, 'input>>, MeshFileError> {
        let instance = children(root, "scene").flat_map(|scene| children(scene, "instance_visual_scene")).next();
        if let Some(instance) = instance {
            return self.referenced(instance, "url", "visual_scene").map(Some);
        }
        let libraries = children(root, "library_visual_scenes");
        Ok(libraries.flat_map(|library| children(library, "visual_scene")).next())
    }

    pub fn geometry(&self, element: Node<'a, 'input>) -> Result<Geometry, MeshFileError> {
        let mesh = child(element, "mesh").ok_or_else(|| missing(element, "mesh"))?;
        let mut geometry = Geometry { vertices: Vec::new(), triangles: Vec::new() };
        let mut source = None;
        for primitive in mesh.children().filter(Node::is_element) {
            let layout = match primitive.tag_name().name() {
                "triangles" => Layout::Triangles,
                "polylist" => Layout::Polylist,
                "polygons" | "trifans" => Layout::Polygons,
                "tristrips" => Layout::Strips,
                _ => continue,
            };
            let inputs = Inputs::of(primitive)?;
            let vertices = self.referenced(inputs.vertex, "source", "vertices")?;
            // Primitives of one mesh share their <vertices>, of which there is one.
            if source.is_none() {
                geometry.vertices = self.positions(vertices)?;
                source = Some(vertices.id());
            } else if source != Some(vertices.id()) {
                return Err(unsupported(mesh, "a second <vertices>"));
            }
            layout.cut(primitive, &inputs, geometry.vertices.len(), &mut geometry.triangles)?;
            if geometry.triangles.len() > MOST_TRIANGLES {
                return Err(MeshFileError::TooManyTriangles);
            }
        }
        Ok(geometry)
    }

    fn positions(&self, vertices: Node<'a, 'input>) -> Result<Vec<Vec3>, MeshFileError> {
        let input = children(vertices, "input").find(|input| input.attribute("semantic") == Some("POSITION"));
        let source = self.referenced(input.ok_or_else(|| missing(vertices, "POSITION input"))?, "source", "source")?;
        let accessor = child(source, "technique_common").and_then(|common| child(common, "accessor"));
        let accessor = accessor.ok_or_else(|| missing(source, "accessor"))?;
        let array = self.referenced(accessor, "source", "float_array")?;
        let words = words_of(array);
        let numbers: Vec<f64> =
            words.map(|word| finite_number(word, || place_of(array))).collect::<Result<_, MeshFileError>>()?;
        let (count, stride) = (whole(accessor, "count", None)?, whole(accessor, "stride", Some(1))?);
        let offset = whole(accessor, "offset", Some(0))?;
        if count == 0 {
            return Ok(Vec::new());
        }
        if stride < 3 {
            return Err(unsupported(accessor, "a stride below 3"));
        }
        let end = (count - 1).checked_mul(stride).and_then(|n| n.checked_add(offset)).and_then(|n| n.checked_add(3));
        if end.is_none_or(|end| end > numbers.len()) {
            return Err(MeshFileError::BadIndex {
                place: place_of(accessor),
                what: "number",
                index: end.and_then(|end| i64::try_from(end).ok()).unwrap_or(i64::MAX),
                available: numbers.len(),
            });
        }
        Ok((0..count).map(|i| Vec3::from_column_slice(&numbers[offset + i * stride..][..3])).collect())
    }
}
