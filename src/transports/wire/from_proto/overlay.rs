//! Overlays: from messages to edits that only a question sees.

use super::Path;
use super::scene::{body_ref, edit, required_pose};
use crate::limits::LimitExceeded;
use crate::query::{Attached, Overlay, Overlays};
use crate::service::{Library, Robots, ServiceError};
use crate::transports::wire::v1;

/// The overlays of a question.
///
/// # Errors
/// A field that is missing or cannot be, an asset or model that is not there, too many.
pub fn overlays(context: &v1::Context, library: &Library, robots: &Robots) -> Result<Overlays, ServiceError> {
    let limits = library.limits();
    LimitExceeded::check("max_overlays", context.alternatives.len() + 1, limits.max_overlays)?;
    let all = context.overlay.iter().chain(&context.alternatives);
    let edits = all.map(|overlay| overlay.edits.len() + overlay.attached.len()).sum();
    LimitExceeded::check("max_overlay_edits", edits, limits.max_overlay_edits)?;
    let path = Path::root("context");
    let common = context.overlay.as_ref();
    let common = common.map(|message| overlay(&path.field("overlay"), message, library, robots)).transpose()?;
    let alternative = |(index, message)| overlay(&path.item("alternatives", index), message, library, robots);
    Ok(Overlays {
        common: common.unwrap_or_default(),
        alternatives: context.alternatives.iter().enumerate().map(alternative).collect::<Result<_, _>>()?,
        of_item: context.item_alternatives.clone(),
    })
}

/// Whether a question has any overlay.
#[must_use]
pub fn has_overlays(context: &v1::Context) -> bool {
    context.overlay.is_some() || !context.alternatives.is_empty() || !context.item_alternatives.is_empty()
}

/// # Errors
/// The question has an overlay, and is of a kind that takes none.
pub fn no_overlays(context: Option<&v1::Context>) -> Result<(), ServiceError> {
    let Some(context) = context else { return Ok(()) };
    let path = Path::root("context");
    for (field, said) in [
        ("overlay", context.overlay.is_some()),
        ("alternatives", !context.alternatives.is_empty()),
        ("item_alternatives", !context.item_alternatives.is_empty()),
    ] {
        if said {
            return Err(path.field(field).invalid("has no meaning for this question, which takes no overlays"));
        }
    }
    Ok(())
}

fn overlay(
    path: &Path<'_>,
    message: &v1::Overlay,
    library: &Library,
    robots: &Robots,
) -> Result<Overlay, ServiceError> {
    let edit = |(index, message)| edit(&path.item("edits", index), message, library, robots);
    let attached = |(index, message)| attach(&path.item("attached", index), message);
    Ok(Overlay {
        edits: message.edits.iter().enumerate().map(edit).collect::<Result<_, ServiceError>>()?,
        attached: message.attached.iter().enumerate().map(attached).collect::<Result<_, ServiceError>>()?,
    })
}

fn attach(path: &Path<'_>, message: &v1::AttachBody) -> Result<Attached, ServiceError> {
    let link = path.field("link").required(message.link.as_ref())?;
    Ok(Attached {
        body: body_ref(&path.field("body"), message.body.as_ref())?,
        robot: link.robot.clone(),
        link: link.link.clone(),
        body_in_link: required_pose(&path.field("body_in_link"), message.body_in_link.as_ref())?,
        may_touch: message.may_touch.clone(),
    })
}
