//! `clearance` as a contender, through the door of its narrow phase. A configuration is words joined by "/":
//!
//!   1e-1 .. 1e-12     the relative tolerance
//!   1e-2m .. 1e-6m    the absolute tolerance, metres (and 1e-12 relative)
//!   cold, warm        each pair anew; tracks: from the cache that the step before left
//!   gjk, sat, ...     a solver of the ladder by its name; the default without one

use std::env;
use std::error::Error;
use std::path::Path;
use std::sync::Arc;

use clearance::geometry::{InvalidShape, Placement, Pose, Quaternion, Shape, TriangleMesh, Vec3};
use clearance::narrow_phase::{
    Accuracy, Depth, Goal, NoSeparation, PairCache, Separation, Solver, separation, separation_again,
};
use clearance_peers::contender::{Answer, Contender, Pass, serve};
use clearance_peers::pairs::{Kind, PairSet, Pairs, PoseRecord, ShapeRecord};

const RELATIVE: [&str; 16] = [
    "1e-1", "3e-2", "1e-2", "3e-3", "1e-3", "3e-4", "1e-4", "3e-5", "1e-5", "1e-6", "1e-7", "1e-8", "1e-9", "1e-10",
    "1e-11", "1e-12",
];

/// Peers' tolerances are lengths: one of ours that is, too, does no more work on what is near than on what is far.
const ABSOLUTE: [&str; 9] = ["1e-2m", "3e-3m", "1e-3m", "3e-4m", "1e-4m", "3e-5m", "1e-5m", "3e-6m", "1e-6m"];

struct Ours<'a> {
    pairs: &'a Pairs,
    shapes: Vec<Shape>,
}

impl<'a> Ours<'a> {
    fn new(pairs: &'a Pairs) -> Result<Self, InvalidShape> {
        Ok(Self { pairs, shapes: pairs.shapes.iter().map(shape).collect::<Result<_, _>>()? })
    }
}

impl Contender for Ours<'_> {
    fn configs(&self, set: &PairSet, operation: &str) -> Vec<String> {
        if set.name.starts_with("mesh") && operation == "penetration" {
            return Vec::new();
        }
        if set.track_length > 0 {
            return vec!["1e-9/cold".to_owned(), "1e-9/warm".to_owned()];
        }
        let tolerances = match operation {
            // A verdict is reached or not, whatever the tolerance.
            "collide" => vec!["1e-9"],
            // On triangles the search ends on a feature, whatever the tolerance.
            _ if set.name.starts_with("mesh") => vec!["1e-3", "1e-6", "1e-9", "1e-12"],
            _ => [&RELATIVE[..], &ABSOLUTE[..]].concat(),
        };
        tolerances.into_iter().map(|tolerance| format!("{tolerance}/cold")).collect()
    }

    fn ask(&mut self, set: &PairSet, operation: &str, config: &str, pass: &mut Pass) {
        let words = config.split('/');
        let accuracy = words.clone().find_map(accuracy).expect("a configuration has a tolerance");
        let solver = words.clone().find_map(Solver::named).unwrap_or_default();
        let goal = Goal { depth: depth(operation), accuracy, solver, ..Goal::penetration() };
        let pairs: Vec<(&Shape, &Shape, Placement, Placement)> = (self.pairs.of(set).iter())
            .map(|pair| (&self.shapes[pair.a], &self.shapes[pair.b], placement(&pair.at_a), placement(&pair.at_b)))
            .collect();
        let read = if operation == "collide" { verdict } else { distance };
        if words.clone().any(|word| word == "warm") {
            let mut cache = PairCache::new();
            pass.run(
                |i| {
                    if i % set.track_length == 0 {
                        cache = PairCache::new();
                    }
                    let (a, b, at_a, at_b) = &pairs[i];
                    separation_again(a, b, at_a, at_b, &goal, &mut cache)
                },
                read,
            );
        } else {
            pass.run(
                |i| {
                    let (a, b, at_a, at_b) = &pairs[i];
                    separation(a, b, at_a, at_b, &goal)
                },
                read,
            );
        }
    }
}

fn depth(operation: &str) -> Depth {
    match operation {
        "collide" => Depth::Verdict,
        "distance" => Depth::Distance,
        _ => Depth::Penetration,
    }
}

fn accuracy(word: &str) -> Option<Accuracy> {
    Some(match word.strip_suffix('m') {
        Some(length) => Accuracy { absolute: length.parse().ok()?, relative: 1e-12 },
        None => Accuracy { relative: word.parse().ok()?, ..Accuracy::default() },
    })
}

fn distance(found: Result<Separation, NoSeparation>) -> Answer {
    match found {
        Ok(found) => Answer { value: found.signed_distance, bracket: Some((found.bracket.lower, found.bracket.upper)) },
        Err(_) => Answer::from(f64::NAN),
    }
}

/// 1 and 0 for touching and apart; NaN when the bracket leaves it open.
fn verdict(found: Result<Separation, NoSeparation>) -> Answer {
    let Answer { bracket, .. } = distance(found);
    let value = match bracket {
        Some((_, upper)) if upper <= 0.0 => 1.0,
        Some((lower, _)) if lower > 0.0 => 0.0,
        _ => f64::NAN,
    };
    Answer { value, bracket }
}

fn vector(v: &[f64; 3]) -> Vec3 {
    Vec3::new(v[0], v[1], v[2])
}

fn placement(pose: &PoseRecord) -> Placement {
    let [x, y, z, w] = pose.rotation;
    Pose::new(vector(&pose.translation), Quaternion { w, x, y, z }).expect("the pairs are valid").placement()
}

fn shape(record: &ShapeRecord) -> Result<Shape, InvalidShape> {
    let [p, q, r, _] = record.params;
    let vertices: Vec<Vec3> = record.vertices.iter().map(vector).collect();
    match record.kind {
        Kind::Hull => Shape::convex(&vertices),
        Kind::Sphere => Shape::sphere(p),
        Kind::Box => Shape::cuboid(Vec3::new(p, q, r)),
        Kind::Capsule => Shape::capsule(p, q),
        Kind::Cylinder => Shape::cylinder(p, q),
        Kind::Cone => Shape::cone(p, q),
        Kind::Ellipsoid => Shape::ellipsoid(Vec3::new(p, q, r)),
        Kind::Mesh => Ok(Shape::mesh(Arc::new(TriangleMesh::surface(vertices, record.triangles.clone())?))),
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = env::args().nth(1).ok_or("usage: ours PAIRS")?;
    let pairs = Pairs::read(Path::new(&path))?;
    serve(&mut Ours::new(&pairs)?, &pairs)?;
    Ok(())
}
