//! What shapes of many pieces cost: a height field of a million samples, a cloud of a million points, a map of a million cells and what an
//! insertion into it takes, and the cost cards of the mesh files that are named on the command line.
//!
//! `cargo run --release --no-default-features --example fields -- tests/data/robot-ur5/meshes/*`

use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use clearance::geometry::mesh_file::{self, MeshFormat};
use clearance::geometry::{
    Grid, HeightField, PointCloud, Pose, Quaternion, Shape, TriangleMesh, Vec3, Voxels, decomposed,
};
use clearance::narrow_phase::{Depth, Goal, separation};
use clearance::query::MeshCard;

/// The least of several times, seconds.
fn least<T>(times: u32, mut work: impl FnMut() -> T) -> (f64, T) {
    let mut timed = || {
        let started = Instant::now();
        let made = black_box(work());
        (started.elapsed().as_secs_f64(), made)
    };
    let (first, made) = timed();
    ((1..times).map(|_| timed().0).fold(first, f64::min), made)
}

fn ask(name: &str, shape: &Shape, at: Vec3) {
    let ball = Shape::sphere(0.3).expect("a positive radius");
    let (here, there) =
        (Pose::identity().placement(), Pose::new(at, Quaternion::IDENTITY).expect("finite").placement());
    for (depth, what) in [(Depth::Verdict, "verdict"), (Depth::Distance, "distance")] {
        let goal = Goal { depth, ..Goal::penetration() };
        let (seconds, found) = least(50, || separation(shape, &ball, &here, &there, &goal));
        let found = found.expect("both are bounded");
        println!("  {what} of a ball 0.3 m from {name}: {:.1} us, {} nodes", seconds * 1e6, found.cost.nodes);
    }
}

/// Numbers between -1 and 1 that are the same each time: the finaliser of SplitMix64.
fn noise(i: u32) -> f64 {
    let mut hash = (u64::from(i) + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    hash = (hash ^ hash >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    hash = (hash ^ hash >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((hash ^ hash >> 31) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

fn main() {
    let n = 1000;
    let heights: Vec<f64> = (0..n * n)
        .map(|i| libm::sin(f64::from(i % n) * 0.02) + libm::cos(f64::from(i / n) * 0.03) + 0.01 * noise(i))
        .collect();
    let grid = Grid { rows: n, columns: n, spacing: [0.1, 0.1] };
    let (seconds, field) = least(5, || HeightField::new(grid, heights.clone(), -5.0).expect("a field"));
    println!("height field {n} x {n}: {:.1} ms, {:.1} MB", seconds * 1e3, field.memory() as f64 / 1e6);
    ask("it", &Shape::height_field(Arc::new(field)), Vec3::new(50.0, 50.0, 3.0));

    let points: Vec<Vec3> = (0..1_000_000)
        .map(|i| Vec3::new(noise(3 * i), noise(3 * i + 1), noise(3 * i + 2)).normalize() * 10.0)
        .collect();
    let (seconds, cloud) = least(3, || PointCloud::new(&points).expect("a cloud"));
    println!("point cloud of {}: {:.0} ms, {:.1} MB", cloud.len(), seconds * 1e3, cloud.memory() as f64 / 1e6);
    ask("it", &Shape::point_cloud(Arc::new(cloud), 0.01).expect("a radius"), Vec3::new(9.3, 0.0, 0.0));

    let surface: Vec<Vec3> = (0..2_600_000)
        .map(|i| Vec3::new(noise(3 * i), noise(3 * i + 1), noise(3 * i + 2)).normalize() * 14.0)
        .collect();
    let empty = Voxels::new(0.05).expect("a resolution");
    let (seconds, map) = least(2, || empty.with_points(&surface).expect("in reach"));
    println!("voxels of {} cells: {:.0} ms, {:.1} MB", map.len(), seconds * 1e3, map.memory() as f64 / 1e6);
    let scan: Vec<Vec3> = (0..1000).map(|i| Vec3::new(13.9, noise(2 * i), noise(2 * i + 1))).collect();
    let (seconds, more) = least(50, || map.with_points(&scan).expect("in reach"));
    println!("  1000 points inserted: {:.0} us, {} new cells", seconds * 1e6, more.len() - map.len());
    let wide: Vec<Vec3> = (0..1000).map(|i| surface[i * 2003] * 1.01).collect();
    let (seconds, more) = least(50, || map.with_points(&wide).expect("in reach"));
    println!("  1000 points all around: {:.0} us, {} new cells", seconds * 1e6, more.len() - map.len());
    ask("it", &Shape::voxels(map), Vec3::new(13.2, 0.0, 0.0));

    println!("file: triangles, pieces, bytes, build ms, inflation mm, loss mm, closed");
    for path in std::env::args().skip(1) {
        let soup = MeshFormat::from_name(&path)
            .and_then(|format| mesh_file::read(&std::fs::read(&path).unwrap_or_default(), format));
        let Ok(soup) = soup else {
            println!("{path}: not a mesh");
            continue;
        };
        let (seconds, pieces) = least(1, || decomposed(&soup.vertices, &soup.triangles).expect("a mesh"));
        let mesh = Arc::new(TriangleMesh::surface(soup.vertices, soup.triangles).expect("a mesh"));
        let card = MeshCard::of(&mesh, &Arc::new(pieces), None, &|| false);
        let (inflation, loss) = (card.fit.inflation, card.fit.loss);
        println!(
            "{path}: {}, {}, {}, {:.0}, {:.2}..{:.2}, {:.3}..{:.3}, {}",
            mesh.triangles().len(),
            card.pieces,
            card.bytes,
            seconds * 1e3,
            inflation.lower * 1e3,
            inflation.upper * 1e3,
            loss.lower * 1e3,
            loss.upper * 1e3,
            card.fit.closed
        );
    }
}
