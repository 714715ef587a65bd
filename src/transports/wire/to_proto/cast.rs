//! Answers about rays, motions, regions and neighbours.

use super::answer::{cost, indeterminacy, pair, verdict};
use super::count;
use super::declared::coverage;
use super::geometry::vec3;
use crate::geometry::Vec3;
use crate::narrow_phase::Cost;
use crate::query::{Answers, CastHit, CastItem, CastVerdict, Grazed, NearestItem, OverlapItem};
use crate::transports::wire::v1;

/// Answers to rays, as arrays.
#[must_use]
pub fn cast_rays_response(answers: &Answers<CastItem>) -> v1::CastRaysResponse {
    let items = &answers.items;
    let numbers =
        |of: &dyn Fn(&CastItem) -> f64| items.iter().flat_map(|item| of(item).to_le_bytes()).collect::<Vec<u8>>();
    let counts = |of: &dyn Fn(&CastItem) -> usize| -> Vec<u8> {
        items.iter().flat_map(|item| count(of(item)).to_le_bytes()).collect()
    };
    // Verdicts and reasons are small enumerations; their numbers fit a byte.
    let (verdicts, whys): (Vec<u8>, Vec<u8>) =
        items.iter().map(|item| cast_verdict(item.verdict)).map(|(verdict, why)| (verdict as u8, why as u8)).unzip();
    let problem = |(index, item): (usize, &CastItem)| {
        item.problem.clone().map(|problem| v1::BulkProblem { item: count(index), problem })
    };
    let mut whole = Cost::default();
    items.iter().for_each(|item| whole += item.cost);
    v1::CastRaysResponse {
        epoch: answers.epoch.0,
        revision: answers.revision.0,
        out_of_time: answers.out_of_time,
        verdicts: verdicts.into(),
        indeterminacies: whys.into(),
        free_until: numbers(&|item| item.free_until).into(),
        truncated: items.iter().map(|item| u8::from(item.truncated)).collect::<Vec<u8>>().into(),
        hit_counts: counts(&|item| item.hits.len()).into(),
        hits: Some(ray_hits(items.iter().flat_map(|item| &item.hits))),
        grazed_counts: counts(&|item| item.grazed.len()).into(),
        grazed: Some(grazed_bodies(items.iter().flat_map(|item| &item.grazed))),
        problems: items.iter().enumerate().filter_map(problem).collect(),
        cost: Some(cost(whole)),
    }
}

fn ray_hits<'a>(hits: impl Iterator<Item = &'a CastHit> + Clone) -> v1::RayHits {
    let numbers = |of: fn(&CastHit) -> f64| hits.clone().flat_map(|hit| of(hit).to_le_bytes()).collect::<Vec<u8>>();
    let vectors = |of: fn(&CastHit) -> Vec3| -> Vec<u8> {
        hits.clone().flat_map(|hit| <[f64; 3]>::from(of(hit))).flat_map(f64::to_le_bytes).collect()
    };
    v1::RayHits {
        bodies: hits.clone().flat_map(|hit| hit.body.0.to_le_bytes()).collect::<Vec<u8>>().into(),
        subshapes: hits.clone().flat_map(|hit| hit.subshape.to_le_bytes()).collect::<Vec<u8>>().into(),
        lower: numbers(|hit| hit.lower).into(),
        upper: numbers(|hit| hit.upper).into(),
        at_start: hits.clone().map(|hit| u8::from(hit.at_start)).collect::<Vec<u8>>().into(),
        points: vectors(|hit| hit.point).into(),
        normals: vectors(|hit| hit.normal).into(),
    }
}

fn grazed_bodies<'a>(bodies: impl Iterator<Item = &'a Grazed> + Clone) -> v1::GrazedBodies {
    let numbers = |of: fn(&Grazed) -> f64| bodies.clone().flat_map(|one| of(one).to_le_bytes()).collect::<Vec<u8>>();
    v1::GrazedBodies {
        bodies: bodies.clone().flat_map(|one| one.body.0.to_le_bytes()).collect::<Vec<u8>>().into(),
        lower: numbers(|one| one.lower).into(),
        upper: numbers(|one| one.upper).into(),
        indeterminacies: bodies.clone().map(|one| indeterminacy(one.why) as u8).collect::<Vec<u8>>().into(),
    }
}

/// Answers to moving shapes.
#[must_use]
pub fn cast_shapes_response(answers: &Answers<CastItem>) -> v1::CastShapesResponse {
    v1::CastShapesResponse {
        epoch: answers.epoch.0,
        revision: answers.revision.0,
        out_of_time: answers.out_of_time,
        items: answers.items.iter().map(cast_item).collect(),
        coverage: coverage(&answers.coverage),
    }
}

/// Answers to moving pairs.
#[must_use]
pub fn check_moving_pairs_response(answers: &Answers<CastItem>) -> v1::CheckMovingPairsResponse {
    v1::CheckMovingPairsResponse {
        epoch: answers.epoch.0,
        revision: answers.revision.0,
        out_of_time: answers.out_of_time,
        items: answers.items.iter().map(cast_item).collect(),
        coverage: coverage(&answers.coverage),
    }
}

/// Answers to regions.
#[must_use]
pub fn overlap_response(answers: &Answers<OverlapItem>) -> v1::OverlapResponse {
    let item = |item: &OverlapItem| {
        let (verdict_of_all, why) = verdict(item.verdict);
        v1::OverlapItem {
            verdict: verdict_of_all.into(),
            indeterminacy: why.into(),
            bodies: item.bodies.iter().map(|one| one.body.0).collect(),
            verdicts: item.bodies.iter().map(|one| verdict(one.verdict).0 as u8).collect::<Vec<u8>>().into(),
            truncated: item.truncated,
            problem: item.problem.clone().unwrap_or_default(),
            cost: Some(cost(item.cost)),
        }
    };
    v1::OverlapResponse {
        epoch: answers.epoch.0,
        revision: answers.revision.0,
        out_of_time: answers.out_of_time,
        items: answers.items.iter().map(item).collect(),
    }
}

/// Answers to questions for the nearest.
#[must_use]
pub fn nearest_bodies_response(answers: &Answers<NearestItem>) -> v1::NearestBodiesResponse {
    let item = |item: &NearestItem| {
        let (verdict, why) = verdict(item.verdict);
        v1::NearestItem {
            verdict: verdict.into(),
            indeterminacy: why.into(),
            nearest: item.nearest.iter().map(pair).collect(),
            set_is_proved: item.set_is_proved,
            order_is_proved: item.order_is_proved,
            problem: item.problem.clone().unwrap_or_default(),
            cost: Some(cost(item.cost)),
        }
    };
    v1::NearestBodiesResponse {
        epoch: answers.epoch.0,
        revision: answers.revision.0,
        out_of_time: answers.out_of_time,
        items: answers.items.iter().map(item).collect(),
        coverage: coverage(&answers.coverage),
    }
}

fn cast_item(item: &CastItem) -> v1::CastItem {
    let (verdict, why) = cast_verdict(item.verdict);
    let hit = |hit: &CastHit| v1::CastHit {
        body: hit.body.0,
        subshape: hit.subshape,
        own_subshape: hit.own_subshape,
        lower: hit.lower,
        upper: hit.upper,
        at_start: hit.at_start,
        point: Some(vec3(hit.point)),
        normal: Some(vec3(hit.normal)),
    };
    let grazed = |one: &Grazed| v1::Grazed {
        body: one.body.0,
        lower: one.lower,
        upper: one.upper,
        indeterminacy: indeterminacy(one.why).into(),
    };
    v1::CastItem {
        verdict: verdict.into(),
        indeterminacy: why.into(),
        free_until: item.free_until,
        hits: item.hits.iter().map(hit).collect(),
        grazed: item.grazed.iter().map(grazed).collect(),
        truncated: item.truncated,
        problem: item.problem.clone().unwrap_or_default(),
        cost: Some(cost(item.cost)),
    }
}

/// A verdict and, if it is none, why.
fn cast_verdict(verdict: CastVerdict) -> (v1::CastVerdict, v1::Indeterminacy) {
    let decided = |verdict| (verdict, v1::Indeterminacy::Unspecified);
    match verdict {
        CastVerdict::Clear => decided(v1::CastVerdict::Clear),
        CastVerdict::Hit => decided(v1::CastVerdict::Hit),
        CastVerdict::Indeterminate(why) => (v1::CastVerdict::Indeterminate, indeterminacy(why)),
        CastVerdict::NotRun => decided(v1::CastVerdict::NotRun),
        CastVerdict::InvalidInput => decided(v1::CastVerdict::InvalidInput),
    }
}
