//! Derivatives, through every door. Oracle: closed forms of balls; of a robot, how its own joints move a ball.

use clearance::limits::Limits;
use clearance::transports::wire::v1;
use clearance::transports::wire::v1::DerivativeMethod as Method;
use prost::Message;
use tonic::Code;

use super::through_every_door;
use crate::support::door::Door;
use crate::support::messages::*;

through_every_door!(
    balls_have_the_derivatives_of_the_closed_form,
    what_is_not_wanted_is_not_sent_and_what_is_changes_nothing_else,
    each_method_answers_with_its_name,
    seeds_reproduce,
    a_robots_state_has_the_gradient_of_its_joints,
    bodies_that_are_near_have_derivatives,
    beyond_what_is_declared_they_are_refused_by_name,
    options_that_cannot_be_are_refused_by_their_field,
);

fn limits() -> Limits {
    Limits { max_derivative_samples: 100, ..Limits::default() }
}

const DERIVATIVES: v1::Wants =
    v1::Wants { distance: true, witness: false, depth: true, pairs: false, patch: false, derivatives: true };

fn made(options: v1::DerivativeOptions) -> v1::Context {
    v1::Context { wants: Some(DERIVATIVES), derivatives: Some(options), ..context() }
}

fn by(method: Method) -> v1::DerivativeOptions {
    v1::DerivativeOptions { method: method.into(), ..v1::DerivativeOptions::default() }
}

/// Of the one pair of the scene.
async fn derivatives(door: &impl Door, options: v1::DerivativeOptions) -> v1::PairDerivatives {
    let question = v1::DistanceRequest { context: Some(made(options)), ..distance(vec![all_pairs()]) };
    let mut answer = door.distance(question).await.unwrap();
    let nearest = answer.items.remove(0).nearest.unwrap();
    assert!(nearest.witness.is_some(), "derivatives come with the witness");
    nearest.derivatives.unwrap()
}

const CENTRE_OF_A: [f64; 3] = [0.1, 0.2, 0.3];
const RADII: [f64; 2] = [0.5, 0.25];

/// Two balls; the second one's centre is `away` from the first one's.
async fn balls(door: &impl Door, away: [f64; 3]) {
    let [x, y, z] = CENTRE_OF_A;
    let [dx, dy, dz] = away;
    door.create_scene(SCENE).await.unwrap();
    let edits = vec![add("a", sphere(RADII[0]), at(x, y, z)), add("b", sphere(RADII[1]), at(x + dx, y + dy, z + dz))];
    door.apply(apply(edits)).await.unwrap();
}

/// Two boxes, a corner of each towards the other.
async fn boxes(door: &impl Door) {
    door.create_scene(SCENE).await.unwrap();
    let rotation = Some(v1::Quaternion { w: 0.9, x: 0.3, y: -0.2, z: 0.4 });
    let turned = v1::Pose { rotation, ..at(1.1, 0.9, 1.0) };
    let edits = vec![add("a", cuboid(0.3, 0.4, 0.5), at(0.0, 0.0, 0.0)), add("b", cuboid(0.2, 0.3, 0.25), turned)];
    door.apply(apply(edits)).await.unwrap();
}

fn near(told: &[f64], expected: &[f64], what: &str) {
    assert_eq!(told.len(), expected.len(), "{what}");
    let worst = told.iter().zip(expected).map(|(told, expected)| (told - expected).abs()).fold(0.0, f64::max);
    assert!(worst < 1e-9, "{what}: {told:?} is not {expected:?}");
}

/// Three rows of six: `i` times the identity plus `p` times what is across the normal; then nothing, as balls may turn.
fn rows(normal: [f64; 3], i: f64, p: f64) -> Vec<f64> {
    let entry = |row: usize, column: usize| {
        let one = f64::from(u8::from(row == column));
        i * one + p * (one - normal[row] * normal[column])
    };
    (0..3).flat_map(|row| (0..6).map(move |column| if column < 3 { entry(row, column) } else { 0.0 })).collect()
}

async fn balls_have_the_derivatives_of_the_closed_form(door: &impl Door) {
    // Apart, and one in the other.
    for (scene, away) in [[1.2, -0.6, 0.4], [0.3, 0.2, -0.6]].into_iter().enumerate() {
        if scene > 0 {
            door.delete_scene(SCENE).await.unwrap();
        }
        balls(door, away).await;
        let told = derivatives(door, v1::DerivativeOptions::default()).await;
        let length = away.iter().map(|x| x * x).sum::<f64>().sqrt();
        assert_eq!(length < RADII[0] + RADII[1], scene == 1);
        let n = away.map(|x| x / length);
        let (of_a, of_b) = (told.of_a.unwrap(), told.of_b.unwrap());
        near(&of_a.signed_distance, &[-n[0], -n[1], -n[2], 0.0, 0.0, 0.0], "distance by A");
        near(&of_b.signed_distance, &[n[0], n[1], n[2], 0.0, 0.0, 0.0], "distance by B");
        let [a, b] = RADII.map(|radius| radius / length);
        near(&of_a.normal, &rows(n, 0.0, -1.0 / length), "normal by A");
        near(&of_b.normal, &rows(n, 0.0, 1.0 / length), "normal by B");
        near(&of_a.point_on_a, &rows(n, 1.0, -a), "point on A by A");
        near(&of_b.point_on_a, &rows(n, 0.0, a), "point on A by B");
        near(&of_a.point_on_b, &rows(n, 0.0, b), "point on B by A");
        near(&of_b.point_on_b, &rows(n, 1.0, -b), "point on B by B");
        near(&[told.conditioning], &[length], "conditioning");
        assert_eq!((told.epsilon, told.samples, told.seed), (0.0, 0, 0));
        assert!(told.is_valid && !told.on_border && !told.is_contested && told.joints.is_empty(), "{:?}", told.method);
    }
}

async fn what_is_not_wanted_is_not_sent_and_what_is_changes_nothing_else(door: &impl Door) {
    boxes(door).await;
    let plain = v1::Wants { witness: true, pairs: true, derivatives: false, ..DERIVATIVES };
    let question = |wants| {
        let context = v1::Context { wants: Some(wants), margin: 2.0, ..made(by(Method::FiniteDifference)) };
        v1::CollideRequest { context: Some(context), ..collide(vec![all_pairs(), body(named("a"))]) }
    };
    let without = door.collide(question(plain)).await.unwrap();
    let mut with = door.collide(question(v1::Wants { derivatives: true, ..plain })).await.unwrap();
    let counters = |cost: &v1::Cost| [cost.derivative_separations, cost.derivative_supports, cost.derivative_corners];
    assert_eq!(counters(&without.cost.unwrap()), [0; 3]);
    let spent = with.items.iter().map(|item| counters(&item.cost.unwrap())).fold([0; 3], |sum, of| {
        let [a, b, c] = of;
        [sum[0] + a, sum[1] + b, sum[2] + c]
    });
    assert_eq!(counters(&with.cost.unwrap()), spent);
    // In each item once, though it is told twice: 24 moved places and its own.
    assert_eq!(spent, [2 * 25, 0, 0]);
    let mut seen = 0;
    let strip = |cost: &mut Option<v1::Cost>| {
        let cost = cost.as_mut().unwrap();
        (cost.derivative_separations, cost.derivative_supports, cost.derivative_corners) = (0, 0, 0);
    };
    strip(&mut with.cost);
    for item in &mut with.items {
        strip(&mut item.cost);
        for pair in item.pairs.iter_mut().chain(&mut item.nearest) {
            seen += usize::from(pair.derivatives.take().is_some());
        }
    }
    assert_eq!(seen, 4, "the nearest and the listed pair of both items");
    // Byte for byte: what an effect that is off leaves in the answer is nothing at all.
    assert_eq!(with.encode_to_vec(), without.encode_to_vec());
}

async fn each_method_answers_with_its_name(door: &impl Door) {
    boxes(door).await;
    for (asked, told) in [
        (Method::Unspecified, Method::ExactCell), // Boxes are not smooth.
        (Method::Exact, Method::ExactCell),
        (Method::ExactCell, Method::ExactCell),
        (Method::FiniteDifference, Method::FiniteDifference),
        (Method::Smoothed0, Method::Smoothed0),
        (Method::Smoothed1Gaussian, Method::Smoothed1Gaussian),
        (Method::Smoothed1Gumbel, Method::Smoothed1Gumbel),
    ] {
        let options = v1::DerivativeOptions { epsilon: Some(0.05), samples: Some(16), seed: Some(7), ..by(asked) };
        let answer = derivatives(door, options).await;
        assert_eq!(answer.method(), told, "{asked:?}");
        let is_random = matches!(told, Method::Smoothed0 | Method::Smoothed1Gaussian);
        let expected = if is_random { (16, 7) } else { (0, 0) };
        assert_eq!((answer.samples, answer.seed), expected, "{asked:?}");
        match told {
            Method::ExactCell => assert_eq!(answer.epsilon, 0.0),
            Method::FiniteDifference => assert!(answer.epsilon > 0.0 && answer.conditioning.is_nan(), "{answer:?}"),
            Method::Smoothed0 => assert!(answer.epsilon == 0.05 && answer.conditioning.is_nan(), "{answer:?}"),
            Method::Unspecified | Method::Exact | Method::Smoothed1Gaussian | Method::Smoothed1Gumbel => {
                assert_eq!(answer.epsilon, 0.05, "{asked:?}");
            }
        }
        let (of_a, of_b) = (answer.of_a.unwrap(), answer.of_b.unwrap());
        for side in [of_a, of_b] {
            let numbers = [&side.normal, &side.point_on_a, &side.point_on_b];
            assert_eq!(side.signed_distance.len(), 6);
            assert!(numbers.iter().all(|rows| rows.len() == 18), "{asked:?}");
            let all = side.signed_distance.iter().chain(numbers.into_iter().flatten());
            assert!(all.into_iter().all(|number| number.is_finite()), "{asked:?}: {side:?}");
        }
    }
    // Balls are smooth.
    door.delete_scene(SCENE).await.unwrap();
    balls(door, [1.0, 2.0, 2.0]).await;
    assert_eq!(derivatives(door, by(Method::Exact)).await.method(), Method::Exact);
}

async fn seeds_reproduce(door: &impl Door) {
    boxes(door).await;
    for method in [Method::Smoothed0, Method::Smoothed1Gaussian] {
        let seeded = |seed| v1::DerivativeOptions { samples: Some(8), seed: Some(seed), ..by(method) };
        let first = derivatives(door, seeded(u64::MAX)).await;
        assert_eq!(first.seed, u64::MAX);
        assert_eq!(derivatives(door, seeded(u64::MAX)).await.encode_to_vec(), first.encode_to_vec(), "{method:?}");
        let other = derivatives(door, seeded(3)).await;
        assert_ne!(other.of_b.unwrap().point_on_b, first.of_b.unwrap().point_on_b, "{method:?}");
    }
}

async fn a_robots_state_has_the_gradient_of_its_joints(door: &impl Door) {
    door.create_scene(SCENE).await.unwrap();
    let robot = door.load_robot(load(ROBOT)).await.unwrap();
    let (turn, lower) = (0.4, -0.5);
    let (hook, away) = ([libm::cos(turn), libm::sin(turn), lower], [0.3, 0.1, -0.4]);
    let ball = add("ball", sphere(0.2), at(hook[0] + away[0], hook[1] + away[1], hook[2] + away[2]));
    door.apply(apply(vec![add_robot("arm", &robot.id), ball])).await.unwrap();
    let mut question = states(vec![turn, lower]);
    question.context = Some(made(v1::DerivativeOptions::default()));
    let answer = door.check_states(question).await.unwrap();
    let nearest = answer.items[0].nearest_scene.as_ref().unwrap();
    let told = nearest.derivatives.as_ref().unwrap();
    let length = away.iter().map(|x| x * x).sum::<f64>().sqrt();
    near(&[nearest.signed_distance], &[length - 0.3], "distance of hook and ball");
    let n = away.map(|x| x / length);
    // A is the hook: it moves across its arm when the arm turns, and up when it is raised.
    near(&told.joints, &[n[0] * libm::sin(turn) - n[1] * libm::cos(turn), -n[2]], "gradient");
    near(&told.of_a.as_ref().unwrap().signed_distance[..3], &[-n[0], -n[1], -n[2]], "distance by A");
}

async fn bodies_that_are_near_have_derivatives(door: &impl Door) {
    balls(door, [1.0, 2.0, 2.0]).await;
    let context = v1::Context { wants: Some(DERIVATIVES), ..context() };
    let question = v1::NearestBodiesRequest { context: Some(context), items: vec![body(named("a"))], count: 1 };
    let answer = door.nearest_bodies(question).await.unwrap();
    let told = answer.items[0].nearest[0].derivatives.as_ref().unwrap();
    near(&told.of_b.as_ref().unwrap().signed_distance[..3], &[1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0], "distance by B");
}

async fn beyond_what_is_declared_they_are_refused_by_name(door: &impl Door) {
    balls(door, [1.0, 2.0, 2.0]).await;
    let party = |name| Some(v1::Party { kind: Some(v1::party::Kind::Body(named(name))) });
    let declare = |effect: v1::Effect| {
        let effects = Some(v1::Effects { effects: vec![effect.into(), v1::Effect::Depth.into()] });
        edit(v1::edit::Kind::DeclareEffects(v1::DeclareEffects { a: party("a"), b: party("b"), effects }))
    };
    door.apply(apply(vec![declare(v1::Effect::Patch)])).await.unwrap();
    let question =
        v1::DistanceRequest { context: Some(made(v1::DerivativeOptions::default())), ..distance(vec![all_pairs()]) };
    let refusal = door.distance(question).await.unwrap_err();
    assert_eq!((refusal.code, refusal.reason.as_str()), (Code::FailedPrecondition, "EFFECT_NOT_DECLARED"));
    assert!(refusal.message.ends_with("without the effect `derivatives`, which is wanted"), "{refusal:?}");
    // Declaring them is declaring what they need.
    door.apply(apply(vec![declare(v1::Effect::Derivatives)])).await.unwrap();
    assert!(derivatives(door, v1::DerivativeOptions::default()).await.is_valid);
}

async fn options_that_cannot_be_are_refused_by_their_field(door: &impl Door) {
    balls(door, [1.0, 2.0, 2.0]).await;
    let asking = |context| v1::DistanceRequest { context: Some(context), ..distance(vec![all_pairs()]) };
    let none = v1::DerivativeOptions::default();
    let epsilon = |epsilon| v1::DerivativeOptions { epsilon: Some(epsilon), ..none };
    let samples = |samples| v1::DerivativeOptions { samples: Some(samples), ..by(Method::Smoothed0) };
    for (field, options) in [
        ("method", v1::DerivativeOptions { method: 7, ..none }),
        ("method", v1::DerivativeOptions { method: -1, ..none }),
        ("epsilon", epsilon(-0.1)),
        ("epsilon", epsilon(f64::NAN)),
        ("epsilon", epsilon(f64::INFINITY)),
        ("samples", samples(0)),
        ("samples", samples(u32::MAX)),
    ] {
        let refusal = door.distance(asking(made(options))).await.unwrap_err();
        let expected = (Code::InvalidArgument, format!("context.derivatives.{field}"));
        assert_eq!((refusal.code, refusal.field.clone()), expected, "{refusal:?}");
    }
    for beyond in [101, 65536] {
        let refusal = door.distance(asking(made(samples(beyond)))).await.unwrap_err();
        assert_eq!((refusal.code, refusal.reason.as_str()), (Code::ResourceExhausted, "LIMIT_EXCEEDED"), "{refusal:?}");
        let told = format!("max_derivative_samples exceeded: asked for {beyond}, allowed is 100");
        assert_eq!(refusal.message, told);
    }
    assert!(door.distance(asking(made(samples(100)))).await.is_ok());
    // Nobody asks for them, nobody minds how many.
    let not_wanted = v1::Context { wants: None, ..made(samples(101)) };
    assert!(door.distance(asking(not_wanted)).await.is_ok());
    let in_bulk = v1::Context { answer_form: v1::AnswerForm::Bulk.into(), ..made(none) };
    let refusal = door.distance(asking(in_bulk)).await.unwrap_err();
    assert_eq!((refusal.code, refusal.field.as_str()), (Code::InvalidArgument, "context.wants"), "{refusal:?}");
}
