//! The rpc `QueryStream`: questions of any kind in, answers out, many at a time.
//!
//! It goes on when its answers are read. As many questions are taken as may be answered at a time; answers that wait for
//! their turn, or to be read, count among them, so that nothing grows.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

use tokio::task::JoinSet;
use tokio_stream::{Stream, StreamExt};

use super::{
    cast_rays, cast_shapes, check_motions, check_moving_pairs, check_path, check_states, clearance, collide, distance,
    estimate, nearest_bodies, overlap, rpc_named,
};
use crate::limits::LimitExceeded;
use crate::service::{Asker, Call, Permit, Rpc, Service, ServiceError};
use crate::transports::wire::v1::query_stream_request::Question;
use crate::transports::wire::v1::query_stream_response::Outcome;
use crate::transports::wire::{to_proto, v1};

/// A stream of questions that is under way. Dropping it stops the work on them.
#[derive(Debug)]
pub struct QueryMessages<S> {
    service: Arc<Service>,
    /// Who asks, where somebody observes: each question is a call of its own.
    asker: Option<Asker>,
    sent: S,
    /// When the caller no longer listens.
    until: Option<Instant>,
    under_way: JoinSet<(u64, v1::QueryStreamResponse)>,
    /// Answers that are there before their turn, by the number of their question.
    waiting: BTreeMap<u64, v1::QueryStreamResponse>,
    /// Number of the next question, and of the next answer where they come in order.
    taken: u64,
    told: u64,
    first: bool,
    in_order: bool,
    most: usize,
    ended: bool,
    _permit: Permit,
}

/// Takes questions from `sent`. An error among them ends the stream: the caller is gone.
///
/// # Errors
/// The daemon drains, or all places are taken.
pub fn query_stream<S>(
    service: &Arc<Service>,
    sent: S,
    timeout: Option<Duration>,
) -> Result<QueryMessages<S>, ServiceError> {
    Ok(QueryMessages {
        _permit: service.enter_stream()?,
        service: Arc::clone(service),
        asker: Service::current_asker(),
        sent,
        until: timeout.and_then(|timeout| Instant::now().checked_add(timeout)),
        under_way: JoinSet::new(),
        waiting: BTreeMap::new(),
        taken: 0,
        told: 0,
        first: true,
        in_order: false,
        most: service.limits().max_stream_in_flight,
        ended: false,
    })
}

impl<S, E> QueryMessages<S>
where
    S: Stream<Item = Result<v1::QueryStreamRequest, E>> + Unpin,
{
    /// The next answer; none once the caller has ended the stream and all is answered.
    ///
    /// # Errors
    /// The daemon drains and nothing is left to be answered, the caller's time is up, or options that cannot be. Then the
    /// stream has ended.
    pub async fn next(&mut self) -> Result<Option<v1::QueryStreamResponse>, ServiceError> {
        let mut draining = self.service.draining();
        loop {
            if let Some(answer) = self.waiting.remove(&self.told) {
                self.told += 1;
                return Ok(Some(answer));
            }
            let idle = self.under_way.is_empty() && self.waiting.is_empty();
            if idle && self.ended {
                return Ok(None);
            }
            let may_read = !self.ended && self.under_way.len() + self.waiting.len() < self.most;
            let time_is_up = async {
                match self.until {
                    Some(until) => tokio::time::sleep_until(until.into()).await,
                    None => std::future::pending().await,
                }
            };
            tokio::select! {
                biased;
                Some(done) = self.under_way.join_next(), if !self.under_way.is_empty() => {
                    // Panics are caught where the work is done; only a runtime that ends cancels a task.
                    let Ok((number, answer)) = done else { return Err(ServiceError::ShuttingDown) };
                    if !self.in_order {
                        return Ok(Some(answer));
                    }
                    self.waiting.insert(number, answer);
                }
                message = self.sent.next(), if may_read => match message {
                    Some(Ok(message)) => self.take(message)?,
                    Some(Err(_)) => return Ok(None),
                    None => self.ended = true,
                },
                () = time_is_up => return Err(ServiceError::DeadlineExceeded),
                // A sender that is gone means the same. What is under way is still answered.
                _ = draining.wait_for(|draining| *draining), if idle => return Err(ServiceError::ShuttingDown),
            }
        }
    }

    fn take(&mut self, message: v1::QueryStreamRequest) -> Result<(), ServiceError> {
        let first = std::mem::replace(&mut self.first, false);
        let v1::QueryStreamRequest { id, question } = message;
        if let Some(Question::Options(options)) = &question {
            if !first {
                return Err(ServiceError::invalid("options", "is for the first message"));
            }
            let (asked, most) = (options.max_in_flight as usize, self.service.limits().max_stream_in_flight);
            LimitExceeded::check("max_stream_in_flight", asked, most)?;
            self.most = if asked == 0 { most } else { asked };
            self.in_order = options.in_order;
            return Ok(());
        }
        let (service, number) = (Arc::clone(&self.service), self.taken);
        let timeout = self.until.map(|until| until.saturating_duration_since(Instant::now()));
        self.taken += 1;
        let call = match (&self.asker, question.as_ref().and_then(rpc_of)) {
            (Some(asker), Some(rpc)) => service.begin_call(rpc, || asker.clone()),
            _ => Call::unobserved(),
        };
        self.under_way.spawn(async move {
            let outcome = call.answer(answer(&service, question, timeout)).await;
            let outcome = outcome.unwrap_or_else(|error| Outcome::Error(to_proto::query_error(&error)));
            (number, v1::QueryStreamResponse { id, outcome: Some(outcome) })
        });
        Ok(())
    }
}

/// The rpc that asks the same by itself.
fn rpc_of(question: &Question) -> Option<Rpc> {
    rpc_named(match question {
        Question::Options(_) => return None,
        Question::CheckStates(_) => "Queries/CheckStates",
        Question::Collide(_) => "Queries/Collide",
        Question::Distance(_) => "Queries/Distance",
        Question::CastRays(_) => "Queries/CastRays",
        Question::CastShapes(_) => "Queries/CastShapes",
        Question::CheckMovingPairs(_) => "Queries/CheckMovingPairs",
        Question::Overlap(_) => "Queries/Overlap",
        Question::NearestBodies(_) => "Queries/NearestBodies",
        Question::CheckMotions(_) => "Queries/CheckMotions",
        Question::CheckPath(_) => "Queries/CheckPath",
        Question::Clearance(_) => "Queries/Clearance",
        Question::Estimate(_) => "Queries/Estimate",
    })
}

async fn answer(
    service: &Arc<Service>,
    question: Option<Question>,
    timeout: Option<Duration>,
) -> Result<Outcome, ServiceError> {
    match question {
        None | Some(Question::Options(_)) => Err(ServiceError::invalid("question", "is missing")),
        Some(Question::CheckStates(asked)) => Ok(Outcome::CheckStates(check_states(service, asked, timeout).await?)),
        Some(Question::Collide(asked)) => Ok(Outcome::Collide(collide(service, asked, timeout).await?)),
        Some(Question::Distance(asked)) => Ok(Outcome::Distance(distance(service, asked, timeout).await?)),
        Some(Question::CastRays(asked)) => Ok(Outcome::CastRays(cast_rays(service, asked, timeout).await?)),
        Some(Question::CastShapes(asked)) => Ok(Outcome::CastShapes(cast_shapes(service, asked, timeout).await?)),
        Some(Question::CheckMovingPairs(asked)) => {
            Ok(Outcome::CheckMovingPairs(check_moving_pairs(service, asked, timeout).await?))
        }
        Some(Question::Overlap(asked)) => Ok(Outcome::Overlap(overlap(service, asked, timeout).await?)),
        Some(Question::NearestBodies(asked)) => {
            Ok(Outcome::NearestBodies(nearest_bodies(service, asked, timeout).await?))
        }
        Some(Question::CheckMotions(asked)) => Ok(Outcome::CheckMotions(check_motions(service, asked, timeout).await?)),
        Some(Question::CheckPath(asked)) => Ok(Outcome::CheckPath(check_path(service, asked, timeout).await?)),
        Some(Question::Estimate(asked)) => Ok(Outcome::Estimate(estimate(service, asked, timeout).await?)),
        Some(Question::Clearance(asked)) => Ok(Outcome::Clearance(clearance(service, asked, timeout).await?)),
    }
}
