//! What is watched.

use super::Path;
use super::query::{context, unknown_value};
use crate::limits::Limits;
use crate::query::{ContactQuestion, Context, Threshold};
use crate::scene::Snapshot;
use crate::service::ServiceError;
use crate::transports::wire::v1;

/// A question about contacts; names of bodies are looked up in the snapshot that comes first.
///
/// # Errors
/// A field that cannot be or has no meaning here, a body that is not there.
pub fn contact_question(
    request: &v1::WatchContactsRequest,
    snapshot: &Snapshot,
    limits: &Limits,
) -> Result<ContactQuestion, ServiceError> {
    let path = Path::root("context");
    let asked = path.required(request.context.as_ref())?;
    for (field, said) in [
        ("cut_off", asked.cut_off.is_some()),
        ("max_pairs", asked.max_pairs.is_some()),
        ("time_budget", asked.time_budget.is_some()),
        ("answer_form", asked.answer_form != 0),
    ] {
        if said {
            return Err(path.field(field).invalid("has no meaning for contacts"));
        }
    }
    let threshold = match v1::ContactThreshold::try_from(request.threshold) {
        Ok(v1::ContactThreshold::Unspecified | v1::ContactThreshold::Touching) if asked.margin != 0.0 => {
            return Err(path
                .field("margin")
                .invalid("has no meaning unless the threshold is CONTACT_THRESHOLD_MARGIN"));
        }
        Ok(v1::ContactThreshold::Unspecified | v1::ContactThreshold::Touching) => Threshold::Touching,
        Ok(v1::ContactThreshold::Margin) => Threshold::Margin(asked.margin),
        Err(_) => return Err(unknown_value(&Path::root("threshold"), request.threshold)),
    };
    let Context { wants, accuracy, solver, filter, max_patch_points, derivatives, margin: _, cut_off: _, max_pairs: _ } =
        context(request.context.as_ref(), snapshot)?;
    Ok(ContactQuestion {
        threshold,
        wants,
        accuracy,
        solver,
        filter,
        stays: request.stays,
        max_patch_points,
        derivatives,
        max_contacts: limits.max_contacts,
    })
}
