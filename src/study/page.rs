//! The report: one file of HTML that needs no other, no script and no network.

use std::fmt::Write as _;
use std::time::Duration;

use super::machine::Machine;
use super::markup::escaped;
use super::plot::{MARKS, form};
use super::section::{Figure, Section};
use super::study::Effort;

/// Colours after Okabe and Ito, which people with any kind of colour vision tell apart; black turns white at night, and yellow,
/// which nobody sees on white, is left out. Marks from 7 on are told by their form and broken lines.
const COLOURS: [[&str; 2]; MARKS] = [
    ["#000000", "#ffffff"],
    ["#0072b2", "#56a8e0"],
    ["#d55e00", "#f07f2e"],
    ["#009e73", "#2cc79a"],
    ["#b05a8c", "#e08fc0"],
    ["#b07c00", "#e6a820"],
    ["#3392c4", "#7cc8f0"],
    ["#6b6b6b", "#a8a8a8"],
    ["#8a3a00", "#ffb078"],
    ["#8c8c8c", "#8c8c8c"],
];

const STYLE: &str = "
:root{color-scheme:light dark;--ink:#1a1a1a;--soft:#5a5a5a;--paper:#fff;--grid:#e2e2e2;--panel:#fff}
@media(prefers-color-scheme:dark){:root{--ink:#ececec;--soft:#a9a9a9;--paper:#141414;--grid:#333;--panel:#1a1a1a}}
*{box-sizing:border-box}
body{margin:0 auto;padding:1rem;max-width:92rem;background:var(--paper);color:var(--ink);font:16px/1.5 system-ui,sans-serif}
h1{font-size:1.7rem;line-height:1.2}h2{font-size:1.3rem;margin:2.5rem 0 .3rem}
p,ul.read,figcaption{max-width:62rem}
figure{margin:1rem 0}figcaption{font-weight:600;margin:.3rem 0}
.what{color:var(--soft);margin:.2rem 0 .6rem}
ul.read{margin:.3rem 0 .8rem;padding-left:1.2rem}ul.read li{margin:.2rem 0}
.legend{display:flex;flex-wrap:wrap;gap:.2rem 1.1rem;list-style:none;margin:.4rem 0;padding:0;font-size:.88rem}
.legend li{display:flex;align-items:center;gap:.35rem;white-space:nowrap}
.legend svg{flex:none}
.plots{display:flex;flex-wrap:wrap;gap:.6rem}
.plots>div{display:flex;flex-wrap:wrap;flex:0 1 auto;background:var(--panel);border:1px solid var(--grid);border-radius:4px;padding:.2rem;max-width:100%}
.plots svg{display:block;max-width:100%;height:auto}
svg text{font-family:system-ui,sans-serif;fill:var(--ink)}
.title,.name{font-size:12px;font-weight:600}.tick{font-size:10.5px}.label{font-size:11px}
svg .tick,svg .label{fill:var(--soft)}
.grid{stroke:var(--grid);stroke-width:1}.axis{stroke:var(--soft);fill:none}
.line{fill:none;stroke:var(--c);stroke-width:1.5;stroke-linejoin:round}
.tail{stroke:var(--c);stroke-width:1;opacity:.55}
.dot{fill:var(--c);stroke:none}.ring{fill:var(--panel);stroke:var(--c);stroke-width:1.5}
.m6 .line,.m7 .line,.m8 .line,.m9 .line{stroke-dasharray:4 3}
.wide{overflow-x:auto}
table{border-collapse:collapse;font-size:.86rem;margin:.6rem 0}
th,td{padding:.2rem .5rem;text-align:right;border-bottom:1px solid var(--grid);white-space:nowrap}
th,td:last-child{white-space:normal}td:last-child{min-width:5rem}
th:first-child,td:first-child{text-align:left}th{font-weight:600;vertical-align:bottom}
dl{display:grid;grid-template-columns:max-content 1fr;gap:.1rem 1rem;font-size:.9rem;margin:.6rem 0}
dt{color:var(--soft)}dd{margin:0;overflow-wrap:anywhere}
nav{display:flex;flex-wrap:wrap;gap:.2rem .9rem}nav a{white-space:nowrap}a{color:inherit}
@media print{:root{--ink:#000;--soft:#333;--paper:#fff;--grid:#ccc;--panel:#fff}body{max-width:none;font-size:11pt}table{font-size:7.5pt}th,td{padding:.1rem .3rem}nav{display:none}.plots>div,tr{break-inside:avoid}h2,.what,.legend{break-after:avoid}}
";

fn style() -> String {
    let mut text = STYLE.trim().to_owned();
    for (mark, [day, _]) in COLOURS.iter().enumerate() {
        let _ = write!(text, "\n.m{mark}{{--c:{day}}}");
    }
    text.push_str("\n@media screen and (prefers-color-scheme:dark){");
    for (mark, [_, night]) in COLOURS.iter().enumerate() {
        let _ = write!(text, ".m{mark}{{--c:{night}}}");
    }
    text.push('}');
    text
}

/// The whole page.
pub(super) fn html(sections: &[Section], machine: &Machine, took: Duration, effort: Effort) -> String {
    let mut page = String::from("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>");
    page.push_str("<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>");
    let _ = write!(page, "<title>What accuracy costs</title><style>{}</style></head><body>", style());
    page.push_str("<h1>What accuracy costs</h1>");
    let _ = write!(
        page,
        "<p>Measured by <code>clearance study</code> on this machine in {:.0} s{}. Times are medians over pairs or items, each by \
         the median of rounds in which all ways ran by turns; thin lines and “p99” lead to the 99th percentile (of fewer \
         than a hundred items, the largest). Numbers below the clock's noise mean nothing, and ratios within one plot mean more than \
         times. What takes less than 0.1 ms is asked several times in a row, so that caches and predictors know it. Each plot's numbers are in the CSV named below it.</p>",
        took.as_secs_f64(),
        if effort.part < 1.0 { "; a quick run: few pairs, so tails are rough" } else { "" },
    );
    page.push_str("<nav>");
    for section in sections {
        let _ = write!(page, "<a href=\"#{}\">{}</a>", section.table.name, escaped(section.title));
    }
    page.push_str("</nav><dl>");
    for (name, value) in &machine.facts {
        let _ = write!(page, "<dt>{}</dt><dd>{}</dd>", escaped(name), escaped(value));
    }
    page.push_str("</dl>");
    page.push_str(
        "<section class=\"short\"><h2>In short, for a planner that picks from shelves</h2><ul class=\"read\">",
    );
    for (section, advice) in sections.iter().filter_map(|section| Some((section, section.advice.as_ref()?))) {
        let name = section.table.name;
        let _ = write!(page, "<li><a href=\"#{name}\">{}</a>: {}</li>", escaped(section.title), escaped(advice));
    }
    page.push_str("</ul></section>");
    for section in sections {
        write_section(&mut page, section);
    }
    page.push_str("</body></html>\n");
    page
}

fn write_section(page: &mut String, section: &Section) {
    let name = section.table.name;
    let _ = write!(page, "\n<section id=\"{name}\"><h2>{}</h2>", escaped(section.title));
    let _ = write!(page, "<p class=\"what\">{}</p><ul class=\"read\">", escaped(&section.what));
    for reading in &section.readings {
        let _ = write!(page, "<li>{}</li>", escaped(reading));
    }
    page.push_str("</ul>");
    section.figures.iter().for_each(|figure| write_figure(page, figure));
    if let Some((columns, rows)) = &section.summary {
        page.push_str("<div class=\"wide\"><table><thead><tr>");
        columns.iter().for_each(|column| _ = write!(page, "<th>{}</th>", escaped(column)));
        page.push_str("</tr></thead><tbody>");
        for row in rows {
            page.push_str("<tr>");
            row.iter().for_each(|cell| _ = write!(page, "<td>{}</td>", escaped(cell)));
            page.push_str("</tr>");
        }
        page.push_str("</tbody></table></div>");
    }
    let _ = write!(
        page,
        "<p class=\"what\">All numbers: <a href=\"{name}.csv\">{name}.csv</a>, {} rows</p></section>",
        section.table.rows.len()
    );
}

fn write_figure(page: &mut String, figure: &Figure) {
    let _ = write!(page, "<figure><figcaption>{}</figcaption>", escaped(&figure.caption));
    if !figure.legend.is_empty() {
        page.push_str("<ul class=\"legend\">");
        for (text, mark) in &figure.legend {
            let _ = write!(
                page,
                "<li><svg width=\"30\" height=\"14\" viewBox=\"0 0 30 14\" aria-hidden=\"true\"><g class=\"m{mark}\"><line \
                 class=\"line\" x1=\"1\" y1=\"7\" x2=\"29\" y2=\"7\"/>{}</g></svg>{}</li>",
                form(*mark, 15.0, 7.0),
                escaped(text)
            );
        }
        page.push_str("</ul>");
    }
    page.push_str("<div class=\"plots\">");
    for drawing in &figure.drawings {
        let _ = write!(page, "\n<div>{drawing}</div>");
    }
    page.push_str("</div></figure>");
}
