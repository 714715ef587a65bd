//! Many threads edit and ask one scene at once, and everything they are told fits one order of all edits.
//!
//! Oracle: each accepted list of edits is kept with the revision it was told; from these the test makes its own model of
//! every revision, and looks at every pair of balls in it. Centres are multiples of 0.25 m and diameters 0.6 m, so that no
//! pair is near touching.

use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;

use clearance::limits::Limits;
use clearance::transports::wire::v1;
use clearance::transports::wire::v1::revision_rule::Rule;
use tokio::runtime::Builder;
use tonic::Code;

use crate::support::door::{Door, Grpc, InProcess};
use crate::support::messages::*;
use crate::support::watchdog::watched;

const KEPT: usize = 24;
const WRITERS: u64 = 3;
const READERS: u64 = 4;
const EDITS: usize = 150;
const QUESTIONS: usize = 250;
const BALLS: usize = 24;
const RADIUS: f64 = 0.3;

/// Numbers from a linear congruential generator (Knuth's MMIX constants).
struct Random(u64);

impl Random {
    fn below(&mut self, count: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % count
    }

    fn place(&mut self) -> [f64; 3] {
        [0; 3].map(|_| 0.25 * self.below(9) as f64)
    }
}

/// One edit, as the model understands it.
#[derive(Clone, Debug)]
enum Step {
    Add(String, [f64; 3]),
    Move(String, [f64; 3]),
    Remove(String),
}

impl Step {
    fn message(&self) -> v1::Edit {
        let pose = |[x, y, z]: [f64; 3]| at(x, y, z);
        match self {
            Self::Add(name, place) => add(name, sphere(RADIUS), pose(*place)),
            Self::Move(name, place) => move_to(named(name), pose(*place)),
            Self::Remove(name) => remove(named(name)),
        }
    }
}

/// What was told about an accepted list of edits.
struct Accepted {
    steps: Vec<Step>,
    added: Vec<u64>,
}

/// What was told about a question.
struct Answered {
    rule: Rule,
    /// The latest revision that anybody had been told when the question was put.
    known: u64,
    probe: [f64; 3],
    answer: v1::Answer,
}

#[derive(Debug, Default)]
struct Reached {
    won: usize,
    lost: usize,
    refused: usize,
    latest: usize,
    exactly: usize,
    at_least: usize,
    to_come: usize,
    gone: usize,
    own_writes: usize,
}

#[derive(Default)]
struct History {
    /// The latest revision that anybody was told.
    known: AtomicU64,
    writers_left: AtomicU64,
    accepted: Mutex<BTreeMap<u64, Accepted>>,
    answered: Mutex<Vec<Answered>>,
    reached: Mutex<Reached>,
}

/// A list of edits, most of which fit whatever the others do.
fn steps(random: &mut Random) -> Vec<Step> {
    (0..1 + random.below(4))
        .map(|_| {
            let name = format!("ball {}", random.below(BALLS));
            match random.below(12) {
                0 => Step::Remove(name),
                1 => Step::Add(name, random.place()),
                _ => Step::Move(name, random.place()),
            }
        })
        .collect()
}

async fn write(door: &impl Door, seed: u64, history: &History) {
    let random = &mut Random(seed);
    let mut seen = history.known.load(Ordering::SeqCst);
    for _ in 0..EDITS {
        let steps = steps(random);
        let expected_revision = (random.below(3) == 0).then_some(seen);
        let edits = steps.iter().map(Step::message).collect();
        let request = v1::ApplyRequest { expected_revision, ..apply(edits) };
        match door.apply(request).await {
            Ok(told) => {
                assert!(expected_revision.is_none_or(|expected| told.revision == expected + 1));
                history.known.fetch_max(told.revision, Ordering::SeqCst);
                seen = told.revision;
                let accepted = Accepted { steps, added: told.added };
                let before = history.accepted.lock().unwrap().insert(told.revision, accepted);
                assert!(before.is_none(), "revision {seen} was told twice");
                history.reached.lock().unwrap().won += usize::from(expected_revision.is_some());
                if random.below(3) == 0 {
                    ask(door, random, Rule::AtLeast(seen), history).await;
                    history.reached.lock().unwrap().own_writes += 1;
                }
            }
            Err(refusal) if refusal.code == Code::Aborted => {
                assert!(expected_revision.is_some(), "{refusal:?}");
                history.reached.lock().unwrap().lost += 1;
                seen = history.known.load(Ordering::SeqCst);
            }
            Err(refusal) => {
                assert_eq!(refusal.code, Code::FailedPrecondition, "{refusal:?}");
                history.reached.lock().unwrap().refused += 1;
            }
        }
    }
    // Whoever saw all writers at work waits for no more than this: nobody removes that ball.
    history.writers_left.fetch_sub(1, Ordering::SeqCst);
    let last = vec![Step::Move(format!("ball {BALLS}"), random.place())];
    let told = door.apply(apply(last.iter().map(Step::message).collect())).await.unwrap();
    history.known.fetch_max(told.revision, Ordering::SeqCst);
    history.accepted.lock().unwrap().insert(told.revision, Accepted { steps: last, added: told.added });
}

async fn read(door: &impl Door, seed: u64, history: &History) {
    let random = &mut Random(seed);
    for _ in 0..QUESTIONS {
        let known = history.known.load(Ordering::SeqCst);
        let back = random.below(KEPT + 8) as u64;
        let rule = match random.below(5) {
            0 | 1 => Rule::Latest(v1::Latest {}),
            2 => Rule::Exactly(known.saturating_sub(back)),
            3 => Rule::AtLeast(known.saturating_sub(back)),
            // Only while somebody writes will it come.
            _ if history.writers_left.load(Ordering::SeqCst) == WRITERS => Rule::AtLeast(known + 1),
            _ => Rule::AtLeast(known),
        };
        ask(door, random, rule, history).await;
    }
}

async fn ask(door: &impl Door, random: &mut Random, rule: Rule, history: &History) {
    let probe = random.place();
    let [x, y, z] = probe;
    let items = vec![all_pairs(), placed(sphere(RADIUS), at(x, y, z))];
    let mut context = asked_of(rule);
    context.max_pairs = Some(10_000);
    let question = v1::CollideRequest { context: Some(context), ..collide(items) };
    let known = history.known.load(Ordering::SeqCst);
    match door.collide(question).await {
        Ok(answer) => history.answered.lock().unwrap().push(Answered { rule, known, probe, answer }),
        Err(refusal) => {
            let Rule::Exactly(asked) = rule else { panic!("{rule:?}: {refusal:?}") };
            assert_eq!(refusal.code, Code::OutOfRange, "{refusal:?}");
            let now =
                door.get_scene(v1::GetSceneRequest { scene: SCENE.to_owned(), ..Default::default() }).await.unwrap();
            assert!(asked < now.oldest_revision && now.revision - now.oldest_revision < KEPT as u64, "{refusal:?}");
            history.reached.lock().unwrap().gone += 1;
        }
    }
}

/// Balls by their ids.
type Model = BTreeMap<u64, [f64; 3]>;

/// The model of every revision, from what was told.
fn models(accepted: &BTreeMap<u64, Accepted>) -> Vec<Model> {
    let mut ids: BTreeMap<String, u64> = BTreeMap::new();
    let mut models = vec![Model::new()];
    for (revision, Accepted { steps, added }) in accepted {
        assert_eq!(*revision, models.len() as u64, "a revision that nobody was told");
        let mut model = models[models.len() - 1].clone();
        let mut added = added.iter();
        for step in steps {
            match step {
                Step::Add(name, place) => {
                    let id = *added.next().expect("an id for each body added");
                    assert!(model.insert(id, *place).is_none(), "the id {id} is used again");
                    assert!(ids.insert(name.clone(), id).is_none(), "{name:?} was there already");
                }
                Step::Move(name, place) => assert!(model.insert(ids[name], *place).is_some()),
                Step::Remove(name) => assert!(model.remove(&ids.remove(name).expect("the body was there")).is_some()),
            }
        }
        assert!(added.next().is_none());
        models.push(model);
    }
    models
}

fn touch(a: [f64; 3], b: [f64; 3]) -> bool {
    (0..3).map(|i| (a[i] - b[i]) * (a[i] - b[i])).sum::<f64>() < 4.0 * RADIUS * RADIUS
}

fn check(answered: &Answered, models: &[Model]) {
    let Answered { rule, known, probe, answer } = answered;
    let revision = answer.revision;
    match rule {
        // An edit that somebody had been told of before the question is in the answer.
        Rule::Latest(_) => assert!(revision >= *known, "{revision} after {known} was told"),
        Rule::Exactly(asked) => assert_eq!(revision, *asked),
        Rule::AtLeast(asked) => assert!(revision >= *asked.max(known), "{revision}, asked {asked}, known {known}"),
    }
    let model = &models[revision as usize];
    let id = |side: &Option<v1::Side>| match side.as_ref().and_then(|side| side.kind.as_ref()) {
        Some(v1::side::Kind::Body(body)) => Some(body.id),
        _ => None,
    };
    let pairs = |item: usize| -> Vec<(Option<u64>, Option<u64>)> {
        answer.items[item].pairs.iter().map(|pair| (id(&pair.a), id(&pair.b))).collect()
    };
    let mut expected = Vec::new();
    for (a, one) in model {
        let later = model.range(a + 1..).filter(|(_, other)| touch(*one, **other));
        expected.extend(later.map(|(b, _)| (Some(*a), Some(*b))));
    }
    assert_eq!(pairs(0), expected, "all pairs of revision {revision}");
    let near = model.iter().filter(|(_, place)| touch(*probe, **place)).map(|(id, _)| (None, Some(*id)));
    assert_eq!(pairs(1), near.collect::<Vec<_>>(), "what the probe touches in revision {revision}");
}

fn history<D: Door + Sync>() {
    let runtime = Builder::new_multi_thread().worker_threads(2).enable_all().build().unwrap();
    let door = runtime.block_on(D::open(Limits { snapshots_kept: KEPT, ..Limits::default() }));
    let history = History { writers_left: AtomicU64::new(WRITERS), ..History::default() };
    let steps: Vec<Step> = {
        let random = &mut Random(1);
        (0..=BALLS).map(|i| Step::Add(format!("ball {i}"), random.place())).collect()
    };
    runtime.block_on(async {
        door.create_scene(SCENE).await.unwrap();
        let told = door.apply(apply(steps.iter().map(Step::message).collect())).await.unwrap();
        history.accepted.lock().unwrap().insert(told.revision, Accepted { steps, added: told.added });
        history.known.store(told.revision, Ordering::SeqCst);
    });
    let (door_of, history_of) = (&door, &history);
    thread::scope(|scope| {
        for client in 0..WRITERS + READERS {
            scope.spawn(move || {
                let runtime = Builder::new_current_thread().enable_all().build().unwrap();
                let seed = 1000 + client;
                if client < WRITERS {
                    runtime.block_on(watched("a writer", write(door_of, seed, history_of)));
                } else {
                    runtime.block_on(watched("a reader", read(door_of, seed, history_of)));
                }
            });
        }
    });
    let models = models(&history.accepted.into_inner().unwrap());
    let mut reached = history.reached.into_inner().unwrap();
    for answered in history.answered.into_inner().unwrap() {
        check(&answered, &models);
        match answered.rule {
            Rule::Latest(_) => reached.latest += 1,
            Rule::Exactly(_) => reached.exactly += 1,
            Rule::AtLeast(asked) if asked > answered.known => reached.to_come += 1,
            Rule::AtLeast(_) => reached.at_least += 1,
        }
    }
    let Reached { won, lost, refused, latest, exactly, at_least, to_come, gone, own_writes } = reached;
    for (regime, count) in [
        ("compare-and-set won", won),
        ("compare-and-set lost", lost),
        ("edits refused", refused),
        ("latest revision", latest),
        ("exactly a revision", exactly),
        ("at least a revision", at_least),
        ("a revision to come", to_come),
        ("a revision that is gone", gone),
        ("own writes read", own_writes),
    ] {
        assert!(count >= 3, "{regime}: only {count} of {reached:?}");
    }
}

#[test]
fn in_process_histories_are_linearizable() {
    history::<InProcess>();
}

#[test]
fn grpc_histories_are_linearizable() {
    history::<Grpc>();
}
