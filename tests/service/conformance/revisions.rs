//! Which state of a scene answers.

use clearance::limits::Limits;
use clearance::transports::wire::v1;
use clearance::transports::wire::v1::revision_rule::Rule;
use tonic::Code;

use super::through_every_door;
use crate::support::door::Door;
use crate::support::messages::*;

through_every_door!(
    an_earlier_revision_answers_as_it_was,
    a_revision_to_come_is_waited_for,
    the_oldest_revision_told_is_of_the_same_moment_as_the_contents,
    a_revision_that_never_comes_is_unavailable,
    a_revision_that_is_gone_is_out_of_range,
    pairs_changed_since_a_revision_are_told_as_far_as_it_is_kept,
);

fn limits() -> Limits {
    Limits { snapshots_kept: 3, ..Limits::default() }
}

fn question(rule: Rule) -> v1::CollideRequest {
    v1::CollideRequest { context: Some(asked_of(rule)), ..collide(vec![placed(sphere(0.1), at(0.0, 0.0, 0.0))]) }
}

/// Revision 1 has a ball at the origin, revision 2 has it elsewhere.
async fn two_revisions(door: &impl Door) {
    door.create_scene(SCENE).await.unwrap();
    door.apply(apply(vec![add("ball", sphere(0.5), at(0.0, 0.0, 0.0))])).await.unwrap();
    door.apply(apply(vec![move_to(named("ball"), at(5.0, 0.0, 0.0))])).await.unwrap();
}

async fn an_earlier_revision_answers_as_it_was(door: &impl Door) {
    two_revisions(door).await;
    let cases = [
        (Rule::Exactly(0), 0, v1::Verdict::Free),
        (Rule::Exactly(1), 1, v1::Verdict::Collision),
        (Rule::AtLeast(1), 2, v1::Verdict::Free),
        (Rule::Latest(v1::Latest {}), 2, v1::Verdict::Free),
    ];
    for (rule, revision, verdict) in cases {
        let answer = door.collide(question(rule)).await.unwrap();
        assert_eq!((answer.revision, verdicts(&answer)), (revision, vec![verdict]), "{rule:?}");
    }
    let contents = v1::GetSceneRequest {
        scene: SCENE.to_owned(),
        revision: Some(v1::RevisionRule { epoch: None, rule: Some(Rule::Exactly(0)) }),
        ..v1::GetSceneRequest::default()
    };
    let contents = door.get_scene(contents).await.unwrap();
    assert_eq!((contents.revision, contents.oldest_revision, contents.bodies.len()), (0, 0, 0));
}

async fn a_revision_to_come_is_waited_for(door: &impl Door) {
    two_revisions(door).await;
    for rule in [Rule::AtLeast(3), Rule::Exactly(4)] {
        let change = async {
            tokio::time::sleep(std::time::Duration::from_millis(50)).await;
            door.apply(apply(vec![move_to(named("ball"), at(0.0, 0.0, 0.0))])).await.unwrap()
        };
        let (answer, changed) = tokio::join!(door.collide(question(rule)), change);
        let answer = answer.unwrap();
        assert_eq!((answer.revision, verdicts(&answer)), (changed.revision, vec![v1::Verdict::Collision]));
    }
}

/// It was looked up before the wait once, and told revisions that were gone.
async fn the_oldest_revision_told_is_of_the_same_moment_as_the_contents(door: &impl Door) {
    two_revisions(door).await;
    let contents = v1::GetSceneRequest {
        scene: SCENE.to_owned(),
        revision: Some(v1::RevisionRule { epoch: None, rule: Some(Rule::AtLeast(9)) }),
        ..v1::GetSceneRequest::default()
    };
    let changes = async {
        tokio::time::sleep(std::time::Duration::from_millis(50)).await;
        for x in 3..=9 {
            door.apply(apply(vec![move_to(named("ball"), at(f64::from(x), 0.0, 0.0))])).await.unwrap();
        }
    };
    let (contents, ()) = tokio::join!(door.get_scene(contents), changes);
    let contents = contents.unwrap();
    assert_eq!((contents.revision, contents.oldest_revision), (9, 7), "three are kept");
}

async fn a_revision_that_never_comes_is_unavailable(door: &impl Door) {
    two_revisions(door).await;
    let mut question = question(Rule::AtLeast(99));
    question.context.as_mut().unwrap().time_budget = Some(0.05);
    let refusal = door.collide(question).await.unwrap_err();
    assert_eq!((refusal.code, refusal.reason.as_str()), (Code::Unavailable, "REVISION_NOT_YET"), "{refusal:?}");
}

async fn a_revision_that_is_gone_is_out_of_range(door: &impl Door) {
    two_revisions(door).await;
    door.apply(apply(vec![remove(named("ball"))])).await.unwrap();
    let refusal = door.collide(question(Rule::Exactly(0))).await.unwrap_err();
    assert_eq!((refusal.code, refusal.reason.as_str()), (Code::OutOfRange, "REVISION_GONE"), "{refusal:?}");
    assert_eq!(door.collide(question(Rule::Exactly(1))).await.unwrap().revision, 1);
}

async fn pairs_changed_since_a_revision_are_told_as_far_as_it_is_kept(door: &impl Door) {
    door.create_scene(SCENE).await.unwrap();
    let ball = |name: &str, x| add(name, sphere(0.5), at(x, 0.0, 0.0));
    door.apply(apply(vec![ball("a", 0.0), ball("b", 0.9), ball("c", 10.0), ball("d", 10.9)])).await.unwrap();
    door.apply(apply(vec![move_to(named("b"), at(0.8, 0.0, 0.0))])).await.unwrap();
    let party = |name| Some(v1::Party { kind: Some(v1::party::Kind::Body(named(name))) });
    let margin = v1::SetPairMargin { a: party("c"), b: party("d"), margin: Some(0.1) };
    door.apply(apply(vec![edit(v1::edit::Kind::SetPairMargin(margin))])).await.unwrap();
    let items = vec![changed_since(1), changed_since(2), changed_since(3), all_pairs()];
    let answer = door.collide(collide(items.clone())).await.unwrap();
    let pairs: Vec<usize> = answer.items.iter().map(|item| item.pairs.len()).collect();
    assert_eq!(pairs, [2, 1, 0, 2], "{answer:?}");
    let nearest = door.distance(distance(items)).await.unwrap();
    assert!(nearest.items[2].nearest.is_none());
    let upper = |item: usize| nearest.items[item].nearest.as_ref().unwrap().bracket.unwrap().upper;
    assert!(upper(0) <= 0.0 && upper(1) <= 0.0);

    // Three are kept: 1, 2 and 3; revision 1 of the scene still knows all since 0.
    let refusal = door.collide(collide(vec![all_pairs(), changed_since(0)])).await.unwrap_err();
    assert_eq!((refusal.code, refusal.reason.as_str()), (Code::OutOfRange, "REVISION_GONE"), "{refusal:?}");
    assert!(refusal.message.ends_with("the oldest kept is 1"), "{refusal:?}");
    let first = v1::CollideRequest { context: Some(asked_of(Rule::Exactly(1))), ..collide(vec![changed_since(0)]) };
    assert_eq!(door.collide(first).await.unwrap().items[0].pairs.len(), 2);
    let refusal = door.distance(distance(vec![all_pairs(), changed_since(4)])).await.unwrap_err();
    let field = (refusal.code, refusal.field.as_str());
    assert_eq!(field, (Code::InvalidArgument, "items[1].changed_since"), "{refusal:?}");
}
