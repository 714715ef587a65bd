//! What must be true of an answer, given the truth about the pair.

use clearance::geometry::Vec3;
use clearance::narrow_phase::{Goal, Separation};

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

/// Whether the witness points and the normal are within the errors that the answer states: the points of their shapes, and,
/// of shapes apart, the vector and its direction of the true ones. No slack beyond what the truth leaves open and
/// the rounding of this comparison.
pub fn witness_faults(a: &Specimen, b: &Specimen, found: &Separation, truth: &Truth) -> Vec<String> {
    let mut faults = Vec::new();
    for (name, specimen, point) in [("A", a, found.point_on_a), ("B", b, found.point_on_b)] {
        let off = distance_outside(specimen, point, truth.size);
        if !(off <= found.point_error) {
            faults.push(format!("the witness on {name} is {off:e} m off its shape, {:e} stated", found.point_error));
        }
    }
    if truth.lower > Dd::ZERO {
        // Any direction that proves l of a distance u is turned from the true one by an angle of cosine l / u at least.
        let open = (2.0 * truth.width() / truth.upper.hi).sqrt() + FEW_ROUNDINGS;
        let normal = Vec3::from(truth.normal);
        let chord = (found.normal - normal).norm();
        if !(chord <= found.normal_error + open) {
            faults.push(format!("the normal is turned by {chord:e}, {:e} stated", found.normal_error));
        }
        let off = (found.point_on_b - found.point_on_a - normal * truth.value()).norm();
        // The difference of the stored points rounds with where they are.
        let places = found.point_on_a.amax() + found.point_on_b.amax();
        let rounding = truth.value() * open + truth.width() + f64::EPSILON * places;
        if !(off <= found.point_error + rounding) {
            faults.push(format!("the vector between the witnesses is {off:e} m off, {:e} stated", found.point_error));
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
