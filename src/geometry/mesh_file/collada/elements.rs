//! Elements of a Collada document: children by name, words, numbers, and errors that tell the line.

use roxmltree::Node;

use super::super::MeshFileError;
use super::super::text::finite_number;

pub(super) fn numbers<const N: usize>(element: Node) -> Result<[f64; N], MeshFileError> {
    let words = words_of(element);
    let numbers: Vec<f64> = words.map(|w| finite_number(w, || place_of(element))).collect::<Result<_, _>>()?;
    let found = numbers.len();
    numbers.try_into().map_err(|_| MeshFileError::Syntax {
        place: place_of(element),
        problem: format!("{N} numbers are needed, {found} are there"),
    })
}

/// An attribute that is a whole number.
pub(super) fn whole(element: Node, attribute: &'static str, default: Option<usize>) -> Result<usize, MeshFileError> {
    match (element.attribute(attribute), default) {
        (Some(text), _) => text.trim().parse().map_err(|_| MeshFileError::Syntax {
            place: place_of(element),
            problem: format!("{attribute}={text:?} is not a whole number"),
        }),
        (None, Some(default)) => Ok(default),
        (None, None) => Err(missing(element, attribute)),
    }
}

pub(super) fn children<'a, 'input: 'a>(
    parent: Node<'a, 'input>,
    tag: &'static str,
) -> impl Iterator<Item = Node<'a, 'input>> + use<'a, 'input> {
    parent.children().filter(move |node| node.tag_name().name() == tag)
}

pub(super) fn child<'a, 'input: 'a>(parent: Node<'a, 'input>, tag: &'static str) -> Option<Node<'a, 'input>> {
    children(parent, tag).next()
}

/// The words of an element's text, comments in between left out.
pub(super) fn words_of<'a>(element: Node<'a, '_>) -> impl Iterator<Item = &'a str> {
    element.children().filter(Node::is_text).filter_map(|text| text.text()).flat_map(str::split_ascii_whitespace)
}

/// `<tag> in line N`.
pub(super) fn place_of(element: Node) -> String {
    let line = element.document().text_pos_at(element.range().start).row;
    format!("<{}> in line {line}", element.tag_name().name())
}

pub(super) fn missing(element: Node, what: &'static str) -> MeshFileError {
    MeshFileError::Missing { place: place_of(element), what }
}

pub(super) fn unsupported(element: Node, what: &str) -> MeshFileError {
    MeshFileError::Unsupported { place: place_of(element), what: what.to_owned() }
}

pub(super) fn uneven(element: Node, what: &str) -> MeshFileError {
    MeshFileError::Syntax { place: place_of(element), problem: format!("indices do not make whole {what}") }
}
