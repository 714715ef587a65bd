//! What does each effect cost? As multiples of a verdict on the same pairs, and of the question for verdicts in the same scene.
//!
//! `cargo bench --no-default-features --features effect-derivatives,effect-motion,effect-patch --bench effects`, about a minute. Half of the
//! bodies are boxes, half hulls of 40 corners; they fill a cube so that some touch. Pairs are those whose boxes are within the margin.

use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use clearance::geometry::{ConvexHull, Pose, Quaternion, RigidMotion, Shape, Vec3};
use clearance::narrow_phase::{
    Cost, Depth, DerivativeGoal, Goal, ImpactGoal, PatchGoal, Separation, contact_patch, derivatives, impact,
    separation,
};
use clearance::query::{
    CastMode, CastShapes, Casts, ContactQuestion, ContactTracker, Context, DEFAULT_RESOLUTION, ItemBatch, Mode, Moved,
    Mover, PairQuery, Prepared, Subject, Wants, Way,
};
use clearance::scene::{Body, BodyId, Edit, Effect, Epoch, NewBody, Scene, Snapshot};

const BODIES: usize = 1000;
const ROUNDS: usize = 31;
const MARGIN: f64 = 0.02;

/// How far a body moves, towards what it is held against or up, metres; and it turns, radians.
const STEP: f64 = 0.1;

fn place(i: usize, lifted: f64) -> Pose {
    let side = 0.9 * libm::cbrt(BODIES as f64);
    let along = |step: f64| side * (i as f64 * step).fract();
    let translation = Vec3::new(along(0.754_877_666_2), along(0.569_840_290_9), along(0.430_159_709_0) + lifted);
    let turned = Quaternion { w: 1.0, x: along(0.1) / side, y: 0.2, z: 0.0 };
    Pose::new(translation, turned).expect("finite numbers")
}

/// Forty points on a ball, by the golden angle.
fn hull(radius: f64) -> Shape {
    let point = |i: u32| {
        let z = 1.0 - (2.0 * f64::from(i) + 1.0) / 40.0;
        let (sin, cos) = libm::sincos(2.399_963_229_7 * f64::from(i));
        Vec3::new(cos * libm::sqrt(1.0 - z * z), sin * libm::sqrt(1.0 - z * z), z) * radius
    };
    Shape::hull(Arc::new(ConvexHull::new(&(0..40).map(point).collect::<Vec<_>>()).expect("finite points")))
}

fn scene() -> Scene {
    let cuboid = |half| Shape::cuboid(Vec3::repeat(half)).expect("positive lengths");
    let shapes = [cuboid(0.15), hull(0.25), cuboid(0.25), hull(0.35)].map(Arc::new);
    let body = |i: usize| NewBody::new(format!("body {i}"), Arc::clone(&shapes[i % 4]), place(i, 0.0));
    let mut scene = Scene::new(Epoch(1));
    let edits: Vec<Edit> = (0..BODIES).map(|i| Edit::AddBody(body(i))).collect();
    edits.chunks(100).for_each(|some| _ = scene.apply(some, None).expect("valid edits"));
    scene
}

/// What is wanted for an effect, with what it needs; none for those that are questions of their own.
fn wants(effect: Effect) -> Option<(Wants, f64)> {
    let wants = |distance, witness, depth, patch| Wants { distance, witness, depth, patch, ..Wants::VERDICT };
    let all = wants(true, true, true, false);
    match effect {
        Effect::Verdict => Some((Wants::VERDICT, 0.0)),
        Effect::Margin => Some((Wants::VERDICT, MARGIN)),
        Effect::Distance => Some((wants(true, false, false, false), 0.0)),
        Effect::Witness => Some((wants(true, true, false, false), 0.0)),
        Effect::Depth => Some((wants(true, false, true, false), 0.0)),
        Effect::Patch => Some((wants(true, true, true, true), 0.0)),
        // By formula; in overlaps, too.
        Effect::Derivatives => Some((Wants { derivatives: true, ..all }, 0.0)),
        Effect::Motion | Effect::Events => None,
    }
}

/// Bodies whose boxes are within the margin.
fn close_pairs(snapshot: &Snapshot) -> Vec<[&Body; 2]> {
    let bodies: Vec<&Body> = snapshot.bodies().map(|body| &**body).collect();
    let meet = |one: &Body, other: &Body| {
        let boxes = one.bounds.zip(other.bounds);
        boxes.is_some_and(|(one, other)| one.grown(MARGIN).overlaps(&other))
    };
    let pairs = bodies.iter().enumerate().flat_map(|(i, one)| bodies[i + 1..].iter().map(move |other| [*one, *other]));
    pairs.filter(|[one, other]| meet(one, other)).collect()
}

fn measured([a, b]: [&Body; 2], goal: &Goal) -> Separation {
    separation(&a.shape, &b.shape, &a.placement, &b.placement, goal).expect("both have bounds")
}

/// What the kernel does for an effect of one pair, and what it counts; none for what is no matter of one pair.
fn ask_pair(effect: Effect, pair: [&Body; 2]) -> Option<Cost> {
    let [a, b] = pair;
    if effect == Effect::Motion {
        let step = (a.pose.translation() - b.pose.translation()).normalize() * STEP;
        let motion = RigidMotion::by(b.pose, step, Vec3::z() * STEP).expect("a small turn");
        let found = impact(&a.shape, &b.shape, &RigidMotion::still(a.pose), &motion, &ImpactGoal::touch());
        return Some(black_box(found.expect("both have bounds")).cost);
    }
    let (wants, margin) = wants(effect)?;
    let depth = match (wants.depth, wants.distance) {
        (true, _) => Depth::Penetration,
        (false, true) => Depth::Distance,
        (false, false) => Depth::Verdict,
    };
    let found = black_box(measured(pair, &Goal { depth, margin, ..Goal::penetration() }));
    let mut cost = found.cost;
    if wants.patch && found.bracket.lower <= margin {
        let goal = PatchGoal { cut_off: margin, ..PatchGoal::default() };
        let patch = contact_patch(&a.shape, &b.shape, &a.placement, &b.placement, &found, &goal);
        cost.patch_corners += black_box(patch.expect("both are convex")).cost.corners;
    }
    if wants.derivatives {
        let goal = DerivativeGoal::default();
        let made = derivatives(&a.shape, &b.shape, &a.placement, &b.placement, &found, &goal, &Goal::penetration());
        cost.derivative_corners += black_box(made.expect("both are convex")).cost.corners;
    }
    Some(cost)
}

/// What is asked for an effect of one body of the scene.
fn ask_body(effect: Effect, snapshot: &Snapshot, body: BodyId) {
    let Some((wants, margin)) = wants(effect) else {
        let way = Way::By { displacement: Vec3::z() * STEP, turn: Vec3::z() * STEP };
        let items = vec![Mover { moved: Moved::Body(body), start: None, way }];
        let (mode, resolution) = (CastMode::First, DEFAULT_RESOLUTION);
        let question = CastShapes { items, mode, resolution, context: Context::default() };
        black_box(Casts::new(snapshot, &question).expect("a valid question").answer_all(&|| false));
        return;
    };
    let context = Context { wants, margin, ..Context::default() };
    let question = PairQuery { items: vec![Subject::Body(body)], mode: Mode::All, context };
    black_box(Prepared::collide(snapshot, &question).expect("a valid question").answer(&|| false));
}

/// Leads watched contacts on after each body moved there or back; the edits are not timed. Seconds.
fn lead_on(scene: &mut Scene, tracker: &mut ContactTracker, lifted: f64) -> f64 {
    let mut seconds = 0.0;
    for i in 0..BODIES {
        let edit = Edit::MoveBody { body: BodyId(i as u64 + 1).into(), pose: place(i, lifted) };
        scene.apply(&[edit], None).expect("a valid edit");
        let snapshot = scene.snapshot();
        seconds += timed(|| _ = black_box(tracker.advance(&snapshot, &|| false).expect("a later revision")));
    }
    seconds
}

fn timed(work: impl FnOnce()) -> f64 {
    let begun = Instant::now();
    work();
    begun.elapsed().as_secs_f64()
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    sorted[sorted.len() / 2]
}

/// An effect, and in each round seconds a pair and a question. No effect of one pair: not a number.
struct Row {
    effect: Effect,
    pair: Vec<f64>,
    question: Vec<f64>,
}

fn main() {
    let mut scene = scene();
    let snapshot = scene.snapshot();
    let ids: Vec<BodyId> = snapshot.bodies().map(|body| body.id).collect();
    let pairs = close_pairs(&snapshot);
    let touching = pairs.iter().filter(|pair| measured(**pair, &Goal::verdict()).bracket.upper <= 0.0).count();
    let mut tracker = ContactTracker::new(ContactQuestion::default());
    tracker.advance(&snapshot, &|| false).expect("a valid question");
    let mut rows: Vec<Row> =
        (Effect::EACH.into_iter()).map(|effect| Row { effect, pair: Vec::new(), question: Vec::new() }).collect();
    for round in 0..ROUNDS {
        for row in &mut rows {
            let effect = row.effect;
            let of_pairs = timed(|| pairs.iter().for_each(|pair| _ = black_box(ask_pair(effect, *pair))));
            row.pair.push(if effect == Effect::Events { f64::NAN } else { of_pairs / pairs.len() as f64 });
            let seconds = if effect == Effect::Events {
                lead_on(&mut scene, &mut tracker, if round % 2 == 0 { STEP } else { 0.0 })
            } else {
                timed(|| ids.iter().for_each(|id| ask_body(effect, &snapshot, *id)))
            };
            row.question.push(seconds / ids.len() as f64);
        }
    }
    let count = pairs.len();
    println!(
        "{BODIES} bodies, {count} close pairs, {touching} of them touching; medians of {ROUNDS} interleaved rounds\n"
    );
    println!("| effect | a pair | to a verdict | support calls | a question | to one for verdicts |");
    println!("| --- | --- | --- | --- | --- | --- |");
    for row in &rows {
        let ratio = |own: &[f64], verdict: &[f64]| median(own.iter().zip(verdict).map(|(own, verdict)| own / verdict));
        let question = median(row.question.iter().map(|seconds| seconds * 1e6));
        let to_verdicts = ratio(&row.question, &rows[0].question);
        let supports = |cost: Cost| cost.supports as f64 / count as f64;
        let of_pair = if row.effect == Effect::Events {
            "| | |".to_owned()
        } else {
            let supports: f64 = pairs.iter().filter_map(|pair| ask_pair(row.effect, *pair)).map(supports).sum();
            let nanoseconds = median(row.pair.iter().map(|seconds| seconds * 1e9));
            format!("{nanoseconds:.0} ns | {:.2} | {supports:.1} |", ratio(&row.pair, &rows[0].pair))
        };
        println!("| {} | {of_pair} {question:.2} us | {to_verdicts:.2} |", row.effect);
    }
}
