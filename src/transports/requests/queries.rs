//! The service `Queries`: what is where, and what would be met.

use std::sync::Arc;
use std::time::Duration;

use super::effort::Effort;
use crate::query::Answer;
use crate::service::{ContactWatch, Patience, Service, ServiceError, Target, View};
use crate::transports::wire::{from_proto, to_proto, v1};

/// The rpc `CheckStates`.
///
/// # Errors
/// As [`Service::ask`].
pub async fn check_states(
    service: &Arc<Service>,
    message: v1::CheckStatesRequest,
    timeout: Option<Duration>,
) -> Result<v1::CheckStatesResponse, ServiceError> {
    let (context, effort) = (message.context.clone(), Effort::of_states(&message));
    let question = move |view: &View| view.check_states(&from_proto::check_states(&message, view.snapshot())?);
    Ok(v1::CheckStatesResponse { answer: Some(answer(service, context, timeout, effort, question).await?) })
}

/// The rpc `Collide`.
///
/// # Errors
/// As [`Service::ask`].
pub async fn collide(
    service: &Arc<Service>,
    message: v1::CollideRequest,
    timeout: Option<Duration>,
) -> Result<v1::CollideResponse, ServiceError> {
    let (context, library) = (message.context.clone(), Arc::clone(service.library()));
    let effort = Effort::of_subjects(&message.items, context.as_ref());
    let question = move |view: &View| view.collide(&from_proto::collide(&message, view.worlds(), &library)?);
    Ok(v1::CollideResponse { answer: Some(answer(service, context, timeout, effort, question).await?) })
}

/// The rpc `Distance`.
///
/// # Errors
/// As [`Service::ask`].
pub async fn distance(
    service: &Arc<Service>,
    message: v1::DistanceRequest,
    timeout: Option<Duration>,
) -> Result<v1::DistanceResponse, ServiceError> {
    let (mut context, library) = (message.context.clone(), Arc::clone(service.library()));
    if let Some(context) = &mut context {
        context.wants.get_or_insert_default().distance = true;
    }
    let effort = Effort::of_subjects(&message.items, context.as_ref());
    let question = move |view: &View| view.distance(&from_proto::distance(&message, view.worlds(), &library)?);
    Ok(v1::DistanceResponse { answer: Some(answer(service, context, timeout, effort, question).await?) })
}

/// The rpc `CastRays`.
///
/// # Errors
/// As [`Service::ask`].
pub async fn cast_rays(
    service: &Arc<Service>,
    message: v1::CastRaysRequest,
    timeout: Option<Duration>,
) -> Result<v1::CastRaysResponse, ServiceError> {
    ask(service, message.context.clone(), timeout, Effort::of_rays(&message), move |view| {
        let answers = view.cast_rays(&from_proto::cast_rays(&message, view.snapshot())?)?;
        Ok(to_proto::cast_rays_response(&answers))
    })
    .await
}

/// The rpc `CastShapes`.
///
/// # Errors
/// As [`Service::ask`].
pub async fn cast_shapes(
    service: &Arc<Service>,
    message: v1::CastShapesRequest,
    timeout: Option<Duration>,
) -> Result<v1::CastShapesResponse, ServiceError> {
    let library = Arc::clone(service.library());
    ask(service, message.context.clone(), timeout, Effort::Any, move |view| {
        let answers = view.cast_shapes(&from_proto::cast_shapes(&message, view.snapshot(), &library)?)?;
        Ok(to_proto::cast_shapes_response(&answers))
    })
    .await
}

/// The rpc `CheckMovingPairs`.
///
/// # Errors
/// As [`Service::ask`].
pub async fn check_moving_pairs(
    service: &Arc<Service>,
    message: v1::CheckMovingPairsRequest,
    timeout: Option<Duration>,
) -> Result<v1::CheckMovingPairsResponse, ServiceError> {
    let library = Arc::clone(service.library());
    ask(service, message.context.clone(), timeout, Effort::Any, move |view| {
        let asked = from_proto::check_moving_pairs(&message, view.snapshot(), &library)?;
        Ok(to_proto::check_moving_pairs_response(&view.check_moving_pairs(&asked)?))
    })
    .await
}

/// The rpc `Overlap`.
///
/// # Errors
/// As [`Service::ask`].
pub async fn overlap(
    service: &Arc<Service>,
    message: v1::OverlapRequest,
    timeout: Option<Duration>,
) -> Result<v1::OverlapResponse, ServiceError> {
    let library = Arc::clone(service.library());
    ask(service, message.context.clone(), timeout, Effort::Any, move |view| {
        let answers = view.overlap(&from_proto::overlap(&message, view.snapshot(), &library)?)?;
        Ok(to_proto::overlap_response(&answers))
    })
    .await
}

/// The rpc `NearestBodies`.
///
/// # Errors
/// As [`Service::ask`].
pub async fn nearest_bodies(
    service: &Arc<Service>,
    message: v1::NearestBodiesRequest,
    timeout: Option<Duration>,
) -> Result<v1::NearestBodiesResponse, ServiceError> {
    let library = Arc::clone(service.library());
    let effort = Effort::of_subjects(&message.items, message.context.as_ref());
    ask(service, message.context.clone(), timeout, effort, move |view| {
        let answers = view.nearest_bodies(&from_proto::nearest_bodies(&message, view.snapshot(), &library)?)?;
        Ok(to_proto::nearest_bodies_response(&answers))
    })
    .await
}

/// The rpc `Estimate`.
///
/// # Errors
/// As [`Service::ask`].
pub async fn estimate(
    service: &Arc<Service>,
    mut message: v1::EstimateRequest,
    timeout: Option<Duration>,
) -> Result<v1::EstimateResponse, ServiceError> {
    let asked = message.question.as_mut().ok_or_else(|| ServiceError::invalid("question", "is missing"))?;
    let context = from_proto::context_of(asked).clone();
    let library = Arc::clone(service.library());
    let measured = move |view: &View| {
        let asked = from_proto::estimate(&message, view.worlds(), &library)?;
        Ok(to_proto::estimate_response(&view.estimate(&asked)?))
    };
    // An estimate names its own fields; what is refused around it is wrong with the context, which is the question's.
    let around = suppose(service, context, timeout, Effort::Any, move |view| Ok(measured(view)), |_, _| ());
    around.await.map_err(|error| error.within("question"))?
}

/// The watch that is asked for; its steps become messages by [`to_proto::contact_messages`].
///
/// # Errors
/// As [`Service::watch_contacts`].
pub async fn watch_contacts(
    service: &Arc<Service>,
    message: &v1::WatchContactsRequest,
    timeout: Option<Duration>,
) -> Result<ContactWatch, ServiceError> {
    from_proto::no_overlays(message.context.as_ref())?;
    let target = from_proto::target(message.context.as_ref())?;
    let question = |snapshot: &_, limits: &_| from_proto::contact_question(message, snapshot, limits);
    service.watch_contacts(&target, Patience { timeout, time_budget: None }, question).await
}

/// A question whose answer is encoded where it is found, and that takes no overlays.
pub(super) async fn ask<T: Send + 'static>(
    service: &Arc<Service>,
    context: Option<v1::Context>,
    timeout: Option<Duration>,
    effort: Effort,
    question: impl FnOnce(&View) -> Result<T, ServiceError> + Send + 'static,
) -> Result<T, ServiceError> {
    from_proto::no_overlays(context.as_ref())?;
    let patience = from_proto::patience(timeout, context.as_ref())?;
    let target = from_proto::target(context.as_ref())?;
    put(service, (&target, patience), effort, question).await
}

/// A question that is answered item by item, as if the edits of its overlays had been applied.
pub(super) async fn answer(
    service: &Arc<Service>,
    context: Option<v1::Context>,
    timeout: Option<Duration>,
    effort: Effort,
    question: impl FnOnce(&View) -> Result<Answer, ServiceError> + Send + 'static,
) -> Result<v1::Answer, ServiceError> {
    let form = from_proto::answer_form(context.as_ref())?;
    let encoded = move |view: &View| Ok(to_proto::answer(&question(view)?, form));
    suppose(service, context, timeout, effort, encoded, |answer, added| answer.added_bodies = added).await
}

/// Asks in the worlds of the overlays, and lets `name` put the bodies that they added into the answer.
pub(super) async fn suppose<T: Send + 'static>(
    service: &Arc<Service>,
    context: Option<v1::Context>,
    timeout: Option<Duration>,
    effort: Effort,
    question: impl FnOnce(&View) -> Result<T, ServiceError> + Send + 'static,
    name: impl FnOnce(&mut T, Vec<v1::AddedBody>) + Send + 'static,
) -> Result<T, ServiceError> {
    let patience = from_proto::patience(timeout, context.as_ref())?;
    let target = from_proto::target(context.as_ref())?;
    let (library, robots) = (Arc::clone(service.library()), Arc::clone(service.robots()));
    let supposed = move |view: &View| match context {
        Some(context) if from_proto::has_overlays(&context) => {
            let view = view.supposing(&from_proto::overlays(&context, &library, &robots)?)?;
            let mut answer = question(&view)?;
            name(&mut answer, to_proto::added_bodies(view.worlds()));
            Ok(answer)
        }
        _ => question(view),
    };
    put(service, (&target, patience), effort, supposed).await
}

/// Puts a question where the effort it takes belongs.
async fn put<T: Send + 'static>(
    service: &Arc<Service>,
    (target, patience): (&Target, Patience),
    effort: Effort,
    question: impl FnOnce(&View) -> Result<T, ServiceError> + Send + 'static,
) -> Result<T, ServiceError> {
    match effort {
        Effort::Little => service.ask_at_once(target, patience, question).await,
        Effort::Any => service.ask(target, patience, question).await,
    }
}
