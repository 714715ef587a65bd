//! What must be true of an answer, given the truth about the pair.

use clearance::geometry::Vec3;
use clearance::narrow_phase::{Goal, Separation, Termination};

use crate::oracle::double_double::Dd;
use crate::oracle::{Truth, truth};
use crate::specimen::{Form, Specimen};

/// Roundings of one result of a few operations, relative.
const FEW_ROUNDINGS: f64 = 8.0 * f64::EPSILON;

/// How far a normal's length may be from 1. It goes through two rotation matrices at most, each within 37 roundings of one.
const NORMAL_LENGTH: f64 = 40.0 * f64::EPSILON;

/// What is wrong with `found`, in words; nothing, one hopes. No slack beyond the truth's own gap.
pub fn faults(found: &Separation, goal: &Goal, truth: &Truth) -> Vec<String> {
    let mut faults = Vec::new();
    let mut must = |holds: bool, what: &str| {
        if !holds {
            faults.push(what.to_owned());
        }
    };
    let (lower, upper) = (found.bracket.lower, found.bracket.upper);
    // Comparisons that NaN fails.
    must(Dd::from(lower) <= truth.upper, "lower is above the truth");
    must(truth.lower <= Dd::from(upper), "upper is below the truth");
    must(lower <= found.signed_distance && found.signed_distance <= upper, "the estimate is outside of the bracket");
    must(upper > 0.0 || truth.lower <= Dd::ZERO, "a collision of shapes that are apart");
    must(lower <= 0.0 || truth.upper > Dd::ZERO, "free, of shapes that meet");
    let margin = Dd::from(goal.margin);
    must(!(lower > goal.margin && truth.upper <= margin), "beyond the margin, of shapes within it");
    must((found.normal.norm() - 1.0).abs() <= NORMAL_LENGTH, "the normal is no unit vector");
    let apart = found.point_on_b - found.point_on_a - found.normal * found.signed_distance;
    let size = found.point_on_a.amax() + found.point_on_b.amax() + found.signed_distance.abs();
    must(apart.amax() <= FEW_ROUNDINGS * size, "the witness points are not the signed distance along the normal apart");
    faults
}

/// How far a witness point may be from its shape, and whether both are within that. Only for brackets that closed.
///
/// Apart: the points are u = |x| apart on the cores, a separating plane proves l, so the true nearest point of the
/// difference is within sqrt(u^2 - l^2) of x. In an overlap a point of a face nearest the origin is on the boundary to the
/// bracket's width, and beside the true one by what a shape of that extent bends within the width.
pub fn witness_faults(a: &Specimen, b: &Specimen, found: &Separation, truth: &Truth) -> Vec<String> {
    match found.termination {
        Termination::Converged | Termination::RoundingFloor | Termination::ClosedForm => {}
        Termination::Decided | Termination::IterationLimit | Termination::TimeLimit => return Vec::new(),
    }
    let radii = (a.body.swept_radius + b.body.swept_radius).hi;
    let (lower, upper) = (found.bracket.lower + radii, found.bracket.upper + radii);
    let width = found.bracket.width();
    let beside = if lower > 0.0 { (width * (lower + upper)).sqrt() } else { (2.0 * width * truth.size).sqrt() };
    let places = found.point_on_a.amax() + found.point_on_b.amax();
    let allowed = width + beside + FEW_ROUNDINGS * (places + truth.size);
    let mut faults = Vec::new();
    for (name, specimen, point) in [("A", a, found.point_on_a), ("B", b, found.point_on_b)] {
        let off = distance_outside(specimen, point, truth.size);
        if !(off <= allowed) {
            faults.push(format!("the witness on {name} is {off:e} m off its shape, {allowed:e} allowed"));
        }
    }
    faults
}

/// How far the point is outside of the shape; zero inside. Metres.
fn distance_outside(specimen: &Specimen, point: Vec3, size: f64) -> f64 {
    let place = [point.x, point.y, point.z];
    let Some(point) = Form::point().and_then(|form| form.placed(place, [1.0, 0.0, 0.0, 0.0])) else { return f64::NAN };
    truth(&specimen.body, &point.body, 1e-18 * size, 60).lower.hi.max(0.0)
}
