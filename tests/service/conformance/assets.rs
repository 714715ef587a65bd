//! Uploads and what is made of them.

use clearance::limits::Limits;
use clearance::transports::wire::v1;
use tonic::Code;

use super::through_every_door;
use crate::support::door::Door;
use crate::support::messages::*;

through_every_door!(
    an_uploaded_mesh_is_a_shape,
    a_second_upload_is_told_that_the_file_is_there,
    bytes_that_are_not_what_was_announced_are_refused,
    a_mesh_that_cannot_be_is_refused_where_it_is_used,
);

fn limits() -> Limits {
    Limits { max_asset_bytes: 1000, ..Limits::default() }
}

async fn an_uploaded_mesh_is_a_shape(door: &impl Door) {
    let stored = door.put_asset(announced(TETRAHEDRON), TETRAHEDRON).await.unwrap();
    door.create_scene(SCENE).await.unwrap();
    let inside = placed(sphere(0.01), at(0.1, 0.1, 0.1));
    for (mode, expected) in [
        (v1::MeshMode::Exact, v1::Verdict::Free), // A surface without interior.
        (v1::MeshMode::Hull, v1::Verdict::Collision),
        (v1::MeshMode::Solid, v1::Verdict::Collision),
    ] {
        let shape = mesh_asset(stored.sha256.clone(), mode);
        door.apply(apply(vec![add("mesh", shape, at(0.0, 0.0, 0.0))])).await.unwrap();
        let answer = door.collide(collide(vec![inside.clone()])).await.unwrap();
        assert_eq!(verdicts(&answer), [expected], "{mode:?}");
        door.apply(apply(vec![remove(named("mesh"))])).await.unwrap();
    }
}

async fn a_second_upload_is_told_that_the_file_is_there(door: &impl Door) {
    assert!(!door.put_asset(announced(TETRAHEDRON), TETRAHEDRON).await.unwrap().already_present);
    let again = door.put_asset(announced(TETRAHEDRON), TETRAHEDRON).await.unwrap();
    assert!(again.already_present && again.bytes == TETRAHEDRON.len() as u64);
}

async fn bytes_that_are_not_what_was_announced_are_refused(door: &impl Door) {
    let mut other = TETRAHEDRON.to_vec();
    other[2] ^= 1;
    for bytes in [&other[..], &TETRAHEDRON[1..], b""] {
        let refusal = door.put_asset(announced(TETRAHEDRON), bytes).await.unwrap_err();
        assert_eq!((refusal.code, refusal.reason.as_str()), (Code::DataLoss, "HASH_MISMATCH"), "{refusal:?}");
    }
    let longer = [TETRAHEDRON, b"\n"].concat();
    assert_eq!(door.put_asset(announced(TETRAHEDRON), &longer).await.unwrap_err().code, Code::DataLoss);
    let no_hash = v1::AssetHeader { sha256: "abc".to_owned(), bytes: 3 };
    let refusal = door.put_asset(no_hash, b"abc").await.unwrap_err();
    assert_eq!((refusal.code, refusal.field.as_str()), (Code::InvalidArgument, "header.sha256"));
    let large = v1::AssetHeader { bytes: 1001, ..announced(TETRAHEDRON) };
    assert_eq!(door.put_asset(large, b"").await.unwrap_err().code, Code::ResourceExhausted);
}

async fn a_mesh_that_cannot_be_is_refused_where_it_is_used(door: &impl Door) {
    let open = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let stored = door.put_asset(announced(open), open).await.unwrap();
    let garbage = b"f 1 2 3\n";
    let bad = door.put_asset(announced(garbage), garbage).await.unwrap();
    door.create_scene(SCENE).await.unwrap();
    let using = |sha256: &str, mode| apply(vec![add("mesh", mesh_asset(sha256.to_owned(), mode), at(0.0, 0.0, 0.0))]);
    let refusal = door.apply(using(&stored.sha256, v1::MeshMode::Solid)).await.unwrap_err();
    assert_eq!(refusal.field, "edits[0].add_body.shape.mesh_asset", "{refusal:?}");
    let refusal = door.apply(using(&bad.sha256, v1::MeshMode::Exact)).await.unwrap_err();
    assert_eq!(refusal.field, "edits[0].add_body.shape.mesh_asset.sha256", "{refusal:?}");
    let refusal = door.apply(using(&announced(b"?").sha256, v1::MeshMode::Exact)).await.unwrap_err();
    assert_eq!(refusal.code, Code::NotFound, "{refusal:?}");
}
