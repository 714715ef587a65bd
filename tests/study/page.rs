//! Is the report one well-formed file that needs nothing else, and are its labels apart?

use std::collections::BTreeSet;

use roxmltree::{Document, Node};

use crate::folder::folder;

fn text() -> String {
    std::fs::read_to_string(folder().join("index.html")).unwrap()
}

/// The page without its first line, which XML does not have.
fn body(page: &str) -> &str {
    page.strip_prefix("<!DOCTYPE html>\n").unwrap()
}

#[test]
fn it_is_well_formed_with_a_section_and_a_reading_for_every_table() {
    let page = text();
    let document = Document::parse(body(&page)).unwrap();
    let sections: Vec<Node> = document.descendants().filter(|node| node.has_tag_name("section")).collect();
    let sections: Vec<Node> = sections.into_iter().filter(|section| section.attribute("class").is_none()).collect();
    let names: BTreeSet<&str> = sections.iter().filter_map(|section| section.attribute("id")).collect();
    let expected = [
        "distance",
        "outputs",
        "precision",
        "penetration",
        "geometry",
        "motion",
        "broad_phase",
        "batches",
        "lecture",
        "derivatives",
        "alignment",
    ];
    assert_eq!(names, expected.into());
    for section in sections {
        let name = section.attribute("id").unwrap();
        assert!(folder().join(format!("{name}.csv")).is_file(), "{name}");
        let readings: Vec<String> = section
            .descendants()
            .filter(|node| node.has_tag_name("ul") && node.attribute("class") == Some("read"))
            .flat_map(|list| list.children())
            .map(|item| item.text().unwrap_or_default().to_owned())
            .collect();
        assert!(!readings.is_empty(), "{name} says nothing");
        for reading in readings {
            assert!(
                reading.ends_with('.') && !reading.contains("NaN") && !reading.contains("no time"),
                "{name}: {reading}"
            );
        }
        assert!(
            section.descendants().any(|node| node.tag_name().name() == "svg" && node.attribute("role").is_some()),
            "{name}"
        );
    }
}

#[test]
fn it_says_in_short_which_tolerance_and_geometry_to_choose() {
    let page = text();
    let document = Document::parse(body(&page)).unwrap();
    let short = document.descendants().find(|node| node.attribute("class") == Some("short")).unwrap();
    let advice: String = short.descendants().filter_map(|node| node.text()).collect();
    for word in ["relative 1e-6", "For a shelf take", "For a mug take", "CheckMotions", "states into a question"] {
        assert!(advice.contains(word), "{word}: {advice}");
    }
    assert!(!advice.contains("NaN") && !advice.contains("no time"), "{advice}");
}

#[test]
fn it_needs_no_script_and_no_other_file() {
    let page = text();
    let document = Document::parse(body(&page)).unwrap();
    for node in document.descendants().filter(Node::is_element) {
        assert!(!["script", "link", "img", "iframe", "object"].contains(&node.tag_name().name()), "{node:?}");
        let to = node.attribute("href").unwrap_or_default();
        assert!(to.is_empty() || to.starts_with('#') || (to.ends_with(".csv") && folder().join(to).is_file()), "{to}");
    }
    assert!(!page.contains("@import") && !page.contains("url("));
    assert!(page.contains("prefers-color-scheme:dark") && page.contains("@media print"));
    for fact in ["processor", "crates", "command"] {
        assert!(page.contains(&format!("<dt>{fact}</dt>")), "{fact}");
    }
}

/// Where a text surely is at most: its anchor, and a width by the number of its letters.
fn extent(node: &Node) -> [f64; 4] {
    let number = |name| node.attribute(name).unwrap().parse::<f64>().unwrap();
    let size = match node.attribute("class") {
        Some("title" | "name") => 12.0,
        Some("label") => 11.0,
        _ => 10.5,
    };
    let width = 0.56 * size * node.text().unwrap_or_default().chars().count() as f64;
    let (x, y) = (number("x"), number("y"));
    let left = match node.attribute("text-anchor") {
        Some("middle") => x - 0.5 * width,
        Some("end") => x - width,
        _ => x,
    };
    [left, left + width, y - size, y]
}

#[test]
fn no_two_labels_of_a_drawing_overlap_and_none_leaves_it() {
    let page = text();
    let document = Document::parse(body(&page)).unwrap();
    let mut drawings = 0;
    for svg in document.descendants().filter(|node| node.tag_name().name() == "svg" && node.attribute("role").is_some())
    {
        let size = |name| svg.attribute(name).unwrap().parse::<f64>().unwrap();
        let texts: Vec<Node> = svg.descendants().filter(|node| node.tag_name().name() == "text").collect();
        for (i, one) in texts.iter().enumerate() {
            let [left, right, top, bottom] = extent(one);
            let name = (svg.attribute("aria-label"), one.text());
            assert!(
                left >= -1.0 && right <= size("width") + 1.0 && bottom <= size("height"),
                "{name:?} {left} {right}"
            );
            for other in &texts[..i] {
                let [l, r, t, b] = extent(other);
                let meet = left < r && l < right && top < b && t < bottom;
                assert!(!meet, "{name:?} and {:?}", other.text());
            }
        }
        drawings += 1;
    }
    assert!(drawings > 40, "{drawings}");
}
