//! What a person sees of an answer: one line of a table.

use std::collections::BTreeMap;

use super::super::state_line::Names;
use super::super::words;
use crate::query::{ItemAnswer, PairAnswer, Side};
use crate::scene::BodyId;

/// Heads the columns of [`row`].
pub const HEADINGS: &str = "  state      verdict          clearance      bracket width  deciding pair                                        cost";

/// Names for both sides of pairs.
pub struct Cast {
    /// Links of the robot, by index.
    pub links: Vec<String>,
    /// Bodies of the scene.
    pub bodies: BTreeMap<BodyId, String>,
}

impl Cast {
    /// `forearm_link_0 - shelf_top`.
    pub fn pair(&self, pair: &PairAnswer) -> String {
        format!("{} - {}", self.side(&pair.a), self.side(&pair.b))
    }

    pub fn side(&self, side: &Side) -> String {
        Names { links: &self.links, bodies: &self.bodies }.of(side)
    }
}

/// One state of a table.
pub fn row(name: &str, item: &ItemAnswer, cast: &Cast) -> String {
    let verdict = words::verdict(item.verdict);
    let cost = format!("{} pairs, {} supports", item.cost.pairs, item.cost.supports);
    match &item.nearest {
        Some(pair) => format!(
            "  {name:<10} {verdict:<13} {:>10.3} mm {:>15.0e} m  {:<52} {cost}",
            pair.signed_distance * 1e3,
            pair.bracket.width(),
            cast.pair(pair),
        ),
        None => format!("  {name:<10} {verdict:<13} {:>31}  {:<52} {cost}", "-", "-"),
    }
}
