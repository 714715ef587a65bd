//! Meshes as convex pieces, and what those cost.

use std::fmt::Write;

use clearance::limits::Limits;
use clearance::transports::wire::v1;
use tonic::Code;

use super::through_every_door;
use crate::support::door::Door;
use crate::support::messages::*;

through_every_door!(
    a_decomposed_mesh_is_solid_where_the_mesh_is_and_free_where_its_hull_is_not,
    the_cost_card_says_what_a_hull_and_a_decomposition_reach_and_lose,
    cards_that_cannot_be_are_refused_by_field,
);

fn limits() -> Limits {
    Limits::default()
}

/// An L of two bars, 1 m long and 0.2 m thick, as OBJ.
fn corner_piece() -> Vec<u8> {
    let outline = [(0.0, 0.0), (1.0, 0.0), (1.0, 0.2), (0.2, 0.2), (0.2, 1.0), (0.0, 1.0)];
    let mut text = String::new();
    for z in [0.0, 0.2] {
        outline.iter().for_each(|(x, y)| writeln!(text, "v {x} {y} {z}").unwrap());
    }
    let mut face = |a: usize, b: usize, c: usize| writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1).unwrap();
    for [a, b, c] in [[0, 1, 2], [0, 2, 3], [0, 3, 5], [3, 4, 5]] {
        face(a, c, b);
        face(a + 6, b + 6, c + 6);
    }
    for i in 0..6 {
        let j = (i + 1) % 6;
        face(i, j, j + 6);
        face(i, j + 6, i + 6);
    }
    text.into_bytes()
}

async fn a_decomposed_mesh_is_solid_where_the_mesh_is_and_free_where_its_hull_is_not(door: &impl Door) {
    let file = corner_piece();
    let stored = door.put_asset(announced(&file), &file).await.unwrap();
    door.create_scene(SCENE).await.unwrap();
    let shape = mesh_asset(stored.sha256, v1::MeshMode::Decompose);
    door.apply(apply(vec![add("l", shape, at(0.0, 0.0, 0.0))])).await.unwrap();
    let balls = [(0.1, 0.1), (0.9, 0.1), (0.1, 0.9), (0.55, 0.55), (1.2, 0.1)];
    let items = balls.map(|(x, y)| placed(sphere(0.02), at(x, y, 0.1))).to_vec();
    let answer = door.collide(collide(items)).await.unwrap();
    let [hit, free] = [v1::Verdict::Collision, v1::Verdict::Free];
    assert_eq!(verdicts(&answer), [hit, hit, hit, free, free]);
    let contents = door
        .get_scene(v1::GetSceneRequest { scene: SCENE.to_owned(), ..v1::GetSceneRequest::default() })
        .await
        .unwrap();
    assert_eq!(contents.bodies[0].shape_kind, "compound");
}

fn described(sha256: &str, mode: v1::MeshMode) -> v1::DescribeMeshRequest {
    let Some(v1::shape::Core::MeshAsset(mesh)) = mesh_asset(sha256.to_owned(), mode).core else { panic!("no asset") };
    v1::DescribeMeshRequest { mesh: Some(mesh), accuracy: None }
}

async fn the_cost_card_says_what_a_hull_and_a_decomposition_reach_and_lose(door: &impl Door) {
    let file = corner_piece();
    let hash = door.put_asset(announced(&file), &file).await.unwrap().sha256;
    let hull = door.describe_mesh(described(&hash, v1::MeshMode::Hull)).await.unwrap();
    let inflation = hull.inflation.unwrap();
    // The middle of the hypotenuse is 0.4 from both bars.
    assert!(inflation.lower <= 0.4 + 1e-9 && 0.4 <= inflation.upper && inflation.upper < 0.402, "{hull:?}");
    assert!(hull.loss.unwrap().upper < 2e-3 && hull.pieces == 1 && hull.closed, "{hull:?}");
    let pieces = door.describe_mesh(described(&hash, v1::MeshMode::Decompose)).await.unwrap();
    let (inflation, loss) = (pieces.inflation.unwrap(), pieces.loss.unwrap());
    assert!(pieces.pieces > 1 && inflation.upper < 0.1 && loss.upper < 0.02, "{pieces:?}");
    assert!(pieces.bytes > hull.bytes && pieces.build_seconds > 0.0 && pieces.points > 0, "{pieces:?}");
}

async fn cards_that_cannot_be_are_refused_by_field(door: &impl Door) {
    let file = corner_piece();
    let hash = door.put_asset(announced(&file), &file).await.unwrap().sha256;
    let exact = described(&hash, v1::MeshMode::Exact);
    let accurate = v1::DescribeMeshRequest { accuracy: Some(0.0), ..described(&hash, v1::MeshMode::Hull) };
    let nothing = v1::DescribeMeshRequest { mesh: None, accuracy: None };
    for (request, field) in [(exact, "mesh.mode"), (accurate, "accuracy"), (nothing, "mesh")] {
        let refusal = door.describe_mesh(request).await.expect_err(field);
        assert_eq!((refusal.code, refusal.field.as_str()), (Code::InvalidArgument, field), "{refusal:?}");
    }
    let missing = described(&announced(b"?").sha256, v1::MeshMode::Hull);
    assert_eq!(door.describe_mesh(missing).await.unwrap_err().code, Code::NotFound);
}
