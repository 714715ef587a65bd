//! Derivatives: how they are to be made, and what they are.

use crate::narrow_phase::{DerivativeGoal, DerivativeMethod, Derivatives, TwistMatrix};
use crate::query::PairDerivatives;
use crate::transports::wire::v1;

pub(super) fn derivative_options(goal: &DerivativeGoal) -> v1::DerivativeOptions {
    // Each pair gets a stream of its own where it is asked.
    let DerivativeGoal { method: made, epsilon, samples, seed, stream: _ } = *goal;
    v1::DerivativeOptions {
        method: method(made).into(),
        epsilon: Some(epsilon),
        samples: Some(samples),
        seed: Some(seed),
    }
}

/// How a pair changes when its bodies move.
#[must_use]
pub fn pair_derivatives(derivatives: &PairDerivatives) -> v1::PairDerivatives {
    let PairDerivatives { twists, joints } = derivatives;
    v1::PairDerivatives {
        of_a: Some(side(twists, 0)),
        of_b: Some(side(twists, 1)),
        joints: joints.clone(),
        method: method(twists.method).into(),
        conditioning: twists.conditioning,
        residual: twists.residual,
        epsilon: twists.epsilon,
        samples: twists.samples,
        seed: twists.seed,
        is_valid: twists.is_valid,
        on_border: twists.on_border,
        is_contested: twists.is_contested,
    }
}

fn side(twists: &Derivatives, side: usize) -> v1::TwistDerivatives {
    // Matrices are kept column by column.
    let rows = |matrix: &TwistMatrix| matrix.transpose().as_slice().to_vec();
    v1::TwistDerivatives {
        signed_distance: twists.signed_distance[side].to_vec(),
        normal: rows(&twists.normal[side]),
        point_on_a: rows(&twists.point_on_a[side]),
        point_on_b: rows(&twists.point_on_b[side]),
    }
}

fn method(method: DerivativeMethod) -> v1::DerivativeMethod {
    match method {
        DerivativeMethod::Exact => v1::DerivativeMethod::Exact,
        DerivativeMethod::ExactCell => v1::DerivativeMethod::ExactCell,
        DerivativeMethod::FiniteDifference => v1::DerivativeMethod::FiniteDifference,
        DerivativeMethod::Smoothed0 => v1::DerivativeMethod::Smoothed0,
        DerivativeMethod::Smoothed1Gaussian => v1::DerivativeMethod::Smoothed1Gaussian,
        DerivativeMethod::Smoothed1Gumbel => v1::DerivativeMethod::Smoothed1Gumbel,
    }
}
