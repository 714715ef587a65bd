//! A drawing of one number for each of several named things: a mark at the median, a line to the 99th percentile.

use std::fmt::Write as _;

use super::markup::escaped;
use super::plot::{form, opening};
use super::scale::{Axis, Scale};

/// One named thing.
#[derive(Clone, Debug)]
pub(super) struct Rung {
    pub name: String,
    /// Number of the mark, value, and how far its tail reaches.
    pub values: Vec<(usize, f64, f64)>,
}

const WIDTH: f64 = 520.0;
const SIDE: f64 = 22.0;
const TOP: f64 = 30.0;
const STEP: f64 = 38.0;
const BOTTOM: f64 = 44.0;

/// Draws them from the top down, the name of each above its line.
pub(super) fn rungs(title: &str, axis: &Axis, rungs: &[Rung]) -> String {
    let values = rungs.iter().flat_map(|rung| rung.values.iter().flat_map(|(_, value, tail)| [*value, *tail]));
    let scale = Scale::around(axis, values);
    let bottom = TOP + STEP * rungs.len() as f64;
    let at = |value: f64| SIDE + (WIDTH - 2.0 * SIDE) * scale.place(value);
    let mut svg = opening(WIDTH, bottom + BOTTOM, title);
    for (value, text) in scale.ticks(6) {
        let x = at(value);
        let _ = write!(svg, r#"<line class="grid" x1="{x:.1}" y1="{TOP}" x2="{x:.1}" y2="{bottom}"/>"#);
        let y = bottom + 16.0;
        let _ = write!(svg, r#"<text class="tick" x="{x:.1}" y="{y}" text-anchor="middle">{}</text>"#, escaped(&text));
    }
    for (i, rung) in rungs.iter().enumerate() {
        let y = TOP + STEP * i as f64;
        let _ = write!(svg, r#"<text class="name" x="4" y="{:.1}">{}</text>"#, y + 13.0, escaped(&rung.name));
        let line = y + 26.0;
        let _ = write!(svg, r#"<line class="grid" x1="4" y1="{line}" x2="{}" y2="{line}"/>"#, WIDTH - 4.0);
        for (mark, value, tail) in rung.values.iter().filter(|(_, value, _)| value.is_finite()) {
            let (from, to) = (at(*value), at(if tail.is_finite() { *tail } else { *value }));
            let _ = write!(
                svg,
                r#"<g class="m{mark}"><line class="tail" x1="{from:.1}" y1="{line}" x2="{to:.1}" y2="{line}"/>"#
            );
            let _ = write!(svg, "{}</g>", form(*mark, from, line));
        }
    }
    let _ = write!(
        svg,
        r#"<text class="label" x="{:.1}" y="{:.1}" text-anchor="middle">{}</text></svg>"#,
        0.5 * WIDTH,
        bottom + BOTTOM - 8.0,
        escaped(axis.label)
    );
    svg
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::scale::Unit;

    #[test]
    fn every_rung_has_its_name_and_marks() {
        let rung = |name: &str| Rung { name: name.to_owned(), values: vec![(0, 1e-7, 2e-7), (1, 5e-7, f64::NAN)] };
        let svg = rungs("t", &Axis::log("time", Unit::Seconds), &[rung("a < b"), rung("c")]);
        let document = roxmltree::Document::parse(&svg).unwrap();
        let count = |class: &str| document.descendants().filter(|node| node.attribute("class") == Some(class)).count();
        assert_eq!((count("name"), count("dot")), (2, 4));
    }
}
