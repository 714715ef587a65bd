//! Scenes with ten thousand more bodies, and the right answers in them by looking at every pair.
//!
//! Small boxes, cylinders and spheres at random in a hall of 12 x 12 x 4 m around the robot: a tenth of them within its
//! reach, as parts and tools lie about, the others beyond it. A body is taken only where no state of the scene comes
//! nearer to it than 5 mm: so the verdicts of the workload stay, a third of them collisions, while every state has to be
//! proved free of what is near, and its distance may be another.

use std::fmt::Write as _;
use std::sync::Arc;

use clearance::geometry::{Core, Placement, Pose, Quaternion, Shape, Vec3};
use clearance::narrow_phase::{Goal, separation};
use clearance::robot::RobotModel;
use clearance::scene::{Edit, Epoch, NewBody, Scene, Snapshot};
use serde_json::Value;

pub const EXTRA: usize = 10_000;
const IN_REACH: usize = 1_000;

/// What the arm reaches from its shoulder, metres, with a little to spare.
const REACH: f64 = 1.3;

/// The least distance between a state and an extra body, metres.
const ROOM: f64 = 0.005;

/// The hall's half lengths, and half its height, about the shoulder, metres.
const HALL: (f64, f64) = (6.0, 2.0);

/// Every third scene of the workload: the others have the same objects in other places.
const EVERY: usize = 3;

/// A scene of the workload with extra bodies, and its states.
pub struct Crowded {
    pub snapshot: Arc<Snapshot>,
    /// Joint positions of each, and whether it collides.
    pub states: Vec<(Vec<f64>, bool)>,
    /// The least signed distance of each over all pairs.
    pub distances: Vec<f64>,
}

/// Numbers in 0..1 from a linear congruential generator (Knuth's MMIX constants), the same in every run.
struct Random(u64);

impl Random {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

pub fn scenes(robot: &Arc<RobotModel>, plain: &[Arc<Snapshot>], states: &[(usize, Vec<f64>, Value)]) -> Vec<Crowded> {
    (0..plain.len()).step_by(EVERY).map(|scene| crowded(robot, &plain[scene], scene, states)).collect()
}

fn crowded(robot: &Arc<RobotModel>, plain: &Snapshot, scene: usize, states: &[(usize, Vec<f64>, Value)]) -> Crowded {
    let own: Vec<_> = states.iter().filter(|(of, _, _)| *of == scene).collect();
    let arms: Vec<Vec<Placed>> = own.iter().map(|(_, positions, _)| arm(robot, positions)).collect();
    let shoulder = shoulder(robot, &own[0].1);
    let mut random = Random(scene as u64 + 1);
    let mut bodies: Vec<(Arc<Shape>, Pose)> = Vec::new();
    while bodies.len() < EXTRA {
        let in_reach = bodies.len() < IN_REACH;
        let (shape, pose) = (Arc::new(shape(&mut random)), pose(&mut random, shoulder, in_reach));
        let body = Placed::new(&shape, &pose);
        if arms.iter().all(|arm| least(arm, std::slice::from_ref(&body), ROOM) >= ROOM) {
            bodies.push((shape, pose));
        }
    }
    let placed: Vec<Placed> = (plain.bodies().map(|body| Placed::new(&body.shape, &body.pose)))
        .chain(bodies.iter().map(|(shape, pose)| Placed::new(shape, pose)))
        .collect();
    let distance = |arm: &Vec<Placed>| {
        let between = robot.self_pairs().iter().flat_map(|(a, b)| {
            let of = |link| arm.iter().filter(move |placed| placed.link == link);
            of(*a).flat_map(move |one| of(*b).map(move |other| distance(one, other)))
        });
        let own = between.fold(f64::INFINITY, f64::min);
        least(arm, &placed, own)
    };
    let distances = arms.iter().map(distance).collect();
    let old = plain.bodies().map(|body| NewBody::new(body.name.to_string(), Arc::clone(&body.shape), body.pose));
    let new = (0..).zip(&bodies).map(|(i, (shape, pose))| NewBody::new(format!("extra{i}"), Arc::clone(shape), *pose));
    let mut edits: Vec<Edit> = old.chain(new).map(Edit::AddBody).collect();
    edits.push(Edit::AddRobot { name: "ur5".to_owned(), model: Arc::clone(robot), base: Pose::identity() });
    let mut scene = Scene::new(Epoch(1));
    for some in edits.chunks(EXTRA) {
        scene.apply(some, None).expect("the crowd is in order");
    }
    let collides = |truth: &Value| truth["in_collision"].as_bool().expect("the truth says so");
    let states = own.iter().map(|(_, positions, truth)| (positions.clone(), collides(truth))).collect();
    Crowded { snapshot: scene.snapshot(), states, distances }
}

fn shape(random: &mut Random) -> Shape {
    let mut half = || random.between(0.01, 0.06);
    let sides = Vec3::new(half(), half(), half());
    let made = match random.between(0.0, 3.0) {
        0.0..1.0 => Shape::cuboid(sides),
        1.0..2.0 => Shape::cylinder(sides.x, sides.y),
        _ => Shape::sphere(sides.x),
    };
    made.expect("its lengths are positive")
}

fn shoulder(robot: &RobotModel, positions: &[f64]) -> Vec3 {
    let mut poses = Vec::new();
    robot.link_poses(positions, &Pose::identity(), &mut poses);
    let link = robot.link("shoulder_link_0").expect("the arm has a shoulder");
    poses[link as usize].translation()
}

fn pose(random: &mut Random, shoulder: Vec3, in_reach: bool) -> Pose {
    let translation = loop {
        let (half, height) = if in_reach { (REACH, REACH) } else { HALL };
        let mut across = || random.between(-half, half);
        let point = Vec3::new(across(), across(), random.between(-height, height));
        if (point.norm() < REACH) == in_reach {
            break shoulder + point;
        }
    };
    let mut component = || random.between(-1.0, 1.0);
    let rotation = Quaternion { w: component(), x: component(), y: component(), z: component() };
    Pose::new(translation, rotation).expect("four random numbers are not all zero")
}

/// A shape where it is.
struct Placed {
    /// Of a robot's.
    link: u32,
    shape: Arc<Shape>,
    at: Placement,
    centre: Vec3,
    /// Of a ball about the centre that holds it.
    radius: f64,
}

impl Placed {
    fn new(shape: &Arc<Shape>, pose: &Pose) -> Self {
        let at = pose.placement();
        let bounds = shape.placed_bounds(&at).expect("a body of the workload has bounds");
        let (centre, radius) = (bounds.center(), bounds.half_extents().norm());
        Self { link: 0, shape: Arc::clone(shape), at, centre, radius }
    }
}

fn arm(robot: &RobotModel, positions: &[f64]) -> Vec<Placed> {
    let mut poses = Vec::new();
    robot.link_poses(positions, &Pose::identity(), &mut poses);
    let links = (0..).zip(robot.links()).zip(&poses);
    let shapes = links.flat_map(|((link, parts), pose)| {
        (parts.shapes.iter()).map(move |part| Placed { link, ..Placed::new(&part.shape, &pose.compose(&part.pose)) })
    });
    shapes.collect()
}

fn distance(a: &Placed, b: &Placed) -> f64 {
    separation(&a.shape, &b.shape, &a.at, &b.at, &Goal::penetration()).expect("both have extent").signed_distance
}

/// The least signed distance between one of these and one of those, if it is below `bound`: every pair is looked at, and
/// measured unless balls around the two are farther apart.
fn least(these: &[Placed], those: &[Placed], bound: f64) -> f64 {
    let mut least = bound;
    for a in these {
        for b in those {
            if (a.centre - b.centre).norm() - a.radius - b.radius < least {
                least = least.min(distance(a, b));
            }
        }
    }
    least
}

/// Kind and half lengths of a body, as the text has them.
fn lengths(shape: &Shape) -> (&'static str, [f64; 3]) {
    if let Core::Cuboid { half_extents } = shape.core() {
        ("box", (*half_extents).into())
    } else if let Core::Cylinder { radius, half_length } = shape.core() {
        ("cylinder", [*radius, *half_length, 0.0])
    } else {
        assert_eq!(shape.kind(), "sphere", "the workload has no others");
        ("sphere", [shape.swept_radius(), 0.0, 0.0])
    }
}

/// The crowded scenes as text, for the peer: `scene BODIES STATES`, a line a body (kind, three lengths, translation,
/// quaternion w x y z), and a line a state (positions, 1 for a collision, distance).
pub fn text(scenes: &[Crowded]) -> String {
    let mut text = String::new();
    let mut line = |words: &mut dyn Iterator<Item = String>| {
        let joined = words.collect::<Vec<_>>().join(" ");
        writeln!(text, "{joined}").expect("a string takes all");
    };
    for scene in scenes {
        let bodies: Vec<_> = scene.snapshot.bodies().collect();
        line(&mut ["scene".to_owned(), bodies.len().to_string(), scene.states.len().to_string()].into_iter());
        for body in bodies {
            let (kind, lengths) = lengths(&body.shape);
            let Quaternion { w, x, y, z } = body.pose.rotation();
            let t = body.pose.translation();
            let numbers = lengths.into_iter().chain([t.x, t.y, t.z, w, x, y, z]);
            line(&mut std::iter::once(kind.to_owned()).chain(numbers.map(|number| number.to_string())));
        }
        for ((positions, collides), distance) in scene.states.iter().zip(&scene.distances) {
            let numbers = positions.iter().copied().chain([f64::from(u8::from(*collides)), *distance]);
            line(&mut numbers.map(|number| number.to_string()));
        }
    }
    text
}
