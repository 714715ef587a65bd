//! What-if questions. Oracle: the same question to a scene in which the edits were applied.

use clearance::limits::Limits;
use clearance::transports::wire::v1;
use tonic::Code;

use super::through_every_door;
use crate::support::door::Door;
use crate::support::messages::*;

through_every_door!(
    an_overlay_is_answered_as_if_it_were_applied_and_nobody_is_told,
    items_have_overlays_of_their_own,
    a_robot_holds_a_body,
    overlays_are_made_on_the_revision_that_is_asked,
    what_cannot_be_supposed_is_refused_by_field,
    questions_that_take_no_overlays_refuse_them,
    overlays_beyond_a_cap_are_refused_by_its_name,
);

fn limits() -> Limits {
    Limits { max_overlays: 4, max_overlay_edits: 6, ..Limits::default() }
}

fn overlay(edits: Vec<v1::Edit>) -> v1::Overlay {
    v1::Overlay { edits, attached: Vec::new() }
}

fn ball(name: &str, x: f64) -> v1::Edit {
    add(name, sphere(0.5), at(x, 0.0, 0.0))
}

fn to(name: &str, x: f64) -> v1::Edit {
    move_to(named(name), at(x, 0.0, 0.0))
}

fn enabled(name: &str, enabled: bool) -> v1::Edit {
    edit(v1::edit::Kind::SetEnabled(v1::SetEnabled { body: Some(named(name)), enabled }))
}

fn margin(margin: f64) -> v1::Edit {
    let everything = || Some(v1::Party { kind: Some(v1::party::Kind::Everything(v1::Everything {})) });
    let margin = v1::SetPairMargin { a: everything(), b: everything(), margin: Some(margin) };
    edit(v1::edit::Kind::SetPairMargin(margin))
}

fn allow(a: &str, b: &str) -> v1::Edit {
    let party = |name| Some(v1::Party { kind: Some(v1::party::Kind::Body(named(name))) });
    let allowed = v1::SetAllowedCollision { a: party(a), b: party(b), allowed: Some(true) };
    edit(v1::edit::Kind::SetAllowedCollision(allowed))
}

/// Balls of 0.5 m at 0, 2 and 4 m along x: 1, 2 and 3.
async fn balls(door: &impl Door) {
    door.create_scene(SCENE).await.unwrap();
    door.apply(apply(vec![ball("a", 0.0), ball("b", 2.0), ball("c", 4.0)])).await.unwrap();
}

fn without_nodes(mut answer: v1::Answer) -> v1::Answer {
    // The one figure that depends on how a tree came about.
    answer.cost.as_mut().unwrap().nodes = 0;
    answer.items.iter_mut().for_each(|item| item.cost.as_mut().unwrap().nodes = 0);
    answer
}

fn all_wants() -> v1::Wants {
    v1::Wants { distance: true, witness: true, depth: true, pairs: true, patch: true, derivatives: true }
}

async fn an_overlay_is_answered_as_if_it_were_applied_and_nobody_is_told(door: &impl Door) {
    balls(door).await;
    // Moved, hidden, added, given a margin, allowed: 4 is at b, which it may touch; d is within 0.2 m of it.
    let edits = vec![to("a", 1.5), enabled("c", false), ball("4", 2.0), ball("d", 3.1), margin(0.2), allow("b", "4")];
    let with = |overlay| v1::Context { wants: Some(all_wants()), overlay, ..context() };
    let items = vec![all_pairs(), body(named("4")), body(numbered(2)), placed(sphere(0.2), at(3.0, 0.0, 0.0))];
    let question = |overlay| v1::CollideRequest { context: Some(with(overlay)), ..collide(items.clone()) };
    let supposed = door.collide(question(Some(overlay(edits.clone())))).await.unwrap();
    let distance = |overlay| v1::DistanceRequest { context: Some(with(overlay)), ..distance(items.clone()) };
    let supposed_distance = door.distance(distance(Some(overlay(edits.clone())))).await.unwrap();
    let names: Vec<_> = supposed.added_bodies.iter().map(|body| (body.overlay, body.id, body.name.as_str())).collect();
    assert_eq!(names, [(0, 4, "4"), (0, 5, "d")]);
    assert_eq!(supposed.revision, 1);
    // Not a trace of it is left.
    let refusal = door.collide(question(None)).await.unwrap_err();
    assert_eq!((refusal.code, refusal.message.as_str()), (Code::NotFound, "no body \"4\""));
    let applied = door.apply(apply(edits)).await.unwrap();
    assert_eq!((applied.revision, applied.added), (2, vec![4, 5]));
    for (supposed, applied) in [
        (supposed, door.collide(question(None)).await.unwrap()),
        (supposed_distance, door.distance(distance(None)).await.unwrap()),
    ] {
        let supposed = v1::Answer { revision: 2, added_bodies: Vec::new(), ..supposed };
        assert_eq!(without_nodes(supposed), without_nodes(applied));
    }
}

async fn items_have_overlays_of_their_own(door: &impl Door) {
    balls(door).await;
    let context = v1::Context {
        overlay: Some(overlay(vec![ball("near", 0.9)])),
        alternatives: vec![
            overlay(vec![to("near", 9.0), ball("other", -0.9)]),
            overlay(vec![enabled("a", false)]),
            overlay(vec![remove(named("near"))]),
        ],
        item_alternatives: vec![0, 1, 2, 3, 1, 1],
        ..context()
    };
    let mut items = vec![body(named("a")); 5];
    items.push(body(named("other")));
    let question = v1::CollideRequest { context: Some(context), ..collide(items) };
    let answer = door.collide(question.clone()).await.unwrap();
    let (hit, free) = (v1::Verdict::Collision, v1::Verdict::Free);
    assert_eq!(verdicts(&answer), [hit, hit, free, free, hit, hit]);
    let touched = |item: usize| match answer.items[item].pairs[0].b.as_ref().unwrap().kind {
        Some(v1::side::Kind::Body(v1::BodySide { id, .. })) => id,
        _ => panic!("{:?}", answer.items[item]),
    };
    // Both names of each overlay, with the ids that its answers use: `near` is 4 everywhere, `other` 5 where it is.
    let names: Vec<_> = answer.added_bodies.iter().map(|body| (body.overlay, body.id, body.name.as_str())).collect();
    assert_eq!((names, touched(0), touched(1), touched(4)), (vec![(0, 4, "near"), (1, 5, "other")], 4, 5, 5));
    // A name that only another item's overlay has.
    let mut elsewhere = question.clone();
    elsewhere.context.as_mut().unwrap().item_alternatives[5] = 2;
    assert_eq!(door.collide(elsewhere).await.unwrap_err().message, "no body \"other\"");
    // Verdicts as bytes are the same.
    let mut bulk = question;
    bulk.context.as_mut().unwrap().answer_form = v1::AnswerForm::Bulk.into();
    let bulk = door.collide(bulk).await.unwrap();
    let bytes: Vec<u8> = answer.items.iter().map(|item| item.verdict as u8).collect();
    assert_eq!((bulk.bulk.unwrap().verdicts.to_vec(), bulk.added_bodies), (bytes, answer.added_bodies));
}

async fn crane(door: &impl Door) {
    door.create_scene(SCENE).await.unwrap();
    let robot = door.load_robot(load(ROBOT)).await.unwrap();
    // A rod of 1 m, and a post that only the hook with the rod reaches.
    let rod = add("rod", cuboid(0.5, 0.02, 0.02), at(9.0, 0.0, 0.0));
    let post = add("post", cuboid(0.1, 0.1, 2.0), at(0.0, 1.5, 0.0));
    door.apply(apply(vec![add_robot("arm", &robot.id), rod, post])).await.unwrap();
}

fn link(link: &str) -> Option<v1::LinkRef> {
    Some(v1::LinkRef { robot: "arm".to_owned(), link: link.to_owned() })
}

fn rod_in_hand() -> v1::AttachBody {
    let body_in_link = Some(at(0.55, 0.0, 0.0));
    v1::AttachBody { body: Some(named("rod")), link: link("hook"), body_in_link, may_touch: Vec::new() }
}

fn holding(attached: Vec<v1::AttachBody>) -> v1::Overlay {
    v1::Overlay { edits: Vec::new(), attached }
}

async fn a_robot_holds_a_body(door: &impl Door) {
    crane(door).await;
    let quarter = std::f64::consts::FRAC_PI_2;
    let context = v1::Context {
        wants: Some(all_wants()),
        alternatives: vec![holding(vec![rod_in_hand()])],
        item_alternatives: vec![0, 1, 1],
        ..context()
    };
    let mut question = states(vec![quarter, -0.5, quarter, -0.5, 0.0, -0.5]);
    question.context = Some(context.clone());
    let answer = door.check_states(question).await.unwrap();
    let (hit, free) = (v1::Verdict::Collision, v1::Verdict::Free);
    assert_eq!(verdicts(&answer), [free, hit, free]);
    let ids = |pair: &v1::PairAnswer| {
        [&pair.a, &pair.b].map(|side| match side.as_ref().unwrap().kind {
            Some(v1::side::Kind::Body(v1::BodySide { id, .. })) => id,
            _ => 0,
        })
    };
    assert_eq!(answer.items[1].pairs.iter().map(ids).collect::<Vec<_>>(), [[1, 2]]);
    assert_eq!(ids(answer.items[1].nearest_scene.as_ref().unwrap()), [1, 2]);
    // Motions take the rod along.
    let packed = v1::doubles::Form::Packed(v1::PackedDoubles { values: vec![0.0, -0.5, quarter, -0.5] });
    let edge = |context| v1::CheckMotionsRequest {
        context: Some(context),
        robot: "arm".to_owned(),
        positions: Some(v1::Doubles { form: Some(packed.clone()) }),
        ..v1::CheckMotionsRequest::default()
    };
    let with = |number| v1::Context { wants: None, item_alternatives: vec![number], ..context.clone() };
    let empty = door.check_motions(edge(with(0))).await.unwrap().answer.unwrap();
    let full = door.check_motions(edge(with(1))).await.unwrap().answer.unwrap();
    assert_eq!((verdicts(&empty), verdicts(&full)), (vec![free], vec![hit]));
}

async fn overlays_are_made_on_the_revision_that_is_asked(door: &impl Door) {
    balls(door).await;
    door.apply(apply(vec![to("a", 50.0)])).await.unwrap();
    let at_revision = |revision, edits| {
        let rule = v1::revision_rule::Rule::Exactly(revision);
        let context = v1::Context { overlay: Some(overlay(edits)), ..asked_of(rule) };
        v1::CollideRequest { context: Some(context), ..collide(vec![body(named("a"))]) }
    };
    let then = door.collide(at_revision(1, vec![to("b", 0.7)])).await.unwrap();
    let now = door.collide(at_revision(2, vec![to("b", 0.7)])).await.unwrap();
    assert_eq!((verdicts(&then), then.revision), (vec![v1::Verdict::Collision], 1));
    assert_eq!((verdicts(&now), now.revision), (vec![v1::Verdict::Free], 2));
}

async fn what_cannot_be_supposed_is_refused_by_field(door: &impl Door) {
    crane(door).await;
    let (invalid, precondition) = (Code::InvalidArgument, Code::FailedPrecondition);
    let common = |overlay| v1::Context { overlay: Some(overlay), ..context() };
    let second = |overlay| v1::Context {
        alternatives: vec![v1::Overlay::default(), overlay],
        item_alternatives: vec![2],
        ..context()
    };
    let edits = |edits: Vec<v1::Edit>| overlay(edits);
    let nan = move_to(named("rod"), at(f64::NAN, 0.0, 0.0));
    let hold = |change: &dyn Fn(&mut v1::AttachBody)| {
        let mut attached = rod_in_hand();
        change(&mut attached);
        holding(vec![attached])
    };
    let cases = [
        (common(edits(vec![nan.clone()])), invalid, "context.overlay.edits[0].move_body.pose.translation"),
        (second(edits(vec![nan])), invalid, "context.alternatives[1].edits[0].move_body.pose.translation"),
        (common(edits(vec![v1::Edit { kind: None }])), invalid, "context.overlay.edits[0]"),
        (common(edits(vec![ball("x", 0.0), ball("x", 0.0)])), precondition, "context.overlay.edits[1].name"),
        (second(edits(vec![to("nobody", 0.0)])), precondition, "context.alternatives[1].edits[0].body"),
        (second(edits(vec![remove(numbered(77))])), precondition, "context.alternatives[1].edits[0].body"),
        (common(hold(&|a| a.body = None)), invalid, "context.overlay.attached[0].body"),
        (common(hold(&|a| a.link = None)), invalid, "context.overlay.attached[0].link"),
        (common(hold(&|a| a.body_in_link = None)), invalid, "context.overlay.attached[0].body_in_link"),
        (common(hold(&|a| a.body = Some(named("rope")))), precondition, "context.overlay.attached[0].body"),
        (second(hold(&|a| a.link = link("toe"))), precondition, "context.alternatives[1].attached[0].link"),
        (common(hold(&|a| a.may_touch.push("toe".to_owned()))), precondition, "context.overlay.attached[0].may_touch"),
        (v1::Context { item_alternatives: vec![1], ..context() }, invalid, "context.item_alternatives[0]"),
        (v1::Context { item_alternatives: vec![0, 0], ..context() }, invalid, "context.item_alternatives"),
    ];
    for (context, code, field) in cases {
        let mut question = states(vec![0.0, -0.5]);
        question.context = Some(context);
        let refusal = door.check_states(question).await.unwrap_err();
        assert_eq!((refusal.code, refusal.field.as_str()), (code, field), "{refusal:?}");
    }
    let held = v1::CollideRequest { context: Some(common(holding(vec![rod_in_hand()]))), ..collide(vec![all_pairs()]) };
    assert_eq!(door.collide(held).await.unwrap_err().field, "context.overlay.attached");
}

async fn questions_that_take_no_overlays_refuse_them(door: &impl Door) {
    balls(door).await;
    for (field, context) in with_overlays() {
        let context = Some(context);
        let rays = v1::CastRaysRequest { context: context.clone(), ..v1::CastRaysRequest::default() };
        let shapes = v1::CastShapesRequest { context: context.clone(), ..v1::CastShapesRequest::default() };
        let moving = v1::CheckMovingPairsRequest { context: context.clone(), ..v1::CheckMovingPairsRequest::default() };
        let overlap = v1::OverlapRequest { context: context.clone(), ..v1::OverlapRequest::default() };
        let nearest = v1::NearestBodiesRequest { context, ..v1::NearestBodiesRequest::default() };
        let refusals = [
            door.cast_rays(rays).await.unwrap_err(),
            door.cast_shapes(shapes).await.unwrap_err(),
            door.check_moving_pairs(moving).await.unwrap_err(),
            door.overlap(overlap).await.unwrap_err(),
            door.nearest_bodies(nearest).await.unwrap_err(),
        ];
        for refusal in refusals {
            assert_eq!((refusal.code, refusal.field.as_str()), (Code::InvalidArgument, field), "{refusal:?}");
        }
    }
}

async fn overlays_beyond_a_cap_are_refused_by_its_name(door: &impl Door) {
    balls(door).await;
    let with = |overlay, alternatives: Vec<v1::Overlay>| {
        let context = v1::Context { overlay: Some(overlay), alternatives, ..context() };
        door.collide(v1::CollideRequest { context: Some(context), ..collide(vec![all_pairs()]) })
    };
    let moves = |count| overlay(vec![to("a", 0.1); count]);
    assert!(with(moves(2), vec![moves(2), moves(1), moves(1)]).await.is_ok());
    let refusal = with(moves(2), vec![moves(2), moves(2), moves(1)]).await.unwrap_err();
    assert_eq!(refusal.message, "max_overlay_edits exceeded: asked for 7, allowed is 6");
    let refusal = with(moves(0), vec![moves(0); 4]).await.unwrap_err();
    assert_eq!((refusal.code, refusal.reason.as_str()), (Code::ResourceExhausted, "LIMIT_EXCEEDED"));
    assert_eq!(refusal.message, "max_overlays exceeded: asked for 5, allowed is 4");
}
