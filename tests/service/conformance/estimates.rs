//! What questions would cost, through every door. Oracle: the questions themselves, asked with the same wants and accuracy, say which
//! verdicts, widths and counters a row has to have. Nothing is asserted of times but that they are there.

use clearance::limits::Limits;
use clearance::transports::wire::v1;
use clearance::transports::wire::v1::estimate_request::Question;
use tonic::Code;

use super::through_every_door;
use crate::support::door::Door;
use crate::support::messages::*;

through_every_door!(
    a_row_says_what_the_question_itself_would,
    every_question_has_its_own_outputs,
    outputs_that_are_not_declared_have_no_row,
    a_pinned_revision_is_measured_under_its_overlay,
    what_cannot_be_estimated_is_named,
    a_sample_is_capped_and_told,
);

const BALLS: u64 = 12;

fn limits() -> Limits {
    Limits { max_estimate_sample: 8, max_estimate_seconds: 60, ..Limits::default() }
}

/// Cones in a row, each turned otherwise, the last two one in another; and a crane in their middle.
async fn scene(door: &impl Door) {
    door.create_scene(SCENE).await.unwrap();
    let model = door.load_robot(load(ROBOT)).await.unwrap().id;
    let cone = |i: u64| {
        let x = if i == BALLS { 1.5 * (i - 1) as f64 + 0.1 } else { 1.5 * i as f64 };
        let angle = 0.2 * i as f64;
        let rotation = Some(v1::Quaternion { w: 1.0, x: 0.0, y: angle, z: 0.0 });
        let pose = v1::Pose { rotation, ..at(x, 2.0, 0.0) };
        add(&format!("{i}"), shape(v1::shape::Core::Cone(v1::Cone { radius: 0.3, half_length: 0.4 })), pose)
    };
    let edits = (1..=BALLS).map(cone).chain([add_robot("arm", &model)]);
    door.apply(apply(edits.collect())).await.unwrap();
}

fn cones() -> Vec<v1::Subject> {
    (1..=BALLS).map(|i| body(named(&i.to_string()))).collect()
}

fn of(question: Question) -> v1::EstimateRequest {
    v1::EstimateRequest { question: Some(question), ..v1::EstimateRequest::default() }
}

fn outputs(of: &[v1::Output]) -> Vec<i32> {
    of.iter().map(|output| (*output).into()).collect()
}

fn rows(response: &v1::EstimateResponse) -> Vec<(v1::Output, Option<f64>)> {
    response.rows.iter().map(|row| (row.output(), row.tolerance)).collect()
}

fn packed(values: Vec<f64>) -> Option<v1::Doubles> {
    Some(v1::Doubles { form: Some(v1::doubles::Form::Packed(v1::PackedDoubles { values })) })
}

/// The sample of twelve is the cones 1, 3, 4, 6, 7, 9, 10, 12.
async fn a_row_says_what_the_question_itself_would(door: &impl Door) {
    scene(door).await;
    let tolerances = vec![1e-2, 1e-9];
    let request = v1::EstimateRequest {
        tolerances: tolerances.clone(),
        outputs: outputs(&[v1::Output::Depth, v1::Output::Distance]),
        ..of(Question::Distance(distance(cones())))
    };
    let told = door.estimate(request).await.unwrap();
    assert_eq!((told.items, told.sample, told.turns, told.end()), (BALLS, 8, 3, v1::EstimateEnd::Complete));
    assert_eq!((told.revision, told.asked), (1, 3 * 8 * (4 + 1) + 4));
    assert!(told.seconds > 0.0);
    let (depth, distance_) = (v1::Output::Depth, v1::Output::Distance);
    let [rough, fine] = [Some(1e-2), Some(1e-9)];
    assert_eq!(rows(&told), [(depth, rough), (depth, fine), (distance_, rough), (distance_, fine)]);
    for row in &told.rows {
        let context = v1::Context {
            accuracy: Some(v1::Accuracy { absolute: row.tolerance.unwrap(), relative: 0.0 }),
            wants: Some(v1::Wants { distance: true, depth: row.output() == depth, ..v1::Wants::default() }),
            ..context()
        };
        let items = [1, 3, 4, 6, 7, 9, 10, 12].map(|i: usize| cones()[i - 1].clone()).to_vec();
        let asked = v1::DistanceRequest { context: Some(context), items, mode: 0 };
        let answer = door.distance(asked).await.unwrap();
        let counts = row.verdicts.unwrap();
        let of = |verdict| verdicts(&answer).into_iter().filter(|told| *told == verdict).count() as u64;
        assert_eq!(counts.free, of(v1::Verdict::Free));
        assert_eq!(counts.collision, of(v1::Verdict::Collision));
        assert_eq!((counts.free, counts.collision), (7, 1));
        let brackets = answer.items.iter().map(|item| item.nearest.as_ref().unwrap().bracket.unwrap());
        let measured = brackets.filter(|bracket| row.output() == depth || bracket.upper > 0.0);
        let mut told: Vec<f64> = measured.map(|bracket| bracket.upper - bracket.lower).collect();
        told.sort_unstable_by(f64::total_cmp);
        let widths = row.widths.unwrap();
        assert_eq!((widths.items, widths.largest), (told.len() as u64, told[told.len() - 1]));
        assert_eq!((widths.median, widths.wider), (told[told.len().div_ceil(2) - 1], 0));
        let (mean, cost) = (row.mean_cost.unwrap(), answer.cost.unwrap());
        assert_eq!(8.0 * mean.supports, cost.supports as f64);
        assert_eq!(8.0 * mean.gjk_iterations, cost.gjk_iterations as f64);
        assert_eq!(8.0 * mean.epa_iterations, cost.epa_iterations as f64);
        assert_eq!(8.0 * mean.pairs, cost.pairs as f64);
        let times = row.times.unwrap();
        assert!(row.complete && row.items == 8 && 0 < times.median && times.median <= times.p99, "{row:?}");
    }
}

async fn every_question_has_its_own_outputs(door: &impl Door) {
    scene(door).await;
    let states_ = states(vec![0.0, -0.5, 1.0, -0.5]);
    let motions = v1::CheckMotionsRequest {
        context: Some(context()),
        robot: "arm".to_owned(),
        positions: packed(vec![0.0, -0.5, 1.0, -0.5]),
        ..v1::CheckMotionsRequest::default()
    };
    let path = v1::CheckPathRequest {
        context: Some(context()),
        robot: "arm".to_owned(),
        waypoints: packed(vec![0.0, -0.5, 0.5, -0.5, 1.0, -0.5]),
        ..v1::CheckPathRequest::default()
    };
    let near = v1::clearance_request::Subjects::Items(v1::ClearanceSubjects { items: cones() });
    let clearance = v1::ClearanceRequest {
        context: Some(context()),
        within: 2.0,
        subjects: Some(near),
        ..v1::ClearanceRequest::default()
    };
    use v1::Output::{Depth, Derivatives, Distance, Pairs, Patch, Verdict, Witness};
    // Items, outputs that no tolerance changes, and those that it does.
    let cases: [(Question, u64, &[v1::Output], &[v1::Output]); 6] = [
        (Question::CheckStates(states_), 2, &[Verdict, Pairs], &[Distance, Witness, Depth, Patch, Derivatives]),
        (Question::Collide(collide(cones())), BALLS, &[Pairs], &[Distance, Witness, Depth, Patch, Derivatives]),
        (Question::Distance(distance(cones())), BALLS, &[], &[Pairs, Distance, Witness, Depth, Patch, Derivatives]),
        (Question::CheckMotions(motions), 1, &[], &[Verdict, Distance, Witness, Depth, Patch, Derivatives]),
        (Question::CheckPath(path), 2, &[], &[Verdict, Distance, Witness, Depth, Patch, Derivatives]),
        (Question::Clearance(clearance), BALLS, &[], &[Distance, Witness, Depth, Patch, Derivatives]),
    ];
    for (question, items, without, with) in cases {
        let name = format!("{question:?}");
        let request = v1::EstimateRequest { tolerances: vec![1e-1, 1e-3], sample: Some(2), ..of(question) };
        let told = door.estimate(request).await.unwrap();
        let expected = without.iter().map(|output| (*output, None));
        let tolerances = |output: &v1::Output| [(*output, Some(1e-1)), (*output, Some(1e-3))];
        let expected: Vec<_> = expected.chain(with.iter().flat_map(tolerances)).collect();
        assert_eq!(rows(&told), expected, "{name}");
        assert_eq!((told.items, told.sample), (items, items.min(2)), "{name}");
        assert!(told.rows.iter().all(|row| row.complete && row.times.is_some() && row.mean_cost.is_some()), "{name}");
    }
    // Left to itself an estimate measures every output on the whole ladder.
    let told =
        door.estimate(v1::EstimateRequest { sample: Some(1), ..of(Question::Distance(distance(cones()))) }).await;
    let told = rows(&told.unwrap());
    assert_eq!((told.len(), told[0], told[9]), (60, (Pairs, Some(1e-1)), (Pairs, Some(0.0))));
}

async fn outputs_that_are_not_declared_have_no_row(door: &impl Door) {
    scene(door).await;
    let body = |name| Some(v1::Party { kind: Some(v1::party::Kind::Body(named(name))) });
    let effects = Some(v1::Effects { effects: vec![v1::Effect::Distance.into()] });
    let declare = v1::DeclareEffects { a: body("3"), b: body("4"), effects };
    door.apply(apply(vec![edit(v1::edit::Kind::DeclareEffects(declare))])).await.unwrap();
    let request = v1::EstimateRequest { tolerances: vec![1e-3], ..of(Question::Distance(distance(cones()))) };
    let told = door.estimate(request.clone()).await.unwrap();
    assert_eq!(rows(&told), [(v1::Output::Pairs, Some(1e-3)), (v1::Output::Distance, Some(1e-3))]);
    let named = v1::EstimateRequest { outputs: outputs(&[v1::Output::Distance, v1::Output::Depth]), ..request };
    let refusal = door.estimate(named).await.unwrap_err();
    assert_eq!((refusal.code, refusal.reason.as_str()), (Code::FailedPrecondition, "EFFECT_NOT_DECLARED"));
}

async fn a_pinned_revision_is_measured_under_its_overlay(door: &impl Door) {
    scene(door).await;
    door.apply(apply(vec![remove(named("11"))])).await.unwrap();
    let collisions = async |context: v1::Context| {
        let asked = v1::DistanceRequest { context: Some(context), ..distance(vec![body(named("12"))]) };
        let outputs = outputs(&[v1::Output::Distance]);
        let request = v1::EstimateRequest { tolerances: vec![1e-3], outputs, ..of(Question::Distance(asked)) };
        let told = door.estimate(request).await.unwrap();
        (told.revision, told.rows[0].verdicts.unwrap().collision)
    };
    assert_eq!(collisions(context()).await, (2, 0));
    assert_eq!(collisions(asked_of(v1::revision_rule::Rule::Exactly(1))).await, (1, 1));
    let edits = vec![add("another", sphere(0.5), at(1.5 * 11.0, 2.0, 0.0))];
    let overlay = Some(v1::Overlay { edits, ..v1::Overlay::default() });
    assert_eq!(collisions(v1::Context { overlay: overlay.clone(), ..context() }).await, (2, 1));
    // Items keep their alternatives in the sample: the third of three has one.
    let three = vec![body(named("12")), body(named("12")), body(named("12"))];
    let context =
        v1::Context { alternatives: overlay.into_iter().collect(), item_alternatives: vec![0, 0, 1], ..context() };
    let asked = v1::DistanceRequest { context: Some(context), ..distance(three) };
    let request = v1::EstimateRequest {
        outputs: outputs(&[v1::Output::Distance]),
        tolerances: vec![1e-3],
        ..of(Question::Distance(asked))
    };
    let counts = door.estimate(request).await.unwrap().rows[0].verdicts.unwrap();
    assert_eq!((counts.free, counts.collision), (2, 1));
}

async fn what_cannot_be_estimated_is_named(door: &impl Door) {
    scene(door).await;
    let good = || of(Question::Distance(distance(cones())));
    let wrong = |change: fn(&mut v1::DistanceRequest)| {
        let mut asked = distance(cones());
        change(&mut asked);
        of(Question::Distance(asked))
    };
    let edits = || vec![remove(named("nobody"))];
    let overlaid = of(Question::Distance(v1::DistanceRequest {
        context: Some(v1::Context { overlay: Some(v1::Overlay { edits: edits(), ..Default::default() }), ..context() }),
        ..distance(cones())
    }));
    let cases = [
        (v1::EstimateRequest::default(), "question"),
        (v1::EstimateRequest { tolerances: vec![1.0, f64::NAN], ..good() }, "tolerances[1]"),
        (v1::EstimateRequest { tolerances: vec![-1.0], ..good() }, "tolerances[0]"),
        (v1::EstimateRequest { outputs: vec![0], ..good() }, "outputs[0]"),
        (v1::EstimateRequest { outputs: vec![3, 99], ..good() }, "outputs[1]"),
        (v1::EstimateRequest { outputs: outputs(&[v1::Output::Verdict]), ..good() }, "outputs[0]"),
        (v1::EstimateRequest { sample: Some(0), ..good() }, "sample"),
        (v1::EstimateRequest { time: Some(0.0), ..good() }, "time"),
        (v1::EstimateRequest { time: Some(-1.0), ..good() }, "time"),
        (v1::EstimateRequest { time: Some(f64::NAN), ..good() }, "time"),
        (wrong(|asked| asked.items.clear()), "question.items"),
        (wrong(|asked| asked.mode = 77), "question.mode"),
        (wrong(|asked| asked.context.as_mut().unwrap().margin = f64::INFINITY), "question.context.margin"),
        (wrong(|asked| asked.context = None), "question.context"),
        (wrong(|asked| asked.context.as_mut().unwrap().time_budget = Some(-1.0)), "question.context.time_budget"),
        (overlaid, "question.context.overlay.edits[0].body"),
    ];
    for (request, field) in cases {
        let refusal = door.estimate(request).await.unwrap_err();
        assert_eq!(refusal.field, field, "{refusal:?}");
        let invalid = matches!(refusal.code, Code::InvalidArgument | Code::FailedPrecondition);
        assert!(invalid || refusal.code == Code::NotFound, "{refusal:?}");
    }
    let nowhere = wrong(|asked| asked.context.as_mut().unwrap().scene = "nowhere".to_owned());
    assert_eq!(door.estimate(nowhere).await.unwrap_err().code, Code::NotFound);
    let rows = v1::EstimateRequest { tolerances: vec![1e-3; 20], ..good() };
    assert_eq!(door.estimate(rows).await.unwrap_err().code, Code::ResourceExhausted);
    // Samples count where derivatives are measured.
    let many = || wrong(|asked| asked.context.as_mut().unwrap().derivatives = Some(samples(10_001)));
    let refusal = door.estimate(many()).await.unwrap_err();
    assert_eq!(refusal.code, Code::ResourceExhausted, "{refusal:?}");
    assert!(refusal.message.starts_with("max_derivative_samples exceeded"), "{refusal:?}");
    let depth = v1::EstimateRequest { outputs: outputs(&[v1::Output::Depth]), tolerances: vec![1e-3], ..many() };
    assert_eq!(door.estimate(depth).await.unwrap().rows.len(), 1);
    // An infinite time is longer than the cap, and no error.
    let forever = v1::EstimateRequest { time: Some(f64::INFINITY), sample: Some(1), tolerances: vec![1e-3], ..good() };
    assert_eq!(door.estimate(forever).await.unwrap().end(), v1::EstimateEnd::Complete);
}

fn samples(samples: u32) -> v1::DerivativeOptions {
    v1::DerivativeOptions { samples: Some(samples), ..v1::DerivativeOptions::default() }
}

async fn a_sample_is_capped_and_told(door: &impl Door) {
    scene(door).await;
    let request = v1::EstimateRequest {
        tolerances: vec![1e-3],
        outputs: outputs(&[v1::Output::Distance]),
        sample: Some(1_000_000),
        ..of(Question::Distance(distance(cones())))
    };
    assert_eq!(door.estimate(request.clone()).await.unwrap().sample, 8);
    let hurried = door.estimate(v1::EstimateRequest { time: Some(1e-9), ..request }).await.unwrap();
    assert_eq!((hurried.end(), hurried.turns), (v1::EstimateEnd::Time, 0));
    let row = &hurried.rows[0];
    assert_eq!((row.complete, row.items, row.times, row.widths.is_some()), (false, 0, None, false));
}
