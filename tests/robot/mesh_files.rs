//! One cube in every format; other readers of the same files; files that are cut, bent or lie.

use std::fs;

use clearance::geometry::mesh_file::{MeshFileError, MeshFormat, MeshSoup, read};
use clearance::geometry::{TriangleMesh, Vec3};
use proptest::prelude::*;

const OBJ: &[u8] = include_bytes!("../data/meshes/cube.obj");
const TEXT_STL: &[u8] = include_bytes!("../data/meshes/cube_text.stl");
const BINARY_STL: &[u8] = include_bytes!("../data/meshes/cube_binary.stl");
const COLLADA: &[u8] = include_bytes!("../data/meshes/cube.dae");

/// The cube as `.glb`: corners of a unit cube, a node that halves and one that moves them.
fn glb() -> Vec<u8> {
    let (json, binary) = gltf_parts("");
    let mut json = json.into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut file = b"glTF".to_vec();
    let word = |n: usize| u32::try_from(n).unwrap().to_le_bytes();
    file.extend([word(2), word(12 + 8 + json.len() + 8 + binary.len()), word(json.len())].concat());
    file.extend(b"JSON");
    file.extend(json);
    file.extend(word(binary.len()));
    file.extend(b"BIN\0");
    file.extend(binary);
    file
}

/// The JSON, with `uri` (a whole member and a comma, or nothing) in its buffer, and the buffer's bytes.
fn gltf_parts(uri: &str) -> (String, Vec<u8>) {
    let soup = read(OBJ, MeshFormat::Obj).unwrap();
    let mut binary = Vec::new();
    for corner in soup.triangles.iter().flatten() {
        binary.extend(u16::try_from(*corner).unwrap().to_le_bytes());
    }
    let indices = binary.len();
    for p in &soup.vertices {
        let unit = 2.0 * (p - Vec3::new(0.0, 0.25, 0.375));
        unit.iter().for_each(|c| binary.extend((*c as f32).to_le_bytes()));
    }
    let json = format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}],
        "nodes": [{{"children": [1], "translation": [0, 0.25, 0.375]}}, {{"mesh": 0, "scale": [0.5, 0.5, 0.5]}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 1}}, "indices": 0}}]}}],
        "accessors": [
            {{"bufferView": 0, "componentType": 5123, "type": "SCALAR", "count": {}}},
            {{"bufferView": 1, "componentType": 5126, "type": "VEC3", "count": 8}}],
        "bufferViews": [
            {{"buffer": 0, "byteLength": {indices}}},
            {{"buffer": 0, "byteOffset": {indices}, "byteLength": 96}}],
        "buffers": [{{{uri}"byteLength": {}}}]}}"#,
        indices / 2,
        binary.len()
    );
    (json, binary)
}

fn files() -> Vec<(&'static str, Vec<u8>)> {
    vec![
        ("cube.obj", OBJ.to_vec()),
        ("cube_text.STL", TEXT_STL.to_vec()),
        ("cube_binary.stl", BINARY_STL.to_vec()),
        ("cube.dae", COLLADA.to_vec()),
        ("cube.glb", glb()),
    ]
}

fn corners(soup: &MeshSoup) -> Vec<[f64; 3]> {
    let mut corners: Vec<[f64; 3]> = soup.vertices.iter().map(|v| [v.x, v.y, v.z]).collect();
    corners.sort_by(|a, b| a.partial_cmp(b).unwrap());
    corners
}

/// Volume within, positive when triangles face outwards.
fn volume(soup: &MeshSoup) -> f64 {
    let signed = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| soup.vertices[i as usize]);
        a.dot(&b.cross(&c)) / 6.0
    };
    soup.triangles.iter().map(signed).sum()
}

fn error(bytes: &[u8], format: MeshFormat) -> String {
    read(bytes, format).unwrap_err().to_string()
}

#[test]
fn the_cube_is_the_same_in_every_format() {
    let mut expected = Vec::new();
    for x in [-0.25, 0.25] {
        for y in [0.0, 0.5] {
            expected.extend([[x, y, 0.125], [x, y, 0.625]]);
        }
    }
    for (name, bytes) in files() {
        let soup = read(&bytes, MeshFormat::from_name(name).unwrap()).unwrap();
        assert_eq!(corners(&soup), expected, "{name}");
        assert_eq!(soup.triangles.len(), 12, "{name}");
        assert_eq!(volume(&soup), 0.125, "{name}");
        assert!(TriangleMesh::solid(soup.vertices, soup.triangles).is_ok(), "{name}");
    }
}

#[test]
fn numbers_are_the_nearest_to_what_is_written() {
    let obj = "v 0.1 1e-3 -12345.678901234567\nv 1 0 0 \nv 0 1 0\nf 1 2 3\n";
    let soup = read(obj.as_bytes(), MeshFormat::Obj).unwrap();
    assert_eq!(soup.vertices[0], Vec3::new(0.1, 1e-3, -12345.678901234567));
    let dae = std::str::from_utf8(COLLADA).unwrap();
    let dae = dae.replace("meter=\"0.5\"", "meter=\"1\"").replace("0.5 0</translate>", "0 0</translate>");
    let dae = dae.replace("1 0.75", "1 0").replace(">-0.5 -0.5 -0.5 ", ">0.1 1e-3 -12345.678901234567 ");
    let soup = read(dae.as_bytes(), MeshFormat::Collada).unwrap();
    assert!(soup.vertices.contains(&Vec3::new(0.1, 1e-3, -12345.678901234567)));
}

/// Reference: the crates `tobj` and `stl_io`, on meshes of the UR5 and on the cube.
#[test]
fn other_readers_see_the_same_triangles() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/robot-ur5/meshes");
    let mut meshes = 0;
    for entry in fs::read_dir(folder).unwrap() {
        let bytes = fs::read(entry.unwrap().path()).unwrap();
        let ours = read(&bytes, MeshFormat::Obj).unwrap();
        let options = tobj::LoadOptions { triangulate: true, single_index: true, ..Default::default() };
        let (models, _) =
            tobj::load_obj_buf(&mut bytes.as_slice(), &options, |_| tobj::MTLLoadResult::Ok(Default::default()))
                .unwrap();
        let theirs =
            models.iter().flat_map(|m| m.mesh.indices.iter().map(|&i| &m.mesh.positions[3 * i as usize..][..3]));
        let ours = ours.triangles.iter().flatten().map(|&i| ours.vertices[i as usize]);
        assert!(ours.eq(theirs.map(Vec3::from_column_slice)));
        meshes += 1;
    }
    assert_eq!(meshes, 17);
    let theirs = stl_io::read_stl(&mut std::io::Cursor::new(TEXT_STL)).unwrap();
    let ours = read(TEXT_STL, MeshFormat::Stl).unwrap();
    let theirs = theirs.faces.iter().flat_map(|f| f.vertices).map(|i| theirs.vertices[i].0.map(f64::from));
    assert!(ours.triangles.iter().flatten().map(|&i| ours.vertices[i as usize]).eq(theirs.map(Vec3::from)));
}

#[test]
fn gltf_text_holds_its_buffer_inline_or_is_refused() {
    let (_, binary) = gltf_parts("");
    let encode = |bytes: &[u8]| -> String {
        const LETTERS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        bytes
            .chunks_exact(3) // 168 bytes: no padding.
            .flat_map(|c| {
                let bits = u32::from_be_bytes([0, c[0], c[1], c[2]]);
                [18, 12, 6, 0].map(|shift| char::from(LETTERS[(bits >> shift & 63) as usize]))
            })
            .collect()
    };
    assert_eq!(binary.len() % 3, 0);
    let uri = format!(r#""uri": "data:application/octet-stream;base64,{}", "#, encode(&binary));
    let soup = read(gltf_parts(&uri).0.as_bytes(), MeshFormat::Gltf).unwrap();
    assert_eq!(volume(&soup), 0.125);
    let outside = gltf_parts(r#""uri": "../secret.bin", "#).0;
    let text = error(outside.as_bytes(), MeshFormat::Gltf);
    assert_eq!(text, r#"buffers[0] is in another file, "../secret.bin"; pack it into a .glb or a data: URI"#);
}

#[test]
fn mirroring_nodes_keep_triangles_facing_outwards() {
    let (json, binary) = gltf_parts("");
    let mirrored = json.replace(r#""scale": [0.5"#, r#""scale": [-0.5"#);
    assert_eq!(json.len() + 1, mirrored.len());
    let mut file = glb();
    let dae = std::str::from_utf8(COLLADA).unwrap();
    let dae = dae.replace("<matrix>1 0", "<matrix>-1 0");
    assert_eq!(volume(&read(dae.as_bytes(), MeshFormat::Collada).unwrap()), 0.125);
    let at = 20 + json.len().next_multiple_of(4);
    let padded = mirrored.len().next_multiple_of(4);
    let mut text = mirrored.into_bytes();
    text.resize(padded, b' ');
    file.splice(20..at, text);
    let total = u32::try_from(file.len()).unwrap();
    file.splice(8..12, total.to_le_bytes());
    file.splice(12..16, u32::try_from(padded).unwrap().to_le_bytes());
    assert_eq!(file.len(), 12 + 8 + padded + 8 + binary.len());
    assert_eq!(volume(&read(&file, MeshFormat::Gltf).unwrap()), 0.125);
}

#[test]
fn wrong_files_are_refused_by_name() {
    let dae = std::str::from_utf8(COLLADA).unwrap();
    let dae_with = |from: &str, to: &str| {
        assert!(dae.contains(from), "{from}");
        error(dae.replace(from, to).as_bytes(), MeshFormat::Collada)
    };
    let gltf_with = |from: &str, to: &str| {
        let text =
            gltf_parts(r#""uri": "data:;base64,AAAA", "#).0.replace(r#""byteLength": 168}]"#, r#""byteLength": 3}]"#);
        assert!(text.contains(from), "{from}");
        error(text.replace(from, to).as_bytes(), MeshFormat::Gltf)
    };
    let mut count_lies = BINARY_STL.to_vec();
    count_lies[..5].copy_from_slice(b"     ");
    count_lies[83] = 0xff;
    let mut not_a_number = BINARY_STL.to_vec();
    not_a_number[84 + 50 + 24..][..4].copy_from_slice(&f32::NAN.to_le_bytes());
    let cases: Vec<(String, &str)> = vec![
        (
            MeshFormat::from_name("cube.step").unwrap_err().to_string(),
            r#""cube.step" does not end in .obj, .stl, .dae, .gltf or .glb"#,
        ),
        (error(b"", MeshFormat::Obj), "the file has no triangles"),
        (error(b"v 0 0\n", MeshFormat::Obj), "line 1 has no three coordinates"),
        (error(b"v 0 0 nan\n", MeshFormat::Obj), r#"line 1: "nan" is not a finite number"#),
        (error(b"v 0 0 0\nf 1 1 2\n", MeshFormat::Obj), "line 2 names vertex 2, but there are 1"),
        (error(b"v 0 0 0\nf 1 1 0\n", MeshFormat::Obj), "line 2 names vertex 0, but there are 1"),
        (
            error(b"v 0 0 0\nf 1 1 -9223372036854775808\n", MeshFormat::Obj),
            "line 2 names vertex -9223372036854775808, but there are 1",
        ),
        (error(b"v 0 0 0\nf 1 1\n", MeshFormat::Obj), "line 2: a face needs three corners"),
        (error(b"v 0 0 \xff\n", MeshFormat::Obj), "byte 6 is not UTF-8 text"),
        (error(b"", MeshFormat::Stl), "binary STL needs 84 bytes, but there are 0"),
        (error(&count_lies, MeshFormat::Stl), "binary STL needs 213909504684 bytes, but there are 684"),
        (error(&not_a_number, MeshFormat::Stl), r#"triangle 1: "NaN" is not a finite number"#),
        (error(&TEXT_STL[..TEXT_STL.len() - 14], MeshFormat::Stl), "text STL has no endsolid"),
        (error(b"solid x\nfacet\nvertex 0 0 0\nendfacet\n", MeshFormat::Stl), "line 4: a facet needs three vertices"),
        (
            dae_with("#cube", "#ball"),
            r##"<instance_geometry> in line 37: url="#ball" is not a <geometry> of this file"##,
        ),
        (dae_with("count=\"8\"", "count=\"9\""), "<accessor> in line 11 names number 27, but there are 24"),
        (
            dae_with("count=\"8\"", "count=\"18446744073709551615\""),
            "<accessor> in line 11 names number 9223372036854775807, but there are 24",
        ),
        (dae_with("<p>0 0 ", "<p>8 0 "), "<p> in line 21 names vertex 8, but there are 8"),
        (dae_with("<vcount>4 4", "<vcount>4 5"), "<vcount> in line 20: indices do not make whole polygons"),
        (dae_with("meter=\"0.5\"", "meter=\"0\""), "<unit> in line 4: meter is not positive"),
        (dae_with("0 0 1 0</rotate>", "0 0 0 0</rotate>"), "<rotate> in line 35 has no axis"),
        (
            dae_with("instance_geometry", "instance_controller"),
            "<node> in line 34: instance_controller is not supported",
        ),
        (gltf_with("5126", "5123"), "accessors[1]: a position of type 5123 VEC3 is not supported"),
        (gltf_with(r#""count": 8"#, r#""count": 9"#), "accessors[1] needs 180 bytes, but there are 3"),
        (
            gltf_with(r#""count": 8"#, r#""count": 18446744073709551615"#),
            "accessors[1] needs 18446744073709551615 bytes, but there are 3",
        ),
        (gltf_with(r#""children": [1]"#, r#""children": [0]"#), "nodes[0]: has two parents, or is its own ancestor"),
        (gltf_with(r#""children": [1]"#, r#""children": [7]"#), "nodes names node 7, but there are 2"),
        (gltf_with(r#""scene": 0"#, r#""scene": 3"#), "scene names scene 3, but there are 1"),
        (
            gltf_with(r#""scene": 0"#, r#""extensionsRequired": ["KHR_draco_mesh_compression"]"#),
            r#"extensionsRequired: "KHR_draco_mesh_compression" is not supported"#,
        ),
        (gltf_with(r#""byteLength": 3}"#, r#""byteLength": 4}"#), "buffers[0] needs 4 bytes, but there are 3"),
        (error(b"glTF\x02\0\0\0\x05\0\0\0", MeshFormat::Gltf), "GLB header: length 5 is below 12"),
        (error(b"glTF\x02\0\0\0\xff\xff\xff\xff", MeshFormat::Gltf), "GLB needs 4294967295 bytes, but there are 12"),
    ];
    let (found, expected): (Vec<String>, Vec<&str>) = cases.into_iter().unzip();
    assert_eq!(found, expected);
}

/// Files much deeper than any stack, and a file whose scene graph multiplies what it holds.
#[test]
fn depth_and_repetition_are_bounded() {
    let deep = 200_000;
    let dae = std::str::from_utf8(COLLADA).unwrap();
    let nested = dae
        .replace("<node id=\"inner\">", &format!("{}<node id=\"inner\">", "<node>".repeat(deep)))
        .replace("</node>\n      </node>", &format!("</node>{}</node>", "</node>".repeat(deep)));
    assert_eq!(volume(&read(nested.as_bytes(), MeshFormat::Collada).unwrap()), 0.125);
    let triangle = "0 1 2 ".repeat(400_000);
    let instances = "<instance_geometry url=\"#cube\"/>".repeat(100);
    let repeated = dae
        .replace("<instance_geometry url=\"#cube\"/>", &instances)
        .replace("<triangles count=\"4\">", &format!("<trifans><input semantic=\"VERTEX\" source=\"#vertices\"/><p>{triangle}</p></trifans><triangles count=\"4\">"));
    assert_eq!(read(repeated.as_bytes(), MeshFormat::Collada), Err(MeshFileError::TooManyTriangles));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]

    /// Whatever the bytes: triangles in range over finite vertices, or an error. Never a panic.
    #[test]
    fn bent_files_never_panic(
        which in 0..5usize,
        keep in 0.0..1.3f64,
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), any::<bool>()), 0..6),
    ) {
        let (name, mut bytes) = files().swap_remove(which);
        bytes.truncate((keep * bytes.len() as f64) as usize);
        for (at, byte, digit) in edits {
            if !bytes.is_empty() {
                let at = at.index(bytes.len());
                bytes[at] = if digit { b'0' + byte % 10 } else { byte };
            }
        }
        if let Ok(soup) = read(&bytes, MeshFormat::from_name(name).unwrap()) {
            prop_assert!(!soup.triangles.is_empty());
            prop_assert!(soup.triangles.iter().flatten().all(|&i| (i as usize) < soup.vertices.len()));
            prop_assert!(soup.vertices.iter().flatten().all(|c| c.is_finite()));
        }
    }
}
