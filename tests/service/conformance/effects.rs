//! Declared effects, through every door. Oracle: what the same scene answers without declarations.

use clearance::limits::Limits;
use clearance::transports::wire::v1;
use clearance::transports::wire::v1::edit::Kind;
use prost::Message;
use tonic::Code;

use super::through_every_door;
use crate::support::door::Door;
use crate::support::messages::*;

through_every_door!(
    what_is_wanted_beyond_what_is_declared_is_refused_by_name,
    pairs_declared_empty_are_left_out_and_listed,
    a_margin_above_zero_needs_the_effect,
    effects_that_are_none_are_refused_by_their_place,
);

fn limits() -> Limits {
    Limits::default()
}

fn group(name: &str) -> Option<v1::Party> {
    Some(v1::Party { kind: Some(v1::party::Kind::Group(name.to_owned())) })
}

fn declare(effects: Option<&[v1::Effect]>) -> v1::Edit {
    let effects = effects.map(|effects| v1::Effects { effects: effects.iter().map(|e| i32::from(*e)).collect() });
    edit(Kind::DeclareEffects(v1::DeclareEffects { a: group("crates"), b: group("shelves"), effects }))
}

fn grouped(name: &str, group: &str, x: f64) -> v1::Edit {
    edit(Kind::AddBody(v1::AddBody {
        name: name.to_owned(),
        shape: Some(sphere(0.5)),
        pose: Some(at(x, 0.0, 0.0)),
        groups: vec![group.to_owned()],
        ..v1::AddBody::default()
    }))
}

/// A crate in a shelf, and another that is in nothing.
async fn store(door: &impl Door) {
    door.create_scene(SCENE).await.unwrap();
    let edits =
        vec![grouped("crate", "crates", 0.0), grouped("shelf", "shelves", 0.9), grouped("other", "crates", 3.0)];
    door.apply(apply(edits)).await.unwrap();
}

fn nearest(wants: v1::Wants) -> v1::DistanceRequest {
    v1::DistanceRequest {
        context: Some(v1::Context { wants: Some(wants), ..context() }),
        ..distance(vec![all_pairs(), body(named("shelf"))])
    }
}

async fn what_is_wanted_beyond_what_is_declared_is_refused_by_name(door: &impl Door) {
    store(door).await;
    let plain = nearest(v1::Wants { distance: true, ..v1::Wants::default() });
    let before = door.distance(plain.clone()).await.unwrap();
    door.apply(apply(vec![declare(Some(&[v1::Effect::Distance]))])).await.unwrap();
    let mut after = door.distance(plain).await.unwrap();
    after.revision = before.revision;
    // What is declared leaves nothing in an answer.
    assert_eq!(after.encode_to_vec(), before.encode_to_vec());
    let refusal = door.distance(nearest(v1::Wants { depth: true, ..v1::Wants::default() })).await.unwrap_err();
    assert_eq!((refusal.code, refusal.reason.as_str()), (Code::FailedPrecondition, "EFFECT_NOT_DECLARED"));
    let told =
        r#"the pair of group "crates" and group "shelves" is declared without the effect `depth`, which is wanted"#;
    assert_eq!(refusal.message, told);
    let filter = v1::Filter { groups: vec!["crates".to_owned()], ..v1::Filter::default() };
    let mut among_crates = nearest(v1::Wants { depth: true, ..v1::Wants::default() });
    among_crates.context.as_mut().unwrap().filter = Some(filter);
    among_crates.items.truncate(1);
    assert_eq!(verdicts(&door.distance(among_crates).await.unwrap()), [v1::Verdict::Free]);
    // Taken back, it may be asked again.
    door.apply(apply(vec![declare(None)])).await.unwrap();
    assert!(door.distance(nearest(v1::Wants { depth: true, ..v1::Wants::default() })).await.is_ok());
}

async fn pairs_declared_empty_are_left_out_and_listed(door: &impl Door) {
    store(door).await;
    let question = nearest(v1::Wants::default());
    let before = door.distance(question.clone()).await.unwrap();
    assert_eq!(verdicts(&before), [v1::Verdict::Collision; 2]);
    assert!(before.coverage.is_none());
    door.apply(apply(vec![declare(Some(&[]))])).await.unwrap();
    let after = door.distance(question).await.unwrap();
    assert_eq!(verdicts(&after), [v1::Verdict::Free; 2]);
    assert_eq!(after.items[1].cost.unwrap().pairs, 0);
    assert!(after.items[1].nearest.is_none());
    // Everybody asks from either side; a shelf from its own.
    let listed = after.coverage.unwrap().declared_empty;
    let pair = |a, b| v1::PartyPair { a: group(a), b: group(b) };
    assert_eq!(listed, [pair("crates", "shelves")]);
    let short = v1::Context { max_pairs: Some(0), ..context() };
    let cut = door.distance(v1::DistanceRequest { context: Some(short), ..distance(vec![body(named("shelf"))]) }).await;
    let cut = cut.unwrap().coverage.unwrap();
    assert_eq!((cut.declared_empty.len(), cut.not_listed), (0, 1));
    let near = v1::NearestBodiesRequest { context: Some(context()), items: vec![body(named("shelf"))], count: 3 };
    let near = door.nearest_bodies(near).await.unwrap();
    assert!(near.items[0].nearest.is_empty());
    assert_eq!(near.coverage.unwrap().declared_empty, [pair("shelves", "crates")]);
}

async fn a_margin_above_zero_needs_the_effect(door: &impl Door) {
    store(door).await;
    let entry = v1::SetPairMargin { a: group("crates"), b: group("shelves"), margin: Some(0.1) };
    let edits = vec![declare(Some(&[v1::Effect::Patch])), edit(Kind::SetPairMargin(entry))];
    let refusal = door.apply(apply(edits)).await.unwrap_err();
    let expected = (Code::FailedPrecondition, "EDIT_REFUSED", "edits[1].margin");
    assert_eq!((refusal.code, refusal.reason.as_str(), refusal.field.as_str()), expected, "{refusal:?}");
    let mut question = collide(vec![all_pairs()]);
    question.context.as_mut().unwrap().margin = 0.1;
    assert!(door.collide(question.clone()).await.is_ok());
    door.apply(apply(vec![declare(Some(&[v1::Effect::Patch]))])).await.unwrap();
    assert_eq!(door.collide(question).await.unwrap_err().reason, "EFFECT_NOT_DECLARED");
}

async fn effects_that_are_none_are_refused_by_their_place(door: &impl Door) {
    store(door).await;
    for number in [0, 10, -1] {
        let effects = Some(v1::Effects { effects: vec![1, number] });
        let declared = v1::DeclareEffects { a: group("crates"), b: group("shelves"), effects };
        let refusal = door.apply(apply(vec![edit(Kind::DeclareEffects(declared))])).await.unwrap_err();
        let field = "edits[0].declare_effects.effects.effects[1]";
        assert_eq!((refusal.code, refusal.field.as_str()), (Code::InvalidArgument, field), "{refusal:?}");
    }
    let missing = v1::DeclareEffects { a: group("crates"), ..v1::DeclareEffects::default() };
    let refusal = door.apply(apply(vec![edit(Kind::DeclareEffects(missing))])).await.unwrap_err();
    assert_eq!(refusal.field, "edits[0].declare_effects.b", "{refusal:?}");
}
