//! Moves a body until it touches another where it should, following derivatives of their nearest points.
//!
//!     cargo run --release --no-default-features --features effect-derivatives --example contact_alignment
//!
//! The lecture's optimisation on three pairs, with each kind of derivatives: the problem and its steps are in
//! `src/study/contact_target.rs`; `clearance study --only alignment` does the same from a thousand places.

use clearance::geometry::{InvalidShape, Pose, Quaternion, Shape, Vec3};
use clearance::narrow_phase::DerivativeMethod;
use clearance::study::{Attempt, ContactTarget};

/// How derivatives are made, what that is called, and pairs of samples.
const METHODS: [(DerivativeMethod, &str, u32); 5] = [
    (DerivativeMethod::Exact, "exact", 1),
    (DerivativeMethod::FiniteDifference, "finite differences", 1),
    (DerivativeMethod::Smoothed0, "smoothed, order 0", 12),
    (DerivativeMethod::Smoothed1Gaussian, "smoothed, order 1, Gaussian", 32),
    (DerivativeMethod::Smoothed1Gumbel, "smoothed, order 1, Gumbel", 1),
];

/// A ball of `corners` points by the golden angle, half a metre wide.
fn hull(corners: u32) -> Result<Shape, InvalidShape> {
    let point = |i: u32| {
        let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(corners);
        let (sin, cos) = libm::sincos(2.399_963_229_7 * f64::from(i));
        Vec3::new(cos * libm::sqrt(1.0 - z * z), sin * libm::sqrt(1.0 - z * z), z) * 0.5
    };
    Shape::convex(&(0..corners).map(point).collect::<Vec<Vec3>>())
}

/// Two shapes: the one that stays, and the one that is moved.
type Pair = [Shape; 2];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let ellipsoids = [Vec3::new(0.5, 0.3, 0.4), Vec3::new(0.3, 0.5, 0.2)].map(Shape::ellipsoid);
    let [one, other] = ellipsoids;
    let pairs: [(&str, Pair); 3] = [
        ("ellipsoids", [one?, other?]),
        ("hulls of 100 corners", [hull(100)?, hull(100)?]),
        ("a box and a hull of 20 corners", [Shape::cuboid(Vec3::new(0.4, 0.3, 0.5))?, hull(20)?]),
    ];
    for (name, [a, b]) in pairs {
        // A contact that there is: B came along z, somewhat turned.
        let came = Pose::new(Vec3::new(0.1, -0.05, 2.0), Quaternion { w: 0.9, x: 0.2, y: -0.3, z: 0.1 })?;
        let at_a = Pose::new(Vec3::zeros(), Quaternion { w: 0.8, x: 0.1, y: 0.2, z: 0.5 })?;
        let target = ContactTarget::of_an_approach([a, b], 0.5, at_a.placement(), came.placement());
        let target = target.ok_or("the approach ends in no single point")?;
        // And B starts from another side.
        let start = Pose::new(Vec3::new(1.2, 0.9, -0.4), Quaternion { w: 0.3, x: 0.7, y: 0.2, z: -0.4 })?;
        println!("{name}");
        for (method, method_name, samples) in METHODS {
            let attempt = Attempt { method, samples, budget: 2000, seed: 1 };
            let course = target.reach(start, &attempt).ok_or("a pair has no separation")?;
            let told = if course.reached { "reached" } else { "not reached" };
            println!(
                "  {method_name:28} {told:11} after {:3} steps and {:4} separations, {:.1e} of the size left",
                course.steps, course.queries, course.left
            );
        }
    }
    Ok(())
}
