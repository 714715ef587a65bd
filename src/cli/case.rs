//! Reads the case format: shapes and poses as JSON, and a pair of placed shapes a line.
//!
//! A shape is `{"type": T, "params": {..}}`, a pose `{"t": [x, y, z], "q": [w, x, y, z]}`; metres. Every shape may have
//! `margin` among its params: the radius of a ball swept over it. `docs/cases.md` lists the types.

use std::fmt;
use std::sync::Arc;

use serde::de::{DeserializeSeed, Deserializer, IgnoredAny, MapAccess, Visitor};
use serde_json::Value;

use super::json_field::{Field, FieldError};
use crate::geometry::{
    Compound, Grid, HeightField, InvalidShape, Part, PointCloud, Pose, Quaternion, Shape, TriangleMesh, Voxels,
    decomposed,
};

/// Two placed shapes.
#[derive(Clone, Debug)]
pub struct Case {
    /// Side A.
    pub a: Shape,
    /// A's frame in the world.
    pub pose_a: Pose,
    /// Side B.
    pub b: Shape,
    /// B's frame in the world.
    pub pose_b: Pose,
}

/// Reads one line. The id is given back even with a line that cannot be read, as far as reading came; null without one.
///
/// The second part is what is wrong, naming the field, if anything is.
pub fn read_line(line: &[u8]) -> (Value, Result<Case, String>) {
    match serde_json::from_slice::<Value>(line) {
        Ok(document) => {
            let id = document.get("id").cloned().unwrap_or(Value::Null);
            (id, read_case(&Field::root(&document)).map_err(|e| e.to_string()))
        }
        Err(error) => (id_before_the_error(line), Err(format!("line: is not JSON: {error}"))),
    }
}

fn read_case(case: &Field) -> Result<Case, FieldError> {
    Ok(Case {
        a: read_shape(&case.member("a")?)?,
        pose_a: read_pose(&case.member("pose_a")?)?,
        b: read_shape(&case.member("b")?)?,
        pose_b: read_pose(&case.member("pose_b")?)?,
    })
}

/// A shape in its own frame.
///
/// # Errors
/// Names the field that is missing, of the wrong kind, or refused by the geometry.
pub fn read_shape(shape: &Field) -> Result<Shape, FieldError> {
    let kind = shape.member("type")?;
    let nothing = Value::Object(serde_json::Map::new());
    let params =
        shape.optional("params").unwrap_or_else(|| Field { value: &nothing, path: format!("{}.params", shape.path) });
    let number = |name: &str| params.member(name)?.number();
    let vector = |name: &str| params.member(name)?.vector();

    let (known, core): (&[&str], Result<Shape, InvalidShape>) = match kind.text()? {
        "sphere" => (&["radius"], Shape::sphere(number("radius")?)),
        "point" => (&[], Ok(Shape::point())),
        "box" => (&["half_extents"], Shape::cuboid(vector("half_extents")?)),
        "capsule" => (&["radius", "half_length"], Shape::capsule(number("radius")?, number("half_length")?)),
        "cylinder" => (&["radius", "half_length"], Shape::cylinder(number("radius")?, number("half_length")?)),
        "cone" => (&["radius", "half_length"], Shape::cone(number("radius")?, number("half_length")?)),
        "ellipsoid" => (&["radii"], Shape::ellipsoid(vector("radii")?)),
        "convex" => (&["points"], Shape::convex(&params.member("points")?.vectors()?)),
        "triangle" => (&["a", "b", "c"], Shape::triangle(vector("a")?, vector("b")?, vector("c")?)),
        "segment" => (&["a", "b"], Shape::segment(vector("a")?, vector("b")?)),
        "halfspace" | "half_space" => (&["normal", "offset"], Shape::half_space(vector("normal")?, number("offset")?)),
        "plane" => (&["normal", "offset"], Shape::plane(vector("normal")?, number("offset")?)),
        "mesh" => (&["vertices", "triangles", "solid", "decompose"], read_mesh(&params)?),
        "compound" => (&["parts"], read_compound(&params)?),
        "height_field" => (&["rows", "columns", "spacing", "heights", "floor"], read_height_field(&params)?),
        "point_cloud" => (&["points", "radius"], read_point_cloud(&params)?),
        "voxels" => (&["resolution", "points", "cells"], read_voxels(&params)?),
        other => return Err(kind.error(format!("no shape is called {other:?}"))),
    };
    params.only(&[known, &["margin"]].concat())?;
    let core = core.map_err(|error| params.error(error))?;
    match params.optional("margin") {
        Some(margin) => core.swept(margin.number()?).map_err(|error| margin.error(error)),
        None => Ok(core),
    }
}

fn read_mesh(params: &Field) -> Result<Result<Shape, InvalidShape>, FieldError> {
    let vertices = params.member("vertices")?.vectors()?;
    let mut triangles = Vec::new();
    for triangle in params.member("triangles")?.elements()? {
        let [a, b, c] = triangle.exactly()?;
        triangles.push([a.index()?, b.index()?, c.index()?]);
    }
    let solid = params.optional("solid").map(|field| field.boolean()).transpose()?.unwrap_or(false);
    if params.optional("decompose").map(|field| field.boolean()).transpose()?.unwrap_or(false) {
        if solid {
            return Err(params.error("is solid and to be decomposed: the pieces of a decomposition are solid anyway"));
        }
        return Ok(decomposed(&vertices, &triangles).map(|pieces| Shape::compound(Arc::new(pieces))));
    }
    let mesh =
        if solid { TriangleMesh::solid(vertices, triangles) } else { TriangleMesh::surface(vertices, triangles) };
    Ok(mesh.map(|mesh| Shape::mesh(Arc::new(mesh))))
}

fn read_compound(params: &Field) -> Result<Result<Shape, InvalidShape>, FieldError> {
    let mut parts = Vec::new();
    for part in params.member("parts")?.elements()? {
        parts.push(Part { shape: read_shape(&part.member("shape")?)?, pose: read_pose(&part.member("pose")?)? });
    }
    Ok(Compound::new(parts).map(|compound| Shape::compound(Arc::new(compound))))
}

fn read_height_field(params: &Field) -> Result<Result<Shape, InvalidShape>, FieldError> {
    let [x, y] = params.member("spacing")?.exactly()?;
    let (rows, columns) = (params.member("rows")?.index()?, params.member("columns")?.index()?);
    let grid = Grid { rows, columns, spacing: [x.number()?, y.number()?] };
    let (heights, floor) = (params.member("heights")?.numbers()?, params.member("floor")?.number()?);
    Ok(HeightField::new(grid, heights, floor).map(|field| Shape::height_field(Arc::new(field))))
}

fn read_point_cloud(params: &Field) -> Result<Result<Shape, InvalidShape>, FieldError> {
    let points = params.member("points")?.vectors()?;
    let radius = params.optional("radius").map(|field| field.number()).transpose()?.unwrap_or(0.0);
    Ok(PointCloud::new(&points).and_then(|cloud| Shape::point_cloud(Arc::new(cloud), radius)))
}

fn read_voxels(params: &Field) -> Result<Result<Shape, InvalidShape>, FieldError> {
    let points = params.optional("points").map(|field| field.vectors()).transpose()?.unwrap_or_default();
    let mut cells = Vec::new();
    for cell in params.optional("cells").map(|field| field.elements()).transpose()?.unwrap_or_default() {
        let [i, j, k] = cell.exactly()?;
        cells.push([i.integer()?, j.integer()?, k.integer()?]);
    }
    let map = Voxels::new(params.member("resolution")?.number()?);
    Ok(map.and_then(|map| map.with_cells(&cells)?.with_points(&points)).map(Shape::voxels))
}

/// The pose of a frame in the world, or in the frame of a compound.
///
/// # Errors
/// Names the field that is missing, of the wrong kind, or refused by the geometry.
pub fn read_pose(pose: &Field) -> Result<Pose, FieldError> {
    let translation = pose.member("t")?.vector()?;
    let [w, x, y, z] = pose.member("q")?.exactly()?;
    let rotation = Quaternion { w: w.number()?, x: x.number()?, y: y.number()?, z: z.number()? };
    Pose::new(translation, rotation).map_err(|error| pose.error(error))
}

/// The member `id` of a line that is broken behind it.
fn id_before_the_error(line: &[u8]) -> Value {
    let mut id = Value::Null;
    // The error was reported; here it only ends the search.
    let _ = IdSearch(&mut id).deserialize(&mut serde_json::Deserializer::from_slice(line));
    id
}

/// Reads an object member by member and keeps the id as soon as it has it.
struct IdSearch<'a>(&'a mut Value);

impl<'de> DeserializeSeed<'de> for IdSearch<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for IdSearch<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("an object")
    }

    fn visit_map<M: MapAccess<'de>>(self, mut members: M) -> Result<(), M::Error> {
        while let Some(name) = members.next_key::<String>()? {
            if name == "id" {
                *self.0 = members.next_value()?;
            } else {
                members.next_value::<IgnoredAny>()?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn shape(value: Value) -> Result<Shape, String> {
        read_shape(&Field { value: &value, path: "a".to_owned() }).map_err(|e| e.to_string())
    }

    #[test]
    fn every_type_is_read() {
        let v = json!([1.0, 2.0, 3.0]);
        let round = json!({"radius": 1.0, "half_length": 2.0});
        let flat = json!({"normal": v, "offset": -1});
        let pose = json!({"t": [0, 0, 0], "q": [2, 0, 0, 0]});
        let ball = json!({"type": "sphere", "params": {"radius": 1}});
        let tetrahedron = json!({"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
            "triangles": [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]], "solid": true});
        for (kind, params) in [
            ("sphere", json!({"radius": 1.0})),
            ("point", json!({})),
            ("box", json!({"half_extents": v})),
            ("capsule", round.clone()),
            ("cylinder", round.clone()),
            ("cone", round),
            ("ellipsoid", json!({"radii": v})),
            ("convex", json!({"points": [v]})),
            ("triangle", json!({"a": v, "b": v, "c": v})),
            ("segment", json!({"a": v, "b": v})),
            ("half_space", flat.clone()),
            ("plane", flat),
            ("mesh", tetrahedron),
            ("compound", json!({"parts": [{"shape": ball, "pose": pose}]})),
            ("height_field", json!({"rows": 2, "columns": 2, "spacing": [1, 2], "heights": [0, 1, 2, 3], "floor": -1})),
            ("point_cloud", json!({"points": [v, v], "radius": 0.1})),
            ("voxels", json!({"resolution": 0.5, "points": [v], "cells": [[-1, 2, 0]]})),
        ] {
            let mut params = params;
            let plain = shape(json!({"type": kind, "params": params})).unwrap();
            assert_eq!(plain.kind(), kind);
            params["margin"] = json!(0.25);
            let swept = shape(json!({"type": kind, "params": params})).unwrap();
            assert_eq!(swept.swept_radius(), plain.swept_radius() + 0.25, "{kind}");
        }
        assert_eq!(shape(json!({"type": "point"})).unwrap().kind(), "point");
        let params = json!({"normal": [0, 0, 1], "offset": 0});
        assert_eq!(shape(json!({"type": "halfspace", "params": params})).unwrap().kind(), "half_space");
    }

    #[test]
    fn complaints_name_the_field() {
        for (value, complaint) in [
            (json!(3), "a: is another number, not an object"),
            (json!({}), "a.type: is missing"),
            (json!({"type": "blob"}), "a.type: no shape is called \"blob\""),
            (json!({"type": "sphere"}), "a.params.radius: is missing"),
            (json!({"type": "sphere", "params": {"radius": "1"}}), "a.params.radius: is a text, not a number"),
            (json!({"type": "sphere", "params": {"radius": -1.0}}), "a.params: radius is negative: -1"),
            (
                json!({"type": "sphere", "params": {"radius": 1, "margn": 1}}),
                "a.params: has a member \"margn\"; known are: radius, margin",
            ),
            (
                json!({"type": "sphere", "params": {"radius": 1, "margin": -1}}),
                "a.params.margin: swept_radius is negative: -1",
            ),
            (
                json!({"type": "box", "params": {"half_extents": [1, 2]}}),
                "a.params.half_extents: has 2 elements, 3 are needed",
            ),
            (
                json!({"type": "box", "params": {"half_extents": [1, null, 2]}}),
                "a.params.half_extents[1]: is null, not a number",
            ),
            (json!({"type": "convex", "params": {"points": []}}), "a.params: points is empty"),
            (
                json!({"type": "mesh", "params": {"vertices": [[0, 0, 0]], "triangles": [[0, 0, -1]]}}),
                "a.params.triangles[0][2]: is another number, not an index",
            ),
            (
                json!({"type": "height_field", "params": {"rows": 2, "columns": 2, "spacing": [1, 1], "heights": [1, 2, 3], "floor": 0}}),
                "a.params: heights has 3 numbers, 4 are needed",
            ),
            (
                json!({"type": "height_field", "params": {"rows": 2, "columns": -2, "spacing": [1, 1], "heights": [], "floor": 0}}),
                "a.params.columns: is another number, not an index",
            ),
            (json!({"type": "point_cloud", "params": {"points": []}}), "a.params: points is empty"),
            (json!({"type": "voxels", "params": {"resolution": 0}}), "a.params: resolution is not positive: 0"),
            (
                json!({"type": "voxels", "params": {"resolution": 1, "cells": [[0, 1.5, 0]]}}),
                "a.params.cells[0][1]: is another number, not a whole number",
            ),
            (
                json!({"type": "point_cloud", "params": {"points": [[0, 0, 0]], "radius": -1}}),
                "a.params: radius is negative: -1",
            ),
            (
                json!({"type": "mesh", "params": {"vertices": [[0, 0, 0]], "triangles": [[0, 0, 1]]}}),
                "a.params: triangles[0] names vertex 1, but there are 1 vertices",
            ),
        ] {
            assert_eq!(shape(value.clone()).unwrap_err(), complaint, "{value}");
        }
        let zero = json!({"t": [0, 0, 0], "q": [0, 0, 0, 0]});
        let error = read_pose(&Field { value: &zero, path: "pose_b".to_owned() }).unwrap_err();
        assert_eq!(error.to_string(), "pose_b: rotation is the zero quaternion");
    }

    #[test]
    fn the_id_of_an_unreadable_line_is_kept_when_it_stands_before_the_error() {
        let (id, case) = read_line(br#"{"id": "x-1", "a": {"type": "sphere", "params": {"radius": NaN}}}"#);
        assert_eq!(id, json!("x-1"));
        assert!(case.unwrap_err().starts_with("line: is not JSON"));
        assert_eq!(read_line(b"{\"a\": NaN, \"id\": 7}").0, Value::Null);
        assert_eq!(read_line(b"[1]").1.unwrap_err(), "line: is a list, not an object");
        assert_eq!(read_line(b"{\"id\": 7}").0, json!(7));
        assert!(read_line(b"\xff\xfe").1.is_err());
    }
}
