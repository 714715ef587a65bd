//! Which geometry for a body? The exact mesh, convex pieces, its hull, balls, voxels: what each gets wrong, and what it costs.

use std::sync::Arc;

use crate::geometry::{Aabb, Compound, InvalidShape, Placement, Quaternion, Shape, TriangleMesh, Vec3};
use crate::narrow_phase::{FitGoal, Goal, fit, separation};

use super::body::{mesh_bytes, mug, shelf};
use super::families::placed;
use super::pieces::with_at_most;
use super::plot::{Point, Series, plot};
use super::race::{Raced, Way, race};
use super::random::Random;
use super::scale::{Axis, Unit, time};
use super::section::{Figure, Section};
use super::sphere_cover::cover;
use super::study::{NoStudy, Study};
use super::table::{Table, nanoseconds, number};

/// Of the time.
pub(super) const SHARE: f64 = 0.1;

/// Pieces at most.
const PIECES: [usize; 5] = [32, 16, 8, 4, 2];

/// Cells along the longest side of a body.
const CELLS: [usize; 4] = [8, 16, 32, 64];

/// Poses whose questions are timed.
const TIMED: usize = 48;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Mesh,
    Pieces,
    Hull,
    Balls,
    Voxels,
}

impl Kind {
    const ALL: [Self; 5] = [Self::Mesh, Self::Pieces, Self::Hull, Self::Balls, Self::Voxels];

    fn name(self) -> &'static str {
        match self {
            Self::Mesh => "exact mesh",
            Self::Pieces => "convex pieces",
            Self::Hull => "hull",
            Self::Balls => "balls",
            Self::Voxels => "voxels",
        }
    }

    fn mark(self) -> usize {
        match self {
            Self::Mesh => 0,
            Self::Pieces => 1,
            Self::Hull => 8,
            Self::Balls => 2,
            Self::Voxels => 3,
        }
    }
}

/// One way to stand for a body.
struct Stand {
    kind: Kind,
    name: String,
    shape: Shape,
    /// Triangles, pieces, balls or cells.
    parts: usize,
    bytes: usize,
    /// How far a point of it may be from the body, metres: at least, at most.
    inflation: [f64; 2],
    /// How far a point of the body may be from it.
    loss: [f64; 2],
}

/// What was found with one way over all poses.
struct Told {
    raced: Raced,
    false_hits: usize,
    misses: usize,
    undecided: usize,
}

/// A body, and what is held against it.
struct Subject {
    name: &'static str,
    mesh: Arc<TriangleMesh>,
    probe: Shape,
    probe_name: &'static str,
}

fn subjects() -> Result<Vec<Subject>, InvalidShape> {
    let cuboid = |x: f64, y: f64, z: f64| Shape::cuboid(Vec3::new(x, y, z));
    Ok(vec![
        Subject {
            name: "shelf",
            mesh: shelf()?,
            probe: cuboid(0.04, 0.05, 0.06)?,
            probe_name: "a box of 8 x 10 x 12 cm, a picked item",
        },
        Subject {
            name: "mug",
            mesh: mug(48)?,
            probe: cuboid(0.005, 0.01, 0.03)?,
            probe_name: "a box of 1 x 2 x 6 cm, a finger",
        },
    ])
}

fn bracket_of(fit: crate::narrow_phase::Bracket) -> [f64; 2] {
    [fit.lower.max(0.0), fit.upper.max(0.0)]
}

fn of_pieces(kind: Kind, mesh: &Arc<TriangleMesh>, pieces: &Arc<Compound>, accuracy: f64, most_points: usize) -> Stand {
    let fit = fit(mesh, pieces, &FitGoal { accuracy, most_points, stop: &|| false });
    let count = pieces.parts().len();
    let name = if kind == Kind::Hull { "hull".to_owned() } else { format!("{count} pieces") };
    Stand {
        kind,
        name,
        shape: Shape::compound(Arc::clone(pieces)),
        parts: count,
        bytes: pieces.memory(),
        inflation: bracket_of(fit.inflation),
        loss: bracket_of(fit.loss),
    }
}

fn stands(mesh: &Arc<TriangleMesh>, most_cells: usize, most_points: usize) -> Result<Vec<Stand>, InvalidShape> {
    let exact = Shape::mesh(Arc::clone(mesh));
    let bounds = mesh.bounds();
    let longest = 2.0 * bounds.half_extents().max();
    let mut all = vec![Stand {
        kind: Kind::Mesh,
        name: "exact mesh".to_owned(),
        shape: exact.clone(),
        parts: mesh.triangles().len(),
        bytes: mesh_bytes(mesh),
        inflation: [0.0; 2],
        loss: [0.0; 2],
    }];
    for pieces in with_at_most(mesh, &PIECES)? {
        all.push(of_pieces(Kind::Pieces, mesh, &pieces, 1e-3 * longest, most_points));
    }
    let hull = Shape::convex(mesh.vertices())?;
    let part = crate::geometry::Part { shape: hull.clone(), pose: crate::geometry::Pose::identity() };
    let alone = Arc::new(Compound::new(vec![part])?);
    all.push(Stand { shape: hull, ..of_pieces(Kind::Hull, mesh, &alone, 1e-3 * longest, most_points) });
    for cells in CELLS.into_iter().filter(|cells| *cells <= most_cells) {
        let covered = cover(&exact, &bounds, longest / cells as f64);
        let millimetres = 1e3 * covered.side;
        let (cloud, radius) = covered.balls()?;
        let (parts, bytes) = (cloud.len(), cloud.memory());
        all.push(Stand {
            kind: Kind::Balls,
            name: format!("{parts} balls, {millimetres:.1} mm cells"),
            shape: Shape::point_cloud(Arc::new(cloud), radius)?,
            parts,
            bytes,
            inflation: covered.inflation_of_balls(&exact, radius),
            loss: [0.0; 2],
        });
        let map = covered.voxels()?;
        all.push(Stand {
            kind: Kind::Voxels,
            name: format!("voxels of {millimetres:.1} mm"),
            parts: map.len(),
            bytes: map.memory(),
            shape: Shape::voxels(map),
            inflation: covered.inflation_of_cells(&exact),
            loss: [0.0; 2],
        });
    }
    Ok(all)
}

/// Poses of the probe whose bounds meet the body's: what a broad phase lets through.
fn poses(bounds: &Aabb, probe: &Shape, count: usize, random: &mut Random) -> Vec<Placement> {
    let around = bounds.grown(super::families::radius(probe));
    let pose = || {
        let center = random.within(around.min, around.max);
        // Items and grippers are mostly upright; a third of them lie any way.
        let upright = random.between(0.0, 3.0) > 1.0;
        let turn = random.between(0.0, std::f64::consts::TAU);
        let any = random.rotation();
        placed(center, if upright { Quaternion::about_axis(Vec3::z(), turn) } else { any })
    };
    let meets = |at: &Placement| probe.placed_bounds(at).is_some_and(|placed| placed.overlaps(bounds));
    // Most of them meet; a bound all the same, so that this ends whatever happens.
    std::iter::repeat_with(pose).take(100 * count).flatten().filter(meets).take(count).collect()
}

/// 1 for a collision, -1 for apart, 0 for neither.
fn verdict(body: &Shape, probe: &Shape, at: &Placement) -> i32 {
    let found = separation(body, probe, &Placement::identity(), at, &Goal::verdict());
    found.map_or(0, |found| i32::from(found.bracket.upper <= 0.0) - i32::from(found.bracket.lower > 0.0))
}

pub(super) fn section(study: &Study, advance: &mut dyn FnMut(f64)) -> Result<Section, NoStudy> {
    let subjects = subjects().map_err(NoStudy::own)?;
    let columns = [
        "body",
        "geometry",
        "kind",
        "parts",
        "bytes",
        "inflation_at_least_m",
        "inflation_at_most_m",
        "loss_at_least_m",
        "loss_at_most_m",
        "poses_free",
        "poses_colliding",
        "false_hits",
        "misses",
        "undecided",
        "time_median_ns",
        "time_p99_ns",
    ];
    let mut table = Table::new("geometry", &columns);
    let (mut drawings, mut readings, mut rows, mut advices) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let count = study.effort.of(20_000, 600);
    let most_cells = if study.effort.part < 1.0 { 32 } else { 64 };
    let mut random = Random(60);
    let of_all = subjects.len() as f64;
    for (i, subject) in subjects.iter().enumerate() {
        let stands = stands(&subject.mesh, most_cells, study.effort.of(20_000, 1000)).map_err(NoStudy::own)?;
        advance((i as f64 + 0.3) / of_all);
        let poses = poses(&subject.mesh.bounds(), &subject.probe, count, &mut random);
        let truth: Vec<i32> = poses.iter().map(|at| verdict(&stands[0].shape, &subject.probe, at)).collect();
        let told = told(study, subject, &stands, &poses, &truth, subjects.len());
        advance((i as f64 + 1.0) / of_all);
        let free = truth.iter().filter(|verdict| **verdict < 0).count();
        let colliding = truth.iter().filter(|verdict| **verdict > 0).count();
        for (stand, told) in stands.iter().zip(&told) {
            table.push(row(subject, stand, told, free, colliding));
            rows.push(short_row(subject, stand, told, free, colliding));
        }
        drawings.push(drawn(subject, &stands, &told, free).concat());
        advices.extend(advice(subject, &stands, &told, free));
        readings.extend(reading(subject, &stands, &told, free, colliding));
    }
    let head = ["body", "geometry", "kB", "reaches beyond, mm", "loses, mm", "false hits", "misses", "median", "p99"];
    Ok(Section {
        title: "Geometry",
        what: format!(
            "What stands for a body, and what that gets wrong: {count} poses of a probe whose bounds meet the body's, as a broad phase lets them through; the exact solid mesh is the truth. \
             {} A false hit costs a plan, a miss costs a robot. Balls are built here: one around each cell of a grid that the body may touch, through its \
             corners, so nothing is lost; how far they reach beyond the body is in the table, proved from both sides.",
            subjects.iter().map(|s| format!("Against the {}: {}.", s.name, s.probe_name)).collect::<Vec<_>>().join(" ")
        ),
        readings,
        advice: Some(advices.join(" ")),
        figures: vec![Figure {
            caption: "Time of a verdict by the share of free poses that are told to collide (none at the left edge); memory by how far the \
                      geometry reaches beyond the body (nothing at the left edge)"
                .to_owned(),
            legend: Kind::ALL.iter().map(|kind| (kind.name().to_owned(), kind.mark())).collect(),
            drawings,
        }],
        summary: Some((head.map(str::to_owned).to_vec(), rows)),
        table,
    })
}

fn told(
    study: &Study,
    subject: &Subject,
    stands: &[Stand],
    poses: &[Placement],
    truth: &[i32],
    subjects: usize,
) -> Vec<Told> {
    let timed = poses.len().min(TIMED);
    let mut ways: Vec<Way> = stands
        .iter()
        .map(|stand| {
            Way::new(timed, move |item| _ = std::hint::black_box(verdict(&stand.shape, &subject.probe, &poses[item])))
        })
        .collect();
    let raced = race(&mut ways, study.effort.share(SHARE, subjects), &mut |_| ());
    drop(ways);
    let one = |(stand, raced): (&Stand, Raced)| {
        let mut told = Told { raced, false_hits: 0, misses: 0, undecided: 0 };
        for (at, truth) in poses.iter().zip(truth) {
            let found = verdict(&stand.shape, &subject.probe, at);
            told.false_hits += usize::from(*truth < 0 && found >= 0);
            told.misses += usize::from(*truth > 0 && found < 0);
            told.undecided += usize::from(found == 0);
        }
        told
    };
    stands.iter().zip(raced).map(one).collect()
}

fn row(subject: &Subject, stand: &Stand, told: &Told, free: usize, colliding: usize) -> Vec<String> {
    vec![
        subject.name.to_owned(),
        stand.name.clone(),
        stand.kind.name().to_owned(),
        stand.parts.to_string(),
        stand.bytes.to_string(),
        number(stand.inflation[0]),
        number(stand.inflation[1]),
        number(stand.loss[0]),
        number(stand.loss[1]),
        free.to_string(),
        colliding.to_string(),
        told.false_hits.to_string(),
        told.misses.to_string(),
        told.undecided.to_string(),
        nanoseconds(told.raced.median),
        nanoseconds(told.raced.p99),
    ]
}

fn share(part: usize, of: usize) -> String {
    format!("{:.2} %", 100.0 * part as f64 / of.max(1) as f64)
}

fn short_row(subject: &Subject, stand: &Stand, told: &Told, free: usize, colliding: usize) -> Vec<String> {
    let millimetres = |[low, high]: [f64; 2]| {
        if high < 1e-9 { "0".to_owned() } else { format!("{:.1} to {:.1}", 1e3 * low, 1e3 * high) }
    };
    vec![
        subject.name.to_owned(),
        stand.name.clone(),
        format!("{:.0}", stand.bytes as f64 / 1e3),
        millimetres(stand.inflation),
        millimetres(stand.loss),
        share(told.false_hits, free),
        share(told.misses, colliding),
        time(told.raced.median),
        time(told.raced.p99),
    ]
}

fn drawn(subject: &Subject, stands: &[Stand], told: &[Told], free: usize) -> [String; 2] {
    let series = |point: &dyn Fn(&Stand, &Told) -> Point| -> Vec<Series> {
        let of = |kind: Kind| {
            let own = stands.iter().zip(told).filter(|(stand, _)| stand.kind == kind);
            Series { mark: kind.mark(), joined: true, points: own.map(|(stand, told)| point(stand, told)).collect() }
        };
        Kind::ALL.map(of).into()
    };
    let hits = |_: &Stand, told: &Told| {
        let part = told.false_hits as f64 / free.max(1) as f64;
        Point::with_tail(part, told.raced.median, told.raced.p99)
    };
    let memory = |stand: &Stand, _: &Told| Point::new(stand.inflation[1], stand.bytes as f64);
    let least = 0.5 / free.max(1) as f64;
    [
        plot(
            &format!("{}: time by false hits", subject.name),
            &Axis::log("false hits among free poses", Unit::Part),
            &Axis::log("", Unit::Seconds),
            &series(&hits),
            least,
        ),
        plot(
            &format!("{}: memory by inflation", subject.name),
            &Axis::log("reaches beyond the body at most, m", Unit::Plain),
            &Axis::log("", Unit::Bytes),
            &series(&memory),
            1e-5,
        ),
    ]
}

/// The quickest without a false answer, and what others would save.
fn advice(subject: &Subject, stands: &[Stand], told: &[Told], free: usize) -> Option<String> {
    let quickest = |most: usize| {
        let fits = stands.iter().zip(told).filter(move |(_, told)| told.false_hits <= most && told.misses == 0);
        fits.min_by(|a, b| a.1.raced.median.total_cmp(&b.1.raced.median))
    };
    let (right, right_told) = quickest(0)?;
    let (_, hull) = stands.iter().zip(told).find(|(stand, _)| stand.kind == Kind::Hull)?;
    let loose = quickest(free / 20).filter(|(stand, _)| stand.name != right.name);
    let loose = loose.map_or_else(String::new, |(stand, told)| {
        format!(" Where up to 5 % of free poses may be lost, {} takes {}.", stand.name, time(told.raced.median))
    });
    Some(format!(
        "For a {} take the {} ({} a verdict, no false answer); its hull would take {} and tell {} of the free poses to collide.{loose}",
        subject.name,
        right.name,
        time(right_told.raced.median),
        time(hull.raced.median),
        share(hull.false_hits, free),
    ))
}

fn reading(subject: &Subject, stands: &[Stand], told: &[Told], free: usize, colliding: usize) -> Option<String> {
    let both: Vec<(&Stand, &Told)> = stands.iter().zip(told).collect();
    let (_, exact) = both.first()?;
    let quickest = |most: usize| {
        let fits = both.iter().filter(|(_, told)| told.false_hits <= most && told.misses == 0);
        fits.min_by(|a, b| a.1.raced.median.total_cmp(&b.1.raced.median))
    };
    let (right, right_told) = quickest(0)?;
    let (near, near_told) = quickest(free / 100)?;
    let (_, hull) = both.iter().find(|(stand, _)| stand.kind == Kind::Hull)?;
    let missing: Vec<String> = both
        .iter()
        .filter(|(_, told)| told.misses > 0)
        .map(|(stand, told)| format!("{} ({})", stand.name, share(told.misses, colliding)))
        .collect();
    let missing = if missing.is_empty() { "none".to_owned() } else { missing.join(", ") };
    Some(format!(
        "{}: the exact mesh takes {} a verdict; of what errs in no pose, {} is the quickest ({}), of what has at most 1 % false hits and no \
         miss, {} ({}). The hull tells {} of the free poses to collide. With misses: {missing}.",
        subject.name,
        time(exact.raced.median),
        right.name,
        time(right_told.raced.median),
        near.name,
        time(near_told.raced.median),
        share(hull.false_hits, free),
    ))
}
