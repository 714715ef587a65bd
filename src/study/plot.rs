//! A drawing of points over two axes, as SVG that takes its colours from the page.

use std::fmt::Write as _;

use super::markup::escaped;
use super::scale::{Axis, Scale};

/// A point, and how far up what it stands for reaches: from the median to the 99th percentile.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    pub x: f64,
    pub y: f64,
    pub up_to: Option<f64>,
}

impl Point {
    pub fn new(x: f64, y: f64) -> Self {
        Self { x, y, up_to: None }
    }

    pub fn with_tail(x: f64, y: f64, up_to: f64) -> Self {
        Self { x, y, up_to: Some(up_to) }
    }
}

/// Points of one thing, joined by a line in their order.
#[derive(Clone, Debug)]
pub(super) struct Series {
    /// Number of the mark: its colour, form and line.
    pub mark: usize,
    pub joined: bool,
    pub points: Vec<Point>,
}

/// Marks that are told apart by form as well as by colour.
pub(super) const MARKS: usize = 10;

/// Of a drawing, pixels.
const WIDTH: f64 = 295.0;
const HEIGHT: f64 = 236.0;
const LEFT: f64 = 58.0;
const RIGHT: f64 = 14.0;
const TOP: f64 = 26.0;
const BOTTOM: f64 = 44.0;

/// What a value that a logarithmic axis does not show is drawn at: zero is below all others.
fn shown(value: f64, axis: &Axis, least: f64) -> f64 {
    if axis.log && value <= 0.0 { least } else { value }
}

/// Draws all series. `least`: where zeros of a logarithmic axis x are drawn.
pub(super) fn plot(title: &str, x: &Axis, y: &Axis, series: &[Series], least: f64) -> String {
    let place = |p: &Point| Point { x: shown(p.x, x, least), ..*p };
    let all: Vec<Point> = series.iter().flat_map(|s| s.points.iter().map(place)).collect();
    let scale_x = Scale::around(x, all.iter().map(|p| p.x));
    let scale_y = Scale::around(y, all.iter().flat_map(|p| [Some(p.y), p.up_to]).flatten());
    let (right, bottom) = (WIDTH - RIGHT, HEIGHT - BOTTOM);
    let at_x = |value: f64| LEFT + (right - LEFT) * scale_x.place(value);
    let at_y = |value: f64| bottom + (TOP - bottom) * scale_y.place(value);
    let mut svg = opening(WIDTH, HEIGHT, title);
    for (value, text) in scale_x.ticks(4) {
        let at = at_x(value);
        let _ = write!(svg, r#"<line class="grid" x1="{at:.1}" y1="{TOP}" x2="{at:.1}" y2="{bottom}"/>"#);
        let _ = write!(
            svg,
            r#"<text class="tick" x="{at:.1}" y="{:.1}" text-anchor="middle">{}</text>"#,
            bottom + 15.0,
            escaped(&text)
        );
    }
    for (value, text) in scale_y.ticks(6) {
        let at = at_y(value);
        let _ = write!(svg, r#"<line class="grid" x1="{LEFT}" y1="{at:.1}" x2="{right}" y2="{at:.1}"/>"#);
        let _ = write!(
            svg,
            r#"<text class="tick" x="{:.1}" y="{:.1}" text-anchor="end">{}</text>"#,
            LEFT - 6.0,
            at + 4.0,
            escaped(&text)
        );
    }
    let _ = write!(svg, r#"<path class="axis" d="M{LEFT} {TOP}V{bottom}H{right}"/>"#);
    let middle = 0.5 * (LEFT + right);
    let _ = write!(
        svg,
        r#"<text class="label" x="{middle:.1}" y="{:.1}" text-anchor="middle">{}</text>"#,
        HEIGHT - 8.0,
        escaped(x.label)
    );
    for one in series {
        let points: Vec<(f64, f64, Option<f64>)> = one
            .points
            .iter()
            .map(place)
            .filter(|p| p.x.is_finite() && p.y.is_finite())
            .map(|p| (at_x(p.x), at_y(p.y), p.up_to.filter(|up| up.is_finite()).map(at_y)))
            .collect();
        draw(&mut svg, one, &points);
    }
    svg.push_str("</svg>");
    svg
}

fn draw(svg: &mut String, series: &Series, points: &[(f64, f64, Option<f64>)]) {
    let mark = series.mark % MARKS;
    let _ = write!(svg, r#"<g class="m{mark}">"#);
    for (x, y, up) in points {
        if let Some(up) = up {
            let _ = write!(svg, r#"<line class="tail" x1="{x:.1}" y1="{y:.1}" x2="{x:.1}" y2="{up:.1}"/>"#);
        }
    }
    if series.joined && points.len() > 1 {
        let path: Vec<String> = points.iter().map(|(x, y, _)| format!("{x:.1},{y:.1}")).collect();
        let _ = write!(svg, r#"<polyline class="line" points="{}"/>"#, path.join(" "));
    }
    for (x, y, _) in points {
        svg.push_str(&form(mark, *x, *y));
    }
    svg.push_str("</g>");
}

/// Opens a drawing whose first line is its title.
pub(super) fn opening(width: f64, height: f64, title: &str) -> String {
    let title = escaped(title);
    format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" role="img" aria-label="{title}"><text class="title" x="4" y="15">{title}</text>"#
    )
}

/// The form of a mark, so that marks differ without colour.
pub(super) fn form(mark: usize, x: f64, y: f64) -> String {
    let path = |d: &str, r: f64| {
        let mut text = String::new();
        let mut numbers = d.split(' ').filter_map(|number| number.parse::<f64>().ok());
        let mut first = true;
        while let (Some(dx), Some(dy)) = (numbers.next(), numbers.next()) {
            let _ = write!(text, "{}{:.1} {:.1}", if first { 'M' } else { 'L' }, x + r * dx, y + r * dy);
            first = false;
        }
        text
    };
    let filled = |d: &str| format!(r#"<path class="dot" d="{}Z"/>"#, path(d, 3.6));
    let hollow = |d: &str| format!(r#"<path class="ring" d="{}Z"/>"#, path(d, 3.4));
    match mark % MARKS {
        0 => format!(r#"<circle class="dot" cx="{x:.1}" cy="{y:.1}" r="3.4"/>"#),
        1 => filled("-0.9 -0.9 0.9 -0.9 0.9 0.9 -0.9 0.9"),
        2 => filled("0 -1.1 1 0.8 -1 0.8"),
        3 => filled("0 -1.2 1.2 0 0 1.2 -1.2 0"),
        4 => filled("0 1.1 1 -0.8 -1 -0.8"),
        5 => format!(r#"<circle class="ring" cx="{x:.1}" cy="{y:.1}" r="3.2"/>"#),
        6 => hollow("-0.9 -0.9 0.9 -0.9 0.9 0.9 -0.9 0.9"),
        7 => hollow("0 -1.1 1 0.8 -1 0.8"),
        8 => hollow("0 -1.2 1.2 0 0 1.2 -1.2 0"),
        _ => {
            format!(r#"<path class="ring" d="{}{}"/>"#, path("-0.9 -0.9 0.9 0.9", 3.4), path("-0.9 0.9 0.9 -0.9", 3.4))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::scale::Unit;

    #[test]
    fn a_drawing_is_well_formed_and_holds_every_point_within() {
        let points = (0..12).map(|i| Point::with_tail(libm::pow(10.0, -f64::from(i)), 1e-7, 3e-7)).collect();
        let zero = vec![Point::new(0.0, 2e-7)];
        let series = [Series { mark: 0, joined: true, points }, Series { mark: 9, joined: false, points: zero }];
        let (x, y) = (Axis::log("error & < width", Unit::Plain), Axis::log("time", Unit::Seconds));
        let svg = plot("a \"title\"", &x, &y, &series, 1e-17);
        let document = roxmltree::Document::parse(&svg).unwrap();
        let circles: Vec<f64> = document
            .descendants()
            .filter(|node| node.has_tag_name("circle"))
            .map(|node| node.attribute("cx").unwrap().parse().unwrap())
            .collect();
        assert_eq!(circles.len(), 12);
        assert!(circles.iter().all(|x| (LEFT..=WIDTH - RIGHT).contains(x)), "{circles:?}");
    }

    #[test]
    fn all_marks_differ() {
        let forms: std::collections::BTreeSet<String> = (0..MARKS).map(|mark| form(mark, 0.0, 0.0)).collect();
        assert_eq!(forms.len(), MARKS);
    }
}
