//! What does an answer look like in shared memory? Columns of the same numbers, in the same order, as the bulk form of
//! the wire; and beside them, where wanted, sides, witnesses and listed pairs.

use super::codes;
use super::layout::{ABI_HASH, MAGIC, ResponseHeader, VERSION, kind};
use super::request::{Nonce, question_number};
use super::sections::Writer;
use crate::geometry::Vec3;
use crate::narrow_phase::Cost;
use crate::query::{Answer, Answers, CastHit, CastItem, ItemAnswer, MotionAnswer, PairAnswer, Side, Wants, Witness};
use crate::service::ServiceError;
use crate::transports::wire::to_proto::ErrorCard;

/// What an answer has of its request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame {
    /// The request's.
    pub nonce: Nonce,
    /// The number of its question.
    pub question: u32,
    /// The sides of the nearest pair are wanted.
    pub wants_sides: bool,
}

/// Bits of [`ResponseHeader::flags`].
pub(super) const STOPPED: u32 = 1;
pub(super) const OUT_OF_TIME: u32 = 2;

/// Sections that an answer may have.
const ROOM: usize = 60;

/// More of a text than this is cut off, bytes: an error always fits.
const LONGEST_TEXT: usize = 4096;

/// An answer to states, motions or subjects.
#[must_use]
pub fn message(frame: &Frame, answer: &Answer, wants: Wants, motions: bool) -> Vec<u8> {
    let items = &answer.items;
    let mut writer = Writer::new(ResponseHeader::BYTES, ROOM);
    writer.bytes(kind::VERDICTS, items.iter().map(|item| codes::verdict(item.verdict).0));
    writer.bytes(kind::INDETERMINACIES, items.iter().map(|item| codes::verdict(item.verdict).1));
    // The pair that decides a verdict is not the nearest.
    if wants.closed().distance {
        brackets(&mut writer, kind::NEAREST_LOWER, items, |item| item.nearest.as_ref());
        brackets(&mut writer, kind::SELF_LOWER, items, |item| item.nearest_self.as_ref());
        brackets(&mut writer, kind::SCENE_LOWER, items, |item| item.nearest_scene.as_ref());
    }
    problems(&mut writer, items.iter().map(|item| item.problem.as_deref()));
    let left_out = &answer.coverage.declared_empty;
    if !left_out.is_empty() {
        let names: Vec<String> = left_out.iter().flat_map(|(a, b)| [a.to_string(), b.to_string()]).collect();
        writer.texts(kind::DECLARED_EMPTY, names.iter().map(String::as_str));
    }
    if answer.coverage.not_listed > 0 {
        writer.integers(kind::DECLARED_EMPTY_NOT_LISTED, [answer.coverage.not_listed as u64]);
    }
    if motions {
        motion_columns(&mut writer, items);
    }
    let nearest = || items.iter().map(|item| item.nearest.as_ref());
    if frame.wants_sides {
        sides(&mut writer, kind::NEAREST_A_KIND, nearest());
    }
    if wants.witness {
        witnesses(&mut writer, nearest().map(|pair| pair?.witness.as_ref()));
    }
    if wants.pairs {
        listed_pairs(&mut writer, items);
    }
    let stopped = answer.stopped_at.map_or(0, |_| STOPPED);
    let flags = stopped | if answer.out_of_time { OUT_OF_TIME } else { 0 };
    let header = ResponseHeader {
        items: items.len() as u32,
        flags,
        epoch: answer.epoch.0,
        revision: answer.revision.0,
        stopped_at: answer.stopped_at.unwrap_or(0) as u32,
        ..framed(frame, answer.cost)
    };
    finished(writer, header)
}

/// An answer to rays.
#[must_use]
pub fn rays_message(frame: &Frame, answers: &Answers<CastItem>) -> Vec<u8> {
    let items = &answers.items;
    let mut writer = Writer::new(ResponseHeader::BYTES, ROOM);
    writer.bytes(kind::VERDICTS, items.iter().map(|item| codes::cast_verdict(item.verdict).0));
    writer.bytes(kind::INDETERMINACIES, items.iter().map(|item| codes::cast_verdict(item.verdict).1));
    problems(&mut writer, items.iter().map(|item| item.problem.as_deref()));
    writer.bytes(kind::TRUNCATED, items.iter().map(|item| u8::from(item.truncated)));
    writer.doubles_of(kind::FREE_UNTIL, 1, items.iter().map(|item| item.free_until));
    hits(&mut writer, items);
    writer.counts(kind::GRAZED_COUNTS, items.iter().map(|item| item.grazed.len() as u32));
    let grazed = || items.iter().flat_map(|item| &item.grazed);
    writer.integers(kind::GRAZED_BODIES, grazed().map(|one| one.body.0));
    writer.doubles_of(kind::GRAZED_LOWER, 1, grazed().map(|one| one.lower));
    writer.doubles_of(kind::GRAZED_UPPER, 1, grazed().map(|one| one.upper));
    writer.bytes(kind::GRAZED_INDETERMINACIES, grazed().map(|one| codes::indeterminacy(one.why)));
    let mut cost = Cost::default();
    items.iter().for_each(|item| cost += item.cost);
    let header = ResponseHeader {
        items: items.len() as u32,
        flags: if answers.out_of_time { OUT_OF_TIME } else { 0 },
        epoch: answers.epoch.0,
        revision: answers.revision.0,
        ..framed(frame, cost)
    };
    finished(writer, header)
}

/// The response message of an rpc that was called by its name.
#[must_use]
pub fn response_message(nonce: Nonce, response: &[u8]) -> Vec<u8> {
    let mut writer = Writer::new(ResponseHeader::BYTES, 1);
    writer.bytes(kind::RESPONSE, response.iter().copied());
    finished(writer, ResponseHeader { nonce, question: question_number::CALL, ..ResponseHeader::default() })
}

/// Why a request was not answered.
#[must_use]
pub fn error_message(nonce: Nonce, error: &ServiceError) -> Vec<u8> {
    let card = ErrorCard::of(error);
    let mut writer = Writer::new(ResponseHeader::BYTES, 4);
    writer.text(kind::ERROR_REASON, card.reason_name());
    writer.text(kind::ERROR_MESSAGE, cut(&error.to_string()));
    let named = |key: &'static str| key.strip_prefix("clearance-").unwrap_or(key);
    if let Some((_, field)) = card.details.iter().find(|(key, _)| named(key) == "field") {
        writer.text(kind::ERROR_FIELD, cut(field));
    }
    let lines: String = card.details.iter().map(|(key, value)| format!("{}={value}\n", named(key))).collect();
    writer.text(kind::ERROR_DETAILS, cut(&lines));
    finished(writer, ResponseHeader { nonce, code: card.code.into(), ..ResponseHeader::default() })
}

/// The text up to the longest that fits, at a character's end.
fn cut(text: &str) -> &str {
    let end = (0..=text.len().min(LONGEST_TEXT)).rev().find(|end| text.is_char_boundary(*end)).unwrap_or(0);
    &text[..end]
}

fn framed(frame: &Frame, cost: Cost) -> ResponseHeader {
    // No batch has contact patches or derivatives.
    let Cost {
        supports,
        gjk_iterations,
        epa_iterations,
        nodes,
        pairs,
        escalations,
        patch_corners: _,
        patch_cuts: _,
        derivative_separations: _,
        derivative_supports: _,
        derivative_corners: _,
    } = cost;
    ResponseHeader {
        nonce: frame.nonce,
        question: frame.question,
        supports,
        gjk_iterations,
        epa_iterations,
        nodes,
        pairs,
        escalations,
        ..ResponseHeader::default()
    }
}

fn finished(writer: Writer, header: ResponseHeader) -> Vec<u8> {
    writer.finish(|sections, total_bytes, bytes| {
        let known = ResponseHeader { magic: MAGIC, abi_hash: ABI_HASH, version: VERSION, ..header };
        ResponseHeader { sections, total_bytes, ..known }.write(bytes);
    })
}

/// Three columns from `first` on; none when no item has that pair.
fn brackets(
    writer: &mut Writer,
    first: u32,
    items: &[ItemAnswer],
    pair_of: impl Fn(&ItemAnswer) -> Option<&PairAnswer>,
) {
    if items.iter().all(|item| pair_of(item).is_none()) {
        return;
    }
    let numbers: [fn(&PairAnswer) -> f64; 3] =
        [|pair| pair.bracket.lower, |pair| pair.bracket.upper, |pair| pair.signed_distance];
    for (column, number) in (first..).zip(numbers) {
        writer.doubles_of(column, 1, items.iter().map(|item| pair_of(item).map_or(f64::NAN, number)));
    }
}

fn problems<'a>(writer: &mut Writer, problems: impl Iterator<Item = Option<&'a str>>) {
    let found: Vec<(u32, &str)> = (0..).zip(problems).filter_map(|(item, problem)| Some((item, problem?))).collect();
    if !found.is_empty() {
        writer.counts(kind::PROBLEM_ITEMS, found.iter().map(|(item, _)| *item));
        writer.texts(kind::PROBLEM_TEXTS, found.iter().map(|(_, text)| *text));
    }
}

fn motion_columns(writer: &mut Writer, items: &[ItemAnswer]) {
    let numbers: [fn(&MotionAnswer) -> Option<f64>; 6] = [
        |motion| Some(motion.free_until),
        |motion| motion.reached.map(|[from, _]| from),
        |motion| motion.reached.map(|[_, to]| to),
        |motion| motion.undecided.map(|[from, _]| from),
        |motion| motion.undecided.map(|[_, to]| to),
        |motion| Some(motion.states as f64),
    ];
    for (column, number) in (kind::FREE_UNTIL..).zip(numbers) {
        let rows = items.iter().map(|item| item.motion.as_ref().and_then(number).unwrap_or(f64::NAN));
        writer.doubles_of(column, 1, rows);
    }
}

/// Eleven columns from `first` on: both sides, the verdict, why it is none, how the work stopped.
fn sides<'a>(writer: &mut Writer, first: u32, pairs: impl Iterator<Item = Option<&'a PairAnswer>> + Clone) {
    let sides_of: [fn(&PairAnswer) -> &Side; 2] = [|pair| &pair.a, |pair| &pair.b];
    for (column, side_of) in (first..).step_by(4).zip(sides_of) {
        let sides = || pairs.clone().map(|pair| pair.map_or((0, 0, 0, 0), |pair| side(side_of(pair))));
        writer.bytes(column, sides().map(|(kind, ..)| kind));
        writer.integers(column + 1, sides().map(|(_, id, ..)| id));
        writer.counts(column + 2, sides().map(|(_, _, shape, _)| shape));
        writer.counts(column + 3, sides().map(|(.., subshape)| subshape));
    }
    let verdicts = || pairs.clone().map(|pair| pair.map_or((0, 0), |pair| codes::verdict(pair.verdict)));
    writer.bytes(first + 8, verdicts().map(|(verdict, _)| verdict));
    writer.bytes(first + 9, verdicts().map(|(_, why)| why));
    writer.bytes(first + 10, pairs.map(|pair| pair.map_or(0, |pair| codes::termination(pair.termination))));
}

/// Kind, id, shape and subshape of a side.
fn side(side: &Side) -> (u8, u64, u32, u32) {
    match *side {
        Side::Link { link, shape, subshape } => (1, link.into(), shape, subshape),
        Side::Query { subshape } => (2, 0, 0, subshape),
        Side::Body { id, subshape } => (3, id.0, 0, subshape),
    }
}

fn witnesses<'a>(writer: &mut Writer, witnesses: impl Iterator<Item = Option<&'a Witness>> + Clone) {
    let vectors: [fn(&Witness) -> Vec3; 3] = [|w| w.point_on_a, |w| w.point_on_b, |w| w.normal];
    for (column, vector) in (kind::NEAREST_POINT_ON_A..).zip(vectors) {
        let rows = witnesses.clone().map(|witness| witness.map_or([f64::NAN; 3], |witness| vector(witness).into()));
        writer.doubles_of(column, 3, rows.flatten());
    }
    let numbers: [fn(&Witness) -> f64; 2] = [|w| w.point_error, |w| w.normal_error];
    for (column, number) in (kind::NEAREST_POINT_ERROR..).zip(numbers) {
        writer.doubles_of(column, 1, witnesses.clone().map(|witness| witness.map_or(f64::NAN, number)));
    }
}

fn listed_pairs(writer: &mut Writer, items: &[ItemAnswer]) {
    let pairs = || items.iter().flat_map(|item| &item.pairs);
    writer.bytes(kind::TRUNCATED, items.iter().map(|item| u8::from(item.truncated)));
    writer.counts(kind::PAIR_COUNTS, items.iter().map(|item| item.pairs.len() as u32));
    sides(writer, kind::PAIR_A_KIND, pairs().map(Some));
    writer.doubles_of(kind::PAIR_LOWER, 1, pairs().map(|pair| pair.bracket.lower));
    writer.doubles_of(kind::PAIR_UPPER, 1, pairs().map(|pair| pair.bracket.upper));
    writer.doubles_of(kind::PAIR_SIGNED_DISTANCE, 1, pairs().map(|pair| pair.signed_distance));
}

fn hits(writer: &mut Writer, items: &[CastItem]) {
    let hits = || items.iter().flat_map(|item| &item.hits);
    let vectors = |vector: fn(&CastHit) -> Vec3| hits().flat_map(move |hit| <[f64; 3]>::from(vector(hit)));
    writer.counts(kind::HIT_COUNTS, items.iter().map(|item| item.hits.len() as u32));
    writer.integers(kind::HIT_BODIES, hits().map(|hit| hit.body.0));
    writer.counts(kind::HIT_SUBSHAPES, hits().map(|hit| hit.subshape));
    writer.doubles_of(kind::HIT_LOWER, 1, hits().map(|hit| hit.lower));
    writer.doubles_of(kind::HIT_UPPER, 1, hits().map(|hit| hit.upper));
    writer.bytes(kind::HIT_AT_START, hits().map(|hit| u8::from(hit.at_start)));
    writer.doubles_of(kind::HIT_POINTS, 3, vectors(|hit| hit.point));
    writer.doubles_of(kind::HIT_NORMALS, 3, vectors(|hit| hit.normal));
}
