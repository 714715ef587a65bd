//! Collada (`.dae`): the triangles of the scene that the file instances, in metres.
//!
//! Read are `triangles`, `polylist`, `polygons`, `trifans` and `tristrips` of the geometries that the visual scene's
//! nodes instance, through the nodes' transforms, times `<unit meter>`. A file without a visual scene gives its
//! geometries as they stand. Polygons are cut into fans about their first corner. Lines are not surfaces and are left
//! out. Nodes instanced from a library, skins, holes, `lookat` and `skew` are refused by name: leaving them out would
//! lose surface.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use roxmltree::{Document, Node};

use super::affine::Affine;
use super::soup::Expansion;
use super::text::finite_number;
use super::{MOST_TRIANGLES, MeshFileError, MeshSoup};
use crate::geometry::{Mat3, Quaternion, Vec3};

/// Vertices and triangles of one geometry, in its own indices and frame.
struct Geometry {
    vertices: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

pub(super) fn read(text: &str) -> Result<MeshSoup, MeshFileError> {
    let document = Document::parse(text)
        .map_err(|e| MeshFileError::Syntax { place: "Collada".to_owned(), problem: e.to_string() })?;
    let file = File { ids: ids(&document) };
    let root = document.root_element();
    let unit = Affine::linear(Mat3::identity() * metres_per_unit(root)?);
    let mut geometries = BTreeMap::new();
    let mut expansion = Expansion::default();
    let Some(scene) = file.visual_scene(root)? else {
        for element in children(root, "library_geometries").flat_map(|library| children(library, "geometry")) {
            place(&mut expansion, &file.geometry(element)?, &unit)?;
        }
        return Ok(expansion.soup);
    };
    // A stack of our own: files may nest deeper than ours is.
    let mut nodes: Vec<(Node, Affine)> = children(scene, "node").map(|node| (node, unit)).collect();
    nodes.reverse();
    while let Some((node, outer)) = nodes.pop() {
        let here = outer.compose(&transform(node)?);
        for instance in children(node, "instance_geometry") {
            let element = file.referenced(instance, "url", "geometry")?;
            let geometry = match geometries.entry(element.range().start) {
                Entry::Occupied(read) => read.into_mut(),
                Entry::Vacant(unread) => unread.insert(file.geometry(element)?),
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

/// The document with its elements by id.
struct File<'a, 'input> {
    ids: BTreeMap<&'a str, Node<'a, 'input>>,
}

impl<'a, 'input> File<'a, 'input> {
    /// The element that `attribute` of `from` refers to as `#id`.
    fn referenced(
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

    fn visual_scene(&self, root: Node<'a, 'input>) -> Result<Option<Node<'a, 'input>>, MeshFileError> {
        let instance = children(root, "scene").flat_map(|scene| children(scene, "instance_visual_scene")).next();
        if let Some(instance) = instance {
            return self.referenced(instance, "url", "visual_scene").map(Some);
        }
        let libraries = children(root, "library_visual_scenes");
        Ok(libraries.flat_map(|library| children(library, "visual_scene")).next())
    }

    fn geometry(&self, element: Node<'a, 'input>) -> Result<Geometry, MeshFileError> {
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

/// Where in a primitive's `<p>` the vertices stand.
struct Inputs<'a, 'input> {
    vertex: Node<'a, 'input>,
    offset: usize,
    stride: usize,
}

impl<'a, 'input> Inputs<'a, 'input> {
    fn of(primitive: Node<'a, 'input>) -> Result<Self, MeshFileError> {
        let mut stride = 0;
        for input in children(primitive, "input") {
            stride = stride.max(whole(input, "offset", Some(0))?.saturating_add(1));
        }
        let vertex = children(primitive, "input").find(|input| input.attribute("semantic") == Some("VERTEX"));
        let vertex = vertex.ok_or_else(|| missing(primitive, "VERTEX input"))?;
        Ok(Self { vertex, offset: whole(vertex, "offset", Some(0))?, stride })
    }

    /// The vertex of each corner listed in `p`.
    fn corners(&self, p: Node, vertices: usize) -> Result<Vec<u32>, MeshFileError> {
        let indices = words_of(p);
        let mut corners = Vec::new();
        for word in indices.skip(self.offset).step_by(self.stride) {
            let index: u32 = word.parse().map_err(|_| MeshFileError::Syntax {
                place: place_of(p),
                problem: format!("{word:?} is not an index"),
            })?;
            if index as usize >= vertices {
                let (place, index) = (place_of(p), i64::from(index));
                return Err(MeshFileError::BadIndex { place, what: "vertex", index, available: vertices });
            }
            corners.push(index);
        }
        Ok(corners)
    }
}

/// How corners make triangles.
#[derive(Clone, Copy)]
enum Layout {
    /// Three by three.
    Triangles,
    /// As many at a time as `vcount` says.
    Polylist,
    /// One polygon in each `p`.
    Polygons,
    /// One strip in each `p`, every second triangle turned over.
    Strips,
}

impl Layout {
    fn cut(
        self,
        primitive: Node,
        inputs: &Inputs,
        vertices: usize,
        triangles: &mut Vec<[u32; 3]>,
    ) -> Result<(), MeshFileError> {
        if child(primitive, "ph").is_some() {
            return Err(unsupported(primitive, "a polygon with holes"));
        }
        for p in children(primitive, "p") {
            let corners = inputs.corners(p, vertices)?;
            match self {
                Self::Triangles => {
                    let (whole, rest) = corners.as_chunks::<3>();
                    if !rest.is_empty() {
                        return Err(uneven(p, "triangles"));
                    }
                    triangles.extend(whole);
                }
                Self::Polylist => {
                    let mut rest = corners.as_slice();
                    let counts = child(primitive, "vcount").ok_or_else(|| missing(primitive, "vcount"))?;
                    for word in words_of(counts) {
                        let count = word.parse().ok().filter(|count| *count <= rest.len());
                        let (polygon, others) = rest.split_at(count.ok_or_else(|| uneven(counts, "polygons"))?);
                        fan(polygon, triangles);
                        rest = others;
                    }
                    if !rest.is_empty() {
                        return Err(uneven(counts, "polygons"));
                    }
                }
                Self::Polygons => fan(&corners, triangles),
                Self::Strips => {
                    let windows = corners.windows(3).enumerate();
                    triangles
                        .extend(windows.map(|(i, w)| if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[0], w[2], w[1]] }));
                }
            }
        }
        Ok(())
    }
}

fn fan(polygon: &[u32], triangles: &mut Vec<[u32; 3]>) {
    if let [first, rest @ ..] = polygon {
        triangles.extend(rest.windows(2).map(|pair| [*first, pair[0], pair[1]]));
    }
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

fn numbers<const N: usize>(element: Node) -> Result<[f64; N], MeshFileError> {
    let words = words_of(element);
    let numbers: Vec<f64> = words.map(|w| finite_number(w, || place_of(element))).collect::<Result<_, _>>()?;
    let found = numbers.len();
    numbers.try_into().map_err(|_| MeshFileError::Syntax {
        place: place_of(element),
        problem: format!("{N} numbers are needed, {found} are there"),
    })
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

/// An attribute that is a whole number.
fn whole(element: Node, attribute: &'static str, default: Option<usize>) -> Result<usize, MeshFileError> {
    match (element.attribute(attribute), default) {
        (Some(text), _) => text.trim().parse().map_err(|_| MeshFileError::Syntax {
            place: place_of(element),
            problem: format!("{attribute}={text:?} is not a whole number"),
        }),
        (None, Some(default)) => Ok(default),
        (None, None) => Err(missing(element, attribute)),
    }
}

fn ids<'a, 'input>(document: &'a Document<'input>) -> BTreeMap<&'a str, Node<'a, 'input>> {
    document.descendants().filter_map(|node| node.attribute("id").map(|id| (id, node))).collect()
}

fn children<'a, 'input: 'a>(
    parent: Node<'a, 'input>,
    tag: &'static str,
) -> impl Iterator<Item = Node<'a, 'input>> + use<'a, 'input> {
    parent.children().filter(move |node| node.tag_name().name() == tag)
}

fn child<'a, 'input: 'a>(parent: Node<'a, 'input>, tag: &'static str) -> Option<Node<'a, 'input>> {
    children(parent, tag).next()
}

/// The words of an element's text, comments in between left out.
fn words_of<'a>(element: Node<'a, '_>) -> impl Iterator<Item = &'a str> {
    element.children().filter(Node::is_text).filter_map(|text| text.text()).flat_map(str::split_ascii_whitespace)
}

/// `<tag> in line N`.
fn place_of(element: Node) -> String {
    let line = element.document().text_pos_at(element.range().start).row;
    format!("<{}> in line {line}", element.tag_name().name())
}

fn missing(element: Node, what: &'static str) -> MeshFileError {
    MeshFileError::Missing { place: place_of(element), what }
}

fn unsupported(element: Node, what: &str) -> MeshFileError {
    MeshFileError::Unsupported { place: place_of(element), what: what.to_owned() }
}

fn uneven(element: Node, what: &str) -> MeshFileError {
    MeshFileError::Syntax { place: place_of(element), problem: format!("indices do not make whole {what}") }
}
