//! Contact patches, through every door. Oracle: closed forms of boxes.

use clearance::limits::Limits;
use clearance::transports::wire::v1;
use prost::Message;
use tonic::Code;

use super::through_every_door;
use crate::support::door::Door;
use crate::support::messages::*;

through_every_door!(
    boxes_that_overlap_touch_in_four_points,
    what_is_not_wanted_is_not_sent_and_what_is_changes_nothing_else,
    a_margin_adds_the_contacts_that_are_about_to_be,
    a_robots_link_has_patches,
    points_that_no_patch_has_are_refused,
);

fn limits() -> Limits {
    Limits::default()
}

/// A table whose top is at 0, a box that sinks 10 mm into it, and one that hovers 20 mm above.
async fn table(door: &impl Door) {
    door.create_scene(SCENE).await.unwrap();
    let edits = vec![
        add("table", cuboid(1.0, 1.0, 0.5), at(0.0, 0.0, -0.5)),
        add("sunk", cuboid(0.1, 0.2, 0.1), at(0.5, 0.5, 0.09)),
        add("hovers", cuboid(0.1, 0.1, 0.1), at(-0.5, 0.0, 0.12)),
    ];
    door.apply(apply(edits)).await.unwrap();
}

fn wanting(wants: v1::Wants) -> v1::CollideRequest {
    let context = v1::Context { wants: Some(wants), ..context() };
    v1::CollideRequest { context: Some(context), ..collide(vec![all_pairs()]) }
}

const PATCH: v1::Wants =
    v1::Wants { distance: false, witness: false, depth: false, pairs: true, patch: true, derivatives: false };

async fn boxes_that_overlap_touch_in_four_points(door: &impl Door) {
    table(door).await;
    let answer = door.collide(wanting(PATCH)).await.unwrap();
    let pairs = &answer.items[0].pairs;
    assert_eq!(pairs.len(), 1, "{pairs:?}");
    let patch = pairs[0].patch.as_ref().unwrap();
    assert_eq!(
        (patch.normal, patch.points.len(), patch.corners, patch.truncated),
        (Some(vec3(0.0, 0.0, 1.0)), 4, 4, false)
    );
    for (x, y) in [(0.4, 0.3), (0.6, 0.3), (0.6, 0.7), (0.4, 0.7)] {
        let is_there = |point: &&v1::ContactPoint| {
            let (a, b) = (point.point_on_a.unwrap(), point.point_on_b.unwrap());
            let off = [a.x - x, a.y - y, a.z, b.x - x, b.y - y, b.z + 0.01, point.signed_distance + 0.01];
            off.iter().all(|off| off.abs() < 1e-9)
        };
        assert_eq!(patch.points.iter().filter(is_there).count(), 1, "({x}, {y}): {patch:?}");
    }
    let cost = answer.cost.unwrap();
    assert!(cost.patch_corners > 0 && answer.items[0].cost == answer.cost, "{cost:?}");
}

async fn what_is_not_wanted_is_not_sent_and_what_is_changes_nothing_else(door: &impl Door) {
    table(door).await;
    let plain = v1::Wants { distance: true, witness: true, depth: true, pairs: true, patch: false, derivatives: false };
    let without = door.collide(wanting(plain)).await.unwrap();
    let mut with = door.collide(wanting(v1::Wants { patch: true, ..plain })).await.unwrap();
    let cost = without.cost.unwrap();
    assert_eq!((cost.patch_corners, cost.patch_cuts), (0, 0));
    assert!(with.items.iter().all(|item| item.nearest.as_ref().unwrap().patch.is_some()));
    let strip = |cost: &mut Option<v1::Cost>| {
        let cost = cost.as_mut().unwrap();
        (cost.patch_corners, cost.patch_cuts) = (0, 0);
    };
    strip(&mut with.cost);
    for item in &mut with.items {
        strip(&mut item.cost);
        item.pairs.iter_mut().chain(&mut item.nearest).for_each(|pair| pair.patch = None);
    }
    // Byte for byte: what an effect that is off leaves in the answer is nothing at all.
    assert_eq!(with.encode_to_vec(), without.encode_to_vec());
}

async fn a_margin_adds_the_contacts_that_are_about_to_be(door: &impl Door) {
    table(door).await;
    let mut question = wanting(PATCH);
    question.context.as_mut().unwrap().margin = 0.03;
    let answer = door.collide(question.clone()).await.unwrap();
    let hovering: Vec<_> = answer.items[0].pairs.iter().filter(|pair| pair.verdict() == v1::Verdict::Margin).collect();
    assert_eq!(hovering.len(), 1, "{answer:?}");
    let patch = hovering[0].patch.as_ref().unwrap();
    assert!(
        patch.points.len() == 4 && patch.points.iter().all(|p| (p.signed_distance - 0.02).abs() < 1e-9),
        "{patch:?}"
    );
    question.context.as_mut().unwrap().max_patch_points = Some(2);
    let fewer = door.collide(question).await.unwrap();
    let patches = fewer.items[0].pairs.iter().map(|pair| pair.patch.as_ref().unwrap());
    assert!(patches.into_iter().all(|patch| patch.points.len() == 2 && patch.truncated), "{fewer:?}");
}

async fn a_robots_link_has_patches(door: &impl Door) {
    door.create_scene(SCENE).await.unwrap();
    let robot = door.load_robot(load(ROBOT)).await.unwrap();
    // The rod lies along x, its lower side at -0.05.
    let edits = vec![add_robot("arm", &robot.id), add("shelf", cuboid(0.1, 0.2, 0.1), at(0.5, 0.0, -0.14))];
    door.apply(apply(edits)).await.unwrap();
    let mut question = states(vec![0.0, 0.0]);
    question.context.as_mut().unwrap().wants = Some(PATCH);
    let answer = door.check_states(question).await.unwrap();
    let patch = answer.items[0].nearest.as_ref().unwrap().patch.as_ref().unwrap();
    // What the rod, 0.1 m wide, and the shelf, 0.2 m long, have in common.
    assert!(
        patch.points.len() == 4 && patch.points.iter().all(|p| (p.signed_distance + 0.01).abs() < 1e-9),
        "{patch:?}"
    );
    let xs: Vec<f64> = patch.points.iter().map(|p| p.point_on_a.unwrap().x).collect();
    assert!(xs.iter().all(|x| (x - 0.4).abs() < 1e-9 || (x - 0.6).abs() < 1e-9), "{xs:?}");
}

async fn points_that_no_patch_has_are_refused(door: &impl Door) {
    table(door).await;
    for points in [0, 33, u32::MAX] {
        let mut question = wanting(PATCH);
        question.context.as_mut().unwrap().max_patch_points = Some(points);
        let refusal = door.collide(question).await.unwrap_err();
        assert_eq!((refusal.code, refusal.field.as_str()), (Code::InvalidArgument, "context.max_patch_points"));
    }
}
