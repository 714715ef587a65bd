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
    a_revision_that_never_comes_is_unavailable,
    a_revision_that_is_gone_is_out_of_range,
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
