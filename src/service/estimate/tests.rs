//! Oracles: the contract of brackets, counts that follow from the request, and the cap on time. Nothing is asserted of how long items take.

use std::sync::Arc;

use super::*;
use crate::geometry::{Pose, Quaternion, Shape, Vec3};
use crate::query::{Context, Mode, PairQuery, Subject};
use crate::scene::{BodyId, Edit, NewBody, SceneOptions};
use crate::service::{Change, Config, Patience, Service, Target};

const BOXES: usize = 40;

/// Of a question for distances: a build without patches or derivatives has no price for them.
const OUTPUTS: usize = 4 + cfg!(feature = "effect-patch") as usize + cfg!(feature = "effect-derivatives") as usize;

async fn service(limits: Limits) -> (Arc<Service>, Target) {
    let service = Service::new(&Config { threads: 1, limits }).unwrap();
    service.create_scene("cell", &SceneOptions::default()).unwrap();
    let turned = |i: usize| {
        let t = Vec3::new(1.3 * i as f64, 0.1 * (i % 3) as f64, 0.0);
        Pose::new(t, Quaternion { w: 1.0, x: 0.1, y: 0.2 + 0.01 * i as f64, z: 0.3 }).unwrap()
    };
    let shape = Arc::new(Shape::cuboid(Vec3::new(0.3, 0.2, 0.25)).unwrap());
    let body = |i: usize| Edit::AddBody(NewBody::new(format!("{i}"), Arc::clone(&shape), turned(i)));
    let edits = (0..BOXES).map(body).collect();
    let change = move || Ok(Change { edits, ..Change::default() });
    service.apply("cell", Patience::default(), change).await.unwrap();
    (service, Target { scene: "cell".to_owned(), ..Target::default() })
}

fn estimate() -> Estimate {
    let items = (1..=BOXES as u64).map(|id| Subject::Body(BodyId(id))).collect();
    let question = BatchQuestion::Distance(PairQuery { items, mode: Mode::All, context: Context::default() });
    Estimate { question, tolerances: Vec::new(), outputs: Vec::new(), sample: None, time: None }
}

async fn ask(limits: Limits, estimate: Estimate) -> Result<Estimated, ServiceError> {
    let (service, target) = service(limits).await;
    service.ask(&target, Patience::default(), move |view| view.estimate(&estimate)).await
}

fn patient() -> Limits {
    Limits { max_estimate_seconds: 600, ..Limits::default() }
}

#[tokio::test]
async fn every_row_has_the_sample_and_brackets_as_narrow_as_was_asked() {
    let estimated = ask(patient(), Estimate { sample: Some(10), ..estimate() }).await.unwrap();
    assert_eq!((estimated.end, estimated.items, estimated.sample), (EstimateEnd::Complete, BOXES, 10));
    assert_eq!((estimated.revision, estimated.turns), (Revision(1), TURNS));
    assert_eq!(estimated.rows.len(), OUTPUTS * LADDER.len());
    assert_eq!(estimated.asked, (TURNS * 10 * (estimated.rows.len() + 1) + estimated.rows.len()) as u64);
    let mut narrow = 0;
    for row in &estimated.rows {
        let (times, widths, tolerance) = (row.times.unwrap(), row.widths.unwrap(), row.tolerance.unwrap());
        assert!(row.complete && row.items == 10 && row.verdicts.total() == 10, "{row:?}");
        assert!(0 < times.median && times.median <= times.p99, "{row:?}");
        assert!(row.mean_cost.unwrap().pairs > 0.0);
        assert!(widths.items == 10 && widths.median <= widths.largest, "{row:?}");
        // The bracket is within the tolerance, or at the floor of rounding, which is far below a picometre here.
        assert!(widths.largest <= tolerance.max(1e-12), "{row:?}");
        assert_eq!(widths.wider == 0, widths.largest <= tolerance, "{row:?}");
        narrow += usize::from(tolerance > 0.0 && widths.wider == 0);
    }
    assert_eq!(narrow, OUTPUTS * (LADDER.len() - 1));
}

#[tokio::test]
async fn the_sample_is_capped_and_lies_evenly() {
    let limits = Limits { max_estimate_sample: 7, ..patient() };
    let asked = Estimate { sample: Some(30), tolerances: vec![1e-3], outputs: vec![Output::Depth], ..estimate() };
    let estimated = ask(limits, asked).await.unwrap();
    assert_eq!((estimated.sample, estimated.rows.len(), estimated.rows[0].items), (7, 1, 7));
    assert_eq!(spread(10, 5), [1, 3, 5, 7, 9]);
    assert_eq!(spread(3, 5), [0, 1, 2]);
    assert_eq!(spread(0, 5), [0; 0]);
}

#[tokio::test]
async fn time_that_is_over_is_told_and_nothing_is_made_up() {
    let estimated = ask(patient(), Estimate { time: Some(Duration::from_nanos(1)), ..estimate() }).await.unwrap();
    assert_eq!((estimated.end, estimated.turns), (EstimateEnd::Time, 0));
    for row in &estimated.rows {
        assert_eq!((row.items, row.complete, row.times, row.widths, row.mean_cost), (0, false, None, None, None));
    }
    let endless = Limits { max_estimate_seconds: usize::MAX, ..Limits::default() };
    let one = Estimate { sample: Some(1), tolerances: vec![1e-3], ..estimate() };
    assert_eq!(ask(endless, one).await.unwrap().end, EstimateEnd::Complete);
    let capped = Limits { max_estimate_seconds: 0, ..Limits::default() };
    assert_eq!(ask(capped, estimate()).await.unwrap().end, EstimateEnd::Time);
}

#[tokio::test]
async fn what_cannot_be_is_named() {
    let wrong = |change: fn(&mut Estimate)| {
        let mut wrong = estimate();
        change(&mut wrong);
        wrong
    };
    let context = |estimate: &mut Estimate, margin: f64, items: usize| {
        let BatchQuestion::Distance(question) = &mut estimate.question else { panic!() };
        question.context.margin = margin;
        question.items.truncate(items);
    };
    let (mut margin, mut empty) = (estimate(), estimate());
    context(&mut margin, -1.0, BOXES);
    context(&mut empty, 0.0, 0);
    let cases = [
        (wrong(|e| e.tolerances = vec![1e-3, f64::NAN]), "tolerances[1]"),
        (wrong(|e| e.tolerances = vec![-1e-3]), "tolerances[0]"),
        (wrong(|e| e.outputs = vec![Output::Depth, Output::Verdict]), "outputs[1]"),
        (wrong(|e| e.sample = Some(0)), "sample"),
        (wrong(|e| e.time = Some(Duration::ZERO)), "time"),
        (margin, "question.context.margin"),
        (empty, "question.items"),
    ];
    for (wrong, name) in cases {
        match ask(patient(), wrong).await {
            Err(ServiceError::Invalid { field, .. }) => assert_eq!(field, name),
            other => panic!("{name}: {other:?}"),
        }
    }
    let limited = |error: Result<Estimated, ServiceError>| match error {
        Err(ServiceError::Limit(exceeded)) => exceeded.limit,
        other => panic!("{other:?}"),
    };
    let many = wrong(|e| e.tolerances = vec![1e-3; 17]);
    assert_eq!(limited(ask(patient(), many).await), "max_estimate_rows");
    assert_eq!(limited(ask(Limits { max_items: 100, ..patient() }, estimate()).await), "max_items");
    let tight = Limits { max_items: 500, ..patient() };
    let fitting = ask(tight.clone(), estimate()).await.unwrap();
    assert!(fitting.sample == 2 && fitting.asked <= tight.max_items as u64, "{fitting:?}");
    let (busy, target) = service(Limits { max_queries_in_flight: 0, ..patient() }).await;
    let refused = busy.ask(&target, Patience::default(), move |view| view.estimate(&estimate())).await;
    assert_eq!(limited(refused), "max_queries_in_flight");
}

#[tokio::test]
async fn the_scene_stays_pinned_while_it_changes() {
    let (service, target) = service(patient()).await;
    let (other, runtime) = (Arc::clone(&service), tokio::runtime::Handle::current());
    let question = move |view: &View| {
        let before = view.estimate(&Estimate { sample: Some(2), ..estimate() })?;
        let edits = vec![Edit::RemoveBody { body: crate::scene::BodyRef::Id(BodyId(1)) }];
        let change = move || Ok(Change { edits, ..Change::default() });
        let moved = std::thread::spawn(move || runtime.block_on(other.apply("cell", Patience::default(), change)));
        let after = view.estimate(&Estimate { sample: Some(2), ..estimate() })?;
        Ok((before, after, moved.join().unwrap()?.applied.revision))
    };
    let asked = tokio::spawn(async move { service.ask(&target, Patience::default(), question).await });
    let (before, after, latest) = asked.await.unwrap().unwrap();
    assert_eq!((before.revision, after.revision, latest), (Revision(1), Revision(1), Revision(2)));
    let counts = |estimated: &Estimated| estimated.rows.iter().map(|row| row.verdicts).collect::<Vec<_>>();
    assert_eq!(counts(&before), counts(&after));
}

/// A build without the code has no price to tell: named, the output is refused as a question for it would be.
#[tokio::test]
async fn derivatives_have_a_price_where_there_is_code_for_them() {
    let outputs = vec![Output::Witness, Output::Derivatives];
    let asked = Estimate { outputs, tolerances: vec![1e-6], sample: Some(5), ..estimate() };
    let estimated = ask(patient(), asked).await;
    if cfg!(not(feature = "effect-derivatives")) {
        let refusal = estimated.unwrap_err().to_string();
        assert!(refusal.contains("derivatives") && refusal.contains("built without"), "{refusal}");
        return;
    }
    let rows = estimated.unwrap().rows;
    let corners: Vec<f64> = rows.iter().map(|row| row.mean_cost.unwrap().derivative_corners).collect();
    assert!(corners[0] == 0.0 && corners[1] >= 16.0, "two boxes of eight corners, {corners:?}");
}
