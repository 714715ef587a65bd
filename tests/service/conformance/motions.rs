//! Motions, paths and clearances.

use clearance::limits::Limits;
use clearance::transports::wire::v1;
use tonic::Code;

use super::through_every_door;
use crate::support::door::Door;
use crate::support::messages::*;

through_every_door!(
    a_motion_is_free_or_its_contact_is_bracketed,
    the_bulk_form_of_motions_says_the_same,
    a_path_names_its_first_blocked_motion,
    the_effort_is_the_callers_choice,
    bad_motions_are_refused_by_name,
    everything_within_a_distance_has_its_row,
    a_clearance_that_cannot_be_is_refused,
);

fn limits() -> Limits {
    Limits { max_motion_states: 5000, ..Limits::default() }
}

/// A crane whose hook passes over a block, or into it.
async fn crane(door: &impl Door) {
    let robot = door.load_robot(load(ROBOT)).await.unwrap();
    door.create_scene(SCENE).await.unwrap();
    let block = add("block", cuboid(0.2, 0.2, 0.2), at(1.0, 0.0, -1.0));
    door.apply(apply(vec![add_robot("arm", &robot.id), block])).await.unwrap();
}

const TURNED: [f64; 2] = [1.5, -0.5];
const LOWERED: [f64; 2] = [0.0, -0.5];
const DRIVEN_IN: [f64; 2] = [0.0, -0.9];

fn packed(values: Vec<f64>) -> Option<v1::Doubles> {
    Some(v1::Doubles { form: Some(v1::doubles::Form::Packed(v1::PackedDoubles { values })) })
}

fn motions(positions: &[[f64; 2]]) -> v1::CheckMotionsRequest {
    v1::CheckMotionsRequest {
        context: Some(context()),
        robot: "arm".to_owned(),
        positions: packed(positions.concat()),
        ..v1::CheckMotionsRequest::default()
    }
}

fn path(waypoints: &[[f64; 2]]) -> v1::CheckPathRequest {
    v1::CheckPathRequest {
        context: Some(context()),
        robot: "arm".to_owned(),
        waypoints: packed(waypoints.concat()),
        ..v1::CheckPathRequest::default()
    }
}

/// The hook's ball of radius 0.1 goes down 0.4 m and meets the block's top, at -0.8, when it is at -0.7: half way.
async fn a_motion_is_free_or_its_contact_is_bracketed(door: &impl Door) {
    crane(door).await;
    let told = door.check_motions(motions(&[TURNED, LOWERED, LOWERED, DRIVEN_IN])).await.unwrap();
    let answer = told.answer.unwrap();
    assert_eq!(verdicts(&answer), [v1::Verdict::Free, v1::Verdict::Collision]);
    let [free, blocked] = told.motions.try_into().unwrap();
    assert_eq!((free.free_until, free.reached, free.undecided), (1.0, None, None));
    let reached = blocked.reached.unwrap();
    assert!(reached.from <= 0.5 && 0.5 <= reached.to && reached.to - reached.from < 1e-3, "{reached:?}");
    assert_eq!(blocked.free_until, reached.from);
    assert!(blocked.states > 2 && told.bulk.is_none());
    let nearest = answer.items[1].nearest.as_ref().unwrap();
    assert!(matches!(nearest.a.as_ref().unwrap().kind, Some(v1::side::Kind::Link(v1::LinkSide { link: 2, .. }))));
    assert_eq!(nearest.verdict(), v1::Verdict::Collision);
}

async fn the_bulk_form_of_motions_says_the_same(door: &impl Door) {
    crane(door).await;
    let question = motions(&[TURNED, LOWERED, LOWERED, DRIVEN_IN]);
    let items = door.check_motions(question.clone()).await.unwrap();
    let mut bulk = question;
    bulk.context.as_mut().unwrap().answer_form = v1::AnswerForm::Bulk.into();
    let bulk = door.check_motions(bulk).await.unwrap();
    assert!(bulk.motions.is_empty() && bulk.answer.unwrap().cost == items.answer.unwrap().cost);
    let arrays = bulk.bulk.unwrap();
    let column = |of: fn(&v1::Motion) -> f64| -> Vec<u8> {
        items.motions.iter().flat_map(|motion| of(motion).to_le_bytes()).collect()
    };
    assert_eq!(arrays.free_until, column(|motion| motion.free_until));
    assert_eq!(arrays.reached_from, column(|motion| motion.reached.map_or(f64::NAN, |reached| reached.from)));
    assert_eq!(arrays.reached_to, column(|motion| motion.reached.map_or(f64::NAN, |reached| reached.to)));
    assert_eq!(arrays.states, column(|motion| motion.states as f64));
}

async fn a_path_names_its_first_blocked_motion(door: &impl Door) {
    crane(door).await;
    let waypoints = [TURNED, LOWERED, DRIVEN_IN, LOWERED];
    let told = door.check_path(path(&waypoints)).await.unwrap();
    let answer = told.answer.unwrap();
    assert_eq!(answer.stopped_at, Some(1));
    assert_eq!(verdicts(&answer), [v1::Verdict::Free, v1::Verdict::Collision, v1::Verdict::NotRun]);
    assert_eq!((told.motions.len(), &told.motions[2]), (3, &v1::Motion::default()));
    let all = v1::CheckPathRequest { mode: v1::Mode::All.into(), ..path(&waypoints) };
    let told = door.check_path(all).await.unwrap();
    assert_eq!(
        verdicts(&told.answer.unwrap()),
        [v1::Verdict::Free, v1::Verdict::Collision, v1::Verdict::Collision],
        "the way out begins in the block"
    );
    assert!(door.check_path(path(&waypoints[..1])).await.unwrap().motions.is_empty(), "one waypoint is no way");
}

async fn the_effort_is_the_callers_choice(door: &impl Door) {
    crane(door).await;
    let with = |effort| v1::CheckMotionsRequest { effort: Some(effort), ..motions(&[LOWERED, DRIVEN_IN]) };
    let width = |told: v1::CheckMotionsResponse| {
        let reached = told.motions[0].reached.unwrap();
        reached.to - reached.from
    };
    let any = v1::MotionEffort { find: v1::Find::AnyContact.into(), ..v1::MotionEffort::default() };
    let coarse = v1::MotionEffort { resolution: Some(0.01), ..v1::MotionEffort::default() };
    let fine = v1::MotionEffort { resolution: Some(1e-6), ..v1::MotionEffort::default() };
    let [any, coarse, fine] = [
        width(door.check_motions(with(any)).await.unwrap()),
        width(door.check_motions(with(coarse)).await.unwrap()),
        width(door.check_motions(with(fine)).await.unwrap()),
    ];
    assert!(any >= coarse && coarse > fine && fine < 1e-5, "{any} {coarse} {fine}");
    let few = v1::MotionEffort { max_states: Some(2), ..v1::MotionEffort::default() };
    let question = v1::CheckMotionsRequest { effort: Some(few), ..motions(&[[1.0, -0.69], [-1.0, -0.69]]) };
    let told = door.check_motions(question).await.unwrap();
    let item = &told.answer.unwrap().items[0];
    assert_eq!((item.verdict(), item.indeterminacy()), (v1::Verdict::Indeterminate, v1::Indeterminacy::IterationLimit));
    assert_eq!(told.motions[0].undecided.unwrap().from, 0.0);
}

async fn bad_motions_are_refused_by_name(door: &impl Door) {
    crane(door).await;
    let refusal = door.check_motions(motions(&[TURNED])).await.unwrap_err();
    assert_eq!((refusal.code, refusal.field.as_str()), (Code::InvalidArgument, "positions"), "{refusal:?}");
    let missing = v1::CheckPathRequest { waypoints: None, ..path(&[]) };
    assert_eq!(door.check_path(missing).await.unwrap_err().field, "waypoints");
    let odd = v1::MotionEffort { find: 17, ..v1::MotionEffort::default() };
    let refusal = door.check_motions(v1::CheckMotionsRequest { effort: Some(odd), ..motions(&[]) }).await.unwrap_err();
    assert_eq!(refusal.field, "effort.find");
    for resolution in [0.0, f64::NAN] {
        let effort = Some(v1::MotionEffort { resolution: Some(resolution), ..v1::MotionEffort::default() });
        let refusal = door.check_motions(v1::CheckMotionsRequest { effort, ..motions(&[]) }).await.unwrap_err();
        assert_eq!((refusal.code, refusal.field.as_str()), (Code::InvalidArgument, "resolution"));
    }
    let effort = Some(v1::MotionEffort { max_states: Some(5001), ..v1::MotionEffort::default() });
    let refusal = door.check_motions(v1::CheckMotionsRequest { effort, ..motions(&[]) }).await.unwrap_err();
    assert_eq!(refusal.code, Code::ResourceExhausted, "{refusal:?}");
    let nobody = v1::CheckMotionsRequest { robot: "nobody".to_owned(), ..motions(&[]) };
    assert_eq!(door.check_motions(nobody).await.unwrap_err().code, Code::NotFound);
    let told = door.check_motions(motions(&[TURNED, [f64::NAN, 0.0], TURNED, LOWERED])).await.unwrap();
    let answer = told.answer.unwrap();
    assert_eq!(verdicts(&answer), [v1::Verdict::InvalidInput, v1::Verdict::Free]);
    assert!(answer.items[0].problem.contains("motions[0].goal"), "{:?}", answer.items[0].problem);
}

async fn everything_within_a_distance_has_its_row(door: &impl Door) {
    crane(door).await;
    let states = v1::RobotStates { robot: "arm".to_owned(), positions: packed([TURNED, LOWERED].concat()) };
    let within = |within| v1::ClearanceRequest {
        context: Some(context()),
        within,
        subjects: Some(v1::clearance_request::Subjects::States(states.clone())),
        ..v1::ClearanceRequest::default()
    };
    // Lowered, the hook is 0.2 above the block; the boom 0.75.
    let answer = door.clearance(within(0.3)).await.unwrap();
    assert_eq!(answer.items.iter().map(|item| item.pairs.len()).collect::<Vec<_>>(), [0, 1]);
    let bracket = answer.items[1].pairs[0].bracket.unwrap();
    assert!(bracket.lower <= 0.2 + 1e-12 && 0.2 - 1e-12 <= bracket.upper, "{bracket:?}");
    let answer = door.clearance(within(0.8)).await.unwrap();
    assert_eq!(answer.items[1].pairs.len(), 2);
    let probe = v1::ClearanceSubjects { items: vec![placed(sphere(0.1), at(1.0, 0.0, 0.0)), all_pairs()] };
    let subjects = Some(v1::clearance_request::Subjects::Items(probe));
    let answer = door.clearance(v1::ClearanceRequest { subjects, ..within(1.0) }).await.unwrap();
    assert_eq!(answer.items.iter().map(|item| item.pairs.len()).collect::<Vec<_>>(), [1, 0]);
}

async fn a_clearance_that_cannot_be_is_refused(door: &impl Door) {
    crane(door).await;
    let nothing = v1::ClearanceRequest { context: Some(context()), ..v1::ClearanceRequest::default() };
    assert_eq!(door.clearance(nothing.clone()).await.unwrap_err().field, "subjects");
    let subjects = Some(v1::clearance_request::Subjects::Items(v1::ClearanceSubjects { items: vec![all_pairs()] }));
    let refusal = door.clearance(v1::ClearanceRequest { subjects, within: f64::NAN, ..nothing }).await.unwrap_err();
    assert_eq!((refusal.code, refusal.field.as_str()), (Code::InvalidArgument, "within"));
}
