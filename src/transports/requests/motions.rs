//! The service `Queries`: motions, and what is near.

use std::sync::Arc;
use std::time::Duration;

use super::effort::Effort;
use super::queries::{answer, suppose};
use crate::query::Answer;
use crate::service::{Service, ServiceError, View};
use crate::transports::wire::{from_proto, to_proto, v1};

/// The rpc `CheckMotions`.
///
/// # Errors
/// As [`Service::ask`].
pub async fn check_motions(
    service: &Arc<Service>,
    message: v1::CheckMotionsRequest,
    timeout: Option<Duration>,
) -> Result<v1::CheckMotionsResponse, ServiceError> {
    let context = message.context.clone();
    let question = move |view: &View| view.check_motions(&from_proto::check_motions(&message, view.snapshot())?);
    let (answer, motions, bulk) = moving(service, context, timeout, question).await?;
    Ok(v1::CheckMotionsResponse { answer: Some(answer), motions, bulk })
}

/// The rpc `CheckPath`.
///
/// # Errors
/// As [`Service::ask`].
pub async fn check_path(
    service: &Arc<Service>,
    message: v1::CheckPathRequest,
    timeout: Option<Duration>,
) -> Result<v1::CheckPathResponse, ServiceError> {
    let context = message.context.clone();
    let question = move |view: &View| view.check_motions(&from_proto::check_path(&message, view.snapshot())?);
    let (answer, motions, bulk) = moving(service, context, timeout, question).await?;
    Ok(v1::CheckPathResponse { answer: Some(answer), motions, bulk })
}

/// The rpc `Clearance`.
///
/// # Errors
/// As [`Service::ask`].
pub async fn clearance(
    service: &Arc<Service>,
    message: v1::ClearanceRequest,
    timeout: Option<Duration>,
) -> Result<v1::ClearanceResponse, ServiceError> {
    let (context, library) = (message.context.clone(), Arc::clone(service.library()));
    let question = move |view: &View| view.clearance(&from_proto::clearance(&message, view.worlds(), &library)?);
    Ok(v1::ClearanceResponse { answer: Some(answer(service, context, timeout, Effort::Any, question).await?) })
}

/// A question whose items are motions.
async fn moving(
    service: &Arc<Service>,
    context: Option<v1::Context>,
    timeout: Option<Duration>,
    question: impl FnOnce(&View) -> Result<Answer, ServiceError> + Send + 'static,
) -> Result<(v1::Answer, Vec<v1::Motion>, Option<v1::BulkMotions>), ServiceError> {
    let form = from_proto::answer_form(context.as_ref())?;
    let encoded = move |view: &View| {
        let answer = question(view)?;
        let (motions, bulk) = to_proto::motions(&answer, form);
        Ok((to_proto::answer(&answer, form), motions, bulk))
    };
    suppose(service, context, timeout, Effort::Any, encoded, |(answer, _, _), added| answer.added_bodies = added).await
}
