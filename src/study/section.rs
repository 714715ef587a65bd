//! One experiment of the report: what was asked, what came out, in words, drawings and numbers.

use super::table::Table;

/// An experiment, ready for the page.
#[derive(Clone, Debug)]
pub struct Section {
    /// Heading.
    pub title: &'static str,
    /// What was done, in a sentence or two.
    pub what: String,
    /// What to read from it: sentences worked out from the figures.
    pub readings: Vec<String>,
    /// What a planner's engineer should do about it, in a sentence, for the head of the page.
    pub advice: Option<String>,
    /// Drawings, in groups.
    pub figures: Vec<Figure>,
    /// A short table for the page, if there is one: names of columns, and rows.
    pub summary: Option<(Vec<String>, Vec<Vec<String>>)>,
    /// All numbers.
    pub table: Table,
}

/// Drawings whose marks mean the same.
#[derive(Clone, Debug)]
pub struct Figure {
    /// What is drawn.
    pub caption: String,
    /// What the marks mean: name, and number of the mark.
    pub legend: Vec<(String, usize)>,
    /// SVG, each in a place of its own.
    pub drawings: Vec<String>,
}
