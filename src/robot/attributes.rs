//! Attributes of XML elements as names and finite numbers, or an error that names element and attribute.

use roxmltree::{Document, Node};

use super::RobotError;
use crate::geometry::Vec3;

/// The `<robot>` of a document's text.
pub(super) fn parse<'t>(document: &'static str, text: &'t str) -> Result<Document<'t>, RobotError> {
    let xml = Document::parse(text).map_err(|e| RobotError::Xml { document, problem: e.to_string() })?;
    let found = xml.root_element().tag_name().name();
    if found != "robot" {
        return Err(RobotError::NotARobot { document, found: found.to_owned() });
    }
    Ok(xml)
}

pub(super) fn children<'a, 'input: 'a>(
    parent: Node<'a, 'input>,
    tag: &'static str,
) -> impl Iterator<Item = Node<'a, 'input>> {
    parent.children().filter(move |node| node.tag_name().name() == tag)
}

pub(super) fn child<'a, 'input: 'a>(parent: Node<'a, 'input>, tag: &'static str) -> Option<Node<'a, 'input>> {
    children(parent, tag).next()
}

pub(super) fn required<'a>(node: Node<'a, '_>, item: &str, attribute: &str) -> Result<&'a str, RobotError> {
    node.attribute(attribute).ok_or_else(|| missing(item, attribute))
}

/// The name of an element that is one of many; `ordinal` (from 0) tells which, should it have none.
pub(super) fn name_of(node: Node, kind: &str, ordinal: usize) -> Result<String, RobotError> {
    required(node, &format!("{kind} number {}", ordinal + 1), "name").map(str::to_owned)
}

pub(super) fn missing(item: &str, field: &str) -> RobotError {
    RobotError::Missing { item: item.to_owned(), field: field.to_owned() }
}

/// A number that has to be there.
pub(super) fn number(node: Node, item: &str, attribute: &str) -> Result<f64, RobotError> {
    let [value] = numbers(required(node, item, attribute)?, item, attribute, "a finite number")?;
    Ok(value)
}

/// A number, or `default` where the attribute is absent.
pub(super) fn number_or(node: Node, item: &str, attribute: &str, default: f64) -> Result<f64, RobotError> {
    if node.has_attribute(attribute) { number(node, item, attribute) } else { Ok(default) }
}

/// Three numbers, or `default` where the attribute is absent.
pub(super) fn vector_or(node: Node, item: &str, attribute: &str, default: Vec3) -> Result<Vec3, RobotError> {
    match node.attribute(attribute) {
        Some(text) => Ok(Vec3::from(numbers::<3>(text, item, attribute, "three finite numbers")?)),
        None => Ok(default),
    }
}

/// Exactly `N` finite numbers in a text.
pub(super) fn numbers<const N: usize>(
    text: &str,
    item: &str,
    field: &str,
    expected: &'static str,
) -> Result<[f64; N], RobotError> {
    let bad =
        || RobotError::BadNumber { item: item.to_owned(), field: field.to_owned(), expected, found: text.to_owned() };
    finite_numbers(text).and_then(|numbers| numbers.try_into().ok()).ok_or_else(bad)
}

/// All the numbers in a text; none if a word of it is not a finite number.
pub(super) fn finite_numbers(text: &str) -> Option<Vec<f64>> {
    let parse = |word: &str| word.parse::<f64>().ok().filter(|number| number.is_finite());
    text.split_whitespace().map(parse).collect()
}
