//! Questions of a client, in the library's own words.

use super::client::Client;
use super::edits::{RemoteOverlay, overlay};
use super::error::ClientError;
use crate::query::{
    Answer, Answers, CastItem, CastRays, CastShapes, CheckMotions, CheckMovingPairs, CheckStates, Clearance, Motions,
    NearestBodies, NearestItem, Overlap, OverlapItem, PairQuery,
};
use crate::service::{Estimate, Estimated, Target};
use crate::transports::wire::{from_proto, to_proto, v1};

impl Client {
    /// A client whose questions are answered as if these changes had been made; nobody else sees them. Of states, motions, paths,
    /// clearance, touching and distance; casts and regions are refused with one.
    #[must_use]
    pub fn supposing(&self, changes: &RemoteOverlay) -> Self {
        let mut client = self.clone();
        client.supposed = Some(Box::new(overlay(changes)));
        client
    }

    /// The context as the daemon is to see it.
    fn seen(&self, context: Option<v1::Context>) -> Option<v1::Context> {
        context.map(|context| v1::Context { overlay: self.supposed.as_deref().cloned(), ..context })
    }

    /// Is the robot free in these states?
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn check_states(&self, target: &Target, question: &CheckStates) -> Result<Answer, ClientError> {
        let mut request = to_proto::check_states_request(target, question);
        request.context = self.seen(request.context);
        let response = self.queries().check_states(request).await?.into_inner();
        plain(response.answer)
    }

    /// Is the robot free all along these motions, or this path?
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn check_motions(&self, target: &Target, question: &CheckMotions) -> Result<Answer, ClientError> {
        let mut queries = self.queries();
        let answer = match question.motions {
            Motions::Edges => {
                let mut request = to_proto::check_motions_request(target, question);
                request.context = self.seen(request.context);
                let response = queries.check_motions(request).await?.into_inner();
                from_proto::motions(response.answer.as_ref(), &response.motions)
            }
            Motions::Path => {
                let mut request = to_proto::check_path_request(target, question);
                request.context = self.seen(request.context);
                let response = queries.check_path(request).await?.into_inner();
                from_proto::motions(response.answer.as_ref(), &response.motions)
            }
        };
        Ok(answer?)
    }

    /// Which pairs are within a distance?
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn clearance(&self, target: &Target, question: &Clearance) -> Result<Answer, ClientError> {
        let mut request = to_proto::clearance_request(target, question);
        request.context = self.seen(request.context);
        plain(self.queries().clearance(request).await?.into_inner().answer)
    }

    /// What would a question cost, for each output at each tolerance?
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn estimate(&self, target: &Target, estimate: &Estimate) -> Result<Estimated, ClientError> {
        let mut request = to_proto::estimate_request(target, estimate);
        if let Some(question) = &mut request.question {
            let context = from_proto::context_of(question);
            *context = self.seen(context.take());
        }
        Ok(from_proto::estimated(&self.queries().estimate(request).await?.into_inner())?)
    }

    /// What touches?
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn collide(&self, target: &Target, question: &PairQuery) -> Result<Answer, ClientError> {
        let mut request = to_proto::collide_request(target, question);
        request.context = self.seen(request.context);
        plain(self.queries().collide(request).await?.into_inner().answer)
    }

    /// How far is the nearest?
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn distance(&self, target: &Target, question: &PairQuery) -> Result<Answer, ClientError> {
        let mut request = to_proto::distance_request(target, question);
        request.context = self.seen(request.context);
        plain(self.queries().distance(request).await?.into_inner().answer)
    }

    /// What does each ray meet? The cost is told as a sum over all rays, which stands with the first.
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn cast_rays(&self, target: &Target, question: &CastRays) -> Result<Answers<CastItem>, ClientError> {
        let mut request = to_proto::cast_rays_request(target, question);
        request.context = self.seen(request.context);
        Ok(from_proto::cast_rays_answers(&self.queries().cast_rays(request).await?.into_inner())?)
    }

    /// What does each moving shape or body meet, and when?
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn cast_shapes(&self, target: &Target, question: &CastShapes) -> Result<Answers<CastItem>, ClientError> {
        let mut request = to_proto::cast_shapes_request(target, question);
        request.context = self.seen(request.context);
        Ok(from_proto::cast_shapes_answers(&self.queries().cast_shapes(request).await?.into_inner())?)
    }

    /// When does each pair of moving shapes or bodies meet?
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn check_moving_pairs(
        &self,
        target: &Target,
        question: &CheckMovingPairs,
    ) -> Result<Answers<CastItem>, ClientError> {
        let mut request = to_proto::check_moving_pairs_request(target, question);
        request.context = self.seen(request.context);
        Ok(from_proto::check_moving_pairs_answers(&self.queries().check_moving_pairs(request).await?.into_inner())?)
    }

    /// Which bodies have a point in each region?
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn overlap(&self, target: &Target, question: &Overlap) -> Result<Answers<OverlapItem>, ClientError> {
        let mut request = to_proto::overlap_request(target, question);
        request.context = self.seen(request.context);
        Ok(from_proto::overlap_answers(&self.queries().overlap(request).await?.into_inner())?)
    }

    /// Which bodies are nearest?
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn nearest_bodies(
        &self,
        target: &Target,
        question: &NearestBodies,
    ) -> Result<Answers<NearestItem>, ClientError> {
        let mut request = to_proto::nearest_bodies_request(target, question);
        request.context = self.seen(request.context);
        Ok(from_proto::nearest_bodies_answers(&self.queries().nearest_bodies(request).await?.into_inner())?)
    }
}

fn plain(answer: Option<v1::Answer>) -> Result<Answer, ClientError> {
    Ok(from_proto::answer(&answer.ok_or(ClientError::Missing("answer"))?)?)
}
