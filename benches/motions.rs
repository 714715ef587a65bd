//! What certainty about a motion costs, beside checking it at fixed steps, and what those miss.
//!
//! `cargo bench --no-default-features --features effect-motion --bench motions`, half a minute. The motions are those of `tests/query/edges.rs`: a
//! UR5 between its starts, goals and states near them, in 21 scenes. Truth for what is missed: a proved collision, or one
//! that a dense sampling of 4096 steps meets. All ways run in turn, round after round; a figure is the least over the rounds.

#[path = "../tests/query/edges.rs"]
mod edges;
#[allow(dead_code, reason = "shared with the tests, which ask about its states, too")]
#[path = "../tests/query/workload.rs"]
mod workload;

use std::sync::Arc;
use std::time::Instant;

use clearance::geometry::{Pose, Quaternion, Shape, Vec3};
use clearance::limits::Limits;
use clearance::query::{CheckMotions, CheckStates, Context, Find, Mode, Motions, Prepared, Verdict};
use clearance::scene::{Edit, Epoch, NewBody, Scene, Snapshot};

use edges::{Edge, edges};

const ROUNDS: usize = 3;

/// Steps of the sampling that is held against everything.
const DENSE: usize = 4096;

/// Bodies that are added to each scene, around the robot and beyond its reach.
const CROWD: usize = 10_000;

/// What became of one motion.
#[derive(Clone, Copy, Default)]
struct Told {
    blocked: bool,
    undecided: bool,
    states: u64,
    pairs: u64,
}

/// Answers a motion in a scene.
type Check = Box<dyn Fn(&Snapshot, &Edge) -> Told>;

/// A way to check a motion.
struct Way {
    name: String,
    check: Check,
}

fn main() {
    let robot = workload::ur5();
    let scenes = workload::scenes(&robot);
    let edges = edges();
    let dense = ways(&[DENSE]).remove(2);
    let truth: Vec<bool> = edges.iter().map(|edge| (dense.check)(&scenes[edge.scene], edge).blocked).collect();
    let ways = ways(&[16, 64, 256]);
    println!(
        "{} motions in {} scenes, {} of them blocked",
        edges.len(),
        scenes.len(),
        truth.iter().filter(|b| **b).count()
    );
    table(&ways, &scenes, &edges, &truth);
    for kind in ["start-goal", "noisy line", "noisy goal", "random"] {
        let (some, truth): (Vec<Edge>, Vec<bool>) =
            edges.iter().zip(&truth).filter(|(edge, _)| edge.kind == kind).map(|(edge, b)| (edge.clone(), *b)).unzip();
        println!("\n{kind}: {} motions, {} blocked", some.len(), truth.iter().filter(|b| **b).count());
        table(&ways, &scenes, &some, &truth);
    }
    println!("\nall, in scenes with {CROWD} bodies more");
    let crowded: Vec<Arc<Snapshot>> = scenes.iter().map(|scene| crowded(scene)).collect();
    table(&ways, &crowded, &edges, &truth);
}

fn table(ways: &[Way], scenes: &[Arc<Snapshot>], edges: &[Edge], truth: &[bool]) {
    println!(
        "| way | us a motion | us free | us blocked | states a motion | pairs a motion | collisions missed | undecided |\n\
         | --- | --- | --- | --- | --- | --- | --- | --- |"
    );
    let mut least = vec![[f64::INFINITY; 2]; ways.len()];
    let mut told = vec![Vec::new(); ways.len()];
    for _ in 0..ROUNDS {
        for (w, way) in ways.iter().enumerate() {
            let mut seconds = [0.0; 2];
            told[w].clear();
            for (edge, blocked) in edges.iter().zip(truth) {
                let start = Instant::now();
                told[w].push((way.check)(&scenes[edge.scene], edge));
                seconds[usize::from(*blocked)] += start.elapsed().as_secs_f64();
            }
            for (least, seconds) in least[w].iter_mut().zip(seconds) {
                *least = least.min(seconds);
            }
        }
    }
    let count = truth.len() as f64;
    let blocked = truth.iter().filter(|blocked| **blocked).count() as f64;
    for ((way, [free, hit]), told) in ways.iter().zip(least).zip(told) {
        let sum = |of: fn(&Told) -> u64| told.iter().map(of).sum::<u64>() as f64 / count;
        let missed =
            told.iter().zip(truth).filter(|(told, blocked)| **blocked && !told.blocked && !told.undecided).count();
        println!(
            "| {} | {:.0} | {:.0} | {:.0} | {:.1} | {:.0} | {missed} | {} |",
            way.name,
            (free + hit) * 1e6 / count,
            free * 1e6 / (count - blocked).max(1.0),
            hit * 1e6 / blocked.max(1.0),
            sum(|told| told.states),
            sum(|told| told.pairs),
            told.iter().filter(|told| told.undecided).count(),
        );
    }
}

/// Certified, with the first contact or any, and at fixed steps.
fn ways(steps: &[usize]) -> Vec<Way> {
    let certified = |name: &str, find| Way {
        name: name.to_owned(),
        check: Box::new(move |snapshot, edge| {
            let request = CheckMotions {
                robot: "ur5".to_owned(),
                positions: [edge.start.as_slice(), &edge.goal].concat(),
                motions: Motions::Edges,
                mode: Mode::All,
                find,
                resolution: CheckMotions::DEFAULT_RESOLUTION,
                max_states: CheckMotions::DEFAULT_MAX_STATES,
                context: Context::default(),
            };
            let answer = Prepared::check_motions(snapshot, &request).expect("in order").answer(&|| false);
            let item = &answer.items[0];
            Told {
                blocked: item.verdict == Verdict::Collision,
                undecided: matches!(item.verdict, Verdict::Indeterminate(_)),
                states: item.motion.expect("a motion").states,
                pairs: item.cost.pairs,
            }
        }),
    };
    let mut ways = vec![
        certified("certified, first contact bracketed", Find::FirstContact),
        certified("certified, verdict", Find::AnyContact),
    ];
    ways.extend(steps.iter().map(|&steps| Way {
        name: format!("{steps} steps"),
        check: Box::new(move |snapshot, edge| {
            let last = (steps - 1) as f64;
            let state = |i: usize| {
                let t = i as f64 / last;
                edge.start.iter().zip(&edge.goal).map(move |(start, goal)| start + t * (goal - start))
            };
            let positions = (0..steps).flat_map(state).collect();
            let (robot, context) = ("ur5".to_owned(), Context::default());
            let request = CheckStates { robot, positions, mode: Mode::StopAtFirst, context };
            let answer = Prepared::check_states(snapshot, &request).expect("in order").answer(&|| false);
            let states = answer.stopped_at.map_or(steps, |stopped| stopped + 1) as u64;
            Told { blocked: answer.stopped_at.is_some(), undecided: false, states, pairs: answer.cost.pairs }
        }),
    }));
    ways
}

/// The same scene with small boxes all around, none of them within the robot's reach of 1.5 m.
fn crowded(scene: &Snapshot) -> Arc<Snapshot> {
    let mut crowded = Scene::with_limits(Epoch(1), Limits { max_edits: usize::MAX, ..Limits::default() });
    let mut edits: Vec<Edit> = scene
        .bodies()
        .map(|body| Edit::AddBody(NewBody::new(body.name.to_string(), Arc::clone(&body.shape), body.pose)))
        .collect();
    for robot in scene.robots() {
        edits.push(Edit::AddRobot { name: robot.name.to_string(), model: Arc::clone(&robot.model), base: robot.base });
    }
    let shape = Arc::new(Shape::cuboid(Vec3::repeat(0.05)).expect("a box"));
    let mut added = 0;
    for i in 0.. {
        // Fractional parts of multiples of irrational numbers fill a cube of 12 m evenly.
        let along = |step: f64| 12.0 * ((f64::from(i) * step).fract() - 0.5);
        let place = Vec3::new(along(0.754_877_666_2), along(0.569_840_290_9), along(0.430_159_709_0));
        if place.norm() < 2.5 {
            continue;
        }
        let pose = Pose::new(place, Quaternion::IDENTITY).expect("finite");
        edits.push(Edit::AddBody(NewBody::new(format!("crowd {i}"), Arc::clone(&shape), pose)));
        added += 1;
        if added == CROWD {
            break;
        }
    }
    crowded.apply(&edits, None).expect("in order");
    crowded.snapshot()
}
