//! Answers about rays, motions, regions and neighbours, as a client reads them.

use super::answer::{NotAnAnswer, cost, coverage, indeterminacy, pair, verdict};
use crate::geometry::Vec3;
use crate::narrow_phase::Cost;
use crate::query::{
    Answers, CastHit, CastItem, CastVerdict, Coverage, Grazed, NearestItem, OverlapItem, Overlapping, Verdict,
};
use crate::scene::{BodyId, Epoch, Revision};
use crate::transports::wire::v1;

/// Answers to moving shapes.
///
/// # Errors
/// [`NotAnAnswer`].
pub fn cast_shapes_answers(message: &v1::CastShapesResponse) -> Result<Answers<CastItem>, NotAnAnswer> {
    let items = message.items.iter().map(cast_item).collect::<Result<_, _>>()?;
    let coverage = coverage(message.coverage.as_ref())?;
    Ok(Answers { coverage, ..answers((message.epoch, message.revision, message.out_of_time), items, is_cast) })
}

/// Answers to moving pairs.
///
/// # Errors
/// [`NotAnAnswer`].
pub fn check_moving_pairs_answers(message: &v1::CheckMovingPairsResponse) -> Result<Answers<CastItem>, NotAnAnswer> {
    let items = message.items.iter().map(cast_item).collect::<Result<_, _>>()?;
    let coverage = coverage(message.coverage.as_ref())?;
    Ok(Answers { coverage, ..answers((message.epoch, message.revision, message.out_of_time), items, is_cast) })
}

/// Answers to regions.
///
/// # Errors
/// [`NotAnAnswer`].
pub fn overlap_answers(message: &v1::OverlapResponse) -> Result<Answers<OverlapItem>, NotAnAnswer> {
    let items = message.items.iter().map(overlap_item).collect::<Result<_, _>>()?;
    let is_done = |item: &OverlapItem| item.verdict != Verdict::NotRun || !item.bodies.is_empty();
    Ok(answers((message.epoch, message.revision, message.out_of_time), items, is_done))
}

/// Answers to questions for the nearest.
///
/// # Errors
/// [`NotAnAnswer`].
pub fn nearest_bodies_answers(message: &v1::NearestBodiesResponse) -> Result<Answers<NearestItem>, NotAnAnswer> {
    let item = |item: &v1::NearestItem| {
        Ok(NearestItem {
            verdict: verdict(item.verdict, item.indeterminacy)?,
            nearest: item.nearest.iter().map(pair).collect::<Result<_, _>>()?,
            set_is_proved: item.set_is_proved,
            order_is_proved: item.order_is_proved,
            problem: problem(&item.problem),
            cost: cost(item.cost)?,
        })
    };
    let items = message.items.iter().map(item).collect::<Result<_, _>>()?;
    let is_done = |item: &NearestItem| item.verdict != Verdict::NotRun;
    let coverage = coverage(message.coverage.as_ref())?;
    Ok(Answers { coverage, ..answers((message.epoch, message.revision, message.out_of_time), items, is_done) })
}

/// Answers to rays. The cost is told as a sum over all rays, which stands with the first.
///
/// # Errors
/// [`NotAnAnswer`].
pub fn cast_rays_answers(message: &v1::CastRaysResponse) -> Result<Answers<CastItem>, NotAnAnswer> {
    let count = message.verdicts.len();
    let whys = exactly("indeterminacies", &message.indeterminacies, count)?;
    let truncated = exactly("truncated", &message.truncated, count)?;
    let free_until = doubles("free_until", &message.free_until, count)?;
    let mut hits = ray_hits(message.hits.as_ref().ok_or(NotAnAnswer::missing("hits"))?)?.into_iter();
    let mut grazed = grazed_bodies(message.grazed.as_ref().ok_or(NotAnAnswer::missing("grazed"))?)?.into_iter();
    let hit_counts = words("hit_counts", &message.hit_counts, count)?;
    let grazed_counts = words("grazed_counts", &message.grazed_counts, count)?;
    let mut items = Vec::with_capacity(count);
    for i in 0..count {
        let of_ray = hits.by_ref().take(hit_counts[i] as usize).collect();
        items.push(CastItem {
            verdict: cast_verdict(message.verdicts[i].into(), whys[i].into())?,
            free_until: free_until[i],
            hits: of_ray,
            grazed: grazed.by_ref().take(grazed_counts[i] as usize).collect(),
            truncated: truncated[i] != 0,
            problem: None,
            cost: Cost::default(),
        });
    }
    for told in &message.problems {
        let item = items.get_mut(told.item as usize).ok_or(NotAnAnswer::missing("problems"))?;
        item.problem = problem(&told.problem);
    }
    if let Some(first) = items.first_mut() {
        first.cost = cost(message.cost)?;
    }
    Ok(answers((message.epoch, message.revision, message.out_of_time), items, is_cast))
}

fn answers<T>(
    (epoch, revision, out_of_time): (u64, u64, bool),
    items: Vec<T>,
    is_done: impl Fn(&T) -> bool,
) -> Answers<T> {
    // Without a limit of time every item was looked at, whatever its verdict.
    let answered = if out_of_time { items.iter().filter(|item| is_done(item)).count() } else { items.len() };
    Answers {
        epoch: Epoch(epoch),
        revision: Revision(revision),
        items,
        out_of_time,
        answered,
        coverage: Coverage::default(),
    }
}

fn is_cast(item: &CastItem) -> bool {
    item.verdict != CastVerdict::NotRun
}

fn problem(text: &str) -> Option<String> {
    (!text.is_empty()).then(|| text.to_owned())
}

fn cast_item(item: &v1::CastItem) -> Result<CastItem, NotAnAnswer> {
    let vector = |v: &Option<v1::Vec3>| v.map(|v| Vec3::new(v.x, v.y, v.z)).ok_or(NotAnAnswer::missing("hits"));
    let hit = |hit: &v1::CastHit| {
        Ok(CastHit {
            body: BodyId(hit.body),
            subshape: hit.subshape,
            own_subshape: hit.own_subshape,
            lower: hit.lower,
            upper: hit.upper,
            at_start: hit.at_start,
            point: vector(&hit.point)?,
            normal: vector(&hit.normal)?,
        })
    };
    let grazed = |one: &v1::Grazed| {
        let why = indeterminacy(one.indeterminacy)?;
        Ok(Grazed { body: BodyId(one.body), lower: one.lower, upper: one.upper, why })
    };
    Ok(CastItem {
        verdict: cast_verdict(item.verdict, item.indeterminacy)?,
        free_until: item.free_until,
        hits: item.hits.iter().map(hit).collect::<Result<_, _>>()?,
        grazed: item.grazed.iter().map(grazed).collect::<Result<_, _>>()?,
        truncated: item.truncated,
        problem: problem(&item.problem),
        cost: cost(item.cost)?,
    })
}

fn overlap_item(item: &v1::OverlapItem) -> Result<OverlapItem, NotAnAnswer> {
    let verdicts = exactly("verdicts", &item.verdicts, item.bodies.len())?;
    // Why a single body is undecided is not told: the item's reason stands for it, or rounding where a collision decides the item.
    let is_told = item.indeterminacy() != v1::Indeterminacy::Unspecified;
    let why = if is_told { item.indeterminacy } else { v1::Indeterminacy::Rounding.into() };
    let body =
        |(&body, &number): (&u64, &u8)| Ok(Overlapping { body: BodyId(body), verdict: verdict(number.into(), why)? });
    Ok(OverlapItem {
        verdict: verdict(item.verdict, item.indeterminacy)?,
        bodies: item.bodies.iter().zip(verdicts).map(body).collect::<Result<_, _>>()?,
        truncated: item.truncated,
        problem: problem(&item.problem),
        cost: cost(item.cost)?,
    })
}

fn cast_verdict(number: i32, why: i32) -> Result<CastVerdict, NotAnAnswer> {
    match v1::CastVerdict::try_from(number) {
        Ok(v1::CastVerdict::Clear) => Ok(CastVerdict::Clear),
        Ok(v1::CastVerdict::Hit) => Ok(CastVerdict::Hit),
        Ok(v1::CastVerdict::Indeterminate) => indeterminacy(why).map(CastVerdict::Indeterminate),
        Ok(v1::CastVerdict::NotRun) => Ok(CastVerdict::NotRun),
        Ok(v1::CastVerdict::InvalidInput) => Ok(CastVerdict::InvalidInput),
        Ok(v1::CastVerdict::Unspecified) | Err(_) => Err(NotAnAnswer::missing("verdict")),
    }
}

fn ray_hits(hits: &v1::RayHits) -> Result<Vec<CastHit>, NotAnAnswer> {
    let count = hits.subshapes.len() / 4;
    let bodies = ids("hits.bodies", &hits.bodies, count)?;
    let subshapes = words("hits.subshapes", &hits.subshapes, count)?;
    let (lower, upper) = (doubles("hits.lower", &hits.lower, count)?, doubles("hits.upper", &hits.upper, count)?);
    let at_start = exactly("hits.at_start", &hits.at_start, count)?;
    let points = doubles("hits.points", &hits.points, 3 * count)?;
    let normals = doubles("hits.normals", &hits.normals, 3 * count)?;
    let vector = |of: &[f64], i: usize| Vec3::new(of[3 * i], of[3 * i + 1], of[3 * i + 2]);
    let hit = |i: usize| CastHit {
        body: bodies[i],
        subshape: subshapes[i],
        own_subshape: 0,
        lower: lower[i],
        upper: upper[i],
        at_start: at_start[i] != 0,
        point: vector(&points, i),
        normal: vector(&normals, i),
    };
    Ok((0..count).map(hit).collect())
}

fn grazed_bodies(grazed: &v1::GrazedBodies) -> Result<Vec<Grazed>, NotAnAnswer> {
    let count = grazed.indeterminacies.len();
    let bodies = ids("grazed.bodies", &grazed.bodies, count)?;
    let lower = doubles("grazed.lower", &grazed.lower, count)?;
    let upper = doubles("grazed.upper", &grazed.upper, count)?;
    let one = |i: usize| {
        let why = indeterminacy(grazed.indeterminacies[i].into())?;
        Ok(Grazed { body: bodies[i], lower: lower[i], upper: upper[i], why })
    };
    (0..count).map(one).collect()
}

/// One byte an item.
fn exactly<'a>(field: &'static str, bytes: &'a [u8], count: usize) -> Result<&'a [u8], NotAnAnswer> {
    if bytes.len() == count { Ok(bytes) } else { Err(NotAnAnswer::missing(field)) }
}

fn chunks<const N: usize>(field: &'static str, bytes: &[u8], count: usize) -> Result<Vec<[u8; N]>, NotAnAnswer> {
    let (whole, rest) = bytes.as_chunks::<N>();
    if whole.len() == count && rest.is_empty() { Ok(whole.to_vec()) } else { Err(NotAnAnswer::missing(field)) }
}

fn doubles(field: &'static str, bytes: &[u8], count: usize) -> Result<Vec<f64>, NotAnAnswer> {
    Ok(chunks(field, bytes, count)?.into_iter().map(f64::from_le_bytes).collect())
}

fn words(field: &'static str, bytes: &[u8], count: usize) -> Result<Vec<u32>, NotAnAnswer> {
    Ok(chunks(field, bytes, count)?.into_iter().map(u32::from_le_bytes).collect())
}

fn ids(field: &'static str, bytes: &[u8], count: usize) -> Result<Vec<BodyId>, NotAnAnswer> {
    Ok(chunks(field, bytes, count)?.into_iter().map(u64::from_le_bytes).map(BodyId).collect())
}
