//! One line of the output of `clearance states`.

use std::collections::BTreeMap;

use serde::Serialize;
use serde_json::Value;

use super::words;
use crate::narrow_phase;
use crate::query::{Coverage, ItemAnswer, PairAnswer, Side, Verdict};
use crate::scene::{BodyId, BodyRef, Party, Revision};

/// An answer, or what is wrong with a line of the input. Metres; null where there is no such pair.
#[derive(Clone, Debug, Serialize)]
pub struct AnswerLine {
    id: Value,
    verdict: &'static str,
    signed_distance: Option<f64>,
    lower: Option<f64>,
    upper: Option<f64>,
    pair: Option<[String; 2]>,
    self_distance: Option<f64>,
    self_pair: Option<[String; 2]>,
    env_distance: Option<f64>,
    env_pair: Option<[String; 2]>,
    revision: Option<u64>,
    cost: Option<Cost>,
    /// Parties whose pairs the scene declares empty.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    declared_empty: Vec<[String; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    message: Option<String>,
}

/// Counters; no times, so that the same work is the same line.
#[derive(Clone, Copy, Debug, Serialize)]
struct Cost {
    supports: u64,
    gjk_iterations: u64,
    epa_iterations: u64,
    nodes: u64,
    pairs: u64,
    escalations: u64,
}

/// What the sides of a pair are called.
#[derive(Clone, Copy, Debug)]
pub struct Names<'a> {
    /// Links of the robot, by index.
    pub links: &'a [String],
    /// Bodies of the scene.
    pub bodies: &'a BTreeMap<BodyId, String>,
}

impl AnswerLine {
    /// The answer to a state.
    #[must_use]
    pub fn of_answer(id: &Value, item: &ItemAnswer, revision: Revision, names: Names) -> Self {
        // States on the command line have no patches.
        let narrow_phase::Cost { supports, gjk_iterations, epa_iterations, nodes, pairs, escalations, .. } = item.cost;
        let distance = |pair: &Option<PairAnswer>| pair.as_ref().map(|pair| pair.signed_distance);
        let named = |pair: &Option<PairAnswer>| pair.as_ref().map(|pair| [names.of(&pair.a), names.of(&pair.b)]);
        Self {
            id: id.clone(),
            verdict: words::verdict(item.verdict),
            signed_distance: distance(&item.nearest),
            lower: item.nearest.as_ref().map(|pair| pair.bracket.lower),
            upper: item.nearest.as_ref().map(|pair| pair.bracket.upper),
            pair: named(&item.nearest),
            self_distance: distance(&item.nearest_self),
            self_pair: named(&item.nearest_self),
            env_distance: distance(&item.nearest_scene),
            env_pair: named(&item.nearest_scene),
            revision: Some(revision.0),
            cost: Some(Cost { supports, gjk_iterations, epa_iterations, nodes, pairs, escalations }),
            declared_empty: Vec::new(),
            message: item.problem.clone(),
        }
    }

    /// The same with what it says nothing about.
    #[must_use]
    pub fn leaving_out(self, coverage: &Coverage, names: Names) -> Self {
        let pairs = coverage.declared_empty.iter();
        Self { declared_empty: pairs.map(|(a, b)| [names.of_party(a), names.of_party(b)]).collect(), ..self }
    }

    /// A line that nobody could be asked about.
    #[must_use]
    pub fn of_bad_line(id: &Value, message: &str) -> Self {
        Self {
            id: id.clone(),
            verdict: words::verdict(Verdict::InvalidInput),
            signed_distance: None,
            lower: None,
            upper: None,
            pair: None,
            self_distance: None,
            self_pair: None,
            env_distance: None,
            env_pair: None,
            revision: None,
            cost: None,
            declared_empty: Vec::new(),
            message: Some(message.to_owned()),
        }
    }
}

impl Names<'_> {
    /// The name of a side.
    #[must_use]
    pub fn of(&self, side: &Side) -> String {
        match side {
            Side::Link { link, .. } => self.links[*link as usize].clone(),
            Side::Body { id, .. } => self.bodies.get(id).cloned().unwrap_or_else(|| format!("body {id}")),
            Side::Query { .. } => "query".to_owned(),
        }
    }
    /// What a party is called, as a scene file calls it.
    fn of_party(&self, party: &Party) -> String {
        match party {
            Party::Body(BodyRef::Id(id)) => self.bodies.get(id).cloned().unwrap_or_else(|| format!("body {id}")),
            Party::Body(BodyRef::Name(name)) | Party::Group(name) => name.clone(),
            Party::Link { link, .. } => link.clone(),
            Party::Robot(_) => "robot".to_owned(),
            Party::Everything => "everything".to_owned(),
        }
    }
}
