//! The derivatives of a pair, from what its answer says: about whose origin, by which samples, and what they are to a robot's joints.

use super::answer::{PairAnswer, PairDerivatives, Side};
use super::request::Context;
use super::stage::{OnStage, Stage, Standing};
use crate::geometry::Vec3;
use crate::narrow_phase::{Cost, Depth, DerivativeGoal, Derivatives, Goal, Separation, TwistMatrix, derivatives};
use crate::robot::LinkGradient;

pub(super) fn of_pair(
    pair: &PairAnswer,
    stage: &Stage,
    context: &Context,
    stop: &dyn Fn() -> bool,
    cost: &mut Cost,
) -> Option<Box<PairDerivatives>> {
    let witness = pair.witness?;
    let sides = [stage.side(&pair.a)?, stage.side(&pair.b)?];
    let found = Separation {
        bracket: pair.bracket,
        signed_distance: pair.signed_distance,
        normal: witness.normal,
        point_on_a: witness.point_on_a,
        point_on_b: witness.point_on_b,
        point_error: witness.point_error,
        normal_error: witness.normal_error,
        termination: pair.termination,
        subshape_a: subshape(&pair.a),
        subshape_b: subshape(&pair.b),
        cost: Cost::default(),
    };
    let goal = DerivativeGoal { stream: stream(stage.item, [&pair.a, &pair.b]), ..context.derivatives };
    let again = Goal {
        depth: Depth::Penetration,
        accuracy: context.accuracy,
        solver: context.solver,
        margin: 0.0,
        cut_off: f64::INFINITY,
        stop,
    };
    let [a, b] = &sides;
    let mut twists = derivatives(a.shape, b.shape, &a.at, &b.at, &found, &goal, &again).ok()?;
    cost.derivative_separations += twists.cost.separations;
    cost.derivative_supports += twists.cost.supports;
    cost.derivative_corners += twists.cost.corners;
    let joints = match &stage.robot {
        Some(standing) => of_robot(&mut twists, &sides, standing),
        None => Vec::new(),
    };
    Some(Box::new(PairDerivatives { twists, joints }))
}

/// Twists of links are about the links' origins, and have a gradient with respect to the joints.
fn of_robot(twists: &mut Derivatives, sides: &[OnStage; 2], standing: &Standing) -> Vec<f64> {
    let poses = &standing.placed.poses;
    let mut gradients = [None, None];
    for (body, side) in sides.iter().enumerate() {
        let Some(link) = side.link else { continue };
        about(twists, body, side.at.translation - poses[link as usize].translation());
        gradients[body] = Some(LinkGradient { link, twist: twists.signed_distance[body] });
    }
    let gradient = |one, other| standing.parts.model.joint_gradient(standing.positions, poses, one, other);
    match &gradients {
        [Some(one), other] => gradient(one, other.as_ref()),
        [None, Some(one)] => gradient(one, None),
        [None, None] => Vec::new(),
    }
}

/// Makes the block of a body, which is about the origin o of its shape, one about the origin from which o is at `arm`: a twist (v, w) about
/// that is the twist (v + w x arm, w) about o. So columns of v stay as they are, and with J_v for these and w along axis i the
/// column is that of w and J_v (e_i x arm): the adjoint of the translation.
fn about(twists: &mut Derivatives, body: usize, arm: Vec3) {
    let row = &mut twists.signed_distance[body];
    let along = Vec3::new(row[0], row[1], row[2]);
    for i in 0..3 {
        let carried = Vec3::ith(i, 1.0).cross(&arm);
        row[3 + i] += along.dot(&carried);
        for block in [&mut twists.normal, &mut twists.point_on_a, &mut twists.point_on_b] {
            let block: &mut TwistMatrix = &mut block[body];
            let column = block.column(3 + i) + block.fixed_columns::<3>(0) * carried;
            block.set_column(3 + i, &column);
        }
    }
}

fn subshape(side: &Side) -> u32 {
    match side {
        Side::Link { subshape, .. } | Side::Query { subshape } | Side::Body { subshape, .. } => *subshape,
    }
}

/// The number of a pair of an item: by its sides alone, so that it does not hang on how the pair was come to.
fn stream(item: usize, sides: [&Side; 2]) -> u64 {
    let words = |side: &Side| match *side {
        Side::Query { subshape } => [0, 0, 0, u64::from(subshape)],
        Side::Body { id, subshape } => [1, id.0, 0, u64::from(subshape)],
        Side::Link { link, shape, subshape } => [2, u64::from(link), u64::from(shape), u64::from(subshape)],
    };
    let words = sides.into_iter().flat_map(words);
    words.fold(mixed(item as u64), |stream, word| mixed(stream ^ word))
}

/// A step of the generator SplitMix64: each number has one it comes from.
fn mixed(number: u64) -> u64 {
    let mut z = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::BodyId;
    use std::collections::BTreeSet;

    #[test]
    fn each_pair_of_each_item_has_a_stream_of_its_own() {
        let sides: Vec<Side> = (0..4)
            .flat_map(|i| {
                let (link, shape, id) = (i, i / 2, BodyId(u64::from(i)));
                let of = move |subshape| {
                    [
                        Side::Link { link, shape, subshape },
                        Side::Body { id, subshape },
                        Side::Query { subshape: subshape + 2 * i },
                    ]
                };
                (0..2).flat_map(of)
            })
            .collect();
        let mut met = BTreeSet::new();
        for item in 0..5 {
            for a in &sides {
                sides.iter().for_each(|b| assert!(met.insert(stream(item, [a, b])), "{item} {a:?} {b:?}"));
            }
        }
        assert_eq!(met.len(), 5 * 24 * 24);
    }
}
