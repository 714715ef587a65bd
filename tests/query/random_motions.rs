//! Motions of random small robots in random scenes, held against samples.
//!
//! Oracle: `CheckStates` at positions along the motion, which knows nothing of bounds on motions. It cannot see what lies between
//! two samples, so it converges from one side: a motion that is told to be free must be free at all of them.
#![cfg(feature = "effect-motion")]

use std::fmt::Write;
use std::sync::Arc;

use clearance::geometry::{Pose, Quaternion, Shape, Vec3};
use clearance::query::{
    CheckMotions, CheckStates, Context, Find, Indeterminacy, ItemAnswer, Mode, Motions, Prepared, Side, Verdict,
};
use clearance::robot::{JointKind, MeshRequest, ModelOptions, RobotModel};
use clearance::scene::{Edit, Epoch, NewBody, Scene, Snapshot};

/// SplitMix64 (Steele, Lea, Flood 2014).
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, count: usize) -> usize {
        (self.bits() % count as u64) as usize
    }

    fn between(&mut self, least: f64, most: f64) -> f64 {
        least + (most - least) * (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    fn vector(&mut self, size: f64) -> Vec3 {
        Vec3::new(self.between(-size, size), self.between(-size, size), self.between(-size, size))
    }
}

fn collision(random: &mut Random) -> String {
    let at = random.vector(0.3);
    let size = |random: &mut Random| random.between(0.02, 0.12);
    let geometry = match random.below(4) {
        0 => format!(r#"<box size="{} {} {}"/>"#, size(random), size(random), size(random) * 3.0),
        1 => format!(r#"<sphere radius="{}"/>"#, size(random)),
        2 => format!(r#"<cylinder radius="{}" length="{}"/>"#, size(random), size(random) * 3.0),
        _ => format!(r#"<capsule radius="{}" length="{}"/>"#, size(random), size(random) * 3.0),
    };
    format!(r#"<collision><origin xyz="{} {} {}"/><geometry>{geometry}</geometry></collision>"#, at.x, at.y, at.z)
}

/// A tree of two to six joints, mostly a chain; some fixed, some that follow another.
fn robot(random: &mut Random) -> RobotModel {
    let count = 2 + random.below(5);
    let mut text = String::from("<robot name=\"random\">");
    for link in 0..=count {
        let shapes: String = (0..[0, 1, 1, 2][random.below(4)]).map(|_| collision(random)).collect();
        write!(text, "<link name=\"l{link}\">{shapes}</link>").unwrap();
    }
    let mut leader = None;
    for joint in 0..count {
        let kind =
            ["revolute", "revolute", "continuous", "prismatic", "prismatic", "fixed", "floating"][random.below(7)];
        let parent = if random.below(4) == 0 { random.below(joint + 1) } else { joint };
        let (at, rpy, axis) = (random.vector(0.5), random.vector(3.0), random.vector(1.0) + Vec3::new(0.0, 0.0, 0.1));
        write!(
            text,
            r#"<joint name="j{joint}" type="{kind}"><parent link="l{parent}"/><child link="l{}"/><limit lower="-9" upper="9"/>
               <origin xyz="{} {} {}" rpy="{} {} {}"/><axis xyz="{} {} {}"/>"#,
            joint + 1, at.x, at.y, at.z, rpy.x, rpy.y, rpy.z, axis.x, axis.y, axis.z
        )
        .unwrap();
        if !["fixed", "floating"].contains(&kind) {
            match leader {
                Some(leader) if random.below(4) == 0 => {
                    let (multiplier, offset) = (random.between(-1.5, 1.5), random.between(-0.5, 0.5));
                    write!(text, r#"<mimic joint="j{leader}" multiplier="{multiplier}" offset="{offset}"/>"#).unwrap();
                }
                _ => leader = Some(joint),
            }
        }
        text.push_str("</joint>");
    }
    let mut none = |_: &MeshRequest| Err("none".to_owned());
    RobotModel::from_urdf(&(text + "</robot>"), None, &mut none, &ModelOptions::default()).unwrap()
}

fn pose(random: &mut Random, size: f64) -> Pose {
    let turn = Quaternion::from_roll_pitch_yaw(
        random.between(-3.0, 3.0),
        random.between(-1.5, 1.5),
        random.between(-3.0, 3.0),
    );
    Pose::new(random.vector(size), turn).unwrap()
}

fn scene(random: &mut Random) -> (Arc<RobotModel>, Arc<Snapshot>) {
    let model = Arc::new(robot(random));
    let base = pose(random, 0.5);
    let mut edits = vec![Edit::AddRobot { name: "arm".to_owned(), model: Arc::clone(&model), base }];
    for body in 0..random.below(16) {
        let shape = match random.below(5) {
            0 => Shape::sphere(random.between(0.02, 0.2)),
            1 => {
                Shape::cuboid(Vec3::new(random.between(0.0, 0.4), random.between(0.02, 0.4), random.between(0.02, 0.2)))
            }
            2 => Shape::capsule(random.between(0.02, 0.1), random.between(0.1, 0.6)),
            3 => Shape::convex(&(0..9).map(|_| random.vector(0.3)).collect::<Vec<_>>()),
            _ => Shape::half_space(Vec3::new(0.1, -0.2, 1.0), random.between(-2.0, -0.8)),
        };
        edits.push(Edit::AddBody(NewBody::new(format!("body {body}"), Arc::new(shape.unwrap()), pose(random, 1.2))));
    }
    let mut scene = Scene::new(Epoch(1));
    scene.apply(&edits, None).unwrap();
    (model, scene.snapshot())
}

/// Start and goal, mostly from a start that is free, if one is met in a few throws.
fn motion(random: &mut Random, model: &RobotModel, snapshot: &Snapshot) -> Vec<f64> {
    let mut thrown = throw(random, model);
    let throws = [1, 20][usize::from(random.below(6) > 0)];
    for _ in 1..throws {
        let positions = thrown[..model.degrees_of_freedom()].to_vec();
        let context = Context { margin: 0.02, ..Context::default() };
        let start = CheckStates { robot: "arm".to_owned(), positions, mode: Mode::All, context };
        let start = Prepared::check_states(snapshot, &start).unwrap().answer(&|| false).items.remove(0);
        if start.verdict == Verdict::Free {
            break;
        }
        thrown = throw(random, model);
    }
    thrown
}

/// Start and goal; floating joints keep their orientation.
fn throw(random: &mut Random, model: &RobotModel) -> Vec<f64> {
    let reach = [0.02, 0.3, 1.5, 4.0][random.below(4)];
    let mut start = Vec::new();
    let mut goal = Vec::new();
    for joint in model.joints() {
        let scale = if joint.kind == JointKind::Prismatic || joint.kind == JointKind::Floating { 0.3 } else { 1.0 };
        for number in 0..joint.kind.width() {
            let from = random.between(-3.0, 3.0) * scale;
            let moves = number < 3 && random.below(5) > 0;
            start.push(from);
            goal.push(if moves { from + random.between(-reach, reach) * scale } else { from });
        }
    }
    [start, goal].concat()
}

/// How often each regime was reached.
#[derive(Debug, Default)]
struct Reached {
    free: usize,
    at_start: usize,
    midway: usize,
    late: usize,
    undecided: usize,
    resolution: usize,
    margin: usize,
    own: usize,
    turning: usize,
    sliding: usize,
}

fn sweep(seed: u64, motions: usize, samples: usize) -> Reached {
    let mut random = Random(seed);
    let mut reached = Reached::default();
    let mut done = 0;
    while done < motions {
        let (model, snapshot) = scene(&mut random);
        if model.degrees_of_freedom() == 0 {
            continue;
        }
        for _ in 0..20.min(motions - done) {
            done += 1;
            let margin = [0.0, 0.0, 0.05][random.below(3)];
            let context = Context { margin, ..Context::default() };
            let request = CheckMotions {
                robot: "arm".to_owned(),
                positions: motion(&mut random, &model, &snapshot),
                motions: Motions::Edges,
                mode: Mode::All,
                find: if random.below(4) == 0 { Find::AnyContact } else { Find::FirstContact },
                resolution: [1e-4, 1e-3, 1e-2][random.below(3)],
                max_states: [4096, 4096, 4096, 12][random.below(4)],
                context,
            };
            let item = Prepared::check_motions(&snapshot, &request).unwrap().answer(&|| false).items.remove(0);
            check(&snapshot, &model, &request, &item, samples, &mut random, &mut reached);
        }
    }
    reached
}

fn check(
    snapshot: &Snapshot,
    model: &RobotModel,
    request: &CheckMotions,
    item: &ItemAnswer,
    samples: usize,
    random: &mut Random,
    reached: &mut Reached,
) {
    let motion = item.motion.unwrap();
    let (start, goal) = request.positions.split_at(model.degrees_of_freedom());
    let mut times: Vec<f64> = (0..samples).map(|_| random.between(0.0, 1.0)).collect();
    // Where a claim ends is where it is most likely to be wrong.
    times.extend([0.0, 1.0, motion.free_until, motion.free_until * (1.0 - 1e-9), motion.free_until * 0.999]);
    times.extend(motion.reached.into_iter().flatten());
    times.extend(motion.reached.map(|[from, _]| from * (1.0 - 1e-9)));
    let at = |t: f64| -> Vec<f64> {
        let between = start.iter().zip(goal).map(|(start, goal)| start + t * (goal - start));
        if t == 1.0 { goal.to_vec() } else { between.collect() }
    };
    let positions = times.iter().flat_map(|t| at(*t)).collect();
    let (robot, context) = (request.robot.clone(), request.context.clone());
    let states = CheckStates { robot, positions, mode: Mode::All, context };
    let states = Prepared::check_states(snapshot, &states).unwrap().answer(&|| false).items;
    let told = || format!("{item:?}\n{request:?}\n{model:?}");
    for (t, state) in times.iter().zip(&states) {
        if *t < motion.free_until || item.verdict == Verdict::Free {
            assert_eq!(state.verdict, Verdict::Free, "at {t}: {}", told());
        }
        let apart = match (item.verdict, motion.reached) {
            (Verdict::Free | Verdict::Margin, _) => true,
            (Verdict::Collision, Some([from, _])) => *t < from,
            _ => false,
        };
        assert!(!apart || matches!(state.verdict, Verdict::Free | Verdict::Margin), "at {t}: {state:?} {}", told());
        if let Some([from, to]) = motion.reached {
            assert!(motion.free_until <= from && from <= to && to <= 1.0, "{}", told());
            let worst = if item.verdict == Verdict::Margin { Verdict::Margin } else { Verdict::Collision };
            assert!(*t != to || state.verdict == worst, "at {t}: {state:?} {}", told());
        }
    }
    reached.free += usize::from(item.verdict == Verdict::Free);
    reached.margin += usize::from(item.verdict == Verdict::Margin);
    if item.verdict == Verdict::Collision {
        let [from, to] = motion.reached.unwrap();
        reached.at_start += usize::from(to == 0.0);
        reached.midway += usize::from(from > 0.0 && to < 1.0);
        reached.late += usize::from(to > 0.5);
        let pair = item.nearest.as_ref().unwrap();
        assert_eq!(pair.verdict, Verdict::Collision, "{}", told());
        reached.own += usize::from(matches!(pair.b, Side::Link { .. }));
    }
    if let Verdict::Indeterminate(why) = item.verdict {
        reached.undecided += 1;
        reached.resolution += usize::from(why == Indeterminacy::Resolution);
        let [from, to] = motion.undecided.unwrap();
        assert!(motion.free_until <= from && from < to && to <= 1.0, "{}", told());
    }
    let moves = |kind: fn(JointKind) -> bool| {
        model.joints().iter().any(|joint| kind(joint.kind) && start[joint.first] != goal[joint.first])
    };
    reached.turning += usize::from(moves(|kind| kind == JointKind::Revolute || kind == JointKind::Continuous));
    reached.sliding += usize::from(moves(|kind| kind == JointKind::Prismatic || kind == JointKind::Floating));
}

fn assert_every_regime(reached: &Reached, motions: usize) {
    println!("{motions} motions: {reached:?}");
    let Reached { free, at_start, midway, late, undecided, resolution, margin, own, turning, sliding } = *reached;
    for (count, least) in [
        (free, 10),
        (at_start, 20),
        (midway, 10),
        (late, 20),
        (undecided, 100),
        (resolution, 500),
        (margin, 50),
        (own, 50),
        (turning, 2),
        (sliding, 2),
    ] {
        assert!(count > motions / least / 2, "{reached:?}");
    }
}

#[test]
fn random_motions_hold_for_samples() {
    let motions = 2000;
    assert_every_regime(&sweep(1, motions, 24), motions);
}

/// `MOTIONS` of them, a million unless said.
#[test]
#[ignore = "minutes; ./test long"]
fn a_million_random_motions_hold_for_samples() {
    let motions: usize = std::env::var("MOTIONS").ok().and_then(|count| count.parse().ok()).unwrap_or(1_000_000);
    let parts = std::thread::available_parallelism().map_or(1, usize::from);
    let sweeps: Vec<Reached> = std::thread::scope(|scope| {
        let run = |part: usize| scope.spawn(move || sweep(1000 + part as u64, motions / parts, 48));
        let running: Vec<_> = (0..parts).map(run).collect();
        running.into_iter().map(|sweep| sweep.join().unwrap()).collect()
    });
    for reached in &sweeps {
        assert_every_regime(reached, motions / parts);
    }
}
